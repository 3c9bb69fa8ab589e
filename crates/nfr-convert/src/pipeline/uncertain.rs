//! Glyphs of which it is not known whether the teacher hints them as FreeType does.

use crate::conversion::Progress;
use crate::teacher::Teacher;

/// The most glyphs that the message lists.
const GLYPHS_LISTED: usize = 3;

/// Warns of the selected ones in one line.
pub(super) fn warn_of_uncertain(teacher: &Teacher, gids: &[u16], progress: &dyn Progress) {
    let found: Vec<u16> =
        gids.iter().filter(|gid| teacher.uncertain().binary_search(gid).is_ok()).copied().collect();
    if found.is_empty() {
        return;
    }
    let listed: Vec<String> = found.iter().take(GLYPHS_LISTED).map(u16::to_string).collect();
    let more = found.len().saturating_sub(GLYPHS_LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let noun = if found.len() == 1 { "composite glyph" } else { "composite glyphs" };
    progress.warn(&format!(
        "skrifa and FreeType may hint {} {noun} differently ({}{more}): a component's program writes what a later \
         program reads; see docs/upstream.md",
        found.len(),
        listed.join(", "),
    ));
}
