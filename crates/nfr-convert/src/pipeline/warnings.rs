//! Warnings of a conversion that name glyphs.

use crate::compare::report::glyph_count_text;
use crate::conversion::Progress;
use crate::teacher::Teacher;

/// The most glyphs that one message lists.
const GLYPHS_LISTED: usize = 5;

/// How many glyphs, and which are the first of them: "7 glyphs (3, 5, 8, 9, 12 and 2 more)".
pub(super) fn glyphs_text(gids: &[u16]) -> String {
    let listed: Vec<String> = gids.iter().take(GLYPHS_LISTED).map(u16::to_string).collect();
    let more = gids.len().saturating_sub(GLYPHS_LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("{} ({}{more})", glyph_count_text(gids.len()), listed.join(", "))
}

/// Warns of the selected glyphs of which it is not known whether the teacher hints them as FreeType does.
pub(super) fn warn_of_uncertain(teacher: &Teacher, gids: &[u16], progress: &dyn Progress) {
    let is_uncertain = |gid: &&u16| teacher.uncertain().binary_search(gid).is_ok();
    let found: Vec<u16> = gids.iter().filter(is_uncertain).copied().collect();
    if !found.is_empty() {
        progress.warn(&format!(
            "skrifa and FreeType may differ on {}: the program of a component writes what a later program reads; see \
             docs/upstream.md",
            glyphs_text(&found)
        ));
    }
}
