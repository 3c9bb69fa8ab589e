//! A font for LVGL 9 as a C file, in the layout of lv_font_conv: uncompressed bitmaps without padding, no kerning.

mod bitmaps;
mod cmaps;
mod source;

use std::collections::BTreeSet;

use bitmaps::Bitmaps;
use cmaps::{MAX_MAPS, maps};
use source::{File, write_file};

use super::face::Face;
use super::strike::{Glyph, Strike};
use crate::failure::Failure;

/// Bitmaps' offsets have 20 bits without `LV_FONT_FMT_TXT_LARGE`, advance widths 12, of which 4 are fractions.
const SMALL_BITMAPS: usize = 1 << 20;
const SMALL_ADVANCE: i32 = 1 << 8;
/// What the structures take where pointers have 32 bits: a glyph's, one's of a large font, a map's, and the font's two.
const GLYPH_BYTES: usize = 8;
const LARGE_GLYPH_BYTES: usize = 16;
const MAP_BYTES: usize = 24;
const FONT_BYTES: usize = 24 + 36;

/// A C file.
#[derive(Debug)]
pub(super) struct CFile {
    pub(super) text: String,
    pub(super) characters: usize,
    /// Glyphs that no character stands for, which LVGL cannot find.
    pub(super) left_out: usize,
    /// What the font takes in a device's memory, with pointers of 32 bits.
    pub(super) bytes: usize,
    /// Whether LVGL has to be built with `LV_FONT_FMT_TXT_LARGE`.
    pub(super) is_large: bool,
}

/// The name of the font's variable, made from a file's name without its extension.
pub(super) fn symbol(stem: &str) -> String {
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        name
    } else {
        format!("font_{name}")
    }
}

/// Writes a strike.
///
/// # Errors
///
/// No glyph that has a character, and more ranges of characters than a font of LVGL has.
pub(super) fn lvgl(strike: &Strike, face: &Face, symbol: &str) -> Result<CFile, Failure> {
    let glyph = |gid: &u16| {
        strike.glyphs.binary_search_by_key(gid, |glyph| glyph.gid).ok().map(|at| &strike.glyphs[at])
    };
    // LVGL takes U+0000 for the end of a text.
    let with = face.characters.iter().filter(|(code, _)| **code > 0);
    let glyphs: Vec<(u32, &Glyph)> = with.filter_map(|(code, gid)| Some((*code, glyph(gid)?))).collect();
    if glyphs.is_empty() {
        return Err(Failure::failed(
            "no glyph that is selected stands for a character, and LVGL finds glyphs by their characters; select some with --text or --unicodes",
        ));
    }
    let characters: Vec<u32> = glyphs.iter().map(|(code, _)| *code).collect();
    let maps = maps(&characters);
    if maps.len() > MAX_MAPS {
        return Err(Failure::failed(format!(
            "the characters fall into {} ranges, and a font of LVGL has {MAX_MAPS} at most; choose fewer with --text or --unicodes",
            maps.len()
        )));
    }
    let bitmaps = Bitmaps::new(&glyphs, strike.bits);
    let is_large = bitmaps.length >= SMALL_BITMAPS || glyphs.iter().any(|(_, glyph)| !is_small(glyph));
    let glyph_bytes = if is_large { LARGE_GLYPH_BYTES } else { GLYPH_BYTES };
    let lists: usize = maps.iter().filter(|map| !map.is_dense).map(|map| 2 * map.characters.len()).sum();
    let bytes =
        bitmaps.length + (glyphs.len() + 1) * glyph_bytes + maps.len() * MAP_BYTES + lists + FONT_BYTES;
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_file(
        &mut text,
        &File { strike, face, symbol, glyphs: &glyphs, maps: &maps, bitmaps: &bitmaps, is_large },
    );
    let found: BTreeSet<u16> = glyphs.iter().map(|(_, glyph)| glyph.gid).collect();
    let left_out = strike.glyphs.len() - found.len();
    Ok(CFile { text, characters: glyphs.len(), left_out, bytes, is_large })
}

/// Whether a glyph fits into the fields of a font that is not large.
fn is_small(glyph: &Glyph) -> bool {
    let (side, offset) = (u32::from(u8::MAX), i32::from(i8::MIN)..=i32::from(i8::MAX));
    glyph.place.width <= side
        && glyph.place.height <= side
        && offset.contains(&glyph.place.left)
        && offset.contains(&glyph.bottom())
        && glyph.whole_advance() < SMALL_ADVANCE
}
