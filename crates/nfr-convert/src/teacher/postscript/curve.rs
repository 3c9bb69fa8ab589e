//! Cubic curves as splines of quadratic ones.
//!
//! The control points of the spline are those of fontTools' cu2qu (`cubic_approx_spline`): the cubic is cut into equal parts of
//! its parameter, and the points on the curve between them are half-way between two control points, as `glyf` implies them. Each
//! control point is a linear combination of the cubic's points, so that the same combination of a hinted cubic's points is where
//! hinting moves it.

/// The most quadratics of a cubic.
const MAX_QUADRATICS: usize = 8;
/// Points of a quadratic at which it is compared with the cubic.
pub(super) const SAMPLES: usize = 8;

/// One coordinate of a cubic's points.
pub(super) type Cubic = [f64; 4];

/// The least number of quadratics that stay within `tolerance` of a cubic of these coordinates along x and y, or the most.
pub(super) fn quadratics(cubic: [Cubic; 2], tolerance: f64) -> usize {
    let is_near = |count: &usize| {
        let apart = cubic.map(|axis| differences(&axis, &controls(&axis, *count)));
        apart[0].iter().zip(&apart[1]).all(|(x, y)| x.hypot(*y) <= tolerance)
    };
    (1..MAX_QUADRATICS).find(is_near).unwrap_or(MAX_QUADRATICS)
}

/// One coordinate of the control points of so many quadratics.
pub(super) fn controls(cubic: &Cubic, count: usize) -> Vec<f64> {
    let count_f = count as f64;
    let part = |k: usize| {
        let [a, b] = [k, k + 1].map(|k| k as f64 / count_f);
        let share = if count > 1 { k as f64 / (count_f - 1.0) } else { 0.5 };
        let [from, to] = [a, b].map(|t| at(cubic, t));
        let [after, before] = [a, b].map(|t| derivative(cubic, t) / (2.0 * count_f));
        (from + after) * (1.0 - share) + (to - before) * share
    };
    (0..count).map(part).collect()
}

/// How far a spline is from its cubic, at equal steps of the parameter.
pub(super) fn differences(cubic: &Cubic, controls: &[f64]) -> Vec<f64> {
    let count = controls.len();
    let joint = |k: usize| match k {
        0 => cubic[0],
        k if k == count => cubic[3],
        k => (controls[k - 1] + controls[k]) / 2.0,
    };
    let mut differences = Vec::with_capacity(count * SAMPLES);
    for (k, control) in controls.iter().enumerate() {
        let (from, to) = (joint(k), joint(k + 1));
        for sample in 1..=SAMPLES {
            let u = sample as f64 / SAMPLES as f64;
            let v = 1.0 - u;
            let spline = v * v * from + 2.0 * u * v * control + u * u * to;
            differences.push(spline - at(cubic, (k as f64 + u) / count as f64));
        }
    }
    differences
}

fn at([a, b, c, d]: &Cubic, t: f64) -> f64 {
    let s = 1.0 - t;
    s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d
}

pub(super) fn derivative([a, b, c, d]: &Cubic, t: f64) -> f64 {
    let s = 1.0 - t;
    3.0 * (s * s * (b - a) + 2.0 * s * t * (c - b) + t * t * (d - c))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a circle of radius 500.
    const QUARTER: [Cubic; 2] = [[0.0, 276.0, 500.0, 500.0], [500.0, 500.0, 276.0, 0.0]];

    #[test]
    fn a_finer_tolerance_takes_more_quadratics() {
        let counts = [10.0, 1.0, 0.1, 0.01].map(|tolerance| quadratics(QUARTER, tolerance));
        assert!(counts.is_sorted() && counts[0] < counts[3], "{counts:?}");
        for (tolerance, count) in [10.0, 1.0, 0.1].into_iter().zip(counts) {
            let far = QUARTER.map(|axis| differences(&axis, &controls(&axis, count)));
            assert!(far.iter().flatten().all(|d| d.abs() <= tolerance), "{tolerance}");
        }
    }

    #[test]
    fn a_quadratic_written_as_a_cubic_is_found_again() {
        let [a, control, b] = [10.0, 70.0, 30.0];
        let cubic = [a, a + (control - a) * 2.0 / 3.0, b + (control - b) * 2.0 / 3.0, b];
        assert_eq!(quadratics([cubic, [0.0; 4]], 1e-9), 1);
        assert!((controls(&cubic, 1)[0] - control).abs() < 1e-9);
    }

    #[test]
    fn moving_a_cubic_moves_its_control_points_alike() {
        let moved = QUARTER[0].map(|v| 2.0 * v + 7.0);
        for (a, b) in controls(&QUARTER[0], 4).iter().zip(controls(&moved, 4)) {
            assert!((2.0 * a + 7.0 - b).abs() < 1e-9);
        }
    }
}
