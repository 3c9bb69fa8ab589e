//! The limits on a model's size.

use crate::error::Error;
use nfr::internals::model::gridfit::MAX_KNOTS;
use nfr::internals::table::codec::MAX_RANK;

/// The limits on the size of a glyph's model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capacity {
    /// Edge of a field cell in em. Very small and very large glyphs have other cells, so that their number stays
    /// within bounds.
    pub cell: f32,
    /// Knots of each warped axis, at most.
    pub knots: usize,
    /// Knots are added until the mean squared residual of the points' moves is below this (pixels²).
    pub knot_gain: f64,
    /// Deformation patterns, at most.
    pub rank: usize,
    /// Deformation patterns, at least. Training learns those that the points do not need.
    pub least_rank: usize,
    /// Patterns are added until the mean squared residual of the points' moves is below this at every size
    /// (pixels²).
    pub pattern_gain: f64,
}

/// The table stores the edge of a cell in this fraction of an em, in 16 bits.
pub const CELL_UNITS_PER_EM: f32 = 10_000.0;

impl Default for Capacity {
    fn default() -> Self {
        Self { cell: 0.031, knots: 12, knot_gain: 5e-4, rank: 8, least_rank: 2, pattern_gain: 0.0025 }
    }
}

impl Capacity {
    /// Checks that a table can hold such models.
    ///
    /// # Errors
    ///
    /// `InvalidParameter`, naming the first number that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |what: String| Err(Error::InvalidParameter(what));
        let Self { cell, knots, knot_gain, rank, least_rank, pattern_gain } = *self;
        let unit = CELL_UNITS_PER_EM.recip();
        if !(unit..=f32::from(u16::MAX) / CELL_UNITS_PER_EM).contains(&cell) {
            return wrong(format!("cells of {cell} em; use 0.0001 to 6.5535"));
        }
        if !(2..=MAX_KNOTS).contains(&knots) {
            return wrong(format!("{knots} knots; use 2 to {MAX_KNOTS}"));
        }
        if least_rank == 0 || least_rank > rank || rank > MAX_RANK.into() {
            return wrong(format!("{least_rank} to {rank} patterns; use 1 to {MAX_RANK}, the fewer first"));
        }
        for (gain, of) in [(knot_gain, "knots"), (pattern_gain, "patterns")] {
            // Infinity is valid: nothing is ever added.
            if gain.is_nan() || gain < 0.0 {
                return wrong(format!("{of} are to leave less than {gain} of the moves; use 0 or more"));
            }
        }
        Ok(())
    }
}
