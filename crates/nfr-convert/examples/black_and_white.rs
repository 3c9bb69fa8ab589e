//! Black and white beside FreeType's.
//!
//! `cargo run --release -p nfr-convert --example black_and_white -- [OUT.png]` converts printable ASCII of the fonts of the README's figures
//! for the target `mono`, 8 to 24 pixels per em, and counts the pixels that differ over the union of the two boxes. FreeType hints with
//! `FT_LOAD_TARGET_MONO` and draws with `FT_RENDER_MODE_MONO`: it sets a pixel whose centre is inside, and its drop-out control fills gaps
//! in thin strokes. Compared with it are
//!
//! - the grey bitmap, black from half coverage on;
//! - `Rasterizer::draw_mono`;
//! - the models' points drawn by FreeType: what is left is the models', not the rasteriser's.
//!
//! `--quality N` converts with another quality than the default. The picture has FreeType's text above ours, three times as large.

#![allow(clippy::print_stdout)]

#[path = "../tests/samples/freetype_mono.rs"]
mod freetype_mono;

use std::error::Error;
use std::rc::Rc;

use freetype::Face;
use freetype::face::LoadFlag;
use freetype_mono::{monochrome, moved};
use image::{GrayImage, Luma};
use nfr::internals::decode;
use nfr::{Bitmap, Font, MonoBitmap, Placement, Rasterizer, Target};
use nfr_convert::compare::metrics::{coverage_at, union_box};
use nfr_convert::{Options, Progress, Quality, convert};
use read_fonts::{FontRef, TableProvider};

const FONTS: [&str; 3] = ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"];
const PPEM: std::ops::RangeInclusive<u16> = 8..=24;
/// The least coverage of a pixel that is set.
const HALF: u8 = 128;
/// What is compared with FreeType.
const WAYS: [&str; 3] = ["half coverage", "draw_mono", "FreeType on our points"];

struct Silent;
impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// Pixels, and how many of them differ.
#[derive(Default, Clone, Copy)]
struct Count {
    pixels: u64,
    differ: u64,
}

impl Count {
    fn add(&mut self, theirs: &Bitmap, ours: &Bitmap) {
        let (columns, rows) = union_box(&theirs.placement, &ours.placement);
        for y in rows {
            for x in columns.clone() {
                let [theirs, ours] = [theirs, ours].map(|bitmap| coverage_at(bitmap, x, y) >= HALF);
                self.pixels += 1;
                self.differ += u64::from(theirs != ours);
            }
        }
    }

    fn share(self) -> f64 {
        100.0 * self.differ as f64 / self.pixels.max(1) as f64
    }

    fn merge(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.differ += other.differ;
    }
}

/// Where a font's bitmaps come from.
struct Drawn {
    face: Face,
    font: Font,
    rasterizer: Rasterizer,
}

impl Drawn {
    fn new(data: &[u8], gids: &[u16], quality: Option<Quality>) -> Result<Self, Box<dyn Error>> {
        let face = freetype::Library::init()?.new_memory_face(Rc::new(data.to_vec()), 0)?;
        let mut options =
            Options { gids: gids.to_vec(), ppem: PPEM, target: Target::Mono, ..Options::default() };
        if let Some(quality) = quality {
            options = options.with_quality(quality);
        }
        let font = Font::new(convert(data, &options, &Silent)?.font)?;
        let rasterizer = Rasterizer::new(&font);
        Ok(Self { face, font, rasterizer })
    }

    fn theirs(&self, gid: u16, ppem: u16) -> Result<Bitmap, Box<dyn Error>> {
        Ok(unpacked(&monochrome(&self.face, gid, ppem, LoadFlag::TARGET_MONO)?))
    }

    fn ours(&mut self, gid: u16, ppem: u16) -> Result<Bitmap, Box<dyn Error>> {
        Ok(unpacked(&self.rasterizer.render_mono(gid.into(), f32::from(ppem))?))
    }

    fn ways(&mut self, gid: u16, ppem: u16) -> Result<[Bitmap; 3], Box<dyn Error>> {
        let grey = self.rasterizer.render(u32::from(gid), f32::from(ppem))?;
        let outline = decode(&self.font, gid.into())?.hinted_outline(ppem.into()).ok_or("no outline")?;
        let floor = moved(&self.face, gid, ppem, &outline)?.ok_or("FreeType has other points")?;
        Ok([grey, self.ours(gid, ppem)?, unpacked(&floor)])
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (quality, path) = match arguments.as_slice() {
        [option, value, rest @ ..] if option == "--quality" => {
            (Some(Quality::new(value.parse()?).ok_or("quality is 0 to 100")?), rest.first())
        }
        rest => (None, rest.first()),
    };
    let mut picture = Picture::new();
    println!("pixels that differ from FreeType's: {}", WAYS.join(" | "));
    for name in FONTS {
        let data = std::fs::read(format!("{}/fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR")))?;
        let cmap = FontRef::new(&data)?.cmap()?;
        let mut gids: Vec<u16> =
            (' '..='~').filter_map(|c| u16::try_from(cmap.map_codepoint(c)?.to_u32()).ok()).collect();
        gids.sort_unstable();
        let mut drawn = Drawn::new(&data, &gids, quality)?;
        let (mut all, mut worst) = ([Count::default(); 3], Vec::new());
        for ppem in PPEM {
            let mut counts = [Count::default(); 3];
            for gid in &gids {
                let theirs = drawn.theirs(*gid, ppem)?;
                let before = counts[1].differ;
                for (count, ours) in counts.iter_mut().zip(drawn.ways(*gid, ppem)?) {
                    count.add(&theirs, &ours);
                }
                worst.push((counts[1].differ - before, ppem, *gid));
            }
            print(name, &ppem.to_string(), &counts);
            all.iter_mut().zip(counts).for_each(|(all, count)| all.merge(count));
        }
        print(name, "all", &all);
        println!("{} bytes in the table", drawn.font.table_len());
        worst.sort_unstable();
        let worst: Vec<String> = worst
            .iter()
            .rev()
            .take(5)
            .map(|(n, ppem, gid)| format!("{n} in glyph {gid} at {ppem}"))
            .collect();
        println!("most: {}", worst.join(", "));
        picture.add(&mut drawn)?;
    }
    if let Some(path) = path {
        picture.image.save(path)?;
    }
    Ok(())
}

fn print(name: &str, ppem: &str, counts: &[Count; 3]) {
    let shares = counts.map(|count| format!("{:6.3} %", count.share()));
    println!("{name:24} {ppem:>4} {:8} pixels  {}", counts[1].pixels, shares.join(" | "));
}

/// A byte a pixel: 255 where it is black.
fn unpacked(bitmap: &MonoBitmap) -> Bitmap {
    let Placement { width, height, .. } = bitmap.placement;
    let level = |x, y| if bitmap.is_black(x, y) { 255 } else { 0 };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| level(x, y))).collect();
    Bitmap { placement: bitmap.placement, pixels }
}

/// Lines of text, FreeType's and ours in turn.
struct Picture {
    image: GrayImage,
    baseline: i64,
}

impl Picture {
    const TEXT: &str = "Sphinx of black quartz, judge my vow: 0123456789 @&%";
    const SIZES: [u16; 5] = [9, 10, 12, 14, 16];
    const SCALE: u32 = 3;

    fn new() -> Self {
        Self { image: GrayImage::from_pixel(430 * Self::SCALE, 450 * Self::SCALE, Luma([255])), baseline: 2 }
    }

    fn add(&mut self, drawn: &mut Drawn) -> Result<(), Box<dyn Error>> {
        for ppem in Self::SIZES {
            for freetype in [true, false] {
                self.baseline += i64::from(ppem) + 2;
                let mut pen = 4;
                let font = drawn.font.clone();
                for glyph in Self::TEXT.chars().filter_map(|c| font.glyph_for_char(c)) {
                    let gid = u16::try_from(glyph)?;
                    let bitmap = if freetype { drawn.theirs(gid, ppem)? } else { drawn.ours(gid, ppem)? };
                    self.set(&bitmap, pen);
                    pen += drawn.rasterizer.hinted_advance(glyph, f32::from(ppem))?.round() as i64;
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
