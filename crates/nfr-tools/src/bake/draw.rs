//! Drawing the glyphs of a strike.

use nfr::{Font, Limits, MissingModel, MonoBitmapRef, Placement, Rasterizer};

use super::face::Face;
use super::strike::{Glyph, Strike};
use crate::failure::Failure;

/// The most glyphs without models that one message lists.
const LISTED: usize = 5;

/// Draws the glyphs of a face at a size, with so many bits a pixel.
///
/// # Errors
///
/// A glyph without a model if that is an error, and what the library cannot draw.
pub(super) fn draw(
    font: &Font,
    face: &Face,
    ppem: u16,
    bits: u8,
    missing: MissingModel,
) -> Result<Strike, Failure> {
    // A tool need not answer at once: one of the paper's networks may take its time.
    let mut limits = Limits::default();
    (limits.decoded_bytes, limits.work) = (1 << 30, u64::MAX);
    let mut rasterizer = Rasterizer::new(font).with_limits(limits).with_missing_model(missing);
    let size = f32::from(ppem);
    let mut glyphs = Vec::with_capacity(face.gids.len());
    for &gid in &face.gids {
        let mut glyph = if bits == 1 {
            let drawn = rasterizer.draw_mono(gid.into(), size)?;
            Glyph::new(gid, drawn.placement, &unpacked(drawn), bits)
        } else {
            let drawn = rasterizer.draw(gid.into(), size)?;
            Glyph::new(gid, drawn.placement, drawn.pixels, bits)
        };
        glyph.advance = font.advance(gid.into(), size);
        glyph.hinted_advance = rasterizer.hinted_advance(gid.into(), size)?;
        glyphs.push(glyph);
    }
    Ok(Strike { ppem, bits, line: font.line_metrics(size), glyphs })
}

/// A byte a pixel: 255 where it is black.
fn unpacked(bitmap: MonoBitmapRef<'_>) -> Vec<u8> {
    let Placement { width, height, .. } = bitmap.placement;
    let level = |x, y| if bitmap.is_black(x, y) { 255 } else { 0 };
    (0..height).flat_map(|y| (0..width).map(move |x| level(x, y))).collect()
}

/// Checks that all glyphs have models.
///
/// # Errors
///
/// The glyphs that have none, by name.
pub(super) fn check_models(font: &Font, face: &Face) -> Result<(), Failure> {
    let without: Vec<u16> = face.gids.iter().copied().filter(|gid| !font.has_model((*gid).into())).collect();
    if without.is_empty() {
        return Ok(());
    }
    let listed: Vec<String> = without.iter().take(LISTED).map(|gid| face.title(*gid)).collect();
    let more = without.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let verb = if without.len() == 1 { "has no model" } else { "have no models" };
    Err(Failure::failed(format!(
        "{}{more} {verb} in this font; leave them out, convert them too, or pass --missing outline or --missing blank",
        listed.join(", ")
    )))
}

/// What to know of a size before it is used, if anything.
pub(super) fn size_warning(font: &Font, sizes: &[u16]) -> Option<String> {
    let (first, last) = font.ppem_range();
    let beyond: Vec<String> =
        sizes.iter().filter(|ppem| !(first..=last).contains(*ppem)).map(u16::to_string).collect();
    if beyond.is_empty() {
        return None;
    }
    Some(format!(
        "warning: {} ppem: the models were trained for {first}-{last} ppem; at other sizes glyphs are unhinted",
        beyond.join(", ")
    ))
}
