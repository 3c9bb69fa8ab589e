//! Coverage in fewer bits, as displays keep it.

use core::fmt;

/// Bits a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Depth {
    /// Black and white: a pixel is set if at least half of it is covered. Thin strokes may break; [`nfr::Rasterizer::draw_mono`]
    /// draws text without gaps, packed in the same way.
    One,
    /// 4 levels.
    Two,
    /// 16 levels.
    Four,
    /// 256 levels: the coverage itself.
    Eight,
}

impl Depth {
    /// The number of bits: 1, 2, 4 or 8.
    pub fn bits(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// The bytes of a row of so many pixels: rows begin at whole bytes.
    pub fn row_bytes(self, width: u32) -> usize {
        (width as usize * self.bits() as usize).div_ceil(8)
    }

    /// The nearest level to a coverage.
    fn level(self, coverage: u8) -> u8 {
        let most = (1u32 << self.bits()) - 1;
        ((u32::from(coverage) * most + 127) / 255) as u8
    }
}

/// A buffer that does not hold the packed rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BufferTooSmall {
    /// The bytes that the rows take.
    pub needed: usize,
    /// The bytes of the buffer.
    pub length: usize,
}

impl fmt::Display for BufferTooSmall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "packed pixels take {} bytes, and the buffer has {}", self.needed, self.length)
    }
}

impl core::error::Error for BufferTooSmall {}

/// Packs a bitmap to fewer bits a pixel, each level to the nearest: the top row first, the first pixel of a byte in its highest
/// bits, rows padded with zeros to whole bytes. Returns how many bytes of `out` it wrote.
///
/// ```
/// use nfr_embedded::{Depth, pack};
///
/// let font = nfr::Font::new(include_bytes!("../fonts/ascii.nfr.ttf").as_slice())?;
/// let mut rasterizer = nfr::Rasterizer::new(&font);
/// let bitmap = rasterizer.draw(font.glyph_for_char('i').unwrap_or(0), 12.0)?;
/// let mut bits = [0; 64];
/// let length = pack(bitmap, Depth::One, &mut bits).unwrap();
/// assert_eq!(length, 9); // 9 rows of one byte
/// # Ok::<(), nfr::Error>(())
/// ```
///
/// # Errors
///
/// A buffer with fewer than `height` × [`Depth::row_bytes`] bytes, in which nothing is written.
pub fn pack(bitmap: nfr::BitmapRef<'_>, depth: Depth, out: &mut [u8]) -> Result<usize, BufferTooSmall> {
    let row_bytes = depth.row_bytes(bitmap.placement.width);
    let needed = row_bytes * bitmap.placement.height as usize;
    let length = out.len();
    let out = out.get_mut(..needed).ok_or(BufferTooSmall { needed, length })?;
    out.fill(0);
    let bits = depth.bits() as usize;
    for (row, packed) in bitmap.rows().zip(out.chunks_exact_mut(row_bytes.max(1))) {
        for (x, coverage) in row.iter().enumerate() {
            let at = x * bits;
            packed[at / 8] |= depth.level(*coverage) << (8 - bits - at % 8);
        }
    }
    Ok(needed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_the_nearest_and_cover_the_whole_range() {
        for depth in [Depth::One, Depth::Two, Depth::Four, Depth::Eight] {
            let most = (1i32 << depth.bits()) - 1;
            for coverage in 0..=255u8 {
                // The distance to a level in 1/(255 · most).
                let distance = |level: i32| (i32::from(coverage) * most - level * 255).abs();
                let level = i32::from(depth.level(coverage));
                assert!(
                    (0..=most).all(|other| distance(level) <= distance(other)),
                    "{coverage} in {depth:?}"
                );
            }
        }
        assert_eq!((Depth::One.level(127), Depth::One.level(128)), (0, 1));
    }
}
