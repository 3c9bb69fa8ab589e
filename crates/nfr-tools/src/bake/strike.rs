//! Glyphs at one size, as bitmap formats store them.

use nfr::{LineMetrics, Placement};

/// Glyphs at one size.
#[derive(Debug)]
pub(super) struct Strike {
    pub(super) ppem: u16,
    /// Bits a pixel: 1, 2, 4 or 8.
    pub(super) bits: u8,
    pub(super) line: LineMetrics,
    /// Ascending by glyph number.
    pub(super) glyphs: Vec<Glyph>,
}

/// A glyph at one size.
#[derive(Debug)]
pub(super) struct Glyph {
    pub(super) gid: u16,
    /// The smallest box around the pixels that are not blank; empty if none are.
    pub(super) place: Placement,
    /// A level for each pixel of the box, top row first: 0 is blank, 2^bits - 1 is black.
    pub(super) levels: Vec<u8>,
    /// In pixels, linear in the size.
    pub(super) advance: f32,
    /// In pixels, a whole number at the sizes that the models were trained for.
    pub(super) hinted_advance: f32,
}

/// Rounds a coverage to the nearest level of so many bits.
fn level(coverage: u8, bits: u8) -> u8 {
    let max = (1u16 << bits) - 1;
    ((u16::from(coverage) * max + 127) / 255) as u8
}

impl Glyph {
    /// Rounds a bitmap's coverages to levels, and cuts off the rows and columns at its edges that are blank then.
    pub(super) fn new(gid: u16, place: Placement, coverage: &[u8], bits: u8) -> Self {
        let levels: Vec<u8> = coverage.iter().map(|value| level(*value, bits)).collect();
        let (place, levels) = trimmed(place, &levels);
        Self { gid, place, levels, advance: 0.0, hinted_advance: 0.0 }
    }

    /// The hinted advance width in whole pixels.
    pub(super) fn whole_advance(&self) -> i32 {
        self.hinted_advance.round() as i32
    }

    /// From the baseline up to the bottom edge: negative below it.
    pub(super) fn bottom(&self) -> i32 {
        self.place.top - self.place.height as i32
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &[u8]> {
        self.levels.chunks_exact(self.place.width.max(1) as usize)
    }
}

/// The part of a bitmap that is not blank.
fn trimmed(place: Placement, levels: &[u8]) -> (Placement, Vec<u8>) {
    let width = (place.width as usize).max(1);
    let is_blank = |row: &&[u8]| row.iter().all(|level| *level == 0);
    let above = levels.chunks_exact(width).take_while(is_blank).count();
    let below = levels.chunks_exact(width).rev().take_while(is_blank).count();
    let rows: Vec<&[u8]> = levels
        .chunks_exact(width)
        .skip(above)
        .take((place.height as usize).saturating_sub(above + below))
        .collect();
    let blanks = |row: &&[u8]| row.iter().take_while(|level| **level == 0).count();
    let blanks_right = |row: &&[u8]| row.iter().rev().take_while(|level| **level == 0).count();
    let (Some(before), Some(after)) = (rows.iter().map(blanks).min(), rows.iter().map(blanks_right).min())
    else {
        return (Placement::default(), Vec::new());
    };
    let levels: Vec<u8> = rows.iter().flat_map(|row| &row[before..width - after]).copied().collect();
    let place = Placement {
        left: place.left + before as i32,
        top: place.top - above as i32,
        width: (width - before - after) as u32,
        height: rows.len() as u32,
    };
    (place, levels)
}

/// Packs levels, the first in the highest bits. The last byte is filled with zeros.
pub(super) fn packed(levels: &[u8], bits: u8) -> Vec<u8> {
    let pixels = usize::from(8 / bits);
    let byte = |chunk: &[u8]| {
        let byte = chunk.iter().fold(0u16, |byte, level| byte << bits | u16::from(*level));
        (byte << (usize::from(bits) * (pixels - chunk.len()))) as u8
    };
    levels.chunks(pixels).map(byte).collect()
}

impl Strike {
    /// How far a line reaches above and below the baseline, in whole pixels, the second downwards.
    pub(super) fn line_extent(&self) -> (i32, i32) {
        (self.line.ascent.round() as i32, -self.line.descent.round() as i32)
    }

    /// The smallest box around all glyphs, with their origins together.
    pub(super) fn bounds(&self) -> Placement {
        let boxes = self.glyphs.iter().map(|glyph| glyph.place);
        boxes.fold(Placement::default(), nfr::internals::union)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverages_are_rounded_to_the_nearest_level() {
        assert!((0..=255).all(|value| level(value, 8) == value));
        assert_eq!([0, 127, 128, 255].map(|value| level(value, 1)), [0, 0, 1, 1]);
        assert_eq!([42, 43, 127, 128, 212, 213].map(|value| level(value, 2)), [0, 1, 1, 2, 2, 3]);
        for bits in [1, 2, 4] {
            let step = 255.0 / f64::from((1u16 << bits) - 1);
            for value in 0..=255u8 {
                let error = f64::from(value) - f64::from(level(value, bits)) * step;
                assert!(error.abs() <= step / 2.0, "{value} at {bits} bits");
            }
        }
    }

    #[test]
    fn blank_edges_are_cut_off_and_the_placement_follows() {
        let place = Placement { left: -1, top: 3, width: 4, height: 4 };
        let coverage = [0, 0, 0, 0, 0, 100, 0, 0, 0, 0, 255, 0, 0, 0, 127, 0];
        let glyph = Glyph::new(7, place, &coverage, 4);
        assert_eq!(glyph.place, Placement { left: 0, top: 2, width: 2, height: 3 });
        assert_eq!(glyph.levels, [6, 0, 0, 15, 0, 7]);
        // At 1 bit only one pixel is left.
        let glyph = Glyph::new(7, place, &coverage, 1);
        assert_eq!(
            (glyph.place, glyph.levels),
            (Placement { left: 1, top: 1, width: 1, height: 1 }, vec![1])
        );
        let blank = Glyph::new(7, place, &[0; 16], 8);
        assert_eq!((blank.place, blank.levels.len()), (Placement::default(), 0));
        assert_eq!(Glyph::new(7, Placement::default(), &[], 8).place, Placement::default());
    }

    #[test]
    fn levels_are_packed_from_the_highest_bits() {
        assert_eq!(packed(&[1, 0, 1, 1, 0, 0, 0, 0, 1], 1), [0b1011_0000, 0b1000_0000]);
        assert_eq!(packed(&[3, 0, 1, 2, 1], 2), [0b1100_0110, 0b0100_0000]);
        assert_eq!(packed(&[15, 1, 2], 4), [0xf1, 0x20]);
        assert_eq!(packed(&[255, 1], 8), [255, 1]);
        assert!(packed(&[], 4).is_empty());
    }
}
