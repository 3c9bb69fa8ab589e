//! Lists of glyphs.

use read_fonts::types::BigEndian;

use crate::error::Error;

/// Ascending lists of glyphs, merged.
#[derive(Debug, Clone, Default)]
pub struct Gids<'a> {
    lists: [&'a [BigEndian<u16>]; 3],
}

impl<'a> Gids<'a> {
    pub(super) fn new(lists: [&'a [BigEndian<u16>]; 3]) -> Self {
        Self { lists }
    }
}

impl Iterator for Gids<'_> {
    type Item = u16;

    fn next(&mut self) -> Option<u16> {
        let waiting = self.lists.iter_mut().filter(|list| !list.is_empty());
        let list = waiting.min_by_key(|list| list.first().map(|gid| gid.get()))?;
        let (first, rest) = list.split_first()?;
        *list = rest;
        Some(first.get())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.lists.iter().map(|list| list.len()).sum();
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
