//! Character maps as people's fonts have them: which subtable answers, whatever others there are.

use nfr::Font;
use read_fonts::types::{GlyphId, Tag};
use read_fonts::{FontRef, model};
use write_fonts::FontBuilder;

use crate::samples::bytes;

/// A subtable: platform, encoding, and its bytes.
type Subtable = (u16, u16, Vec<u8>);

fn be16(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
}

/// Format 0: one byte for each of 256 codes.
fn bytes_map(map: &[(u8, u8)]) -> Vec<u8> {
    let mut glyphs = [0; 256];
    map.iter().for_each(|(code, glyph)| glyphs[usize::from(*code)] = *glyph);
    [be16(&[0, 262, 0]), glyphs.to_vec()].concat()
}

/// Format 4: a segment for each code; the last one ends the list.
fn segments(map: &[(u16, u16)]) -> Vec<u8> {
    let all: Vec<(u16, u16)> = map.iter().copied().chain([(0xffff, 0)]).collect();
    let count = all.len() as u16;
    let codes = be16(&all.iter().map(|(code, _)| *code).collect::<Vec<_>>());
    let deltas = be16(&all.iter().map(|(code, glyph)| glyph.wrapping_sub(*code)).collect::<Vec<_>>());
    let log = u16::BITS - 1 - count.leading_zeros();
    let search = 2 << log;
    let length = 16 + 8 * count;
    let head = be16(&[4, length, 0, 2 * count, search, log as u16, 2 * count - search]);
    [head, codes.clone(), vec![0, 0], codes, deltas, vec![0; 2 * usize::from(count)]].concat()
}

/// Format 12: a group for each code.
fn groups(map: &[(u32, u32)]) -> Vec<u8> {
    let mut bytes = be16(&[12, 0]);
    for number in [16 + 12 * map.len() as u32, 0, map.len() as u32] {
        bytes.extend(number.to_be_bytes());
    }
    for number in map.iter().flat_map(|(code, glyph)| [*code, *code, *glyph]) {
        bytes.extend(number.to_be_bytes());
    }
    bytes
}

/// Format 14: the variants of characters, each with a glyph of its own or without one: selector, character, glyph.
fn variants(map: &[(u32, u32, Option<u16>)]) -> Vec<u8> {
    let be24 = |number: u32| number.to_be_bytes()[1..].to_vec();
    let be32 = |number: usize| (number as u32).to_be_bytes().to_vec();
    let (mut records, mut lists) = (Vec::new(), Vec::new());
    for (selector, character, glyph) in map {
        let at = 10 + 11 * map.len() + lists.len();
        let [default, own] = if glyph.is_some() { [0, at] } else { [at, 0] };
        records.extend([be24(*selector), be32(default), be32(own)].concat());
        let glyph = glyph.map_or(vec![0], |glyph| glyph.to_be_bytes().to_vec());
        lists.extend([be32(1), be24(*character), glyph].concat());
    }
    [be16(&[14]), be32(10 + records.len() + lists.len()), be32(map.len()), records, lists].concat()
}

/// The vectors' font with another character map.
fn with_cmap(subtables: &[Subtable]) -> Font {
    let mut cmap = be16(&[0, subtables.len() as u16]);
    let mut offset = 4 + 8 * subtables.len();
    for (platform, encoding, bytes) in subtables {
        cmap.extend(be16(&[*platform, *encoding]));
        cmap.extend((offset as u32).to_be_bytes());
        offset += bytes.len();
    }
    subtables.iter().for_each(|(_, _, bytes)| cmap.extend(bytes));
    let data = bytes("sans");
    let mut builder = FontBuilder::new();
    builder.add_raw(Tag::new(b"cmap"), cmap).copy_missing_tables(FontRef::new(&data).unwrap());
    checked(builder.build())
}

/// A font whose characters are those that read-fonts' own model of a font has.
fn checked(data: Vec<u8>) -> Font {
    let (font, twin) = (Font::new(data.clone()).unwrap(), model::Font::new(data, 0).unwrap());
    let characters: Vec<_> = twin.charmap().unicodes().map(|(code, glyph)| (code, glyph.to_u32())).collect();
    assert!(font.characters().map(|(c, glyph)| (u32::from(c), glyph)).eq(characters));
    for code in (0..0x2_0000).filter_map(char::from_u32) {
        let glyph = twin.charmap().map_unicode(code).map(GlyphId::to_u32);
        assert_eq!(font.glyph_for_char(code), glyph, "U+{:04X}", u32::from(code));
    }
    font
}

#[test]
fn characters_of_whole_fonts_are_found() {
    for name in ["outline", "serif", "mono"] {
        checked(bytes(name));
    }
}

#[test]
fn a_macintosh_subtable_never_answers_for_unicode() {
    // é is 8E in Mac Roman, and È is E9 there, which is é in Unicode.
    let macintosh = (1, 0, bytes_map(&[(0x8e, 1), (0xe9, 2)]));
    let unicode = segments(&[(0xc8, 2), (0xe9, 1)]);
    for (platform, encoding) in [(3, 1), (0, 3)] {
        let mut subtables = [macintosh.clone(), (platform, encoding, unicode.clone())];
        subtables.sort_by_key(|(platform, encoding, _)| (*platform, *encoding));
        let font = with_cmap(&subtables);
        assert_eq!((font.glyph_for_char('é'), font.glyph_for_char('È')), (Some(1), Some(2)), "{platform}");
    }
    let font = with_cmap(&[macintosh]);
    assert_ne!(font.glyph_for_char('é'), Some(2), "the code of Mac Roman was taken for Unicode");
}

#[test]
fn a_symbol_font_is_asked_by_its_low_codes() {
    let font = with_cmap(&[(3, 0, segments(&[(0xf041, 3), (0xf0e9, 4)]))]);
    assert_eq!((font.glyph_for_char('A'), font.glyph_for_char('\u{f041}')), (Some(3), Some(3)));
    assert_eq!((font.glyph_for_char('é'), font.glyph_for_char('B')), (Some(4), None));
}

#[test]
fn characters_beyond_the_first_plane_are_found_beside_a_smaller_subtable() {
    let small = segments(&[(0x41, 5)]);
    let large = groups(&[(0x41, 5), (0x1f600, 6)]);
    for subtables in [vec![(3, 1, small.clone()), (3, 10, large.clone())], vec![(0, 3, small), (0, 4, large)]]
    {
        let font = with_cmap(&subtables);
        assert_eq!((font.glyph_for_char('A'), font.glyph_for_char('\u{1f600}')), (Some(5), Some(6)));
        assert!(font.characters().eq([('A', 5), ('\u{1f600}', 6)]));
    }
}

#[test]
fn variation_selectors_choose_the_glyphs_that_the_font_lists_for_them() {
    let listed = variants(&[(0xfe00, 0x41, Some(7)), (0xfe0f, 0x41, None), (0xe_0100, 0x1f600, Some(8))]);
    let font = with_cmap(&[(0, 5, listed), (3, 10, groups(&[(0x41, 5), (0x42, 9), (0x1f600, 6)]))]);
    assert_eq!((font.glyph_for_char('A'), font.glyph_for_char('\u{fe00}')), (Some(5), None));
    assert_eq!(font.glyph_for_variation('A', '\u{fe00}'), Some(7));
    assert_eq!(font.glyph_for_variation('A', '\u{fe0f}'), Some(5), "the default variant");
    assert_eq!(font.glyph_for_variation('\u{1f600}', '\u{e0100}'), Some(8));
    assert_eq!(font.glyph_for_variation('B', '\u{fe00}'), None);
    assert!(font.characters().eq([('A', 5), ('B', 9), ('\u{1f600}', 6)]));
}

#[test]
fn a_range_of_characters_may_share_a_glyph() {
    let mut shared = be16(&[13, 0]);
    shared.extend([28, 0, 1, 0x41, 0x43, 5].into_iter().flat_map(u32::to_be_bytes));
    let font = with_cmap(&[(3, 10, shared)]);
    assert_eq!(['A', 'C', 'D'].map(|c| font.glyph_for_char(c)), [Some(5), Some(5), None]);
}
