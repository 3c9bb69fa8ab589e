//! Which glyphs a table has, whatever they are drawn from.

use read_fonts::types::BigEndian;

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
