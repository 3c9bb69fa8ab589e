//! The font that benchmarks draw, and its glyphs.

use std::error::Error;

use nfr::Font;
use nfr::convert::select::Selection;
use nfr::convert::{Options, Progress, Quality, convert};
use read_fonts::FontRef;

const FONT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/fonts/LiberationSans-Regular.ttf");
pub(crate) const TEXT: &str = "agRe%@W8";

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// A neural font with the glyphs of `TEXT`.
pub(crate) fn neural() -> Result<Vec<u8>, Box<dyn Error>> {
    if let Some(path) = std::env::var_os("NFR_BENCH_FONT") {
        return Ok(std::fs::read(path)?);
    }
    let original = std::fs::read(FONT)?;
    let selection = Selection { text: Some(TEXT.into()), ..Selection::default() };
    let mut options =
        Options { gids: selection.resolve(&FontRef::new(&original)?, [])?, ..Options::default() }
            .with_quality(Quality::default());
    options.schedule.steps = 0;
    options.polish.rounds = 0;
    Ok(convert(&original, &options, &Silent)?.font)
}

/// The glyphs of `TEXT`, each of which must have a model.
pub(crate) fn glyphs(font: &Font<'_>) -> Result<Vec<u16>, Box<dyn Error>> {
    let gid = |c| font.glyph_for_char(c).filter(|gid| font.has_model(*gid));
    TEXT.chars().map(|c| gid(c).ok_or_else(|| format!("the font has no model of {c:?}").into())).collect()
}
