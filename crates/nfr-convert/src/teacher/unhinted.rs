//! A font's unhinted outlines, drawn by skrifa.

use read_fonts::FontRef;
use skrifa::font::Font;
use skrifa::font::glyph::GlyphSourceOrder;
use skrifa::{DrawMemory, GlyphId, OutlineSource, ScaleError, ScalerFont, ScalerSource};

use super::outline::Outline;
use crate::error::Error;
use crate::input::open::{owned, units_per_em};
use nfr::internals::table::Dropout;

/// The unhinted outlines of a font, of which this keeps a copy.
pub(crate) struct UnhintedOutlines {
    /// In font units, which are exact; a scaled outline is rounded to 26.6 pixels.
    unscaled: ScalerFont,
    units_per_em: u16,
}

impl UnhintedOutlines {
    /// Takes the outlines of a font.
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
    pub(crate) fn font(&self) -> &Font {
        self.unscaled.font()
    }

    /// An outline in font units.
    pub(crate) fn units(&self, gid: u16) -> Result<Outline, Error> {
        draw(&self.unscaled, gid).map_err(|e| undrawable(gid, None, &e))
    }

    /// An outline in em.
    pub(crate) fn em(&self, gid: u16) -> Result<Outline, Error> {
        let mut outline = self.units(gid)?;
        outline.scale(1.0 / f32::from(self.units_per_em));
        Ok(outline)
    }

    /// An outline at a size in pixels per em.
    pub(crate) fn at(&self, gid: u16, ppem: f32) -> Result<Outline, Error> {
        let scaler = ScalerFont::force_unhinted(glyf_of(self.font().clone()), Some(ppem));
        draw(&scaler, gid).map_err(|e| undrawable(gid, Some(ppem), &e))
    }
}

/// A source of `glyf` (or CFF) outlines without `VARC`, which has no hint programs.
pub(crate) fn glyf_of(font: Font) -> ScalerSource {
    ScalerSource::new(font, GlyphSourceOrder::BASE_OUTLINES)
}

/// Draws a glyph with the scaler's size and hinting.
pub(crate) fn draw(scaler: &ScalerFont, gid: u16) -> Result<Outline, ScaleError> {
    let gid = GlyphId::from(gid);
    let mut outline = Outline::default();
    match scaler.outline(gid) {
        Some(glyph) => {
            let metrics = glyph.draw(DrawMemory::Scratch, &mut outline)?;
            outline.advance = metrics.h_advance;
            let dropout = metrics.dropout_control;
            if dropout.is_enabled() {
                outline.dropout = Dropout::new(dropout.is_smart(), dropout.includes_stubs());
            }
            Ok(outline)
        }
        // skrifa returns `None` for a damaged glyph, too.
        None if gid.to_u32() < scaler.font().num_glyphs() => {
            Err(ScaleError::Outline(skrifa::raw::model::Error::Malformed))
        }
        None => Err(ScaleError::GlyphNotFound(gid)),
    }
}

/// The error for a glyph that cannot be drawn, in font units or at a size in pixels per em.
pub(crate) fn undrawable(gid: u16, ppem: Option<f32>, error: &ScaleError) -> Error {
    if matches!(error, ScaleError::GlyphNotFound(_)) {
        return Error::NoSuchGlyph(gid.into());
    }
    let size = ppem.map_or_else(|| "in font units".into(), |ppem| format!("at {ppem} ppem"));
    Error::Malformed(format!(
        "glyph {gid} cannot be drawn {size} ({error}); leave it out, or repair the font"
    ))
}
