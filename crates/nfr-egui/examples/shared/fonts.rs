//! Fonts and their conversions.

use nfr::Target;
use nfr_convert::{Options, Progress, convert};
use read_fonts::{FontRef, TableProvider};

/// A font in `fonts/`.
pub(crate) fn path(name: &str) -> String {
    format!("{}/fonts/{name}.ttf", env!("CARGO_MANIFEST_DIR"))
}

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

/// The font with models of a text's characters.
pub(crate) fn converted(original: &[u8], text: &str, target: Target) -> Result<Vec<u8>, nfr_convert::Error> {
    let cmap = FontRef::new(original).and_then(|font| font.cmap());
    let gid = |character| cmap.as_ref().ok()?.map_codepoint(character)?.to_u32().try_into().ok();
    let mut gids: Vec<u16> = text.chars().filter_map(gid).collect();
    gids.sort_unstable();
    gids.dedup();
    let options = Options { gids, target, ..Options::default() };
    Ok(convert(original, &options, &Silent)?.font)
}
