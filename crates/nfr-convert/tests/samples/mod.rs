//! What several test files use.
#![allow(dead_code, reason = "every test file uses a part of it")]

use nfr::Bitmap;
use nfr::internals::model::network::{Dense, NORMS, NetworkSize, NetworkWeights, Norm, Shape};
use nfr_convert::{Conversion, Options, Progress, convert};
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
/// are the first guesses: rough, but whole. Nothing is polished.
pub(crate) fn converted(font: &[u8], text: &str, steps: usize) -> Conversion {
    let mut options = Options { gids: gids(font, text), ..Options::default() };
    options.schedule.steps = steps;
    options.polish.rounds = 0;
    convert(font, &options, &Silent).unwrap()
}

/// The largest difference of a pixel over the union of two bitmaps' boxes.
pub(crate) fn max_difference(a: &Bitmap, b: &Bitmap) -> u8 {
    nfr_convert::compare::metrics::Sums::of(a, b).max()
}

/// A network whose numbers look random, with a size for each ppem, in a box two pixels wider that it fills but for a
/// border of one pixel.
pub(crate) fn network(shape: Shape, ppems: &[u16], seed: u64) -> NetworkWeights {
    let mut state = seed;
    let mut noise = |scale: f32| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 40) as f32 / 8_388_608.0 - 1.0) * scale
    };
    let dense = shape.layers().into_iter().map(|(inputs, outputs)| Dense {
        inputs,
        outputs,
        weights: (0..inputs * outputs).map(|_| noise((3.0 / inputs as f32).sqrt())).collect(),
        bias: (0..outputs).map(|_| noise(0.5)).collect(),
    });
    let dense = dense.collect();
    let mut features = |least: f32| (0..shape.width).map(|_| least + noise(1.0)).collect::<Vec<_>>();
    let norms = (0..NORMS).map(|_| Norm { gamma: features(1.0), beta: features(0.0) }).collect();
    let size = |&ppem: &u16| {
        let side = ppem as u8 + 2;
        NetworkSize { ppem, side, origin: [2, i16::from(side) - 3], crop: [1, 1, side - 2, side - 2] }
    };
    NetworkWeights { shape, sizes: ppems.iter().map(size).collect(), dense, norms }
}
