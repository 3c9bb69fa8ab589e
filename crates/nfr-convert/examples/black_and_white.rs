//! Coverage at half as black and white, beside FreeType's monochrome bitmaps.
//!
//! `cargo run --release -p nfr-convert --example black_and_white -- [OUT.png]` converts printable ASCII of the fonts of the README's figures
//! for the target `mono`, 8 to 24 pixels per em, and counts the pixels that differ over the union of the two boxes: those that
//! only FreeType sets and those that only the threshold sets. FreeType hints with `FT_LOAD_TARGET_MONO` and draws with
//! `FT_RENDER_MODE_MONO`: it sets a pixel whose centre is inside, and its drop-out control fills gaps in thin strokes. The picture has
//! FreeType's text above ours, three times as large.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::rc::Rc;

use freetype::face::LoadFlag;
use freetype::{Face, RenderMode};
use image::{GrayImage, Luma};
use nfr::{Bitmap, Font, Placement, Rasterizer, Target};
use nfr_convert::compare::metrics::{coverage_at, union_box};
use nfr_convert::{Options, Progress, convert};
use read_fonts::{FontRef, TableProvider};

const FONTS: [&str; 3] = ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"];
const PPEM: std::ops::RangeInclusive<u16> = 8..=24;
/// The least coverage of a pixel that is set.
const HALF: u8 = 128;

struct Silent;
impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// Pixels, and how many of them differ.
#[derive(Default, Clone, Copy)]
struct Count {
    pixels: u64,
    only_freetype: u64,
    only_ours: u64,
}

impl Count {
    fn add(&mut self, freetype: &Bitmap, ours: &Bitmap) {
        let (columns, rows) = union_box(&freetype.placement, &ours.placement);
        for y in rows {
            for x in columns.clone() {
                let [theirs, ours] = [freetype, ours].map(|bitmap| coverage_at(bitmap, x, y) >= HALF);
                self.pixels += 1;
                self.only_freetype += u64::from(theirs && !ours);
                self.only_ours += u64::from(ours && !theirs);
            }
        }
    }

    fn merge(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.only_freetype += other.only_freetype;
        self.only_ours += other.only_ours;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut picture = Picture::new();
    println!("font                     ppem   pixels   differ     only FreeType  only ours");
    for name in FONTS {
        let data = std::fs::read(format!("{}/fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR")))?;
        let face = freetype::Library::init()?.new_memory_face(Rc::new(data.clone()), 0)?;
        let cmap = FontRef::new(&data)?.cmap()?;
        let mut gids: Vec<u16> =
            (' '..='~').filter_map(|c| u16::try_from(cmap.map_codepoint(c)?.to_u32()).ok()).collect();
        gids.sort_unstable();
        let options = Options { gids: gids.clone(), ppem: PPEM, target: Target::Mono, ..Options::default() };
        let font = Font::new(convert(&data, &options, &Silent)?.font)?;
        let mut rasterizer = Rasterizer::new(&font);
        let (mut all, mut worst) = (Count::default(), Vec::new());
        for ppem in PPEM {
            let mut count = Count::default();
            for gid in &gids {
                let before = count;
                count.add(
                    &monochrome(&face, *gid, ppem)?,
                    &rasterizer.render(u32::from(*gid), f32::from(ppem))?,
                );
                worst.push((
                    count.only_freetype + count.only_ours - before.only_freetype - before.only_ours,
                    ppem,
                    *gid,
                ));
            }
            print(name, &ppem.to_string(), count);
            all.merge(count);
        }
        print(name, "all", all);
        worst.sort_unstable();
        let worst: Vec<String> = worst
            .iter()
            .rev()
            .take(5)
            .map(|(n, ppem, gid)| format!("{n} in glyph {gid} at {ppem}"))
            .collect();
        println!("most: {}", worst.join(", "));
        picture.add(&face, &font, &mut rasterizer)?;
    }
    if let Some(path) = std::env::args().nth(1) {
        picture.image.save(path)?;
    }
    Ok(())
}

fn print(name: &str, ppem: &str, count: Count) {
    let share = |pixels: u64| 100.0 * pixels as f64 / count.pixels.max(1) as f64;
    println!(
        "{name:24} {ppem:>4} {:8} {:7.2} % {:12.2} % {:8.2} %",
        count.pixels,
        share(count.only_freetype + count.only_ours),
        share(count.only_freetype),
        share(count.only_ours)
    );
}

/// FreeType's bitmap of a glyph, hinted for and drawn in black and white: 255 where a pixel is set.
fn monochrome(face: &Face, gid: u16, ppem: u16) -> Result<Bitmap, freetype::Error> {
    face.set_pixel_sizes(0, ppem.into())?;
    face.load_glyph(gid.into(), LoadFlag::TARGET_MONO | LoadFlag::NO_BITMAP)?;
    let slot = face.glyph();
    slot.render_glyph(RenderMode::Mono)?;
    let bitmap = slot.bitmap();
    let (width, height) = (bitmap.width() as usize, bitmap.rows() as usize);
    let placement = Placement {
        left: slot.bitmap_left(),
        top: slot.bitmap_top(),
        width: width as u32,
        height: height as u32,
    };
    let rows = bitmap.buffer().chunks(bitmap.pitch().max(1) as usize).take(height);
    let level = |row: &[u8], x: usize| if row[x / 8] >> (7 - x % 8) & 1 == 1 { 255 } else { 0 };
    let pixels = rows.flat_map(|row| (0..width).map(move |x| level(row, x))).collect();
    Ok(Bitmap { placement, pixels })
}

/// Lines of text, FreeType's and ours in turn.
struct Picture {
    image: GrayImage,
    baseline: i64,
}

impl Picture {
    const TEXT: &str = "Sphinx of black quartz, judge my vow: 0123456789 @&%";
    const SCALE: u32 = 3;

    fn new() -> Self {
        Self { image: GrayImage::from_pixel(420 * Self::SCALE, 300 * Self::SCALE, Luma([255])), baseline: 2 }
    }

    fn add(&mut self, face: &Face, font: &Font, rasterizer: &mut Rasterizer) -> Result<(), Box<dyn Error>> {
        for ppem in [9u16, 12, 16] {
            for freetype in [true, false] {
                self.baseline += i64::from(ppem) + 2;
                let mut pen = 4;
                for glyph in Self::TEXT.chars().filter_map(|c| font.glyph_for_char(c)) {
                    let ours = rasterizer.render(glyph, f32::from(ppem))?;
                    let bitmap = if freetype { monochrome(face, glyph as u16, ppem)? } else { ours };
                    self.set(&bitmap, pen);
                    pen += rasterizer.hinted_advance(glyph, f32::from(ppem))?.round() as i64;
                }
            }
            self.baseline += 4;
        }
        Ok(())
    }

    fn set(&mut self, bitmap: &Bitmap, pen: i64) {
        let (columns, rows) = union_box(&bitmap.placement, &Placement::default());
        for y in rows {
            for x in columns.clone().filter(|x| coverage_at(bitmap, *x, y) >= HALF) {
                let [x, y] = [pen + x, self.baseline + y].map(|at| at as u32 * Self::SCALE);
                for at in 0..Self::SCALE * Self::SCALE {
                    if let Some(pixel) =
                        self.image.get_pixel_mut_checked(x + at % Self::SCALE, y + at / Self::SCALE)
                    {
                        *pixel = Luma([0]);
                    }
                }
            }
        }
    }
}
