//! A binary arithmetic coder: one bin after the other, each with its probability.
//!
//! It is the carry-less coder of lpaq: an interval of 32-bit numbers is split in proportion, and a leading byte that
//! both ends share is output. constriction 0.5, the crate for this, ends each message with whole words of 16 or
//! 32 bits and brings five dependencies; a glyph is some hundreds of bytes, and the renderer's list of dependencies is
//! to stay short.

use alloc::vec::Vec;
use core::hint::select_unpredictable;

/// The probability 1.
pub const ONE: u32 = 1 << 12;

/// Codes bins: writes them, reads them, or adds up their cost.
pub trait Coder {
    /// Whether the bins are known beforehand.
    const WRITES: bool;

    /// Codes a bin that is 1 with probability `probability` / [`ONE`], which is neither 0 nor 1. A reader ignores `bit`
    /// and returns what it has read.
    fn bit(&mut self, probability: u32, bit: bool) -> bool;

    /// Whether more has been read than there is; what is read then is meaningless.
    fn is_exhausted(&self) -> bool {
        false
    }

    /// Begins a section of the message: a writer keeps its bytes for the end of the message.
    fn begin_section(&mut self) {}

    /// Ends the section, and gives its length in bytes.
    fn end_section(&mut self) -> usize {
        0
    }

    /// Goes on with a section of the message, counted from 0, if this is a reader: `lengths` has the bytes of all sections but
    /// the first.
    ///
    /// # Errors
    ///
    /// `Early` for sections that are longer than the message.
    fn enter_section(&mut self, _lengths: &[usize], _section: usize) -> Result<(), End> {
        Ok(())
    }

    /// Checks that what is read ends here: the message, or the section that was entered.
    ///
    /// # Errors
    ///
    /// If the bins do not end where the bytes do.
    fn check_end(&self) -> Result<(), End> {
        Ok(())
    }

    /// Is given the source of each probability: the contexts' slots, the stretched probability of each, and the mixer;
    /// `usize::MAX` if nothing was mixed.
    #[inline]
    fn observe(&mut self, _slots: [usize; 3], _stretched: [i32; 3], _mixer: usize, _p: u32, _bit: bool) {}
}

/// The interval that the bins so far have narrowed.
#[derive(Debug, Clone, Copy)]
struct Interval {
    low: u32,
    high: u32,
}

impl Interval {
    const WHOLE: Self = Self { low: 0, high: u32::MAX };

    /// The last number that stands for a 1.
    fn split(self, probability: u32) -> u32 {
        self.low + (u64::from(self.high - self.low) * u64::from(probability) / u64::from(ONE)) as u32
    }

    fn narrow(&mut self, split: u32, bit: bool) {
        self.high = select_unpredictable(bit, split, self.high);
        self.low = select_unpredictable(bit, self.low, split.wrapping_add(1));
    }

    /// The leading byte, if both ends share it; the interval then goes on with the bytes behind.
    fn shift_byte(&mut self) -> Option<u8> {
        if (self.low ^ self.high) >> 24 != 0 {
            return None;
        }
        let byte = (self.low >> 24) as u8;
        self.low <<= 8;
        self.high = self.high << 8 | 0xFF;
        Some(byte)
    }

    /// The byte that ends a message, so that zeros after it stay within the interval; none if zeros alone do.
    fn last(self) -> Option<u8> {
        (self.low > 0).then_some((self.low.saturating_add(0x00FF_FFFF) >> 24) as u8)
    }

    /// The bytes that end what other bytes follow, so that whatever they are stays within the interval: as few as there can be,
    /// and how many.
    fn last_followed(self) -> ([u8; 4], usize) {
        for count in 0..4 {
            let rest = u32::MAX.checked_shr(8 * count).unwrap_or(0);
            let start = (u64::from(self.low) + u64::from(rest)) & !u64::from(rest);
            if start + u64::from(rest) <= u64::from(self.high) {
                return ((start as u32).to_be_bytes(), count as usize);
            }
        }
        (self.low.to_be_bytes(), 4)
    }
}

/// Writes bins.
#[derive(Debug)]
pub struct Encoder {
    interval: Interval,
    bytes: Vec<u8>,
    /// The bytes of the sections that are ended.
    sections: Option<Vec<u8>>,
    /// What is coded outside of the section that is begun.
    outside: Option<(Interval, Vec<u8>)>,
}

impl Encoder {
    /// An encoder that has written nothing.
    #[expect(clippy::new_without_default, reason = "an encoder is made to write, never as a placeholder")]
    pub fn new() -> Self {
        Self { interval: Interval::WHOLE, bytes: Vec::new(), sections: None, outside: None }
    }

    /// The bytes of all bins.
    pub fn finish(mut self) -> Vec<u8> {
        match self.sections {
            None => self.bytes.extend(self.interval.last()),
            Some(sections) => {
                let (last, count) = self.interval.last_followed();
                self.bytes.extend(&last[..count]);
                self.bytes.extend(sections);
            }
        }
        self.bytes
    }
}

impl Coder for Encoder {
    const WRITES: bool = true;

    fn bit(&mut self, probability: u32, bit: bool) -> bool {
        self.interval.narrow(self.interval.split(probability), bit);
        while let Some(byte) = self.interval.shift_byte() {
            self.bytes.push(byte);
        }
        bit
    }

    fn begin_section(&mut self) {
        let interval = core::mem::replace(&mut self.interval, Interval::WHOLE);
        self.outside = Some((interval, core::mem::take(&mut self.bytes)));
    }

    fn end_section(&mut self) -> usize {
        let Some((interval, bytes)) = self.outside.take() else { return 0 };
        let last = core::mem::replace(&mut self.interval, interval).last();
        let mut section = core::mem::replace(&mut self.bytes, bytes);
        section.extend(last);
        self.sections.get_or_insert_default().extend(&section);
        section.len()
    }
}

/// Reads bins. Beyond the end of the bytes there are zeros.
#[derive(Debug)]
pub struct Decoder<'a> {
    interval: Interval,
    message: &'a [u8],
    /// The part of the message that is read.
    bytes: &'a [u8],
    /// Whether sections follow it.
    is_followed: bool,
    /// How many bytes are shifted out; four more are in `window`.
    consumed: usize,
    window: u32,
}

/// How a message can fail to end where its bytes do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The bins need more bytes than there are.
    Early,
    /// There are more bytes than the bins need.
    Late,
}

impl<'a> Decoder<'a> {
    /// A decoder at the beginning of a message.
    pub fn new(bytes: &'a [u8]) -> Self {
        let mut decoder = Self {
            interval: Interval::WHOLE,
            message: bytes,
            bytes,
            is_followed: false,
            consumed: 0,
            window: 0,
        };
        decoder.window = (0..4).fold(0, |window, at| window << 8 | decoder.byte(at));
        decoder
    }

    fn byte(&self, at: usize) -> u32 {
        self.bytes.get(at).copied().unwrap_or(0).into()
    }

    /// Checks that the message ends where its bytes do.
    ///
    /// # Errors
    ///
    /// If the bins do not end where the bytes do.
    pub fn finish(self) -> Result<(), End> {
        self.check_end()
    }
}

impl Coder for Decoder<'_> {
    const WRITES: bool = false;

    #[inline]
    fn bit(&mut self, probability: u32, _bit: bool) -> bool {
        let split = self.interval.split(probability);
        let bit = self.window <= split;
        self.interval.narrow(split, bit);
        while self.interval.shift_byte().is_some() {
            self.window = self.window << 8 | self.byte(self.consumed + 4);
            self.consumed += 1;
        }
        bit
    }

    fn is_exhausted(&self) -> bool {
        self.consumed > self.bytes.len()
    }

    fn enter_section(&mut self, lengths: &[usize], section: usize) -> Result<(), End> {
        // Damaged lengths may add up to more than there are numbers.
        let sum = |lengths: &[usize]| lengths.iter().fold(0usize, |sum, length| sum.saturating_add(*length));
        let end = |lengths: &[usize]| self.message.len().checked_sub(sum(lengths));
        let begin = match section.checked_sub(1) {
            None => Some(0),
            Some(before) => end(lengths.get(before..).unwrap_or_default()),
        };
        let end = end(lengths.get(section..).unwrap_or_default());
        let bytes = begin.zip(end).and_then(|(begin, end)| self.message.get(begin..end)).ok_or(End::Early)?;
        if section == 0 {
            (self.bytes, self.is_followed) = (bytes, true);
        } else {
            *self = Self { message: self.message, ..Self::new(bytes) };
        }
        Ok(())
    }

    fn check_end(&self) -> Result<(), End> {
        let last = match self.is_followed {
            true => self.interval.last_followed().1,
            false => usize::from(self.interval.last().is_some()),
        };
        match (self.consumed + last).cmp(&self.bytes.len()) {
            core::cmp::Ordering::Greater => Err(End::Early),
            core::cmp::Ordering::Equal => Ok(()),
            core::cmp::Ordering::Less => Err(End::Late),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bins() -> impl Strategy<Value = Vec<(u32, bool)>> {
        let probability = prop_oneof![1..ONE, Just(1), Just(ONE - 1), Just(ONE / 2)];
        prop::collection::vec((probability, any::<bool>()), 0..2000)
    }

    fn encode(bins: &[(u32, bool)]) -> Vec<u8> {
        let mut encoder = Encoder::new();
        bins.iter().for_each(|(probability, bit)| {
            encoder.bit(*probability, *bit);
        });
        encoder.finish()
    }

    fn decode(bytes: &[u8], bins: &[(u32, bool)]) -> (Vec<bool>, Result<(), End>) {
        let mut decoder = Decoder::new(bytes);
        let bits = bins.iter().map(|(probability, _)| decoder.bit(*probability, false)).collect();
        (bits, decoder.finish())
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn bins_are_read_as_they_were_written(bins in bins()) {
            let expected: Vec<bool> = bins.iter().map(|(_, bit)| *bit).collect();
            prop_assert_eq!(decode(&encode(&bins), &bins), (expected, Ok(())));
        }

        #[test]
        fn bins_take_as_many_bits_as_their_probability_say(bins in bins()) {
            let bits: f64 = bins
                .iter()
                .map(|&(probability, bit)| -(f64::from(if bit { probability } else { ONE - probability }) / f64::from(ONE)).log2())
                .sum();
            let bytes = encode(&bins).len() as f64;
            prop_assert!((bytes - bits / 8.0).abs() <= 2.0 + 0.001 * bits, "{bytes} for {bits} bits");
        }

        #[test]
        fn other_lengths_never_mean_the_same(bins in bins(), at in any::<prop::sample::Index>()) {
            let mut bytes = encode(&bins);
            let expected: Vec<bool> = bins.iter().map(|(_, bit)| *bit).collect();
            if !bytes.is_empty() {
                prop_assert_ne!(
                    decode(&bytes[..at.index(bytes.len())], &bins), (expected.clone(), Ok(()))
                );
            }
            bytes.push(0);
            prop_assert_eq!(decode(&bytes, &bins), (expected, Err(End::Late)));
        }

        #[test]
        fn sections_are_read_without_each_other(
            first in bins(), sections in prop::collection::vec(bins(), 1..4), at in any::<prop::sample::Index>(),
        ) {
            let mut encoder = Encoder::new();
            let code = |coder: &mut Encoder, bins: &[(u32, bool)]| bins.iter().for_each(|(p, bit)| {
                coder.bit(*p, *bit);
            });
            code(&mut encoder, &first);
            let lengths: Vec<usize> = sections.iter().map(|section| {
                encoder.begin_section();
                code(&mut encoder, section);
                encoder.end_section()
            }).collect();
            let message = encoder.finish();
            let read = |section: usize, bins: &[(u32, bool)]| {
                let mut decoder = Decoder::new(&message);
                decoder.enter_section(&lengths, section).expect("a section");
                let bits: Vec<bool> = bins.iter().map(|(p, _)| decoder.bit(*p, false)).collect();
                (bits, decoder.check_end())
            };
            let bits = |bins: &[(u32, bool)]| bins.iter().map(|(_, bit)| *bit).collect::<Vec<bool>>();
            prop_assert_eq!(read(0, &first), (bits(&first), Ok(())));
            let at = at.index(sections.len());
            prop_assert_eq!(read(at + 1, &sections[at]), (bits(&sections[at]), Ok(())));
            prop_assert_eq!(Decoder::new(&message).enter_section(&[message.len(), 1], 1), Err(End::Early));
        }
    }
}
