//! Context mixing, as in lpaq: numbers are binarised, and the probability of each bin is adapted in several contexts.
//!
//! A number is coded as: is it 0? is it negative? how many bits has it? and then those bits (an Exp-Golomb code). Each of
//! the first bins is coded in up to three contexts; each context has its own adaptive probability, and the three are mixed
//! in the logistic domain. The initial probabilities and the mixers' weights are trained on fonts and part of the format.

use alloc::vec::Vec;

use super::damage::malformed;
use super::elements::{Element, SUFFIX_LENGTHS};
use super::logistic::{squash, stretch};
use super::priors::Prior;
use super::range::{Coder, ONE};
use crate::error::Damage;

/// Adaptation rate of probabilities, as a shift.
const RATE: u32 = 4;

/// Codes numbers with a coder, and adapts to them.
pub struct ContextModel<'p, C> {
    /// Reads or writes the bins.
    pub coder: C,
    prior: Prior<'p>,
    slots: Vec<u16>,
}

impl<'p, C: Coder> ContextModel<'p, C> {
    /// A model in its initial state.
    pub fn new(coder: C, prior: &Prior<'p>) -> Self {
        Self::with_memory(coder, prior, Vec::new())
    }

    /// The same, in memory that another model leaves.
    pub(super) fn with_memory(coder: C, prior: &Prior<'p>, mut slots: Vec<u16>) -> Self {
        slots.clear();
        slots.extend_from_slice(prior.slots);
        Self { coder, prior: *prior, slots }
    }

    /// The model's memory, for another one, empty.
    pub(super) fn into_memory(mut self) -> Vec<u16> {
        self.slots.clear();
        self.slots
    }

    /// Goes back to the initial state, for another message.
    pub fn forget(&mut self) {
        self.slots.clear();
        self.slots.extend_from_slice(self.prior.slots);
    }

    /// Lends the memory to another model, and is in the initial state then if that model leaves it empty.
    pub(super) fn lend<T>(&mut self, f: impl FnOnce(&mut Vec<u16>) -> T) -> T {
        let given = f(&mut self.slots);
        if self.slots.len() != self.prior.slots.len() {
            self.forget();
        }
        given
    }

    /// The probability of a bin that is 1, in 1/4096, before it is coded.
    pub(super) fn probability(&self, element: Element, contexts: [usize; 3], bin: usize) -> u32 {
        let bin = bin.min(element.bins - 1);
        let [a, b, _] = element.contexts;
        if b == 0 {
            let slot = element.first_slot + contexts[0] * element.bins + bin;
            return u32::from(self.slots[slot] >> 4).clamp(1, ONE - 1);
        }
        let weights = self.prior.weights[element.first_mixer + bin];
        let slots = [contexts[0], a + contexts[1], a + b + contexts[2]];
        let terms = slots.into_iter().zip(weights).map(|(context, weight)| {
            let slot = element.first_slot + context * element.bins + bin;
            stretch(u32::from(self.slots[slot] >> 4)) * i32::from(weight)
        });
        squash((terms.sum::<i32>() + 16) >> 5).clamp(1, ONE - 1)
    }

    /// Codes one bin: its contexts' probabilities are mixed in the logistic domain.
    #[inline(always)]
    fn bin(&mut self, element: Element, contexts: [usize; 3], bin: usize, bit: bool) -> bool {
        debug_assert!(
            (0..3).all(|i| contexts[i] < element.contexts[i].max(1)),
            "{contexts:?} of {element:?}"
        );
        let bin = bin.min(element.bins - 1);
        if element.contexts[1] == 0 {
            return self.bin_of_slot(element.first_slot + contexts[0] * element.bins + bin, bit);
        }
        let [a, b, _] = element.contexts;
        let slots = [contexts[0], a + contexts[1], a + b + contexts[2]]
            .map(|context| element.first_slot + context * element.bins + bin);
        let mixer = element.first_mixer + bin;
        let stretched = slots.map(|slot| stretch(u32::from(self.slots[slot] >> 4)));
        let weights = self.prior.weights[mixer].map(i32::from);
        let sum = stretched[0] * weights[0] + stretched[1] * weights[1] + stretched[2] * weights[2];
        let probability = squash((sum + 16) >> 5).clamp(1, ONE - 1);
        let bit = self.coder.bit(probability, bit);
        self.coder.observe(slots, stretched, mixer, probability, bit);
        slots.into_iter().for_each(|slot| self.update(slot, bit));
        bit
    }

    /// Codes one bin with the probability of one slot.
    #[inline]
    fn bin_of_slot(&mut self, slot: usize, bit: bool) -> bool {
        let probability = u32::from(self.slots[slot] >> 4).clamp(1, ONE - 1);
        let bit = self.coder.bit(probability, bit);
        self.coder.observe([slot; 3], [0; 3], usize::MAX, probability, bit);
        self.update(slot, bit);
        bit
    }

    #[inline]
    fn update(&mut self, slot: usize, bit: bool) {
        // Towards 1 a probability moves as its complement does towards 0. No branch: nobody could guess it.
        let complement = u16::from(bit).wrapping_neg();
        let probability = self.slots[slot] ^ complement;
        self.slots[slot] = (probability - (probability >> RATE)) ^ complement;
    }

    /// Refuses to go on behind the end of the bytes.
    ///
    /// # Errors
    ///
    /// `Malformed` if more has been read than there is.
    pub(super) fn check(&self) -> Result<(), Damage> {
        if self.coder.is_exhausted() { Err(malformed("ends early")) } else { Ok(()) }
    }

    /// Codes a flag.
    pub fn flag(&mut self, element: Element, contexts: [usize; 3], value: bool) -> bool {
        self.bin(element, contexts, 0, value)
    }

    /// Codes a number of `width` bits. The context of each bit is the bits before it.
    pub fn bits(&mut self, element: Element, context: usize, width: u32, value: usize) -> usize {
        (0..width).rev().fold(1, |known, at| {
            // A binary tree of slots for each context; slot 0 of each is unused.
            let slot = element.first_slot + (context << width) + known;
            known << 1 | usize::from(self.bin_of_slot(slot, value >> at & 1 == 1))
        }) - (1 << width)
    }

    /// Codes a number with its sign.
    #[inline]
    pub fn signed(&mut self, element: Element, contexts: [usize; 3], value: i32) -> i32 {
        if !self.bin(element, contexts, 0, value != 0) {
            return 0;
        }
        let negative = self.bin(element, contexts, 1, value < 0);
        let size = self.positive(element, contexts, value.unsigned_abs()) as i32;
        if negative { size.wrapping_neg() } else { size }
    }

    /// Gives the probability, in 1/4096, of each bin of a number with its sign, without coding it.
    pub(super) fn visit_signed(
        &self,
        element: Element,
        contexts: [usize; 3],
        value: i32,
        visit: &mut dyn FnMut(u32),
    ) {
        let mut bin = |bin: usize, bit: bool| {
            let probability = self.probability(element, contexts, bin);
            visit(if bit { probability } else { ONE - probability });
        };
        bin(0, value != 0);
        if value == 0 {
            return;
        }
        bin(1, value < 0);
        let length = value.unsigned_abs().ilog2();
        (0..length).for_each(|k| bin(2 + k as usize, true));
        bin(2 + length as usize, false);
        (0..length).for_each(|_| visit(ONE / 2));
    }

    /// Codes a number that is at least 1.
    #[inline]
    pub fn positive(&mut self, element: Element, contexts: [usize; 3], value: u32) -> u32 {
        let length = if C::WRITES { 31 - value.max(1).leading_zeros() } else { 0 };
        let mut below = 0;
        while below < 31 && self.bin(element, contexts, 2 + below as usize, below < length) {
            below += 1;
        }
        let suffix = element.first_slot + element.contexts.iter().sum::<usize>() * element.bins;
        (0..below).rev().fold(1, |known, at| {
            let bit = value >> at & 1 == 1;
            let bit = match (below - 1 - at, below as usize) {
                (depth @ 0..=1, 1..=SUFFIX_LENGTHS) => {
                    let at = if depth == 0 { 0 } else { 1 + (known as usize & 1) };
                    self.bin_of_slot(suffix + 3 * (below as usize - 1) + at, bit)
                }
                _ => self.coder.bit(ONE / 2, bit),
            };
            known << 1 | u32::from(bit)
        })
    }
}

/// Quantises a value to a context: the number of limits that it reaches.
#[inline]
pub fn class<const N: usize>(value: i32, limits: [i32; N]) -> usize {
    limits.iter().filter(|limit| value >= **limit).count()
}
