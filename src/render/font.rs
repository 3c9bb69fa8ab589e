//! A font that carries models: looking glyphs up, and metrics.

use alloc::sync::Arc;
use core::fmt;
use core::ops::Range;

use read_fonts::FontRef;
use read_fonts::tables::cmap::Cmap;
use read_fonts::tables::hmtx::Hmtx;
use read_fonts::types::GlyphId;

use super::charmap::{characters, glyph_of, glyph_of_variation};
use super::glyf::Outlines;
use super::metrics::LineMetrics;
use super::tables::{Tables, malformed, table_range};
use crate::error::Error;
use crate::model::sizes::Scale;
use crate::table::{self, Header, Table};
use crate::target::Target;

/// A font with an `Nfrt` table. It shares the file's bytes: clones are cheap, and all of them are one font, which
/// threads may use at the same time. Opening it takes the same time for any number of glyphs.
#[derive(Clone)]
pub struct Font(Arc<Inner>);

struct Inner {
    data: Arc<dyn AsRef<[u8]> + Send + Sync>,
    /// Which of the file's fonts it is.
    index: u32,
    tables: Tables,
    /// Where the `Nfrt` table is in the file.
    table: Range<usize>,
    header: Header,
    scale: Scale,
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
        let file = open(data.as_ref(), index)?;
        let table = table_range(&file, data.as_ref(), table::TAG)?.ok_or(Error::NotConverted)?;
        let tables = Tables::new(&file, data.as_ref())?;
        let models = Table::parse(&data.as_ref()[table.clone()])?;
        models.check()?;
        let header = *models.header();
        if header.glyph_count != 0 && header.glyph_count != tables.glyph_count {
            return Err(Error::Renumbered {
                models: header.glyph_count.into(),
                font: tables.glyph_count.into(),
            });
        }
        // Table::parse has checked the sizes, Tables::new the units.
        let scale = header.scale(tables.units_per_em).ok_or(Error::UnitsPerEm(tables.units_per_em))?;
        let scale = scale.with_whole_sizes(tables.whole_sizes);
        Ok(Self(Arc::new(Inner { data: Arc::new(data), index, tables, table, header, scale })))
    }

    /// The file's bytes, for a shaper or another renderer.
    pub fn data(&self) -> &[u8] {
        (*self.0.data).as_ref()
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
        self.0.tables.glyph_count.into()
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
        glyph_of(&self.cmap()?, character).map(GlyphId::to_u32)
    }

    /// The glyph of a character with a variation selector behind it, U+FE00–FE0F or U+E0100–E01EF (OpenType 1.9, "cmap", format 14).
    /// `None` if the font does not list them: [`Font::glyph_for_char`] has the glyph then, and nothing is drawn for the selector.
    pub fn glyph_for_variation(&self, character: char, selector: char) -> Option<u32> {
        glyph_of_variation(&self.cmap()?, character, selector).map(GlyphId::to_u32)
    }

    /// The characters of the font's character map with their glyphs.
    pub fn characters(&self) -> impl Iterator<Item = (char, u32)> + '_ {
        let glyph_count = self.0.tables.glyph_count;
        let found = self.cmap().into_iter().flat_map(move |cmap| characters(&cmap, glyph_count));
        found.map(|(character, glyph)| (character, glyph.to_u32()))
    }

    /// Font units in an em.
    pub fn units_per_em(&self) -> u16 {
        self.0.scale.units_per_em()
    }

    /// The advance width in pixels, linear in the size; 0 for a glyph that the font does not have.
    pub fn advance(&self, glyph: u32, ppem: f32) -> f32 {
        f32::from(self.advance_units(glyph)) * ppem / f32::from(self.0.scale.units_per_em())
    }

    /// The left side bearing of `hmtx` in pixels, linear in the size; 0 for a glyph that the font does not have.
    pub(super) fn side_bearing(&self, glyph: u32, ppem: f32) -> f32 {
        let hmtx = self.0.tables.hmtx(self.data());
        let bearing = hmtx.and_then(|hmtx| hmtx.side_bearing(GlyphId::new(glyph)));
        f32::from(bearing.unwrap_or(0)) * ppem / f32::from(self.0.scale.units_per_em())
    }

    /// Metrics of a line of text at a size in pixels per em.
    pub fn line_metrics(&self, ppem: f32) -> LineMetrics {
        open(self.data(), self.0.index)
            .map_or_else(|_| LineMetrics::default(), |font| LineMetrics::new(&font, ppem))
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
        let bytes = self.data().get(self.0.table.clone()).ok_or(malformed(b"Nfrt"))?;
        Table::parse(bytes)
    }

    /// Units and sizes of all models.
    pub(crate) fn scale(&self) -> Scale {
        self.0.scale
    }

    /// The bytes of the table `glyf`.
    pub(super) fn glyf(&self) -> Option<&[u8]> {
        self.0.tables.glyf(self.data())
    }

    /// The outlines, and what places them. None in a font that has none.
    pub(super) fn outline_tables(&self) -> Option<(Outlines<'_>, Hmtx<'_>)> {
        Some((self.0.tables.outlines(self.data())?, self.0.tables.hmtx(self.data())?))
    }

    /// A glyph's advance width in font units; 0 for a glyph that the font does not have.
    pub(super) fn advance_units(&self, glyph: u32) -> u16 {
        if glyph >= self.glyph_count() {
            return 0;
        }
        let hmtx = self.0.tables.hmtx(self.data());
        hmtx.and_then(|hmtx| hmtx.advance(GlyphId::new(glyph))).unwrap_or_default()
    }

    fn cmap(&self) -> Option<Cmap<'_>> {
        self.0.tables.cmap(self.data())
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
