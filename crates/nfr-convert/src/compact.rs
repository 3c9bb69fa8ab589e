//! A converted font of which glyphs were taken out, with only what the others need of what models share.

use std::collections::BTreeMap;

use nfr::Font;
use nfr::internals::model::outline::{OutlinePoints, OutlineWeights};
use nfr::internals::table::outline::{
    Known, OutlineIndex, Shared, Source, Sources, StoredGlyph, decode, decode_parts, decode_shared, encode,
    encode_parts, plain_parts,
};
use nfr::internals::table::{BigEndian, HEADER_LEN, TAG};
use nfr::internals::{Damage, components};
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;

use crate::error::Error;
use crate::input::open::{open, owned};
use crate::outline::stored_outline;
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

/// Writes a font again without the shared tracks and lists of grid offsets that none of its models refers to. A font that has
/// other models than those of outlines comes back as it is.
///
/// # Errors
///
/// Those of opening the font, and of a damaged model.
pub fn compact(data: &[u8]) -> Result<Vec<u8>, Error> {
    let (file, font) = (open(data, 0)?, Font::new(data.to_vec())?);
    let table = nfr::internals::table(&font)?;
    let gids: Vec<u16> = table.gids().collect();
    let index = *table.outlines();
    if index.is_empty() || gids.len() != index.len() {
        return Ok(data.to_vec());
    }
    let decoded = decode_all(&file, &font, &index, &gids)?;
    let numbers = Numbers::used_by(&decoded);
    let mut bytes = file.table_data(TAG).map_or(Vec::new(), |table| table.as_bytes()[..HEADER_LEN].to_vec());
    encode_all(&file, &font, &index, decoded, &numbers)?.write(&mut bytes)?;
    let mut builder = FontBuilder::new();
    builder.add_raw(TAG, bytes).copy_missing_tables(file);
    Ok(builder.build())
}

/// The moves of a shared track.
fn moves(
    index: &OutlineIndex<'_>,
    font: &Font,
    axis: usize,
    number: usize,
    sizes: std::ops::Range<usize>,
) -> Result<Vec<i16>, Damage> {
    let outside = Damage::Malformed("has a track outside the table");
    let level = index.levels()[axis].get(number).ok_or(outside)?.get();
    let message = index.shared(axis, number).ok_or(outside)?;
    decode_shared(message, level, nfr::internals::scale(font), sizes, &mut Vec::new())
}

fn decode_all(
    file: &FontRef<'_>,
    font: &Font,
    index: &OutlineIndex<'_>,
    gids: &[u16],
) -> Result<BTreeMap<u16, Decoded>, Error> {
    let (table, scale, outlines) = (nfr::internals::table(font)?, nfr::internals::scale(font), owned(file)?);
    let shared_moves = |axis: usize, number: usize, sizes| moves(index, font, axis, number, sizes);
    let shared = Shared { levels: index.levels(), moves: &shared_moves };
    let mut decoded = BTreeMap::new();
    for gid in gids {
        let (glyph, message) = (u32::from(*gid), index.glyph((*gid).into())?);
        let of_glyph = |damage: Damage| Error::from(damage.of(glyph));
        let model = if table.is_composed(glyph) {
            let known = parts_of(file, *gid);
            Decoded::Composed(decode_parts(message, known.as_deref(), scale.sizes()).map_err(of_glyph)?)
        } else {
            let (points, advance) = stored_outline(&outlines, *gid)?;
            let known = Known { points: &points, advance, scale, shared };
            let (weights, sources) =
                decode(message, &known, 0..scale.sizes(), &mut Vec::new()).map_err(of_glyph)?;
            Decoded::Own(Box::new(Own { points, advance, weights, sources }))
        };
        decoded.insert(*gid, model);
    }
    Ok(decoded)
}

fn parts_of(file: &FontRef<'_>, gid: u16) -> Option<Vec<nfr::internals::table::outline::StoredPart>> {
    Some(plain_parts(&components(&file.loca(None).ok()?, &file.glyf().ok()?, gid.into())?))
}

/// New numbers of the shared tracks along x and y and of the lists that models refer to, by the old ones.
#[derive(Default)]
struct Numbers {
    tracks: [BTreeMap<u16, u16>; 2],
    lists: BTreeMap<u16, u16>,
}

impl Numbers {
    fn used_by(decoded: &BTreeMap<u16, Decoded>) -> Self {
        let mut numbers = Self::default();
        for model in decoded.values() {
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
        for used in numbers.tracks.iter_mut().chain([&mut numbers.lists]) {
            (0..).zip(used.values_mut()).for_each(|(new, number)| *number = new);
        }
        numbers
    }
}

fn encode_all(
    file: &FontRef<'_>,
    font: &Font,
    index: &OutlineIndex<'_>,
    decoded: BTreeMap<u16, Decoded>,
    numbers: &Numbers,
) -> Result<Messages, Error> {
    let scale = nfr::internals::scale(font);
    let outside = || Error::from(Damage::Malformed("refers to something outside the table"));
    let mut messages = Messages::default();
    for axis in [0, 1] {
        for old in numbers.tracks[axis].keys().map(|old| usize::from(*old)) {
            let level = index.levels()[axis].get(old).ok_or_else(outside)?.get();
            let message = index.shared(axis, old).ok_or_else(outside)?;
            messages.shared[axis].push((level, message.to_vec()));
        }
    }
    for old in numbers.lists.keys() {
        messages.lists.push(index.list((*old).into()).ok_or_else(outside)?.to_vec());
    }
    let levels = messages.shared.each_ref().map(|tracks| {
        tracks.iter().map(|(level, _)| BigEndian::from(*level)).collect::<Vec<BigEndian<i16>>>()
    });
    let old_numbers = numbers.tracks.each_ref().map(|tracks| tracks.keys().copied().collect::<Vec<u16>>());
    let shared_moves =
        |axis: usize, number: usize, sizes| moves(index, font, axis, old_numbers[axis][number].into(), sizes);
    let shared = Shared { levels: [&levels[0], &levels[1]], moves: &shared_moves };
    for (gid, model) in decoded {
        let message = match model {
            Decoded::Own(own) => {
                let Own { points, advance, mut weights, mut sources } = *own;
                for (tracks, sources) in numbers.tracks.iter().zip(&mut sources) {
                    for source in sources {
                        if let Source::Same(number) | Source::Near(number) = source {
                            *number = tracks.get(number).copied().unwrap_or(*number);
                        }
                    }
                }
                let known = Known { points: &points, advance, scale, shared };
                encode(&known, &mut weights, &sources, &mut |question| question.wanted.into())?
            }
            Decoded::Composed(mut glyph) => {
                for list in glyph.parts.iter_mut().flat_map(|part| &mut part.lists) {
                    let new = list.checked_sub(1).and_then(|old| numbers.lists.get(&old));
                    *list = new.map_or(0, |new| new + 1);
                }
                encode_parts(&glyph, parts_of(file, gid).as_deref())?
            }
        };
        messages.glyphs.insert(gid, message);
    }
    Ok(messages)
}
