//! Charts of errors as SVG, for the report.
//!
//! Errors are drawn on logarithmic axes, since models differ by orders of magnitude; an error of zero stands at the
//! lower end. Every function returns a whole SVG document that needs no font but the reader's sans-serif.

mod axis;
mod frame;
mod glyphs;
mod histogram;
mod lines;
#[cfg(test)]
mod tests;
mod variants;

pub use glyphs::{GlyphSeries, error_by_glyph};
pub use histogram::error_histogram;
pub use lines::{Line, SizeSeries, error_by_size, lines, loss_history};
pub use variants::ablations;

/// What stands above a chart.
#[derive(Debug, Clone, Copy)]
pub struct Headings<'h> {
    /// What the chart shows, in one short line.
    pub title: &'h str,
    /// On what scale, and whatever else a reader must know; broken into lines as needed.
    pub subtitle: &'h str,
}

/// The errors of one model or variant, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name, in the legend.
    pub name: String,
    /// Its errors.
    pub values: Vec<f64>,
}
