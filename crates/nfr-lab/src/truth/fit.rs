//! The rule that finds the size of the type for a size of the box.

use nfr_convert::error::Error;

/// Dots per inch at which a point is a pixel.
const POINTS_PER_INCH: u32 = 72;

/// The whole pixels per em of a point size at a resolution in dpi, rounded twice as FreeType does: to 1/64 pixel, and
/// then to a whole number. `u16::MAX` stands for everything larger.
pub(super) fn whole_ppem(point_size: u32, resolution: u32) -> u16 {
    let scaled = (u64::from(point_size) * 64 * u64::from(resolution) + 36) / u64::from(POINTS_PER_INCH);
    u16::try_from((scaled + 32) >> 6).unwrap_or(u16::MAX)
}

/// The point size and the resolution of the rule; `fits` tells whether the glyphs fit at so many pixels per em. The
/// point size rises first, at 72 dpi, and then the resolution, each up to the last value before the first that does
/// not fit. `None` if nothing fits at all.
pub(super) fn search(mut fits: impl FnMut(u16) -> Result<bool, Error>) -> Result<Option<(u32, u32)>, Error> {
    let mut point_size = 0;
    while fits(whole_ppem(point_size + 1, POINTS_PER_INCH))? {
        point_size += 1;
    }
    if point_size == 0 {
        return Ok(None);
    }
    let mut resolution = POINTS_PER_INCH;
    while fits(whole_ppem(point_size, resolution + 1))? {
        resolution += 1;
    }
    Ok(Some((point_size, resolution)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn pixels_per_em_are_rounded_as_freetype_does() {
        // 10 · 75 / 72 = 10.42, 10 · 76 / 72 = 10.56, 36 · 73 / 72 = 36.5.
        let pairs = [(10, 72), (10, 75), (10, 76), (36, 73)];
        assert_eq!(pairs.map(|(size, resolution)| whole_ppem(size, resolution)), [10, 10, 11, 37]);
    }

    #[test]
    fn the_resolution_rises_until_its_rounding_reaches_the_next_size() {
        // 20 · 73 / 72 = 20.28 still is 20; 20 · 74 / 72 = 20.56 is 21.
        assert_eq!(search(|ppem| Ok(ppem <= 20)).unwrap(), Some((20, 73)));
    }

    #[test]
    fn the_first_size_that_does_not_fit_ends_the_search_even_if_a_larger_one_fits() {
        // 2 · 89 / 72 = 2.47 is 2, 2 · 90 / 72 = 2.5 is 3.
        assert_eq!(search(|ppem| Ok(ppem != 3 && ppem < 9)).unwrap(), Some((2, 89)));
    }

    #[test]
    fn nothing_may_fit() {
        assert_eq!(search(|_| Ok(false)).unwrap(), None);
    }
}
