//! What `nfr-convert` tells of a conversion: as text, and as the file of `--report`.

use std::fmt::{self, Write};

use serde::{Serialize, Serializer};

use nfr_convert::compare::report::{Report, glyph_count_text};
use nfr_convert::{Conversion, GlyphReport, Hinter};

/// The files and options of a conversion.
#[derive(Debug, Serialize)]
pub(super) struct About {
    pub(super) input: String,
    pub(super) output: String,
    /// The neural font that the models were added to.
    pub(super) into: Option<String>,
    /// Of the font in the input.
    pub(super) index: u32,
    /// Where the input is a variable font, the place of its instance.
    pub(super) instance: Option<String>,
    pub(super) target: &'static str,
    #[serde(serialize_with = "hinter_name")]
    pub(super) hinter: Hinter,
    pub(super) ppem: String,
    pub(super) seed: u64,
}

fn hinter_name<S: Serializer>(hinter: &Hinter, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(hinter.name())
}

/// The contents of the file of `--report`.
#[derive(Debug, Serialize)]
pub(super) struct ReportFile<'r> {
    #[serde(flatten)]
    about: About,
    glyphs: Vec<GlyphEntry>,
    /// The glyphs that have no model.
    left_out: &'r [u16],
    table_bytes: usize,
    bytes_per_glyph: f64,
    /// The hint programs that the table stands in place of.
    hint_bytes: HintBytesEntry,
    input_bytes: usize,
    output_bytes: usize,
    mae: f64,
    bad16: f64,
    seconds: f64,
    /// The comparison of the written font with its original.
    comparison: &'r Report,
}

#[derive(Debug, Serialize)]
struct HintBytesEntry {
    glyph_programs: usize,
    fpgm: usize,
    prep: usize,
    cvt: usize,
    total: usize,
}

#[derive(Debug, Serialize)]
struct GlyphEntry {
    gid: u16,
    bytes: usize,
    composed: bool,
    mae: f64,
    bad16: f64,
}

/// What is told of a conversion.
pub(super) fn report<'r>(
    about: About,
    input: &[u8],
    conversion: &'r Conversion,
    comparison: &'r Report,
    seconds: f64,
) -> ReportFile<'r> {
    let glyph = |g: &GlyphReport| GlyphEntry {
        gid: g.gid,
        bytes: g.bytes,
        composed: g.composed,
        mae: g.mae,
        bad16: g.bad16,
    };
    let figures = &comparison.totals.neural.figures;
    let hints = &conversion.hint_bytes;
    ReportFile {
        about,
        glyphs: conversion.glyphs.iter().map(glyph).collect(),
        left_out: &conversion.left_out,
        table_bytes: conversion.table_bytes,
        bytes_per_glyph: comparison.header.bytes_per_glyph,
        hint_bytes: HintBytesEntry {
            glyph_programs: hints.glyph_programs,
            fpgm: hints.fpgm,
            prep: hints.prep,
            cvt: hints.cvt,
            total: hints.total(),
        },
        input_bytes: input.len(),
        output_bytes: conversion.font.len(),
        mae: figures.mae,
        bad16: figures.bad16,
        seconds,
        comparison,
    }
}

/// The same for people. `added` glyphs were not named: layout and composites need them.
pub(super) fn summary_text(report: &ReportFile<'_>, added: usize) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_summary(&mut text, report, added);
    text
}

fn write_summary(out: &mut String, report: &ReportFile<'_>, added: usize) -> fmt::Result {
    let unhinted = &report.comparison.totals.unhinted.figures;
    let added = match added {
        0 => String::new(),
        count => format!(", {count} of them for layout, composites, .notdef and the space"),
    };
    let composed = match report.glyphs.iter().filter(|glyph| glyph.composed).count() {
        0 => String::new(),
        count => format!(", {count} of them put together from others"),
    };
    let count = glyph_count_text(report.glyphs.len());
    let into = report.about.into.as_ref().map_or(String::new(), |path| format!(" beside those of {path}"));
    writeln!(out, "{}: {count}{into} at {} ppem{composed}{added}", report.about.output, report.about.ppem)?;
    if let Some(instance) = &report.about.instance {
        writeln!(out, "source  the instance {instance} of a variable font")?;
    }
    if report.about.hinter == Hinter::Auto {
        writeln!(out, "teacher skrifa's autohinter")?;
    }
    writeln!(out, "table   {} bytes, {:.1} per glyph", report.table_bytes, report.bytes_per_glyph)?;
    let hints = &report.hint_bytes;
    if hints.total == 0 {
        let line = match report.about.hinter {
            Hinter::Font => "PostScript hints are left out with the charstrings",
            Hinter::Auto => "no hint programs in the original",
        };
        writeln!(out, "hints   {line}")?;
    } else {
        writeln!(
            out,
            "hints   {} bytes left out: {} of glyph programs, {} of fpgm, {} of prep, {} of cvt",
            hints.total, hints.glyph_programs, hints.fpgm, hints.prep, hints.cvt
        )?;
    }
    let percent = 100.0 * report.output_bytes as f64 / report.input_bytes.max(1) as f64;
    writeln!(
        out,
        "file    {} bytes, {percent:.1} % of the original's {}",
        report.output_bytes, report.input_bytes
    )?;
    writeln!(out, "mae     {:.5} (unhinted {:.5})", report.mae, unhinted.mae)?;
    writeln!(out, "bad16   {:.2} % (unhinted {:.2} %)", 100.0 * report.bad16, 100.0 * unhinted.bad16)?;
    writeln!(out, "time    {:.1} s", report.seconds)
}
