//! The messages of composed glyphs.

use alloc::vec;
use alloc::vec::Vec;

use super::codec::{COMPOSED, raw};
use crate::error::Damage;
use crate::model::compose::Part;
use crate::table::context_model::{ContextModel, class};
use crate::table::damage::{malformed, malformed_end, too_large};
use crate::table::elements::{ADVANCE, ADVANCES, MESSAGE, PART, PART_LIST, UNUSUAL};
use crate::table::header::MAX_PARTS;
use crate::table::priors::OUTLINE_PRIOR;
use crate::table::range::{Coder, Decoder, Encoder};

/// A part as it is stored: the glyph, its offset in font units, and its lists of grid offsets: 0 for none, else the list's
/// number plus 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StoredPart {
    /// The glyph.
    pub gid: u16,
    /// The offset along x and y, in font units.
    pub offset: [i16; 2],
    /// The lists of grid offsets along x and y.
    pub lists: [u16; 2],
}

/// What is known of a composed glyph before its message is read.
#[derive(Clone, Copy)]
pub struct KnownGlyph<'a> {
    /// Its parts in `glyf`, without lists, if it has some there.
    pub parts: Option<&'a [StoredPart]>,
    /// The advance width in font units.
    pub advance: u16,
    /// The [hash](crate::model::outline::OutlinePoints::hash) of its outline; none if it cannot be read.
    pub outline_hash: &'a dyn Fn() -> Option<u16>,
}

/// The context of [`UNUSUAL`] for parts that are not those of `glyf`.
const OTHER_PARTS: usize = 2;

/// The hinted advance widths of a composed glyph, in whole pixels less the scaled one, rounded.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Advances {
    /// 0 at all sizes.
    #[default]
    Rounded,
    /// Those of the first part.
    OfFirstPart,
    /// Of its own, at all sizes.
    Own(Vec<i8>),
}

/// A composed glyph as it is stored.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StoredGlyph {
    /// Its parts.
    pub parts: Vec<StoredPart>,
    /// Its hinted advance widths.
    pub advances: Advances,
}

/// Encodes a composed glyph.
///
/// # Errors
///
/// `TooLarge` for more parts than the format allows; `Stale` for an outline that cannot be read.
pub fn encode_parts(glyph: &StoredGlyph, known: &KnownGlyph<'_>) -> Result<Vec<u8>, Damage> {
    let mut model = ContextModel::new(Encoder::new(), &OUTLINE_PRIOR);
    let mut glyph = glyph.clone();
    code_parts(&mut model, &mut glyph.parts, known)?;
    code_advances(&mut model, &mut glyph.advances, 0);
    Ok(model.coder.finish())
}

/// Decodes a composed glyph.
///
/// # Errors
///
/// `Stale` if its outline or its parts are not those that it was composed of; `Malformed` or `TooLarge`.
pub fn decode_parts(bytes: &[u8], known: &KnownGlyph<'_>, sizes: usize) -> Result<StoredGlyph, Damage> {
    let mut model = ContextModel::new(Decoder::new(bytes), &OUTLINE_PRIOR);
    let mut glyph = StoredGlyph::default();
    code_parts(&mut model, &mut glyph.parts, known)?;
    code_advances(&mut model, &mut glyph.advances, sizes);
    model.coder.finish().map_err(malformed_end)?;
    Ok(glyph)
}

/// Codes the advance widths of a composed glyph; a reader is told the number of sizes.
pub fn code_advances<C: Coder>(model: &mut ContextModel<'_, C>, advances: &mut Advances, sizes: usize) {
    let kind = match advances {
        Advances::Rounded => 0,
        Advances::OfFirstPart => 1,
        Advances::Own(_) => 2,
    };
    *advances = match model.bits(ADVANCES, 0, 2, kind) {
        0 => Advances::Rounded,
        1 => Advances::OfFirstPart,
        _ => {
            let mut list =
                if let Advances::Own(list) = advances { core::mem::take(list) } else { vec![0; sizes] };
            let mut before = [0i32; 2];
            for advance in &mut list {
                let context = 9 + class(before[0], [0, 1]) * 3 + class(before[1], [0, 1]);
                let step = model.signed(ADVANCE, [context, 0, 0], i32::from(*advance) - before[0]);
                *advance = before[0].wrapping_add(step) as i8;
                before = [(*advance).into(), before[0]];
            }
            Advances::Own(list)
        }
    };
}

/// Codes the parts of a glyph; a reader's are empty.
///
/// # Errors
///
/// As [`decode_parts`].
pub fn code_parts<C: Coder>(
    model: &mut ContextModel<'_, C>,
    parts: &mut Vec<StoredPart>,
    known: &KnownGlyph<'_>,
) -> Result<(), Damage> {
    if model.bits(MESSAGE, 0, 2, COMPOSED) != COMPOSED {
        return Err(malformed("is not that of a composed glyph"));
    }
    let plain = |part: &StoredPart| StoredPart { lists: [0; 2], ..*part };
    let is_other =
        C::WRITES && known.parts.is_none_or(|known| !parts.iter().map(plain).eq(known.iter().copied()));
    if model.flag(UNUSUAL, [OTHER_PARTS, 0, 0], is_other) {
        let count = model.signed(PART, [0; 3], parts.len() as i32);
        if !(0..=MAX_PARTS as i32).contains(&count) {
            return Err(too_large("parts", count, MAX_PARTS as i32));
        }
        let hash = (known.outline_hash)().ok_or(Damage::Stale)?;
        if raw(model, hash) != hash {
            return Err(Damage::Stale);
        }
        parts.resize(count as usize, StoredPart::default());
        for part in &mut *parts {
            part.gid = raw(model, part.gid);
            for (axis, offset) in part.offset.iter_mut().enumerate() {
                *offset = model.signed(PART, [1 + axis, 0, 0], (*offset).into()) as i16;
            }
        }
    } else {
        let parts_of_glyf = known.parts.ok_or(Damage::Stale)?;
        let hash = hash(parts_of_glyf, known.advance);
        if raw(model, hash) != hash {
            return Err(Damage::Stale);
        }
        if !C::WRITES {
            parts.extend(parts_of_glyf);
        }
    }
    for part in parts {
        for (axis, list) in part.lists.iter_mut().enumerate() {
            let number = model.positive(PART_LIST, [axis, 0, 0], u32::from(*list) + 1) - 1;
            *list = u16::try_from(number).map_err(|_| malformed("refers to no list of grid offsets"))?;
        }
    }
    model.check()
}

/// A hash of parts and of the advance width: FNV-1a of 32 bits, folded to 16.
fn hash(parts: &[StoredPart], advance: u16) -> u16 {
    let numbers = parts.iter().flat_map(|part| [part.gid, part.offset[0] as u16, part.offset[1] as u16]);
    let hash = numbers
        .chain([advance])
        .fold(0x811C_9DC5u32, |hash, number| (hash ^ u32::from(number)).wrapping_mul(0x0100_0193));
    (hash ^ hash >> 16) as u16
}

/// The parts of `glyf` as they are stored.
pub fn plain_parts(parts: &[Part]) -> Vec<StoredPart> {
    parts.iter().map(|part| StoredPart { gid: part.gid, offset: part.offset, lists: [0; 2] }).collect()
}
