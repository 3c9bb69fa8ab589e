//! The teacher, skrifa with zeno, against FreeType: its bitmaps are FreeType's. And it never teaches anything
//! but the font's own hints: a font that has none is refused.

use std::collections::BTreeSet;
use std::rc::Rc;

use crate::freetype_bitmap::freetype_bitmap;
use freetype::face::LoadFlag;
use nfr::{Bitmap, Target};
use nfr_convert::Error;
use nfr_convert::assemble::assemble;
use nfr_convert::teacher::Teacher;
use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

use crate::samples::{FONTS, ascii, font, gid, max_difference};

/// The rasterisers cut curves into straight pieces at different places. Where thin curves share a pixel, that adds
/// up, to 13 levels in the '@' at 13 ppem; `bad16` begins where this bound ends.
const RASTERISER_DIFFERENCE: u8 = 16;
/// All sizes up to 16, where hinting moves the most for their size, and a spread of the larger ones.
const PPEM: [u16; 18] = [8, 9, 10, 11, 12, 13, 14, 15, 16, 18, 21, 24, 29, 32, 37, 48, 63, 64];

/// Compares all ASCII glyphs of all fonts, in all sizes; `draw` is the teacher's side. Pixels are compared where
/// the placements put them, so that a wrong `left` or `top` is a difference too.
fn compare(target: Target, flags: LoadFlag, draw: impl Fn(&Teacher, u16, u16) -> Bitmap) {
    for name in FONTS {
        let data = font(name);
        let teacher = Teacher::new(&FontRef::new(&data).unwrap(), target).unwrap();
        let face = freetype::Library::init().unwrap().new_memory_face(Rc::new(data.clone()), 0).unwrap();
        for (ppem, character) in
            PPEM.into_iter().flat_map(|s| ascii().chars().map(move |c| (s, c)).collect::<Vec<_>>())
        {
            let gid = gid(&data, character);
            let ours = draw(&teacher, gid, ppem);
            let theirs = freetype_bitmap(&face, gid, ppem, flags).unwrap();
            let difference = max_difference(&ours, &theirs);
            assert!(
                difference <= RASTERISER_DIFFERENCE,
                "{name} {character:?} at {ppem} ppem, {target}: off by {difference}"
            );
        }
    }
}

fn hinted(teacher: &Teacher, gid: u16, ppem: u16) -> Bitmap {
    teacher.at(ppem).unwrap().hinted(gid).unwrap().rasterize().unwrap()
}

#[test]
fn its_smooth_bitmaps_are_freetypes_default_ones() {
    compare(Target::Smooth, LoadFlag::TARGET_NORMAL, hinted);
}

#[test]
fn its_mono_bitmaps_are_freetypes_mono_outlines_drawn_in_grey() {
    compare(Target::Mono, LoadFlag::TARGET_MONO, hinted);
}

#[test]
fn its_lcd_bitmaps_are_freetypes_lcd_outlines_drawn_in_grey() {
    compare(Target::Lcd, LoadFlag::TARGET_LCD, hinted);
}

#[test]
fn its_unhinted_bitmaps_are_freetypes_without_hinting() {
    compare(Target::Smooth, LoadFlag::NO_HINTING, |teacher, gid, ppem| {
        teacher.unhinted(gid, ppem.into()).unwrap().rasterize().unwrap()
    });
}

#[test]
fn programs_of_glyphs_need_no_others() {
    // The glyph's programs call functions that are not there then, which other renderers ignore.
    let data = altered(&[], &[b"fpgm", b"prep", b"cvt "]);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    assert!(teacher.at(12).unwrap().is_hinted());
}

/// A copy of Liberation Sans with some tables replaced.
fn altered(tables: &[(&[u8; 4], Vec<u8>)], dropped: &[&[u8; 4]]) -> Vec<u8> {
    let data = font("LiberationSans-Regular");
    let original = FontRef::new(&data).unwrap();
    let mut builder = FontBuilder::new();
    for record in original.table_directory().table_records() {
        let tag = record.tag();
        if !dropped.iter().any(|d| Tag::new(d) == tag) {
            builder.add_raw(tag, original.table_data(tag).unwrap().as_bytes().to_vec());
        }
    }
    for (tag, bytes) in tables {
        builder.add_raw(Tag::new(tag), bytes.clone());
    }
    builder.build()
}

fn refusal(data: &[u8]) -> Error {
    let font = FontRef::new(data).unwrap();
    Teacher::new(&font, Target::Smooth).err().expect("the font was accepted")
}

#[test]
fn a_font_without_hint_programs_is_refused() {
    let data = font("LiberationSans-Regular");
    let error = refusal(&assemble(&FontRef::new(&data).unwrap(), &[], &BTreeSet::new()).unwrap());
    assert!(matches!(&error, Error::Unsupported(text) if text.contains("no hint programs")), "{error}");
}

#[test]
fn a_font_without_outlines_is_refused() {
    let error = refusal(&altered(&[], &[b"glyf", b"loca"]));
    assert!(matches!(&error, Error::Unsupported(text) if text.contains("no outlines")), "{error}");
}

#[test]
fn a_variable_font_is_refused() {
    // OpenType 1.9, "fvar": one axis, `wght` from 400 to 700, no instances.
    let fixed = |v: i32| (v << 16).to_be_bytes();
    let fvar = [
        &[0, 1, 0, 0, 0, 16, 0, 2, 0, 1, 0, 20, 0, 0, 0, 8][..],
        b"wght",
        &fixed(400),
        &fixed(400),
        &fixed(700),
        &[0, 0, 1, 0],
    ]
    .concat();
    let error = refusal(&altered(&[(b"fvar", fvar)], &[]));
    assert!(matches!(&error, Error::Unsupported(text) if text.contains("variable")), "{error}");
}

#[test]
fn a_size_at_which_prep_switches_hinting_off_says_so_and_shows_the_plain_outline() {
    // PUSHB[1] 1 1, INSTCTRL: selector 1 ("inhibit grid-fitting") on.
    let data = altered(&[(b"prep", vec![0xB1, 1, 1, 0x8E])], &[]);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    let at = teacher.at(16).unwrap();
    assert!(!at.is_hinted());
    let gid = gid(&data, 'g');
    assert_eq!(at.hinted(gid).unwrap().points, teacher.unhinted(gid, 16.0).unwrap().points);
    let original = font("LiberationSans-Regular");
    assert!(
        Teacher::new(&FontRef::new(&original).unwrap(), Target::Smooth).unwrap().at(16).unwrap().is_hinted()
    );
}

#[test]
fn a_font_that_switches_hinting_off_at_all_sizes_teaches_nothing() {
    let data = altered(&[(b"prep", vec![0xB1, 1, 1, 0x8E])], &[]);
    let options = nfr_convert::Options { gids: vec![gid(&data, 'g')], ppem: 12..=13, ..Default::default() };
    let error = nfr_convert::convert(&data, &options, &crate::samples::Silent).unwrap_err();
    assert!(matches!(&error, Error::Unsupported(text) if text.contains("at all of these sizes")), "{error}");
}

#[test]
fn a_prep_program_that_fails_is_malformed() {
    // 0x8F is no instruction, and the font defines none.
    let data = altered(&[(b"prep", vec![0x8F])], &[]);
    let teacher = Teacher::new(&FontRef::new(&data).unwrap(), Target::Smooth).unwrap();
    assert!(matches!(teacher.at(16).err(), Some(Error::Malformed(_))));
}
