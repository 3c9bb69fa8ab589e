//! Glyphs at their places in a picture, black on white.

use std::error::Error;
use std::ops::Range;

use image::{GrayImage, Luma};
use nfr::Placement;

/// No picture has more pixels.
const MAX_PIXELS: usize = 64_000_000;

/// White paper.
pub(crate) fn blank(width: usize, height: usize) -> Result<GrayImage, Box<dyn Error>> {
    if width.saturating_mul(height) > MAX_PIXELS {
        return Err(format!(
            "the picture would have {width}×{height} pixels; choose fewer sizes or less text"
        )
        .into());
    }
    Ok(GrayImage::from_pixel(width.try_into()?, height.try_into()?, Luma([255])))
}

/// A position in whole pixels, and the subpixel offset in quarters of one.
pub(crate) fn split_position(units: i32, ppem: u16, units_per_em: i32) -> (i64, f32) {
    let pixels = f64::from(units) * f64::from(ppem) / f64::from(units_per_em);
    let quarters = (pixels * 4.0).round() as i64;
    (quarters.div_euclid(4), quarters.rem_euclid(4) as f32 / 4.0)
}

/// Blends a glyph into the picture, within these columns: where two glyphs overlap, the light that the first lets through
/// meets the second.
pub(crate) fn blend(
    picture: &mut GrayImage,
    [x, y]: [i64; 2],
    place: &Placement,
    coverage: &[u8],
    columns: &Range<i64>,
    darkness: u8,
) {
    let (left, top) = (x + i64::from(place.left), y - i64::from(place.top));
    for (y, row) in (top..).zip(coverage.chunks_exact(place.width.max(1) as usize)) {
        for (x, &coverage) in (left..).zip(row).filter(|(x, _)| columns.contains(x)) {
            let at = u32::try_from(x).ok().zip(u32::try_from(y).ok());
            if let Some(pixel) = at.and_then(|(x, y)| picture.get_pixel_mut_checked(x, y)) {
                pixel.0[0] = product(pixel.0[0], 255 - product(coverage, darkness));
            }
        }
    }
}

/// Two shares of 255, multiplied and rounded.
fn product(a: u8, b: u8) -> u8 {
    // At most 255.
    ((u16::from(a) * u16::from(b) + 127) / 255) as u8
}
