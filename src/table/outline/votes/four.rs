//! The votes, four rules at a time and without branches.

use wide::i32x4;

use super::super::rules::{ROOM, Rules, equal};
use super::super::scores::Scores;
use super::Candidate;

#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Votes<const N: usize> {
    positions: [i32x4; N],
    /// 0 for rules that lack what they need.
    weights: [i32x4; N],
    /// The weights of all rules with the same position; 0 for rules that lack what they need, and once the position is a candidate.
    sums: [i32x4; N],
    /// All weights together, but for those of candidates.
    pub(in super::super) left: u32,
}

impl<const N: usize> Votes<N> {
    #[inline(always)]
    pub(in super::super) fn new(rules: &Rules<N>, scores: &Scores) -> Self {
        let (positions, valid) = (rules.lanes, rules.valid());
        let weights: [i32x4; N] =
            core::array::from_fn(|group| (scores.group(group) + i32x4::splat(1)) & valid[group]);
        let left = weights.into_iter().fold(i32x4::splat(0), |left, weights| left + weights);
        let sums = sums(positions, weights);
        let sums = core::array::from_fn(|group| sums[group] & valid[group]);
        Self { positions, weights, sums, left: left.reduce_add() as u32 }
    }

    /// Takes the next candidate, if any position is left.
    #[inline(always)]
    pub(in super::super) fn take(&mut self) -> Option<Candidate> {
        let (first, weight) = highest(self.sums);
        if weight == 0 {
            return None;
        }
        let position = self.positions[first / 4 % N].to_array()[first % 4];
        let equal = equal(self.positions, position);
        let (rule, best) =
            highest(core::array::from_fn::<_, N, _>(|group| self.weights[group] & equal[group]));
        self.sums = core::array::from_fn(|group| self.sums[group] & !equal[group]);
        Some(Candidate { position, weight, rule, score: (best - 1) as u16 })
    }
}

/// For each rule, the weights of all rules with the same position. All are compared with all: that takes less time than it takes to find
/// out which need not be.
#[inline(always)]
fn sums<const N: usize>(positions: [i32x4; N], weights: [i32x4; N]) -> [i32x4; N] {
    let mut sums = [i32x4::splat(0); N];
    for (group, (four, weights)) in positions.into_iter().zip(weights).enumerate() {
        // The last rule needs a track above, and the last lane has none.
        let count = if group > 0 && group + 1 == N { 3 } else { 4 };
        for (position, weight) in four.to_array().into_iter().zip(weights.to_array()).take(count) {
            for (sum, equal) in sums.iter_mut().zip(equal(positions, position)) {
                *sum += equal & i32x4::splat(weight);
            }
        }
    }
    sums
}

/// The highest of some numbers below 2²⁷ that are not negative, the first of equal ones: its lane, and the number.
#[inline(always)]
fn highest<const N: usize>(numbers: [i32x4; N]) -> (usize, u32) {
    const LAST: i32 = ROOM as i32 - 1;
    let keys: [i32x4; N] = core::array::from_fn(|group| {
        let first = LAST - 4 * group as i32;
        numbers[group] << ROOM.ilog2() as i32 | i32x4::new([first, first - 1, first - 2, first - 3])
    });
    let key = keys.into_iter().fold(i32x4::splat(0), i32x4::max).reduce_max();
    ((LAST - key % ROOM as i32) as usize, key as u32 / ROOM as u32)
}
