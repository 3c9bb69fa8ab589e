//! Pictures of bitmaps, for people: ink black on white, as `image` keeps and enlarges them.

mod check;
mod label;
mod line;
mod raster;
mod sheet;

pub use check::{check_close, check_golden, write_failure};
pub use label::LabelFont;
pub use line::{specimen, text_line};
pub use raster::{DIFFERENCE_GAIN, blank, coverage, difference, enclosing, enlarged, png};
pub use sheet::{SheetRow, sheet};
