//! The components of a composite glyph (OpenType 1.9, "glyf", composite glyph description).

use super::bytes::Bytes;
use crate::number::mul_fixed;

const ARGUMENTS_ARE_WORDS: u16 = 0x0001;
const ARGUMENTS_ARE_OFFSETS: u16 = 0x0002;
const HAS_SCALE: u16 = 0x0008;
const MORE_FOLLOW: u16 = 0x0020;
const HAS_TWO_SCALES: u16 = 0x0040;
const HAS_MATRIX: u16 = 0x0080;
const METRICS: u16 = 0x0200;
const OFFSET_IS_SCALED: u16 = 0x0800;
const OFFSET_IS_UNSCALED: u16 = 0x1000;
const GLYPH_HAS_24_BITS: u16 = 0x2000;

/// A glyph that is part of another one.
pub(super) struct Component {
    flags: u16,
    pub(super) glyph: u32,
    /// An offset, or the numbers of two points that are to coincide.
    arguments: [i16; 2],
    /// What x and y add to x, then what they add to y, in 1/65536.
    matrix: [[i32; 2]; 2],
}

impl Component {
    /// The components that bytes list; None for one that ends early, and is the last then.
    pub(super) fn list(mut bytes: Bytes<'_>) -> impl Iterator<Item = Option<Self>> {
        let mut more = true;
        core::iter::from_fn(move || {
            if !more {
                return None;
            }
            let component = Self::read(&mut bytes);
            more = component.as_ref().is_some_and(|component| component.flags & MORE_FOLLOW != 0);
            Some(component)
        })
    }

    fn read(bytes: &mut Bytes<'_>) -> Option<Self> {
        let flags = bytes.u16()?;
        let high = if flags & GLYPH_HAS_24_BITS != 0 { bytes.u8()? } else { 0 };
        let glyph = u32::from(high) << 16 | u32::from(bytes.u16()?);
        let mut argument = || {
            Some(if flags & ARGUMENTS_ARE_WORDS != 0 {
                bytes.i16()?
            } else if flags & ARGUMENTS_ARE_OFFSETS != 0 {
                (bytes.u8()? as i8).into()
            } else {
                bytes.u8()?.into()
            })
        };
        let arguments = [argument()?, argument()?];
        let mut share = || bytes.i16().map(|share| i32::from(share) << 2);
        let mut matrix = [[1 << 16, 0], [0, 1 << 16]];
        if flags & HAS_SCALE != 0 {
            matrix[0][0] = share()?;
            matrix[1][1] = matrix[0][0];
        } else if flags & HAS_TWO_SCALES != 0 {
            (matrix[0][0], matrix[1][1]) = (share()?, share()?);
        } else if flags & HAS_MATRIX != 0 {
            // Column by column.
            (matrix[0][0], matrix[1][0]) = (share()?, share()?);
            (matrix[0][1], matrix[1][1]) = (share()?, share()?);
        }
        Some(Self { flags, glyph, arguments, matrix })
    }

    /// Whether the composite glyph has its metrics.
    pub(super) fn has_metrics(&self) -> bool {
        self.flags & METRICS != 0
    }

    /// Whether its points are scaled.
    pub(super) fn is_scaled(&self) -> bool {
        self.flags & (HAS_SCALE | HAS_TWO_SCALES | HAS_MATRIX) != 0
    }

    /// A point, scaled.
    pub(super) fn scaled(&self, [x, y]: [i32; 2]) -> [i32; 2] {
        self.matrix.map(|[by_x, by_y]| mul_fixed(x, by_x).wrapping_add(mul_fixed(y, by_y)))
    }

    /// How far its points are moved; None if [anchors](Self::anchors) say it.
    pub(super) fn offset(&self) -> Option<[i32; 2]> {
        if self.flags & ARGUMENTS_ARE_OFFSETS == 0 {
            return None;
        }
        let offset = self.arguments.map(i32::from);
        if !self.is_scaled() || self.flags & (OFFSET_IS_SCALED | OFFSET_IS_UNSCALED) != OFFSET_IS_SCALED {
            return Some(offset);
        }
        let [[xx, xy], [yx, yy]] = self.matrix;
        Some([mul_fixed(offset[0], length(xx, xy)), mul_fixed(offset[1], length(yy, yx))])
    }

    /// The numbers of a point that is there already and of one of its own, which are to coincide.
    pub(super) fn anchors(&self) -> [usize; 2] {
        self.arguments.map(|number| usize::from(number as u16))
    }
}

/// About the length of a vector, as FreeType reckons it (`ttgload.c`).
fn length(a: i32, b: i32) -> i32 {
    let (a, b) = (a.abs(), b.abs());
    a.max(b) + ((3 * a.min(b)) >> 3)
}
