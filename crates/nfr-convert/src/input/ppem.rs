//! A list of sizes, as people write it: `12`, `8-64`, `8-64:2`, `9,12,16-20`.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// The largest size that the teacher draws, in pixels per em.
pub const MAX_TEACHER_PPEM: u16 = 1024;

/// Sizes in pixels per em: ascending, without repeats, never empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PpemList(Vec<u16>);

impl PpemList {
    /// The sizes, ascending.
    pub fn sizes(&self) -> &[u16] {
        &self.0
    }

    /// The sizes of both lists.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let mut sizes = [&*self.0, &other.0].concat();
        sizes.sort_unstable();
        sizes.dedup();
        Self(sizes)
    }

    /// The list's ends and the step between its sizes, if that is the same throughout. It is 1 for one size.
    pub fn evenly_spaced(&self) -> Option<(RangeInclusive<u16>, u16)> {
        let (first, last) = (*self.0.first()?, *self.0.last()?);
        let step = self.0.get(1).map_or(1, |second| second - first);
        self.0.windows(2).all(|pair| pair[1] - pair[0] == step).then_some((first..=last, step))
    }
}

impl From<RangeInclusive<u16>> for PpemList {
    /// Every size of a range, which must not be empty.
    fn from(range: RangeInclusive<u16>) -> Self {
        Self(range.collect())
    }
}

/// Joins ranges without steps: `9,12,16-20`.
impl fmt::Display for PpemList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let runs = self.0.chunk_by(|a, b| a + 1 == *b);
        for (i, run) in runs.enumerate() {
            let comma = if i > 0 { "," } else { "" };
            match run {
                [one] => write!(f, "{comma}{one}")?,
                [first, .., last] => write!(f, "{comma}{first}-{last}")?,
                [] => {}
            }
        }
        Ok(())
    }
}

impl FromStr for PpemList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut sizes = Vec::new();
        for item in text.split(',') {
            sizes.extend(parse_item(item.trim())?);
        }
        sizes.sort_unstable();
        sizes.dedup();
        Ok(Self(sizes))
    }
}

/// One size, a range, or a range with a step.
fn parse_item(item: &str) -> Result<impl Iterator<Item = u16> + use<>, String> {
    let usage = || format!("{item:?} is no size; write 12, 8-64, 8-64:2 or 9,12,16-20");
    let (range, step) = match item.split_once(':') {
        Some((range, step)) if range.contains('-') => (range, step.parse::<usize>().map_err(|_| usage())?),
        Some(_) => return Err(usage()),
        None => (item, 1),
    };
    let (first, last) = range.split_once('-').unwrap_or((range, range));
    let parse = |size: &str| -> Result<u16, String> {
        let value: u32 = size.trim().parse().map_err(|_| usage())?;
        match u16::try_from(value) {
            Ok(size) if size > 0 && size <= MAX_TEACHER_PPEM => Ok(size),
            _ => Err(format!("{value} ppem is outside 1-{MAX_TEACHER_PPEM}; choose sizes within")),
        }
    };
    let (first, last) = (parse(first)?, parse(last)?);
    if first > last {
        return Err(format!("the range {range:?} runs backwards; write {last}-{first}"));
    }
    if step == 0 {
        return Err(format!("the step in {item:?} is 0; write 1 or more"));
    }
    Ok((first..=last).step_by(step))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn sizes(text: &str) -> Vec<u16> {
        text.parse::<PpemList>().unwrap().sizes().to_vec()
    }

    #[test]
    fn reads_sizes_ranges_steps_and_lists() {
        assert_eq!(sizes("12"), [12]);
        assert_eq!(sizes("8-11"), [8, 9, 10, 11]);
        assert_eq!(sizes("8-13:2"), [8, 10, 12]);
        assert_eq!(sizes("9, 12,16-18,17"), [9, 12, 16, 17, 18]);
    }

    #[test]
    fn says_what_is_wrong_with_a_size() {
        for text in ["", "0", "8-", "-8", "x", "64-8", "8-64:0", "12:2", "1025", "70000", "8-64:", "1.5"] {
            let error = text.parse::<PpemList>().unwrap_err();
            assert!(error.contains("write") || error.contains("choose"), "{text}: {error}");
        }
    }

    #[test]
    fn a_list_is_evenly_spaced_if_it_has_one_step() {
        let spaced = |text: &str| text.parse::<PpemList>().unwrap().evenly_spaced();
        assert_eq!(spaced("8-12"), Some((8..=12, 1)));
        assert_eq!(spaced("8,9,10"), Some((8..=10, 1)));
        assert_eq!(spaced("8-13:2"), Some((8..=12, 2)));
        assert_eq!(spaced("12"), Some((12..=12, 1)));
        assert_eq!(spaced("8,9,11"), None);
    }

    #[test]
    fn a_union_has_the_sizes_of_both_once() {
        let [a, b] = ["8-10,20", "9-12"].map(|text| text.parse::<PpemList>().unwrap());
        assert_eq!(a.union(&b).to_string(), "8-12,20");
    }

    #[test]
    fn prints_the_shortest_list_that_reads_back() {
        for (text, canonical) in [("8-64", "8-64"), ("12", "12"), ("9,12,16-18,19", "9,12,16-19")] {
            let list: PpemList = text.parse().unwrap();
            assert_eq!(list.to_string(), canonical);
            assert_eq!(canonical.parse::<PpemList>().unwrap(), list);
        }
    }
}
