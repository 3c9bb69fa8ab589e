//! A glyph's outline as the font stores it.

use nfr::internals::model::compose::Part;
use nfr::internals::model::outline::OutlinePoints;
use nfr::internals::table::outline::{KnownGlyph, StoredGlyph, decode_parts, encode_parts, plain_parts};
use nfr::internals::{Damage, components};
use read_fonts::{FontRef, TableProvider};
use skrifa::font::Font;

use crate::error::Error;

/// The points of a glyph in font units, components resolved, and its advance width.
///
/// # Errors
///
/// `Malformed` for a glyph that cannot be read, or that does not fit 16 bits.
pub(crate) fn stored_outline(font: &Font, gid: u16) -> Result<(OutlinePoints, u16), Error> {
    let unreadable = || Error::from(nfr::Error::MalformedOutline(gid.into()));
    let mut points = OutlinePoints::default();
    let outline = font.outline_glyphs().get(gid.into()).ok_or_else(unreadable)?;
    outline.draw_unscaled(skrifa::DrawMemory::Scratch, &mut points).map_err(|_| unreadable())?;
    if points.is_unfit {
        return Err(unreadable());
    }
    Ok((points, advance(font, gid)))
}

fn advance(font: &Font, gid: u16) -> u16 {
    font.glyph_metrics().h_advance(gid.into()).clamp(0.0, f32::from(u16::MAX)) as u16
}

/// What a font has for a glyph that its table composes.
pub(crate) struct FontGlyph {
    /// Its parts in `glyf`, if it is a composite glyph there.
    parts: Option<Vec<Part>>,
    advance: u16,
    /// None if the outline cannot be read.
    outline_hash: Option<u16>,
}

impl FontGlyph {
    /// Reads it. `font` is a copy of `file`.
    pub(crate) fn read(file: &FontRef<'_>, font: &Font, gid: u16) -> Self {
        let (loca, glyf) = (file.loca(None).ok(), file.glyf().ok());
        let parts = loca.zip(glyf).and_then(|(loca, glyf)| components(&loca, &glyf, gid.into()));
        let outline = stored_outline(font, gid).ok();
        let outline_hash = outline.map(|(points, advance)| points.hash(advance));
        Self { parts, advance: advance(font, gid), outline_hash }
    }

    /// Encodes the composed glyph.
    ///
    /// # Errors
    ///
    /// As [`encode_parts`].
    pub(crate) fn encode(&self, glyph: &StoredGlyph) -> Result<Vec<u8>, Damage> {
        self.with_known(|known| encode_parts(glyph, known))
    }

    /// Decodes the composed glyph.
    ///
    /// # Errors
    ///
    /// As [`decode_parts`].
    pub(crate) fn decode(&self, message: &[u8], sizes: usize) -> Result<StoredGlyph, Damage> {
        self.with_known(|known| decode_parts(message, known, sizes))
    }

    fn with_known<T>(&self, f: impl FnOnce(&KnownGlyph<'_>) -> T) -> T {
        let parts = self.parts.as_deref().map(plain_parts);
        let outline_hash = || self.outline_hash;
        f(&KnownGlyph { parts: parts.as_deref(), advance: self.advance, outline_hash: &outline_hash })
    }
}
