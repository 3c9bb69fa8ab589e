//! How often each rule was right for a track.

use wide::i32x4;

use super::rules::{LANES, RULES, Rules, equal};

/// A score changes by this fraction of its distance from 0 or 1, as a shift.
const SCORE_RATE: i32 = 3;
/// The score 1.
const ALWAYS: i32 = 65535;

/// A score, in 1/65536: as wide as they are computed with, or as few bytes as can be.
#[cfg(not(feature = "small"))]
type Score = i32;
#[cfg(feature = "small")]
type Score = u16;

/// How often each rule was right.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scores([Score; LANES]);

/// The initial scores by the kind of neighbours, in 1/256.
const INITIAL: [[u8; RULES]; 3] = [
    [150, 40, 120, 200, 0, 0, 0, 0, 0, 0, 0],
    [120, 30, 80, 200, 130, 40, 120, 0, 0, 0, 0],
    [80, 20, 60, 200, 90, 40, 90, 90, 90, 40, 90],
];

impl Scores {
    pub(super) fn new(kind: usize) -> Self {
        let mut scores = [0; LANES];
        for (score, initial) in scores.iter_mut().zip(INITIAL[kind]) {
            *score = Score::from(initial) << 8;
        }
        Self(scores)
    }

    /// Those of four rules.
    #[cfg_attr(
        not(feature = "small"),
        expect(clippy::useless_conversion, reason = "devices keep fewer bytes")
    )]
    #[inline(always)]
    pub(super) fn group(&self, group: usize) -> i32x4 {
        i32x4::new([0, 1, 2, 3].map(|lane| i32::from(self.0[(4 * group + lane) % LANES])))
    }

    /// That of a rule.
    #[cfg(feature = "small")]
    pub(super) fn of(&self, rule: usize) -> u16 {
        self.0[rule % LANES]
    }

    /// Learns which rules were right.
    #[inline(always)]
    pub(super) fn update<const N: usize>(&mut self, rules: &Rules<N>, position: i32) {
        let (equal, valid) = (equal(rules.lanes, position), rules.valid());
        for (group, (equal, valid)) in equal.into_iter().zip(valid).enumerate() {
            let scores = self.group(group);
            let more = (i32x4::splat(ALWAYS) - scores) >> SCORE_RATE;
            let less = i32x4::splat(0) - (scores >> SCORE_RATE);
            let scores = scores + (valid & (equal & more | !equal & less));
            for (lane, score) in scores.to_array().into_iter().enumerate() {
                self.0[(4 * group + lane) % LANES] = score as Score;
            }
        }
    }
}

#[cfg(test)]
mod tests;
