//! Learning rates, epoch by epoch.

/// The first and the last rate of each fifth of the implicit network's training.
const FIFTHS: [(f64, f64); 5] = [(1e-3, 1e-5), (1e-4, 1e-6), (5e-5, 1e-7), (1e-5, 1e-8), (1e-6, 1e-9)];
/// The two rates that the masked network's training alternates between.
const ALTERNATING: [f64; 2] = [5e-4, 1e-5];

/// The implicit network's rates: five times a decay, by the same factor every epoch. The last epoch of a fifth has
/// not quite arrived at its last rate, as in the paper's code.
pub fn implicit_rates(epochs: usize) -> Vec<f64> {
    let fifth = epochs / FIFTHS.len();
    let mut rates = Vec::with_capacity(epochs);
    for (k, (first, last)) in FIFTHS.into_iter().enumerate() {
        // The remainder of the division by five goes to the last.
        let length = if k + 1 == FIFTHS.len() { epochs - rates.len() } else { fifth };
        let factor = last / first;
        rates.extend((0..length).map(|epoch| first * factor.powf(epoch as f64 / length as f64)));
    }
    rates
}

/// The masked network's rates: each holds for `period` epochs.
pub fn masked_rates(epochs: usize, period: usize) -> Vec<f64> {
    (0..epochs).map(|epoch| ALTERNATING[epoch / period.max(1) % ALTERNATING.len()]).collect()
}

/// The epochs, counted from 0, at which the rate is raised again.
pub fn resets(rates: &[f64]) -> Vec<usize> {
    (1..rates.len()).filter(|&epoch| rates[epoch] > rates[epoch - 1]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a / b - 1.0).abs() < 1e-12
    }

    #[test]
    fn five_hundred_epochs_decay_five_times_as_published() {
        let rates = implicit_rates(500);
        assert_eq!((rates.len(), resets(&rates)), (500, vec![100, 200, 300, 400]));
        // A hundredth in 100 epochs is a tenth in 50 and a factor of 10^-0.02 in one.
        assert!(close(rates[0], 1e-3) && close(rates[50], 1e-4) && close(rates[99], 1e-5 * 10f64.powf(0.02)));
        assert!(close(rates[100], 1e-4) && close(rates[150], 1e-5));
        // A five-hundredth, a thousandth and a thousandth in 100 epochs.
        assert!(close(rates[200], 5e-5) && close(rates[250], 5e-5 / 500f64.sqrt()));
        assert!(
            close(rates[300], 1e-5) && close(rates[400], 1e-6) && close(rates[499], 1e-9 * 10f64.powf(0.03))
        );
    }

    #[test]
    fn epochs_that_do_not_divide_by_five_are_the_last_decays() {
        let rates = implicit_rates(27);
        assert_eq!((rates.len(), resets(&rates)), (27, vec![5, 10, 15, 20]));
        assert!(implicit_rates(0).is_empty());
    }

    #[test]
    fn the_masked_networks_rate_changes_every_period() {
        let rates = masked_rates(1600, 50);
        assert_eq!(
            [0, 49, 50, 99, 100, 1599].map(|epoch| rates[epoch]),
            [5e-4, 5e-4, 1e-5, 1e-5, 5e-4, 1e-5]
        );
        assert_eq!(resets(&rates), (1..16).map(|k| 100 * k).collect::<Vec<_>>());
    }
}
