//! The files beside a checkpoint: the training's history, its errors, and pictures of its bitmaps.

use std::fmt::Write;
use std::path::Path;

use image::RgbImage;
use serde::Serialize;

use super::SquareBitmap;
use super::charts::{Headings, Line, loss_history};
use super::error_table::{csv_table, write_csv};
use super::evaluation::{ClassAccuracy, Evaluation};
use super::experiment::Experiment;
use super::files;
use super::interpolation::{Interpolation, names};
use super::pictures::{BitmapRow, PredictionRow, captioned, prediction_rows, size_series};
use super::schedule::resets;
use super::settings::Settings;
use super::train::Epoch;
use nfr_convert::compare::picture::{LabelFont, png};
use nfr_convert::error::Error;

/// How much bitmaps are enlarged.
const ZOOM: u32 = 3;
/// Bitmaps beside each other.
pub(super) const COLUMNS: usize = 8;

/// The contents of `settings.json`.
#[derive(Serialize)]
struct SettingsFile<'s> {
    label: String,
    scale: &'static str,
    sides: &'s [usize],
    width: usize,
    latent: usize,
    encoder: usize,
    implicit_epochs: usize,
    masked_widths: &'s [usize],
    masked_epochs: usize,
    masked_period: usize,
    seed: u64,
}

/// Writes `settings.json` into the context's directory, if it has one.
///
/// # Errors
///
/// `Io` if it cannot be written.
pub fn settings(context: &Experiment<'_>) -> Result<(), Error> {
    let Some(directory) = context.directory_of(&[]) else { return Ok(()) };
    let settings = &context.settings;
    let contents = SettingsFile {
        label: settings.label(),
        scale: settings.scale.name(),
        sides: &settings.sides,
        width: settings.implicit.width,
        latent: settings.implicit.latent,
        encoder: settings.implicit.encoder,
        implicit_epochs: settings.implicit_epochs,
        masked_widths: &settings.masked_widths,
        masked_epochs: settings.masked_epochs,
        masked_period: settings.masked_period,
        seed: settings.seed,
    };
    let json = serde_json::to_string_pretty(&contents)
        .map_err(|e| Error::Io(format!("settings.json cannot be written ({e})")))?;
    files::write(&directory.join("settings.json"), (json + "\n").as_bytes())
}

/// Writes a training's history, errors and pictures beside its checkpoint, if the context has a directory. Our own model has
/// no history.
///
/// # Errors
///
/// `Io` if they cannot be written.
pub fn evaluation(context: &Experiment<'_>, font: &LabelFont, evaluation: &Evaluation) -> Result<(), Error> {
    let code = format!("u{:04x}", u32::from(evaluation.glyph));
    let Some(directory) = context.directory_of(&[&evaluation.model, &evaluation.font, &code]) else {
        return Ok(());
    };
    let label = context.settings.label();
    if !evaluation.history.is_empty() {
        let title = format!("{} of {:?} in {}", evaluation.model, evaluation.glyph, evaluation.font);
        history(&directory, &label, &title, &evaluation.history)?;
    }
    files::write(&directory.join("errors.csv"), labelled(&label, &write_csv(&evaluation.rows)?).as_bytes())?;
    let labels: Vec<String> = evaluation.truth.iter().map(|truth| truth.side.to_string()).collect();
    let rows = labels.iter().zip(&evaluation.drawn).zip(&evaluation.truth);
    let rows: Vec<PredictionRow<'_>> =
        rows.map(|((label, prediction), truth)| PredictionRow { label, prediction, truth }).collect();
    let picture = prediction_rows(font, &rows, ZOOM)?;
    let picture = captioned(font, &picture, context.settings.scale_note())?;
    files::write(&directory.join("comparison.png"), &png(&picture)?)
}

/// Writes what an experiment on a family gave beside its checkpoint, if the context has a directory.
///
/// # Errors
///
/// `Io` if it cannot be written.
pub fn interpolation(
    context: &Experiment<'_>,
    font: &LabelFont,
    experiment: &str,
    found: &Interpolation,
) -> Result<(), Error> {
    let code = format!("u{:04x}", u32::from(found.glyph));
    let Some(directory) = context.directory_of(&[experiment, &code]) else { return Ok(()) };
    let label = context.settings.label();
    history(&directory, &label, &format!("{experiment}, {:?}", found.glyph), &found.history)?;
    let rows = found.ends.iter().chain(&found.between).flat_map(|rendering| rendering.rows.clone());
    let table = write_csv(&rows.collect::<Vec<_>>())?;
    files::write(&directory.join("errors.csv"), labelled(&label, &table).as_bytes())?;
    let picture = captioned(font, &between(font, found)?, context.settings.scale_note())?;
    files::write(&directory.join("between.png"), &png(&picture)?)
}

/// A picture of the interpolations between two fonts, at all sizes: the first font, each interpolation, the real one
/// where there is one, and the last font.
///
/// # Errors
///
/// `LimitExceeded` if it would be too large.
pub fn between(font: &LabelFont, found: &Interpolation) -> Result<RgbImage, Error> {
    let rendered = |name: &str| found.between.iter().find(|rendering| rendering.name == name);
    let ways = [
        ("first", names::FIRST),
        ("implicit", names::IMPLICIT),
        ("grid-fit", names::GRID_FIT),
        ("snapped", names::SNAPPED),
    ];
    let mut rows: Vec<(&str, Vec<&SquareBitmap>)> = ways
        .into_iter()
        .filter_map(|(label, name)| Some((label, rendered(name)?.drawn.iter().collect())))
        .collect();
    let truth = found.between.iter().find_map(|rendering| rendering.truth.as_ref());
    rows.extend(truth.map(|truth| ("truth", truth.iter().collect())));
    rows.extend(rendered(names::LAST).map(|rendering| ("last", rendering.drawn.iter().collect())));
    let rows: Vec<BitmapRow<'_>> =
        rows.into_iter().map(|(label, squares)| BitmapRow { label, squares }).collect();
    size_series(font, &rows, COLUMNS, ZOOM)
}

/// Writes `history.csv` and `loss.svg`.
///
/// # Errors
///
/// `Io` if they cannot be written.
pub fn history(directory: &Path, label: &str, title: &str, epochs: &[Epoch]) -> Result<(), Error> {
    let rates: Vec<f64> = epochs.iter().map(|epoch| epoch.rate).collect();
    let starts = resets(&rates);
    let record = |(k, epoch): (usize, &Epoch)| {
        let Epoch { rate, loss, seconds } = epoch;
        let reset = u8::from(starts.contains(&k)).to_string();
        [k.to_string(), format!("{rate:e}"), format!("{loss:e}"), format!("{seconds:.4}"), reset]
    };
    let header = ["epoch", "rate", "loss", "seconds", "reset"];
    let table = csv_table(header, epochs.iter().enumerate().map(record))?;
    files::write(&directory.join("history.csv"), labelled(label, &table).as_bytes())?;
    let chart = loss_history(
        &Headings { title: &format!("Loss: {title}"), subtitle: label },
        &[loss_line("loss", epochs)],
        &starts.iter().map(|epoch| *epoch as f64).collect::<Vec<_>>(),
    )?;
    files::write(&directory.join("loss.svg"), chart.as_bytes())
}

/// A history's loss as a curve.
pub fn loss_line(name: &str, epochs: &[Epoch]) -> Line {
    let points = epochs.iter().enumerate().map(|(k, epoch)| [k as f64, epoch.loss]).collect();
    Line { name: name.to_owned(), points }
}

/// A table whose first line, a comment, says at what scale its figures were made.
pub fn labelled(label: &str, table: &str) -> String {
    format!("# {label}\n{table}")
}

/// The settings' label and every evaluation in a line, for a terminal.
pub fn summary(settings: &Settings, evaluations: &[Evaluation]) -> String {
    let mut text = format!("{}\n", settings.label());
    let wide = evaluations.iter().map(|evaluation| evaluation.model.len()).max().unwrap_or(0);
    for evaluation in evaluations {
        let (model, font, glyph) = (&evaluation.model, &evaluation.font, evaluation.glyph);
        let (mse, mae) = (evaluation.mse(), evaluation.mae());
        let _ = write!(text, "{model:wide$}  {font} {glyph:?}  mse {mse:.3e}  mae {mae:.4}");
        if let Some(last) = evaluation.history.last() {
            let _ = write!(text, "  loss {:.3e}", last.loss);
        }
        if let Some((seconds, rate)) = evaluation.seconds().zip(evaluation.operations_per_second()) {
            let _ = write!(text, "  {seconds:.1} s, {:.3} TFLOP/s", rate / 1e12);
        }
        if let Some(ClassAccuracy { pixels, wrong, mse, rounding }) = evaluation.class_accuracy {
            let _ = write!(
                text,
                "  {wrong} of {pixels} pixels in a wrong class: mse {mse:.3e}, that of the right ones {rounding:.3e}"
            );
        }
        text.push('\n');
    }
    text
}
