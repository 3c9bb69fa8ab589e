//! The lists that the selection options take.

use std::ops::RangeInclusive;
use std::str::FromStr;

/// Ranges of code points, as in CSS: `U+20-7E,U+E9,U+4??`; plain hexadecimal too.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CodePoints(pub Vec<RangeInclusive<u32>>);

/// Ranges of glyph numbers, as in `3,5-9`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GlyphIds(pub Vec<RangeInclusive<u16>>);

/// Glyph names, as in `a,eacute`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GlyphNames(pub Vec<String>);

/// Reads the items of a list that commas or white space separate. An empty list is an error, because it would select
/// nothing.
fn items<T>(text: &str, parse: impl Fn(&str) -> Result<T, String>) -> Result<Vec<T>, String> {
    let separator = |c: char| c == ',' || c.is_whitespace();
    let items: Vec<T> =
        text.split(separator).filter(|item| !item.is_empty()).map(parse).collect::<Result<_, _>>()?;
    if items.is_empty() {
        Err("the list is empty; leave the option out or name something".into())
    } else {
        Ok(items)
    }
}

impl FromStr for CodePoints {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parse = |item: &str| -> Result<RangeInclusive<u32>, String> {
            let number = |text: &str| {
                let digits = text.strip_prefix("U+").or_else(|| text.strip_prefix("u+")).unwrap_or(text);
                // `from_str_radix` would take a sign.
                let digits = digits.bytes().all(|b| b.is_ascii_hexdigit()).then_some(digits)?;
                u32::from_str_radix(digits, 16).ok().filter(|&code| code <= u32::from(char::MAX))
            };
            // Question marks stand for any digit.
            let any = item.trim_end_matches('?').len()..item.len();
            let ends = if any.is_empty() {
                let (first, last) = item.split_once('-').unwrap_or((item, item));
                (number(first), number(last))
            } else {
                let end = |digit: &str| number(&format!("{}{}", &item[..any.start], digit.repeat(any.len())));
                // The last range may reach beyond the last code point.
                (end("0"), end("F").or(end("0").map(|_| u32::from(char::MAX))))
            };
            match ends {
                (Some(first), Some(last)) if first <= last => Ok(first..=last),
                _ => Err(format!(
                    "{item:?} is no code point; write U+E9, E9, U+20-7E or U+4?? (up to U+10FFFF)"
                )),
            }
        };
        Ok(Self(items(text, parse)?))
    }
}

impl FromStr for GlyphIds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parse = |item: &str| -> Result<RangeInclusive<u16>, String> {
            let (first, last) = item.split_once('-').unwrap_or((item, item));
            match (first.parse(), last.parse()) {
                (Ok(first), Ok(last)) if first <= last => Ok(first..=last),
                _ => Err(format!("{item:?} is no glyph number; write 3 or 5-9 (0 to {})", u16::MAX)),
            }
        };
        Ok(Self(items(text, parse)?))
    }
}

impl FromStr for GlyphNames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self(items(text, |name| Ok(name.to_owned()))?))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn code_points_read_with_and_without_the_prefix() {
        let all: CodePoints = "U+20-7E,e9 u+0041-U+0042".parse().unwrap();
        assert_eq!(all.0, [0x20..=0x7e, 0xe9..=0xe9, 0x41..=0x42]);
    }

    #[test]
    fn glyph_numbers_read_as_numbers_and_ranges() {
        assert_eq!("3,5-9".parse::<GlyphIds>().unwrap().0, [3..=3, 5..=9]);
    }

    #[test]
    fn a_list_that_makes_no_sense_is_refused() {
        for text in ["", ",", "U+", "+41", "G", "110000", "7E-20", "-5", "U+20-", "2-3-4"] {
            assert!(text.parse::<CodePoints>().is_err(), "{text}");
        }
        for text in ["", "x", "9-5", "70000", "-1", "0x10", "1-"] {
            assert!(text.parse::<GlyphIds>().is_err(), "{text}");
        }
        assert!(" ,".parse::<GlyphNames>().is_err());
    }
}
