//! How far each rule was off where the first candidate was wrong. A position that no candidate gives is coded as its distance from the
//! rule that was off least, moved on by as much as it was off.

use super::rules::{LANES, ROOM, Rules, VALID};
use crate::table::context_model::class;

/// The mean distance at the start, and the most that counts, in 1/64 pixel.
const UNKNOWN: i32 = 20;
const MOST: i32 = 48;
/// Rules follow changes up to this, in 1/64 pixel. Larger ones are jumps, mostly by whole pixels, that do not last.
const FOLLOWED: i32 = 24;
/// The mean changes by this fraction of its distance from a new one, as a shift.
const RATE: i32 = 2;

/// The distances of all rules from a track's positions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shifts {
    /// How far the position lay above the rule's, in 1/64 pixel, smoothed.
    by: [i8; LANES],
    /// How far it lay from there on average, in 1/4 of 1/64 pixel.
    mean: [u8; LANES],
}

/// What a distance counts from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reference {
    pub(super) position: i32,
    /// How far it was off, quantised to 0 to 6.
    pub(super) context: usize,
}

impl Shifts {
    pub(super) fn new() -> Self {
        Self { by: [0; LANES], mean: [(4 * UNKNOWN) as u8; LANES] }
    }

    /// The position of the rule that was off least; of several the first.
    #[inline]
    pub(super) fn reference(&self, positions: &[i32; ROOM], valid: usize) -> Reference {
        let valid = &VALID[valid % VALID.len()].lanes;
        // There are always rules that need nothing. A mean has 8 bits.
        let mut best = i32::MAX;
        for (rule, (mean, valid)) in self.mean.iter().zip(valid).enumerate() {
            let key = i32::from(*mean) << 4 | rule as i32 | !i32::from(*valid) & 1 << 16;
            best = best.min(key);
        }
        let rule = best as usize % ROOM;
        let by = self.by.get(rule).copied().unwrap_or(0);
        Reference {
            position: positions[rule].wrapping_add(by.into()),
            context: class(best >> 4, [4, 8, 16, 32, 56, 88]),
        }
    }

    /// Learns how far each rule was off.
    #[inline]
    pub(super) fn update<const N: usize>(&mut self, rules: &Rules<N>, position: i32) {
        let valid = &VALID[rules.valid % VALID.len()].lanes;
        let numbers = self.by.iter_mut().zip(&mut self.mean).zip(rules.positions.iter().zip(valid));
        for ((by, mean), (from, valid)) in numbers.take(4 * N) {
            let off = position.wrapping_sub(*from).wrapping_sub((*by).into()).clamp(-MOST, MOST);
            let (valid, far) = (i32::from(*valid), off.abs());
            *mean = (i32::from(*mean) + (valid & (4 * far - i32::from(*mean)) >> RATE)) as u8;
            let followed = if far <= FOLLOWED { off >> 1 } else { 0 };
            *by = by.saturating_add((valid & followed) as i8);
        }
    }
}

#[cfg(test)]
mod tests;
