//! The output font: the input font without its hint programs, and with the models in a table of their own.

use std::collections::BTreeSet;

use read_fonts::tables::glyf::Glyph;
use read_fonts::tables::head::Flags;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::from_obj::ToOwnedTable;
use write_fonts::tables::gasp::{Gasp, GaspRange, GaspRangeBehavior};
use write_fonts::tables::maxp::Maxp;
use write_fonts::{FontBuilder, dump_table};

use super::strip::{Stripped, strip};
use crate::error::Error;
use nfr::internals::table;

const CVT: Tag = Tag::new(b"cvt ");
const FPGM: Tag = Tag::new(b"fpgm");
const GASP: Tag = Tag::new(b"gasp");
const GLYF: Tag = Tag::new(b"glyf");
const HEAD: Tag = Tag::new(b"head");
const LOCA: Tag = Tag::new(b"loca");
const MAXP: Tag = Tag::new(b"maxp");
const PREP: Tag = Tag::new(b"prep");

/// Tables that are not copied: the programs and their data, what was measured by running them, and the
/// signature, which no longer holds.
const DROPPED: [Tag; 8] = [
    FPGM,
    PREP,
    CVT,
    Tag::new(b"cvar"),
    Tag::new(b"hdmx"),
    Tag::new(b"VDMX"),
    Tag::new(b"LTSH"),
    Tag::new(b"DSIG"),
];

/// Tables of PostScript outlines, which `glyf` stands in place of.
const POSTSCRIPT: [Tag; 2] = [Tag::new(b"CFF "), Tag::new(b"CFF2")];

/// No TrueType font comes near this size. Tables may overlap, so that a small file can ask for a huge copy.
const MAX_FONT_BYTES: usize = 1 << 30;

// OpenType 1.9, "head".
const HEAD_BYTES: usize = 54;
const HEAD_FLAGS_AT: usize = 16;
const HEAD_INDEX_TO_LOC_FORMAT_AT: usize = 50;

/// The bytes of a font's hint programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HintBytes {
    /// The programs of all glyphs, without the fields that say how long they are.
    pub glyph_programs: usize,
    /// The font program, which defines functions.
    pub fpgm: usize,
    /// The program that runs for each size.
    pub prep: usize,
    /// The control values that programs read.
    pub cvt: usize,
}

impl HintBytes {
    /// All of them.
    pub fn total(&self) -> usize {
        self.glyph_programs + self.fpgm + self.prep + self.cvt
    }
}

/// Counts the bytes of hint programs that [`assemble`] takes out of a font.
///
/// # Errors
///
/// As for [`assemble`].
pub fn hint_bytes(font: &FontRef) -> Result<HintBytes, Error> {
    let length = |tag| font.table_data(tag).map_or(0, |data| data.len());
    Ok(HintBytes {
        glyph_programs: strip_font(font)?.program_bytes,
        fpgm: length(FPGM),
        prep: length(PREP),
        cvt: length(CVT),
    })
}

/// The hash that ties models to the outlines of the font that [`assemble`] writes, all of them.
///
/// # Errors
///
/// As for [`assemble`].
pub fn outline_hash(font: &FontRef) -> Result<u64, Error> {
    let units_per_em = font.head().map_err(|e| unreadable(HEAD, e))?.units_per_em();
    Ok(table::outline_hash(units_per_em, &strip_font(font)?.glyf))
}

/// Writes a font with the outlines and everything else of `font`, no hint programs, and `nfrt` as its
/// `Nfrt` table.
///
/// Changed are `glyf` and `loca` (see [`strip`]), the fields of `maxp` and `head` about programs, and
/// `gasp`, which asks for smooth and unhinted rendering at all sizes. The tables `fpgm`, `prep`, `cvt `,
/// `cvar`, `hdmx`, `VDMX`, `LTSH` and `DSIG` are left out. All others are copied byte by byte. A font out of
/// a collection becomes a font file of its own. The glyphs in `dropped` are left without outlines, unless glyphs
/// that keep theirs are made of them.
///
/// # Errors
///
/// `Malformed` if a table or glyph that has to change cannot be read, or if a table lies outside the file;
/// `Unsupported` without TrueType outlines; `LimitExceeded` for a result of more than 1 GiB.
pub fn assemble(font: &FontRef, nfrt: &[u8], dropped: &BTreeSet<u16>) -> Result<Vec<u8>, Error> {
    let mut stripped = strip_font(font)?;
    if !dropped.is_empty() {
        let num_glyphs = font.maxp().map_err(|e| unreadable(MAXP, e))?.num_glyphs();
        let kept = components(font, (0..num_glyphs).filter(|gid| !dropped.contains(gid)))?;
        stripped = stripped.without(&(dropped - &kept), num_glyphs)?;
    }
    let mut builder = FontBuilder::new();
    let mut size = nfrt.len();
    for record in font.table_directory().table_records() {
        let tag = record.tag();
        if !DROPPED.contains(&tag) {
            let data = table_bytes(font, tag)?;
            size += data.len();
            builder.add_raw(tag, data);
        }
    }
    if size > MAX_FONT_BYTES {
        return Err(Error::LimitExceeded(format!(
            "the font would have {size} bytes, and {MAX_FONT_BYTES} are allowed; its tables overlap or are damaged; repair the font"
        )));
    }
    builder.add_raw(HEAD, head(font, stripped.long_offsets)?);
    builder.add_raw(MAXP, maxp(font)?);
    builder.add_raw(GASP, gasp()?);
    builder.add_raw(LOCA, stripped.loca);
    builder.add_raw(GLYF, stripped.glyf);
    builder.add_raw(table::TAG, nfrt);
    Ok(builder.build())
}

/// The glyphs that some glyphs are made of, and those that these are made of.
fn components(font: &FontRef, gids: impl Iterator<Item = u16>) -> Result<BTreeSet<u16>, Error> {
    let loca = font.loca(None).map_err(|e| unreadable(LOCA, e))?;
    let glyf = font.glyf().map_err(|e| unreadable(GLYF, e))?;
    let mut found = BTreeSet::new();
    let mut left: Vec<u16> = gids.collect();
    while let Some(gid) = left.pop() {
        let glyph = loca
            .get_glyf(gid.into(), &glyf)
            .map_err(|e| Error::Malformed(format!("glyph {gid} cannot be read ({e}); repair the font")))?;
        if let Some(Glyph::Composite(glyph)) = glyph {
            let parts = glyph.components().filter_map(|part| u16::try_from(part.glyph.to_u32()).ok());
            left.extend(parts.filter(|part| found.insert(*part)));
        }
    }
    Ok(found)
}

fn table_bytes<'a>(font: &FontRef<'a>, tag: Tag) -> Result<&'a [u8], Error> {
    let data = font.table_data(tag).ok_or_else(|| {
        Error::Malformed(format!("table '{tag}' is missing or reaches beyond the file; repair the font"))
    })?;
    Ok(data.as_bytes())
}

fn strip_font(font: &FontRef) -> Result<Stripped, Error> {
    if font.table_data(GLYF).is_none() || POSTSCRIPT.iter().any(|&tag| font.table_data(tag).is_some()) {
        return Err(Error::Unsupported(
            "the font's outlines are not TrueType ('glyf'); convert them to a hinted TrueType font first"
                .into(),
        ));
    }
    let long_offsets = match font.head().map_err(|e| unreadable(HEAD, e))?.index_to_loc_format() {
        0 => false,
        1 => true,
        format => {
            return Err(Error::Malformed(format!(
                "'head' says that 'loca' has format {format}, and only 0 and 1 are defined; repair the font"
            )));
        }
    };
    let num_glyphs = font.maxp().map_err(|e| unreadable(MAXP, e))?.num_glyphs();
    strip(table_bytes(font, GLYF)?, table_bytes(font, LOCA)?, long_offsets, num_glyphs)
}

fn unreadable(tag: Tag, error: impl std::fmt::Display) -> Error {
    Error::Malformed(format!("table '{tag}' cannot be read ({error}); repair the font"))
}

/// `head` with what it says of programs cleared. Its bytes are patched, not parsed, so that reserved bits stay.
fn head(font: &FontRef, long_offsets: bool) -> Result<Vec<u8>, Error> {
    let mut head = table_bytes(font, HEAD)?.to_vec();
    if head.len() < HEAD_BYTES {
        return Err(unreadable(HEAD, format!("{} bytes instead of {HEAD_BYTES}", head.len())));
    }
    let cleared = Flags::INSTRUCTIONS_MAY_DEPEND_ON_POINT_SIZE | Flags::INSTRUCTIONS_MAY_ALTER_ADVANCE_WIDTH;
    let flags = u16::from_be_bytes([head[HEAD_FLAGS_AT], head[HEAD_FLAGS_AT + 1]]) & !cleared.bits();
    head[HEAD_FLAGS_AT..][..2].copy_from_slice(&flags.to_be_bytes());
    head[HEAD_INDEX_TO_LOC_FORMAT_AT..][..2].copy_from_slice(&u16::from(long_offsets).to_be_bytes());
    Ok(head)
}

/// `maxp` for a font without programs. A maxSizeOfInstructions of 0 without `fpgm` and `prep` is also how
/// FreeType (`FT_Load_Glyph`) tells that a font is unhinted; its default is to autohint such a font then.
fn maxp(font: &FontRef) -> Result<Vec<u8>, Error> {
    let mut maxp: Maxp = font.maxp().map_err(|e| unreadable(MAXP, e))?.to_owned_table();
    if maxp.max_points.is_none() {
        return Err(unreadable(MAXP, "version 0.5 instead of 1.0, which 'glyf' needs"));
    }
    // 1: programs do not use the twilight zone. 0 is not a legal value.
    maxp.max_zones = Some(1);
    maxp.max_twilight_points = Some(0);
    maxp.max_storage = Some(0);
    maxp.max_function_defs = Some(0);
    maxp.max_instruction_defs = Some(0);
    maxp.max_stack_elements = Some(0);
    maxp.max_size_of_instructions = Some(0);
    dump_table(&maxp).map_err(|e| unreadable(MAXP, e))
}

/// A `gasp` for all sizes (0xFFFF ends the last range): antialiased in both directions, never grid-fitted.
/// Version 1, as version 0 has no flag for smoothing in y (OpenType 1.9, "gasp").
fn gasp() -> Result<Vec<u8>, Error> {
    let behavior = GaspRangeBehavior::GASP_DOGRAY | GaspRangeBehavior::GASP_SYMMETRIC_SMOOTHING;
    let gasp = Gasp::new(1, 1, vec![GaspRange::new(u16::MAX, behavior)]);
    dump_table(&gasp).map_err(|e| unreadable(GASP, e))
}
