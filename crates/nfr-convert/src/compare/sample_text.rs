//! The text that comparisons show.

use std::collections::BTreeSet;

use read_fonts::FontRef;

use crate::error::Error;
use crate::open::owned;
use crate::select::Selection;

/// Every letter, for a line of text.
pub const PANGRAM: &str = "The quick brown fox jumps over the lazy dog";
/// Typical letters in one word, for pictures with columns.
pub const WORD: &str = "Hamburgefonstiv";
/// With fewer distinct letters than this a text shows little, and glyphs are shown in order instead.
const FEWEST_LETTERS: usize = 4;
/// The number of glyphs shown in order.
const GLYPHS_IN_ORDER: usize = 24;

/// The glyphs of the selection's own text; without one, those of `default` that are among `gids`.
///
/// # Errors
///
/// `Malformed` if the font's table directory cannot be read.
pub fn sample_glyphs(
    font: &FontRef<'_>,
    selection: &Selection,
    gids: &[u16],
    default: &str,
) -> Result<Vec<u16>, Error> {
    if selection.text.is_some() {
        return selection.text_glyphs(font);
    }
    let font = owned(font)?;
    let charmap = font.charmap();
    let lookup = |c: char| charmap.map_unicode(c).and_then(|gid| u16::try_from(gid.to_u32()).ok());
    let available: BTreeSet<u16> = gids.iter().copied().collect();
    let letters: Vec<(char, u16)> = default
        .chars()
        .filter_map(|c| Some((c, lookup(c)?)))
        .filter(|(_, gid)| available.contains(gid))
        .collect();
    let distinct: BTreeSet<char> = letters.iter().map(|(c, _)| *c).filter(|c| !c.is_whitespace()).collect();
    if distinct.len() < FEWEST_LETTERS {
        return Ok(gids.iter().copied().take(GLYPHS_IN_ORDER).collect());
    }
    Ok(letters.into_iter().map(|(_, gid)| gid).collect())
}
