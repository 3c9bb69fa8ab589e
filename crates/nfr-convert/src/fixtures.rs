//! Training samples for the unit tests.

use read_fonts::{FontRef, TableProvider};

use super::teacher::Teacher;
use super::training_samples::GlyphSamples;
use nfr::Target;
use nfr::internals::model::gridfit::Scale;

/// The sizes of all samples.
pub(super) const SIZES: std::ops::RangeInclusive<u16> = 8..=40;

/// The training samples of a text in Liberation Serif.
pub(super) fn glyph_samples(text: &str, target: Target) -> (Vec<GlyphSamples>, Scale) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSerif-Regular.ttf");
    let data = std::fs::read(path).unwrap();
    let font = FontRef::new(&data).unwrap();
    let teacher = Teacher::new(&font, target).unwrap();
    let sizes: Vec<_> = SIZES.map(|s| teacher.at(s).unwrap()).collect();
    let gid = |c| font.cmap().unwrap().map_codepoint(c).unwrap().to_u32() as u16;
    let glyphs = text.chars().map(|c| GlyphSamples::draw(&teacher, &sizes, gid(c)).unwrap()).collect();
    let (first_ppem, last_ppem) = SIZES.into_inner();
    (glyphs, Scale::new(teacher.units_per_em(), first_ppem, last_ppem).unwrap())
}
