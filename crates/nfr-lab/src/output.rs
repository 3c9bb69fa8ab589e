//! What a training leaves beside its checkpoint: its history, its errors and pictures of what it draws.

use std::fmt::Write;
use std::path::Path;

use serde::Serialize;

use super::Square;
use super::bench::Bench;
use super::charts::{Headings, Line, loss_history};
use super::error::write_csv;
use super::files;
use super::interpolation::{Interpolation, names};
use super::pictures::{Comparison, Strip, cascade, noted, triptychs};
use super::scale::Settings;
use super::schedule::resets;
use super::single::{Choices, Outcome};
use super::train::Epoch;
use nfr_convert::error::Error;

/// How much bitmaps are enlarged.
const ZOOM: u32 = 3;
/// Bitmaps beside each other.
pub(super) const COLUMNS: usize = 8;

/// The settings as a file tells them.
#[derive(Serialize)]
struct Written<'s> {
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

/// Writes `settings.json` into the bench's directory, if it has one.
///
/// # Errors
///
/// `Io` if it cannot be written.
pub fn settings(bench: &Bench<'_>) -> Result<(), Error> {
    let Some(place) = bench.place(&[]) else { return Ok(()) };
    let settings = &bench.settings;
    let written = Written {
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
    let json = serde_json::to_string_pretty(&written)
        .map_err(|e| Error::Io(format!("settings.json cannot be written ({e})")))?;
    files::write(&place.join("settings.json"), (json + "\n").as_bytes())
}

/// Writes a training's history, errors and pictures beside its checkpoint, if the bench has a directory. Our own model has
/// no history.
///
/// # Errors
///
/// `Io` if they cannot be written.
pub fn outcome(bench: &Bench<'_>, outcome: &Outcome) -> Result<(), Error> {
    let code = format!("u{:04x}", u32::from(outcome.glyph));
    let Some(place) = bench.place(&[&outcome.model, &outcome.font, &code]) else { return Ok(()) };
    let label = bench.settings.label();
    if !outcome.history.is_empty() {
        let title = format!("{} of {:?} in {}", outcome.model, outcome.glyph, outcome.font);
        history(&place, &label, &title, &outcome.history)?;
    }
    files::write(&place.join("errors.csv"), labelled(&label, &write_csv(&outcome.rows)?).as_bytes())?;
    let labels: Vec<String> = outcome.truth.iter().map(|truth| truth.side.to_string()).collect();
    let rows = labels.iter().zip(&outcome.drawn).zip(&outcome.truth);
    let rows: Vec<Comparison<'_>> =
        rows.map(|((label, prediction), truth)| Comparison { label, prediction, truth }).collect();
    files::write(&place.join("comparison.png"), &noted(&triptychs(&rows, ZOOM)?, bench.settings.kind())?)
}

/// Writes what an experiment on a family gave beside its checkpoint, if the bench has a directory.
///
/// # Errors
///
/// `Io` if it cannot be written.
pub fn interpolation(bench: &Bench<'_>, experiment: &str, found: &Interpolation) -> Result<(), Error> {
    let code = format!("u{:04x}", u32::from(found.glyph));
    let Some(place) = bench.place(&[experiment, &code]) else { return Ok(()) };
    let label = bench.settings.label();
    history(&place, &label, &format!("{experiment}, {:?}", found.glyph), &found.history)?;
    let rows = found.ends.iter().chain(&found.between).flat_map(|drawing| drawing.rows.clone());
    let table = write_csv(&rows.collect::<Vec<_>>())?;
    files::write(&place.join("errors.csv"), labelled(&label, &table).as_bytes())?;
    files::write(&place.join("between.png"), &noted(&between(found)?, bench.settings.kind())?)
}

/// A picture of what lies between two fonts, at all sizes: the first font, what each way makes of it, the real one
/// where there is one, and the last font.
///
/// # Errors
///
/// `LimitExceeded` if it would be too large.
pub fn between(found: &Interpolation) -> Result<Vec<u8>, Error> {
    let shown = |name: &str| found.between.iter().find(|drawing| drawing.name == name);
    let ways = [
        ("first", names::FIRST),
        ("implicit", names::IMPLICIT),
        ("grid-fit", names::GRID_FIT),
        ("snapped", names::SNAPPED),
    ];
    let mut rows: Vec<(&str, Vec<&Square>)> = ways
        .into_iter()
        .filter_map(|(label, name)| Some((label, shown(name)?.drawn.iter().collect())))
        .collect();
    let truth = found.between.iter().find_map(|drawing| drawing.truth.as_ref());
    rows.extend(truth.map(|truth| ("truth", truth.iter().collect())));
    rows.extend(shown(names::LAST).map(|drawing| ("last", drawing.drawn.iter().collect())));
    let rows: Vec<Strip<'_>> = rows.into_iter().map(|(label, squares)| Strip { label, squares }).collect();
    cascade(&rows, COLUMNS, ZOOM)
}

/// Writes `history.csv` and `loss.svg`.
///
/// # Errors
///
/// `Io` if they cannot be written.
pub fn history(place: &Path, label: &str, title: &str, epochs: &[Epoch]) -> Result<(), Error> {
    let rates: Vec<f64> = epochs.iter().map(|epoch| epoch.rate).collect();
    let starts = resets(&rates);
    let mut table = "epoch,rate,loss,seconds,reset\n".to_owned();
    for (k, epoch) in epochs.iter().enumerate() {
        let reset = u8::from(starts.contains(&k));
        // A string takes everything that is written to it.
        let _ = writeln!(table, "{k},{:e},{:e},{:.4},{reset}", epoch.rate, epoch.loss, epoch.seconds);
    }
    files::write(&place.join("history.csv"), labelled(label, &table).as_bytes())?;
    let chart = loss_history(
        &Headings { title: &format!("Loss: {title}"), subtitle: label },
        &[loss_line("loss", epochs)],
        &starts.iter().map(|epoch| *epoch as f64).collect::<Vec<_>>(),
    )?;
    files::write(&place.join("loss.svg"), chart.as_bytes())
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

/// The settings' label and every outcome in a line, for a terminal.
pub fn summary(settings: &Settings, outcomes: &[Outcome]) -> String {
    let mut text = format!("{}\n", settings.label());
    let wide = outcomes.iter().map(|outcome| outcome.model.len()).max().unwrap_or(0);
    for outcome in outcomes {
        let (model, font, glyph) = (&outcome.model, &outcome.font, outcome.glyph);
        let (mse, mae) = (outcome.mse(), outcome.mae());
        let _ = write!(text, "{model:wide$}  {font} {glyph:?}  mse {mse:.3e}  mae {mae:.4}");
        if let Some(last) = outcome.history.last() {
            let _ = write!(text, "  loss {:.3e}  {:.1} s", last.loss, outcome.seconds());
        }
        if let Some(Choices { pixels, wrong, mse, rounding }) = outcome.choices {
            let _ = write!(
                text,
                "  {wrong} of {pixels} pixels in a wrong class: mse {mse:.3e}, that of the right ones {rounding:.3e}"
            );
        }
        text.push('\n');
    }
    text
}
