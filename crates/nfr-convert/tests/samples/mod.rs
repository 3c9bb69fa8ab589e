//! Fonts and conversions for the tests.
#![allow(dead_code, reason = "every test file uses a part of it")]

use std::sync::Mutex;

use nfr::Bitmap;
use nfr_convert::{Conversion, Options, Progress, Shape, convert};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;

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

/// Remembers warnings.
#[derive(Default)]
pub(crate) struct Warnings(pub(crate) Mutex<Vec<String>>);

impl Progress for Warnings {
    fn glyph_done(&self, _: u16, _: f64) {}
    fn warn(&self, message: &str) {
        self.0.lock().unwrap().push(message.to_owned());
    }
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

/// The font with some tables replaced.
pub(crate) fn with_tables(data: &[u8], tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut builder = FontBuilder::new();
    for (tag, bytes) in tables {
        builder.add_raw(Tag::new(tag), bytes.clone());
    }
    builder.copy_missing_tables(FontRef::new(data).unwrap());
    builder.build()
}

/// The bytes of a table.
pub(crate) fn table(data: &[u8], tag: &[u8; 4]) -> Vec<u8> {
    FontRef::new(data).unwrap().table_data(Tag::new(tag)).unwrap().as_bytes().to_vec()
}

/// The font with fractional sizes along x where it is hinted, or with whole ones: without bit 3 of `head.flags`, or with it.
pub(crate) fn with_whole_sizes(data: &[u8], whole: bool) -> Vec<u8> {
    let mut head = table(data, b"head");
    head[17] = head[17] & !8 | u8::from(whole) << 3;
    with_tables(data, &[(b"head", head)])
}

/// The font with another byte in its table `glyf`.
pub(crate) fn with_changed_outline(data: &[u8], gid: u16) -> Vec<u8> {
    let mut glyf = table(data, b"glyf");
    let loca = FontRef::new(data).unwrap().loca(None).unwrap();
    // The last byte of a simple glyph that is not padding: a coordinate.
    let end = loca.get_raw(usize::from(gid) + 1).unwrap() as usize;
    let at = (0..end).rev().find(|at| glyf[*at] != 0).unwrap();
    glyf[at] ^= 1;
    with_tables(data, &[(b"glyf", glyf)])
}

/// The font with another program of a simple glyph, which takes its points from `low` to `high` off the curve at sizes below
/// `ppem`, and hints nothing.
pub(crate) fn with_flipped_points(data: &[u8], gid: u16, [low, high, ppem]: [u8; 3]) -> Vec<u8> {
    // OpenType 1.9, "TrueType instruction set": if MPPEM < ppem, FLIPRGOFF low high.
    with_program(data, gid, &[0x4B, 0xB0, ppem, 0x50, 0x58, 0xB1, low, high, 0x82, 0x59])
}

/// The font with another program of a simple glyph, which must not be longer than the one before. It becomes as long with SVTCA[y],
/// which moves nothing.
pub(crate) fn with_program(data: &[u8], gid: u16, program: &[u8]) -> Vec<u8> {
    let mut glyf = table(data, b"glyf");
    let start = FontRef::new(data).unwrap().loca(None).unwrap().get_raw(gid.into()).unwrap() as usize;
    let word = |at: usize| usize::from(u16::from_be_bytes([glyf[start + at], glyf[start + at + 1]]));
    // The box, where contours end, the length of the program (OpenType 1.9, "glyf").
    let length_at = 10 + 2 * word(0);
    let (from, length) = (start + length_at + 2, word(length_at));
    assert!(program.len() <= length, "the program of glyph {gid} is too short");
    glyf[from..from + length].fill(0);
    glyf[from..from + program.len()].copy_from_slice(program);
    with_tables(data, &[(b"glyf", glyf)])
}
