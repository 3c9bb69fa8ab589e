//! How far each way to set skrifa up is from FreeType's default render.
//!
//! `cargo run --release -p nfr-convert --example teacher_settings -- [FONT.ttf ...]` prints, for printable ASCII at 8 to 64
//! pixels per em, the mean absolute error over the union of the two boxes, the share of pixels off by more than 16 of
//! 255, and the largest difference. Without arguments it takes the fonts that README speaks of.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::rc::Rc;

use freetype::RenderMode;
use freetype::face::LoadFlag;
use nfr::{Bitmap, Placement};
use nfr_convert::compare::metrics::Sums;
use nfr_convert::outline::Outline;
use read_fonts::{FontRef, TableProvider};
use skrifa::font::Font;
use skrifa::{DrawMemory, GlyphId, HintOptions, RasterTarget, ScalerFont};

fn main() -> Result<(), Box<dyn Error>> {
    let mut paths: Vec<String> = std::env::args().skip(1).collect();
    if paths.is_empty() {
        let shipped = ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"];
        paths = shipped.map(|name| format!("{}/fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"))).into();
    }
    let teacher = HintOptions::interpreter().with_classic_cleartype(true);
    let settings = [
        ("the teacher's settings", teacher),
        ("symmetric rendering off", teacher.with_symmetric_rendering(false)),
        ("linear metrics on", teacher.with_preserve_linear_metrics(true)),
        ("target light", teacher.with_target(RasterTarget::Light)),
        ("target lcd", teacher.with_target(RasterTarget::Lcd)),
        ("target mono", teacher.with_target(RasterTarget::Mono)),
        ("classic ClearType off", teacher.with_classic_cleartype(false)),
        ("autohinter", HintOptions::auto().with_classic_cleartype(true)),
    ];
    for path in paths {
        println!("{path}");
        let data = std::fs::read(&path)?;
        let font = Font::new(data.clone(), 0).ok_or("no font")?;
        let face = freetype::Library::init()?.new_memory_face(Rc::new(data.clone()), 0)?;
        let cmap = FontRef::new(&data)?.cmap()?;
        let gids: Vec<GlyphId> = ('!'..='~').filter_map(|c| cmap.map_codepoint(c)).collect();
        let mut sums = vec![Sums::default(); settings.len()];
        for ppem in 8..=64u16 {
            let truth = gids.iter().map(|gid| freetype_bitmap(&face, *gid, ppem));
            let truth = truth.collect::<Result<Vec<_>, _>>()?;
            for ((_, options), sums) in settings.iter().zip(&mut sums) {
                let scaler = ScalerFont::hinted(font.clone(), f32::from(ppem), *options);
                for (gid, truth) in gids.iter().zip(&truth) {
                    let mut outline = Outline::default();
                    let glyph = scaler.outline(*gid).ok_or("no such glyph")?;
                    glyph.draw(DrawMemory::Scratch, &mut outline)?;
                    sums.add(truth, &outline.rasterize()?);
                }
            }
        }
        for ((name, _), sums) in settings.iter().zip(&sums) {
            let figures = sums.figures();
            println!(
                "{name:24} mae {:.5}  bad16 {:.3} %  max {}",
                figures.mae,
                100.0 * figures.bad16,
                sums.max()
            );
        }
    }
    Ok(())
}

fn freetype_bitmap(face: &freetype::Face, gid: GlyphId, ppem: u16) -> Result<Bitmap, freetype::Error> {
    face.set_pixel_sizes(0, ppem.into())?;
    face.load_glyph(gid.to_u32(), LoadFlag::TARGET_NORMAL | LoadFlag::NO_BITMAP)?;
    let slot = face.glyph();
    slot.render_glyph(RenderMode::Normal)?;
    let bitmap = slot.bitmap();
    let (width, height) = (bitmap.width() as usize, bitmap.rows() as usize);
    let placement = Placement {
        left: slot.bitmap_left(),
        top: slot.bitmap_top(),
        width: width as u32,
        height: height as u32,
    };
    let rows = bitmap.buffer().chunks(bitmap.pitch().max(1) as usize).take(height);
    Ok(Bitmap { placement, pixels: rows.flat_map(|row| &row[..width]).copied().collect() })
}
