//! A font's outlines without hints, drawn by skrifa.

use read_fonts::FontRef;
use skrifa::font::Font;
use skrifa::font::glyph::GlyphSourceOrder;
use skrifa::{DrawMemory, GlyphId, OutlineSource, ScaleError, ScalerFont, ScalerSource};

use crate::error::Error;
use crate::open::{owned, units_per_em};
use crate::outline::Outline;

/// The plain outlines of a font, of which this is a copy.
pub(crate) struct PlainOutlines {
    /// In font units, which are exact; a scaled outline is rounded to 26.6 pixels.
    unscaled: ScalerFont,
    units_per_em: u16,
}

impl PlainOutlines {
    /// Takes the outlines of a font.
    ///
    /// # Errors
    ///
    /// `Malformed` if `head` cannot be read, or has a size of an em that OpenType does not allow.
    pub(crate) fn new(font: &FontRef<'_>) -> Result<Self, Error> {
        let units_per_em = units_per_em(font)?;
        Ok(Self { unscaled: ScalerFont::force_unhinted(glyf_of(owned(font)?), None), units_per_em })
    }

    /// Font units in an em.
    pub(crate) fn units_per_em(&self) -> u16 {
        self.units_per_em
    }

    /// The table that the outlines are in.
    pub(crate) fn table(&self) -> Option<OutlineSource> {
        self.unscaled.outline_source()
    }

    /// The font, for other ways to draw it.
    pub(crate) fn source(&self) -> ScalerSource {
        glyf_of(self.unscaled.font().clone())
    }

    /// An outline in em.
    ///
    /// # Errors
    ///
    /// `MissingGlyph` for a glyph that the font does not have, `Malformed` for one that cannot be drawn.
    pub(crate) fn em(&self, gid: u16) -> Result<Outline, Error> {
        let mut outline = draw(&self.unscaled, gid).map_err(|e| undrawable(gid, None, &e))?;
        outline.scale(1.0 / f32::from(self.units_per_em));
        Ok(outline)
    }

    /// An outline at a size in pixels per em.
    ///
    /// # Errors
    ///
    /// As `em`.
    pub(crate) fn at(&self, gid: u16, ppem: f32) -> Result<Outline, Error> {
        let scaler = ScalerFont::force_unhinted(self.source(), Some(ppem));
        draw(&scaler, gid).map_err(|e| undrawable(gid, Some(ppem), &e))
    }
}

/// `glyf` and what may stand in its place, without `VARC`, which hint programs know nothing of.
pub(crate) fn glyf_of(font: Font) -> ScalerSource {
    ScalerSource::new(font, GlyphSourceOrder::BASE_OUTLINES)
}

/// Draws a glyph as the scaler is set up.
pub(crate) fn draw(scaler: &ScalerFont, gid: u16) -> Result<Outline, ScaleError> {
    let gid = GlyphId::from(gid);
    let mut outline = Outline::default();
    match scaler.outline(gid) {
        Some(glyph) => glyph.draw(DrawMemory::Scratch, &mut outline).map(|_| outline),
        // skrifa says the same of a glyph that is damaged.
        None if gid.to_u32() < scaler.font().num_glyphs() => {
            Err(ScaleError::Outline(skrifa::raw::model::Error::Malformed))
        }
        None => Err(ScaleError::GlyphNotFound(gid)),
    }
}

/// Says which glyph cannot be drawn, in font units or at a size in pixels per em.
pub(crate) fn undrawable(gid: u16, ppem: Option<f32>, error: &ScaleError) -> Error {
    if matches!(error, ScaleError::GlyphNotFound(_)) {
        return Error::MissingGlyph(gid);
    }
    let size = ppem.map_or_else(|| "in font units".into(), |ppem| format!("at {ppem} ppem"));
    Error::Malformed(format!("glyph {gid} cannot be drawn {size} ({error})"))
}
