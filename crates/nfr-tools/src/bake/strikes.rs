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
