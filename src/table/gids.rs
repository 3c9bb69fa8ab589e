//! Lists of glyphs.

use read_fonts::types::BigEndian;

use crate::error::Error;

/// Ascending lists and ranges of glyphs, merged.
#[derive(Debug, Clone, Default)]
pub struct Gids<'a> {
    lists: [&'a [BigEndian<u16>]; 3],
    /// Triples: the first glyph of a range, its last, and another number.
    ranges: &'a [BigEndian<u16>],
    /// The next glyph of the first range, if it is not its first one.
    next: Option<u16>,
}

impl<'a> Gids<'a> {
    pub(super) fn new(lists: [&'a [BigEndian<u16>]; 3], ranges: &'a [BigEndian<u16>]) -> Self {
        Self { lists, ranges, next: None }
    }

    /// The next glyph of the ranges, and the last of its range.
    fn peek_range(&self) -> Option<(u16, u16)> {
        let [first, last, ..] = self.ranges else { return None };
        Some((self.next.unwrap_or(first.get()), last.get()))
    }
}

impl Iterator for Gids<'_> {
    type Item = u16;

    fn next(&mut self) -> Option<u16> {
        let range = self.peek_range();
        let waiting = self.lists.iter_mut().filter(|list| !list.is_empty());
        let list = waiting.min_by_key(|list| list.first().map(|gid| gid.get()));
        let listed = list.as_ref().and_then(|list| list.first()).map(|gid| gid.get());
        if let Some((gid, last)) = range
            && listed.is_none_or(|listed| gid <= listed)
        {
            self.next = (gid < last).then(|| gid + 1);
            if gid >= last {
                self.ranges = self.ranges.get(3..).unwrap_or_default();
            }
            return Some(gid);
        }
        let list = list?;
        let (first, rest) = list.split_first()?;
        *list = rest;
        Some(first.get())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let listed = self.lists.iter().map(|list| list.len()).sum::<usize>();
        let ranges = self.ranges.chunks_exact(3);
        let in_ranges = ranges.map(|range| usize::from(range[1].get().saturating_sub(range[0].get())) + 1);
        let taken = self.peek_range().map_or(0, |(next, _)| usize::from(next - self.ranges[0].get()));
        let left = listed + in_ranges.sum::<usize>() - taken;
        (left, Some(left))
    }
}

impl ExactSizeIterator for Gids<'_> {}

/// The index of a glyph in an ascending list.
pub(super) fn find(gids: &[BigEndian<u16>], gid: u32) -> Option<usize> {
    gids.binary_search_by_key(&gid, |listed| listed.get().into()).ok()
}

/// The error for a glyph whose bytes lie outside the table.
pub(super) fn outside(gid: u32) -> Error {
    Error::MalformedModel { glyph: gid, what: "lies outside the table" }
}
