//! Tables of models that are there already: written again with only what is needed, or put together.

mod font;
mod outlines;
mod sections;

use std::collections::BTreeSet;

use nfr::internals::table::{HEADER_LEN, OUTLINE_MODELS, TAG};
use write_fonts::FontBuilder;

use crate::assemble::assemble;
use crate::compare::fonts::{FontPair, hinter_of};
use crate::error::Error;
use crate::writer::{flags_mut, write_certificate, write_dropout};
use font::ConvertedFont;
use sections::{Errors, Texts, dropout, errors, fields};

/// Writes a font again without the shared tracks and lists of grid offsets that none of its models refers to. A font that has
/// other models than those of outlines comes back as it is.
///
/// # Errors
///
/// Those of opening the font, and of a damaged model.
pub fn compact(data: &[u8]) -> Result<Vec<u8>, Error> {
    let font = ConvertedFont::open(data)?;
    let (table, gids) = (font.table()?, font.outline_gids()?);
    if gids.is_empty() || gids.len() != table.gids().len() {
        return Ok(data.to_vec());
    }
    let mut bytes =
        font.file.table_data(TAG).map_or(Vec::new(), |table| table.as_bytes()[..HEADER_LEN].to_vec());
    outlines::messages(&[(&font, &gids)])?.write(&mut bytes)?;
    if let Some(certificate) = table.certificate() {
        write_certificate(&mut bytes, &certificate, certificate.errors());
    }
    if let Some(modes) = table.dropout() {
        let exceptions: Vec<_> = modes.exceptions().collect();
        write_dropout(&mut bytes, &modes.ranges().collect::<Vec<_>>(), &exceptions);
    }
    let mut builder = FontBuilder::new();
    builder.add_raw(TAG, bytes).copy_missing_tables(font.file);
    Ok(builder.build())
}

/// Puts the models of another conversion of the same font into a converted font. Where both have a glyph, that of `base` stays.
/// `original` is the hinted font, the one of this index in its file; its errors are measured for the glyphs that are added.
///
/// # Errors
///
/// `InvalidParameter` if the two were not converted for the same sizes, the same target and by the same hinter, from the same font; those of damaged
/// models.
pub fn merge(original: (&[u8], u32), base: &[u8], addition: &[u8], jobs: usize) -> Result<Vec<u8>, Error> {
    let (base, addition) = (ConvertedFont::open(base)?, ConvertedFont::open(addition)?);
    check_same_conversion(&base, &addition)?;
    let known: BTreeSet<u16> = base.table()?.gids().collect();
    let is_new = |gid: &u16| !known.contains(gid);
    let mut table = fields(&base, &addition, is_new)?;
    let gids = base.outline_gids()?;
    let added: Vec<u16> = addition.outline_gids()?.into_iter().filter(is_new).collect();
    if !gids.is_empty() || !added.is_empty() {
        *flags_mut(&mut table) |= OUTLINE_MODELS;
        outlines::messages(&[(&base, &gids), (&addition, &added)])?.write(&mut table)?;
    }
    let without_certificate = table.clone();
    let stated = errors(&base, &addition, is_new)?;
    let font = |errors: Option<&Errors>| -> Result<Vec<u8>, Error> {
        let mut table = without_certificate.clone();
        if let Some(errors) = errors {
            let texts = Texts::of(base.table()?.certificate(), addition.table()?.certificate());
            write_certificate(&mut table, &texts.certificate(), errors.values().copied());
        }
        if let Some((ranges, exceptions)) = dropout(&base, &addition, is_new)? {
            write_dropout(&mut table, &ranges, &exceptions);
        }
        let dropped = match base.font.outlines_dropped() {
            true => addition.table()?.gids().filter(is_new).collect(),
            false => BTreeSet::new(),
        };
        assemble(&base.file, &table, &dropped)
    };
    let merged = font(stated.as_ref())?;
    let Some(mut errors) = stated else { return Ok(merged) };
    // A composed glyph that was added may have parts of the font that was there.
    let pair = FontPair::open(original.0, original.1, &merged)?;
    let added: Vec<u16> = addition.table()?.gids().filter(is_new).collect();
    let check = pair.check_certificate(&added, jobs)?;
    let exceeded = check.map_or(Vec::new(), |check| check.exceeded);
    if exceeded.is_empty() {
        return Ok(merged);
    }
    errors.extend(exceeded.into_iter().map(|glyph| (glyph.gid, glyph.measured.into())));
    font(Some(&errors))
}

fn check_same_conversion(base: &ConvertedFont<'_>, addition: &ConvertedFont<'_>) -> Result<(), Error> {
    let [a, b] = [base, addition].map(|font| nfr::internals::header(&font.font));
    let are_same = a.outline_hash == b.outline_hash
        && (a.target, a.first_ppem, a.last_ppem) == (b.target, b.first_ppem, b.last_ppem)
        && (a.outlines_dropped, a.origin) == (b.outlines_dropped, b.origin)
        && hinter_of(&base.font)? == hinter_of(&addition.font)?
        && base.font.glyph_count() == addition.font.glyph_count();
    if are_same {
        return Ok(());
    }
    Err(Error::InvalidParameter(
        "the two fonts are not conversions of the same font for the same sizes, target and hinter; convert it with the options of the \
         first"
            .into(),
    ))
}
