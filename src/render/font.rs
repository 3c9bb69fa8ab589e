//! A font that carries models: looking glyphs up, and metrics.

use alloc::sync::Arc;
use core::fmt;
use core::ops::Range;

use read_fonts::model::Blob;
use read_fonts::tables::cmap::PlatformId;
use read_fonts::tables::head::Flags;
use read_fonts::types::{GlyphId, Tag};
use read_fonts::{FontRef, TableProvider, model};

use super::metrics::LineMetrics;
use crate::error::Error;
use crate::model::sizes::Scale;
use crate::table::{self, Header, Table};
use crate::target::Target;

/// A font with an `Nfrt` table. It shares the file's bytes: clones are cheap, and all of them are one font, which
/// threads may use at the same time. Opening it takes the same time for any number of glyphs.
#[derive(Clone)]
pub struct Font(Arc<Inner>);

struct Inner {
    font: model::Font,
    data: Blob,
    /// Where the `Nfrt` table is in the file.
    table: Range<usize>,
    header: Header,
    scale: Scale,
    glyph_count: u32,
}

const _: () = {
    const fn sendable<T: Clone + Send + Sync + 'static>() {}
    sendable::<Font>();
};

impl fmt::Debug for Font {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Font")
            .field("header", self.header())
            .field("scale", &self.0.scale)
            .finish_non_exhaustive()
    }
}

impl Font {
    /// Opens the first font of a file's bytes: a `Vec<u8>`, a `&'static [u8]`, an `Arc<[u8]>`, a memory map.
    ///
    /// # Errors
    ///
    /// As [`Font::from_index`].
    pub fn new(data: impl AsRef<[u8]> + Send + Sync + 'static) -> Result<Self, Error> {
        Self::from_index(data, 0)
    }

    /// Opens one font of a file's bytes. `index` counts the fonts of a collection and is 0 for a plain font.
    ///
    /// # Errors
    ///
    /// `NotAFont`, `NoSuchFont`; `NotConverted` for a font without an `Nfrt` table; `MissingTable`, `MalformedTable`
    /// or `UnitsPerEm` for a font whose header, metrics or character map cannot be read; `MalformedModels` or
    /// `UnknownVersion`; `Renumbered` if glyphs were taken out or added after the conversion.
    pub fn from_index(data: impl AsRef<[u8]> + Send + Sync + 'static, index: u32) -> Result<Self, Error> {
        let data = Blob::Shared(Arc::new(data));
        let file = open(&data, index)?;
        let table = range(&file, &data, table::TAG)?.ok_or(Error::NotConverted)?;
        let units_per_em = head_units(&file)?;
        let whole_sizes = has_whole_sizes(&file)?;
        check_tables(&file, &data)?;
        let glyph_count: u32 = file.maxp().map_err(|_| malformed(b"maxp"))?.num_glyphs().into();
        let models = Table::parse(&data[table.clone()])?;
        models.check()?;
        let header = *models.header();
        if header.glyph_count != 0 && u32::from(header.glyph_count) != glyph_count {
            return Err(Error::Renumbered { models: header.glyph_count.into(), font: glyph_count });
        }
        // Table::parse has checked the sizes, head_units the units.
        let scale =
            header.scale(units_per_em).ok_or(Error::UnitsPerEm(units_per_em))?.with_whole_sizes(whole_sizes);
        let font = model::Font::new(data.clone(), index).ok_or(Error::NotAFont)?;
        Ok(Self(Arc::new(Inner { font, data, table, header, scale, glyph_count })))
    }

    /// The file's bytes, for a shaper or another renderer.
    pub fn data(&self) -> &[u8] {
        &self.0.data
    }

    /// What the models were trained for.
    pub fn target(&self) -> Target {
        self.header().target
    }

    /// The models were trained on every whole size from the first to the last of these, in pixels per em; networks on
    /// some of them.
    pub fn ppem_range(&self) -> (u16, u16) {
        (self.0.scale.first_ppem(), self.0.scale.last_ppem())
    }

    /// The number of glyphs in the font, with a model or without.
    pub fn glyph_count(&self) -> u32 {
        self.0.glyph_count
    }

    /// The glyphs that have a model, ascending.
    pub fn modelled_glyphs(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.table().map_or_else(|_| table::Gids::default(), |table| table.gids()).map(u32::from)
    }

    /// Whether a glyph has a model.
    pub fn has_model(&self, glyph: u32) -> bool {
        self.table().is_ok_and(|table| table.contains(glyph))
    }

    /// The bytes that a glyph's model takes in the table.
    ///
    /// # Errors
    ///
    /// `MissingModel` if it has none, `MalformedModel` if the table's entry is damaged.
    pub fn model_len(&self, glyph: u32) -> Result<usize, Error> {
        self.table()?.model_len(glyph)
    }

    /// The length of the `Nfrt` table in bytes.
    pub fn table_len(&self) -> usize {
        self.0.table.len()
    }

    /// The glyph that the font's character map gives for a character.
    pub fn glyph_for_char(&self, character: char) -> Option<u32> {
        self.0.font.charmap().map_unicode(character).map(GlyphId::to_u32)
    }

    /// The glyph of a character with a variation selector behind it, U+FE00–FE0F or U+E0100–E01EF (OpenType 1.9, "cmap", format 14).
    /// `None` if the font does not list them: [`Font::glyph_for_char`] has the glyph then, and nothing is drawn for the selector.
    pub fn glyph_for_variation(&self, character: char, selector: char) -> Option<u32> {
        self.0.font.charmap().map_unicode_variant(character, selector).map(GlyphId::to_u32)
    }

    /// The characters of the font's character map with their glyphs.
    pub fn characters(&self) -> impl Iterator<Item = (char, u32)> + '_ {
        let mappings = self.0.font.charmap().unicodes();
        mappings.filter_map(|(code, glyph)| Some((char::from_u32(code)?, glyph.to_u32())))
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> u16 {
        self.0.scale.units_per_em()
    }

    /// The advance width in pixels, linear in the size; 0 for a glyph that the font does not have.
    pub fn advance(&self, glyph: u32, ppem: f32) -> f32 {
        if glyph >= self.0.glyph_count {
            return 0.0;
        }
        let units = self.0.font.glyph_metrics().h_advance(GlyphId::new(glyph));
        units * ppem / f32::from(self.0.scale.units_per_em())
    }

    /// The left side bearing of `hmtx` in pixels, linear in the size; 0 for a glyph that the font does not have.
    pub(super) fn side_bearing(&self, glyph: u32, ppem: f32) -> f32 {
        let bearing =
            self.0.font.tables().hmtx().ok().and_then(|hmtx| hmtx.side_bearing(GlyphId::new(glyph)));
        f32::from(bearing.unwrap_or(0)) * ppem / f32::from(self.0.scale.units_per_em())
    }

    /// Metrics of a line of text at a size in pixels per em.
    pub fn line_metrics(&self, ppem: f32) -> LineMetrics {
        LineMetrics::new(&self.0.font, ppem)
    }

    /// Whether the glyphs that have models have no outlines in this font.
    pub fn outlines_dropped(&self) -> bool {
        self.header().outlines_dropped
    }
}

impl Font {
    /// What the conversion was asked for.
    pub(crate) fn header(&self) -> &Header {
        &self.0.header
    }

    /// The `Nfrt` table. It was read when the font was opened; this only finds its arrays again.
    pub(crate) fn table(&self) -> Result<Table<'_>, Error> {
        let bytes = self.0.data.get(self.0.table.clone()).ok_or(malformed(b"Nfrt"))?;
        Table::parse(bytes)
    }

    /// Units and sizes of all models.
    pub(crate) fn scale(&self) -> Scale {
        self.0.scale
    }

    pub(super) fn model(&self) -> &model::Font {
        &self.0.font
    }
}

/// Opens one font of a file.
///
/// # Errors
///
/// `NotAFont`, `NoSuchFont`, or `MalformedTable` for a collection's font that cannot be read.
pub fn open(data: &[u8], index: u32) -> Result<FontRef<'_>, Error> {
    match read_fonts::FileRef::new(data) {
        Err(_) => Err(Error::NotAFont),
        Ok(read_fonts::FileRef::Font(font)) if index == 0 => Ok(font),
        Ok(read_fonts::FileRef::Font(_)) => Err(Error::NoSuchFont { index, count: 1 }),
        Ok(read_fonts::FileRef::Collection(fonts)) => {
            if index >= fonts.len() {
                return Err(Error::NoSuchFont { index, count: fonts.len() });
            }
            fonts.get(index).map_err(|_| malformed(b"ttcf"))
        }
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

/// Whether hinted sizes are whole along x too, which the font's header says.
fn has_whole_sizes(font: &FontRef<'_>) -> Result<bool, Error> {
    let head = font.head().map_err(|_| unreadable(font, b"head"))?;
    Ok(head.flags().contains(Flags::FORCE_INTEGER_PPEM))
}

fn malformed(tag: &[u8; 4]) -> Error {
    Error::MalformedTable { tag: *tag }
}

/// The error for a table that is needed and cannot be read.
fn unreadable(font: &FontRef<'_>, tag: &[u8; 4]) -> Error {
    let listed = font.table_directory().table_records().iter().any(|record| record.tag() == Tag::new(tag));
    if listed { malformed(tag) } else { Error::MissingTable { tag: *tag } }
}

/// Where a table is in the file; `None` if the font has none.
fn range(font: &FontRef<'_>, data: &[u8], tag: Tag) -> Result<Option<Range<usize>>, Error> {
    let records = font.table_directory().table_records();
    let Some(record) = records.iter().find(|record| record.tag() == tag) else { return Ok(None) };
    let start = record.offset() as usize;
    let range = start..start.saturating_add(record.length() as usize);
    if data.get(range.clone()).is_some() { Ok(Some(range)) } else { Err(malformed(&tag.to_be_bytes())) }
}

/// Checks what metrics and characters are read from, so that nothing is silently without width or characters later.
fn check_tables(font: &FontRef<'_>, data: &[u8]) -> Result<(), Error> {
    font.maxp().map_err(|_| unreadable(font, b"maxp"))?;
    font.hhea().map_err(|_| unreadable(font, b"hhea"))?;
    let hmtx = font.hmtx().map_err(|_| unreadable(font, b"hmtx"))?;
    if hmtx.h_metrics().is_empty() {
        return Err(malformed(b"hmtx"));
    }
    // A font without a character map can be drawn by its glyphs' numbers.
    let Some(_) = range(font, data, Tag::new(b"cmap"))? else { return Ok(()) };
    let cmap = font.cmap().map_err(|_| malformed(b"cmap"))?;
    let unicode = cmap.encoding_records().iter().filter(|record| {
        matches!(
            (record.platform_id(), record.encoding_id()),
            (PlatformId::Unicode, 0..=4 | 6) | (PlatformId::Windows, 0 | 1 | 10)
        )
    });
    let mut readable = unicode.map(|record| record.subtable(cmap.offset_data()).is_ok()).peekable();
    if readable.peek().is_some() && !readable.any(|is| is) {
        return Err(malformed(b"cmap"));
    }
    Ok(())
}
