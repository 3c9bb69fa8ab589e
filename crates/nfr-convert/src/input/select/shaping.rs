//! What shapers put in the place of characters before they look at layout: what the characters compose to, and what stands for a
//! character that the font lacks. The rules are HarfBuzz's.

use std::collections::BTreeSet;

use unicode_normalization::char::{canonical_combining_class, compose, decompose_canonical};

/// What stands for a character that the font lacks, of characters that it `has`: a letter, with as many of the accents as there is one
/// with, and the others as marks; a hyphen for one that does not break lines; the space for a space of another width. None if the
/// font lacks that, too, and for characters that nothing stands for.
pub(super) fn parts(code: u32, has: impl Fn(u32) -> bool) -> Option<Vec<u32>> {
    let character = char::from_u32(code)?;
    let mut whole = Vec::new();
    match character {
        '\u{2011}' => whole.push('\u{2010}'),
        '\u{a0}' | '\u{2000}'..='\u{200a}' | '\u{202f}' | '\u{205f}' | '\u{3000}' => whole.push(' '),
        _ => decompose_canonical(character, |part| whole.push(part)),
    }
    if whole == [character] {
        return None;
    }
    let of_letter = |count: usize| {
        let (letter, marks) = whole.split_at_checked(count)?;
        let (first, accents) = letter.split_first()?;
        let letter = accents.iter().try_fold(*first, |letter, accent| compose(letter, *accent))?;
        let parts: Vec<u32> = std::iter::once(letter).chain(marks.iter().copied()).map(u32::from).collect();
        parts.iter().all(|part| has(*part)).then_some(parts)
    };
    (1..=whole.len()).rev().find_map(of_letter)
}

/// All that characters compose to with marks among them, and what that composes to.
pub(super) fn compositions(codes: &BTreeSet<u32>) -> BTreeSet<u32> {
    let characters: BTreeSet<char> = codes.iter().filter_map(|code| char::from_u32(*code)).collect();
    let marks: Vec<char> =
        characters.iter().copied().filter(|c| canonical_combining_class(*c) != 0).collect();
    let mut found = BTreeSet::new();
    let mut left: Vec<char> = characters.into_iter().collect();
    while let Some(base) = left.pop() {
        let composed = marks.iter().filter_map(|mark| compose(base, *mark));
        left.extend(composed.filter(|composed| found.insert(u32::from(*composed))));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_character_that_is_missing_has_parts() {
        let with = |font: &'static str| move |code| font.chars().any(|c| u32::from(c) == code);
        assert_eq!(parts('ặ'.into(), with("a\u{323}\u{306}")), Some(vec![0x61, 0x323, 0x306]));
        assert_eq!(parts('ặ'.into(), with("aạ\u{306}")), Some(vec!['ạ'.into(), 0x306]));
        assert_eq!(parts('ặ'.into(), with("a\u{306}")), None);
        assert_eq!(parts(0x2011, with("\u{2010}")), Some(vec![0x2010]));
        assert_eq!((parts(0x2009, with(" ")), parts(0x2009, with(""))), (Some(vec![0x20]), None));
        assert_eq!((parts('a'.into(), with("a")), parts(0xd800, with("a"))), (None, None));
    }

    #[test]
    fn marks_are_composed_in_any_order() {
        let codes = ['a', 'x', '\u{323}', '\u{306}'].map(u32::from).into();
        assert_eq!(compositions(&codes), ['ạ', 'ă', 'ặ'].map(u32::from).into());
        assert!(compositions(&[0x61, 0x62].into()).is_empty());
    }
}
