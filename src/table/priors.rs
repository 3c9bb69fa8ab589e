//! What glyphs begin with: odds and weights learnt from fonts, kept in `spec/priors.txt`.

use super::contexts::{MIXTURES, SLOTS};
use super::range::ONE;

/// The odds of each slot in 1/65536 and the weights of each mixture in 1/32.
#[derive(Debug, Clone)]
pub struct Prior {
    /// The odds of each slot, in 1/65536.
    pub slots: [u16; SLOTS],
    /// The weights of each mixture, in 1/32.
    pub weights: [[u8; 3]; MIXTURES],
}

/// The table of the specification: a character for each slot, then three for each mixture; 64 characters from `0`
/// on stand for 0 to 63.
const TEXT: &[u8] = include_bytes!("../../spec/priors.txt");

/// The first of the 64 characters.
pub const DIGIT: u8 = b'0';

/// The priors that the format prescribes.
pub static PRIOR: Prior = {
    let mut prior = Prior { slots: [1 << 15; SLOTS], weights: [[13; 3]; MIXTURES] };
    let (mut at, mut number) = (0, 0);
    while at < TEXT.len() {
        if TEXT[at] >= DIGIT {
            let value = TEXT[at] - DIGIT;
            if number < SLOTS {
                prior.slots[number] = odds(value);
            } else {
                prior.weights[(number - SLOTS) / 3][(number - SLOTS) % 3] = value;
            }
            number += 1;
        }
        at += 1;
    }
    assert!(number == SLOTS + 3 * MIXTURES, "spec/priors.txt does not fit the contexts; learn it again");
    prior
};

/// The odds that a digit of the table stands for.
pub const fn odds(digit: u8) -> u16 {
    (squash((digit as i32 - 32) * 64 + 32) * 16 + 8) as u16
}

/// The logistic function at every half unit from −8 to 8, in 1/4096.
const CURVE: [i32; 33] = [
    1, 2, 3, 6, 10, 16, 27, 45, 73, 120, 194, 310, 488, 747, 1101, 1546, 2047, 2549, 2994, 3348, 3607, 3785,
    3901, 3975, 4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094,
];

/// The logistic function at 256 steps to the unit, in 1/4096: from what contexts say to odds.
pub const fn squash(said: i32) -> u32 {
    if said > 2047 {
        return ONE - 1;
    }
    if said < -2047 {
        return 0;
    }
    let (at, share) = (((said >> 7) + 16) as usize, said & 127);
    ((CURVE[at] * (128 - share) + CURVE[at + 1] * share + 64) >> 7) as u32
}

/// Its inverse, from odds to what a context says: the least number with at least those odds.
pub static STRETCH: [i16; ONE as usize] = {
    let mut table = [2047; ONE as usize];
    let (mut said, mut odds) = (-2047, 0);
    while odds < ONE {
        while said < 2047 && squash(said) < odds {
            said += 1;
        }
        table[odds as usize] = said as i16;
        odds += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specification_lists_the_curve() {
        let page = include_str!("../../spec/nfrt.md").split_whitespace().collect::<Vec<_>>().join(" ");
        let curve = CURVE.map(|odds| odds.to_string()).join(" ");
        assert!(page.contains(&format!("C = {curve} and")), "spec/nfrt.md does not list the curve");
    }

    #[test]
    fn what_is_squashed_is_stretched_back() {
        for odds in 1..ONE - 1 {
            let back = squash(STRETCH[odds as usize].into());
            // The curve rises by up to four a step.
            assert!((odds..odds + 4).contains(&back), "{odds} comes back as {back}");
        }
        assert!(STRETCH.is_sorted());
    }
}
