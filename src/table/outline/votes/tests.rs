use proptest::prelude::*;

use super::super::rules::{BEFORE, LANES, LOWER, ROOM, RULES, Rules, SHARED, VALID, lanes};
use super::super::scores::Scores;
use super::*;

/// What `Votes` finds, from the words of the specification: position, weight, rule and score.
fn naive(positions: [i32; LANES], scores: [i32; LANES], valid: usize) -> (Vec<(i32, u32, usize, u16)>, u32) {
    let mut found: Vec<(i32, u32, usize, u16)> = Vec::new();
    for rule in (0..RULES).filter(|rule| VALID[valid][*rule] != 0) {
        let (weight, score) = (scores[rule] as u32 + 1, scores[rule] as u16);
        match found.iter_mut().find(|candidate| candidate.0 == positions[rule]) {
            Some(candidate) => {
                candidate.1 += weight;
                if score > candidate.3 {
                    (candidate.2, candidate.3) = (rule, score);
                }
            }
            None => found.push((positions[rule], weight, rule, score)),
        }
    }
    let total = found.iter().map(|candidate| candidate.1).sum();
    found.sort_by_key(|candidate| std::cmp::Reverse(candidate.1));
    found.truncate(CANDIDATES);
    (found, total)
}

fn check<const N: usize>(positions: [i32; LANES], scores: [i32; LANES], valid: usize) {
    let room: [i32; ROOM] = core::array::from_fn(|lane| positions.get(lane).copied().unwrap_or(0));
    let rules = Rules::<N> { lanes: lanes(&room), valid };
    let mut votes = Votes::new(&rules, &Scores::from(scores));
    let (expected, total) = naive(positions, scores, valid);
    assert_eq!(votes.left, total);
    for (rank, expected) in expected.iter().enumerate() {
        let Candidate { position, weight, rule, score } = votes.take().expect("a candidate");
        assert_eq!((position, weight, rule, score), *expected, "number {rank}");
    }
    if expected.len() < CANDIDATES {
        assert!(votes.take().is_none());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn candidates_are_those_of_a_plain_loop(
        positions in prop::array::uniform12(prop_oneof![-2..3i32, any::<i32>()]),
        scores in prop::array::uniform12(0..=65535i32),
        valid in 0..16usize,
    ) {
        check::<3>(positions, scores, valid);
        check::<2>(positions, scores, valid & (LOWER | BEFORE | SHARED));
        check::<1>(positions, scores, valid & (BEFORE | SHARED));
    }
}
