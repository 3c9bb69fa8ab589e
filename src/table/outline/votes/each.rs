//! The votes, rule by rule: less code, and fewer steps where there is no SIMD.

use super::super::rules::{RULES, Rules};
use super::super::scores::Scores;
use super::Candidate;

#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Votes<const N: usize> {
    /// The positions as candidates, in the order of the first rule of each, and with weight 0 once they were taken.
    places: [Candidate; RULES],
    count: usize,
    /// All weights together, but for those of candidates.
    pub(in super::super) left: u32,
}

impl<const N: usize> Votes<N> {
    pub(in super::super) fn new(rules: &Rules<N>, scores: &Scores) -> Self {
        let mut votes = Self { places: Default::default(), count: 0, left: 0 };
        for (rule, position) in rules.each() {
            let score = scores.of(rule);
            votes.left += u32::from(score) + 1;
            let places = &mut votes.places;
            let at = places[..votes.count].iter().position(|place| place.position == position);
            let place = &mut places[at.unwrap_or(votes.count) % RULES];
            if at.is_none() {
                *place = Candidate { position, weight: 0, rule, score };
                votes.count += 1;
            }
            place.weight += u32::from(score) + 1;
            if score > place.score {
                (place.rule, place.score) = (rule, score);
            }
        }
        votes
    }

    /// Takes the next candidate, if any position is left.
    pub(in super::super) fn take(&mut self) -> Option<Candidate> {
        let mut best = 0;
        for (at, place) in self.places.iter().enumerate() {
            if place.weight > self.places[best].weight {
                best = at;
            }
        }
        let candidate = self.places[best];
        self.places[best].weight = 0;
        (candidate.weight > 0).then_some(candidate)
    }
}
