//! Removing the hint programs of the glyphs from `glyf`, and the `loca` that goes with the result
//! (OpenType 1.9, "glyf" and "loca").
//!
//! The glyphs are copied as bytes, never decoded and written anew: what an outline is made of stays
//! byte-identical. Their layout is followed only to find where the program and the data end.

use std::collections::BTreeSet;
use std::ops::Range;

use read_fonts::FontData;
use read_fonts::tables::glyf::{CompositeGlyphFlags as Component, SimpleGlyphFlags as Point};
use read_fonts::types::{FixedSize, Scalar};

use crate::error::Error;

/// numberOfContours and the bounding box, five 16-bit numbers.
const HEADER_BYTES: usize = 10;

/// The last offset that the short `loca` format can hold: a 16-bit number that counts pairs of bytes.
const MAX_SHORT_OFFSET: usize = 2 * u16::MAX as usize;
/// The short format can only point at even offsets.
const SHORT_ALIGNMENT: usize = 2;
/// "The local offsets should be 32-bit aligned" (OpenType 1.9, "loca", long format).
const LONG_ALIGNMENT: usize = 4;

/// The outlines of a font without hint programs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stripped {
    /// The `glyf` table.
    pub glyf: Vec<u8>,
    /// The `loca` table, with one offset more than there are glyphs.
    pub loca: Vec<u8>,
    /// Whether `loca` has 32-bit offsets: `head.indexToLocFormat` is 1 for them, 0 for 16-bit ones.
    pub long_offsets: bool,
    /// Bytes of the programs that were removed, without the fields that said how long they were.
    pub program_bytes: usize,
}

impl Stripped {
    /// The outlines with some glyphs left empty. Only `glyf`, `loca` and its format change.
    ///
    /// # Errors
    ///
    /// `Malformed` if `loca` does not match `glyf` or the number of glyphs.
    pub fn without(&self, dropped: &BTreeSet<u16>, num_glyphs: u16) -> Result<Self, Error> {
        let mut outlines = Vec::with_capacity(self.glyf.len());
        let mut ends = Vec::with_capacity(usize::from(num_glyphs));
        let ranges = glyph_ranges(&self.loca, self.long_offsets, num_glyphs)?;
        for (gid, range) in (0..num_glyphs).zip(ranges) {
            if !dropped.contains(&gid) {
                let outline = self.glyf.get(range);
                outlines.extend_from_slice(outline.ok_or_else(|| {
                    Error::Malformed(format!("'loca' puts glyph {gid} outside 'glyf'; repair the font"))
                })?);
            }
            ends.push(outlines.len());
        }
        let (mut glyf, loca, long_offsets) = pack(&outlines, &ends);
        // Some programs take a table without bytes for a missing one.
        if glyf.is_empty() {
            glyf.push(0);
        }
        Ok(Self { glyf, loca, long_offsets, program_bytes: self.program_bytes })
    }
}

/// Removes the programs of all glyphs. `long_offsets` is the format of the `loca` passed in; that of the
/// result is the short one wherever the outlines fit it.
///
/// # Errors
///
/// `Malformed`, naming the glyph, if `loca` points outside `glyf` or backwards, or if a glyph's data end
/// before the glyph does.
pub fn strip(glyf: &[u8], loca: &[u8], long_offsets: bool, num_glyphs: u16) -> Result<Stripped, Error> {
    let mut program_bytes = 0;
    let mut outlines = Vec::with_capacity(glyf.len());
    let mut ends = Vec::with_capacity(usize::from(num_glyphs));
    for (gid, range) in glyph_ranges(loca, long_offsets, num_glyphs)?.into_iter().enumerate() {
        let (start, end) = (range.start, range.end);
        let data = glyf.get(range).ok_or_else(|| {
            let size = glyf.len();
            Error::Malformed(format!(
                "'loca' puts glyph {gid} at bytes {start} to {end} of 'glyf', which has {size}; repair the font"
            ))
        })?;
        program_bytes += strip_glyph(data, &mut outlines).map_err(|part| {
            let size = data.len();
            Error::Malformed(format!(
                "the {size} bytes of glyph {gid} in 'glyf' end inside its {part}; repair the font"
            ))
        })?;
        ends.push(outlines.len());
    }
    let (glyf, loca, long_offsets) = pack(&outlines, &ends);
    Ok(Stripped { glyf, loca, long_offsets, program_bytes })
}

/// The range of each glyph in `glyf`, from `loca`. The ranges are not checked against each other or the table.
fn glyph_ranges(loca: &[u8], long_offsets: bool, num_glyphs: u16) -> Result<Vec<Range<usize>>, Error> {
    let entries = usize::from(num_glyphs) + 1;
    let width = if long_offsets { 4 } else { 2 };
    let offsets: Vec<usize> = loca
        .chunks_exact(width)
        .take(entries)
        .map(|bytes| bytes.iter().fold(0, |value, &byte| value << 8 | usize::from(byte)))
        .map(|offset| if long_offsets { offset } else { offset * 2 })
        .collect();
    if offsets.len() < entries {
        return Err(Error::Malformed(format!(
            "'loca' has offsets for {} glyphs, but 'maxp' counts {num_glyphs}; repair the font",
            offsets.len().saturating_sub(1)
        )));
    }
    Ok(offsets.windows(2).map(|pair| pair[0]..pair[1]).collect())
}

/// Lays the glyphs out for `loca`: the padded `glyf`, the `loca`, and whether its offsets are long.
/// `ends` says where each glyph ends in `outlines`.
fn pack(outlines: &[u8], ends: &[usize]) -> (Vec<u8>, Vec<u8>, bool) {
    let starts = || std::iter::once(0).chain(ends.iter().copied());
    let lengths = || starts().zip(ends).map(|(start, end)| end - start);
    let short_size: usize = lengths().map(|length| length.next_multiple_of(SHORT_ALIGNMENT)).sum();
    let long_offsets = short_size > MAX_SHORT_OFFSET;
    let alignment = if long_offsets { LONG_ALIGNMENT } else { SHORT_ALIGNMENT };

    let mut glyf = Vec::with_capacity(outlines.len() + ends.len() * (alignment - 1));
    let mut loca = Vec::new();
    let mut push_offset = |offset: usize| {
        if long_offsets {
            loca.extend((offset as u32).to_be_bytes());
        } else {
            loca.extend(((offset / 2) as u16).to_be_bytes());
        }
    };
    push_offset(0);
    for (start, &end) in starts().zip(ends) {
        glyf.extend_from_slice(&outlines[start..end]);
        glyf.resize(glyf.len().next_multiple_of(alignment), 0);
        push_offset(glyf.len());
    }
    (glyf, loca, long_offsets)
}

/// The part of a glyph that its data end in.
type Cut = &'static str;

/// Appends one glyph without its program, and without padding; says how many bytes the program had.
fn strip_glyph(data: &[u8], out: &mut Vec<u8>) -> Result<usize, Cut> {
    if data.is_empty() {
        return Ok(0);
    }
    let mut reader = Reader { data: FontData::new(data), at: 0 };
    let contours: i16 = reader.read("header")?;
    reader.skip(HEADER_BYTES - i16::RAW_BYTE_LEN, "header")?;
    match usize::try_from(contours) {
        Err(_) => strip_composite(reader, out),
        Ok(0) => Ok(strip_empty(data, out)),
        Ok(contours) => strip_simple(reader, contours, out),
    }
}

/// A glyph without contours: nothing has to follow the header, and what does means nothing. A program
/// length of 0 is kept where there was one, as some readers ask for it.
fn strip_empty(data: &[u8], out: &mut Vec<u8>) -> usize {
    let (header, rest) = data.split_at(HEADER_BYTES);
    out.extend_from_slice(header);
    let Some((length, rest)) = rest.split_first_chunk() else {
        return 0;
    };
    out.extend([0; u16::RAW_BYTE_LEN]);
    usize::from(u16::from_be_bytes(*length)).min(rest.len())
}

fn strip_simple(mut reader: Reader<'_>, contours: usize, out: &mut Vec<u8>) -> Result<usize, Cut> {
    reader.skip((contours - 1) * u16::RAW_BYTE_LEN, "contour ends")?;
    let last_point: u16 = reader.read("contour ends")?;
    let before = reader.passed();
    let program = reader.read::<u16>("program length")?;
    reader.skip(usize::from(program), "program")?;

    let points_at = reader.at;
    let mut coordinate_bytes = 0;
    let mut points_left = usize::from(last_point) + 1;
    while points_left > 0 {
        let flags: Point = reader.read("flags")?;
        let repeats = if flags.contains(Point::REPEAT_FLAG) { reader.read::<u8>("flags")? } else { 0 };
        // A count beyond the last point is cut there, as FreeType does.
        let points = points_left.min(1 + usize::from(repeats));
        coordinate_bytes += points
            * coordinate_size(flags, Point::X_SHORT_VECTOR, Point::X_IS_SAME_OR_POSITIVE_X_SHORT_VECTOR);
        coordinate_bytes += points
            * coordinate_size(flags, Point::Y_SHORT_VECTOR, Point::Y_IS_SAME_OR_POSITIVE_Y_SHORT_VECTOR);
        points_left -= points;
    }
    reader.skip(coordinate_bytes, "coordinates")?;

    out.extend_from_slice(before);
    out.extend([0; u16::RAW_BYTE_LEN]);
    out.extend_from_slice(&reader.passed()[points_at..]);
    Ok(usize::from(program))
}

/// The bytes that one coordinate of a point takes.
fn coordinate_size(flags: Point, short: Point, same: Point) -> usize {
    match (flags.contains(short), flags.contains(same)) {
        (true, _) => 1,
        (false, true) => 0,
        (false, false) => 2,
    }
}

fn strip_composite(mut reader: Reader<'_>, out: &mut Vec<u8>) -> Result<usize, Cut> {
    out.extend_from_slice(reader.passed());
    let mut has_program = false;
    loop {
        let bits: u16 = reader.read("components")?;
        let body_at = reader.at;
        let flags = Component::from_bits_truncate(bits);
        reader.skip(component_size(flags), "components")?;
        // The bits and not the flags, so that reserved ones stay.
        out.extend((bits & !Component::WE_HAVE_INSTRUCTIONS.bits()).to_be_bytes());
        out.extend_from_slice(&reader.passed()[body_at..]);
        has_program |= flags.contains(Component::WE_HAVE_INSTRUCTIONS);
        if !flags.contains(Component::MORE_COMPONENTS) {
            break;
        }
    }
    if !has_program {
        return Ok(0);
    }
    let program = reader.read::<u16>("program length")?;
    reader.skip(usize::from(program), "program")?;
    Ok(usize::from(program))
}

/// The bytes of a component behind its flags: glyph, two arguments, transform.
pub(crate) fn component_size(flags: Component) -> usize {
    // OpenType 1.9 reserves this bit, but skrifa reads it.
    let glyph = if flags.contains(Component::GID_IS_24_BIT) { 3 } else { 2 };
    let arguments = if flags.contains(Component::ARG_1_AND_2_ARE_WORDS) { 4 } else { 2 };
    // At most one of these may be set; readers look at them in this order.
    let transform = if flags.contains(Component::WE_HAVE_A_SCALE) {
        2
    } else if flags.contains(Component::WE_HAVE_AN_X_AND_Y_SCALE) {
        4
    } else if flags.contains(Component::WE_HAVE_A_TWO_BY_TWO) {
        8
    } else {
        0
    };
    glyph + arguments + transform
}

/// Walks through a glyph's data and stops at their end.
struct Reader<'a> {
    data: FontData<'a>,
    at: usize,
}

impl<'a> Reader<'a> {
    fn read<T: Scalar>(&mut self, part: Cut) -> Result<T, Cut> {
        let value = self.data.read_at(self.at).map_err(|_| part)?;
        self.at += T::RAW_BYTE_LEN;
        Ok(value)
    }

    fn skip(&mut self, bytes: usize, part: Cut) -> Result<(), Cut> {
        if bytes > self.data.len() - self.at {
            return Err(part);
        }
        self.at += bytes;
        Ok(())
    }

    /// The bytes that have been read.
    fn passed(&self) -> &'a [u8] {
        &self.data.as_bytes()[..self.at]
    }
}
