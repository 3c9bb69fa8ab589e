//! Bitmaps in a TrueType font: the tables EBLC, where they are, and EBDT, the bitmaps (OpenType 1.9, "EBLC" and "EBDT").

use nfr::Placement;

use super::face::Face;
use super::strike::{Glyph, Strike, packed};
use crate::failure::Failure;

/// Version 2.0 of both tables.
const VERSION: [u8; 4] = [0, 2, 0, 0];
const EBLC_HEADER: usize = 8;
const BITMAP_SIZE: usize = 48;
const INDEX_SUBTABLE_RECORD: usize = 8;
/// Offsets of 16 bits from the first bitmap of a subtable.
const INDEX_FORMAT: u16 = 3;
/// Metrics of 5 bytes for one direction, then the pixels without padding between rows.
const IMAGE_FORMAT: u16 = 2;
/// Metrics are for horizontal text.
const HORIZONTAL: u8 = 1;
/// A subtable goes on over a gap of so many glyphs: each takes 2 bytes there, and a new subtable takes 18 or 20.
const MAX_GAP: u16 = 8;

/// Both tables.
#[derive(Debug)]
pub(super) struct Tables {
    pub(super) eblc: Vec<u8>,
    pub(super) ebdt: Vec<u8>,
}

/// Neighbouring glyphs with a common subtable.
struct Run<'s> {
    glyphs: Vec<&'s Glyph>,
    /// Where their bitmaps begin in EBDT.
    at: usize,
    /// Where each bitmap begins after that, and where the last one ends.
    offsets: Vec<u16>,
}

/// Writes both tables. Every strike has to pass [`check`].
pub(super) fn tables(strikes: &[Strike]) -> Tables {
    let mut ebdt = VERSION.to_vec();
    let mut sizes = Vec::new();
    let mut indices = Vec::new();
    let indices_at = EBLC_HEADER + strikes.len() * BITMAP_SIZE;
    for strike in strikes {
        let runs = add_bitmaps(strike, &mut ebdt);
        let index = index(&runs);
        let numbers = [indices_at + indices.len(), index.len(), runs.len(), 0];
        sizes.extend(numbers.iter().flat_map(|number| (*number as u32).to_be_bytes()));
        sizes.extend(line_metrics(strike));
        // None for vertical text.
        sizes.extend([0; 12]);
        let ends = [strike.glyphs.first(), strike.glyphs.last()];
        sizes.extend(ends.iter().flatten().flat_map(|glyph| glyph.gid.to_be_bytes()));
        sizes.extend([strike.ppem as u8, strike.ppem as u8, strike.bits, HORIZONTAL]);
        indices.extend(index);
    }
    let count = (strikes.len() as u32).to_be_bytes();
    Tables { eblc: [&VERSION, &count[..], &sizes, &indices].concat(), ebdt }
}

/// Appends a strike's bitmaps to EBDT.
fn add_bitmaps<'s>(strike: &'s Strike, ebdt: &mut Vec<u8>) -> Vec<Run<'s>> {
    let mut runs: Vec<Run<'s>> = Vec::new();
    for glyph in &strike.glyphs {
        let image = image(glyph, strike.bits);
        let end = |run: &Run<'_>| u16::try_from(ebdt.len() + image.len() - run.at).ok();
        let gap = |run: &Run<'_>| run.glyphs.last().map_or(0, |last| glyph.gid - last.gid - 1);
        let open = runs.last_mut().and_then(|run| Some((end(run)?, gap(run), run)));
        match open {
            Some((end, gap, run)) if gap <= MAX_GAP => {
                // A glyph whose bitmap has no bytes has none.
                let here = (ebdt.len() - run.at) as u16;
                run.offsets.extend((0..gap).map(|_| here));
                run.offsets.push(end);
                run.glyphs.push(glyph);
            }
            _ => runs.push(Run { glyphs: vec![glyph], at: ebdt.len(), offsets: vec![0, image.len() as u16] }),
        }
        ebdt.extend(image);
    }
    runs
}

/// A glyph's metrics and pixels.
fn image(glyph: &Glyph, bits: u8) -> Vec<u8> {
    let Placement { left, top, height, .. } = glyph.place;
    let width = stored_width(glyph, bits);
    let mut image = vec![height as u8, width as u8, left as u8, top as u8, glyph.whole_advance() as u8];
    let blanks = vec![0; width - glyph.place.width as usize];
    let levels: Vec<u8> = glyph.rows().flat_map(|row| row.iter().chain(&blanks)).copied().collect();
    image.extend(packed(&levels, bits));
    image
}

/// The columns that are stored. FreeType (2.13, `tt_sbit_decoder_load_bitmap`) takes a bitmap whose length is that of rows of whole
/// bytes at 1 bit a pixel for one with padded rows, whatever the bits; one column more, which takes no byte, gives it the right rows.
fn stored_width(glyph: &Glyph, bits: u8) -> usize {
    let (width, height) = (glyph.place.width as usize, glyph.place.height as usize);
    let whole_bytes = height * width.div_ceil(8);
    let is_mistaken = (width * height * usize::from(bits)).div_ceil(8) == whole_bytes
        && (width * height).div_ceil(8) < whole_bytes
        && !(width * usize::from(bits)).is_multiple_of(8);
    width + usize::from(is_mistaken)
}

/// The list of a strike's subtables, and the subtables.
fn index(runs: &[Run<'_>]) -> Vec<u8> {
    let (mut list, mut subtables) = (Vec::new(), Vec::new());
    for run in runs {
        let ends = [run.glyphs.first(), run.glyphs.last()];
        list.extend(ends.iter().flatten().flat_map(|glyph| glyph.gid.to_be_bytes()));
        let at = runs.len() * INDEX_SUBTABLE_RECORD + subtables.len();
        list.extend((at as u32).to_be_bytes());
        subtables.extend([INDEX_FORMAT, IMAGE_FORMAT].iter().flat_map(|format| format.to_be_bytes()));
        subtables.extend((run.at as u32).to_be_bytes());
        subtables.extend(run.offsets.iter().flat_map(|offset| offset.to_be_bytes()));
        subtables.resize(subtables.len().next_multiple_of(4), 0);
    }
    [list, subtables].concat()
}

/// The extremes of a strike's glyphs (`sbitLineMetrics`). Blank glyphs have no extent.
fn line_metrics(strike: &Strike) -> [u8; 12] {
    let (ascent, descent) = strike.line_extent();
    let least = |value: fn(&Glyph) -> i32| {
        let inked = strike.glyphs.iter().filter(|glyph| glyph.place.area() > 0);
        inked.map(value).min().unwrap_or(0).clamp(i8::MIN.into(), i8::MAX.into()) as u8
    };
    let right = |glyph: &Glyph| glyph.whole_advance() - glyph.place.left - glyph.place.width as i32;
    let widest = strike.glyphs.iter().map(|glyph| stored_width(glyph, strike.bits)).max().unwrap_or(0);
    let caret = [1, 0, 0];
    let top = least(|glyph| -glyph.place.top);
    let [ascent, descent] = [ascent as u8, -descent as u8];
    let (left, bottom) = (least(|glyph| glyph.place.left), least(Glyph::bottom));
    [
        ascent,
        descent,
        widest as u8,
        caret[0],
        caret[1],
        caret[2],
        left,
        least(right),
        top.wrapping_neg(),
        bottom,
        0,
        0,
    ]
}

/// Checks that the tables can hold a strike: sizes, sides and advance widths up to 255 pixels, and -128 to 127 for where a bitmap begins.
///
/// # Errors
///
/// The first glyph that they cannot hold, with the size and the limit.
pub(super) fn check(strike: &Strike, face: &Face) -> Result<(), Failure> {
    let ppem = strike.ppem;
    let fits = |what: &str, value: i64, (least, most): (i64, i64)| {
        if (least..=most).contains(&value) {
            return Ok(());
        }
        Err(Failure::failed(format!(
            "{what} at {ppem} ppem is {value}, and EBLC holds {least} to {most}; choose smaller sizes, or another --format"
        )))
    };
    let (byte, signed) = ((0, 255), (-128, 127));
    fits("the size", ppem.into(), byte)?;
    for glyph in &strike.glyphs {
        let of_glyph = |what: &str| format!("the {what} of {}", face.title(glyph.gid));
        let Placement { left, top, height, .. } = glyph.place;
        fits(&of_glyph("width"), stored_width(glyph, strike.bits) as i64, byte)?;
        fits(&of_glyph("height"), height.into(), byte)?;
        fits(&of_glyph("left side bearing"), left.into(), signed)?;
        fits(&of_glyph("top"), top.into(), signed)?;
        fits(&of_glyph("advance width"), glyph.whole_advance().into(), byte)?;
    }
    let (ascent, descent) = strike.line_extent();
    fits("the ascent of a line", ascent.into(), signed)?;
    fits("the descent of a line", (-descent).into(), signed)
}

#[cfg(test)]
mod tests {
    use nfr::LineMetrics;

    use super::*;

    fn glyph(gid: u16, [left, top, width, height]: [i32; 4], advance: f32) -> Glyph {
        let place = Placement { left, top, width: width as u32, height: height as u32 };
        let mut glyph = Glyph::new(gid, place, &vec![255; place.area()], 8);
        glyph.hinted_advance = advance;
        glyph
    }

    fn strike(ppem: u16, bits: u8, glyphs: Vec<Glyph>) -> Strike {
        Strike { ppem, bits, line: LineMetrics::default(), glyphs }
    }

    #[test]
    fn what_a_byte_cannot_hold_is_named() {
        let check = |ppem: u16, place: [i32; 4], advance: f32| {
            check(&strike(ppem, 8, vec![glyph(7, place, advance)]), &Face::default())
                .map_err(|e| format!("{e:?}"))
        };
        assert_eq!(check(255, [-128, 127, 255, 255], 255.0), Ok(()));
        let cases = [
            (256, [0, 0, 1, 1], 1.0, "the size at 256 ppem is 256, and EBLC holds 0 to 255"),
            (20, [0, 0, 256, 1], 1.0, "the width of glyph 7 at 20 ppem is 256, and EBLC holds 0 to 255"),
            (20, [0, 0, 1, 256], 1.0, "the height of glyph 7 at 20 ppem is 256, and EBLC holds 0 to 255"),
            (
                20,
                [-129, 0, 1, 1],
                1.0,
                "the left side bearing of glyph 7 at 20 ppem is -129, and EBLC holds -128 to 127",
            ),
            (20, [0, 128, 1, 1], 1.0, "the top of glyph 7 at 20 ppem is 128, and EBLC holds -128 to 127"),
            (
                20,
                [0, 0, 1, 1],
                256.0,
                "the advance width of glyph 7 at 20 ppem is 256, and EBLC holds 0 to 255",
            ),
        ];
        for (ppem, place, advance, message) in cases {
            let error = check(ppem, place, advance).expect_err(message);
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn bitmaps_that_freetype_would_misread_get_a_column_more_that_takes_no_byte() {
        let bytes = |width: usize, bits: u8| (width * 2 * usize::from(bits)).div_ceil(8);
        for (width, bits, stored) in [(3, 2, 4), (3, 4, 3), (3, 1, 3), (4, 2, 4), (2, 4, 2)] {
            let glyph = glyph(7, [0, 2, width, 2], 4.0);
            assert_eq!(stored_width(&glyph, bits), stored, "{width} columns at {bits} bits");
            assert_eq!(bytes(width as usize, bits), bytes(stored, bits));
        }
    }

    #[test]
    fn subtables_end_at_wide_gaps_and_before_offsets_overflow() {
        let large = |gid: u16| glyph(gid, [0, 100, 200, 200], 200.0);
        let small = |gid: u16| glyph(gid, [0, 1, 1, 1], 1.0);
        let strike = strike(100, 8, vec![small(3), small(12), small(22), large(23), large(24)]);
        let mut ebdt = Vec::new();
        let runs = add_bitmaps(&strike, &mut ebdt);
        let gids = |run: &Run<'_>| run.glyphs.iter().map(|glyph| glyph.gid).collect::<Vec<_>>();
        assert_eq!(runs.iter().map(gids).collect::<Vec<_>>(), [vec![3, 12], vec![22, 23], vec![24]]);
        assert_eq!(runs[0].offsets, [0, 6, 6, 6, 6, 6, 6, 6, 6, 6, 12]);
        assert_eq!((runs[2].at, ebdt.len()), (12 + 6 + 40005, 12 + 6 + 2 * 40005));
        // Lists of subtables, each with as many offsets as glyphs and one more, in multiples of four bytes.
        assert_eq!(index(&runs).len(), 3 * 8 + (8 + 24) + (8 + 8) + (8 + 4));
    }
}
