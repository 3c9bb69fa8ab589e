//! What is drawn, and where it lies.

use alloc::vec::Vec;

use crate::error::Error;

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
    pub(super) fn new(placement: Placement, pixels: &'a [u8]) -> Self {
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
pub(super) struct Canvas<'b> {
    pub(super) pixels: &'b mut [u8],
    pub(super) pitch: usize,
}

impl<'b> Canvas<'b> {
    /// A canvas for a bitmap.
    ///
    /// # Errors
    ///
    /// `BufferTooSmall` if the rows overlap or do not fit.
    pub(super) fn new(placement: Placement, pixels: &'b mut [u8], pitch: usize) -> Result<Self, Error> {
        let (width, height, length) = (placement.width as usize, placement.height as usize, pixels.len());
        let end = height.saturating_sub(1).saturating_mul(pitch).saturating_add(width);
        if placement.area() > 0 && (pitch < width || end > length) {
            return Err(Error::BufferTooSmall { placement, pitch, length });
        }
        Ok(Self { pixels, pitch })
    }
}

/// The box around two bitmaps; one without pixels takes no room.
pub fn union(a: Placement, b: Placement) -> Placement {
    match (a.area(), b.area()) {
        (0, _) => return b,
        (_, 0) => return a,
        _ => {}
    }
    let right = |p: Placement| i64::from(p.left) + i64::from(p.width);
    let bottom = |p: Placement| i64::from(p.top) - i64::from(p.height);
    let (left, top) = (a.left.min(b.left), a.top.max(b.top));
    let length = |length: i64| u32::try_from(length).unwrap_or(u32::MAX);
    Placement {
        left,
        top,
        width: length(right(a).max(right(b)) - i64::from(left)),
        height: length(i64::from(top) - bottom(a).min(bottom(b))),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const A: Placement = Placement { left: -1, top: 2, width: 2, height: 2 };
    const B: Placement = Placement { left: 0, top: 3, width: 2, height: 2 };

    #[test]
    fn the_union_holds_both_boxes_and_ignores_empty_ones() {
        let empty = Placement { left: 50, top: 50, ..Placement::default() };
        assert_eq!(union(A, B), Placement { left: -1, top: 3, width: 3, height: 3 });
        assert_eq!((union(A, empty), union(empty, B)), (A, B));
    }

    #[test]
    fn the_last_row_needs_no_more_than_its_pixels() {
        let fits = |pitch, length| Canvas::new(A, &mut [0; 16][..length], pitch).is_ok();
        assert!(fits(2, 4) && fits(5, 7) && !fits(5, 6) && !fits(1, 16) && !fits(2, 3));
        assert!(!fits(usize::MAX, 16));
        assert!(Canvas::new(Placement::default(), &mut [], 0).is_ok());
    }
}
