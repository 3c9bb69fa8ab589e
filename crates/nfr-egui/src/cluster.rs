//! Which clusters of text are one glyph, whatever stands beside them.

use nfr::Font;

/// The variation selector that asks for a character's text form, not its emoji (Unicode, UTS #51).
const TEXT_FORM: char = '\u{FE0E}';

/// The glyph of a cluster. `None` if the font has none, if it takes several glyphs, or if it has to be shaped or is laid out in a
/// special way.
pub(crate) fn glyph(font: &Font, cluster: &str) -> Option<u32> {
    let mut chars = cluster.chars();
    let character = chars.next().filter(|character| stands_alone(*character))?;
    let glyph = match (chars.next(), chars.next()) {
        (None, _) => font.glyph_for_char(character),
        (Some(selector), None) => font.glyph_for_variation(character, selector).or_else(|| {
            let plain = || font.glyph_for_char(character);
            (selector == TEXT_FORM).then(plain).flatten()
        }),
        _ => None,
    };
    // Glyph 0 stands for what a font lacks.
    glyph.filter(|glyph| *glyph != 0)
}

/// Whether a character's glyph is the one of the character map, with its own advance width.
fn stands_alone(character: char) -> bool {
    !character.is_control() && !is_layout(character) && !is_joined(character)
}

/// Characters that are invisible, and spaces whose width egui chooses.
fn is_layout(character: char) -> bool {
    matches!(character,
        '\u{AD}' | '\u{34F}' | '\u{61C}' | '\u{2009}' | '\u{200B}'..='\u{200F}' | '\u{2028}'..='\u{202F}' | '\u{2060}'..='\u{206F}'
        | '\u{FE00}'..='\u{FE0F}' | '\u{FEFF}' | '\u{FFF9}'..='\u{FFFB}' | '\u{E0000}'..='\u{E0FFF}')
}

/// Scripts that egui's shaper has to see whole words of (Unicode 17, blocks): those that are written from the right, as Hebrew and Arabic,
/// and those whose letters take their form from their neighbours, of South and South-East Asia, Tibet and Mongolia, and conjoining
/// Hangul letters.
fn is_joined(character: char) -> bool {
    matches!(character,
        '\u{590}'..='\u{109F}' | '\u{1100}'..='\u{11FF}' | '\u{1700}'..='\u{18AF}' | '\u{1900}'..='\u{1CCF}' | '\u{A800}'..='\u{AAFF}'
        | '\u{ABC0}'..='\u{ABFF}' | '\u{D7B0}'..='\u{D7FF}' | '\u{FB1D}'..='\u{FDFF}' | '\u{FE70}'..='\u{FEFE}'
        | '\u{10800}'..='\u{11FFF}' | '\u{1E800}'..='\u{1EFFF}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_signs_and_spaces_stand_alone() {
        assert!(" aé\u{a0}ßЖω“€中가ｱ→".chars().all(stands_alone));
    }

    #[test]
    fn what_is_shaped_or_laid_out_by_egui_does_not() {
        assert!(!"\t\n\r\u{ad}\u{200b}\u{202f}\u{2009}\u{feff}אعكܐกမहಕᠠᄀ".chars().any(stands_alone));
    }
}
