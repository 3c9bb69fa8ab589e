//! Warnings of a conversion that name glyphs.

use read_fonts::FontRef;
use read_fonts::types::Tag;

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

/// Tables of bitmaps that a font may have beside its outlines.
const BITMAPS: [Tag; 4] = [Tag::new(b"EBDT"), Tag::new(b"CBDT"), Tag::new(b"sbix"), Tag::new(b"bdat")];

/// Warns of a font with embedded bitmaps, which stay in it.
pub(super) fn warn_of_bitmaps(font: &FontRef<'_>, progress: &dyn Progress) {
    let found = BITMAPS.iter().filter(|tag| font.table_data(**tag).is_some_and(|table| !table.is_empty()));
    let found: Vec<String> = found.map(|tag| format!("'{tag}'")).collect();
    if !found.is_empty() {
        progress.warn(&format!(
            "the font has embedded bitmaps ({}), which stay in it: nfr does not draw them, and programs that know no models prefer \
             them to outlines at their sizes",
            found.join(", ")
        ));
    }
}
