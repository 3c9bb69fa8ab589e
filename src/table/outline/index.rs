//! The part of the table about outline models: which glyphs have one, and where its message is.

use alloc::vec::Vec;

use read_fonts::FontData;
use read_fonts::types::BigEndian;

use crate::error::Error;
use crate::table::gids::outside;
use crate::table::header::BLOCK;

/// The 16-bit numbers of a range of glyphs: the first, the last, and the index of the first.
const RANGE_NUMBERS: usize = 3;
/// The bit of a block's offset that says that its lengths take two bytes each.
const WIDE: u32 = 1 << 31;

/// The outline models of a table. Messages are numbered: those of glyphs first, then those of the shared tracks along x and
/// y, then lists of grid offsets.
#[derive(Debug, Clone, Copy, Default)]
pub struct OutlineIndex<'a> {
    /// Ranges of glyphs, ascending.
    ranges: &'a [BigEndian<u16>],
    glyphs: usize,
    levels: [&'a [BigEndian<i16>]; 2],
    lists: usize,
    /// Where each block of [`BLOCK`] messages begins in the payload: with their lengths.
    blocks: &'a [BigEndian<u32>],
    payload: &'a [u8],
}

fn truncated(offset: usize) -> Error {
    Error::MalformedModels { what: "ends before its outline models", offset }
}

impl<'a> OutlineIndex<'a> {
    /// Finds the arrays, which begin with their counts at `at`, and the offset behind them.
    pub(in crate::table) fn parse(data: FontData<'a>, at: usize) -> Result<(Self, usize), Error> {
        let count = |k: usize| data.read_at::<u16>(at + 2 * k).map(usize::from).map_err(|_| truncated(at));
        let [ranges, x, y, lists] = [count(0)?, count(1)?, count(2)?, count(3)?];
        let payload_len = data.read_at::<u32>(at + 8).map_err(|_| truncated(at))? as usize;
        let ranges_at = at + 12;
        let x_at = ranges_at + 2 * RANGE_NUMBERS * ranges;
        let y_at = x_at + 2 * x;
        let blocks_at = y_at + 2 * y;
        let ranges = data.read_array::<BigEndian<u16>>(ranges_at..x_at).map_err(|_| truncated(ranges_at))?;
        let glyphs = check_ranges(ranges, ranges_at)?;
        let payload_at = blocks_at + 4 * (glyphs + x + y + lists).div_ceil(BLOCK);
        let end = payload_at.checked_add(payload_len).ok_or_else(|| truncated(payload_at))?;
        let index = Self {
            ranges,
            glyphs,
            levels: [
                data.read_array(x_at..y_at).map_err(|_| truncated(x_at))?,
                data.read_array(y_at..blocks_at).map_err(|_| truncated(y_at))?,
            ],
            lists,
            blocks: data.read_array(blocks_at..payload_at).map_err(|_| truncated(blocks_at))?,
            payload: data.as_bytes().get(payload_at..end).ok_or_else(|| truncated(payload_at))?,
        };
        Ok((index, end))
    }

    /// The number of glyphs.
    pub fn len(&self) -> usize {
        self.glyphs
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.glyphs == 0
    }

    /// The levels of the shared tracks along x and y, ascending.
    pub fn levels(&self) -> [&'a [BigEndian<i16>]; 2] {
        self.levels
    }

    /// The number of lists of grid offsets.
    pub fn lists(&self) -> usize {
        self.lists
    }

    /// Ranges of glyphs: the first and the last of each.
    pub(in crate::table) fn ranges(&self) -> &'a [BigEndian<u16>] {
        self.ranges
    }

    /// The index of a glyph.
    pub fn find(&self, gid: u32) -> Option<usize> {
        let (mut low, mut high) = (0, self.ranges.len() / RANGE_NUMBERS);
        while low < high {
            let middle = (low + high) / 2;
            let [first, last, index] =
                [0, 1, 2].map(|k| u32::from(self.ranges[middle * RANGE_NUMBERS + k].get()));
            if gid < first {
                high = middle;
            } else if gid > last {
                low = middle + 1;
            } else {
                return Some((index + gid - first) as usize);
            }
        }
        None
    }

    /// A message, by its number; `None` if it lies outside the table.
    pub fn message(&self, number: usize) -> Option<&'a [u8]> {
        let begin = self.blocks.get(number / BLOCK)?.get();
        let width = if begin & WIDE != 0 { 2 } else { 1 };
        let messages = self.glyphs + self.levels[0].len() + self.levels[1].len() + self.lists;
        let first = number / BLOCK * BLOCK;
        let block = self.payload.get((begin & !WIDE) as usize..)?;
        let (lengths, messages) = block.split_at_checked((messages - first).min(BLOCK) * width)?;
        let length = |bytes: &[u8]| bytes.iter().fold(0, |length, byte| length << 8 | usize::from(*byte));
        let (before, rest) = lengths.split_at_checked((number - first) * width)?;
        let start = match width {
            1 => before.iter().map(|length| usize::from(*length)).sum(),
            _ => before.chunks_exact(width).map(length).sum::<usize>(),
        };
        messages.get(start..start + length(rest.get(..width)?))
    }

    /// The message of a glyph.
    ///
    /// # Errors
    ///
    /// `MissingModel`, or `MalformedModel` for an entry that points nowhere.
    pub fn glyph(&self, gid: u32) -> Result<&'a [u8], Error> {
        self.message(self.find(gid).ok_or(Error::MissingModel(gid))?).ok_or(outside(gid))
    }

    /// The message of a shared track, by its axis and its number.
    pub fn shared(&self, axis: usize, number: usize) -> Option<&'a [u8]> {
        if number >= self.levels[axis].len() {
            return None;
        }
        let before = if axis == 0 { 0 } else { self.levels[0].len() };
        self.message(self.glyphs + before + number)
    }

    /// The message of a list of grid offsets.
    pub fn list(&self, number: usize) -> Option<&'a [u8]> {
        if number >= self.lists {
            return None;
        }
        self.message(self.glyphs + self.levels[0].len() + self.levels[1].len() + number)
    }
}

/// Checks that ranges ascend and number their glyphs one after the other. Returns the number of glyphs.
fn check_ranges(ranges: &[BigEndian<u16>], at: usize) -> Result<usize, Error> {
    let (mut glyphs, mut next) = (0usize, 0u32);
    for range in ranges.chunks_exact(RANGE_NUMBERS) {
        let [first, last, index] = [0, 1, 2].map(|k| u32::from(range[k].get()));
        if first < next || last < first || index as usize != glyphs {
            return Err(Error::MalformedModels { what: "lists glyphs out of order", offset: at });
        }
        glyphs += (last - first) as usize + 1;
        next = last + 1;
    }
    Ok(glyphs)
}

/// Packs messages into blocks: where each begins, and the payload.
pub fn pack(messages: &[impl AsRef<[u8]>]) -> Option<(Vec<u32>, Vec<u8>)> {
    let (mut blocks, mut payload) = (Vec::new(), Vec::<u8>::new());
    for block in messages.chunks(BLOCK) {
        let lengths = block.iter().map(|message| u16::try_from(message.as_ref().len()));
        let lengths = lengths.collect::<Result<Vec<_>, _>>().ok()?;
        let is_wide = lengths.iter().any(|length| *length > u8::MAX.into());
        let begin = u32::try_from(payload.len()).ok().filter(|begin| begin & WIDE == 0)?;
        blocks.push(begin | if is_wide { WIDE } else { 0 });
        for length in lengths {
            payload.extend(&length.to_be_bytes()[usize::from(!is_wide)..]);
        }
        block.iter().for_each(|message| payload.extend(message.as_ref()));
    }
    Some((blocks, payload))
}
