//! Changing single numbers of a model, for the converter's refinement.

use super::{EMBEDDING_STEPS, FIELD_STEPS, GridFit, PATTERN_STEPS, WARP_STEPS};

impl GridFit {
    /// Sets a knot's hinted position at one size, in 1/`WARP_STEPS` pixel.
    pub fn set_hinted(&mut self, axis: usize, size: usize, knot: usize, hinted: i32) {
        let at = size * self.knots[axis].len() + knot;
        let plain = self.knots[axis][knot] * self.scale.ppem_of(size) as f32;
        self.moves[axis][at] = hinted as f32 / WARP_STEPS - plain;
    }

    /// Sets a coefficient of the field, in 1/`FIELD_STEPS` em.
    pub fn set_field(&mut self, at: usize, value: i8) {
        self.field[at] = f32::from(value) / FIELD_STEPS;
        self.trace();
    }

    /// Sets a value of the patterns, in 1/`PATTERN_STEPS`.
    pub fn set_pattern(&mut self, at: usize, value: i8) {
        self.patterns[at] = f32::from(value) / PATTERN_STEPS;
        self.evaluate_patterns();
    }

    /// Sets the weight of a pattern at one size, in 1/`EMBEDDING_STEPS` pixel.
    pub fn set_embedding(&mut self, size: usize, pattern: usize, weight: i8) {
        self.embedding[size * self.rank + pattern] = f32::from(weight) / EMBEDDING_STEPS;
    }
}
