use proptest::collection::vec;
use proptest::prelude::*;

use super::*;

/// One vertex, moved as `Warp::apply` moves it.
fn moved(warp: &Warp, offset: i32, at: f32, knots: u8, values: &[(f32, f32)]) -> i32 {
    let piece = if warp.is_linear { 0 } else { usize::from(knots).min(MAX_KNOTS) };
    let [scale, shift] = warp.pieces[piece];
    let mut sum = at * scale + shift;
    for (value, weight) in values {
        sum += value * weight;
    }
    sum.max(0.0).min(warp.length).round_ties_even() as i32 + offset
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn eight_vertices_at_once_are_eight_vertices(
        blocks in 0usize..5,
        at in vec(-1.0f32..2.0, 40),
        knots in vec(any::<u8>(), 40),
        patterns in vec(-8.0f32..8.0, 3 * 40),
        weights in vec((0usize..3, -2000.0f32..2000.0), 0..4),
        pieces in prop::array::uniform(prop::array::uniform2(-1e6f32..1e6)),
        is_linear in any::<bool>(),
        length in 0.0f32..4_194_304.0,
        offset in -4_194_304i32..4_194_304,
    ) {
        let warp = Warp { pieces, is_linear, length, ..Warp::default() };
        let count = blocks * LANES;
        let mut points = vec![5; 3];
        warp.apply(offset, &at[..count], &knots[..count], &patterns, &weights, &mut points);
        let expected: Vec<i32> = (0..count)
            .map(|k| {
                let value = |&(pattern, weight): &(usize, f32)| (patterns[pattern * count + k], weight);
                let values: Vec<(f32, f32)> = weights.iter().map(value).collect();
                moved(&warp, offset, at[k], knots[k], &values)
            })
            .collect();
        prop_assert_eq!(points, expected);
    }
}
