//! From a model to pixels.

mod area;
mod draw;
mod font;
mod glyph;
mod network;

mod rasterizer;

pub use draw::Scratch;
pub use font::Font;
pub use font::{head_units, open};
pub use glyph::Glyph;
pub use glyph::union;
pub use rasterizer::Rasterizer;

use crate::error::Error;
use crate::model::gridfit::check_ppem;

/// How a glyph is set: its size, and where the pen stands. A plain number is a size with the pen on a whole pixel.
///
/// ```
/// let quarter = nfr::Setting { pen: [0.25, 0.0], ..nfr::Setting::from(16.0) };
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The size in pixels per em, above 0 and at most 2048; it may be fractional.
    pub ppem: f32,
    /// The pen's place in pixels, x to the right and y up: what is left of a position in a line of text when whole
    /// pixels are taken off. At most [`MAX_PEN`] either way.
    pub pen: [f32; 2],
}

/// The farthest that a pen may be off, in pixels.
pub const MAX_PEN: f32 = 1024.0;

impl From<f32> for Setting {
    fn from(ppem: f32) -> Self {
        Self { ppem, pen: [0.0; 2] }
    }
}

impl Setting {
    /// Checks it.
    fn checked(self) -> Result<Self, Error> {
        check_ppem(self.ppem)?;
        if let Some(far) = self.pen.iter().find(|at| at.is_nan() || at.abs() > MAX_PEN) {
            return Err(Error::InvalidParameter(format!(
                "a pen at {far} pixels is outside -{MAX_PEN}–{MAX_PEN}; add whole pixels to the placement"
            )));
        }
        Ok(self)
    }
}

/// Where a bitmap lies relative to the pen, in pixels (FreeType's `bitmap_left` and `bitmap_top`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Placement {
    /// From the pen to the left edge of the left column.
    pub left: i32,
    /// From the baseline up to the top edge of the top row.
    pub top: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Placement {
    /// The number of pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A rendered glyph: coverage 0–255, top row first, `placement.width` bytes a row.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Bitmap {
    /// Where the pixels lie.
    pub placement: Placement,
    /// `placement.area()` coverage values.
    pub pixels: Vec<u8>,
}
