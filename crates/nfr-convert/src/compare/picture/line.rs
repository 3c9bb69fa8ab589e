//! Glyphs side by side, as one bitmap.

use super::raster::enclosing;
use crate::compare::source::SizedSource;
use crate::error::Error;
use nfr::Bitmap;

/// Pixels between the glyphs of a specimen.
const SPECIMEN_GAP: i64 = 2;

/// A line of text: each glyph with its origin at the sum of the advances before it, in pixels, rounded to a whole one. No
/// kerning.
///
/// # Errors
///
/// As the source's.
pub fn text_line(
    source: &mut dyn SizedSource,
    gids: &[u16],
    advance: impl Fn(u16) -> f32,
) -> Result<Bitmap, Error> {
    let mut x = 0.0f64;
    let mut glyphs = Vec::with_capacity(gids.len());
    for &gid in gids {
        glyphs.push(moved(source.bitmap(gid)?, x.round() as i64));
        x += f64::from(advance(gid));
    }
    Ok(joined(&glyphs))
}

/// Glyphs in lines of at most about `max_width` pixels, kept apart even where their advances overlap.
///
/// # Errors
///
/// As the source's.
pub fn specimen(
    source: &mut dyn SizedSource,
    gids: &[u16],
    advance: impl Fn(u16) -> f32,
    max_width: i64,
) -> Result<Vec<Bitmap>, Error> {
    let (mut lines, mut line, mut x) = (Vec::new(), Vec::new(), 0);
    for &gid in gids {
        let bitmap = source.bitmap(gid)?;
        let left = i64::from(bitmap.placement.left).min(0);
        let right = i64::from(bitmap.placement.left) + i64::from(bitmap.placement.width);
        let width = right.max(advance(gid).round() as i64) - left + SPECIMEN_GAP;
        if x + width > max_width && !line.is_empty() {
            lines.push(joined(&line));
            (line, x) = (Vec::new(), 0);
        }
        line.push(moved(bitmap, x - left));
        x += width;
    }
    lines.push(joined(&line));
    Ok(lines)
}

fn moved(mut bitmap: Bitmap, right: i64) -> Bitmap {
    let left = i64::from(bitmap.placement.left) + right;
    bitmap.placement.left = left.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
    bitmap
}

/// One bitmap of several. Where they overlap, coverage adds up.
fn joined(bitmaps: &[Bitmap]) -> Bitmap {
    let placement = enclosing(bitmaps);
    let mut pixels = vec![0u8; placement.area()];
    for bitmap in bitmaps.iter().filter(|bitmap| bitmap.placement.area() > 0) {
        let place = bitmap.placement;
        let (column, row) = ((place.left - placement.left) as usize, (placement.top - place.top) as usize);
        let rows = pixels.chunks_exact_mut(placement.width as usize).skip(row);
        for (target, source) in rows.zip(bitmap.pixels.chunks_exact(place.width as usize)) {
            for (target, source) in target[column..].iter_mut().zip(source) {
                *target = target.saturating_add(*source);
            }
        }
    }
    Bitmap { placement, pixels }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use nfr::Placement;

    /// Every glyph is one pixel as dark as its number.
    struct Dots;

    impl SizedSource for Dots {
        fn bitmap(&mut self, gid: u16) -> Result<Bitmap, Error> {
            let placement = Placement { left: 0, top: 1, width: 1, height: 1 };
            Ok(Bitmap { placement, pixels: vec![gid as u8] })
        }
    }

    #[test]
    fn advances_add_up_exactly_and_glyphs_stand_on_whole_pixels() {
        let line = text_line(&mut Dots, &[1, 2, 3], |_| 1.4).unwrap();
        assert_eq!(line.pixels, [1, 2, 0, 3]);
    }

    #[test]
    fn coverage_adds_up_where_glyphs_overlap() {
        assert_eq!(text_line(&mut Dots, &[200, 50, 60], |_| 0.0).unwrap().pixels, [255]);
    }

    #[test]
    fn a_specimen_breaks_its_lines_and_keeps_glyphs_apart() {
        let lines = specimen(&mut Dots, &[1, 2, 3], |_| 0.0, 6).unwrap();
        let pixels: Vec<_> = lines.iter().map(|line| line.pixels.as_slice()).collect();
        assert_eq!(pixels, [[1, 0, 0, 2].as_slice(), &[3]]);
    }
}
