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

/// The characters that a text to type into begins with: the selection's own text; without one, those of `default` that are among
/// `characters`, which are sorted; or else the first of these.
pub fn sample_characters(selection: &Selection, characters: &[(char, u16)], default: &str) -> String {
    if let Some(text) = &selection.text {
        return text.split_whitespace().collect::<Vec<_>>().join(" ");
    }
    let is_there = |c: &char| characters.binary_search_by_key(c, |(character, _)| *character).is_ok();
    let text: String = default.chars().filter(|c| c.is_whitespace() || is_there(c)).collect();
    let distinct: BTreeSet<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
    if distinct.len() >= FEWEST_LETTERS {
        return text;
    }
    let visible = characters.iter().map(|(c, _)| *c).filter(|c| !c.is_whitespace() && !c.is_control());
    visible.take(GLYPHS_IN_ORDER).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn characters(text: &str) -> Vec<(char, u16)> {
        let mut characters: Vec<_> = text.chars().zip(1..).collect();
        characters.sort_unstable();
        characters
    }

    #[test]
    fn a_text_to_begin_with_has_only_characters_that_are_there() {
        let none = Selection::default();
        assert_eq!(sample_characters(&none, &characters("abcdehT"), "The bad cat"), "The bad ca");
        assert_eq!(sample_characters(&none, &characters("אבג"), "The bad cat"), "אבג");
        assert_eq!(sample_characters(&none, &[], "The bad cat"), "");
        let own = Selection { text: Some("My\n text".into()), ..Selection::default() };
        assert_eq!(sample_characters(&own, &characters("abc"), "The bad cat"), "My text");
    }
}
