//! How often each rule was right for a track, and the candidates that follow from it.

use wide::i32x4;

use super::rules::{LANES, ROOM, RULES, Rules, VALID};

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

/// How often each rule was right, in 1/65536.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scores([u16; LANES]);

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
            *score = u16::from(initial) << 8;
        }
        Self(scores)
    }

    /// Those of four rules.
    #[inline(always)]
    fn group(&self, group: usize) -> i32x4 {
        i32x4::new([0, 1, 2, 3].map(|lane| self.0[(4 * group + lane) % LANES].into()))
    }

    /// Groups the rules by their positions.
    #[inline(always)]
    pub(super) fn rank<const N: usize>(&self, rules: &Rules<N>, ranked: &mut Ranked) {
        let (positions, valid): ([_; N], [_; N]) = (rules.lanes(), rules.valid());
        let weights: [i32x4; N] =
            core::array::from_fn(|group| (self.group(group) + i32x4::splat(1)) & valid[group]);
        let mut left = VALID[rules.valid % VALID.len()].bits;
        (ranked.count, ranked.selected, ranked.total) = (0, 0, 0);
        for place in &mut ranked.places {
            if left == 0 {
                break;
            }
            let position = rules.positions[left.trailing_zeros() as usize % ROOM];
            let equal = equal(positions, position);
            let (mut rules, mut weight) = (0, i32x4::splat(0));
            for (group, equal) in equal.into_iter().enumerate() {
                rules |= equal.to_bitmask() << (4 * group);
                weight += equal & weights[group];
            }
            *place = Place { position, weight: weight.reduce_add() as u32, rules: rules & left };
            left &= !rules;
            ranked.total += place.weight;
            ranked.count += 1;
        }
    }

    /// Learns which rules were right.
    #[inline(always)]
    pub(super) fn update<const N: usize>(&mut self, rules: &Rules<N>, position: i32) {
        let (equal, valid) = (equal(rules.lanes(), position), rules.valid());
        for (group, (equal, valid)) in equal.into_iter().zip(valid).enumerate() {
            let scores = self.group(group);
            let more = (i32x4::splat(ALWAYS) - scores) >> SCORE_RATE;
            let less = i32x4::splat(0) - (scores >> SCORE_RATE);
            let scores = scores + (valid & (equal & more | !equal & less));
            for (lane, score) in scores.to_array().into_iter().enumerate() {
                self.0[(4 * group + lane) % LANES] = score as u16;
            }
        }
    }

    /// The rule with the highest score among some, and that score. `rules` has a bit for each.
    #[inline(always)]
    fn best(&self, rules: u32) -> (usize, u16) {
        let (mut best, mut score, mut left) = (0, -1, rules);
        while left != 0 {
            let rule = left.trailing_zeros() as usize;
            left &= left - 1;
            let own = self.0.get(rule).map_or(0, |score| i32::from(*score));
            (best, score) = if own > score { (rule, own) } else { (best, score) };
        }
        (best, score as u16)
    }
}

/// A position that some rules give.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    position: i32,
    /// The sum of their scores, and of 1 for each; 0 once the position is a candidate.
    weight: u32,
    /// A bit for each of them.
    rules: u32,
}

/// A position that is tried.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Candidate {
    pub(super) position: i32,
    /// The sum of the scores of the rules that give it.
    pub(super) weight: u32,
    /// The one with the highest score.
    pub(super) rule: usize,
    /// That score.
    pub(super) score: u16,
}

/// The candidates that are tried in turn: the positions with the highest sums of scores, highest first. Most often the first
/// one is right, so each is looked for when it is asked for.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ranked {
    places: [Place; RULES],
    count: usize,
    candidates: [Candidate; CANDIDATES],
    /// How many candidates are found.
    selected: usize,
    /// The sum of all weights, those of positions that are not tried included.
    pub(super) total: u32,
}

impl Ranked {
    /// Finds the next candidate, if there is one.
    #[inline(always)]
    fn select(&mut self, scores: &Scores) -> Option<Candidate> {
        let slot = self.candidates.get_mut(self.selected)?;
        let places = self.places.get_mut(..self.count)?;
        let (mut best, mut weight) = (0, 0);
        for (at, place) in places.iter().enumerate() {
            (best, weight) = if place.weight > weight { (at, place.weight) } else { (best, weight) };
        }
        if weight == 0 {
            return None;
        }
        let place = places.get_mut(best)?;
        place.weight = 0;
        let (rule, score) = scores.best(place.rules);
        *slot = Candidate { position: place.position, weight, rule, score };
        self.selected += 1;
        Some(*slot)
    }

    /// A candidate, if there are as many.
    #[inline(always)]
    pub(super) fn candidate(&mut self, rank: usize, scores: &Scores) -> Option<Candidate> {
        if rank < self.selected { self.candidates.get(rank).copied() } else { self.select(scores) }
    }

    /// All candidates.
    pub(super) fn all(&mut self, scores: &Scores) -> &[Candidate] {
        while self.select(scores).is_some() {}
        &self.candidates[..self.selected]
    }
}

#[cfg(test)]
mod tests;
