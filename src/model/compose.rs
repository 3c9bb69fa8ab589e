//! Glyphs that are put together from the models of others, as accented letters are.

use alloc::vec::Vec;

use super::gridfit::{Scale, floor};
use crate::error::Damage;

/// What does not snap to pixels stands on a grid of this fraction of a pixel, that of scaled outlines.
const GRID: f32 = 64.0;

/// A glyph that has no model of its own.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Composed {
    /// The glyph.
    pub gid: u16,
    /// What it is put together from; its coverage is the sum of theirs.
    pub parts: Vec<Part>,
}

/// One part of a composed glyph: a glyph that has a model of its own, and where it stands.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Part {
    /// The glyph.
    pub gid: u16,
    /// How far it is moved along x and y, in font units.
    pub offset: [i16; 2],
    /// For x and y: empty if the part stands there at any size, to 1/64 pixel. Otherwise it stands on a whole pixel,
    /// and this says for each trained size how many pixels from [`snapped`].
    pub snaps: [Vec<i8>; 2],
}

/// The whole pixel nearest to `offset` (font units) at a size.
pub fn snapped(offset: i16, ppem: usize, units_per_em: u16) -> i32 {
    // In integers, so that it is the same everywhere: floor(offset · ppem / units + ½).
    let units = i64::from(units_per_em);
    (2 * i64::from(offset) * ppem as i64 + units).div_euclid(2 * units) as i32
}

/// The place in pixels of what does not snap, at an offset in em.
pub fn unsnapped(offset: f32, ppem: f32) -> f32 {
    floor(offset * ppem * GRID + 0.5) as f32 / GRID
}

/// Where a part stands, ready to evaluate.
#[derive(Debug, Clone)]
pub struct Origin {
    scale: Scale,
    /// In em.
    offset: [f32; 2],
    /// For x and y: how far snapping moves the part at each size, in pixels; empty if it does not snap.
    moves: [Vec<f32>; 2],
}

impl Origin {
    /// The origin of a glyph that stands where it is.
    pub fn zero(scale: Scale) -> Self {
        Self { scale, offset: [0.0; 2], moves: [Vec::new(), Vec::new()] }
    }

    /// Where a part stands.
    ///
    /// # Errors
    ///
    /// `Malformed` if it has not one snap for each size.
    pub fn new(part: &Part, scale: Scale) -> Result<Self, Damage> {
        if part.snaps.iter().any(|snaps| !snaps.is_empty() && snaps.len() != scale.sizes()) {
            return Err(Damage::Malformed("has the wrong number of places for a part"));
        }
        let em = part.offset.map(|v| f32::from(v) / f32::from(scale.units_per_em()));
        let moves = [0, 1].map(|axis| {
            let moved = |(size, snap): (usize, &i8)| {
                let ppem = scale.ppem_of(size);
                let pixel = snapped(part.offset[axis], ppem, scale.units_per_em()) + i32::from(*snap);
                pixel as f32 - em[axis] * ppem as f32
            };
            part.snaps[axis].iter().enumerate().map(moved).collect()
        });
        Ok(Self { scale, offset: em, moves })
    }

    /// The place in pixels at a size. A part that snaps stands where it does at the trained size that
    /// stands for this one; beyond the trained sizes nothing snaps.
    pub fn at(&self, ppem: f32) -> [f32; 2] {
        let fit = self.scale.fit(ppem);
        [0, 1].map(|axis| match self.moves[axis].get(fit.size) {
            Some(moved) => self.offset[axis] * fit.grid + moved * fit.strength,
            None => unsnapped(self.offset[axis], ppem),
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
    fn halves_snap_upwards() {
        let at = |offset, ppem| snapped(offset, ppem, 1000);
        assert_eq!([at(49, 10), at(50, 10), at(-50, 10), at(-51, 10)], [0, 1, 0, -1]);
        assert_eq!(at(i16::MIN, 1024), -33_554);
    }

    #[test]
    fn a_part_stands_on_its_pixels_along_one_axis_and_at_its_place_along_the_other() {
        let part = Part { gid: 1, offset: [123, 260], snaps: [vec![], vec![0, 1, -1]] };
        let origin = Origin::new(&part, SCALE).unwrap();
        for (ppem, y) in [(10.0, 3.0), (11.0, 4.0), (12.0, 2.0)] {
            let [at_x, at_y] = origin.at(ppem);
            assert!(
                (at_x - (0.123 * ppem * 64.0).round() / 64.0).abs() < 1e-5 && (at_y - y).abs() < 1e-5,
                "{ppem}: {at_x}, {at_y}"
            );
        }
        for (ppem, y) in [(10.4, 3.0), (10.5, 4.0), (11.4, 4.0), (11.6, 2.0)] {
            assert!((origin.at(ppem)[1] - y).abs() < 1e-5, "between sizes it stands as at the nearer one");
        }
        assert!((origin.at(100.0)[1] - 26.0).abs() < 1e-4, "nothing snaps beyond the trained sizes");
    }

    #[test]
    fn a_part_without_a_place_for_each_size_is_malformed() {
        let part = Part { snaps: [vec![], vec![0; 2]], ..Part::default() };
        assert!(matches!(Origin::new(&part, SCALE), Err(Damage::Malformed(_))));
    }
}
