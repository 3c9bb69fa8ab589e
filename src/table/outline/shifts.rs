//! How far each rule was off where the first candidate was wrong. A position that no candidate gives is coded as its distance from the
//! rule that was off least, moved on by as much as it was off.

use super::rules::{RULES, Rules};
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
    by: [i8; RULES],
    /// How far it lay from there on average, in 1/4 of 1/64 pixel.
    mean: [u8; RULES],
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
        Self { by: [0; RULES], mean: [(4 * UNKNOWN) as u8; RULES] }
    }

    /// The position of the rule that was off least; of several the first.
    #[inline]
    pub(super) fn reference<const N: usize>(&self, rules: &Rules<N>) -> Reference {
        // There are always rules that need nothing.
        let (mut best, mut position) = (i32::MAX, 0);
        for (rule, from) in rules.each() {
            let mean = self.mean[rule].into();
            if mean < best {
                (best, position) = (mean, from.wrapping_add(self.by[rule].into()));
            }
        }
        Reference { position, context: class(best, [4, 8, 16, 32, 56, 88]) }
    }

    /// Learns how far each rule was off.
    #[inline]
    pub(super) fn update<const N: usize>(&mut self, rules: &Rules<N>, position: i32) {
        for (rule, from) in rules.each() {
            let (by, mean) = (&mut self.by[rule], &mut self.mean[rule]);
            let off = position.wrapping_sub(from).wrapping_sub((*by).into()).clamp(-MOST, MOST);
            let far = off.abs();
            *mean = (i32::from(*mean) + ((4 * far - i32::from(*mean)) >> RATE)) as u8;
            if far <= FOLLOWED {
                *by = by.saturating_add((off >> 1) as i8);
            }
        }
    }
}

#[cfg(test)]
mod tests;
