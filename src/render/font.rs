//! A font that carries models: looking glyphs up and decoding their models.

use std::sync::Arc;

use read_fonts::tables::{cmap::Cmap, hmtx::Hmtx};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};

use super::Glyph;
use crate::error::Error;
use crate::model::Target;
use crate::model::compose::Origin;
use crate::model::gridfit::{GridFit, Scale};
use crate::model::network::Network;
use crate::table::{self, Header, PartsDecoder, Precision, Table};

/// A font with an `Nfrt` table, borrowed from the file's bytes. Opening it reads headers only.
#[derive(Clone)]
pub struct Font<'a> {
    font: FontRef<'a>,
    cmap: Option<Cmap<'a>>,
    hmtx: Option<Hmtx<'a>>,
    table: Table<'a>,
    scale: Scale,
    glyph_count: u16,
}

impl std::fmt::Debug for Font<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Font").field("table", &self.table).field("scale", &self.scale).finish_non_exhaustive()
    }
}

impl<'a> Font<'a> {
    /// Opens the first font of a file's bytes.
    ///
    /// # Errors
    ///
    /// As [`Font::from_index`].
    pub fn parse(data: &'a [u8]) -> Result<Self, Error> {
        Self::from_index(data, 0)
    }

    /// Opens one font of a file's bytes. `index` counts the fonts of a collection and is 0 for a plain font.
    ///
    /// # Errors
    ///
    /// `Malformed` for bytes that are no font or contradict themselves, `Unsupported` for a font without an
    /// `Nfrt` table or with one from the future, `InvalidParameter` for an index that is out of range.
    pub fn from_index(data: &'a [u8], index: u32) -> Result<Self, Error> {
        let font = open(data, index)?;
        let bytes = font.table_data(table::TAG).ok_or_else(|| {
            Error::Unsupported("the font has no 'Nfrt' table; make one with nfr-convert".into())
        })?;
        let table = Table::parse(bytes.as_bytes())?;
        let scale = table.header().scale(head_units(&font)?);
        let glyph_count = font
            .maxp()
            .map_err(|e| Error::Malformed(format!("table 'maxp' cannot be read ({e})")))?
            .num_glyphs();
        Ok(Self { cmap: font.cmap().ok(), hmtx: font.hmtx().ok(), font, table, scale, glyph_count })
    }

    /// What the conversion was asked for.
    pub fn header(&self) -> &Header {
        self.table.header()
    }

    /// What the models were trained for.
    pub fn target(&self) -> Target {
        self.header().target
    }

    /// The models were trained on every whole size from the first to the last of these, in pixels per em; networks on
    /// some of them, which [`Network::sizes`] has.
    pub fn ppem_range(&self) -> (u16, u16) {
        (self.scale.first_ppem, self.scale.last_ppem)
    }

    /// The length of the `Nfrt` table in bytes.
    pub fn table_len(&self) -> usize {
        self.table.table_len()
    }

    /// The bytes that a glyph's model or network takes in the table.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if it has none.
    pub fn model_len(&self, gid: u16) -> Result<usize, Error> {
        self.table.model_len(gid)
    }

    /// The number of glyphs in the font, with a model or without.
    pub fn glyph_count(&self) -> u16 {
        self.glyph_count
    }

    /// The glyphs that have a model or a network, ascending.
    pub fn modelled_glyphs(&self) -> impl ExactSizeIterator<Item = u16> + use<'a> {
        self.table.gids()
    }

    /// Whether a glyph has a model or a network.
    pub fn has_model(&self, gid: u16) -> bool {
        self.table.contains(gid)
    }

    /// The glyphs that have a network, ascending.
    pub fn networks(&self) -> impl ExactSizeIterator<Item = u16> + use<'a> {
        self.table.network_gids()
    }

    /// Whether a glyph is drawn by a network: only at sizes that it was trained for, with the pen on a whole pixel, and
    /// a thousand times more slowly.
    pub fn is_network(&self, gid: u16) -> bool {
        self.table.is_network(gid)
    }

    /// How the weights of a glyph's network are stored.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if it has none, `Malformed` if its bytes are damaged.
    pub fn precision(&self, gid: u16) -> Result<Precision, Error> {
        self.table.precision(gid)
    }

    /// The glyph that the font's character map gives for a character.
    pub fn glyph_for_char(&self, character: char) -> Option<u16> {
        u16::try_from(self.cmap.as_ref()?.map_codepoint(character)?.to_u32()).ok()
    }

    /// The advance width in pixels, linear in the size; 0 for a glyph that the font does not have.
    pub fn advance(&self, gid: u16, ppem: f32) -> f32 {
        if gid >= self.glyph_count {
            return 0.0;
        }
        let units = self.hmtx.as_ref().and_then(|hmtx| hmtx.advance(gid.into())).unwrap_or(0);
        f32::from(units) * ppem / f32::from(self.scale.units_per_em)
    }

    /// Whether the glyphs that have models have no outlines in this font.
    pub fn outlines_dropped(&self) -> bool {
        self.header().outlines_dropped
    }

    /// Whether the outlines in this font are the ones that the models were trained from. Reads all of them.
    /// Where they were dropped, there is nothing that could differ.
    pub fn outlines_match(&self) -> bool {
        if self.outlines_dropped() {
            return true;
        }
        let glyf = self.font.table_data(Tag::new(b"glyf"));
        glyf.is_some_and(|glyf| {
            table::outline_hash(self.scale.units_per_em, glyf.as_bytes()) == self.header().outline_hash
        })
    }

    /// Decodes a glyph's model or network. To draw many glyphs, a [`Rasterizer`](super::Rasterizer) keeps what this
    /// sets up and throws away.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if it has none, `Malformed` or `LimitExceeded` if its bytes are damaged.
    pub fn glyph(&self, gid: u16) -> Result<Glyph, Error> {
        self.glyph_with(&mut PartsDecoder::default(), gid, |_| None)
    }

    /// Decodes a glyph. Those in `known` are not decoded again as parts of others.
    pub(super) fn glyph_with(
        &self,
        parts: &mut PartsDecoder,
        gid: u16,
        known: impl Fn(u16) -> Option<Arc<GridFit>>,
    ) -> Result<Glyph, Error> {
        let model = |gid| match known(gid) {
            Some(model) => Ok(model),
            None => {
                let weights = self.table.weights(gid, self.scale)?;
                GridFit::new(&weights, self.scale).map(Arc::new)
            }
        };
        if self.table.is_network(gid) {
            return Network::new(self.table.network(gid)?).map(Glyph::of_network);
        }
        if !self.table.is_composed(gid) {
            return Ok(Glyph::of_model(model(gid)?, self.scale));
        }
        let placed = parts.parts(&self.table, gid, self.scale)?;
        let placed = placed.iter().map(|part| Ok((model(part.gid)?, Origin::new(part, self.scale)?)));
        Ok(Glyph::of_parts(placed.collect::<Result<_, Error>>()?))
    }

    #[cfg(feature = "fallback")]
    pub(super) fn outlines(&self) -> skrifa::outline::OutlineGlyphCollection<'a> {
        skrifa::MetadataProvider::outline_glyphs(&self.font)
    }
}

/// Opens one font of a file.
pub fn open(data: &[u8], index: u32) -> Result<FontRef<'_>, Error> {
    match read_fonts::FileRef::new(data) {
        Err(_) => Err(Error::Malformed(
            "these bytes are no OpenType font; pass a .ttf file or a collection of them".into(),
        )),
        Ok(read_fonts::FileRef::Font(font)) if index == 0 => Ok(font),
        Ok(read_fonts::FileRef::Font(_)) => Err(Error::InvalidParameter(format!(
            "font index {index} in a file that holds one font; use index 0"
        ))),
        Ok(read_fonts::FileRef::Collection(fonts)) => {
            if index >= fonts.len() {
                return Err(Error::InvalidParameter(format!(
                    "font index {index} in a collection of {} fonts; use 0–{}",
                    fonts.len(),
                    fonts.len().saturating_sub(1)
                )));
            }
            fonts
                .get(index)
                .map_err(|e| Error::Malformed(format!("font {index} of the collection cannot be read ({e})")))
        }
    }
}

/// Font units in an em, checked.
pub fn head_units(font: &FontRef<'_>) -> Result<u16, Error> {
    let head = font.head().map_err(|e| {
        Error::Malformed(format!("table 'head' cannot be read ({e}); the file may be truncated"))
    })?;
    match head.units_per_em() {
        units @ 16..=16384 => Ok(units),
        units => {
            Err(Error::Malformed(format!("table 'head' claims {units} units per em, 16–16384 are allowed")))
        }
    }
}
