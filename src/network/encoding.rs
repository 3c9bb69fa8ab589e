//! The positional encoding of coordinates, and the hyperbolic tangent.
//!
//! The standard library leaves the last digits of sines and exponentials to the platform. These come from additions,
//! multiplications and divisions in a fixed order, so that they are the same on every machine.

use core::f64::consts::PI;

/// The frequencies of an encoding.
pub const FREQUENCY_COUNT: usize = 32;
/// The numbers of an encoding: a sine and a cosine for each frequency.
pub const ENCODED: usize = 2 * FREQUENCY_COUNT;

/// The frequencies in half turns, 2^(12·i/31), each to the nearest f64.
pub(super) const FREQUENCIES: [f64; FREQUENCY_COUNT] = [
    1.0,
    1.307759068450572,
    1.7102337811147081,
    2.2365737364232703,
    2.9248995860659113,
    3.82506395798502,
    5.002262078458347,
    6.541753595870311,
    8.555037588568538,
    11.18792798738602,
    14.631114282676025,
    19.133972384706258,
    25.022625901582426,
    32.723565939240586,
    42.79454010908214,
    55.964947907823905,
    73.18866814182059,
    95.71314447028534,
    125.16973265093539,
    163.6918529697944,
    214.06950515272635,
    279.95133664220435,
    366.10889921870165,
    478.78223299371365,
    626.1318070105438,
    818.8295486633821,
    1070.8317677798268,
    1400.3899550990257,
    1831.3726631478403,
    2394.994207944063,
    3132.0753943254435,
    4096.0,
];

/// Taylor's coefficients of sin(z)/z and cos(z) in z², the highest power first: 1/n! with alternating signs. Up to π/4
/// they are exact to 1e-16.
const SINE: [f64; 9] = [
    1.0 / 355_687_428_096_000.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 39_916_800.0,
    1.0 / 362_880.0,
    -1.0 / 5_040.0,
    1.0 / 120.0,
    -1.0 / 6.0,
    1.0,
];
const COSINE: [f64; 9] = [
    1.0 / 20_922_789_888_000.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 479_001_600.0,
    -1.0 / 3_628_800.0,
    1.0 / 40_320.0,
    -1.0 / 720.0,
    1.0 / 24.0,
    -1.0 / 2.0,
    1.0,
];

/// The encoding of a number: `[sin(f₀πv), cos(f₀πv), sin(f₁πv), …]` with frequencies fᵢ = 2^(12·i/31), i = 0…31. `value`
/// is at most 1 either way; beyond 2⁴⁰ the result is defined but meaningless.
pub fn encode(value: f64) -> [f64; ENCODED] {
    let mut encoded = [0.0; ENCODED];
    for (pair, frequency) in encoded.as_chunks_mut::<2>().0.iter_mut().zip(FREQUENCIES) {
        *pair = sin_cos(frequency * value);
    }
    encoded
}

/// The sine and cosine of so many half turns.
pub(super) fn sin_cos(half_turns: f64) -> [f64; 2] {
    // All of this is exact: whole turns are taken off, then whole quarters.
    let turned = half_turns - 2.0 * nearest(half_turns * 0.5);
    let quarters = nearest(turned * 2.0);
    let z = (turned - quarters * 0.5) * PI;
    let square = z * z;
    let (sine, cosine) = (polynomial(&SINE, square) * z, polynomial(&COSINE, square));
    match quarters as i32 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        -1 => [-cosine, sine],
        _ => [-sine, -cosine],
    }
}

/// The hyperbolic tangent, to 1e-13 and better, as (e − 1)/(e + 1) with e = exp(2|v|).
pub(super) fn tanh(value: f64) -> f64 {
    // From 20 on it is 1 to all digits. NaN is treated as out of range.
    let size = if value.abs() < 20.0 { value.abs() } else { 20.0 };
    let exponential = exp(2.0 * size);
    let tanh = (exponential - 1.0) / (exponential + 1.0);
    if value < 0.0 { -tanh } else { tanh }
}

/// The exponential of a number from 0 to 40: that of its 256th part by its series, squared eight times.
fn exp(value: f64) -> f64 {
    const TERMS: [f64; 13] = [
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        1.0 / 2.0,
        1.0,
        1.0,
    ];
    let mut power = polynomial(&TERMS, value / 256.0);
    for _ in 0..8 {
        power *= power;
    }
    power
}

/// A polynomial by Horner's rule, the highest coefficient first.
fn polynomial(coefficients: &[f64], at: f64) -> f64 {
    coefficients.iter().fold(0.0, |sum, coefficient| sum * at + coefficient)
}

/// The nearest whole number, halves away from 0.
fn nearest(value: f64) -> f64 {
    let half = if value < 0.0 { -0.5 } else { 0.5 };
    (value + half) as i64 as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From −1 to 1, the ends of both and what lies between, some of it on whole quarters.
    fn values() -> impl Iterator<Item = f64> {
        (-4000..=4000).map(|k| f64::from(k) / 4000.0)
    }

    #[test]
    fn the_frequencies_are_powers_of_two() {
        for (i, frequency) in FREQUENCIES.into_iter().enumerate() {
            let power = 2f64.powf(12.0 * i as f64 / 31.0);
            assert!((frequency - power).abs() <= 1e-15 * power, "{i}");
        }
        assert_eq!((FREQUENCIES[0], FREQUENCIES[31]), (1.0, 4096.0));
    }

    #[test]
    fn an_encoding_is_sines_and_cosines() {
        for value in values() {
            for (pair, frequency) in encode(value).as_chunks::<2>().0.iter().zip(FREQUENCIES) {
                let (sine, cosine) = ((frequency * value) % 2.0 * PI).sin_cos();
                assert!((pair[0] - sine).abs() < 2e-15 && (pair[1] - cosine).abs() < 2e-15, "{value}");
                let (sine, cosine) = (frequency * value * PI).sin_cos();
                assert!((pair[0] - sine).abs() < 5e-12 && (pair[1] - cosine).abs() < 5e-12, "{value}");
            }
        }
    }

    #[test]
    fn whole_quarters_of_a_turn_are_exact() {
        let quarters = [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0]];
        for k in -9i32..=9 {
            assert_eq!(sin_cos(f64::from(k) / 2.0), quarters[k.rem_euclid(4) as usize], "{k}");
        }
    }

    #[test]
    fn the_tangent_is_that_of_the_standard_library() {
        for value in values().map(|v| v * 25.0).chain([1e-9, -1e-300, 0.0, 1e300, f64::NEG_INFINITY]) {
            assert!((tanh(value) - value.tanh()).abs() < 1e-13, "{value}");
        }
    }

    #[test]
    fn any_number_has_an_encoding() {
        for value in [f64::MAX, f64::INFINITY, f64::NAN, 1e30] {
            assert_eq!(encode(value).len(), ENCODED);
        }
    }
}
