//! One number for how much error is worth how many bytes.

use super::polish::Polish;
use super::start::Capacity;

/// How much a model may cost: 0 for the smallest files, 100 for the least error.
///
/// Anything between is allowed; the settings at 0, 25, 50, 75 and 100 are interpolated. `cargo run --release --example
/// figures -- --quality 0,25,50,75,100` prints what they come to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality(f32);

/// What is set at each of the five qualities that are written down.
struct Setting {
    /// Edge of a field's cell in em.
    cell: f64,
    knots: f64,
    knot_gain: f64,
    rank: f64,
    pattern_gain: f64,
    smoothness: f64,
    bit_worth: f64,
}

/// From the smallest files to the least error.
#[rustfmt::skip]
const SETTINGS: [Setting; 5] = [
    Setting { cell: 0.055, knots: 6.0,  knot_gain: 1e-2, rank: 4.0,  pattern_gain: 0.025,  smoothness: 1.0, bit_worth: 0.03 },
    Setting { cell: 0.040, knots: 9.0,  knot_gain: 2e-3, rank: 6.0,  pattern_gain: 0.0075, smoothness: 0.4, bit_worth: 0.012 },
    Setting { cell: 0.031, knots: 12.0, knot_gain: 5e-4, rank: 8.0,  pattern_gain: 0.0025, smoothness: 0.2, bit_worth: 0.006 },
    Setting { cell: 0.026, knots: 14.0, knot_gain: 1e-4, rank: 10.0, pattern_gain: 0.001,  smoothness: 0.1, bit_worth: 0.003 },
    Setting { cell: 0.021, knots: 18.0, knot_gain: 2e-5, rank: 12.0, pattern_gain: 0.0005, smoothness: 0.05, bit_worth: 0.001 },
];

impl Quality {
    /// A quality, if it is within 0 to 100.
    pub fn new(quality: f32) -> Option<Self> {
        (0.0..=100.0).contains(&quality).then_some(Self(quality))
    }

    /// A setting, interpolated between its logarithms.
    fn between(self, of: impl Fn(&Setting) -> f64) -> f64 {
        let at = f64::from(self.0) / 100.0 * (SETTINGS.len() - 1) as f64;
        let below = (at as usize).min(SETTINGS.len() - 2);
        let (low, high) = (of(&SETTINGS[below]), of(&SETTINGS[below + 1]));
        low * (high / low).powf(at - below as f64)
    }

    /// How large a model may become.
    pub fn capacity(self) -> Capacity {
        Capacity {
            cell: self.between(|s| s.cell) as f32,
            knots: self.between(|s| s.knots).round() as usize,
            knot_gain: self.between(|s| s.knot_gain),
            rank: self.between(|s| s.rank).round() as usize,
            pattern_gain: self.between(|s| s.pattern_gain),
            ..Capacity::default()
        }
    }

    /// How strongly the training pulls the field towards what is cheap to store.
    pub fn smoothness(self) -> f64 {
        self.between(|s| s.smoothness)
    }

    /// How the finished weights are polished.
    pub fn polish(self) -> Polish {
        Polish { bit_worth: self.between(|s| s.bit_worth), ..Polish::default() }
    }
}

impl Default for Quality {
    /// The middle.
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
            assert!(more.polish().bit_worth < less.polish().bit_worth);
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
        assert_eq!(middle.smoothness(), crate::train::Schedule::default().smoothness);
        assert_eq!(middle.polish(), Polish::default());
    }
}
