//! The options of the training.

use crate::error::Error;

/// The steps and learning rates of the training.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Optimiser steps; each evaluates one eighth of the sizes.
    pub steps: usize,
    /// The share of the steps after which weights are rounded in the loop (quantisation-aware training).
    pub rounded_from: f32,
    /// Initial learning rate of the field, in em. All rates decay along a cosine.
    pub field_rate: f64,
    /// Initial learning rate of the hinted knot positions, in pixels.
    pub warp_rate: f64,
    /// Initial learning rate of the deformation patterns.
    pub pattern_rate: f64,
    /// Initial learning rate of the size embedding, in pixels.
    pub embedding_rate: f64,
    /// Penalty of a spline coefficient's distance from the plane through its neighbours: pixels of error for an em.
    pub smoothness: f64,
}

impl Default for Schedule {
    fn default() -> Self {
        Self {
            steps: 400,
            rounded_from: 0.7,
            field_rate: 1.5e-3,
            warp_rate: 0.008,
            pattern_rate: 0.015,
            embedding_rate: 0.015,
            smoothness: 0.2,
        }
    }
}

/// The table stores the number of steps in 16 bits.
const MAX_STEPS: usize = u16::MAX as usize;

impl Schedule {
    /// Checks that training can follow the schedule.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first number that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        if self.steps > MAX_STEPS {
            return wrong(format!("{} training steps; use 0 to {MAX_STEPS}", self.steps));
        }
        if !(0.0..=1.0).contains(&self.rounded_from) {
            return wrong(format!("rounding from {} of the steps on; use 0 to 1", self.rounded_from));
        }
        for (value, of) in [
            (self.field_rate, "the field's learning rate"),
            (self.warp_rate, "the warp's learning rate"),
            (self.pattern_rate, "the patterns' learning rate"),
            (self.embedding_rate, "the embedding's learning rate"),
            (self.smoothness, "the field's smoothness"),
        ] {
            if !value.is_finite() || value < 0.0 {
                return wrong(format!("{of} is {value}; use a finite number, 0 or more"));
            }
        }
        Ok(())
    }
}

/// burn's backends for the CPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Backend {
    /// burn-flex, which trains these models about five times as fast as burn-ndarray.
    #[default]
    Flex,
    /// burn-ndarray, which burn 0.22 deprecates.
    #[cfg(feature = "ndarray")]
    Ndarray,
}
