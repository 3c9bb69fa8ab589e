//! A font that carries models: looking glyphs up and drawing them.

use read_fonts::{FontRef, TableProvider};

use super::{Bitmap, Placement};
use crate::error::Error;
use crate::model::Target;

/// Working memory that rendering reuses, so that a warm loop allocates nothing.
#[derive(Debug, Default)]
pub struct Scratch {}

/// A font with an `Nfrt` table, borrowed from the file's bytes.
#[derive(Clone)]
pub struct Font<'a> {
    font: FontRef<'a>,
    units_per_em: u16,
}

impl<'a> Font<'a> {
    /// Opens a font file's bytes.
    ///
    /// # Errors
    ///
    /// `Malformed` for bytes that are no font, `Unsupported` for a font without an `Nfrt` table.
    pub fn parse(data: &'a [u8]) -> Result<Self, Error> {
        let font = FontRef::new(data).map_err(|e| Error::Malformed(e.to_string()))?;
        let units_per_em = font.head().map_err(|e| Error::Malformed(e.to_string()))?.units_per_em();
        Ok(Self { font, units_per_em })
    }

    /// What the models were trained for.
    pub fn target(&self) -> Target {
        Target::Smooth
    }

    /// The sizes that the models were trained on, in pixels per em.
    pub fn ppem_range(&self) -> (u16, u16) {
        (8, 64)
    }

    /// The length of the `Nfrt` table in bytes.
    pub fn table_len(&self) -> usize {
        0
    }

    /// The glyphs that have a model, in order.
    pub fn modelled_glyphs(&self) -> impl Iterator<Item = u16> + '_ {
        std::iter::empty()
    }

    /// The glyph that the font's character map gives for a character.
    pub fn glyph_for_char(&self, character: char) -> Option<u16> {
        let gid = self.font.cmap().ok()?.map_codepoint(character)?;
        u16::try_from(gid.to_u32()).ok()
    }

    /// The advance width in pixels, linear in the size.
    pub fn advance(&self, gid: u16, ppem: f32) -> f32 {
        let _ = (gid, ppem, self.units_per_em);
        0.0
    }

    /// Whether the outlines in this font are the ones that the models were trained from.
    pub fn outlines_match(&self) -> bool {
        true
    }

    /// Decodes a glyph's model.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` if it has none, `Malformed` if its bytes are damaged.
    pub fn glyph(&self, gid: u16) -> Result<Glyph, Error> {
        Err(Error::MissingGlyph(gid))
    }
}

/// One glyph's model, decoded and ready to draw at any size.
#[derive(Debug, Clone)]
pub struct Glyph {}

impl Glyph {
    /// Where the bitmap lies at a size, which may be fractional.
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for a size that is not a positive number within the limits.
    pub fn placement(&self, ppem: f32) -> Result<Placement, Error> {
        Err(Error::InvalidParameter(ppem.to_string()))
    }

    /// Draws into `pixels`, top row first, `placement.width` bytes a row.
    ///
    /// # Errors
    ///
    /// As `placement`, and `InvalidParameter` for a buffer that is too small.
    pub fn render_into(
        &self,
        ppem: f32,
        _scratch: &mut Scratch,
        _pixels: &mut [u8],
    ) -> Result<Placement, Error> {
        self.placement(ppem)
    }

    /// Draws into a new bitmap.
    ///
    /// # Errors
    ///
    /// As `placement`.
    pub fn render(&self, ppem: f32) -> Result<Bitmap, Error> {
        let placement = self.placement(ppem)?;
        let mut pixels = vec![0; placement.area()];
        self.render_into(ppem, &mut Scratch::default(), &mut pixels)?;
        Ok(Bitmap { placement, pixels })
    }
}
