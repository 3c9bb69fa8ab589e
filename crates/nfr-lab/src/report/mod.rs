//! The report: every figure and table of the paper's evaluation from the results of a study, on one page.

mod beside;
mod charts;
mod claims;
mod content;
mod page;
mod pictures;
mod tables;

use std::path::Path;

use super::files;
use nfr_convert::error::Error;

pub use beside::OtherReport;
pub use claims::{Claim, claims};
pub use content::ReportContext;

/// Writes the report into a directory: `index.html`, the charts as SVG, the pictures as PNG, the tables as CSV.
///
/// # Errors
///
/// `Io` if a file cannot be written, `LimitExceeded` for pictures that would be too large.
pub fn write(directory: &Path, context: ReportContext<'_>) -> Result<(), Error> {
    let claims = claims(context.results, &context.experiment.settings);
    for (name, table) in tables::all(&context, &claims)? {
        files::write(&directory.join(name), table.as_bytes())?;
    }
    let mut sections = charts::sections(&context)?;
    sections.extend(pictures::sections(&context)?);
    for figure in sections.iter().flat_map(|section| &section.figures) {
        files::write(&directory.join(&figure.file), &figure.bytes)?;
    }
    let page = page::page(&context, &claims, &sections);
    // The page comes last: when it is there, so is everything that it shows.
    files::write(&directory.join("index.html"), page.as_bytes())
}
