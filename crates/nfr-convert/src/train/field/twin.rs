//! What training evaluates, once more: in double precision, each sample on its own, with no matrix contracted and
//! nothing kept between samples.

use crate::train::coverage::{MIN_GRADIENT, MIN_SKEW, SLOPE_REACH, samples_per_pixel};
use nfr::Placement;
use nfr::internals::model::gridfit::{
    AxisWarp, DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, MIN_KNOT_GAP, PADDING, PATTERN_STEPS, Scale,
    WARP_STEPS, Weights,
};

/// A model at a size.
pub(super) struct Twin<'a> {
    pub(super) weights: &'a Weights,
    pub(super) scale: Scale,
    pub(super) ppem: f64,
}

impl Twin<'_> {
    fn em(&self, units: i16) -> f64 {
        f64::from(units) / f64::from(self.scale.units_per_em())
    }

    /// The number of the trained size that this one is fitted as: it is less than half a pixel per em off, or half of
    /// one above it.
    fn fitted(&self) -> Option<usize> {
        let off = |size: &usize| self.ppem - self.scale.ppem_of(*size) as f64;
        (0..self.scale.sizes()).find(|size| (-0.5..0.5).contains(&off(size)))
    }

    /// The size that displacements belong to.
    fn grid_size(&self) -> f64 {
        self.fitted().map_or(self.ppem, |size| self.scale.ppem_of(size) as f64)
    }

    /// What a displacement known for each trained size is at this one.
    fn at_size(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.fitted().map_or(0.0, value)
    }

    fn warp(&self, axis: usize) -> &AxisWarp {
        [&self.weights.warp_x, &self.weights.warp_y][axis]
    }

    /// Plain (em) and hinted (pixels) knot positions.
    fn knots(&self, axis: usize) -> Vec<(f64, f64)> {
        let warp = self.warp(axis);
        let mut knots: Vec<(f64, f64)> = Vec::new();
        for (k, &units) in warp.knots.iter().enumerate() {
            let plain = self.em(units);
            let moved = self.at_size(|size| {
                let hinted = f64::from(warp.hinted[size * warp.knots.len() + k]) / f64::from(WARP_STEPS);
                hinted - plain * self.scale.ppem_of(size) as f64
            });
            let hinted = plain * self.grid_size() + moved;
            let least = knots.last().map_or(f64::NEG_INFINITY, |(_, below)| below + f64::from(MIN_KNOT_GAP));
            knots.push((plain, hinted.max(least)));
        }
        knots
    }

    fn unwarp(&self, knots: &[(f64, f64)], at: f64) -> f64 {
        let (Some(first), Some(last)) = (knots.first(), knots.last()) else { return at / self.ppem };
        for pair in knots.windows(2) {
            let ((p, h), (next_p, next_h)) = (pair[0], pair[1]);
            if h <= at && at <= next_h {
                return p + (at - h) / (next_h - h) * (next_p - p);
            }
        }
        let end = if at < first.1 { first } else { last };
        end.0 + (at - end.1) / self.ppem
    }

    /// Where the grid begins and how long it is, in em.
    fn grid(&self, axis: usize) -> [f64; 2] {
        let [low, high] = [axis, axis + 2].map(|k| self.em(self.weights.bounds[k]));
        [low - f64::from(PADDING), high - low + 2.0 * f64::from(PADDING)]
    }

    /// How far the deformation moves a point down, in pixels.
    fn deformation(&self, x: f64, y: f64) -> f64 {
        let rank = usize::from(self.weights.rank);
        let node = |axis: usize, q: f64| {
            let [origin, span] = self.grid(axis);
            ((q - origin) / span * (DEFORM_NODES - 1) as f64).clamp(0.0, (DEFORM_NODES - 1) as f64)
        };
        let (u, v) = (node(0, x), node(1, y));
        let hat = |at: f64, node: usize| (1.0 - (at - node as f64).abs()).max(0.0);
        let mut sum = 0.0;
        for r in 0..rank {
            let strength = self.at_size(|size| {
                f64::from(self.weights.embedding[size * rank + r]) / f64::from(EMBEDDING_STEPS)
            });
            for (row, column) in
                (0..DEFORM_NODES * DEFORM_NODES).map(|k| (k / DEFORM_NODES, k % DEFORM_NODES))
            {
                let pattern =
                    f64::from(self.weights.patterns[(r * DEFORM_NODES + row) * DEFORM_NODES + column])
                        / f64::from(PATTERN_STEPS);
                sum += strength * pattern * hat(u, column) * hat(v, row);
            }
        }
        sum
    }

    /// The field at a point and its gradient: all coefficients, each times its B-spline.
    fn field(&self, x: f64, y: f64) -> [f64; 3] {
        let cells = self.weights.cells.map(usize::from);
        let per_em = [0, 1].map(|axis| cells[axis] as f64 / self.grid(axis)[1]);
        let at =
            |axis: usize, q: f64| ((q - self.grid(axis)[0]) * per_em[axis]).clamp(0.0, cells[axis] as f64);
        let (u, v) = (at(0, x), at(1, y));
        let mut result = [0.0; 3];
        for (k, value) in self.weights.field.iter().enumerate() {
            let (column, row) = (k % (cells[0] + 2), k / (cells[0] + 2));
            let (dx, dy) = (u - (column as f64 - 0.5), v - (row as f64 - 0.5));
            let value = f64::from(*value) / f64::from(FIELD_STEPS);
            result[0] += value * spline(dx) * spline(dy);
            result[1] += value * slope(dx) * per_em[0] * spline(dy);
            result[2] += value * spline(dx) * slope(dy) * per_em[1];
        }
        result
    }

    /// The levels of a bitmap's pixels.
    pub(super) fn draw(&self, place: Placement) -> Vec<f64> {
        let n = samples_per_pixel(self.ppem as f32) as i32;
        let knots = [self.knots(0), self.knots(1)];
        let reach = f64::from(SLOPE_REACH) / f64::from(n);
        let plain = |axis: usize, at: f64| {
            let [low, high] = [at - reach, at + reach].map(|at| self.unwarp(&knots[axis], at));
            ((low + high) / 2.0, (high - low) / (2.0 * reach) * self.ppem)
        };
        let mut pixels = Vec::new();
        for (j, i) in (0..place.height).flat_map(|j| (0..place.width).map(move |i| (j, i))) {
            let mut sum = 0.0;
            for (b, a) in (0..n).flat_map(|b| (0..n).map(move |a| (b, a))) {
                let part = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
                let (x, slope_x) = plain(0, f64::from(place.left) + f64::from(i) + part(a));
                let (y, slope_y) = plain(1, f64::from(place.top) - f64::from(j) - part(b));
                let moved = self.deformation(x, y) / self.ppem * slope_y;
                let [value, gx, gy] = self.field(x, y + moved);
                sum += area(value * self.ppem * f64::from(n), gx * slope_x, gy * slope_y);
            }
            pixels.push(sum / f64::from(n * n) * 255.0);
        }
        pixels
    }
}

/// The centred quadratic B-spline.
fn spline(d: f64) -> f64 {
    match d.abs() {
        d if d <= 0.5 => 0.75 - d * d,
        d if d <= 1.5 => 0.5 * (1.5 - d) * (1.5 - d),
        _ => 0.0,
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
