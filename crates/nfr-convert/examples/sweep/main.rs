//! One face of the sweep over other people's fonts: converts 16 of its glyphs and compares them.
//!
//! `cargo run --release -p nfr-convert --example sweep -- FONT.ttf [INDEX]` prints one JSON object. `tools/sweep/run` runs it over the fonts of
//! Debian's packages, a process a face, and writes `docs/sweep.md`. Glyphs are chosen as `choice` says, converted at 9 to 24 pixels
//! per em for the targets smooth and mono, and drawn by the library. Their errors are those against skrifa's hinted output (the
//! teacher, as `docs/upstream.md` describes it) and against FreeType's, each beside the error of the unhinted outline.

#![allow(clippy::print_stdout)]

mod choice;
#[path = "../../tests/samples/freetype_bitmap.rs"]
mod freetype_bitmap;
mod judge;
mod overlap;
mod warnings;

use std::error::Error;
use std::rc::Rc;
use std::time::Instant;

use nfr::Target;
use nfr_convert::{Options, Shape, convert};
use read_fonts::tables::glyf::Glyph;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use serde::Serialize;

use choice::Chosen;
use judge::{Judged, Original};
use warnings::Warnings;

/// The sizes that are converted and compared, in pixels per em: those at which hinting matters most.
const PPEM: std::ops::RangeInclusive<u16> = 9..=24;

/// What is told of a face.
#[derive(Serialize)]
struct Face {
    glyph_count: u16,
    units_per_em: u16,
    hints: Hints,
    /// Glyphs that FreeType would draw from samples, since flags say that their contours overlap; the flags are cleared for it.
    overlapping: usize,
    /// The glyphs that were chosen, and their characters.
    glyphs: Vec<Chosen>,
    smooth: Outcome,
    mono: Outcome,
}

/// What there is of hints.
#[derive(Serialize)]
struct Hints {
    /// Bytes of the font program.
    fpgm: usize,
    /// Bytes of the program that prepares a size.
    prep: usize,
    /// Glyphs that have programs.
    programs: usize,
}

/// A conversion, or why there is none.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Outcome {
    Refused(String),
    Converted(Converted),
    /// The font that was written does not open, or a glyph of it is not drawn.
    Broken(String),
}

#[derive(Serialize)]
struct Converted {
    seconds: f64,
    table_bytes: usize,
    /// Chosen glyphs that have no model.
    left_out: Vec<u16>,
    warnings: Vec<String>,
    #[serde(flatten)]
    judged: Judged,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("pass a font file, and its index in a collection")?;
    let index: u32 = arguments.next().map_or(Ok(0), |index| index.parse())?;
    let data = std::fs::read(path)?;
    let font = FontRef::from_index(&data, index)?;
    let glyphs = choice::choose(&font)?;
    let (for_freetype, overlapping) = overlap::without_flags(&font, &data);
    let for_freetype = Rc::new(for_freetype);
    let original = Original { data: &data, index, for_freetype: &for_freetype };
    let face = Face {
        glyph_count: font.maxp()?.num_glyphs(),
        units_per_em: font.head()?.units_per_em(),
        hints: hints(&font)?,
        overlapping,
        smooth: outcome(&original, &glyphs, Target::Smooth),
        mono: outcome(&original, &glyphs, Target::Mono),
        glyphs,
    };
    println!("{}", serde_json::to_string(&face)?);
    Ok(())
}

fn hints(font: &FontRef<'_>) -> Result<Hints, Box<dyn Error>> {
    let bytes = |tag: &[u8; 4]| font.table_data(Tag::new(tag)).map_or(0, |table| table.len());
    let has_program = |glyph: Option<Glyph<'_>>| match glyph {
        Some(Glyph::Simple(simple)) => !simple.instructions().is_empty(),
        Some(Glyph::Composite(composite)) => composite.instructions().is_some_and(|code| !code.is_empty()),
        None => false,
    };
    let mut programs = 0;
    if let (Ok(loca), Ok(glyf)) = (font.loca(None), font.glyf()) {
        let glyphs = (0..u32::from(font.maxp()?.num_glyphs())).map(|gid| loca.get_glyf(gid.into(), &glyf));
        programs = glyphs.filter(|glyph| matches!(glyph, Ok(glyph) if has_program(glyph.clone()))).count();
    }
    Ok(Hints { fpgm: bytes(b"fpgm"), prep: bytes(b"prep"), programs })
}

/// Converts and compares for one target.
fn outcome(original: &Original<'_>, glyphs: &[Chosen], target: Target) -> Outcome {
    let mut gids: Vec<u16> = glyphs.iter().map(|glyph| glyph.gid).collect();
    gids.sort_unstable();
    // Fields take minutes of training, and a build with the feature `train`.
    let index = original.index;
    let options = Options { index, gids, ppem: PPEM, target, shape: Shape::Outline, ..Options::default() };
    let (warnings, began) = (Warnings::default(), Instant::now());
    let conversion = match convert(original.data, &options, &warnings) {
        Ok(conversion) => conversion,
        Err(error) => return Outcome::Refused(error.to_string()),
    };
    let seconds = began.elapsed().as_secs_f64();
    let converted: Vec<Chosen> =
        glyphs.iter().filter(|glyph| !conversion.left_out.contains(&glyph.gid)).copied().collect();
    let judged = match judge::judge(original, conversion.font, &converted, target, PPEM, &warnings) {
        Ok(judged) => judged,
        Err(error) => return Outcome::Broken(error.to_string()),
    };
    Outcome::Converted(Converted {
        seconds,
        table_bytes: conversion.table_bytes,
        left_out: conversion.left_out,
        warnings: warnings.texts(),
        judged,
    })
}
