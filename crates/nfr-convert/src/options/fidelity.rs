//! How near outline models are to the hinted outlines.

use super::quality::Quality;

/// The balance of error and bytes of outline models.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fidelity {
    error_per_bit: f64,
}

/// Below this price of a bit, moves that differ at all are different.
const FINE: f64 = 0.01;
/// The error that may be added to save one bit, in pixels of full coverage, at the qualities 0 and 100.
const WORST: f64 = 0.03;
const BEST: f64 = 0.001;

impl Fidelity {
    /// That of quality 100.
    pub(crate) const EXACT: Self = Self { error_per_bit: 0.0 };

    /// That of a quality. 100 is exact.
    pub fn new(quality: Quality) -> Self {
        let share = quality.share();
        if share >= 1.0 {
            return Self::EXACT;
        }
        Self { error_per_bit: WORST * (BEST / WORST).powf(share) }
    }

    /// The same with bits that cost so many times as much.
    pub(crate) fn with_dearer_bits(self, factor: f64) -> Self {
        Self { error_per_bit: self.error_per_bit * factor }
    }

    /// The quality that stands for this, to a tenth.
    pub fn quality(self) -> f64 {
        if self.is_exact() {
            return 100.0;
        }
        // From 0, so that the worst quality is no negative zero.
        0.0 + (1000.0 * (self.error_per_bit / WORST).ln() / (BEST / WORST).ln()).round() / 10.0
    }

    /// Whether every point is where hinting puts it, at every size: of outline models, at the sizes that the teacher draws. Fields,
    /// predicted sizes and glyphs without a model are not exact; [`FontPair::verify`](crate::compare::fonts::FontPair::verify) tells of
    /// them.
    pub fn is_exact(self) -> bool {
        self.error_per_bit == 0.0
    }

    /// The Lagrange multiplier of rate–distortion optimisation: the error, in pixels of full coverage, that may be added to save
    /// one bit.
    pub fn error_per_bit(self) -> f64 {
        self.error_per_bit
    }

    /// Moves that differ by so much, in 1/64 pixel, count as the same while tracks are found.
    pub fn tolerance(self) -> i32 {
        if self.error_per_bit < FINE { 0 } else { 2 }
    }
}

impl Default for Fidelity {
    fn default() -> Self {
        Self::new(Quality::default())
    }
}
