//! The report: every figure and table of the paper's evaluation from what a study found, on one page.

mod claims;
mod figures;
mod page;
mod pictures;
mod tables;

use std::path::Path;

use super::bench::Bench;
use super::error::{ErrorRow, Summary};
use super::files;
use super::single::Outcome;
use super::study::{Findings, Plan};
use nfr_convert::error::Error;

pub use claims::{Claim, claims};

/// What a report is about.
#[derive(Clone, Copy)]
pub struct Part<'r> {
    /// How the experiments ran.
    pub bench: &'r Bench<'r>,
    /// What they were.
    pub plan: &'r Plan<'r>,
    /// What came of them.
    pub findings: &'r Findings,
}

impl Part<'_> {
    fn label(&self) -> String {
        self.bench.settings.label()
    }

    /// The name of the font that has all experiments.
    fn font(&self) -> &str {
        &self.plan.fonts[0].name
    }
}

/// A chart or a picture of the report.
struct Figure {
    /// The file's name.
    file: String,
    bytes: Vec<u8>,
    /// What it shows and how to read it.
    caption: String,
}

/// A heading of the report with its figures.
struct Section {
    title: &'static str,
    text: String,
    figures: Vec<Figure>,
}

/// Writes the report into a directory: `index.html`, the charts as SVG, the pictures as PNG, the tables as CSV.
///
/// # Errors
///
/// `Io` if a file cannot be written, `LimitExceeded` for pictures that would be too large.
pub fn write(place: &Path, part: Part<'_>) -> Result<(), Error> {
    let claims = claims(part.findings, &part.bench.settings);
    for (name, table) in tables::all(&part, &claims)? {
        files::write(&place.join(name), table.as_bytes())?;
    }
    let mut sections = figures::sections(&part)?;
    sections.extend(pictures::sections(&part)?);
    for figure in sections.iter().flat_map(|section| &section.figures) {
        files::write(&place.join(&figure.file), &figure.bytes)?;
    }
    let page = page::page(&part, &claims, &sections);
    // The page comes last: when it is there, so is everything that it shows.
    files::write(&place.join("index.html"), page.as_bytes())
}

/// The rows of a model's outcomes.
fn of_model(outcomes: &[Outcome], model: &str) -> Vec<ErrorRow> {
    outcomes
        .iter()
        .filter(|outcome| outcome.model == model)
        .flat_map(|outcome| outcome.rows.clone())
        .collect()
}

/// The mean squared error of rows; not a number without any.
fn mean_of(rows: &[ErrorRow]) -> f64 {
    Summary::of(rows.iter().map(|row| row.mse)).map_or(f64::NAN, |summary| summary.mean)
}
