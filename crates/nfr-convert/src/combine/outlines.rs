//! The outline models of one or several fonts of the same outlines, with only what they need of what models share.

use std::collections::BTreeMap;
use std::ops::Range;

use nfr::internals::Damage;
use nfr::internals::model::gridfit::Scale;
use nfr::internals::model::outline::{OutlinePoints, OutlineWeights};
use nfr::internals::table::BigEndian;
use nfr::internals::table::outline::{
    Known, Shared, Source, Sources, StoredGlyph, decode, decode_shared, encode,
};

use super::font::ConvertedFont;
use crate::error::Error;
use crate::outline::{FontGlyph, stored_outline};
use crate::writer::Messages;

/// A glyph's model, decoded.
enum Decoded {
    Own(Box<Own>),
    Composed(StoredGlyph),
}

struct Own {
    points: OutlinePoints,
    advance: u16,
    weights: OutlineWeights,
    sources: Sources,
}

/// Some glyphs of a font.
struct Part<'f> {
    font: &'f ConvertedFont<'f>,
    glyphs: BTreeMap<u16, Decoded>,
    numbers: Numbers,
}

/// The new numbers of the shared tracks along x and y and of the lists that the models of a font refer to, by the old ones.
#[derive(Default)]
struct Numbers {
    tracks: [BTreeMap<u16, u16>; 2],
    lists: BTreeMap<u16, u16>,
}

/// The messages of the outline models of some glyphs of each font.
///
/// # Errors
///
/// Those of a damaged model.
pub(super) fn messages(fonts: &[(&ConvertedFont<'_>, &[u16])]) -> Result<Messages, Error> {
    let parts = fonts.iter().map(|(font, gids)| {
        let glyphs = decode_all(font, gids)?;
        Ok(Part { font, numbers: Numbers::used_by(&glyphs), glyphs })
    });
    let mut parts = parts.collect::<Result<Vec<_>, Error>>()?;
    let mut messages = Messages::default();
    for axis in [0, 1] {
        messages.shared[axis] = number_tracks(&mut parts, axis)?;
    }
    messages.lists = number_lists(&mut parts)?;
    let levels = messages.shared.each_ref().map(|tracks| {
        tracks.iter().map(|(level, _)| BigEndian::from(*level)).collect::<Vec<BigEndian<i16>>>()
    });
    for part in parts {
        let scale = nfr::internals::scale(&part.font.font);
        let moves = |axis: usize, number: usize, sizes: Range<usize>, memory: &mut Vec<u16>| {
            let (level, message) = messages.shared[axis].get(number).ok_or(OUTSIDE)?;
            decode_shared(message, *level, scale, sizes, memory)
        };
        let shared = Shared { levels: [&levels[0], &levels[1]], moves: &moves };
        for (gid, model) in part.glyphs {
            let message = match model {
                Decoded::Own(own) => own.encode(&part.numbers, scale, shared)?,
                Decoded::Composed(glyph) => {
                    let file = &part.font.file;
                    FontGlyph::read(file, &part.font.copy, gid).encode(&part.numbers.of_parts(glyph))?
                }
            };
            messages.glyphs.insert(gid, message);
        }
    }
    Ok(messages)
}

const OUTSIDE: Damage = Damage::Malformed("refers to something outside the table");

fn decode_all(font: &ConvertedFont<'_>, gids: &[u16]) -> Result<BTreeMap<u16, Decoded>, Error> {
    let (table, scale) = (font.table()?, nfr::internals::scale(&font.font));
    let index = *table.outlines();
    let moves = |axis: usize, number: usize, sizes: Range<usize>, memory: &mut Vec<u16>| {
        let level = index.levels()[axis].get(number).ok_or(OUTSIDE)?.get();
        decode_shared(index.shared(axis, number).ok_or(OUTSIDE)?, level, scale, sizes, memory)
    };
    let shared = Shared { levels: index.levels(), moves: &moves };
    let decode_glyph = |gid: u16| -> Result<Decoded, Error> {
        let (glyph, message) = (u32::from(gid), index.glyph(gid.into())?);
        let of_glyph = |damage: Damage| Error::from(damage.of(glyph));
        if table.is_composed(glyph) {
            let in_font = FontGlyph::read(&font.file, &font.copy, gid);
            return Ok(Decoded::Composed(in_font.decode(message, scale.sizes()).map_err(of_glyph)?));
        }
        let (points, advance) = stored_outline(&font.copy, gid)?;
        let known = Known { points: &points, advance, scale, shared };
        let (weights, sources) =
            decode(message, &known, 0..scale.sizes(), &mut Vec::new()).map_err(of_glyph)?;
        Ok(Decoded::Own(Box::new(Own { points, advance, weights, sources })))
    };
    gids.iter().map(|gid| Ok((*gid, decode_glyph(*gid)?))).collect()
}

/// Numbers the shared tracks of an axis that are used, by level, and those of the first font first. Two that are the same are one.
fn number_tracks(parts: &mut [Part<'_>], axis: usize) -> Result<Vec<(i16, Vec<u8>)>, Error> {
    let mut used = Vec::new();
    for (which, part) in parts.iter().enumerate() {
        let index = *part.font.table()?.outlines();
        for &old in part.numbers.tracks[axis].keys() {
            let level = index.levels()[axis].get(usize::from(old)).ok_or(OUTSIDE)?.get();
            used.push((level, which, old, index.shared(axis, old.into()).ok_or(OUTSIDE)?.to_vec()));
        }
    }
    used.sort_by_key(|(level, which, old, _)| (*level, *which, *old));
    let (mut tracks, mut known) = (Vec::new(), BTreeMap::new());
    for (level, which, old, message) in used {
        let new = *known.entry((level, message.clone())).or_insert_with(|| {
            tracks.push((level, message));
            tracks.len() - 1
        });
        parts[which].numbers.tracks[axis].insert(old, new as u16);
    }
    Ok(tracks)
}

/// Numbers the lists of grid offsets that are used.
fn number_lists(parts: &mut [Part<'_>]) -> Result<Vec<Vec<u8>>, Error> {
    let (mut lists, mut known) = (Vec::new(), BTreeMap::new());
    for part in parts {
        let index = *part.font.table()?.outlines();
        for (old, number) in &mut part.numbers.lists {
            let message = index.list((*old).into()).ok_or(OUTSIDE)?.to_vec();
            let new = *known.entry(message.clone()).or_insert_with(|| {
                lists.push(message);
                lists.len() - 1
            });
            *number = new as u16;
        }
    }
    Ok(lists)
}

impl Numbers {
    fn used_by(glyphs: &BTreeMap<u16, Decoded>) -> Self {
        let mut numbers = Self::default();
        for model in glyphs.values() {
            match model {
                Decoded::Own(own) => {
                    for (tracks, sources) in numbers.tracks.iter_mut().zip(&own.sources) {
                        for source in sources {
                            if let Source::Same(number) | Source::Near(number) = source {
                                tracks.insert(*number, 0);
                            }
                        }
                    }
                }
                Decoded::Composed(glyph) => {
                    let lists = glyph.parts.iter().flat_map(|part| part.lists);
                    numbers.lists.extend(lists.filter_map(|list| Some((list.checked_sub(1)?, 0))));
                }
            }
        }
        numbers
    }

    fn of_parts(&self, mut glyph: StoredGlyph) -> StoredGlyph {
        for list in glyph.parts.iter_mut().flat_map(|part| &mut part.lists) {
            let new = list.checked_sub(1).and_then(|old| self.lists.get(&old));
            *list = new.map_or(0, |new| new + 1);
        }
        glyph
    }
}

impl Own {
    fn encode(mut self, numbers: &Numbers, scale: Scale, shared: Shared<'_>) -> Result<Vec<u8>, Error> {
        for (tracks, sources) in numbers.tracks.iter().zip(&mut self.sources) {
            for source in sources {
                if let Source::Same(number) | Source::Near(number) = source {
                    *number = tracks.get(number).copied().unwrap_or(*number);
                }
            }
        }
        let known = Known { points: &self.points, advance: self.advance, scale, shared };
        Ok(encode(&known, &mut self.weights, &self.sources, &mut |question| question.wanted.into())?)
    }
}
