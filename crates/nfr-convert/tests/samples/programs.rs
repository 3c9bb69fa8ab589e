//! The smallest fonts whose glyphs have programs: boxes and composites of them, written byte by byte (OpenType 1.9, "glyf").

use read_fonts::types::Tag;
use write_fonts::FontBuilder;

/// Units per em of the font.
pub(crate) const UNITS: u16 = 1024;

/// A box of 500 units with a program; its point 1 is the upper left corner.
pub(crate) fn box_glyph(program: &[u8]) -> Vec<u8> {
    let mut data = words(&[1, 0, 0, 500, 500, 3]);
    data.extend(words(&[program.len() as i16]));
    data.extend(program);
    // Four points on the curve with coordinates of two bytes.
    data.extend([1; 4]);
    data.extend(words(&[0, 0, 500, 0, 0, 500, 0, -500]));
    data
}

/// A composite of other glyphs, all in place, with a program.
pub(crate) fn composite_glyph(program: &[u8], components: &[u16]) -> Vec<u8> {
    let mut data = words(&[-1, 0, 0, 500, 500]);
    for (index, gid) in components.iter().enumerate() {
        // Arguments are words and offsets; more components; instructions.
        let more = if index + 1 < components.len() { 0x20 } else { 0x100 };
        data.extend(words(&[0x3 | more, *gid as i16, 0, 0]));
    }
    data.extend(words(&[program.len() as i16]));
    data.extend(program);
    data
}

/// A font of these glyphs after an empty `.notdef`, with two control values of 0 and a storage area of 8 cells. The line of
/// `OS/2` is 800 to -200 units, that of `hhea` 900 to -200.
pub(crate) fn font_of(glyphs: &[Vec<u8>], fpgm: &[u8]) -> Vec<u8> {
    let count = glyphs.len() as i16 + 1;
    let (mut glyf, mut loca) = (Vec::new(), vec![0u32, 0]);
    for glyph in glyphs {
        glyf.extend(glyph);
        glyf.resize(glyf.len().next_multiple_of(4), 0);
        loca.push(glyf.len() as u32);
    }
    let mut head = vec![0; 54];
    head[..4].copy_from_slice(&[0, 1, 0, 0]);
    head[12..16].copy_from_slice(&0x5F0F_3CF5u32.to_be_bytes());
    head[18..20].copy_from_slice(&UNITS.to_be_bytes());
    head[51] = 1;
    let hhea = words(&[1, 0, 900, -200, 0, 600, 0, 0, 500, 1, 0, 0, 0, 0, 0, 0, 0, 1]);
    let maxp = words(&[1, 0, count, 64, 16, 64, 16, 2, 16, 8, 8, 0, 16, 64, 8, 4]);
    let mut os2 = words(&[0; 39]);
    os2[68..72].copy_from_slice(&words(&[800, -200]));
    let mut hmtx = words(&[600, 0]);
    hmtx.extend(words(&vec![0; glyphs.len()]));
    let tables = [
        (b"head", head),
        (b"hhea", hhea),
        (b"maxp", maxp),
        (b"OS/2", os2),
        (b"hmtx", hmtx),
        (b"cvt ", words(&[0, 0])),
        (b"fpgm", fpgm.to_vec()),
        (b"loca", loca.iter().flat_map(|offset| offset.to_be_bytes()).collect()),
        (b"glyf", glyf),
    ];
    let mut builder = FontBuilder::new();
    for (tag, data) in tables {
        builder.add_raw(Tag::new(tag), data);
    }
    builder.build()
}

fn words(values: &[i16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}
