//! The tables of a font that are read again and again: where they are is found once.

use core::ops::Range;

use read_fonts::tables::cmap::Cmap;
use read_fonts::tables::head::Flags;
use read_fonts::tables::hmtx::Hmtx;
use read_fonts::tables::loca::Loca;
use read_fonts::types::Tag;
use read_fonts::{FontData, FontRead, FontRef, TableProvider};

use super::charmap::is_readable;
use super::glyf::Outlines;
use crate::error::Error;

/// Where tables are in a file.
#[derive(Debug, Clone)]
pub(super) struct Tables {
    /// `glyf` and `loca`, and whether offsets have 32 bits. None in a font without such outlines.
    outlines: Option<(Range<usize>, Range<usize>, bool)>,
    hmtx: Range<usize>,
    /// Glyphs with an advance width of their own.
    advances: u16,
    cmap: Option<Range<usize>>,
    pub(super) glyph_count: u16,
    pub(super) units_per_em: u16,
    /// Whether hinted sizes are whole along x too.
    pub(super) whole_sizes: bool,
}

impl Tables {
    /// Finds and checks the tables, so that nothing is silently without width or characters later.
    ///
    /// # Errors
    ///
    /// `MissingTable`, `MalformedTable`, `UnitsPerEm`.
    pub(super) fn new(font: &FontRef<'_>, data: &[u8]) -> Result<Self, Error> {
        let units_per_em = head_units(font)?;
        let head = font.head().map_err(|_| unreadable(font, b"head"))?;
        let maxp = font.maxp().map_err(|_| unreadable(font, b"maxp"))?;
        let hhea = font.hhea().map_err(|_| unreadable(font, b"hhea"))?;
        let hmtx = font.hmtx().map_err(|_| unreadable(font, b"hmtx"))?;
        if hmtx.h_metrics().is_empty() {
            return Err(malformed(b"hmtx"));
        }
        let cmap = table_range(font, data, Tag::new(b"cmap"))?;
        // A font without a character map can be drawn by its glyphs' numbers.
        if cmap.is_some() && !font.cmap().is_ok_and(|cmap| is_readable(&cmap)) {
            return Err(malformed(b"cmap"));
        }
        let found = |tag| table_range(font, data, Tag::new(tag)).ok().flatten();
        let outlines = found(b"glyf").zip(found(b"loca"));
        Ok(Self {
            outlines: outlines.map(|(glyf, loca)| (glyf, loca, head.index_to_loc_format() != 0)),
            hmtx: table_range(font, data, Tag::new(b"hmtx"))?.ok_or(malformed(b"hmtx"))?,
            advances: hhea.number_of_h_metrics(),
            cmap,
            glyph_count: maxp.num_glyphs(),
            units_per_em,
            whole_sizes: head.flags().contains(Flags::FORCE_INTEGER_PPEM),
        })
    }

    /// The bytes of the table `glyf`.
    pub(super) fn glyf<'a>(&self, data: &'a [u8]) -> Option<&'a [u8]> {
        let (glyf, _, _) = self.outlines.as_ref()?;
        data.get(glyf.clone())
    }

    /// The outlines.
    pub(super) fn outlines<'a>(&self, data: &'a [u8]) -> Option<Outlines<'a>> {
        let (_, loca, is_long) = self.outlines.as_ref()?;
        let loca = Loca::read_with_args(FontData::new(data.get(loca.clone())?), *is_long).ok()?;
        Some(Outlines { glyf: self.glyf(data)?, loca })
    }

    /// Advance widths and side bearings.
    pub(super) fn hmtx<'a>(&self, data: &'a [u8]) -> Option<Hmtx<'a>> {
        Hmtx::read_with_args(FontData::new(data.get(self.hmtx.clone())?), self.advances).ok()
    }

    /// The character map.
    pub(super) fn cmap<'a>(&self, data: &'a [u8]) -> Option<Cmap<'a>> {
        Cmap::read(FontData::new(data.get(self.cmap.clone()?)?)).ok()
    }
}

/// Font units in an em, checked.
///
/// # Errors
///
/// `MissingTable` or `MalformedTable` if they cannot be read, `UnitsPerEm` if they are not allowed.
pub fn head_units(font: &FontRef<'_>) -> Result<u16, Error> {
    match font.head().map_err(|_| unreadable(font, b"head"))?.units_per_em() {
        units @ 16..=16384 => Ok(units),
        units => Err(Error::UnitsPerEm(units)),
    }
}

pub(super) fn malformed(tag: &[u8; 4]) -> Error {
    Error::MalformedTable { tag: *tag }
}

/// The error for a table that is needed and cannot be read.
fn unreadable(font: &FontRef<'_>, tag: &[u8; 4]) -> Error {
    let listed = font.table_directory().table_records().iter().any(|record| record.tag() == Tag::new(tag));
    if listed { malformed(tag) } else { Error::MissingTable { tag: *tag } }
}

/// Where a table is in the file; `None` if the font has none.
///
/// # Errors
///
/// `MalformedTable` for one that lies outside the file.
pub(super) fn table_range(font: &FontRef<'_>, data: &[u8], tag: Tag) -> Result<Option<Range<usize>>, Error> {
    let records = font.table_directory().table_records();
    let Some(record) = records.iter().find(|record| record.tag() == tag) else { return Ok(None) };
    let start = record.offset() as usize;
    let range = start..start.saturating_add(record.length() as usize);
    if data.get(range.clone()).is_some() { Ok(Some(range)) } else { Err(malformed(&tag.to_be_bytes())) }
}
