//! Means, deviations and quantiles.

/// Mean, standard deviation and quartiles of some numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// How many there are.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, of these very numbers (divided by their count).
    pub deviation: f64,
    /// The smallest, the quartiles and the largest; the middle one is the median.
    pub quartiles: [f64; 5],
}

impl Summary {
    /// Summarises numbers; `None` without any.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count as f64;
        let at = |part| quantile(&values, part);
        let quartiles = [at(0.0)?, at(0.25)?, at(0.5)?, at(0.75)?, at(1.0)?];
        Some(Self { count, mean, deviation: variance.sqrt(), quartiles })
    }

    /// The middle of the numbers.
    pub fn median(&self) -> f64 {
        self.quartiles[2]
    }
}

/// The value below which a part (0..1) of ascending numbers lies, straight between the two nearest. `None` without
/// any numbers.
fn quantile(ascending: &[f64], part: f64) -> Option<f64> {
    let place = part.clamp(0.0, 1.0) * ascending.len().checked_sub(1)? as f64;
    let (low, high) = (ascending[place.floor() as usize], ascending[place.ceil() as usize]);
    Some(low + (high - low) * place.fract())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_summary_is_that_of_the_textbook() {
        // Mean 5, squared deviations 9+1+1+1+0+0+4+16 = 32 over 8 values.
        let summary = Summary::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert_eq!((summary.count, summary.mean, summary.deviation, summary.median()), (8, 5.0, 2.0, 4.5));
        // Places 0, 1.75, 3.5, 5.25 and 7 of the list.
        assert_eq!(summary.quartiles, [2.0, 4.0, 4.5, 5.5, 9.0]);
        assert_eq!(Summary::of([]), None);
        assert_eq!(Summary::of([3.0]).unwrap().quartiles, [3.0; 5]);
    }
}
