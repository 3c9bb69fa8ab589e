//! The part of the table about networks: which glyphs have one, and where it is.

use read_fonts::FontData;
use read_fonts::types::BigEndian;

use super::gids::{find, outside};
use crate::error::Error;

/// The networks of a table.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NetworkIndex<'a> {
    gids: &'a [BigEndian<u16>],
    /// Where each network ends in the payload.
    ends: &'a [BigEndian<u32>],
    payload: &'a [u8],
}

fn truncated(offset: usize) -> Error {
    Error::MalformedModels { what: "ends before its networks", offset }
}

impl<'a> NetworkIndex<'a> {
    /// Finds the arrays, which begin with their count at `at`. Says where they end, too.
    pub(super) fn parse(data: FontData<'a>, at: usize) -> Result<(Self, usize), Error> {
        let count = usize::from(data.read_at::<u16>(at).map_err(|_| truncated(at))?);
        let after = |at: usize, length: usize| at.checked_add(length).ok_or_else(|| truncated(at));
        let gids_at = after(at, 2)?;
        let ends_at = after(gids_at, 2 * count)?;
        let payload_at = after(ends_at, 4 * count)?;
        let ends: &[BigEndian<u32>] = data.read_array(ends_at..payload_at).map_err(|_| truncated(ends_at))?;
        let end = after(payload_at, ends.last().map_or(0, |end| end.get() as usize))?;
        let index = Self {
            gids: data.read_array(gids_at..ends_at).map_err(|_| truncated(gids_at))?,
            ends,
            payload: data.as_bytes().get(payload_at..end).ok_or_else(|| truncated(payload_at))?,
        };
        Ok((index, end))
    }

    pub(super) fn gids(&self) -> &'a [BigEndian<u16>] {
        self.gids
    }

    pub(super) fn find(&self, gid: u32) -> Option<usize> {
        find(self.gids, gid)
    }

    /// A network's bytes.
    pub(super) fn packed(&self, index: usize) -> Result<&'a [u8], Error> {
        let start = if index == 0 { 0 } else { self.ends[index - 1].get() as usize };
        self.payload
            .get(start..self.ends[index].get() as usize)
            .ok_or_else(|| outside(self.gids[index].get().into()))
    }
}
