//! Parts of the warnings of a conversion.

use crate::compare::report::glyph_count_text;

/// The most glyphs that one message lists.
const GLYPHS_LISTED: usize = 5;

/// How many glyphs, and which are the first of them: "7 glyphs (3, 5, 8, 9, 12 and 2 more)".
pub(super) fn glyphs_text(gids: &[u16]) -> String {
    let listed: Vec<String> = gids.iter().take(GLYPHS_LISTED).map(u16::to_string).collect();
    let more = gids.len().saturating_sub(GLYPHS_LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("{} ({}{more})", glyph_count_text(gids.len()), listed.join(", "))
}
