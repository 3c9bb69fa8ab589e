//! The font that benchmarks draw, and its glyphs.

use std::error::Error;

use nfr::Font;

const FONT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/spec/vectors/sans.ttf");
pub(crate) const TEXT: &str = "ageM&@W8";

/// A neural font with the glyphs of `TEXT`: `NFR_BENCH_FONT`, or one of the test vectors' fonts.
pub(crate) fn neural() -> Result<Vec<u8>, Box<dyn Error>> {
    let path = std::env::var_os("NFR_BENCH_FONT").unwrap_or_else(|| FONT.into());
    Ok(std::fs::read(path)?)
}

/// The glyphs of `TEXT`, each of which must have a model.
pub(crate) fn glyphs(font: &Font) -> Result<Vec<u32>, Box<dyn Error>> {
    let gid = |c| font.glyph_for_char(c).filter(|gid| font.has_model(*gid));
    TEXT.chars().map(|c| gid(c).ok_or_else(|| format!("the font has no model of {c:?}").into())).collect()
}
