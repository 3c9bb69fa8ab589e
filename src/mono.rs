//! Glyphs in black and white.

use alloc::vec::Vec;

use crate::placement::Placement;

/// A glyph in black and white, one bit a pixel: the top row first, the first pixel of a byte in its highest bit, rows padded with
/// zeros to whole bytes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MonoBitmap {
    /// Where the pixels lie.
    pub placement: Placement,
    /// `placement.height` rows of [`Self::row_bytes`] bytes; a bit is 1 where the pixel is black.
    pub bits: Vec<u8>,
}

/// A glyph in black and white in a rasterizer's own buffer, laid out as in [`MonoBitmap`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct MonoBitmapRef<'a> {
    /// Where the pixels lie.
    pub placement: Placement,
    /// `placement.height` rows of [`Self::row_bytes`] bytes; a bit is 1 where the pixel is black.
    pub bits: &'a [u8],
}

/// The bytes of a row of so many pixels.
pub(crate) fn row_bytes(width: u32) -> usize {
    width.div_ceil(8) as usize
}

impl<'a> MonoBitmapRef<'a> {
    pub(crate) fn new(placement: Placement, bits: &'a [u8]) -> Self {
        Self { placement, bits }
    }

    /// The bytes of a row.
    pub fn row_bytes(&self) -> usize {
        row_bytes(self.placement.width)
    }

    /// The rows, top row first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &'a [u8]> + use<'a> {
        self.bits.chunks_exact(self.row_bytes().max(1))
    }

    /// Whether a pixel is black. Columns are counted from the left, rows from the top; pixels outside of the bitmap are white.
    pub fn is_black(&self, column: u32, row: u32) -> bool {
        let at = row as usize * self.row_bytes() + column as usize / 8;
        let byte = self.bits.get(at).filter(|_| column < self.placement.width);
        byte.is_some_and(|byte| byte & (0x80 >> (column % 8)) != 0)
    }
}

impl MonoBitmap {
    /// The bytes of a row.
    pub fn row_bytes(&self) -> usize {
        row_bytes(self.placement.width)
    }

    /// The rows, top row first.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        MonoBitmapRef::new(self.placement, &self.bits).rows()
    }

    /// Whether a pixel is black. Columns are counted from the left, rows from the top; pixels outside of the bitmap are white.
    pub fn is_black(&self, column: u32, row: u32) -> bool {
        MonoBitmapRef::new(self.placement, &self.bits).is_black(column, row)
    }
}

impl From<MonoBitmapRef<'_>> for MonoBitmap {
    fn from(MonoBitmapRef { placement, bits }: MonoBitmapRef<'_>) -> Self {
        Self { placement, bits: bits.to_vec() }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[test]
    fn pixels_are_read_from_the_highest_bit_on_and_are_white_outside() {
        let placement = Placement { left: 0, top: 2, width: 9, height: 2 };
        let bitmap = MonoBitmap { placement, bits: vec![0x80, 0x80, 0x01, 0x40] };
        let black: Vec<[u32; 2]> = (0..3)
            .flat_map(|row| (0..20).map(move |column| [column, row]))
            .filter(|[column, row]| bitmap.is_black(*column, *row))
            .collect();
        assert_eq!(black, [[0, 0], [8, 0], [7, 1]], "the padding's bit counts for no pixel");
        assert_eq!(bitmap.rows().collect::<Vec<_>>(), [[0x80, 0x80], [0x01, 0x40]]);
        assert_eq!(MonoBitmap::default().rows().len(), 0);
    }
}
