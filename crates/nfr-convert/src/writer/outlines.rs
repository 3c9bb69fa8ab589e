//! Writing outline models.

use std::collections::{BTreeMap, HashMap};

use nfr::internals::model::compose::{Composed, Part};
use nfr::internals::model::gridfit::Scale;
use nfr::internals::table::outline::{Advances, StoredGlyph, StoredPart, encode_list, pack};
use nfr::internals::table::{Header, OUTLINE_MODELS};

use super::{GlyphModel, flags_mut, write, write_header};
use crate::error::Error;
use crate::outline::{EncodedOutlines, FontGlyph};

/// The outline models of a font, and the fields of glyphs that cannot have one.
pub(crate) struct OutlineTable<'t> {
    /// The glyphs that have hints, ascending.
    pub(crate) gids: &'t [u16],
    /// Their messages, and those of what they share.
    pub(crate) encoded: &'t EncodedOutlines,
    /// Composed glyphs, ascending, with their hinted advance widths.
    pub(crate) composed: &'t [(Composed, Advances)],
    /// Fields of other glyphs, ascending.
    pub(crate) fields: &'t [GlyphModel],
    /// The sizes of the models.
    pub(crate) scale: Scale,
}

/// Writes a table of outline models and fields. `in_font` gives what the font has for a composed glyph.
pub(crate) fn write_outlines(
    header: &Header,
    table: &OutlineTable<'_>,
    in_font: impl Fn(u16) -> FontGlyph,
) -> Result<Vec<u8>, Error> {
    let lists = GridOffsetLists::of(table.composed);
    let mut glyphs: BTreeMap<u16, Vec<u8>> =
        table.gids.iter().copied().zip(table.encoded.glyphs.iter().cloned()).collect();
    for (glyph, advances) in table.composed {
        let parts = glyph.parts.iter().map(|part| lists.stored(part)).collect();
        let stored = StoredGlyph { parts, advances: advances.clone() };
        glyphs.insert(glyph.gid, in_font(glyph.gid).encode(&stored)?);
    }
    let mut out = if table.fields.is_empty() {
        write_header(header)
    } else {
        write(header, table.fields, &[], &[], table.scale)?.0
    };
    *flags_mut(&mut out) |= OUTLINE_MODELS;
    let messages = Messages { glyphs, shared: table.encoded.shared.clone(), lists: lists.messages };
    messages.write(&mut out)?;
    Ok(out)
}

/// The messages of outline models.
#[derive(Debug, Clone, Default)]
pub(crate) struct Messages {
    /// By glyph.
    pub(crate) glyphs: BTreeMap<u16, Vec<u8>>,
    /// Those of shared tracks along x and y, by ascending level, which stands beside each.
    pub(crate) shared: [Vec<(i16, Vec<u8>)>; 2],
    /// Lists of grid offsets.
    pub(crate) lists: Vec<Vec<u8>>,
}

impl Messages {
    /// Appends them to a table, with what finds them.
    pub(crate) fn write(&self, out: &mut Vec<u8>) -> Result<(), Error> {
        let Self { glyphs, shared, lists } = self;
        let messages: Vec<&[u8]> = glyphs
            .values()
            .chain(shared.iter().flatten().map(|(_, message)| message))
            .chain(lists)
            .map(Vec::as_slice)
            .collect();
        let too_large =
            || Error::LimitExceeded("outline models that are too large to store; convert fewer sizes".into());
        let (blocks, payload) = pack(&messages).ok_or_else(too_large)?;
        let ranges = ranges(glyphs.keys().copied());
        for count in [ranges.len(), shared[0].len(), shared[1].len(), lists.len()] {
            out.extend(u16::try_from(count).map_err(|_| too_large())?.to_be_bytes());
        }
        out.extend((payload.len() as u32).to_be_bytes());
        out.extend(ranges.into_iter().flatten().flat_map(u16::to_be_bytes));
        out.extend(shared.iter().flatten().flat_map(|(level, _)| level.to_be_bytes()));
        out.extend(blocks.into_iter().flat_map(u32::to_be_bytes));
        out.extend(payload);
        Ok(())
    }
}

/// Ranges of ascending glyphs: the first, the last, and how many are before it.
fn ranges(gids: impl Iterator<Item = u16>) -> Vec<[u16; 3]> {
    let mut ranges: Vec<[u16; 3]> = Vec::new();
    for (index, gid) in gids.enumerate() {
        match ranges.last_mut() {
            Some([_, last, _]) if *last + 1 == gid => *last = gid,
            _ => ranges.push([gid, gid, index as u16]),
        }
    }
    ranges
}

/// The lists of grid offsets of all composed glyphs, the most used first.
struct GridOffsetLists<'c> {
    numbers: HashMap<&'c [i8], u16>,
    messages: Vec<Vec<u8>>,
}

impl<'c> GridOffsetLists<'c> {
    fn of(composed: &'c [(Composed, Advances)]) -> Self {
        let mut uses: BTreeMap<&[i8], usize> = BTreeMap::new();
        for list in composed.iter().flat_map(|(glyph, _)| &glyph.parts).flat_map(|part| &part.grid_offsets) {
            if !list.is_empty() {
                *uses.entry(list).or_default() += 1;
            }
        }
        let mut lists: Vec<(&[i8], usize)> = uses.into_iter().collect();
        lists.sort_by(|(a, n), (b, m)| m.cmp(n).then(a.cmp(b)));
        let numbers = lists.iter().enumerate().map(|(number, (list, _))| (*list, number as u16)).collect();
        Self { numbers, messages: lists.iter().map(|(list, _)| encode_list(list)).collect() }
    }

    fn stored(&self, part: &'c Part) -> StoredPart {
        let lists =
            part.grid_offsets.each_ref().map(|list| self.numbers.get(list.as_slice()).map_or(0, |n| n + 1));
        StoredPart { gid: part.gid, offset: part.offset, lists }
    }
}
