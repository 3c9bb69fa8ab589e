//! Composed glyphs: the models of other glyphs, each at an offset, as in accented letters.

use alloc::vec::Vec;

use super::outline::scale_of;
use super::sizes::{HintedSize, Scale};
use crate::error::Damage;
use crate::number::{floor, mul_fixed};

/// Offsets that are not rounded to the pixel grid are rounded to this fraction of a pixel, as scaled outlines are.
const FRACTION: f32 = 64.0;

/// A glyph that has no model of its own.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Composed {
    /// The glyph.
    pub gid: u16,
    /// Its parts. Its coverage is the sum of theirs.
    pub parts: Vec<Part>,
}

/// One part of a composed glyph: a glyph that has a model of its own, and its offset.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Part {
    /// The glyph.
    pub gid: u16,
    /// The offset along x and y, in font units.
    pub offset: [i16; 2],
    /// For x and y: empty if the scaled offset is rounded to 1/64 pixel. Otherwise it is rounded to the pixel grid, and
    /// these are the pixels that are added to [`round_to_grid`] at each trained size.
    pub grid_offsets: [Vec<i8>; 2],
}

impl Part {
    /// The offset along x and y at a size, in 1/64 pixel, as it is added to hinted outlines: scaled as FreeType does it, and
    /// rounded to the pixel grid where it has grid offsets, which are then added.
    pub fn offset_at(&self, size: &HintedSize, units_per_em: u16) -> [i32; 2] {
        [0, 1].map(|axis| {
            let grid_offset = self.grid_offsets[axis].get(size.index).filter(|_| size.strength > 0.0);
            let follows_whole_size = grid_offset.is_some() || axis == 1;
            let ppem = if follows_whole_size { size.trained_ppem } else { size.ppem };
            let scaled = mul_fixed(self.offset[axis].into(), scale_of(ppem, units_per_em));
            match grid_offset {
                Some(pixels) => ((scaled + 32) & !63) + 64 * i32::from(*pixels),
                None => scaled,
            }
        })
    }

    /// The memory that it takes, in bytes.
    pub fn memory(&self) -> usize {
        size_of::<Self>() + self.grid_offsets.iter().map(Vec::len).sum::<usize>()
    }
}

/// `offset` (font units) at a size, rounded to whole pixels, halves upwards.
pub fn round_to_grid(offset: i16, ppem: usize, units_per_em: u16) -> i32 {
    // In integers, so that it is the same on every machine: floor(offset · ppem / units + ½).
    let units = i64::from(units_per_em);
    (2 * i64::from(offset) * ppem as i64 + units).div_euclid(2 * units) as i32
}

/// `offset` (em) at a size in pixels, rounded to 1/64.
pub fn round_to_fraction(offset: f32, ppem: f32) -> f32 {
    floor(offset * ppem * FRACTION + 0.5) as f32 / FRACTION
}

/// The origin of a part, ready to evaluate.
#[derive(Debug, Clone, Default)]
pub struct Origin {
    /// In em.
    offset: [f32; 2],
    /// For x and y: how far rounding to the grid moves the part at each size, in pixels; empty if it is not rounded.
    moves: [Vec<f32>; 2],
}

impl Origin {
    /// The origin of a part.
    ///
    /// # Errors
    ///
    /// `Malformed` if it has not one offset for each size.
    pub fn new(part: &Part, scale: Scale) -> Result<Self, Damage> {
        if part.grid_offsets.iter().any(|offsets| !offsets.is_empty() && offsets.len() != scale.sizes()) {
            return Err(Damage::Malformed("has the wrong number of offsets for a part"));
        }
        let em = part.offset.map(|v| f32::from(v) / f32::from(scale.units_per_em()));
        let moves = [0, 1].map(|axis| {
            let moved = |(size, more): (usize, &i8)| {
                let ppem = scale.ppem_of(size);
                let pixel = round_to_grid(part.offset[axis], ppem, scale.units_per_em()) + i32::from(*more);
                pixel as f32 - em[axis] * ppem as f32
            };
            part.grid_offsets[axis].iter().enumerate().map(moved).collect()
        });
        Ok(Self { offset: em, moves })
    }

    /// The position in pixels at a size.
    pub fn at(&self, size: &HintedSize) -> [f32; 2] {
        [0, 1].map(|axis| match self.moves[axis].get(size.index) {
            Some(moved) => self.offset[axis] * size.trained_ppem + moved * size.strength,
            None => round_to_fraction(self.offset[axis], size.ppem),
        })
    }

    /// The memory that it takes, in bytes.
    pub fn memory(&self) -> usize {
        size_of::<Self>() + self.moves.iter().map(Vec::len).sum::<usize>() * size_of::<f32>()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use alloc::vec;

    use super::*;

    const SCALE: Scale = match Scale::new(1000, 10, 12) {
        Some(scale) => scale,
        None => unreachable!(),
    };

    #[test]
    fn halves_are_rounded_upwards() {
        let at = |offset, ppem| round_to_grid(offset, ppem, 1000);
        assert_eq!([at(49, 10), at(50, 10), at(-50, 10), at(-51, 10)], [0, 1, 0, -1]);
        assert_eq!(at(i16::MIN, 1024), -33_554);
    }

    #[test]
    fn offsets_are_rounded_to_the_grid_along_one_axis_and_to_a_fraction_along_the_other() {
        let part = Part { gid: 1, offset: [123, 260], grid_offsets: [vec![], vec![0, 1, -1]] };
        let origin = Origin::new(&part, SCALE).unwrap();
        for (ppem, y) in [(10.0, 3.0), (11.0, 4.0), (12.0, 2.0)] {
            let [at_x, at_y] = origin.at(&SCALE.at(ppem));
            assert!(
                (at_x - (0.123 * ppem * 64.0).round() / 64.0).abs() < 1e-5 && (at_y - y).abs() < 1e-5,
                "{ppem}: {at_x}, {at_y}"
            );
        }
        for (ppem, y) in [(10.4, 3.0), (10.5, 4.0), (11.4, 4.0), (11.6, 2.0)] {
            assert!(
                (origin.at(&SCALE.at(ppem))[1] - y).abs() < 1e-5,
                "a fractional size is hinted as the nearest whole one"
            );
        }
        assert!(
            (origin.at(&SCALE.at(100.0))[1] - 26.0).abs() < 1e-4,
            "nothing is hinted at sizes that are not trained"
        );
    }

    #[test]
    fn a_part_without_an_offset_for_each_size_is_malformed() {
        let part = Part { grid_offsets: [vec![], vec![0; 2]], ..Part::default() };
        assert!(matches!(Origin::new(&part, SCALE), Err(Damage::Malformed(_))));
    }
}
