//! Where skrifa and FreeType follow other rules, the teacher follows FreeType's: `docs/upstream.md` has the rules and the smallest
//! font of each.

use std::rc::Rc;

use crate::programs::{box_glyph, composite_glyph, font_of};
use crate::samples::Warnings;
use freetype::face::LoadFlag;
use nfr::Target;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Error, Options, convert};
use read_fonts::FontRef;

const PPEM: u16 = 12;
const TARGETS: [(Target, LoadFlag); 2] =
    [(Target::Smooth, LoadFlag::TARGET_NORMAL), (Target::Mono, LoadFlag::TARGET_MONO)];

/// CVT 0 becomes 64: PUSHB[1] 0 64, WCVTP.
const WRITE: [u8; 4] = [0xB1, 0, 64, 0x44];
/// CVT 0 grows by 64: PUSHB[2] 0 64 0, RCVT, ADD, WCVTP.
const GROW: [u8; 7] = [0xB2, 0, 64, 0, 0x45, 0x60, 0x44];
/// Point 1 moves up by CVT 0: SVTCA[y], PUSHB[0] 1, MDAP[0], PUSHB[1] 1 0, RCVT, SHPIX. Smooth, only a point moves that was touched.
const MOVE: [u8; 9] = [0x00, 0xB0, 1, 0x2E, 0xB1, 1, 0, 0x45, 0x38];
/// Unhinted, point 1 of a box is at 375, and point 1 of a second box in a composite glyph is point 5.
const UNHINTED: i64 = 375;

fn teacher(data: &[u8], target: Target) -> Teacher {
    Teacher::new(&FontRef::new(data).unwrap(), target).unwrap()
}

/// The heights of a glyph's points in the teacher's outline, in 1/64 pixel, which are FreeType's too, for both targets.
fn heights_of_both(data: &[u8], gid: u16) -> Vec<i64> {
    let mut found = Vec::new();
    for (target, flags) in TARGETS {
        let outline = teacher(data, target).at(PPEM).unwrap().hinted(gid).unwrap();
        let ours: Vec<i64> = outline.points.iter().map(|point| (point[1] * 64.0) as i64).collect();
        let face = freetype::Library::init().unwrap().new_memory_face(Rc::new(data.to_vec()), 0).unwrap();
        face.set_pixel_sizes(0, PPEM.into()).unwrap();
        face.load_glyph(gid.into(), flags | LoadFlag::NO_BITMAP).unwrap();
        let points = face.glyph().outline().unwrap().points().to_vec();
        let theirs: Vec<i64> = points.iter().map(|point| point.y).collect();
        assert_eq!(ours, theirs, "glyph {gid}, {target}");
        assert!(found.is_empty() || found == ours, "glyph {gid}, {target}");
        found = ours;
    }
    found
}

/// The composite glyphs about which a conversion of all glyphs warns.
fn warnings(data: &[u8]) -> Vec<String> {
    let glyphs = skrifa::font::Font::new(data.to_vec(), 0).unwrap().num_glyphs();
    let gids = (1..u16::try_from(glyphs).unwrap()).collect();
    let progress = Warnings::default();
    convert(data, &Options { gids, ppem: 12..=13, ..Options::default() }, &progress).unwrap();
    progress.0.into_inner().unwrap()
}

#[test]
fn vertical_phantom_points_stand_at_the_line_of_os2() {
    // PUSHB[1] 1 6, SRP1, SHP[1] after SVTCA[y]: point 1 moves as the third phantom point has moved, which is point 6.
    let data = font_of(&[box_glyph(&[0x00, 0xB1, 1, 6, 0x11, 0x33])], &[]);
    assert_eq!(heights_of_both(&data, 1)[1], 351);
}

#[test]
fn a_composite_glyphs_program_reads_what_a_components_program_has_written() {
    let data = font_of(&[box_glyph(&WRITE), composite_glyph(&MOVE, &[1])], &[]);
    assert_eq!(heights_of_both(&data, 2)[1], UNHINTED + 64);
    assert_eq!(warnings(&data), [""; 0]);
}

#[test]
fn a_component_reads_what_earlier_components_have_written_and_alone_it_reads_nothing_of_that() {
    let glyphs = [box_glyph(&GROW), box_glyph(&MOVE), composite_glyph(&[], &[2, 1, 1, 2])];
    let data = font_of(&glyphs, &[]);
    let heights = heights_of_both(&data, 3);
    assert_eq!([heights[1], heights[13]], [UNHINTED, UNHINTED + 128]);
    assert_eq!(heights_of_both(&data, 2)[1], UNHINTED);
    assert_eq!(warnings(&data), [""; 0]);
}

#[test]
fn nested_composites_pass_on_what_was_written_before_and_in_them() {
    let glyphs = [
        box_glyph(&GROW),
        box_glyph(&MOVE),
        composite_glyph(&MOVE, &[1, 2]),
        composite_glyph(&MOVE, &[1, 3, 2]),
        composite_glyph(&[], &[3, 4, 3]),
    ];
    let data = font_of(&glyphs, &[]);
    // The composite in the middle moves point 1 of its first part by twice 64, the outer one by as much again.
    let heights = heights_of_both(&data, 4);
    assert_eq!([heights[1], heights[5], heights[9]], [UNHINTED + 128, UNHINTED + 128, UNHINTED + 128]);
    for gid in 1..=5 {
        heights_of_both(&data, gid);
    }
    assert_eq!(warnings(&data), [""; 0]);
}

#[test]
fn storage_branches_and_functions_are_passed_on_too() {
    // If MPPEM < 20, S[3] = 64, else S[3] = 0: MPPEM, PUSHB[0] 20, LT, IF, PUSHB[1] 3 64, WS, ELSE, PUSHB[1] 3 0, WS, EIF, and a
    // value that stays on the stack.
    let branch = [0x4B, 0xB0, 20, 0x50, 0x58, 0xB1, 3, 64, 0x42, 0x1B, 0xB1, 3, 0, 0x42, 0x59, 0xB0, 7];
    // SVTCA[y], PUSHB[1] 1 3, RS, SHPIX; the stack is empty before: DEPTH, IF, PUSHB[1] 1 64, SHPIX, EIF.
    let moved = [0x00, 0x24, 0x58, 0xB1, 1, 64, 0x38, 0x59, 0xB1, 1, 3, 0x43, 0x38];
    // PUSHB[0] 2, FDEF, WCVTP, ENDF; and PUSHB[2] 0 64 2, CALL.
    let function = [0xB0, 2, 0x2C, 0x44, 0x2D];
    let call = [0xB2, 0, 64, 2, 0x2B];
    let glyphs =
        [box_glyph(&branch), composite_glyph(&moved, &[1]), box_glyph(&call), composite_glyph(&MOVE, &[3])];
    let data = font_of(&glyphs, &function);
    assert_eq!(heights_of_both(&data, 2)[1], UNHINTED + 64);
    assert_eq!(heights_of_both(&data, 4)[1], UNHINTED + 64);
    assert_eq!(warnings(&data), [""; 0]);
}

#[test]
fn what_a_program_writes_at_its_end_is_passed_on_though_it_moves_points() {
    let program = [&GROW[..], &MOVE[..], &WRITE[..]].concat();
    let data = font_of(&[box_glyph(&program), composite_glyph(&MOVE, &[1])], &[]);
    // Each of the two programs moves the point by 64.
    assert_eq!(heights_of_both(&data, 2)[1], UNHINTED + 128);
    assert_eq!(warnings(&data), [""; 0]);
}

#[test]
fn a_program_that_moves_points_after_it_writes_is_told_where_a_later_one_reads_that() {
    let program = [&WRITE[..], &MOVE[..]].concat();
    let glyphs = [
        box_glyph(&program),
        composite_glyph(&MOVE, &[1]),
        // It reads another control value: PUSHB[1] 1 1.
        composite_glyph(&[0x00, 0xB1, 1, 1, 0x45, 0x38], &[1]),
    ];
    let data = font_of(&glyphs, &[]);
    assert_eq!(teacher(&data, Target::Smooth).uncertain(), [2]);
    heights_of_both(&data, 3);
    let warnings = warnings(&data);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    for part in ["1 glyph (2)", "(2)", "docs/upstream.md"] {
        assert!(warnings[0].contains(part), "{part:?} is not in {warnings:?}");
    }
}

#[test]
fn the_copys_own_glyphs_are_not_the_fonts() {
    let data = font_of(&[box_glyph(&GROW), box_glyph(&MOVE), composite_glyph(&[], &[1, 2])], &[]);
    let at = teacher(&data, Target::Smooth).at(PPEM).unwrap();
    assert!(at.hinted(3).is_ok());
    assert!(matches!(at.hinted(4), Err(Error::NoSuchGlyph(4))));
}

#[test]
fn damaged_composites_are_left_to_skrifa() {
    let loops = composite_glyph(&MOVE, &[1, 2]);
    let chain = |gid: u16| composite_glyph(&MOVE, &[1, gid + 1, gid + 1]);
    let cut = composite_glyph(&MOVE, &[1, 1])[..20].to_vec();
    let mut glyphs = vec![box_glyph(&GROW), loops, composite_glyph(&MOVE, &[1, 9999]), cut];
    glyphs.push(composite_glyph(&MOVE, &[1, 4]));
    // Each of these has twice the parts of the next one, more than can be drawn.
    glyphs.extend((6..100).map(chain));
    glyphs.push(box_glyph(&MOVE));
    let data = font_of(&glyphs, &[]);
    for (target, _) in TARGETS {
        let at = teacher(&data, target).at(PPEM).unwrap();
        for gid in 1..=u16::try_from(glyphs.len()).unwrap() {
            let _ = at.hinted(gid);
        }
    }
    // A program that says that it is longer than the glyph, and every shorter length of all tables' data.
    for end in (0..data.len()).step_by(7) {
        if let Ok(font) = FontRef::new(&data[..end]) {
            let _ = Teacher::new(&font, Target::Smooth);
        }
    }
}
