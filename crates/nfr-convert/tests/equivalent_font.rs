//! Where skrifa and FreeType follow other rules, the teacher follows FreeType's: `docs/upstream.md` has the rules and the smallest
//! font of each.
#![allow(clippy::unwrap_used)]

#[path = "samples/programs.rs"]
mod programs;

use std::rc::Rc;

use freetype::face::LoadFlag;
use nfr::Target;
use nfr_convert::teacher::Teacher;
use programs::{box_glyph, font_of};
use read_fonts::FontRef;

const PPEM: u16 = 12;
const TARGETS: [(Target, LoadFlag); 2] =
    [(Target::Smooth, LoadFlag::TARGET_NORMAL), (Target::Mono, LoadFlag::TARGET_MONO)];

/// The heights of a glyph's points in the teacher's outline, in 1/64 pixel, which are FreeType's too, for both targets.
fn heights_of_both(data: &[u8], gid: u16) -> Vec<i64> {
    let mut found = Vec::new();
    for (target, flags) in TARGETS {
        let teacher = Teacher::new(&FontRef::new(data).unwrap(), target).unwrap();
        let outline = teacher.at(PPEM).unwrap().hinted(gid).unwrap();
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

#[test]
fn vertical_phantom_points_stand_at_the_line_of_os2() {
    // PUSHB[1] 1 6, SRP1, SHP[1] after SVTCA[y]: point 1 moves as the third phantom point has moved, which is point 6.
    let data = font_of(&[box_glyph(&[0x00, 0xB1, 1, 6, 0x11, 0x33])], &[]);
    assert_eq!(heights_of_both(&data, 1)[1], 351);
}
