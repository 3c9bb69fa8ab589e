//! A model at one size: its outline's vertices, grid-fitted, in fixed-point coordinates.

use alloc::vec::Vec;

use wide::f32x8;

use super::contour::{LANES, Polygons};
use super::gridfit::{GridFit, MAX_KNOTS};
use super::sizes::HintedSize;
use crate::number::{UNIT, round};

/// What moves the vertices of a model at one size. One value is set again and again, so that nothing is allocated.
#[derive(Debug, Clone, Default)]
pub struct Hinting {
    warps: [Warp; 2],
    /// The number and the weight (units) of each pattern whose weight is not 0.
    pattern_weights: Vec<(usize, f32)>,
}

impl Hinting {
    /// Hints a model at a size, its origin at `origin` (pixels). Returns the model's box: along each axis, its first pixel
    /// and the end of its pixels.
    pub fn set(&mut self, model: &GridFit, size: &HintedSize, origin: [f32; 2]) -> [(i32, i32); 2] {
        self.pattern_weights.clear();
        let weights = model.pattern_weights(size).map(|pixels| pixels * UNIT as f32).enumerate();
        self.pattern_weights.extend(weights.filter(|(_, units)| *units != 0.0));
        let [x, y] = &mut self.warps;
        [x.set(model, 0, size, origin[0]), y.set(model, 1, size, origin[1])]
    }

    /// The hinted vertices, in units from what lies `offset` units before the upper left corner of the model's box, y
    /// down. Vertices outside the box are moved to its border.
    pub fn vertices(&self, polygons: &Polygons, offset: [i32; 2], [x, y]: &mut [Vec<i32>; 2]) {
        let Polygons { at, knots, patterns, .. } = polygons;
        self.warps[0].apply(offset[0], &at[0], &knots[0], &[], &[], x);
        self.warps[1].apply(offset[1], &at[1], &knots[1], patterns, &self.pattern_weights, y);
    }
}

/// The warp of one axis at a size, from em to units from the corner of the model's own box.
#[derive(Debug, Clone)]
struct Warp {
    /// Hinted positions of the knots, in pixels.
    hinted: [f32; MAX_KNOTS],
    /// Below the first knot, between knots, and above the last one: units per em, and the position of em 0 in units.
    pieces: [[f32; 2]; MAX_KNOTS + 1],
    /// Whether there is only one piece.
    is_linear: bool,
    /// The length of the box in units.
    length: f32,
}

impl Default for Warp {
    fn default() -> Self {
        Self { hinted: [0.0; MAX_KNOTS], pieces: [[0.0; 2]; MAX_KNOTS + 1], is_linear: true, length: 0.0 }
    }
}

impl Warp {
    /// Sets the warp of a model's axis. Returns the first pixel and the end of the model's box; units are counted from its
    /// left border, or its upper one.
    fn set(&mut self, model: &GridFit, axis: usize, size: &HintedSize, origin: f32) -> (i32, i32) {
        let (knots, ppem) = (model.knots(axis), size.ppem);
        let hinted = &mut self.hinted[..knots.len()];
        hinted.iter_mut().zip(model.hinted_knots(axis, size)).for_each(|(out, hinted)| *out = hinted);
        let ends = [hinted.first(), hinted.get(1..).and_then(<[f32]>::last)].map(Option::<&f32>::copied);
        let (first, end) = model.pixels(axis, ppem, ends, origin);
        let (corner, units) = if axis == 0 { (first, UNIT as f32) } else { (end, -(UNIT as f32)) };
        let shift = origin - corner as f32;
        self.length = end.saturating_sub(first) as f32 * UNIT as f32;
        self.is_linear = knots.is_empty();
        let piece =
            |plain: f32, hinted: f32, scale: f32| [scale * units, (hinted - plain * scale + shift) * units];
        let lowest = knots.first().zip(hinted.first());
        self.pieces[0] = lowest.map_or(piece(0.0, 0.0, ppem), |(plain, hinted)| piece(*plain, *hinted, ppem));
        for k in 0..knots.len() {
            let scale = match knots.get(k + 1) {
                Some(next) => (hinted[k + 1] - hinted[k]) / (next - knots[k]),
                None => ppem,
            };
            self.pieces[k + 1] = piece(knots[k], hinted[k], scale);
        }
        (first, end)
    }

    /// Moves vertices: `at` are their positions in em, `knots` the pieces that they lie in, `patterns` the value of each
    /// pattern at each of them.
    fn apply(
        &self,
        offset: i32,
        at: &[f32],
        knots: &[u8],
        patterns: &[f32],
        pattern_weights: &[(usize, f32)],
        points: &mut Vec<i32>,
    ) {
        let stride = at.len();
        let (low, high) = (f32x8::ZERO, f32x8::splat(self.length));
        let ((at, _), (knots, _)) = (at.as_chunks::<LANES>(), knots.as_chunks::<LANES>());
        points.clear();
        for (block, (at, knots)) in at.iter().zip(knots).enumerate() {
            let mut sum = if self.is_linear {
                f32x8::new(*at) * self.pieces[0][0] + self.pieces[0][1]
            } else {
                let moved = |k: usize| {
                    let [scale, shift] = self.pieces[usize::from(knots[k]).min(MAX_KNOTS)];
                    at[k] * scale + shift
                };
                f32x8::new(core::array::from_fn(moved))
            };
            for &(pattern, weight) in pattern_weights {
                if let Some(values) = patterns[pattern * stride + block * LANES..].first_chunk() {
                    sum += f32x8::new(*values) * weight;
                }
            }
            points.extend(sum.fast_max(low).fast_min(high).to_array().map(|units| round(units) + offset));
        }
    }
}

#[cfg(test)]
mod tests;
