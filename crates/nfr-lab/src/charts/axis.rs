//! A logarithmic axis with round numbers on it.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::Ranged;

/// Smaller values are drawn as zero: half a level of one pixel of a large box has a larger mean squared error.
const SMALLEST: f64 = 1e-9;
/// White space on either side of the values.
const ROOM: f64 = 1.25;
/// Up to so many decades there are numbers at 2 and 5 too.
const DECADES_WITH_STEPS: f64 = 2.5;

/// A range of positive numbers. Values outside are drawn at its ends, zero at the lower one.
#[derive(Debug, Clone, Copy)]
pub(super) struct LogAxis {
    low: f64,
    high: f64,
}

impl LogAxis {
    /// An axis that is a decade long at least and holds all positive values.
    pub(super) fn around(values: impl IntoIterator<Item = f64>) -> Self {
        let positive = values.into_iter().filter(|v| v.is_finite() && *v > 0.0).map(|v| v.max(SMALLEST));
        let (low, high) = positive.fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            return Self { low: 1e-4, high: 1e-1 };
        }
        let (low, high) = (low / ROOM, high * ROOM);
        let missing = (10.0 * low / high).max(1.0).sqrt();
        Self { low: low / missing, high: high * missing }
    }

    /// A value's position on the axis, 0..1.
    fn position(&self, value: f64) -> f64 {
        let span = (self.high / self.low).log10();
        ((value.max(self.low) / self.low).log10() / span).min(1.0)
    }

    /// The number at a position, 0..1.
    pub(super) fn at(&self, position: f64) -> f64 {
        self.low * (self.high / self.low).powf(position)
    }

    /// The lower end.
    pub(super) fn low(&self) -> f64 {
        self.low
    }

    /// Which of `count` equal parts a value lies in.
    pub(super) fn part(&self, value: f64, count: usize) -> usize {
        ((self.position(value) * count as f64) as usize).min(count.saturating_sub(1))
    }
}

impl Ranged for LogAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        from + (f64::from(to - from) * self.position(*value)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let steps: &[f64] =
            if (self.high / self.low).log10() <= DECADES_WITH_STEPS { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let numbers = (first..=last).flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)));
        numbers.filter(|v| (self.low..=self.high).contains(v)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for LogAxis {
    fn format(value: &f64) -> String {
        number(*value)
    }
}

/// A positive number with at most two figures, short: `0.02`, `3.5e-4`.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() || value <= 0.0 {
        return "0".into();
    }
    let scientific = format!("{value:.1e}");
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-3..1e4).contains(&rounded) { format!("{rounded}") } else { scientific.replace(".0e", "e") }
}

#[cfg(test)]
mod tests {
    use plotters::coord::ranged1d::BoldPoints;

    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 1e-4, 0.00035, 0.001, 0.0234, 2.0, 12345.0].map(number);
        assert_eq!(texts, ["0", "1e-4", "3.5e-4", "0.001", "0.023", "2", "1.2e4"]);
    }

    #[test]
    fn the_axis_has_room_and_round_numbers() {
        let axis = LogAxis::around([0.0, 0.001, 0.01, f64::NAN]);
        assert!((axis.low - 0.0008).abs() < 1e-12 && (axis.high - 0.0125).abs() < 1e-12);
        let points: Vec<String> = axis.key_points(BoldPoints(9)).into_iter().map(number).collect();
        assert_eq!(points, ["0.001", "0.002", "0.005", "0.01"]);
    }

    #[test]
    fn zero_is_at_the_lower_end_and_the_axis_is_never_empty() {
        let axis = LogAxis::around([0.003]);
        assert_eq!((axis.map(&0.0, (100, 0)), axis.map(&1e9, (100, 0))), (100, 0));
        assert_eq!(axis.map(&0.003, (100, 0)), 50);
        assert!((axis.high / axis.low - 10.0).abs() < 1e-9);
        assert_eq!(LogAxis::around([]).low, 1e-4);
    }
}
