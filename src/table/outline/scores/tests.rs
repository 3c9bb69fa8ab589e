use proptest::prelude::*;

use super::super::rules::{BEFORE, LOWER, ROOM, SHARED, VALID, lanes};
use super::*;

impl From<[i32; LANES]> for Scores {
    fn from(scores: [i32; LANES]) -> Self {
        Self(scores.map(|score| score as Score))
    }
}

fn check<const N: usize>(positions: [i32; LANES], scores: [i32; LANES], valid: usize, hinted: i32) {
    let room: [i32; ROOM] = core::array::from_fn(|lane| positions.get(lane).copied().unwrap_or(0));
    let rules = Rules::<N> { lanes: lanes(&room), valid };
    let mut known = Scores::from(scores);
    known.update(&rules, hinted);
    let learnt = known.0.map(i32::from);
    for rule in 0..RULES {
        let (score, is_valid) = (scores[rule], VALID[valid][rule] != 0);
        let expected = match positions[rule] == hinted {
            _ if !is_valid => score,
            true => score + ((65535 - score) >> 3),
            false => score - (score >> 3),
        };
        assert_eq!(learnt[rule], expected, "rule {rule}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn scores_are_those_of_a_plain_loop(
        positions in prop::array::uniform12(prop_oneof![-2..3i32, any::<i32>()]),
        scores in prop::array::uniform12(0..=65535i32),
        valid in 0..16usize,
        hinted in -2..3i32,
    ) {
        check::<3>(positions, scores, valid, hinted);
        check::<2>(positions, scores, valid & (LOWER | BEFORE | SHARED), hinted);
        check::<1>(positions, scores, valid & (BEFORE | SHARED), hinted);
    }
}
