//! The certificate: who taught the models, and how far each glyph is from its teacher. Nothing is drawn from it.

use core::fmt;
use core::str;

use read_fonts::FontData;

use crate::error::Error;

/// The bytes of a glyph's errors.
const ERROR_BYTES: usize = 3;
/// The bits of an error's code below its exponent.
const MANTISSA_BITS: u8 = 4;
/// What a code of 1 stands for.
const UNIT: f64 = 1.0 / 500_000.0;

/// What a conversion says of itself and of its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Certificate<'a> {
    /// Whether all hinted points are the teacher's, at every size of the models.
    pub is_exact: bool,
    /// The engine that ran the hints, with its version.
    pub teacher: &'a str,
    /// The converter, with its version.
    pub converter: &'a str,
    /// Its options.
    pub options: &'a str,
    /// Three bytes for each glyph of the table, in ascending order.
    errors: &'a [u8],
}

/// What a glyph's error does not exceed, over all sizes of the models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct CertifiedErrors {
    /// The mean absolute error.
    pub mae: Bound,
    /// The share of pixels that are off by more than 16 of 255.
    pub bad16: Bound,
    /// The largest difference of a pixel, of 255.
    pub max: u8,
}

/// A number from 0 to 1, rounded up to the next one that a byte can stand for: at most by a sixteenth.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Bound(u8);

impl Bound {
    /// The least bound that is no less than `value`, which is at most 1.
    pub fn of(value: f64) -> Self {
        Self((0..u8::MAX).find(|code| Self(*code).value() >= value).unwrap_or(u8::MAX))
    }

    /// The bound.
    pub fn value(self) -> f64 {
        let one = 1 << MANTISSA_BITS;
        let (exponent, mantissa) = (self.0 >> MANTISSA_BITS, u32::from(self.0 % one));
        let units = match exponent.checked_sub(1) {
            None => mantissa,
            Some(shift) => (mantissa + u32::from(one)) << shift,
        };
        f64::from(units) * UNIT
    }
}

impl fmt::Debug for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.6}", self.value())
    }
}

impl<'a> Certificate<'a> {
    /// A certificate without errors.
    pub fn new(is_exact: bool, teacher: &'a str, converter: &'a str, options: &'a str) -> Self {
        Self { is_exact, teacher, converter, options, errors: &[] }
    }

    /// Reads a certificate of so many glyphs, which begins at `at`. Returns the offset behind it, too.
    pub(super) fn parse(data: FontData<'a>, at: usize, glyphs: usize) -> Result<(Self, usize), Error> {
        let ends = || Error::MalformedModels { what: "ends before its certificate does", offset: at };
        let bytes = data.as_bytes();
        let (is_exact, mut rest) = bytes.get(at..).and_then(<[u8]>::split_first).ok_or_else(ends)?;
        let mut text = || {
            let (length, after) = rest.split_first().ok_or_else(ends)?;
            let (text, after) = after.split_at_checked((*length).into()).ok_or_else(ends)?;
            rest = after;
            str::from_utf8(text).map_err(|_| Error::MalformedModels {
                what: "has a certificate that is not UTF-8",
                offset: at,
            })
        };
        let (teacher, converter, options) = (text()?, text()?, text()?);
        let (errors, rest) = rest.split_at_checked(ERROR_BYTES * glyphs).ok_or_else(ends)?;
        let certificate = Self { is_exact: *is_exact & 1 == 1, teacher, converter, options, errors };
        Ok((certificate, bytes.len() - rest.len()))
    }

    /// What it says of the glyphs, in ascending order.
    pub fn errors(&self) -> impl Iterator<Item = CertifiedErrors> + 'a {
        self.errors.chunks_exact(ERROR_BYTES).map(|glyph| CertifiedErrors {
            mae: Bound(glyph[0]),
            bad16: Bound(glyph[1]),
            max: glyph[2],
        })
    }

    /// Appends it to a table, with the errors of all glyphs in ascending order. Each text is cut to 255 bytes.
    pub fn write(&self, errors: impl IntoIterator<Item = CertifiedErrors>, table: &mut alloc::vec::Vec<u8>) {
        table.push(self.is_exact.into());
        for text in [self.teacher, self.converter, self.options] {
            let text = &text[..text.floor_char_boundary(u8::MAX.into())];
            table.push(text.len() as u8);
            table.extend(text.bytes());
        }
        table.extend(errors.into_iter().flat_map(|glyph| [glyph.mae.0, glyph.bad16.0, glyph.max]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;

    #[test]
    fn a_bound_is_no_less_than_what_it_bounds_and_at_most_a_sixteenth_more() {
        let mut value = 1e-7;
        while value < 1.0 {
            let bound = Bound::of(value).value();
            assert!(bound >= value && bound <= (value * 17.0 / 16.0).max(value + UNIT), "{value} {bound}");
            value *= 1.01;
        }
        assert_eq!((Bound::of(0.0).value(), Bound::of(0.0)), (0.0, Bound(0)));
        assert!(Bound::of(1.0).value() >= 1.0);
        let values: Vec<f64> = (0..=u8::MAX).map(|code| Bound(code).value()).collect();
        assert!(values.is_sorted_by(|a, b| a < b), "{values:?}");
    }

    #[test]
    fn a_certificate_is_read_as_it_was_written_and_no_shorter() {
        let errors = [(0.0, 0.0, 0), (0.0001, 0.01, 255)].map(|(mae, bad16, max)| CertifiedErrors {
            mae: Bound::of(mae),
            bad16: Bound::of(bad16),
            max,
        });
        let long = "ä".repeat(200);
        let mut table = alloc::vec![7; 5];
        Certificate::new(true, "engine 1", "", &long).write(errors, &mut table);
        let written = table.len();
        let (read, end) = Certificate::parse(FontData::new(&table), 5, 2).expect("a certificate");
        assert_eq!(end, written);
        assert_eq!((read.is_exact, read.teacher, read.converter), (true, "engine 1", ""));
        assert_eq!(read.options, "ä".repeat(127));
        assert!(read.errors().eq(errors));
        for length in 5..table.len() {
            assert!(Certificate::parse(FontData::new(&table[..length]), 5, 2).is_err(), "{length} bytes");
        }
        table[7] = 0xFF;
        assert!(Certificate::parse(FontData::new(&table), 5, 2).is_err());
    }
}
