//! Numbers as decisions, and the odds of each: what was seen in like contexts, before and in this glyph.
//!
//! A number is coded as: is it zero? is it negative? how many bits has it? and then those bits. Each of the first
//! questions is asked in up to three contexts; each context keeps its own odds, and the three are mixed. The
//! odds that a glyph begins with, and the weights of the mixtures, are learnt from fonts and are the same for all.

use alloc::vec::Vec;

use super::priors::{Prior, STRETCH, squash};
use super::range::{Coder, ONE};

/// The contexts' odds move this far (as a shift) towards what they have seen.
const RATE: u32 = 4;
/// Slots for the bits of a number below its leading one: two bits for each of seven lengths.
const TAIL: usize = 3 * TAIL_LENGTHS;
const TAIL_LENGTHS: usize = 7;

/// A kind of number and the contexts that it is coded in.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// How many contexts each of the three sets has. Only the first set is not empty: nothing is mixed.
    contexts: [usize; 3],
    /// Questions: is it zero, is it negative, has it more than 1, 2, … bits. The last stands for all longer ones.
    questions: usize,
    /// The first slot; each set's contexts follow each other, then the tail.
    slot: usize,
    /// The first mixture; one for each question.
    mix: usize,
}

/// Contexts and questions of each kind.
const SHAPES: [([usize; 3], usize); 12] = [
    ([6, 0, 0], 8),
    ([6, 0, 0], 12),
    ([3, 0, 0], 8),
    ([45, 32, 40], 6),
    ([25, 48, 125], 7),
    ([16, 49, 25], 1),
    ([16, 49, 9], 1),
    ([40, 49, 48], 10),
    ([25, 36, 18], 9),
    ([36, 25, 36], 9),
    ([9, 0, 0], 8),
    ([1, 0, 0], 1),
];

/// Counts: of knots, patterns and cells.
pub const COUNT: Kind = KINDS.0[0];
/// Knots and the box, in font units.
pub const UNITS: Kind = KINDS.0[1];
/// The predictor of a knot, bit by bit.
pub const PREDICTOR: Kind = KINDS.0[2];
/// By how many whole pixels a prediction is off.
pub const JUMP: Kind = KINDS.0[3];
/// By how much more it is off.
pub const FRACTION: Kind = KINDS.0[4];
/// Whether a coefficient is clipped.
pub const CLIPPED: Kind = KINDS.0[5];
/// Whether a coefficient is the least.
pub const LEAST: Kind = KINDS.0[6];
/// The residual of any other coefficient.
pub const COEFFICIENT: Kind = KINDS.0[7];
/// A node of a pattern.
pub const PATTERN: Kind = KINDS.0[8];
/// The weight of a pattern, against that of the size before.
pub const EMBEDDING: Kind = KINDS.0[9];
/// A place of a part, against that of the size before.
pub const PLACE: Kind = KINDS.0[10];
/// Whether there is ink.
pub const INK: Kind = KINDS.0[11];

/// All slots.
pub const SLOTS: usize = KINDS.1;
/// All mixtures.
pub const MIXTURES: usize = KINDS.2;

const KINDS: ([Kind; SHAPES.len()], usize, usize) = {
    let mut kinds = [Kind { contexts: [0; 3], questions: 0, slot: 0, mix: 0 }; SHAPES.len()];
    let (mut slot, mut mix, mut k) = (0, 0, 0);
    while k < SHAPES.len() {
        let (contexts, questions) = SHAPES[k];
        kinds[k] = Kind { contexts, questions, slot, mix };
        slot += (contexts[0] + contexts[1] + contexts[2]) * questions;
        if questions > 1 {
            slot += TAIL;
        }
        if contexts[1] > 0 {
            mix += questions;
        }
        k += 1;
    }
    (kinds, slot, mix)
};

/// Codes numbers with a coder, and learns from them.
pub struct Model<'p, C> {
    /// What reads or writes the decisions.
    pub coder: C,
    prior: &'p Prior,
    slots: Vec<u16>,
}

impl<'p, C: Coder> Model<'p, C> {
    /// A model that has seen nothing but its prior.
    pub fn new(coder: C, prior: &'p Prior) -> Self {
        Self { coder, prior, slots: prior.slots.to_vec() }
    }

    /// Codes one question's answer.
    #[inline(always)]
    fn ask(&mut self, kind: Kind, contexts: [usize; 3], question: usize, answer: bool) -> bool {
        debug_assert!((0..3).all(|i| contexts[i] < kind.contexts[i].max(1)), "{contexts:?} of {kind:?}");
        let question = question.min(kind.questions - 1);
        if kind.contexts[1] == 0 {
            return self.alone(kind.slot + contexts[0] * kind.questions + question, answer);
        }
        let [a, b, _] = kind.contexts;
        let slots = [contexts[0], a + contexts[1], a + b + contexts[2]]
            .map(|context| kind.slot + context * kind.questions + question);
        let mix = kind.mix + question;
        let said = slots.map(|slot| i32::from(STRETCH[usize::from(self.slots[slot] >> 4)]));
        let weights = self.prior.weights[mix].map(i32::from);
        let sum = said[0] * weights[0] + said[1] * weights[1] + said[2] * weights[2];
        let odds = squash((sum + 16) >> 5).clamp(1, ONE - 1);
        let answer = self.coder.bit(odds, answer);
        self.coder.watch(slots, said, mix, odds, answer);
        slots.into_iter().for_each(|slot| self.learn(slot, answer));
        answer
    }

    /// Codes a decision in one context.
    #[inline]
    fn alone(&mut self, slot: usize, answer: bool) -> bool {
        let odds = u32::from(self.slots[slot] >> 4).clamp(1, ONE - 1);
        let answer = self.coder.bit(odds, answer);
        self.coder.watch([slot; 3], [0; 3], usize::MAX, odds, answer);
        self.learn(slot, answer);
        answer
    }

    #[inline]
    fn learn(&mut self, slot: usize, answer: bool) {
        let odds = &mut self.slots[slot];
        if answer {
            *odds += (u16::MAX - *odds) >> RATE;
        } else {
            *odds -= *odds >> RATE;
        }
    }

    /// Codes whether something is the case.
    pub fn flag(&mut self, kind: Kind, contexts: [usize; 3], value: bool) -> bool {
        self.ask(kind, contexts, 0, value)
    }

    /// Codes a number of `width` bits, each of which has the bits before it as its context.
    pub fn bits(&mut self, kind: Kind, context: usize, width: u32, value: usize) -> usize {
        (0..width).rev().fold(1, |known, at| {
            // A context has as many slots as the number has values; the first of them is not used.
            let slot = kind.slot + (context << width) + known;
            known << 1 | usize::from(self.alone(slot, value >> at & 1 == 1))
        }) - (1 << width)
    }

    /// Codes a number with its sign.
    #[inline]
    pub fn signed(&mut self, kind: Kind, contexts: [usize; 3], value: i32) -> i32 {
        if !self.ask(kind, contexts, 0, value != 0) {
            return 0;
        }
        let negative = self.ask(kind, contexts, 1, value < 0);
        let size = self.positive(kind, contexts, value.unsigned_abs()) as i32;
        if negative { size.wrapping_neg() } else { size }
    }

    /// Codes a number that is at least 1.
    #[inline]
    pub fn positive(&mut self, kind: Kind, contexts: [usize; 3], value: u32) -> u32 {
        let length = if C::WRITES { 31 - value.max(1).leading_zeros() } else { 0 };
        let mut below = 0;
        while below < 31 && self.ask(kind, contexts, 2 + below as usize, below < length) {
            below += 1;
        }
        let tail = kind.slot + kind.contexts.iter().sum::<usize>() * kind.questions;
        (0..below).rev().fold(1, |known, at| {
            let bit = value >> at & 1 == 1;
            let bit = match (below - 1 - at, below as usize) {
                (depth @ 0..=1, 1..=TAIL_LENGTHS) => {
                    let at = if depth == 0 { 0 } else { 1 + (known as usize & 1) };
                    self.alone(tail + 3 * (below as usize - 1) + at, bit)
                }
                _ => self.coder.bit(ONE / 2, bit),
            };
            known << 1 | u32::from(bit)
        })
    }
}

/// The number of limits that a value reaches: contexts are classes of values.
#[inline]
pub fn class<const N: usize>(value: i32, limits: [i32; N]) -> usize {
    limits.iter().filter(|limit| value >= **limit).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specification_lists_the_kinds_with_their_contexts_and_questions() {
        let page = include_str!("../../spec/nfrt.md");
        let names = [
            "count",
            "units",
            "predictor",
            "jump",
            "fraction",
            "clipped",
            "least",
            "coefficient",
            "pattern",
            "embedding",
            "place",
            "ink",
        ];
        for (name, (contexts, questions)) in names.iter().zip(SHAPES) {
            let sets: Vec<String> = contexts.iter().filter(|n| **n > 0).map(usize::to_string).collect();
            let row = format!("| {name} | {} | {questions} |", sets.join(", "));
            assert!(page.contains(&row), "spec/nfrt.md does not say {row:?}");
        }
    }
}
