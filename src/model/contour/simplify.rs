//! Simplification of closed loops (sleeve algorithm of Imai and Iri): no removed point is farther than a tolerance from
//! the new edges, and the area is preserved.

use alloc::vec::Vec;

use crate::number::sqrt_f32;

/// A point moves if the distance of its neighbours is more than this share of the path through it.
pub(super) const MIN_STRAIGHT: f32 = 0.25;

/// Edges that are so many times as high as wide, and no wider than the tolerance, become vertical; likewise horizontal.
pub(super) const STEEP: f32 = 4.0;

/// Working memory that simplifying reuses.
#[derive(Debug, Clone, Default)]
pub(super) struct Simplifier {
    /// Indices of the points that stay.
    kept: Vec<usize>,
    /// For each edge, twice the area that it cuts off on its right.
    areas: Vec<f32>,
    /// The points that stay, moved.
    points: Vec<[f32; 2]>,
}

fn minus(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

fn length(a: [f32; 2]) -> f32 {
    sqrt_f32(a[0] * a[0] + a[1] * a[1])
}

/// The directions that an edge may have: from the first, anticlockwise, to the second.
#[derive(Debug, Clone, Copy)]
struct Wedge([f32; 2], [f32; 2]);

impl Simplifier {
    /// The simplified loop; empty if the loop is thinner than the tolerance.
    pub(super) fn simplify(&mut self, points: &[[f32; 2]], tolerance: f32) -> &[[f32; 2]] {
        self.points.clear();
        self.keep(points, tolerance);
        if self.kept.len() > 2 {
            self.measure(points);
            self.balance(points);
            self.straighten(tolerance);
        }
        &self.points
    }

    /// Chooses the points that stay: each edge is extended as long as some direction passes all of its points within the
    /// tolerance.
    fn keep(&mut self, points: &[[f32; 2]], tolerance: f32) {
        self.kept.clear();
        self.kept.push(0);
        let (mut anchor, mut wedge) = (0, None);
        let mut k = 1;
        while k <= points.len() {
            let to = minus(points[if k == points.len() { 0 } else { k }], points[anchor]);
            if wedge.is_some_and(|Wedge(right, left)| cross(right, to) < 0.0 || cross(to, left) < 0.0) {
                anchor = k - 1;
                self.kept.push(anchor);
                wedge = None;
                continue;
            }
            wedge = narrowed(wedge, to, tolerance);
            k += 1;
        }
    }

    /// Measures the areas that the edges cut off.
    fn measure(&mut self, points: &[[f32; 2]]) {
        self.areas.clear();
        let ends = self.kept[1..].iter().copied().chain([points.len()]);
        for (&from, to) in self.kept.iter().zip(ends) {
            let arm = |k: usize| minus(points[if k == points.len() { 0 } else { k }], points[from]);
            self.areas.push((from + 1..to).map(|k| cross(arm(k), arm(k + 1))).sum());
        }
    }

    /// Moves the points that stay outwards, so that the edges enclose the area of the loop.
    fn balance(&mut self, points: &[[f32; 2]]) {
        let count = self.kept.len();
        for k in 0..count {
            let (before, after) =
                (if k == 0 { count - 1 } else { k - 1 }, if k + 1 == count { 0 } else { k + 1 });
            let [p, q, r] = [before, k, after].map(|k| points[self.kept[k]]);
            let chord = minus(r, p);
            let (sides, straight) = (length(minus(q, p)) + length(minus(r, q)), length(chord));
            let mut by = 0.0;
            // A spike has no outward direction.
            if straight > sides * MIN_STRAIGHT {
                by = (self.areas[before] + self.areas[k]) * 0.5 / sides / straight;
            }
            self.points.push([q[0] + chord[1] * by, q[1] - chord[0] * by]);
        }
    }

    /// Makes nearly vertical edges vertical, and nearly horizontal ones horizontal.
    fn straighten(&mut self, tolerance: f32) {
        let count = self.points.len();
        for k in 0..count {
            let after = if k + 1 == count { 0 } else { k + 1 };
            let [a, b] = [self.points[k], self.points[after]];
            let [width, height] = [(b[0] - a[0]).abs(), (b[1] - a[1]).abs()];
            if width <= tolerance && height > width * STEEP {
                let x = (a[0] + b[0]) * 0.5;
                (self.points[k][0], self.points[after][0]) = (x, x);
            } else if height <= tolerance && width > height * STEEP {
                let y = (a[1] + b[1]) * 0.5;
                (self.points[k][1], self.points[after][1]) = (y, y);
            }
        }
    }
}

/// The directions that also pass a further point within the tolerance. A point nearer than the tolerance allows all.
fn narrowed(wedge: Option<Wedge>, to: [f32; 2], tolerance: f32) -> Option<Wedge> {
    let far = length(to);
    if far <= tolerance {
        return wedge;
    }
    let share = tolerance / far;
    let aside = [-to[1] * share, to[0] * share];
    let (right, left) = (minus(to, aside), [to[0] + aside[0], to[1] + aside[1]]);
    Some(wedge.map_or(Wedge(right, left), |old| {
        Wedge(
            if cross(old.0, right) > 0.0 { right } else { old.0 },
            if cross(left, old.1) > 0.0 { left } else { old.1 },
        )
    }))
}

#[cfg(test)]
mod tests;
