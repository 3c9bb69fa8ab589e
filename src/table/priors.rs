//! The initial state of context models: probabilities and mixer weights trained on fonts, kept in `spec/priors.txt` and
//! `spec/outline-priors.txt`.

use super::elements::{Element, MIXERS, OUTLINE_MIXERS, OUTLINE_SLOTS, SLOTS};
use super::logistic::squash;
use super::range::ONE;

/// The initial probability of each slot and the weights of each mixer.
#[derive(Debug, Clone, Copy)]
pub struct Prior<'a> {
    /// The probability of each slot, in 1/65536.
    pub slots: &'a [u16],
    /// The weights of each mixer, in 1/32.
    pub weights: &'a [[u8; 3]],
}

impl Prior<'_> {
    /// The initial probability of a slot of an element, in 1/4096.
    pub(super) fn probability(&self, element: Element, slot: usize) -> u32 {
        u32::from(self.slots[element.first_slot + slot] >> 4).clamp(1, ONE - 1)
    }
}

/// The first of the 64 characters.
pub const DIGIT: u8 = b'0';

/// The priors that the format prescribes for fields.
pub static PRIOR: Prior<'static> = Prior { slots: &FIELDS.0, weights: &FIELDS.1 };
/// Those of outlines.
pub static OUTLINE_PRIOR: Prior<'static> = Prior { slots: &OUTLINES.0, weights: &OUTLINES.1 };

static FIELDS: ([u16; SLOTS], [[u8; 3]; MIXERS]) = parse(include_bytes!("../../spec/priors.txt"));
static OUTLINES: ([u16; OUTLINE_SLOTS], [[u8; 3]; OUTLINE_MIXERS]) =
    parse(include_bytes!("../../spec/outline-priors.txt"));

/// Reads a table of the specification: a character for each slot, then three for each mixer; 64 characters from `0`
/// on stand for 0 to 63.
const fn parse<const S: usize, const M: usize>(text: &[u8]) -> ([u16; S], [[u8; 3]; M]) {
    let (mut slots, mut weights) = ([1 << 15; S], [[13; 3]; M]);
    let (mut at, mut number) = (0, 0);
    while at < text.len() {
        if text[at] >= DIGIT {
            let value = text[at] - DIGIT;
            if number < S {
                slots[number] = probability(value);
            } else {
                weights[(number - S) / 3][(number - S) % 3] = value;
            }
            number += 1;
        }
        at += 1;
    }
    assert!(number == S + 3 * M, "a table of priors does not fit the contexts; train it again");
    (slots, weights)
}

/// The probability that a digit of the table stands for.
pub const fn probability(digit: u8) -> u16 {
    (squash((digit as i32 - 32) * 64 + 32) * 16 + 8) as u16
}
