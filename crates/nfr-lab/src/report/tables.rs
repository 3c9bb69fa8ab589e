//! The report's tables as CSV.

use super::beside::CLAIMS;
use super::claims::{Claim, NOT_RUN};
use super::content::ReportContext;
use crate::error_table::{ErrorRow, code_point, csv_table, write_csv};
use crate::evaluation::{ClassAccuracy, Evaluation};
use crate::interpolation::Interpolation;
use crate::output::labelled;
use crate::study::{StoredResult, WrongPixel};
use nfr_convert::error::Error;

/// Every table: its file's name and its text.
pub(super) fn all(
    context: &ReportContext<'_>,
    claims: &[Claim],
) -> Result<Vec<(&'static str, String)>, Error> {
    let (label, results) = (context.label(), context.results);
    let of = |evaluations: &[Evaluation]| -> Vec<ErrorRow> {
        evaluations.iter().flat_map(|evaluation| evaluation.rows.clone()).collect()
    };
    let between = |all: &[Interpolation]| -> Vec<ErrorRow> {
        all.iter().flat_map(|one| one.ends.iter().chain(&one.between)).flat_map(|d| d.rows.clone()).collect()
    };
    let tables = [
        ("errors.csv", of(&results.evaluations)),
        ("ablations.csv", of(&results.ablations)),
        ("weights.csv", between(&results.weights)),
        ("styles.csv", between(&results.styles)),
        ("resizing.csv", results.resized.clone()),
        ("unhinted.csv", results.unhinted.clone()),
    ];
    let errors = tables.into_iter().map(|(name, rows)| Ok((name, write_csv(&rows)?)));
    let mut all = errors.collect::<Result<Vec<_>, Error>>()?;
    all.push(("stored.csv", stored(context)?));
    all.push(("wrong-pixel.csv", wrong_pixel(context)?));
    all.push(("trainings.csv", trainings(context)?));
    all.push((CLAIMS, claimed(context, claims)?));
    Ok(all.into_iter().map(|(name, table)| (name, labelled(&label, &table))).collect())
}

fn stored(context: &ReportContext<'_>) -> Result<String, Error> {
    let record = |one: &StoredResult| {
        let mse = [one.evaluation.mse(), one.mse_before].map(|mse| format!("{mse:e}"));
        let [mse, before] = mse;
        [code_point(one.glyph), one.bits.to_string(), one.bytes.to_string(), mse, before]
    };
    csv_table(["glyph", "bits", "bytes", "mse", "mse_before"], context.results.stored.iter().map(record))
}

fn wrong_pixel(context: &ReportContext<'_>) -> Result<String, Error> {
    let record = |one: &WrongPixel| {
        let [side, column, row] = [one.truth.side, one.at[0], one.at[1]].map(|number| number.to_string());
        [code_point(one.glyph), side, column, row, format!("{:e}", one.mse)]
    };
    csv_table(["glyph", "side", "column", "row", "mse"], context.results.wrong_pixel.iter().map(record))
}

fn trainings(context: &ReportContext<'_>) -> Result<String, Error> {
    let results = context.results;
    let trained = results.evaluations.iter().chain(&results.ablations).filter(|one| !one.history.is_empty());
    let record = |one: &Evaluation| {
        let loss = one.history.last().map_or(f64::NAN, |epoch| epoch.loss);
        let accuracy = one.class_accuracy.map(|ClassAccuracy { pixels, wrong, mse, rounding }| {
            [pixels.to_string(), wrong.to_string(), format!("{mse:e}"), format!("{rounding:e}")]
        });
        let [pixels, wrong, mse, rounding] = accuracy.unwrap_or_default();
        let epochs = one.history.len().to_string();
        let seconds = one.seconds().map_or_else(String::new, |seconds| format!("{seconds:.1}"));
        let origin = one.origin.as_ref();
        let device = origin.map_or_else(String::new, |origin| origin.device.clone());
        let together = origin.map_or_else(String::new, |origin| origin.together.to_string());
        let gigaflops =
            origin.map_or_else(String::new, |origin| (origin.operations / 1_000_000_000).to_string());
        let (model, font) = (one.model.clone(), one.font.clone());
        [
            model,
            font,
            code_point(one.glyph),
            epochs,
            seconds,
            device,
            together,
            gigaflops,
            format!("{loss:e}"),
            pixels,
            wrong,
            mse,
            rounding,
        ]
    };
    let header = [
        "model",
        "font",
        "glyph",
        "epochs",
        "seconds",
        "device",
        "together",
        "gflop",
        "loss",
        "pixels",
        "wrong_class",
        "class_mse",
        "rounding_mse",
    ];
    csv_table(header, trained.map(record))
}

fn claimed(context: &ReportContext<'_>, claims: &[Claim]) -> Result<String, Error> {
    let own =
        |claim: &Claim| [claim.statement.to_owned(), claim.measured.clone(), claim.verdict().to_owned()];
    let Some(other) = context.beside else {
        return csv_table(["claim", "measured", "verdict"], claims.iter().map(own));
    };
    let record = |claim: &Claim| {
        let [statement, measured, verdict] = own(claim);
        let (others, other_verdict) = other.claim(claim.statement).unwrap_or((NOT_RUN, ""));
        [statement, measured, verdict, others.to_owned(), other_verdict.to_owned()]
    };
    let [measured, verdict] = ["measured", "verdict"].map(|column| format!("{column} at {}", other.label));
    let header = ["claim", "measured", "verdict", &measured, &verdict];
    csv_table(header, claims.iter().map(record))
}
