//! A naive twin of the differentiable renderer: in double precision, each sample on its own, from all coefficients.

#[path = "../../../tests/samples/model_twin.rs"]
mod model_twin;

use crate::train::coverage::{MIN_GRADIENT, MIN_SKEW, SLOPE_REACH, samples_per_pixel};
use model_twin::{ModelTwin, spline};
use nfr::Placement;
use nfr::internals::model::gridfit::{FIELD_STEPS, Scale, Weights};

/// A model at a size.
pub(super) struct Twin<'a>(ModelTwin<'a>);

impl<'a> Twin<'a> {
    pub(super) fn new(weights: &'a Weights, scale: Scale, ppem: f64) -> Self {
        Self(ModelTwin { weights, scale, ppem })
    }

    fn unwarp(&self, knots: &[(f64, f64)], at: f64) -> f64 {
        let (Some(first), Some(last)) = (knots.first(), knots.last()) else { return at / self.0.ppem };
        for pair in knots.windows(2) {
            let ((p, h), (next_p, next_h)) = (pair[0], pair[1]);
            if h <= at && at <= next_h {
                return p + (at - h) / (next_h - h) * (next_p - p);
            }
        }
        let end = if at < first.1 { first } else { last };
        end.0 + (at - end.1) / self.0.ppem
    }

    /// The field at a point and its gradient: all coefficients, each times its B-spline.
    fn field(&self, x: f64, y: f64) -> [f64; 3] {
        let cells = self.0.weights.cells.map(usize::from);
        let per_em = [0, 1].map(|axis| cells[axis] as f64 / self.0.grid(axis)[1]);
        let at =
            |axis: usize, q: f64| ((q - self.0.grid(axis)[0]) * per_em[axis]).clamp(0.0, cells[axis] as f64);
        let (u, v) = (at(0, x), at(1, y));
        let mut result = [0.0; 3];
        for (k, value) in self.0.weights.field.iter().enumerate() {
            let (column, row) = (k % (cells[0] + 2), k / (cells[0] + 2));
            let (dx, dy) = (u - (column as f64 - 0.5), v - (row as f64 - 0.5));
            let value = f64::from(*value) / f64::from(FIELD_STEPS);
            result[0] += value * spline(dx) * spline(dy);
            result[1] += value * slope(dx) * per_em[0] * spline(dy);
            result[2] += value * spline(dx) * slope(dy) * per_em[1];
        }
        result
    }

    /// The pixels of a bitmap, 0 to 255.
    pub(super) fn draw(&self, place: Placement) -> Vec<f64> {
        let n = samples_per_pixel(self.0.ppem as f32) as i32;
        let knots = [self.0.knots(0), self.0.knots(1)];
        let reach = f64::from(SLOPE_REACH) / f64::from(n);
        let unhinted = |axis: usize, at: f64| {
            let [low, high] = [at - reach, at + reach].map(|at| self.unwarp(&knots[axis], at));
            ((low + high) / 2.0, (high - low) / (2.0 * reach) * self.0.ppem)
        };
        let mut pixels = Vec::new();
        for (j, i) in (0..place.height).flat_map(|j| (0..place.width).map(move |i| (j, i))) {
            let mut sum = 0.0;
            for (b, a) in (0..n).flat_map(|b| (0..n).map(move |a| (b, a))) {
                let part = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
                let (x, slope_x) = unhinted(0, f64::from(place.left) + f64::from(i) + part(a));
                let (y, slope_y) = unhinted(1, f64::from(place.top) - f64::from(j) - part(b));
                let moved = self.0.deformation(x, y) / self.0.ppem * slope_y;
                let [value, gx, gy] = self.field(x, y + moved);
                sum += area(value * self.0.ppem * f64::from(n), gx * slope_x, gy * slope_y);
            }
            pixels.push(sum / f64::from(n * n) * 255.0);
        }
        pixels
    }
}

fn slope(d: f64) -> f64 {
    match d.abs() {
        a if a <= 0.5 => -2.0 * d,
        a if a <= 1.5 => -d.signum() * (1.5 - a),
        _ => 0.0,
    }
}

/// Area of the unit square around the origin where `value + gx·x + gy·y > 0`: the half-plane that begins at each
/// corner, added and taken away in turn.
fn area(value: f64, gx: f64, gy: f64) -> f64 {
    let a = gx.abs().max(gy.abs()).max(f64::from(MIN_GRADIENT));
    let b = gx.abs().min(gy.abs()).max(f64::from(MIN_SKEW) * a);
    let corner = |at: f64| at.max(0.0).powi(2);
    let (sum, difference) = ((a + b) / 2.0, (a - b) / 2.0);
    (corner(value + sum) - corner(value + difference) - corner(value - difference) + corner(value - sum))
        / (2.0 * a * b)
}

#[test]
fn corners_add_up_to_the_share_of_points_on_the_inner_side() {
    const POINTS: i32 = 64;
    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(POINTS) - 0.5;
    for (value, gx, gy) in
        [(0.3, 1.0, 0.4), (-0.2, 0.5, -0.9), (0.0, 1.0, 1.0), (0.6, -1.0, 0.3), (2.0, 1.0, 0.1)]
    {
        let inside = (0..POINTS * POINTS).filter(|k| value + gx * at(k % POINTS) + gy * at(k / POINTS) > 0.0);
        let share = inside.count() as f64 / f64::from(POINTS * POINTS);
        assert!(
            (area(value, gx, gy) - share).abs() < 0.5 / f64::from(POINTS) + 1e-3,
            "{value} {gx} {gy}: {share}"
        );
    }
}
