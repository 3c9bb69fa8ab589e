//! Changing one number of a model and knowing which pixels it can change, for the converter.

use super::{DEFORM_NODES, EMBEDDING_STEPS, FIELD_STEPS, GridFit, PATTERN_STEPS, WARP_STEPS};

/// Cells beyond a grid that its border's coefficients and nodes reach: everything there counts as on the border.
const BEYOND: f32 = 1e3;

impl GridFit {
    /// Puts a knot elsewhere at one size, in 1/`WARP_STEPS` pixel.
    pub(crate) fn set_hinted(&mut self, axis: usize, size: usize, knot: usize, hinted: i32) {
        let at = size * self.knots[axis].len() + knot;
        let plain = self.knots[axis][knot] * self.scale.ppem_of(size) as f32;
        self.moves[axis][at] = hinted as f32 / WARP_STEPS - plain;
    }

    /// Changes a coefficient of the field, in 1/`FIELD_STEPS` em.
    pub(crate) fn set_field(&mut self, at: usize, value: i8) {
        self.field[at] = f32::from(value) / FIELD_STEPS;
    }

    /// Changes a value of the patterns, in 1/`PATTERN_STEPS`.
    pub(crate) fn set_pattern(&mut self, at: usize, value: i8) {
        self.patterns[at] = f32::from(value) / PATTERN_STEPS;
    }

    /// Gives a pattern another weight at one size, in 1/`EMBEDDING_STEPS` pixel.
    pub(crate) fn set_embedding(&mut self, size: usize, pattern: usize, weight: i8) {
        self.embedding[size * self.rank + pattern] = f32::from(weight) / EMBEDDING_STEPS;
    }

    /// The plain range (em) in which a column or row of coefficients counts.
    pub(crate) fn coefficient_reach(&self, axis: usize, k: usize) -> [f32; 2] {
        let grid = &self.grid[axis];
        let low = if k <= 2 { -BEYOND } else { k as f32 - 2.0 };
        let high = if k + 1 >= grid.cells { BEYOND } else { k as f32 + 1.0 };
        [low, high].map(|cell| grid.origin + cell / grid.cells_per_em)
    }

    /// The plain range (em) in which a column or row of the patterns' nodes counts.
    pub(crate) fn node_reach(&self, axis: usize, k: usize) -> [f32; 2] {
        let grid = &self.grid[axis];
        let low = if k == 0 { -BEYOND } else { k as f32 - 1.0 };
        let high = if k + 1 >= DEFORM_NODES { BEYOND } else { k as f32 + 1.0 };
        let node = grid.cells as f32 / grid.cells_per_em / (DEFORM_NODES - 1) as f32;
        [low, high].map(|at| grid.origin + at * node)
    }

    /// Where hinting puts a plain range (em) at a size, in pixels, however the patterns bend it.
    pub(crate) fn hinted_range(&self, axis: usize, ppem: f32, low: f32, high: f32) -> [f32; 2] {
        let mut bent = 0.0f32;
        if axis == 1 {
            let mut nodes = Vec::new();
            self.mix_patterns(ppem, &mut nodes);
            bent = nodes.iter().fold(0.0, |most, v| most.max(v.abs()));
        }
        let knots = &self.knots[axis];
        let hinted: Vec<f32> = self.hinted_knots(axis, ppem).collect();
        [low - bent, high + bent].map(|at| warp_point(knots, &hinted, ppem, at))
    }
}

/// The piecewise-linear map from `knots` (em) to `hinted` (pixels), with the plain scale beyond the ends.
fn warp_point(knots: &[f32], hinted: &[f32], ppem: f32, at: f32) -> f32 {
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
