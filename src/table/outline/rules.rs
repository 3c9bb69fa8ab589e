//! Candidates for the hinted position of a track at a size: simple rules, each with a score of how often it was right for
//! this track.

use alloc::vec::Vec;

use wide::i32x4;

use crate::model::outline::{interpolated, rounded_down};

/// The number of rules.
pub(super) const RULES: usize = 11;
/// The most candidates that are tried before a position is coded as a number.
pub(super) const CANDIDATES: usize = 2;
/// A score changes by this fraction of its distance from 0 or 1, as a shift.
const SCORE_RATE: i32 = 3;
/// The score 1.
const ALWAYS: i32 = 65535;
/// Rules are compared four at a time; the last lane has none.
const LANES: usize = 4 * GROUPS;
const GROUPS: usize = 3;
/// Room for one number for each lane, a power of two: an index is brought into range by its lowest bits.
const ROOM: usize = LANES.next_power_of_two();

/// The tracks that are coded before one and lie beside it: the nearest below, or at the same level, and the nearest above.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Neighbours {
    /// The track below.
    pub(super) lower: Option<u8>,
    /// The track above.
    pub(super) upper: Option<u8>,
}

impl Neighbours {
    /// 0 without any, 1 with a lower one, 2 with both. In the coding order no track has an upper one alone.
    pub(super) fn kind(self) -> usize {
        usize::from(self.lower.is_some()) + usize::from(self.upper.is_some())
    }
}

/// The order in which tracks are coded: the lowest, the highest, and then the middle of each gap, which
/// makes two gaps at the end of the line.
pub(super) fn coding_order(count: u8) -> Vec<(u8, Neighbours)> {
    let mut order = Vec::with_capacity(count.into());
    if count > 0 {
        order.push((0, Neighbours::default()));
    }
    if count > 1 {
        order.push((count - 1, Neighbours { lower: Some(0), upper: None }));
    }
    let split = |order: &mut Vec<_>, lower: u8, upper: u8| {
        if upper - lower > 1 {
            order.push((lower.midpoint(upper), Neighbours { lower: Some(lower), upper: Some(upper) }));
        }
    };
    split(&mut order, 0, count.saturating_sub(1));
    let mut next = 2;
    while let Some(&(middle, neighbours)) = order.get(next) {
        next += 1;
        if let Neighbours { lower: Some(lower), upper: Some(upper) } = neighbours {
            split(&mut order, lower, middle);
            split(&mut order, middle, upper);
        }
    }
    order
}

/// From font units to 1/64 pixel at a size.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scaling {
    /// The factor, in 1/65536.
    pub(super) factor: i32,
    /// Whether hinted positions and the distances between them are rounded down, as those of PostScript outlines.
    pub(super) rounds_down: bool,
}

/// What the rules look at: levels of the tracks in font units, and their positions in 1/64 pixel at this size and at the one
/// before.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) levels: &'a [i16],
    pub(super) plain: &'a [i32],
    pub(super) hinted: &'a [i32],
    /// None at the first size.
    pub(super) before: Option<&'a [i32]>,
    pub(super) scaling: Scaling,
}

/// A position, rounded to whole pixels.
pub(super) fn to_grid(position: i32) -> i32 {
    position.wrapping_add(32) & !63
}

/// The positions that the rules give a track: of rules in the first `N` groups of four; no other has what it needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules<const N: usize> {
    positions: [i32; ROOM],
    /// The number of a row of [`VALID`].
    valid: usize,
}

/// What a track has beside its plain position: bits of a row of [`VALID`].
const LOWER: usize = 1;
const UPPER: usize = 2;
const BEFORE: usize = 4;
const SHARED: usize = 8;

/// The rules that have what they need.
static VALID: [Valid; 16] = {
    let mut rows = [Valid { bits: 0, lanes: [0; ROOM] }; 16];
    let mut row = 0;
    while row < rows.len() {
        let mut rule = 0;
        while rule < RULES {
            let needs = match rule {
                0 | 1 => 0,
                2 => BEFORE,
                3 => SHARED,
                4 | 5 => LOWER,
                6 => LOWER | BEFORE,
                7 => LOWER | UPPER,
                8 | 9 => UPPER,
                _ => UPPER | BEFORE,
            };
            if row & needs == needs {
                rows[row].bits |= 1 << rule;
                rows[row].lanes[rule] = -1;
            }
            rule += 1;
        }
        row += 1;
    }
    rows
};

#[derive(Clone, Copy)]
struct Valid {
    /// A bit for each rule.
    bits: u32,
    /// The same as masks.
    lanes: [i8; ROOM],
}

impl View<'_> {
    /// The position that each rule gives a track; `shared` is the move of the shared track that it refers to.
    #[inline(always)]
    pub(super) fn rules<const N: usize>(
        &self,
        track: usize,
        neighbours: Neighbours,
        shared: Option<i16>,
    ) -> Rules<N> {
        let plain = self.plain[track];
        let mut at = [0; ROOM];
        let mut valid = 0;
        (at[0], at[1]) = (to_grid(plain), plain);
        let before = |track: usize| self.before.map_or(0, |before| before[track]);
        let own = before(track);
        at[2] = own;
        if self.before.is_some() {
            valid |= BEFORE;
        }
        if let Some(moved) = shared {
            valid |= SHARED;
            at[3] = plain.wrapping_add(moved.into());
        }
        let [lower, upper] = [neighbours.lower, neighbours.upper].map(|track| track.map(usize::from));
        if let (2.., Some(a)) = (N, lower) {
            valid |= LOWER;
            let (hinted, apart) = (self.hinted[a], plain.wrapping_sub(self.plain[a]));
            at[4] = hinted.wrapping_add(to_grid(apart));
            at[5] = hinted.wrapping_add(apart);
            at[6] = hinted.wrapping_add(own.wrapping_sub(before(a)));
        }
        if let (3.., Some(b)) = (N, upper) {
            valid |= UPPER;
            let (hinted, apart) = (self.hinted[b], self.plain[b].wrapping_sub(plain));
            at[8] = hinted.wrapping_sub(to_grid(apart));
            at[9] = hinted.wrapping_sub(apart);
            at[10] = hinted.wrapping_sub(before(b).wrapping_sub(own));
        }
        if let (3.., Some(a), Some(b)) = (N, lower, upper) {
            at[7] = self.between([a, b], track);
        }
        if self.scaling.rounds_down {
            self.of_stems(track, [lower, upper], &mut at);
        }
        Rules { positions: at, valid }
    }

    /// The position of a track, interpolated between two others.
    fn between(&self, ends: [usize; 2], track: usize) -> i32 {
        let ends = ends.map(|k| (i32::from(self.levels[k]), self.plain[k], self.hinted[k]));
        interpolated(ends, self.levels[track].into(), self.plain[track])
    }

    /// The rules that differ for PostScript's hints: they put one edge of a stem on whole pixels, where the tracks around it lead it,
    /// and the other edge as far away as the stem is wide. Positions are rounded down.
    #[inline(never)]
    fn of_stems(&self, track: usize, [lower, upper]: [Option<usize>; 2], at: &mut [i32; ROOM]) {
        let led = |track: usize| match (lower, upper) {
            (Some(a), Some(b)) => self.between([a, b], track),
            _ => self.plain[track],
        };
        at[0] = to_grid(led(track));
        at[1] = rounded_down(self.levels[track].into(), self.scaling.factor);
        // The other edge may be the track above or the one below.
        let [above, below] = [track.checked_add(1), track.checked_sub(1)]
            .map(|other| other.filter(|other| *other < self.levels.len()));
        let under = above.map(|other| to_grid(led(other)).wrapping_sub(self.width(track, other)[1]));
        let over = below.map(|other| to_grid(led(other)).wrapping_add(self.width(other, track)[0]));
        (at[4], at[8]) = (under.or(over).unwrap_or(at[0]), over.or(under).unwrap_or(at[0]));
        let is_whole = |position: i32| position & 63 == 0;
        if let Some(a) = lower {
            let [down, up] = self.width(a, track);
            at[5] = self.hinted[a].wrapping_add(if is_whole(self.hinted[a]) { down } else { up });
        }
        if let Some(b) = upper {
            let [down, up] = self.width(track, b);
            at[9] = self.hinted[b].wrapping_sub(if is_whole(self.hinted[b]) { up } else { down });
        }
    }

    /// How far a track is above another, rounded down and up.
    fn width(&self, lower: usize, upper: usize) -> [i32; 2] {
        let units = i32::from(self.levels[upper]) - i32::from(self.levels[lower]);
        [rounded_down(units, self.scaling.factor), rounded_down(-units, self.scaling.factor).wrapping_neg()]
    }
}

impl<const N: usize> Rules<N> {
    /// The positions that rules give, four at a time.
    #[inline(always)]
    fn lanes(&self) -> [i32x4; N] {
        lanes(&self.positions)
    }

    /// For each rule that has what it needs, all bits.
    #[inline(always)]
    fn valid(&self) -> [i32x4; N] {
        lanes(&VALID[self.valid % VALID.len()].lanes)
    }
}

#[inline(always)]
fn lanes<const N: usize, T: Copy + Into<i32>>(from: &[T; ROOM]) -> [i32x4; N] {
    core::array::from_fn(|group| i32x4::new([0, 1, 2, 3].map(|lane| from[(4 * group + lane) % ROOM].into())))
}

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
