//! The report's tables as CSV.

use std::fmt::Write;

use super::super::error::{ErrorRow, write_csv};
use super::super::interpolation::Interpolation;
use super::super::output::labelled;
use super::super::single::{Choices, Outcome};
use super::{Claim, Part};
use nfr_convert::error::Error;

/// Every table: its file's name and its text.
pub(super) fn all(part: &Part<'_>, claims: &[Claim]) -> Result<Vec<(&'static str, String)>, Error> {
    let (label, f) = (part.label(), part.findings);
    let of = |outcomes: &[Outcome]| -> Vec<ErrorRow> {
        outcomes.iter().flat_map(|outcome| outcome.rows.clone()).collect()
    };
    let between = |all: &[Interpolation]| -> Vec<ErrorRow> {
        all.iter().flat_map(|one| one.ends.iter().chain(&one.between)).flat_map(|d| d.rows.clone()).collect()
    };
    let tables = [
        ("errors.csv", of(&f.outcomes)),
        ("ablations.csv", of(&f.ablations)),
        ("weights.csv", between(&f.weights)),
        ("styles.csv", between(&f.styles)),
        ("resizing.csv", f.resized.clone()),
        ("unhinted.csv", f.unhinted.clone()),
    ];
    let errors = tables.into_iter().map(|(name, rows)| Ok((name, write_csv(&rows)?)));
    let mut all = errors.collect::<Result<Vec<_>, Error>>()?;
    all.push(("stored.csv", stored(part)));
    all.push(("wrong-pixel.csv", wrong_pixel(part)));
    all.push(("trainings.csv", trainings(part)));
    all.push(("claims.csv", claimed(claims)));
    Ok(all.into_iter().map(|(name, table)| (name, labelled(&label, &table))).collect())
}

fn stored(part: &Part<'_>) -> String {
    let mut table = "glyph,bits,bytes,mse,mse_before\n".to_owned();
    for one in &part.findings.stored {
        // A string takes everything that is written to it, here and below.
        let (code, mse) = (u32::from(one.glyph), one.outcome.mse());
        let _ = writeln!(table, "U+{code:04X},{},{},{mse:e},{:e}", one.bits, one.bytes, one.before);
    }
    table
}

fn wrong_pixel(part: &Part<'_>) -> String {
    let mut table = "glyph,side,column,row,mse\n".to_owned();
    for one in &part.findings.wrong_pixel {
        let ([column, row], side) = (one.at, one.truth.side);
        let _ = writeln!(table, "U+{:04X},{side},{column},{row},{:e}", u32::from(one.glyph), one.mse);
    }
    table
}

fn trainings(part: &Part<'_>) -> String {
    let mut table =
        "model,font,glyph,epochs,seconds,loss,pixels,wrong_class,class_mse,rounding_mse\n".to_owned();
    let f = part.findings;
    for one in f.outcomes.iter().chain(&f.ablations).filter(|outcome| !outcome.history.is_empty()) {
        let loss = one.history.last().map_or(f64::NAN, |epoch| epoch.loss);
        let (code, epochs, seconds) = (u32::from(one.glyph), one.history.len(), one.seconds());
        let choices = one.choices.map_or(",,,".into(), |Choices { pixels, wrong, mse, rounding }| {
            format!("{pixels},{wrong},{mse:e},{rounding:e}")
        });
        let _ = writeln!(
            table,
            "{},{},U+{code:04X},{epochs},{seconds:.1},{loss:e},{choices}",
            one.model, one.font
        );
    }
    table
}

fn claimed(claims: &[Claim]) -> String {
    let mut table = "claim,measured,verdict\n".to_owned();
    for claim in claims {
        let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
        let _ = writeln!(table, "{},{},{}", quoted(claim.said), quoted(&claim.measured), claim.verdict());
    }
    table
}
