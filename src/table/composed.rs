//! The part of the table about composed glyphs: which they are, and the parts of each.
//!
//! Parts refer to models by their position in the table, so that a part can be nothing but a glyph with a model
//! of its own.

use alloc::vec::Vec;

use read_fonts::FontData;
use read_fonts::types::BigEndian;

use super::gids::{find, outside};
use super::header::MAX_PARTS;
use crate::error::Error;
use crate::model::compose::Part;

/// The 16-bit numbers of a part: model, offset in x and y, lists of grid offsets in x and y.
pub const PART_NUMBERS: usize = 5;
/// Stands for no list: the part is not rounded to the pixel grid.
pub const NO_GRID_OFFSETS: u16 = u16::MAX;
/// The numbers of composed glyphs, of lists of grid offsets and of parts, and the length of the packed lists.
pub const COUNTS_AT: usize = 40;

/// The composed glyphs of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct ComposedGlyphs<'a> {
    gids: &'a [BigEndian<u16>],
    /// Where each glyph's parts end.
    ends: &'a [BigEndian<u32>],
    parts: &'a [BigEndian<u16>],
    grid_offset_count: u16,
    grid_offsets: &'a [u8],
}

fn truncated(offset: usize) -> Error {
    Error::MalformedModels { what: "ends before its composed glyphs", offset }
}

impl<'a> ComposedGlyphs<'a> {
    /// Finds the arrays, which begin at `at`. Says where they end, too.
    pub(super) fn parse(data: FontData<'a>, at: usize) -> Result<(Self, usize), Error> {
        let u16_at = |at| data.read_at::<u16>(at).map_err(|_| truncated(at));
        let u32_at = |at| data.read_at::<u32>(at).map_err(|_| truncated(at));
        let count = usize::from(u16_at(COUNTS_AT)?);
        let grid_offset_count = u16_at(COUNTS_AT + 2)?;
        let (part_count, offset_bytes) = (u32_at(COUNTS_AT + 4)? as usize, u32_at(COUNTS_AT + 8)? as usize);
        let after = |at: usize, count: usize, size: usize| {
            count.checked_mul(size).and_then(|length| at.checked_add(length)).ok_or_else(|| truncated(at))
        };
        let ends_at = after(at, count, 2)?;
        let parts_at = after(ends_at, count, 4)?;
        let offsets_at = after(parts_at, part_count, 2 * PART_NUMBERS)?;
        let end = after(offsets_at, offset_bytes, 1)?;
        let composed = Self {
            gids: data.read_array(at..ends_at).map_err(|_| truncated(at))?,
            ends: data.read_array(ends_at..parts_at).map_err(|_| truncated(ends_at))?,
            parts: data.read_array(parts_at..offsets_at).map_err(|_| truncated(parts_at))?,
            grid_offset_count,
            grid_offsets: data.as_bytes().get(offsets_at..end).ok_or_else(|| truncated(offsets_at))?,
        };
        Ok((composed, end))
    }

    pub(super) fn gids(&self) -> &'a [BigEndian<u16>] {
        self.gids
    }

    /// The number of lists of grid offsets.
    pub(super) fn grid_offset_count(&self) -> usize {
        self.grid_offset_count.into()
    }

    pub(super) fn packed_grid_offsets(&self) -> &'a [u8] {
        self.grid_offsets
    }

    pub(super) fn find(&self, gid: u32) -> Option<usize> {
        find(self.gids, gid)
    }

    /// The numbers of a glyph's parts.
    fn numbers(&self, index: usize) -> Result<&'a [BigEndian<u16>], Error> {
        let gid = self.gids[index].get().into();
        let start = if index == 0 { 0 } else { self.ends[index - 1].get() as usize };
        let range = start.saturating_mul(PART_NUMBERS)
            ..(self.ends[index].get() as usize).saturating_mul(PART_NUMBERS);
        let numbers = self.parts.get(range).ok_or(outside(gid))?;
        if numbers.len() > MAX_PARTS * PART_NUMBERS {
            let (count, limit) = ((numbers.len() / PART_NUMBERS) as u64, MAX_PARTS as u64);
            return Err(Error::ModelTooLarge { glyph: gid, what: "parts", count, limit });
        }
        Ok(numbers)
    }

    /// The bytes of a glyph's entry.
    pub(super) fn len_of(&self, index: usize) -> Result<usize, Error> {
        Ok(size_of::<u16>() + size_of::<u32>() + size_of_val(self.numbers(index)?))
    }

    /// A glyph's parts. `models` are the glyphs that have models, `grid_offsets` the lists of grid offsets one after the
    /// other, each of `sizes` values.
    pub(super) fn parts(
        &self,
        gid: u32,
        models: &[BigEndian<u16>],
        grid_offsets: &[i8],
        sizes: usize,
    ) -> Result<Vec<Part>, Error> {
        let numbers = self.numbers(self.find(gid).ok_or(Error::MissingModel(gid))?)?;
        let dangling = |what: &'static str| Error::MalformedModel { glyph: gid, what };
        let list = |at: u16| match at {
            NO_GRID_OFFSETS => Ok(Vec::new()),
            at => {
                let start = usize::from(at) * sizes;
                grid_offsets
                    .get(start..start + sizes)
                    .map(<[i8]>::to_vec)
                    .ok_or_else(|| dangling("has a part without offsets"))
            }
        };
        numbers
            .chunks_exact(PART_NUMBERS)
            .map(|part| {
                let number = |k: usize| part[k].get();
                Ok(Part {
                    gid: models
                        .get(usize::from(number(0)))
                        .ok_or_else(|| dangling("has a part without a model"))?
                        .get(),
                    offset: [number(1) as i16, number(2) as i16],
                    grid_offsets: [list(number(3))?, list(number(4))?],
                })
            })
            .collect()
    }
}
