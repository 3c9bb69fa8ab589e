//! What shapers make of characters, against harfrust: variation selectors, split vowel signs, signs without a letter.

use std::collections::BTreeSet;

use nfr_convert::closure::{LayoutFeatures, close};
use nfr_convert::select::Selection;
use read_fonts::FontRef;

use crate::samples::{FONTS, font, with_tables};

/// Characters of a test font, and their glyphs.
const CHARACTERS: [(char, u32); 16] = [
    (' ', 3),
    ('A', 36),
    ('B', 37),
    // Thai.
    ('\u{e01}', 40),
    ('\u{e32}', 41),
    ('\u{e33}', 42),
    ('\u{e4d}', 43),
    // Bengali: the vowel sign 9CB stands on both sides of its letter, as 9C7 and 9BE do.
    ('\u{995}', 44),
    ('\u{9be}', 45),
    ('\u{9c7}', 46),
    ('\u{9cb}', 47),
    // Khmer: 17C4 is 17C1 and itself.
    ('\u{1780}', 48),
    ('\u{17c1}', 49),
    ('\u{17c4}', 50),
    // The dotted circle, and a sign of Devanagari.
    ('\u{25cc}', 51),
    ('\u{93f}', 52),
];

/// Variants of characters: selector, character, glyph. The default variant, B's, is the glyph of the character.
const VARIANTS: [(char, char, Option<u16>); 3] =
    [('\u{fe00}', 'A', Some(60)), ('\u{fe0f}', 'B', None), ('\u{e0101}', 'A', Some(61))];

fn be24(number: char) -> [u8; 3] {
    let [_, bytes @ ..] = u32::from(number).to_be_bytes();
    bytes
}

/// OpenType 1.9, "cmap": a subtable of format 12 with the characters, and one of format 14 with the variants.
fn cmap() -> Vec<u8> {
    let be32 = |numbers: &[u32]| numbers.iter().flat_map(|n| n.to_be_bytes()).collect::<Vec<u8>>();
    let mut characters = CHARACTERS;
    characters.sort_unstable();
    let groups = characters.iter().flat_map(|(c, glyph)| [u32::from(*c), u32::from(*c), *glyph]);
    let groups = be32(&groups.collect::<Vec<_>>());
    let full = [be32(&[12 << 16, 16 + groups.len() as u32, 0, characters.len() as u32]), groups].concat();
    let (mut records, mut lists) = (Vec::new(), Vec::new());
    for (selector, character, glyph) in VARIANTS {
        let at = (10 + 11 * VARIANTS.len() + lists.len()) as u32;
        let offsets = if glyph.is_some() { [0, at] } else { [at, 0] };
        records.extend([&be24(selector)[..], &be32(&offsets)].concat());
        lists.extend([&be32(&[1])[..], &be24(character)].concat());
        // A glyph of its own, or no more characters in the range of the default ones.
        lists.extend(glyph.map_or(vec![0], |glyph| glyph.to_be_bytes().to_vec()));
    }
    let length = (10 + records.len() + lists.len()) as u32;
    let head = [&[0, 14][..], &be32(&[length, VARIANTS.len() as u32])].concat();
    let variants = [head, records, lists].concat();
    // Two subtables: Unicode's variation sequences and Windows' full repertoire.
    let head = be32(&[2, 5, 20 + full.len() as u32, (3 << 16) + 10, 20]);
    [head, full, variants].concat()
}

/// DejaVu Sans without layout, with other characters.
fn with_characters() -> Vec<u8> {
    with_tables(&font(FONTS[2]), &[(b"cmap", cmap()), (b"GSUB", vec![0, 1, 0, 0, 0, 10, 0, 10, 0, 10, 0, 0])])
}

fn text(text: &str) -> Selection {
    Selection { text: Some(text.into()), ..Default::default() }
}

/// The glyphs that a text's conversion has.
fn converted(data: &[u8], selection: &Selection) -> BTreeSet<u16> {
    let font = FontRef::new(data).unwrap();
    let selected = selection.resolve(&font, []).unwrap();
    assert_eq!(selected.missing, [0; 0]);
    let gids = [selected.gids, selection.shaped_glyphs(&font).unwrap()].concat();
    close(&font, &gids, &LayoutFeatures::default()).unwrap().into_iter().collect()
}

/// The glyphs that harfrust makes of a text.
fn shaped(data: &[u8], text: &str) -> Vec<u32> {
    let font = harfrust::Font::new(data.to_vec(), 0).unwrap();
    let mut buffer = harfrust::Buffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    harfrust::shape(&harfrust::ShaperFont::new(&font), &mut buffer, harfrust::ShapeOptions::new()).unwrap();
    buffer.glyph_infos().iter().map(|info| info.glyph_id).collect()
}

#[test]
fn all_that_a_shaper_draws_of_a_text_is_converted_with_it() {
    let data = with_characters();
    let cases = [
        ("A\u{fe00}", &[60][..]),
        ("A\u{e0101}", &[61]),
        ("B\u{fe0f}", &[37]),
        ("A\u{200d}B", &[36, 37]),
        ("\u{e01}\u{e33}", &[43, 41]),
        ("\u{995}\u{9cb}", &[46, 44, 45]),
        ("\u{1780}\u{17c4}", &[49, 48, 50]),
        ("\u{93f}", &[51, 52]),
        ("\u{9cb}", &[46, 51, 45]),
    ];
    for (string, needed) in cases {
        let shaped = shaped(&data, string);
        let converted = converted(&data, &text(string));
        assert!(needed.iter().all(|glyph| shaped.contains(glyph)), "{string:?}: {shaped:?}");
        assert!(
            shaped.iter().all(|glyph| u16::try_from(*glyph).is_ok_and(|glyph| converted.contains(&glyph))),
            "{string:?}: {converted:?} without some of {shaped:?}"
        );
    }
}

#[test]
fn a_variant_is_selected_for_its_sequence_alone() {
    let data = with_characters();
    let font = FontRef::new(&data).unwrap();
    let glyphs = |selection: &Selection| selection.text_glyphs(&font).unwrap();
    assert_eq!(glyphs(&text("A\u{fe00}A\u{fe0f}A\u{e0101}B\u{fe0f}")), [60, 36, 61, 37]);
    assert_eq!(text("A\u{fe00}").resolve(&font, []).unwrap().gids, [60]);
    assert!(!converted(&data, &text("A\u{fe00}")).contains(&61));
    assert!(converted(&data, &text("AB")).is_disjoint(&[60, 61].into()));
    // A list of code points has no order.
    let listed = Selection { unicodes: "U+FE00,U+41".parse().unwrap(), ..Default::default() };
    assert!(converted(&data, &listed).is_superset(&[36, 60].into()));
}
