//! A glyph's outline as the font stores it.

use nfr::internals::model::outline::OutlinePoints;
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
    let advance = font.glyph_metrics().h_advance(gid.into()).clamp(0.0, f32::from(u16::MAX)) as u16;
    Ok((points, advance))
}
