//! Fonts and conversions for the tests.
#![allow(dead_code, reason = "every test file uses a part of it")]

use nfr::Bitmap;
use nfr_convert::{Conversion, Options, Progress, Shape, convert};
use read_fonts::{FontRef, TableProvider};

/// The fonts that most tests take: a sans, a serif, and one of another maker.
pub(crate) const FONTS: [&str; 3] = ["LiberationSans-Regular", "LiberationSerif-Regular", "DejaVuSans"];

/// The bytes of a font in `fonts/`.
pub(crate) fn font(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// The printable ASCII characters that have ink.
pub(crate) fn ascii() -> String {
    ('!'..='~').collect()
}

/// The glyph of a character.
pub(crate) fn gid(font: &[u8], character: char) -> u16 {
    let cmap = FontRef::new(font).unwrap().cmap().unwrap();
    cmap.map_codepoint(character).unwrap().to_u32().try_into().unwrap()
}

/// The glyphs of a text, ascending.
pub(crate) fn gids(font: &[u8], text: &str) -> Vec<u16> {
    let mut gids: Vec<u16> = text.chars().map(|c| gid(font, c)).collect();
    gids.sort_unstable();
    gids.dedup();
    gids
}

/// Takes no notice.
pub(crate) struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// Converts the glyphs of a text with `steps` steps of training, for sizes 8–64. Without any step the models
/// are the initial fits. Nothing is refined.
pub(crate) fn converted(font: &[u8], text: &str, steps: usize) -> Conversion {
    let mut options = Options { gids: gids(font, text), shape: Shape::Field, ..Options::default() };
    options.schedule.steps = steps;
    options.refinement.rounds = 0;
    convert(font, &options, &Silent).unwrap()
}

/// The largest difference of a pixel over the union of two bitmaps' boxes.
pub(crate) fn max_difference(a: &Bitmap, b: &Bitmap) -> u8 {
    nfr_convert::compare::metrics::Sums::of(a, b).max()
}
