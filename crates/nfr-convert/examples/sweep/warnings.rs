//! The warnings of a conversion, and the glyphs that they name.

use std::sync::{Mutex, PoisonError};

use nfr_convert::Progress;

/// Collects warnings.
#[derive(Default)]
pub(crate) struct Warnings(Mutex<Vec<String>>);

impl Progress for Warnings {
    fn glyph_done(&self, _: u16, _: f64) {}

    fn warn(&self, message: &str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message.to_owned());
    }
}

impl Warnings {
    /// All of them, in order.
    pub(crate) fn texts(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Whether a warning is about a glyph: it names it, or lists some glyphs and counts more.
    pub(crate) fn name(&self, gid: u16) -> bool {
        self.texts().iter().any(|text| names(text, gid))
    }
}

/// Numbers stand behind "glyph " or in the list of "2 glyphs (3, 5)".
fn names(text: &str, gid: u16) -> bool {
    let number = |text: &str| text.chars().take_while(char::is_ascii_digit).collect::<String>();
    let single = text.match_indices("glyph ").map(|(at, word)| number(&text[at + word.len()..]));
    let lists = text.match_indices("glyphs (").chain(text.match_indices("glyph ("));
    let mut listed = lists.filter_map(|(at, word)| text[at + word.len()..].split(')').next());
    let is_named = |list: &str| {
        list.ends_with(" more") || list.split(|c: char| !c.is_ascii_digit()).any(|n| n.parse() == Ok(gid))
    };
    single.map(|number| number.parse()).any(|number| number == Ok(gid)) || listed.any(is_named)
}

#[cfg(test)]
mod tests {
    use super::names;

    #[test]
    fn a_warning_names_the_glyphs_that_it_lists() {
        let text = "the models of 2 glyphs (3, 51) are farther at 9 ppem";
        assert!(names(text, 3) && names(text, 51));
        assert!(!names(text, 5) && !names(text, 9) && !names(text, 2));
        assert!(names("the hint program of glyph 7 fails at 12 ppem", 7));
        assert!(!names("the hint program of glyph 7 fails at 12 ppem", 12));
    }

    #[test]
    fn a_warning_of_more_glyphs_than_it_lists_may_mean_any() {
        assert!(names("the models of 6 glyphs (1, 2, 3, 4, 5 and 1 more) are farther", 90));
    }
}
