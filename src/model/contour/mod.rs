//! The outline of a field, traced to polygons. It does not depend on the size; hinting moves its vertices later.

use alloc::vec::Vec;

mod lattice;
mod simplify;

pub use lattice::LATTICE;

use super::grid::{DEFORM_NODES, GridAxis};
use lattice::Lattice;
use simplify::Simplifier;

/// Levels of detail: for sizes below so many pixels per em, the largest distance (em) of polygons from the traced points.
pub const LEVELS_OF_DETAIL: [(f32, f32); 3] = [(25.0, 0.0012), (50.0, 0.0006), (128.0, 0.0004)];
/// The largest distance for all larger sizes.
pub const FINEST: f32 = 0.00005;
/// Edges are split at knots and at rows of nodes if the product of their width and height is more than their sum times
/// the tolerance times this.
pub const SLANT: f32 = 24.0;
/// Edges are split at columns of nodes if they are wider than this (em).
pub const MIN_WIDTH: f32 = 0.12;
/// Edges are not split nearer to their ends than this share of their length.
pub const MIN_SPLIT: f32 = 1.0 / 64.0;
/// Vertices that are moved together, one a lane.
pub const LANES: usize = 8;

/// Closed polygons with the inside on their left. Lists of vertices are padded to a multiple of `LANES`.
#[derive(Debug, Clone, Default)]
pub struct Polygons {
    /// Coordinates along x and y, in em.
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

    /// Releases memory that is not used.
    pub fn shrink(&mut self) {
        self.at.iter_mut().for_each(Vec::shrink_to_fit);
        self.ends.shrink_to_fit();
    }

    fn clear(&mut self) {
        self.at.iter_mut().for_each(Vec::clear);
        self.ends.clear();
    }

    /// Evaluates at the vertices what moves them: their knots and the patterns.
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

/// The parts of a model that an outline is traced from.
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
    splits: Vec<f32>,
}

impl Tracer {
    /// The polygons that are at most each of `tolerances` (em) away from the outline.
    pub fn trace(&mut self, frame: &Frame<'_>, levels: &mut [Polygons], tolerances: &[f32]) {
        levels.iter_mut().for_each(Polygons::clear);
        let Self { lattice, simplifier, points, splits } = self;
        lattice.trace(frame.field, frame.grid.map(|grid| grid.cells));
        let step = frame.grid.map(|grid| 1.0 / (grid.cells_per_em * LATTICE as f32));
        lattice.loops(|chain| {
            points.clear();
            points.extend(chain.iter().map(|p| [0, 1].map(|k| frame.grid[k].origin + p[k] * step[k])));
            for (polygons, tolerance) in levels.iter_mut().zip(tolerances) {
                frame.add(polygons, simplifier.simplify(points, *tolerance), *tolerance, splits);
            }
        });
        levels.iter_mut().for_each(|polygons| polygons.locate(frame));
    }
}

impl Frame<'_> {
    /// Adds a polygon. Its edges are split where hinting can bend them.
    fn add(&self, polygons: &mut Polygons, points: &[[f32; 2]], tolerance: f32, splits: &mut Vec<f32>) {
        let Some(&first) = points.first() else { return };
        for (a, b) in points.iter().zip(points[1..].iter().chain([&first])) {
            self.splits(*a, *b, tolerance, splits);
            for (k, at) in polygons.at.iter_mut().enumerate() {
                at.push(a[k]);
                at.extend(splits.iter().map(|t| a[k] + (b[k] - a[k]) * t));
            }
        }
        polygons.ends.push(polygons.at[0].len() as u32);
    }

    /// The positions where an edge is split, as ascending shares of its length.
    fn splits(&self, a: [f32; 2], b: [f32; 2], tolerance: f32, splits: &mut Vec<f32>) {
        splits.clear();
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let [width, height] = [dx.abs(), dy.abs()];
        let mut split = |t: f32| {
            if t > MIN_SPLIT && t < 1.0 - MIN_SPLIT {
                splits.push(t);
            }
        };
        let slanted = width * height > (width + height) * (tolerance * SLANT);
        let nodes = if self.patterns.is_empty() { 1..1 } else { 1..DEFORM_NODES - 1 };
        if slanted {
            self.knots[0].iter().for_each(|knot| split((knot - a[0]) / dx));
            self.knots[1].iter().for_each(|knot| split((knot - a[1]) / dy));
            nodes.clone().for_each(|node| split((self.grid[1].node(node) - a[1]) / dy));
        }
        if width > MIN_WIDTH {
            nodes.for_each(|node| split((self.grid[0].node(node) - a[0]) / dx));
        }
        splits.sort_unstable_by(f32::total_cmp);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
