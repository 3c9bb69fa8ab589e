//! Errors, bytes and time of a conversion.

use std::collections::BTreeSet;
use std::error::Error;
use std::path::Path;
use std::thread::available_parallelism;

use nfr_convert::Error as ConvertError;
use nfr_convert::compare::diff::{Sources, Tallies, TallyPair, compare};
use nfr_convert::compare::metrics::Figures;
use nfr_convert::open::owned;
use read_fonts::TableProvider;
use read_fonts::tables::glyf::Glyph;
use serde_json::Value;

use crate::autohinted::Autohinted;
use crate::typeface::Typeface;

/// Sizes, in pixels per em, over which errors are summed.
const SIZES: std::ops::RangeInclusive<u16> = 9..=24;

/// Cells of two Markdown tables. Errors: glyphs of the text; mae and bad16 from the models, unhinted and autohinted. Costs: glyphs with models,
/// bytes of their table, of the hint programs of the same glyphs with the programs and values that all share, of all hint programs; seconds.
pub(crate) fn cells(
    typeface: &Typeface<'_>,
    text: &str,
    report: &Path,
) -> Result<[String; 2], Box<dyn Error>> {
    let report: Value = serde_json::from_slice(
        &std::fs::read(report).map_err(|e| format!("cannot read {} ({e})", report.display()))?,
    )?;
    let bytes = |pointer: &str| {
        report.pointer(pointer).and_then(Value::as_u64).ok_or(format!("the report has no {pointer}"))
    };
    let shaped = typeface.shape(text)?;
    let gids: Vec<u16> =
        shaped.glyphs().iter().map(|glyph| glyph.gid).collect::<BTreeSet<_>>().into_iter().collect();
    let [neural, unhinted, autohinted] = errors(typeface, &gids)?;
    let errors = [
        gids.len().to_string(),
        format!("{:.5}", neural.mae),
        format!("{:.4}", unhinted.mae),
        format!("{:.4}", autohinted.mae),
        format!("{:.3} %", 100.0 * neural.bad16),
        format!("{:.1} %", 100.0 * unhinted.bad16),
        format!("{:.1} %", 100.0 * autohinted.bad16),
    ];
    let shared = bytes("/hint_bytes/total")? - bytes("/hint_bytes/glyph_programs")?;
    let costs = [
        typeface.pair.font().modelled_glyphs().count().to_string(),
        thousands(bytes("/table_bytes")?),
        thousands(program_bytes(typeface)? + shared),
        thousands(bytes("/hint_bytes/total")?),
        format!("{:.1} s", report["seconds"].as_f64().ok_or("the report has no time")?),
    ];
    Ok([errors.join(" | "), costs.join(" | ")])
}

/// A number with commas, as README has them.
fn thousands(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", thousands(number / 1000), number % 1000),
    }
}

/// Errors against the hinted bitmaps: from the models, unhinted, autohinted.
fn errors(typeface: &Typeface<'_>, gids: &[u16]) -> Result<[Figures; 3], Box<dyn Error>> {
    let sizes: Vec<u16> = SIZES.collect();
    let jobs = available_parallelism()?.get();
    let autohinter = Autohinted(owned(typeface.pair.original())?);
    let compared = typeface.pair.with_sources(gids, |sources| {
        let autohinted = compare(Sources { neural: &autohinter, ..sources }, gids, &sizes, jobs)?;
        Ok::<_, ConvertError>((total(&compare(sources, gids, &sizes, jobs)?), total(&autohinted)))
    });
    let (models, autohinted) = compared?;
    Ok([models.neural, models.unhinted, autohinted.neural].map(|tally| tally.sums.figures()))
}

fn total(tallies: &Tallies) -> TallyPair {
    let mut total = TallyPair::default();
    tallies.by_ppem.values().for_each(|pair| total.merge(pair));
    total
}

/// Bytes of the hint programs of the glyphs that have models.
fn program_bytes(typeface: &Typeface<'_>) -> Result<u64, Box<dyn Error>> {
    let font = typeface.pair.original();
    let (loca, glyf) = (font.loca(None)?, font.glyf()?);
    let mut bytes = 0usize;
    for gid in typeface.pair.font().modelled_glyphs() {
        bytes += match loca.get_glyf(gid.into(), &glyf)? {
            Some(Glyph::Simple(glyph)) => glyph.instructions().len(),
            Some(Glyph::Composite(glyph)) => glyph.instructions().map_or(0, <[u8]>::len),
            None => 0,
        };
    }
    Ok(bytes as u64)
}
