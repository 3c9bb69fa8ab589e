//! The initial state of context models: probabilities and mixer weights trained on fonts, kept in `spec/priors.txt`.

use super::elements::{MIXERS, SLOTS};
use super::logistic::squash;

/// The initial probability of each slot and the weights of each mixer.
#[derive(Debug, Clone)]
pub struct Prior {
    /// The probability of each slot, in 1/65536.
    pub slots: [u16; SLOTS],
    /// The weights of each mixer, in 1/32.
    pub weights: [[u8; 3]; MIXERS],
}

/// The table of the specification: a character for each slot, then three for each mixer; 64 characters from `0`
/// on stand for 0 to 63.
const TEXT: &[u8] = include_bytes!("../../spec/priors.txt");

/// The first of the 64 characters.
pub const DIGIT: u8 = b'0';

/// The priors that the format prescribes.
pub static PRIOR: Prior = {
    let mut prior = Prior { slots: [1 << 15; SLOTS], weights: [[13; 3]; MIXERS] };
    let (mut at, mut number) = (0, 0);
    while at < TEXT.len() {
        if TEXT[at] >= DIGIT {
            let value = TEXT[at] - DIGIT;
            if number < SLOTS {
                prior.slots[number] = probability(value);
            } else {
                prior.weights[(number - SLOTS) / 3][(number - SLOTS) % 3] = value;
            }
            number += 1;
        }
        at += 1;
    }
    assert!(number == SLOTS + 3 * MIXERS, "spec/priors.txt does not fit the contexts; train it again");
    prior
};

/// The probability that a digit of the table stands for.
pub const fn probability(digit: u8) -> u16 {
    (squash((digit as i32 - 32) * 64 + 32) * 16 + 8) as u16
}
