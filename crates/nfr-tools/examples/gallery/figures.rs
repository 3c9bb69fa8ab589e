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

/// Cells of a Markdown table: glyphs of the text; mae and bad16 from the models, unhinted and autohinted; glyphs with models, bytes of
/// their table, of the hint programs of the same glyphs with the programs and values that all share, of all hint programs; seconds.
pub(crate) fn cells(typeface: &Typeface<'_>, text: &str, report: &Path) -> Result<String, Box<dyn Error>> {
    let report: Value = serde_json::from_slice(
        &std::fs::read(report).map_err(|e| format!("cannot read {} ({e})", report.display()))?,
    )?;
    let number = |pointer: &str| {
        report.pointer(pointer).and_then(Value::as_f64).ok_or(format!("no {pointer} in the report"))
    };
    let shaped = typeface.shape(text)?;
    let gids: Vec<u16> =
        shaped.glyphs().iter().map(|glyph| glyph.gid).collect::<BTreeSet<_>>().into_iter().collect();
    let [neural, unhinted, autohinted] = errors(typeface, &gids)?;
    let models = typeface.pair.font().modelled_glyphs().count();
    let shared = number("/hint_bytes/total")? - number("/hint_bytes/glyph_programs")?;
    let cells = [
        gids.len().to_string(),
        format!("{:.5}", neural.mae),
        format!("{:.4}", unhinted.mae),
        format!("{:.4}", autohinted.mae),
        format!("{:.3} %", 100.0 * neural.bad16),
        format!("{:.1} %", 100.0 * unhinted.bad16),
        format!("{:.1} %", 100.0 * autohinted.bad16),
        format!("{} ({models})", number("/table_bytes")?),
        (program_bytes(typeface)? as f64 + shared).to_string(),
        number("/hint_bytes/total")?.to_string(),
        format!("{:.1} s", number("/seconds")?),
    ];
    Ok(cells.join(" | "))
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
fn program_bytes(typeface: &Typeface<'_>) -> Result<usize, Box<dyn Error>> {
    let font = typeface.pair.original();
    let (loca, glyf) = (font.loca(None)?, font.glyf()?);
    let mut bytes = 0;
    for gid in typeface.pair.font().modelled_glyphs() {
        bytes += match loca.get_glyf(gid.into(), &glyf)? {
            Some(Glyph::Simple(glyph)) => glyph.instructions().len(),
            Some(Glyph::Composite(glyph)) => glyph.instructions().map_or(0, <[u8]>::len),
            None => 0,
        };
    }
    Ok(bytes)
}
