//! The time of a shaped page of 2,000 glyphs, from the font's bytes to pixels, beside cosmic-text with swash, hinted.
//!
//! `cargo run --release -p nfr-cosmic --example speed`. Cold: the text is laid out, but no glyph of it was ever drawn, so that the
//! time has the opening of the font's models and of its hint programs. Warm: all images are cached, and are drawn onto the page. Both
//! draw onto the same kind of canvas, in turn; medians.

#![allow(clippy::print_stdout)]

mod common;

use std::collections::HashSet;
use std::error::Error;

use common::{Drawing, Setting, converted, font, median_time};
use cosmic_text::{CacheKey, CacheKeyFlags, SwashCache};
use image::RgbaImage;
use nfr_cosmic::NeuralFonts;

const WORDS: &str = "A page of plain text has some forty letters. Each of them stands at one of four places between pixels, \
    so that a hundred pairs are drawn, and then the same again and again. ";
const GLYPHS: usize = 2000;
/// Distinct pairs of a glyph and a subpixel offset on the page.
const PAIRS: usize = 100;
const WIDTH: u32 = 600;
const SIZES: [f32; 3] = [12.0, 16.0, 24.0];
/// Turns of each of the two, and passes in a turn.
const TURNS: usize = 15;
const PASSES: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let original = font("LiberationSans-Regular")?;
    let neural = converted(&original, WORDS)?;
    println!("{GLYPHS} glyphs, milliseconds");
    println!("ppem  pairs   cold: models  swash  ratio   warm: models  swash  ratio");
    for size in SIZES {
        let text: String = WORDS.chars().cycle().take(GLYPHS).collect();
        let mut pages = [(&neural, Drawing::Models), (&original, Drawing::Swash)].map(|(font, drawing)| {
            let mut setting = Setting::new(std::iter::once(font.clone()), WIDTH);
            setting.add(&text, &[size], CacheKeyFlags::empty());
            (setting, drawing)
        });
        let pairs: HashSet<CacheKey> = pages[0].0.keys().collect();
        assert!(pairs.len() >= PAIRS, "{} pairs", pairs.len());
        let mut picture = RgbaImage::from_pixel(WIDTH, pages[0].0.height(), image::Rgba([255; 4]));
        let mut times = [const { Vec::new() }; 4];
        for _ in 0..TURNS {
            for (number, (setting, drawing)) in pages.iter_mut().enumerate() {
                let mut caches = (NeuralFonts::new(), SwashCache::new());
                times[number].push(median_time(PASSES, || {
                    caches = (NeuralFonts::new(), SwashCache::new());
                    setting.draw(*drawing, &mut picture, [0, 0], &mut caches);
                }));
                times[2 + number]
                    .push(median_time(PASSES, || setting.draw(*drawing, &mut picture, [0, 0], &mut caches)));
            }
        }
        let [a, b, c, d] = times.map(|mut times: Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2] * 1e3
        });
        println!(
            "{size:4}  {:5}   {a:12.2}  {b:5.2}  {:5.2}   {c:12.2}  {d:5.2}  {:5.2}",
            pairs.len(),
            a / b,
            c / d
        );
    }
    Ok(())
}
