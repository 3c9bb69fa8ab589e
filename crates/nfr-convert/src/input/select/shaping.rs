//! What shapers put in the place of characters before they look at layout: what the characters compose to, and what stands for a
//! character that the font lacks. The rules are HarfBuzz's.

use std::collections::BTreeSet;

use unicode_normalization::char::{
    canonical_combining_class, compose, decompose_canonical, is_combining_mark,
};

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

/// The circle that a shaper draws under a sign that has no letter before it.
pub(super) const DOTTED_CIRCLE: u32 = 0x25cc;

/// Whether a shaper draws a sign on [`DOTTED_CIRCLE`] where no letter stands beside it: the signs of the scripts that HarfBuzz shapes
/// syllable by syllable, and Malayalam's dot reph, which is a letter in Unicode.
pub(super) fn needs_letter(code: u32) -> bool {
    let by_syllables = matches!(code, 0x900..=0xdff | 0xf00..=0x109f | 0x1700..=0x1cff | 0xa800..=0xabff | 0x1_0a00..=0x1_1fff);
    code == 0xd4e || by_syllables && char::from_u32(code).is_some_and(is_combining_mark)
}

/// What shapers split a character into even if the font has it: vowel signs that surround their letter, in Indic scripts and Khmer,
/// and the vowel AM of Thai and Lao. Empty for other characters.
pub(super) fn always_split(code: u32) -> Vec<u32> {
    let mut parts = Vec::new();
    match code {
        0xe33 | 0xeb3 => parts.extend([code + 0x1a, code - 1]),
        // The decompositions of HarfBuzz's Khmer shaper, which Unicode does not have.
        0x17be..=0x17c0 | 0x17c4 | 0x17c5 => parts.push(0x17c1),
        0x900..=0x1cff => {
            let character = char::from_u32(code).unwrap_or_default();
            decompose_canonical(character, |part| parts.push(part.into()));
            parts.retain(|part| *part != code);
        }
        _ => {}
    }
    parts
}

/// Whether a character selects the variant of the character before it (Unicode 16, sec. 23.4).
pub(super) fn is_variation_selector(code: u32) -> bool {
    matches!(code, 0x180b..=0x180d | 0x180f | 0xfe00..=0xfe0f | 0xe_0100..=0xe_01ef)
}

/// Whether a character that the font lacks is drawn as nothing, as joiners and variation selectors are: Unicode's property
/// Default_Ignorable_Code_Point, without the fillers of Hangul, as in HarfBuzz.
pub(super) fn is_ignorable(code: u32) -> bool {
    matches!(
        code,
        0xad | 0x34f | 0x61c | 0x17b4..=0x17b5 | 0x180b..=0x180f | 0x200b..=0x200f | 0x202a..=0x202e | 0x2060..=0x206f
            | 0xfe00..=0xfe0f | 0xfeff | 0xfff0..=0xfff8 | 0x1_d173..=0x1_d17a | 0xe_0000..=0xe_0fff
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vowel_signs_around_a_letter_are_split_and_accented_letters_are_not() {
        assert_eq!(always_split(0x9cb), [0x9c7, 0x9be]);
        assert_eq!(always_split(0xbcc), [0xbc6, 0xbd7]);
        assert_eq!(always_split(0x958), [0x915, 0x93c]);
        assert_eq!(always_split(0x17c4), [0x17c1]);
        assert_eq!(always_split(0xe33), [0xe4d, 0xe32]);
        assert!(['é', 'ạ', 'क', '가'].iter().all(|c| always_split(u32::from(*c)).is_empty()));
    }

    #[test]
    fn signs_of_indic_scripts_need_a_letter_and_letters_and_accents_do_not() {
        assert!(['\u{93f}', '\u{94d}', '\u{d4e}', '\u{17be}'].iter().all(|c| needs_letter(u32::from(*c))));
        assert!(
            ['क', 'a', '\u{301}', '\u{e31}', '\u{64b}', '\u{fe0f}']
                .iter()
                .all(|c| !needs_letter(u32::from(*c)))
        );
    }

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
