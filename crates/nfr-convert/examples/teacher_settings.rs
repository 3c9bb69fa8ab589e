//! The difference of skrifa's settings from FreeType's default render.
//!
//! `cargo run --release -p nfr-convert --example teacher_settings -- [FONT.ttf ...]` prints, for printable ASCII at 8 to 64
//! pixels per em, the mean absolute error over the union of the two boxes, the share of pixels off by more than 16 of
//! 255, and the largest difference. Without arguments it takes the fonts of the README's figures.

#![allow(clippy::print_stdout)]

#[path = "../tests/samples/freetype_bitmap.rs"]
mod freetype_bitmap;

use std::error::Error;
use std::rc::Rc;

use freetype::face::LoadFlag;
use freetype_bitmap::freetype_bitmap;
use nfr_convert::compare::metrics::Sums;
use nfr_convert::teacher::Outline;
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
        let gids = ('!'..='~').filter_map(|c| cmap.map_codepoint(c));
        let gids: Vec<u16> = gids.filter_map(|gid| u16::try_from(gid.to_u32()).ok()).collect();
        let mut sums = vec![Sums::default(); settings.len()];
        for ppem in 8..=64u16 {
            let truth = gids.iter().map(|gid| freetype_bitmap(&face, *gid, ppem, LoadFlag::TARGET_NORMAL));
            let truth = truth.collect::<Result<Vec<_>, _>>()?;
            for ((_, options), sums) in settings.iter().zip(&mut sums) {
                let scaler = ScalerFont::hinted(font.clone(), f32::from(ppem), *options);
                for (gid, truth) in gids.iter().zip(&truth) {
                    let mut outline = Outline::default();
                    let glyph = scaler.outline(GlyphId::from(*gid)).ok_or("no such glyph")?;
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
