//! Charts of errors as SVG, for the report.
//!
//! Errors are drawn on logarithmic axes, since models differ by orders of magnitude; an error of zero stands at the
//! lower end. Every function returns a whole SVG document that needs no font but the reader's sans-serif.

mod axis;
mod box_plot;
mod frame;
mod glyphs;
mod histogram;
mod lines;
#[cfg(test)]
mod tests;

pub use box_plot::box_plot;
pub use frame::{ErrorSeries, Headings};
pub use glyphs::{GlyphSeries, error_by_glyph};
pub use histogram::error_histogram;
pub use lines::{Line, SizeSeries, error_by_size, lines, loss_history};
