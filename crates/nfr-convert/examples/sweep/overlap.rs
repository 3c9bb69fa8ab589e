//! A copy of a face without the flags that say that contours overlap.
//!
//! FreeType draws a glyph with such a flag from 4×4 samples a pixel, so that no seam shows where contours meet; others by exact areas, as nfr and
//! zeno do. What is compared here is hinting, so FreeType is given the copy.

use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};

/// `OVERLAP_SIMPLE`, in the flags of a glyph's first point (OpenType 1.9, "glyf").
const OVERLAP_SIMPLE: u8 = 0x40;
/// `OVERLAP_COMPOUND`, in the high byte of the flags of a composite glyph's first component.
const OVERLAP_COMPOUND: u8 = 0x04;

/// The copy, and how many glyphs had the flag.
pub(crate) fn without_flags(font: &FontRef<'_>, data: &[u8]) -> (Vec<u8>, usize) {
    let (mut copy, mut flagged) = (data.to_vec(), 0);
    let records = font.table_directory().table_records();
    let glyf = records.iter().find(|record| record.tag() == Tag::new(b"glyf"));
    let (Some(glyf), Ok(loca), Ok(maxp)) = (glyf, font.loca(None), font.maxp()) else { return (copy, 0) };
    for glyph in 0..usize::from(maxp.num_glyphs()) {
        let (Some(start), Some(end)) = (loca.get_raw(glyph), loca.get_raw(glyph + 1)) else { continue };
        let at = glyf.offset() as usize;
        if let Some(glyph) = copy.get_mut(at + start as usize..at + end as usize) {
            flagged += usize::from(clear(glyph).unwrap_or(false));
        }
    }
    (copy, flagged)
}

/// Clears the flag of one glyph, and says whether it was set. None if the glyph is blank or damaged.
fn clear(glyph: &mut [u8]) -> Option<bool> {
    let word = |at: usize| Some(u16::from_be_bytes([*glyph.get(at)?, *glyph.get(at + 1)?]));
    let contours = word(0)? as i16;
    let (at, flag) = if contours < 0 {
        (10, OVERLAP_COMPOUND)
    } else {
        let programs = 10 + 2 * usize::from(contours.unsigned_abs());
        (programs + 2 + usize::from(word(programs)?), OVERLAP_SIMPLE)
    };
    let flags = glyph.get_mut(at)?;
    let was_set = *flags & flag != 0;
    *flags &= !flag;
    Some(was_set)
}

#[cfg(test)]
mod tests {
    use super::clear;

    #[test]
    fn the_flag_of_a_simple_glyph_is_behind_its_program() {
        // One contour of one point, a program of two bytes.
        let mut glyph = [0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0x4f, 0x40, 0x41];
        assert_eq!(clear(&mut glyph), Some(true));
        assert_eq!(glyph[14..], [0x4f, 0x40, 0x01]);
        assert_eq!(clear(&mut glyph), Some(false));
    }

    #[test]
    fn the_flag_of_a_composite_glyph_is_in_its_first_component() {
        let mut glyph = [0xff, 0xff, 0, 0, 0, 0, 0, 0, 0, 0, 0x04, 0x26, 0, 3];
        assert_eq!(clear(&mut glyph), Some(true));
        assert_eq!(glyph[10..12], [0, 0x26]);
    }

    #[test]
    fn a_damaged_glyph_is_left_as_it_is() {
        assert_eq!(clear(&mut []), None);
        assert_eq!(clear(&mut [0, 9, 0, 0, 0, 0, 0, 0, 0, 0]), None);
    }
}
