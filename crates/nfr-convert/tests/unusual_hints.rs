//! Hints that move points sideways in smooth text, and hints without which a glyph looks different.

use crate::samples::{FONTS, Silent, Warnings, ascii, font, gid, gids, with_program, with_tables};
use nfr::{Font, Rasterizer, Target};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::metrics::Sums;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Error, Options, Quality, Shape, convert};
use read_fonts::FontRef;

/// OpenType 1.9, "TrueType instruction set": PUSHB[1] 4 3, INSTCTRL leaves backward compatibility mode, in which smooth hinting does
/// not move points in x.
const NATIVE_CLEARTYPE: [u8; 4] = [0xB1, 4, 3, 0x8E];

/// SVTCA[x], NPUSHB, and MDAP[1] for each of the first points: rounds them to whole pixels in x.
fn rounding_in_x(points: u8) -> Vec<u8> {
    let numbers = (0..points).collect();
    [vec![0x01, 0x40, points], numbers, vec![0x2F; points.into()]].concat()
}

/// Moves the dot of an 'i', its points 0 to 3, by 0.4 em along an axis: SVTCA; MDAP[0] of each; SLOOP 4; SHPIX by the size in pixels
/// (MPPEM) times 1638/64 of 1/64 pixel.
fn moving_the_dot(axis: u8) -> Vec<u8> {
    let touch = [&[0xB3, 0, 1, 2, 3][..], &[0x2E; 4]].concat();
    let shift = [0xB0, 4, 0x17, 0xB3, 0, 1, 2, 3, 0xB8, 0x06, 0x66, 0x4B, 0x63, 0x38];
    [&[1 - axis][..], &touch, &shift].concat()
}

/// Liberation Sans with native ClearType, set by `prep` or by each program, whose 'H' and 'l' are rounded in x.
fn native(by_prep: bool) -> Vec<u8> {
    let mut data = font(FONTS[0]);
    for (character, points) in [('H', 12), ('l', 4)] {
        let start = if by_prep { &[][..] } else { &NATIVE_CLEARTYPE };
        let program = [start, &rounding_in_x(points)].concat();
        data = with_program(&data, gid(&data, character), &program);
    }
    if by_prep { with_tables(&data, &[(b"prep", NATIVE_CLEARTYPE.to_vec())]) } else { data }
}

fn options(data: &[u8], text: &str, shape: Shape, quality: f32) -> Options {
    let quality = Quality::new(quality).unwrap();
    let mut options =
        Options { gids: gids(data, text), ppem: 8..=20, shape, ..Options::default().with_quality(quality) };
    options.schedule.steps = 0;
    options.refinement.rounds = 0;
    options
}

/// The errors of the drawn glyphs and of the unhinted outlines against the teacher, at some sizes.
fn errors(data: &[u8], font: &[u8], text: &str, sizes: &[u16]) -> [f64; 2] {
    let font = Font::new(font.to_vec()).unwrap();
    let teacher = Teacher::new(&FontRef::new(data).unwrap(), font.target()).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    let [mut drawn, mut unhinted] = [Sums::default(); 2];
    for (gid, ppem) in gids(data, text).into_iter().flat_map(|gid| sizes.iter().map(move |s| (gid, *s))) {
        let truth = teacher.at(ppem).unwrap().hinted(gid).unwrap().rasterize().unwrap();
        drawn.add(&truth, &rasterizer.render(gid.into(), f32::from(ppem)).unwrap());
        unhinted.add(&truth, &teacher.unhinted(gid, ppem.into()).unwrap().rasterize().unwrap());
    }
    [drawn.mae(), unhinted.mae()]
}

#[test]
fn smooth_hints_that_move_points_in_x_are_learned_by_outline_models() {
    for data in [native(true), native(false)] {
        let conversion = convert(&data, &options(&data, "Hl", Shape::Outline, 100.0), &Silent).unwrap();
        let pair = FontPair::open(&data, 0, &conversion.font).unwrap();
        let found = pair.verify(["", ""], &gids(&data, "Hl"), &(8..=20).into(), 1).unwrap();
        assert!(found.failures(0).is_empty(), "{found}");
        let [drawn, unhinted] = errors(&data, &conversion.font, "Hl", &[8, 11, 16, 20]);
        assert!(drawn == 0.0 && unhinted > 0.02, "{drawn} {unhinted}");
        // Beyond the learned sizes the unhinted outline is drawn, as for all fonts.
        let [drawn, unhinted] = errors(&data, &conversion.font, "Hl", &[7, 21, 64]);
        assert!(drawn > 0.0 && drawn == unhinted, "{drawn} {unhinted}");
        let conversion = convert(&data, &options(&data, "Hl", Shape::Outline, 50.0), &Silent).unwrap();
        let [drawn, _] = errors(&data, &conversion.font, "Hl", &[8, 11, 16, 20]);
        assert!(drawn < 0.001, "{drawn}");
    }
}

#[test]
fn smooth_hints_that_move_points_in_x_are_learned_by_fields() {
    let data = native(true);
    let warnings = Warnings::default();
    let conversion = convert(&data, &options(&data, "Hl", Shape::Field, 50.0), &warnings).unwrap();
    let [drawn, unhinted] = errors(&data, &conversion.font, "Hl", &[8, 11, 16, 20]);
    assert!(drawn < 0.25 * unhinted, "{drawn} of {unhinted}");
    assert_eq!(warnings.0.into_inner().unwrap(), [""; 0]);
}

#[test]
fn a_glyph_that_its_program_puts_together_is_learned_and_told() {
    let sans = font(FONTS[0]);
    for (target, axis) in [(Target::Smooth, 1), (Target::Mono, 0), (Target::Mono, 1)] {
        let data = with_program(&sans, gid(&sans, 'i'), &moving_the_dot(axis));
        for (quality, most) in [(50.0, 0.002), (100.0, 0.0)] {
            let options = Options { target, ..options(&data, "Hil", Shape::Outline, quality) };
            let warnings = Warnings::default();
            let conversion = convert(&data, &options, &warnings).unwrap();
            let warnings = warnings.0.into_inner().unwrap();
            assert_eq!(warnings.len(), 1, "{warnings:?}");
            for part in [format!("1 glyph ({})", gid(&data, 'i')), "outside of 8–20 ppem".into()] {
                assert!(warnings[0].contains(&part), "{part:?} is not in {warnings:?}");
            }
            let [drawn, unhinted] = errors(&data, &conversion.font, "i", &[8, 11, 16, 20]);
            assert!(drawn <= most && unhinted > 0.03, "{target} {axis} {quality}: {drawn} {unhinted}");
            let [drawn, unhinted] = errors(&data, &conversion.font, "i", &[7, 21, 64]);
            assert!(drawn == unhinted, "{drawn} {unhinted}");
        }
    }
}

#[test]
fn a_program_that_fails_is_told_once() {
    // Without `fpgm` no function is defined that the programs call.
    let data = with_tables(&font(FONTS[0]), &[(b"fpgm", Vec::new()), (b"prep", vec![0xB0, 1, 0x21])]);
    for shape in [Shape::Outline, Shape::Field] {
        let warnings = Warnings::default();
        convert(&data, &options(&data, "Hé", shape, 50.0), &warnings).unwrap();
        let warnings = warnings.0.into_inner().unwrap();
        for glyph in gids(&data, "Hé") {
            let told = warnings.iter().filter(|warning| warning.contains(&format!("glyph {glyph}")));
            assert_eq!(told.count(), 1, "{shape:?}, glyph {glyph}: {warnings:?}");
        }
    }
}

#[test]
fn a_font_whose_glyphs_are_known_to_be_put_together_by_programs_is_refused() {
    // OpenType 1.9, "name": the family, in English for Windows.
    let family: Vec<u8> = "MingLiU".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let record = [3, 1, 0x409, 1, family.len() as u16, 0];
    let head = [0, 1, 18].into_iter().chain(record).flat_map(u16::to_be_bytes);
    let data = with_tables(&font(FONTS[0]), &[(b"name", head.chain(family).collect())]);
    let error = convert(&data, &options(&data, "H", Shape::Outline, 50.0), &Silent).err().unwrap();
    assert!(matches!(&error, Error::Unsupported(text) if text.contains("tricky")), "{error}");
}

#[test]
fn glyphs_whose_models_have_more_error_than_their_outlines_are_told_in_one_line() {
    let data = font(FONTS[0]);
    let told = |data: &[u8], options: &Options| {
        let warnings = Warnings::default();
        convert(data, options, &warnings).unwrap();
        warnings.0.into_inner().unwrap()
    };
    for name in FONTS {
        let data = font(name);
        assert_eq!(told(&data, &options(&data, &ascii(), Shape::Outline, 0.0)), [""; 0], "outline models");
    }
    let mut options = options(&data, "@%l", Shape::Field, 50.0);
    options.ppem = 40..=48;
    options.capacity.cell = 0.5;
    let warnings = told(&data, &options);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let named = format!("3 glyphs ({}, {}, {})", gid(&data, '%'), gid(&data, '@'), gid(&data, 'l'));
    assert!(warnings[0].contains(&named) && warnings[0].contains("unhinted outlines"), "{warnings:?}");
}
