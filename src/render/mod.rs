//! From a model to pixels.

mod font;
mod glyph;
#[cfg(any(feature = "convert", feature = "fallback"))]
pub mod outline;
mod rasterizer;

pub use font::Font;
#[cfg(feature = "convert")]
pub(crate) use font::open;
pub use glyph::Glyph;
#[cfg(feature = "convert")]
pub(crate) use glyph::sum;
pub use rasterizer::Rasterizer;

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
