//! The outline that a field describes. It is the same at all sizes, so that it is traced once: what hinting does to
//! it at a size is then done to its points.

use alloc::vec::Vec;

mod lattice;
mod simplify;

pub use lattice::LATTICE;

use crate::model::gridfit::{DEFORM_NODES, GridAxis};
use lattice::Lattice;
use simplify::Simplifier;

/// How far (em) the sides of polygons may be from the traced points, for sizes below so many pixels per em.
pub const LEVELS: [(f32, f32); 3] = [(25.0, 0.0012), (50.0, 0.0006), (128.0, 0.0004)];
/// The same for all larger sizes.
pub const FINEST: f32 = 0.00005;
/// Sides are cut at knots and at rows of nodes if the product of their width and height is more than their sum times
/// the tolerance times this.
pub const SLANT: f32 = 24.0;
/// Sides are cut at columns of nodes if they are wider than this (em).
pub const MIN_WIDTH: f32 = 0.12;
/// No side is cut nearer to its ends than this share of it.
pub const MIN_CUT: f32 = 1.0 / 64.0;
/// Vertices are put in place so many at a time.
pub const LANES: usize = 8;

/// Closed polygons with the inside on their left. Lists of vertices are padded to a multiple of `LANES`.
#[derive(Debug, Clone, Default)]
pub struct Polygons {
    /// Places along x and y, in em.
    pub at: [Vec<f32>; 2],
    /// For each axis, how many knots are at or below each vertex.
    pub knots: [Vec<u8>; 2],
    /// For each pattern, its value at each vertex.
    pub patterns: Vec<f32>,
    /// Where each polygon ends.
    pub ends: Vec<u32>,
}

impl Polygons {
    /// The memory that they take, in bytes.
    pub fn memory(&self) -> usize {
        self.at[0].len() * (2 * size_of::<f32>() + 2)
            + self.patterns.len() * size_of::<f32>()
            + self.ends.len() * size_of::<u32>()
    }

    /// Gives back what tracing reserved and did not need.
    pub fn shrink(&mut self) {
        self.at.iter_mut().for_each(Vec::shrink_to_fit);
        self.ends.shrink_to_fit();
    }

    fn clear(&mut self) {
        self.at.iter_mut().for_each(Vec::clear);
        self.ends.clear();
    }

    /// Finds out where the vertices lie in what moves them.
    pub fn locate(&mut self, frame: &Frame<'_>) {
        let padded = self.at[0].len().next_multiple_of(LANES);
        let Self { at, knots, patterns, .. } = self;
        for axis in 0..2 {
            at[axis].resize(padded, 0.0);
            let below = |v: &f32| frame.knots[axis].partition_point(|knot| knot <= v) as u8;
            knots[axis].clear();
            knots[axis].extend(at[axis].iter().map(below));
        }
        patterns.clear();
        patterns.resize(frame.patterns.len() / NODES * padded, 0.0);
        for (k, (x, y)) in at[0].iter().zip(&at[1]).enumerate() {
            let [(column, u), (row, v)] = [frame.grid[0].locate_node(*x), frame.grid[1].locate_node(*y)];
            let patterns = patterns.iter_mut().skip(k).step_by(padded);
            for (out, pattern) in patterns.zip(frame.patterns.chunks_exact(NODES)) {
                let at = |row: usize| {
                    let nodes = &pattern[row * DEFORM_NODES + column..][..2];
                    nodes[0] + (nodes[1] - nodes[0]) * u
                };
                let (low, high) = (at(row), at(row + 1));
                *out = low + (high - low) * v;
            }
        }
    }
}

/// Nodes of a pattern.
const NODES: usize = DEFORM_NODES * DEFORM_NODES;

/// What an outline is traced from.
pub struct Frame<'a> {
    /// Coefficients in em, bottom row first.
    pub field: &'a [f32],
    /// The grid along each axis.
    pub grid: [GridAxis; 2],
    /// Knots of each axis in em, ascending.
    pub knots: [&'a [f32]; 2],
    /// The deformation's patterns, one after the other.
    pub patterns: &'a [f32],
}

/// Traces outlines.
#[derive(Debug, Clone, Default)]
pub struct Tracer {
    lattice: Lattice,
    simplifier: Simplifier,
    points: Vec<[f32; 2]>,
    cuts: Vec<f32>,
}

impl Tracer {
    /// The polygons that are at most each of `tolerances` (em) away from the outline.
    pub fn trace(&mut self, frame: &Frame<'_>, levels: &mut [Polygons], tolerances: &[f32]) {
        levels.iter_mut().for_each(Polygons::clear);
        let Self { lattice, simplifier, points, cuts } = self;
        lattice.trace(frame.field, frame.grid.map(|grid| grid.cells));
        let step = frame.grid.map(|grid| 1.0 / (grid.cells_per_em * LATTICE as f32));
        lattice.loops(|chain| {
            points.clear();
            points.extend(chain.iter().map(|p| [0, 1].map(|k| frame.grid[k].origin + p[k] * step[k])));
            for (polygons, tolerance) in levels.iter_mut().zip(tolerances) {
                frame.add(polygons, simplifier.simplify(points, *tolerance), *tolerance, cuts);
            }
        });
        levels.iter_mut().for_each(|polygons| polygons.locate(frame));
    }
}

impl Frame<'_> {
    /// Adds a polygon, its sides cut where what moves them bends.
    fn add(&self, polygons: &mut Polygons, points: &[[f32; 2]], tolerance: f32, cuts: &mut Vec<f32>) {
        let Some(&first) = points.first() else { return };
        for (a, b) in points.iter().zip(points[1..].iter().chain([&first])) {
            self.cuts(*a, *b, tolerance, cuts);
            for (k, at) in polygons.at.iter_mut().enumerate() {
                at.push(a[k]);
                at.extend(cuts.iter().map(|t| a[k] + (b[k] - a[k]) * t));
            }
        }
        polygons.ends.push(polygons.at[0].len() as u32);
    }

    /// Where a side is cut, as ascending shares of its length.
    fn cuts(&self, a: [f32; 2], b: [f32; 2], tolerance: f32, cuts: &mut Vec<f32>) {
        cuts.clear();
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let [width, height] = [dx.abs(), dy.abs()];
        let mut cut = |t: f32| {
            if t > MIN_CUT && t < 1.0 - MIN_CUT {
                cuts.push(t);
            }
        };
        let slanted = width * height > (width + height) * (tolerance * SLANT);
        let nodes = if self.patterns.is_empty() { 1..1 } else { 1..DEFORM_NODES - 1 };
        if slanted {
            self.knots[0].iter().for_each(|knot| cut((knot - a[0]) / dx));
            self.knots[1].iter().for_each(|knot| cut((knot - a[1]) / dy));
            nodes.clone().for_each(|node| cut((self.grid[1].node(node) - a[1]) / dy));
        }
        if width > MIN_WIDTH {
            nodes.for_each(|node| cut((self.grid[0].node(node) - a[0]) / dx));
        }
        cuts.sort_unstable_by(f32::total_cmp);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
