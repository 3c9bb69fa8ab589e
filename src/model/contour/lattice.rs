//! The zero level of the field: closed loops of points on a fine lattice (marching squares).

use alloc::vec::Vec;

use crate::model::grid::spline;

/// Lattice steps in a cell of the field, along each axis.
pub const LATTICE: usize = 4;
/// The field is at most this (em) on the border of its grid, so that all loops are closed.
pub(super) const BORDER: f32 = -1.0 / 1024.0;

/// No point.
const NONE: u32 = u32::MAX;

/// Working memory that tracing reuses.
#[derive(Debug, Clone, Default)]
pub(super) struct Lattice {
    /// The field contracted along x: for each row of coefficients, a value for each lattice column.
    contracted: Vec<f32>,
    /// The field on the lattice, bottom row first.
    values: Vec<f32>,
    /// Whether the outline can pass through a cell of the field, bottom row first.
    active: Vec<bool>,
    /// The points on the edges along x, of the lower and the upper row of a band.
    across: [Vec<u32>; 2],
    /// All points, in lattice steps.
    points: Vec<[f32; 2]>,
    /// The point that follows each.
    next: Vec<u32>,
    /// The points of one loop.
    chain: Vec<[f32; 2]>,
}

impl Lattice {
    /// Finds the points where the lattice's edges cross the outline, and links them with the inside on the left. `field`
    /// has two more coefficients than `cells` on each axis.
    pub(super) fn trace(&mut self, field: &[f32], cells: [usize; 2]) {
        self.contract(field, cells);
        self.sample(cells);
        self.find_active(field, cells);
        self.points.clear();
        self.next.clear();
        let columns = cells[0] * LATTICE + 1;
        for across in &mut self.across {
            across.clear();
            across.resize(columns, NONE);
        }
        for j in 0..cells[1] * LATTICE {
            self.band(j, cells[0]);
        }
    }

    fn contract(&mut self, field: &[f32], cells: [usize; 2]) {
        let weights = weights();
        let columns = cells[0] * LATTICE + 1;
        self.contracted.clear();
        self.contracted.resize((cells[1] + 2) * columns, 0.0);
        for (row, out) in field.chunks_exact(cells[0] + 2).zip(self.contracted.chunks_exact_mut(columns)) {
            let (within, last) = out.split_at_mut(columns - 1);
            for (g, out) in row.windows(3).zip(within.chunks_exact_mut(LATTICE)) {
                for (w, out) in weights.iter().zip(out) {
                    *out = w[0] * g[0] + w[1] * g[1] + w[2] * g[2];
                }
            }
            let (w, g) = (weights[LATTICE], &row[cells[0] - 1..]);
            last[0] = w[0] * g[0] + w[1] * g[1] + w[2] * g[2];
        }
    }

    fn sample(&mut self, cells: [usize; 2]) {
        let weights = weights();
        let [columns, rows] = cells.map(|c| c * LATTICE + 1);
        self.values.resize(columns * rows, 0.0);
        for (j, out) in self.values.chunks_exact_mut(columns).enumerate() {
            let cell = (j / LATTICE).min(cells[1] - 1);
            let w = weights[j - cell * LATTICE];
            let [a, b, c] =
                [0, 1, 2].map(|k| &self.contracted[(cell + k) * columns..(cell + k + 1) * columns]);
            for (((out, a), b), c) in out.iter_mut().zip(a).zip(b).zip(c) {
                *out = w[0] * a + w[1] * b + w[2] * c;
            }
            let ends = if j == 0 || j + 1 == rows { 1 } else { columns - 1 };
            out.iter_mut().step_by(ends.max(1)).for_each(|v| *v = v.min(BORDER));
        }
    }

    /// The field lies between the least and the largest of a cell's coefficients.
    fn find_active(&mut self, field: &[f32], cells: [usize; 2]) {
        let stride = cells[0] + 2;
        self.active.clear();
        for (row, column) in (0..cells[1]).flat_map(|row| (0..cells[0]).map(move |column| (row, column))) {
            let border = row == 0 || column == 0 || row + 1 == cells[1] || column + 1 == cells[0];
            let at = |k: usize| &field[(row + k) * stride + column..][..3];
            let inside = [0, 1, 2].map(|k| at(k).iter().filter(|g| **g > 0.0).count()).iter().sum::<usize>();
            self.active.push(inside > 0 && (inside < 9 || border));
        }
    }

    /// Connects the points between lattice row `j` and the next.
    fn band(&mut self, j: usize, cells: usize) {
        let columns = cells * LATTICE + 1;
        let low = &self.values[j * columns..][..columns];
        let high = &self.values[(j + 1) * columns..][..columns];
        let active = &self.active[j / LATTICE * cells..][..cells];
        self.across.swap(0, 1);
        let [below, above] = &mut self.across;
        above.fill(NONE);
        let mut left = NONE;
        for (cell, _) in active.iter().enumerate().filter(|(_, active)| **active) {
            for i in cell * LATTICE..(cell + 1) * LATTICE {
                let corners = [low[i], low[i + 1], high[i + 1], high[i]];
                let inside = corners.map(|value| value > 0.0);
                if inside == [inside[0]; 4] {
                    left = NONE;
                    continue;
                }
                let mut add = |point: [f32; 2]| {
                    self.points.push(point);
                    self.next.push(NONE);
                    (self.points.len() - 1) as u32
                };
                let (x, y) = (i as f32, j as f32);
                let (mut top, mut right) = (NONE, NONE);
                if inside[3] != inside[2] {
                    top = add([x + crossing(high[i], high[i + 1]), y + 1.0]);
                }
                if inside[1] != inside[2] {
                    right = add([x + 1.0, y + crossing(low[i + 1], high[i + 1])]);
                }
                for [from, to] in links(inside, corners, [below[i], right, top, left]) {
                    if let Some(next) = self.next.get_mut(from as usize) {
                        *next = to;
                    }
                }
                above[i] = top;
                left = right;
            }
        }
    }

    /// Visits each loop once, its points in order from the first one found.
    pub(super) fn loops(&mut self, mut visit: impl FnMut(&[[f32; 2]])) {
        for first in 0..self.points.len() {
            self.chain.clear();
            let mut at = first;
            while self.next[at] != NONE {
                self.chain.push(self.points[at]);
                at = core::mem::replace(&mut self.next[at], NONE) as usize;
            }
            if self.chain.len() > 2 {
                visit(&self.chain);
            }
        }
    }
}

/// B-spline weights at each lattice step of a cell, both ends included.
fn weights() -> [[f32; 3]; LATTICE + 1] {
    core::array::from_fn(|k| spline(k as f32 / LATTICE as f32))
}

/// Where the line between two values of different sign crosses zero, 0..1.
fn crossing(a: f32, b: f32) -> f32 {
    a / (a - b)
}

/// The pairs of consecutive points in one lattice cell. Corners are anticlockwise from the lower left, edges likewise from
/// the lower one. If opposite corners are inside, the mean decides whether they are connected.
fn links(inside: [bool; 4], corners: [f32; 4], [bottom, right, top, left]: [u32; 4]) -> [[u32; 2]; 2] {
    let connected = corners[0] + corners[1] + corners[2] + corners[3] > 0.0;
    let one = |from, to| [[from, to], [NONE, NONE]];
    match inside.map(u8::from) {
        [1, 0, 0, 0] => one(bottom, left),
        [0, 1, 0, 0] => one(right, bottom),
        [1, 1, 0, 0] => one(right, left),
        [0, 0, 1, 0] => one(top, right),
        [0, 1, 1, 0] => one(top, bottom),
        [1, 1, 1, 0] => one(top, left),
        [0, 0, 0, 1] => one(left, top),
        [1, 0, 0, 1] => one(bottom, top),
        [1, 1, 0, 1] => one(right, top),
        [0, 0, 1, 1] => one(left, right),
        [1, 0, 1, 1] => one(bottom, right),
        [0, 1, 1, 1] => one(left, bottom),
        [1, 0, 1, 0] if connected => [[bottom, right], [top, left]],
        [1, 0, 1, 0] => [[bottom, left], [top, right]],
        [0, 1, 0, 1] if connected => [[left, bottom], [right, top]],
        [0, 1, 0, 1] => [[right, bottom], [left, top]],
        _ => [[NONE; 2]; 2],
    }
}

#[cfg(test)]
mod tests;
