//! Pictures of bitmaps, for people.

mod canvas;
mod letters;
mod line;
mod sheet;

pub use canvas::{Canvas, DIFFERENCE_GAIN, coverage, difference, enclosing};
pub use line::{specimen, text_line};
pub use sheet::{Row, sheet};
