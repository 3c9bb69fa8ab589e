//! The options of the rate–distortion refinement.

use crate::error::Error;

/// The options of the rate–distortion refinement of the integer weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refinement {
    /// Rounds of coordinate descent over all weights; 0 leaves the weights as they are.
    pub rounds: usize,
    /// The Lagrange multiplier of rate–distortion optimisation: the error, in pixels of full coverage, that may be
    /// added to save one bit.
    pub error_per_bit: f64,
}

impl Default for Refinement {
    fn default() -> Self {
        Self { rounds: 3, error_per_bit: 0.006 }
    }
}

impl Refinement {
    /// Checks the numbers.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        if self.error_per_bit.is_finite() && self.error_per_bit >= 0.0 {
            return Ok(());
        }
        Err(Error::InvalidParameter(format!(
            "a bit is worth {} pixels; use a finite number, 0 or more",
            self.error_per_bit
        )))
    }
}
