use proptest::prelude::*;

use super::*;

/// The quotient of two integers, rounded to the nearest integer, halves away from 0.
fn nearest(value: i128, by: i128) -> i128 {
    let size = (2 * value.abs() + by.abs()) / (2 * by.abs());
    if (value < 0) == (by < 0) { size } else { -size }
}

/// Numbers of all lengths, and such of which products and quotients lie between two integers.
fn number() -> impl Strategy<Value = i32> {
    let any_length = (any::<i32>(), 0u32..31).prop_map(|(v, shift)| v >> shift);
    let half = (-0x8000i32..0x8000).prop_map(|v| v << 15);
    let extreme = prop::sample::select(vec![i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX - 1, i32::MAX]);
    prop_oneof![4 => any_length, 2 => half, 1 => extreme]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(5000) })]

    #[test]
    fn numbers_are_rounded_to_the_nearest_whole_one(v in -4_194_304.0f32..4_194_304.0) {
        prop_assert_eq!(round(v), v.round_ties_even() as i32);
    }

    #[test]
    fn products_are_the_nearest_integers(value in number(), by in number()) {
        let exact = nearest(i128::from(value) * i128::from(by), 0x10000);
        if let Ok(exact) = i32::try_from(exact) {
            prop_assert_eq!(mul_fixed(value, by), exact);
        }
    }

    #[test]
    fn quotients_are_the_nearest_numbers_or_the_largest_of_their_sign(value in number(), by in number()) {
        let most = i128::from(i32::MAX);
        let exact = match by {
            0 if value < 0 => -most,
            0 => most,
            _ => nearest(i128::from(value) << 16, by.into()).clamp(-most, most),
        };
        prop_assert_eq!(i128::from(div_fixed(value, by)), exact);
    }
}

#[test]
fn halves_are_rounded_away_from_0() {
    assert_eq!([1, 3, -1, -3].map(|v| mul_fixed(v, 0x8000)), [1, 2, -1, -2]);
    assert_eq!([1, 3, -1, -3].map(|v| mul_fixed(v, -0x8000)), [-1, -2, 1, 2]);
    assert_eq!([1, 3, -1, -3].map(|v| div_fixed(v, 0x20000)), [1, 2, -1, -2]);
    assert_eq!([1, 3, -1, -3].map(|v| div_fixed(v, -0x20000)), [-1, -2, 1, 2]);
}
