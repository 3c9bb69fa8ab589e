//! A model's weights as floating-point numbers, and their rounding to the integers that the table stores.

use nfr::internals::model::gridfit::{
    AxisWarp, EMBEDDING_STEPS, FIELD_STEPS, PATTERN_STEPS, WARP_STEPS, Weights,
};

/// A model's weights in their natural units, as training changes them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters {
    /// The unhinted outline's box in font units.
    pub bounds: [i16; 4],
    /// Cells of the field along x and y.
    pub cells: [usize; 2],
    /// Spline coefficients in em, bottom row first. Empty for a blank glyph.
    pub field: Vec<f32>,
    /// Knots in font units, for x and y.
    pub knots: [Vec<i16>; 2],
    /// Hinted knot positions in pixels for each axis, by size and knot.
    pub hinted: [Vec<f32>; 2],
    /// The number of deformation patterns.
    pub rank: usize,
    /// Patterns, bottom row first.
    pub patterns: Vec<f32>,
    /// The weight of each pattern in pixels, by size and pattern.
    pub embedding: Vec<f32>,
}

impl Parameters {
    /// Rounds to the integers that the table stores.
    pub fn quantise(&self) -> Weights {
        let bytes = |values: &[f32], steps: f32| {
            let byte = |v: &f32| (v * steps).round_ties_even().clamp(-127.0, 127.0) as i8;
            values.iter().map(byte).collect::<Vec<_>>()
        };
        let warp = |k: usize| AxisWarp {
            knots: self.knots[k].clone(),
            hinted: self.hinted[k].iter().map(|h| (h * WARP_STEPS).round_ties_even() as i32).collect(),
        };
        Weights {
            bounds: self.bounds,
            cells: self.cells.map(|c| c as u8),
            field: bytes(&self.field, FIELD_STEPS),
            warp_x: warp(0),
            warp_y: warp(1),
            rank: self.rank as u8,
            patterns: bytes(&self.patterns, PATTERN_STEPS),
            embedding: bytes(&self.embedding, EMBEDDING_STEPS),
        }
    }
}
