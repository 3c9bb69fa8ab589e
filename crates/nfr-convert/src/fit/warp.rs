//! The initial fit of the warp: knots chosen greedily among the coordinates of the outline's points, and their hinted
//! positions by linear least squares on the moves of the points.

/// Knots of one axis and their hinted positions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Warp {
    /// Ascending positions in em.
    pub(super) knots: Vec<f32>,
    /// For each size, the hinted position of each knot in pixels.
    pub(super) hinted: Vec<Vec<f32>>,
}

/// Coordinates closer than this to a knot (em) cannot be knots: they would make the fit ill-conditioned.
const MIN_SPACING: f32 = 0.006;
/// The weight of the difference of neighbouring knots' moves (ridge regression), for knots that no point determines.
const RIDGE: f64 = 1e-4;

/// When to stop adding knots, and the unit that they are stored in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Font units in an em. Knots are stored in whole font units, and no two are the same.
    pub(super) units: f32,
    /// Knots, at most.
    pub(super) knots: usize,
    /// No more are added once the mean squared residual is below this (pixels²).
    pub(super) max_residual: f64,
}

impl Limits {
    /// Whether two coordinates (em) can both be knots. They need not be whole font units: the implied on-curve points of
    /// TrueType outlines lie between.
    fn apart(self, a: f32, b: f32) -> bool {
        (a - b).abs() > MIN_SPACING && (a * self.units).round() != (b * self.units).round()
    }
}

/// Fits a warp. `unhinted` holds a coordinate of each outline point in em, `hinted` the same coordinate in pixels for
/// each size, `ppem` the sizes.
pub(super) fn fit(unhinted: &[f32], hinted: &[Vec<f32>], ppem: &[u16], limits: Limits) -> Warp {
    let mut coordinates = unhinted.to_vec();
    coordinates.sort_by(f32::total_cmp);
    coordinates.dedup();
    let moves: Vec<Vec<f64>> = hinted
        .iter()
        .zip(ppem)
        .map(|(row, &s)| row.iter().zip(unhinted).map(|(h, p)| f64::from(*h - *p * f32::from(s))).collect())
        .collect();
    let (Some(&low), Some(&high)) = (coordinates.first(), coordinates.last()) else {
        return Warp { knots: Vec::new(), hinted: vec![Vec::new(); ppem.len()] };
    };
    let mut knots = vec![low];
    if limits.apart(high, low) {
        knots.push(high);
    }
    let mut best = solve(&knots, unhinted, &moves);
    while knots.len() < limits.knots && best.1 > limits.max_residual {
        let candidate = coordinates
            .iter()
            .filter(|v| knots.iter().all(|k| limits.apart(*k, **v)))
            .map(|&v| {
                let mut trial = knots.clone();
                trial.push(v);
                trial.sort_by(f32::total_cmp);
                let fit = solve(&trial, unhinted, &moves);
                (trial, fit)
            })
            .min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let Some((trial, fit)) = candidate else { break };
        (knots, best) = (trial, fit);
    }
    let hinted = best
        .0
        .iter()
        .zip(ppem)
        .map(|(row, &s)| row.iter().zip(&knots).map(|(d, k)| *d as f32 + *k * f32::from(s)).collect())
        .collect();
    Warp { knots, hinted }
}

/// The displacements (pixels) of `knots` for each size with the least squared residual of `moves`, and its mean. The
/// basis functions are hats, so that the normal equations are tridiagonal.
fn solve(knots: &[f32], unhinted: &[f32], moves: &[Vec<f64>]) -> (Vec<Vec<f64>>, f64) {
    let n = knots.len();
    let basis: Vec<(usize, f64)> = unhinted.iter().map(|&p| hat(knots, p)).collect();
    let mut normal = vec![0.0; n * n];
    for &(k, t) in &basis {
        normal[k * n + k] += (1.0 - t) * (1.0 - t);
        if k + 1 < n {
            normal[k * n + k + 1] += t * (1.0 - t);
            normal[(k + 1) * n + k] += t * (1.0 - t);
            normal[(k + 1) * n + k + 1] += t * t;
        }
    }
    for k in 1..n {
        for (row, column, sign) in [(k, k, 1.0), (k - 1, k - 1, 1.0), (k, k - 1, -1.0), (k - 1, k, -1.0)] {
            normal[row * n + column] += sign * RIDGE;
        }
    }
    let mut squares = 0.0;
    let solved = moves
        .iter()
        .map(|row| {
            let mut right = vec![0.0; n];
            for (&(k, t), d) in basis.iter().zip(row) {
                right[k] += (1.0 - t) * d;
                if k + 1 < n {
                    right[k + 1] += t * d;
                }
            }
            tridiagonal(&normal, &mut right);
            for (&(k, t), d) in basis.iter().zip(row) {
                let next = if k + 1 < n { right[k + 1] } else { right[k] };
                squares += ((1.0 - t) * right[k] + t * next - d).powi(2);
            }
            right
        })
        .collect();
    (solved, squares / (moves.len() * unhinted.len()).max(1) as f64)
}

/// The knot at or below `p`, and the position of `p` between it and the next one, 0..1.
fn hat(knots: &[f32], p: f32) -> (usize, f64) {
    let last = knots.len() - 1;
    let k = knots.partition_point(|k| *k <= p).saturating_sub(1).min(last.saturating_sub(1));
    if last == 0 {
        return (0, 0.0);
    }
    (k, f64::from(((p - knots[k]) / (knots[k + 1] - knots[k])).clamp(0.0, 1.0)))
}

/// Solves a symmetric positive definite tridiagonal system (dense storage) in place by the Thomas algorithm.
fn tridiagonal(matrix: &[f64], right: &mut [f64]) {
    let n = right.len();
    let mut diagonal: Vec<f64> = (0..n).map(|k| matrix[k * n + k].max(1e-12)).collect();
    for k in 1..n {
        let factor = matrix[k * n + k - 1] / diagonal[k - 1];
        diagonal[k] = (diagonal[k] - factor * matrix[(k - 1) * n + k]).max(1e-12);
        right[k] -= factor * right[k - 1];
    }
    for k in (0..n).rev() {
        let above = if k + 1 < n { matrix[k * n + k + 1] * right[k + 1] } else { 0.0 };
        right[k] = (right[k] - above) / diagonal[k];
    }
}

/// The piecewise-linear map from `knots` (em) to `hinted` (pixels); outside of the outermost knots its slope is `ppem`.
pub(super) fn warp_point(knots: &[f32], hinted: &[f32], ppem: f32, at: f32) -> f32 {
    let (Some(&first), Some(&last)) = (knots.first(), knots.last()) else { return at * ppem };
    if at <= first {
        return hinted[0] + (at - first) * ppem;
    }
    if at >= last {
        return hinted[hinted.len() - 1] + (at - last) * ppem;
    }
    let k = knots.partition_point(|h| *h <= at) - 1;
    hinted[k] + (at - knots[k]) * ((hinted[k + 1] - hinted[k]) / (knots[k + 1] - knots[k]))
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    /// The residual at which the fits stop adding knots (mean square, pixels²).
    const MAX_RESIDUAL: f64 = 2e-5;
    const LIMITS: Limits = Limits { units: 2048.0, knots: 12, max_residual: MAX_RESIDUAL };
    /// The mean squared residual of moves that knots can represent exactly, which `RIDGE` keeps above zero.
    const WITH_RIDGE: f64 = 5.0 * MAX_RESIDUAL;

    fn warped(warp: &Warp, size: usize, unhinted: f32) -> f32 {
        let (k, t) = hat(&warp.knots, unhinted);
        let hinted = &warp.hinted[size];
        let next = hinted[(k + 1).min(hinted.len() - 1)];
        hinted[k] + t as f32 * (next - hinted[k])
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(100) })]

        #[test]
        fn it_reproduces_a_piecewise_linear_move(
            gaps in vec(0.08f32..0.3, 1..5),
            moves in vec(vec(-0.5f32..0.5, 6), 1..4),
            between in vec(0.1f32..0.9, 0..20),
        ) {
            let mut knots = vec![-0.2f32];
            gaps.iter().for_each(|gap| knots.push(knots[knots.len() - 1] + gap));
            // All knots are coordinates of points, and no other point is within `MIN_SPACING` of one.
            let mut unhinted = knots.clone();
            for (k, t) in between.iter().enumerate() {
                let k = k % (knots.len() - 1);
                unhinted.push(knots[k] + t * (knots[k + 1] - knots[k]));
            }
            let ppem: Vec<u16> = (0..moves.len() as u16).map(|k| 10 + 7 * k).collect();
            let hinted: Vec<Vec<f32>> = moves
                .iter()
                .zip(&ppem)
                .map(|(moves, s)| {
                    let moved = |p: f32| {
                        let (k, t) = hat(&knots, p);
                        moves[k] + t as f32 * (moves[(k + 1).min(knots.len() - 1)] - moves[k])
                    };
                    unhinted.iter().map(|p| p * f32::from(*s) + moved(*p)).collect()
                })
                .collect();
            let warp = fit(&unhinted, &hinted, &ppem, LIMITS);
            prop_assert!(warp.knots.is_sorted_by(|a, b| a < b));
            let rows = hinted.iter().enumerate();
            let left = rows.flat_map(|(size, row)| unhinted.iter().zip(row).map(move |(p, h)| (size, p, h)));
            let squares: Vec<f64> =
                left.map(|(size, p, h)| f64::from(warped(&warp, size, *p) - h).powi(2)).collect();
            let mean = squares.iter().sum::<f64>() / squares.len() as f64;
            prop_assert!(mean <= WITH_RIDGE, "{mean}");
        }
    }

    #[test]
    fn points_that_do_not_move_need_two_knots() {
        let unhinted = [0.0, 0.1, 0.3, 0.7];
        let warp = fit(&unhinted, &[unhinted.map(|p| p * 16.0).to_vec()], &[16], LIMITS);
        assert_eq!(warp.knots, [0.0, 0.7]);
        assert!((warp.hinted[0][1] - 0.7 * 16.0).abs() < 1e-4);
    }

    #[test]
    fn it_never_has_more_knots_than_asked_for() {
        let unhinted: Vec<f32> = (0..40).map(|k| k as f32 * 0.02).collect();
        let jagged: Vec<f32> = unhinted.iter().enumerate().map(|(k, p)| p * 16.0 + (k % 2) as f32).collect();
        for most in [2, 5, 12] {
            let limits = Limits { knots: most, ..LIMITS };
            assert_eq!(fit(&unhinted, std::slice::from_ref(&jagged), &[16], limits).knots.len(), most);
        }
    }

    #[test]
    fn no_two_knots_are_the_same_in_font_units() {
        for units in [16.0, 64.0, 100.0, 160.0, 1000.0f32] {
            // Half font units, as between two points of a curve.
            let unhinted: Vec<f32> = (0..60).map(|k| k as f32 * 0.5 / units).collect();
            let jagged: Vec<f32> =
                unhinted.iter().enumerate().map(|(k, p)| p * 16.0 + (k % 3) as f32).collect();
            let limits = Limits { units, knots: 32, ..LIMITS };
            let knots = fit(&unhinted, &[jagged], &[16], limits).knots;
            let stored: Vec<f32> = knots.iter().map(|k| (k * units).round()).collect();
            assert!(stored.is_sorted_by(|a, b| a < b) && stored.len() > 3, "{units}: {stored:?}");
        }
    }

    #[test]
    fn points_with_one_coordinate_need_one_knot() {
        let warp = fit(&[0.25; 3], &[vec![5.0; 3], vec![9.0; 3]], &[16, 32], LIMITS);
        assert_eq!(warp.knots, [0.25]);
        assert!((warp.hinted[0][0] - 5.0).abs() < 1e-4 && (warp.hinted[1][0] - 9.0).abs() < 1e-4);
    }

    #[test]
    fn an_outline_without_points_has_no_knots() {
        let warp = fit(&[], &[Vec::new(), Vec::new()], &[16, 17], LIMITS);
        assert!(warp.knots.is_empty() && warp.hinted == vec![Vec::<f32>::new(); 2]);
    }
}
