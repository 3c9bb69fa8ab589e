//! One number for the balance of error and bytes.

use super::capacity::Capacity;
use super::refinement::Refinement;

/// The balance of error and bytes: 0 for the smallest files, 100 for the least error.
///
/// Any number between is allowed; the presets at 0, 25, 50, 75 and 100 are interpolated. `cargo run --release --example
/// figures -- --quality 0,25,50,75,100` prints bytes and errors of each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality(f32);

/// The options of one quality.
struct Preset {
    cell: f64,
    knots: f64,
    knot_gain: f64,
    rank: f64,
    pattern_gain: f64,
    smoothness: f64,
    error_per_bit: f64,
}

/// Qualities 0, 25, 50, 75 and 100.
#[rustfmt::skip]
const PRESETS: [Preset; 5] = [
    Preset { cell: 0.055, knots: 6.0,  knot_gain: 1e-2, rank: 4.0,  pattern_gain: 0.025,  smoothness: 1.0, error_per_bit: 0.03 },
    Preset { cell: 0.040, knots: 9.0,  knot_gain: 2e-3, rank: 6.0,  pattern_gain: 0.0075, smoothness: 0.4, error_per_bit: 0.012 },
    Preset { cell: 0.031, knots: 12.0, knot_gain: 5e-4, rank: 8.0,  pattern_gain: 0.0025, smoothness: 0.2, error_per_bit: 0.006 },
    Preset { cell: 0.026, knots: 14.0, knot_gain: 1e-4, rank: 10.0, pattern_gain: 0.001,  smoothness: 0.1, error_per_bit: 0.003 },
    Preset { cell: 0.021, knots: 18.0, knot_gain: 2e-5, rank: 12.0, pattern_gain: 0.0005, smoothness: 0.05, error_per_bit: 0.001 },
];

impl Quality {
    /// A quality, if it is within 0 to 100.
    pub fn new(quality: f32) -> Option<Self> {
        (0.0..=100.0).contains(&quality).then_some(Self(quality))
    }

    /// A field of the presets, interpolated between its logarithms.
    fn interpolated(self, of: impl Fn(&Preset) -> f64) -> f64 {
        let at = f64::from(self.0) / 100.0 * (PRESETS.len() - 1) as f64;
        let below = (at as usize).min(PRESETS.len() - 2);
        let (low, high) = (of(&PRESETS[below]), of(&PRESETS[below + 1]));
        low * (high / low).powf(at - below as f64)
    }

    /// From 0 for the smallest files to 1 for the least error.
    pub(super) fn share(self) -> f64 {
        f64::from(self.0) / 100.0
    }

    /// The limits on a model's size.
    pub fn capacity(self) -> Capacity {
        Capacity {
            cell: self.interpolated(|s| s.cell) as f32,
            knots: self.interpolated(|s| s.knots).round() as usize,
            knot_gain: self.interpolated(|s| s.knot_gain),
            rank: self.interpolated(|s| s.rank).round() as usize,
            pattern_gain: self.interpolated(|s| s.pattern_gain),
            ..Capacity::default()
        }
    }

    /// The penalty of a rough field, which takes more bits.
    pub fn smoothness(self) -> f64 {
        self.interpolated(|s| s.smoothness)
    }

    /// The refinement of the trained weights.
    pub fn refinement(self) -> Refinement {
        Refinement { error_per_bit: self.interpolated(|s| s.error_per_bit), ..Refinement::default() }
    }
}

impl Default for Quality {
    /// 50.
    fn default() -> Self {
        Self(50.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_quality_is_more_of_everything() {
        let steps: Vec<Quality> = (0..=20).filter_map(|k| Quality::new(5.0 * k as f32)).collect();
        assert_eq!(steps.len(), 21);
        for pair in steps.windows(2) {
            let [less, more] = [pair[0], pair[1]];
            let (a, b) = (less.capacity(), more.capacity());
            assert!(b.cell < a.cell && b.knots >= a.knots && b.rank >= a.rank);
            assert!(b.knot_gain < a.knot_gain && b.pattern_gain < a.pattern_gain);
            assert!(more.smoothness() < less.smoothness());
            assert!(more.refinement().error_per_bit < less.refinement().error_per_bit);
        }
    }

    #[test]
    fn only_0_to_100_are_qualities() {
        for wrong in [-1.0, 100.5, f32::NAN, f32::INFINITY] {
            assert_eq!(Quality::new(wrong), None);
        }
    }

    #[test]
    fn the_middle_is_the_default_of_each_stage() {
        let middle = Quality::default();
        assert_eq!(middle.capacity(), Capacity::default());
        assert_eq!(middle.smoothness(), crate::options::schedule::Schedule::default().smoothness);
        assert_eq!(middle.refinement(), Refinement::default());
    }
}
