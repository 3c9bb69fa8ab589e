//! A page in three columns: models, swash hinted, swash unhinted. One pixel of the text is one of the picture.
//!
//! `cargo run --release -p nfr-cosmic --example page -- OUT.png [FONT.ttf…]` converts Liberation Sans, sets a text of several scripts
//! with it at 9 to 16 pixels per em, and takes the rest from DejaVu Sans, which has no models, and from the fonts named.
//! It prints how many glyphs a second each column takes from laid-out text to pixels, with nothing cached and with everything.

#![allow(clippy::print_stdout)]

mod common;

use std::error::Error;
use std::path::{Path, PathBuf};

use common::{Drawing, Setting, converted, font, median_time};
use cosmic_text::{CacheKeyFlags, SwashCache};
use image::{DynamicImage, RgbaImage};
use nfr_cosmic::NeuralFonts;

const TEXT: &str = "Hamburgefonstiv 0123456789. \"Hinting\" puts bars on whole pixels, so that 'e' is crisp: AV, To, Wa, fi & @.\n\
    Příliš žluťoučký kůň; Việt Nam; naïve façade, Größe, ¿qué? ½ ± £ €\n\
    Ξεσκεπάζω την ψυχοφθόρα βδελυγμία. Съешь ещё этих мягких булок.\n\
    العربية من خط آخر 😀";
const SIZES: [f32; 6] = [9.0, 10.0, 11.0, 12.0, 14.0, 16.0];
const COLUMN: u32 = 340;
const MARGIN: u32 = 12;
/// Passes that the median is taken of.
const PASSES: usize = 15;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args_os().skip(1).map(PathBuf::from);
    let out = args.next().ok_or("usage: page OUT.png [FONT.ttf...]")?;
    let others = args.map(std::fs::read).collect::<Result<Vec<_>, _>>()?;
    let original = font("LiberationSans-Regular")?;
    let neural = converted(&original, TEXT)?;
    let fallback = font("DejaVuSans")?;
    let columns = [
        ("models", &neural, CacheKeyFlags::empty(), Drawing::Models),
        ("swash, hinted", &original, CacheKeyFlags::empty(), Drawing::Swash),
        ("swash, unhinted", &original, CacheKeyFlags::DISABLE_HINTING, Drawing::Swash),
    ];
    let mut picture: Option<RgbaImage> = None;
    for ((name, font, flags, drawing), number) in columns.into_iter().zip(0..) {
        let fonts = [font, &fallback].into_iter().chain(&others).cloned();
        let mut setting = Setting::new(fonts, COLUMN);
        setting.add(TEXT, &SIZES, flags);
        let height = setting.height() + 2 * MARGIN;
        let picture = picture.get_or_insert_with(|| {
            RgbaImage::from_pixel(3 * (COLUMN + MARGIN) + MARGIN, height, image::Rgba([255; 4]))
        });
        let left = (MARGIN + number * (COLUMN + MARGIN)) as i32;
        let at = [left, MARGIN as i32];
        let mut caches = (NeuralFonts::new(), SwashCache::new());
        setting.draw(drawing, picture, at, &mut caches);
        // The timed passes draw onto a picture that nobody sees.
        let mut other = picture.clone();
        let cold = median_time(PASSES, || {
            setting.draw(drawing, &mut other, at, &mut (NeuralFonts::new(), SwashCache::new()));
        });
        let warm = median_time(PASSES, || setting.draw(drawing, &mut other, at, &mut caches));
        let rate = |seconds: f64| setting.glyphs() as f64 / seconds / 1e6;
        println!("{name:16} {:6.2} million glyphs a second cold, {:6.2} warm", rate(cold), rate(warm));
    }
    save(picture.ok_or("no column")?, &out)?;
    println!("{}: models, swash hinted, swash unhinted, from the left", out.display());
    Ok(())
}

/// Writes a picture, in a byte a pixel where it has no colours.
fn save(picture: RgbaImage, out: &Path) -> Result<(), image::ImageError> {
    let is_grey = picture.pixels().all(|image::Rgba([red, green, blue, _])| red == green && green == blue);
    let picture = DynamicImage::from(picture);
    if is_grey { picture.to_luma8().save(out) } else { picture.save(out) }
}
