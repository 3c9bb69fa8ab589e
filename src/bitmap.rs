//! Bitmaps, and the memory that they are drawn into.

use alloc::vec::Vec;

use crate::error::Error;
use crate::placement::Placement;

/// A rendered glyph: coverage 0–255, top row first, `placement.width` bytes a row.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Bitmap {
    /// Where the pixels lie.
    pub placement: Placement,
    /// `placement.area()` coverage values.
    pub pixels: Vec<u8>,
}

/// A rendered glyph in a rasterizer's own buffer: coverage 0–255, top row first, `placement.width` bytes a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct BitmapRef<'a> {
    /// Where the pixels lie.
    pub placement: Placement,
    /// `placement.area()` coverage values.
    pub pixels: &'a [u8],
}

impl<'a> BitmapRef<'a> {
    pub(crate) fn new(placement: Placement, pixels: &'a [u8]) -> Self {
        Self { placement, pixels }
    }

    /// The rows, top row first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &'a [u8]> + use<'a> {
        self.pixels.chunks_exact(self.placement.width.max(1) as usize)
    }
}

impl Bitmap {
    /// The rows, top row first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        BitmapRef::new(self.placement, &self.pixels).rows()
    }
}

impl From<BitmapRef<'_>> for Bitmap {
    fn from(BitmapRef { placement, pixels }: BitmapRef<'_>) -> Self {
        Self { placement, pixels: pixels.to_vec() }
    }
}

/// Memory that a bitmap is drawn into: its rows begin `pitch` bytes apart.
pub(crate) struct Canvas<'b> {
    pub(crate) pixels: &'b mut [u8],
    pub(crate) pitch: usize,
}

impl<'b> Canvas<'b> {
    /// A canvas for a bitmap.
    ///
    /// # Errors
    ///
    /// `BufferTooSmall` if the rows overlap or do not fit.
    pub(crate) fn new(placement: Placement, pixels: &'b mut [u8], pitch: usize) -> Result<Self, Error> {
        let (width, height, length) = (placement.width as usize, placement.height as usize, pixels.len());
        let end = height.saturating_sub(1).saturating_mul(pitch).saturating_add(width);
        if placement.area() > 0 && (pitch < width || end > length) {
            return Err(Error::BufferTooSmall { placement, pitch, length });
        }
        Ok(Self { pixels, pitch })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const A: Placement = Placement { left: -1, top: 2, width: 2, height: 2 };
    #[test]
    fn the_last_row_needs_no_more_than_its_pixels() {
        let fits = |pitch, length| Canvas::new(A, &mut [0; 16][..length], pitch).is_ok();
        assert!(fits(2, 4) && fits(5, 7) && !fits(5, 6) && !fits(1, 16) && !fits(2, 3));
        assert!(!fits(usize::MAX, 16));
        assert!(Canvas::new(Placement::default(), &mut [], 0).is_ok());
    }
}
