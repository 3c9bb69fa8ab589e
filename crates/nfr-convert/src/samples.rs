//! Lessons that the unit tests of this module learn from.

use read_fonts::{FontRef, TableProvider};

use super::teach::{Lesson, lesson};
use super::teacher::Teacher;
use nfr::Target;
use nfr::internals::model::gridfit::Scale;

/// The sizes of all samples.
pub(super) const SIZES: std::ops::RangeInclusive<u16> = 8..=40;

/// The lessons of a text in Liberation Serif.
pub(super) fn lessons(text: &str, target: Target) -> (Vec<Lesson>, Scale) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSerif-Regular.ttf");
    let data = std::fs::read(path).unwrap();
    let font = FontRef::new(&data).unwrap();
    let teacher = Teacher::new(&font, target).unwrap();
    let sizes: Vec<_> = SIZES.map(|s| teacher.at(s).unwrap()).collect();
    let gid = |c| font.cmap().unwrap().map_codepoint(c).unwrap().to_u32() as u16;
    let lessons = text.chars().map(|c| lesson(&teacher, &sizes, gid(c)).unwrap()).collect();
    let (first_ppem, last_ppem) = SIZES.into_inner();
    (lessons, Scale::new(teacher.units_per_em(), first_ppem, last_ppem).unwrap())
}
