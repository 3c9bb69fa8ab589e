//! Candidates for the hinted position of a track at a size: simple rules, each with a score of how often it was right for
//! this track.

use alloc::vec::Vec;

use crate::model::outline::interpolated;

/// The number of rules.
pub(super) const RULES: usize = 14;
/// The most candidates that are tried before a position is coded as a number.
pub(super) const CANDIDATES: usize = 4;
/// A score changes by this fraction of its distance from 0 or 1, as a shift.
const SCORE_RATE: u32 = 3;

/// The tracks that are coded before one and lie beside it: the nearest below, or at the same level, and the nearest above.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Neighbours {
    /// The track below.
    pub(super) lower: Option<usize>,
    /// The track above.
    pub(super) upper: Option<usize>,
}

impl Neighbours {
    /// 0 without any, 1 with a lower one, 2 with an upper one, 3 with both.
    pub(super) fn kind(self) -> usize {
        usize::from(self.lower.is_some()) + 2 * usize::from(self.upper.is_some())
    }
}

/// The order in which tracks are coded: the lowest, the highest, and then the middle of each gap, which
/// makes two gaps at the end of the line.
pub(super) fn coding_order(count: usize) -> Vec<(usize, Neighbours)> {
    let mut order = Vec::with_capacity(count);
    if count > 0 {
        order.push((0, Neighbours::default()));
    }
    if count > 1 {
        order.push((count - 1, Neighbours { lower: Some(0), upper: None }));
    }
    let mut gaps = Vec::with_capacity(count);
    gaps.push((0, count.saturating_sub(1)));
    let mut next = 0;
    while let Some(&(lower, upper)) = gaps.get(next) {
        next += 1;
        if upper - lower > 1 {
            let middle = (lower + upper) / 2;
            order.push((middle, Neighbours { lower: Some(lower), upper: Some(upper) }));
            gaps.extend([(lower, middle), (middle, upper)]);
        }
    }
    order
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
    /// The move of the shared track that this one refers to.
    pub(super) shared: Option<i16>,
}

/// A position, rounded to whole pixels.
pub(super) fn to_grid(position: i32) -> i32 {
    position.wrapping_add(32) & !63
}

impl View<'_> {
    /// The position that each rule gives a track; `None` for a rule that lacks what it needs.
    pub(super) fn rules(&self, track: usize, neighbours: Neighbours) -> [Option<i32>; RULES] {
        let plain = self.plain[track];
        let mut rules = [None; RULES];
        rules[0] = Some(to_grid(plain));
        rules[1] = Some(plain);
        let before = |k: usize| self.before.map(|before| before[k]);
        if let Some(before) = before(track) {
            rules[2] = Some(before);
            rules[3] = Some(before.wrapping_add(64));
        }
        if let Some(a) = neighbours.lower {
            let (hinted, apart) = (self.hinted[a], plain.wrapping_sub(self.plain[a]));
            rules[4] = Some(hinted.wrapping_add(to_grid(apart)));
            rules[5] = Some(hinted.wrapping_add(apart));
            rules[6] = Some(hinted.wrapping_add(64));
            rules[7] = before(track).zip(before(a)).map(|(own, a)| hinted.wrapping_add(own.wrapping_sub(a)));
        }
        if let Some(b) = neighbours.upper {
            let (hinted, apart) = (self.hinted[b], self.plain[b].wrapping_sub(plain));
            rules[8] = Some(hinted.wrapping_sub(to_grid(apart)));
            rules[9] = Some(hinted.wrapping_sub(apart));
            rules[10] = before(track).zip(before(b)).map(|(own, b)| hinted.wrapping_sub(b.wrapping_sub(own)));
        }
        if let (Some(a), Some(b)) = (neighbours.lower, neighbours.upper) {
            let ends = [a, b].map(|k| (i32::from(self.levels[k]), self.plain[k], self.hinted[k]));
            let middle = interpolated(ends, self.levels[track].into(), plain);
            rules[11] = Some(middle);
            rules[12] = Some(to_grid(middle));
        }
        rules[13] = self.shared.map(|moved| plain.wrapping_add(moved.into()));
        rules
    }
}

/// How often each rule was right, in 1/65536.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scores([u16; RULES]);

/// The initial scores by the kind of neighbours, in 1/256. The third row, an upper neighbour alone, does not occur in this order.
const INITIAL: [[u8; RULES]; 4] = [
    [150, 40, 120, 40, 0, 0, 0, 0, 0, 0, 0, 0, 0, 200],
    [120, 30, 80, 40, 130, 40, 20, 120, 0, 0, 0, 0, 0, 200],
    [120, 30, 80, 40, 0, 0, 0, 0, 130, 40, 120, 0, 0, 200],
    [80, 20, 60, 30, 90, 40, 30, 90, 90, 40, 90, 90, 60, 200],
];

impl Scores {
    pub(super) fn new(kind: usize) -> Self {
        Self(INITIAL[kind].map(|score| u16::from(score) << 8))
    }

    /// The candidates: the positions with the highest sums of scores, highest first.
    pub(super) fn rank(&self, rules: &[Option<i32>; RULES]) -> Ranked {
        let mut found: [Candidate; RULES] = [Candidate::default(); RULES];
        let mut count = 0;
        for (rule, (position, score)) in rules.iter().zip(self.0).enumerate() {
            let Some(position) = *position else { continue };
            let weight = u32::from(score) + 1;
            match found[..count].iter_mut().find(|candidate| candidate.position == position) {
                Some(candidate) => {
                    candidate.weight += weight;
                    if score > candidate.score {
                        (candidate.rule, candidate.score) = (rule, score);
                    }
                }
                None => {
                    found[count] = Candidate { position, weight, rule, score };
                    count += 1;
                }
            }
        }
        let total = found[..count].iter().map(|candidate| candidate.weight).sum();
        let tried = count.min(CANDIDATES);
        for k in 0..tried {
            let mut best = k;
            for other in k + 1..count {
                if found[other].weight > found[best].weight {
                    best = other;
                }
            }
            found[k..=best].rotate_right(1);
        }
        let mut candidates = [Candidate::default(); CANDIDATES];
        candidates[..tried].copy_from_slice(&found[..tried]);
        Ranked { candidates, count: tried, total }
    }

    /// Learns which rules were right.
    pub(super) fn update(&mut self, rules: &[Option<i32>; RULES], position: i32) {
        for (score, rule) in self.0.iter_mut().zip(rules) {
            match rule {
                Some(rule) if *rule == position => *score += (u16::MAX - *score) >> SCORE_RATE,
                Some(_) => *score -= *score >> SCORE_RATE,
                None => {}
            }
        }
    }
}

/// A position that some rules give.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Candidate {
    pub(super) position: i32,
    /// The sum of those rules' scores.
    pub(super) weight: u32,
    /// The one with the highest score.
    pub(super) rule: usize,
    /// That score.
    pub(super) score: u16,
}

/// The candidates that are tried in turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ranked {
    candidates: [Candidate; CANDIDATES],
    count: usize,
    /// The sum of all candidates' weights, those that are not tried included.
    pub(super) total: u32,
}

impl Ranked {
    pub(super) fn candidates(&self) -> &[Candidate] {
        &self.candidates[..self.count]
    }
}
