//! How often each rule was right for a track, and the candidates that follow from it.

use wide::i32x4;

use super::rules::{LANES, ROOM, RULES, Rules, lanes};

/// The most candidates that are tried before a position is coded as a number.
pub(super) const CANDIDATES: usize = 2;
/// A score changes by this fraction of its distance from 0 or 1, as a shift.
const SCORE_RATE: i32 = 3;
/// The score 1.
const ALWAYS: i32 = 65535;

/// For each lane with this number, all bits.
#[inline(always)]
fn equal<const N: usize>(lanes: [i32x4; N], number: i32) -> [i32x4; N] {
    let number = i32x4::splat(number);
    lanes.map(|lanes| lanes.simd_eq(number))
}

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
    fn group(&self, group: usize) -> i32x4 {
        i32x4::new([0, 1, 2, 3].map(|lane| i32::from(self.0[(4 * group + lane) % LANES])))
    }

    /// The votes of the rules that have what they need.
    #[inline(always)]
    pub(super) fn votes<const N: usize>(&self, rules: &Rules<N>) -> Votes<N> {
        let valid = rules.valid();
        let weights = core::array::from_fn(|group| (self.group(group) + i32x4::splat(1)) & valid[group]);
        Votes::new(rules.lanes, valid, weights)
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

/// A position that is tried.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Candidate {
    pub(super) position: i32,
    /// The sum of the scores of the rules that give it, and of 1 for each.
    pub(super) weight: u32,
    /// The one with the highest score.
    pub(super) rule: usize,
    /// That score.
    pub(super) score: u16,
}

/// What rules vote for: each for its position, with its score and 1. The candidates, which are tried in turn, are the positions with
/// the highest sums, highest first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Votes<const N: usize> {
    positions: [i32x4; N],
    /// 0 for rules that lack what they need.
    weights: [i32x4; N],
    /// The weights of all rules with the same position, at least for the first of them; 0 for rules that lack what they need, and once
    /// the position is a candidate.
    sums: [i32x4; N],
    /// All weights together, but for those of candidates.
    pub(super) left: u32,
}

impl<const N: usize> Votes<N> {
    #[inline(always)]
    fn new(positions: [i32x4; N], valid: [i32x4; N], weights: [i32x4; N]) -> Self {
        let left = weights.into_iter().fold(i32x4::splat(0), |left, weights| left + weights);
        let sums = if cfg!(feature = "small") {
            sums_of_first(positions, weights)
        } else {
            let sums = sums_of_all(positions, weights);
            core::array::from_fn(|group| sums[group] & valid[group])
        };
        Self { positions, weights, sums, left: left.reduce_add() as u32 }
    }

    /// Takes the next candidate, if any position is left.
    #[inline(always)]
    pub(super) fn take(&mut self) -> Option<Candidate> {
        let (first, weight) = highest(self.sums);
        if weight == 0 {
            return None;
        }
        let position = flat(self.positions)[first % ROOM];
        let equal = equal(self.positions, position);
        let (rule, best) =
            highest(core::array::from_fn::<_, N, _>(|group| self.weights[group] & equal[group]));
        self.sums = core::array::from_fn(|group| self.sums[group] & !equal[group]);
        Some(Candidate { position, weight, rule, score: (best - 1) as u16 })
    }

    /// All candidates.
    pub(super) fn all(mut self) -> impl Iterator<Item = Candidate> {
        (0..CANDIDATES).map_while(move |_| self.take())
    }
}

/// For each rule, the weights of all rules with the same position. All are compared with all: that takes less time than it takes to find
/// out which need not be.
#[inline(always)]
fn sums_of_all<const N: usize>(positions: [i32x4; N], weights: [i32x4; N]) -> [i32x4; N] {
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

/// The same for the first rule of each position, and 0 for the others: less code, and fewer steps where there is no SIMD.
fn sums_of_first<const N: usize>(positions: [i32x4; N], weights: [i32x4; N]) -> [i32x4; N] {
    let (positions, weights) = (flat(positions), flat(weights));
    let mut sums = [0; ROOM];
    for (at, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0) {
        let is_same = |first: &usize| weights[*first] > 0 && positions[*first] == positions[at];
        sums[(0..at).find(is_same).unwrap_or(at)] += weight;
    }
    lanes(&sums)
}

/// Numbers one by one.
#[inline(always)]
fn flat<const N: usize>(lanes: [i32x4; N]) -> [i32; ROOM] {
    let mut flat = [0; ROOM];
    for (flat, lanes) in flat.chunks_exact_mut(4).zip(lanes) {
        flat.copy_from_slice(&lanes.to_array());
    }
    flat
}

/// The highest of some numbers below 2²⁷ that are not negative, the first of equal ones: its lane, and the number.
#[inline(always)]
fn highest<const N: usize>(numbers: [i32x4; N]) -> (usize, u32) {
    if cfg!(feature = "small") {
        let numbers = flat(numbers).into_iter().enumerate();
        let highest =
            numbers.fold((0, 0), |best, (at, number)| if number > best.1 { (at, number) } else { best });
        return (highest.0, highest.1 as u32);
    }
    const LAST: i32 = ROOM as i32 - 1;
    let keys: [i32x4; N] = core::array::from_fn(|group| {
        let first = LAST - 4 * group as i32;
        numbers[group] << ROOM.ilog2() as i32 | i32x4::new([first, first - 1, first - 2, first - 3])
    });
    let key = keys.into_iter().fold(i32x4::splat(0), i32x4::max).reduce_max();
    ((LAST - key % ROOM as i32) as usize, key as u32 / ROOM as u32)
}

#[cfg(test)]
mod tests;
