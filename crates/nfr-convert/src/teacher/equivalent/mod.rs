//! A copy of the font on which skrifa gives what FreeType gives on the font itself.
//!
//! FreeType is what most people see, and `docs/upstream.md` tells where skrifa 0.49 follows other rules. The teacher stays
//! skrifa as it is published; it runs the programs of a copy of the font that says in data what the rule would have said:
//!
//! - `line`: where vertical phantom points are without `vmtx`.
//! - `composites`: what the program of a component writes for later programs. `effects` finds out what a program writes and
//!   reads; `tables` writes a font with the new components.
//!
//! Glyphs keep their ids. A font that needs no copy has none.

mod cells;
mod composites;
mod effects;
mod follow;
mod functions;
mod glyphs;
mod line;
mod state;
mod tables;

use read_fonts::FontRef;
use skrifa::font::Font;

use crate::error::Error;
use crate::input::open::owned_bytes;

/// The copy of a font, and where it is not equivalent.
pub(super) struct Equivalent {
    /// The copy, if it has to differ from the font.
    pub(super) font: Option<Font>,
    /// The composite glyphs, ascending, that FreeType may hint otherwise than skrifa hints those of the copy.
    pub(super) uncertain: Vec<u16>,
}

impl Equivalent {
    /// Makes the copy of a font that needs one.
    ///
    /// # Errors
    ///
    /// `Malformed` if its table directory cannot be read.
    pub(super) fn of(font: &FontRef<'_>) -> Result<Self, Error> {
        let (copy, uncertain) = with_passed_writes(font);
        let (data, index) = match copy {
            Some(copy) => (
                Some(FontRef::new(&copy).ok().and_then(|font| line::with_typo_line(&font)).unwrap_or(copy)),
                0,
            ),
            None => (line::with_typo_line(font), font.ttc_index().unwrap_or(0)),
        };
        let font = data.map(|data| owned_bytes(data, index)).transpose()?;
        Ok(Self { font, uncertain })
    }
}

/// The font with components that write what earlier ones wrote, if there are any, and the composite glyphs for which that is
/// not possible.
fn with_passed_writes(font: &FontRef<'_>) -> (Option<Vec<u8>>, Vec<u16>) {
    let new = composites::new_glyphs(font);
    let changed: Vec<u16> = new.replaced.keys().copied().collect();
    let copy = if changed.is_empty() { None } else { tables::with_glyphs(font, &new) };
    let mut uncertain = new.uncertain;
    if copy.is_none() {
        uncertain.extend(changed);
        uncertain.sort_unstable();
        uncertain.dedup();
    }
    (copy, uncertain)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const SANS: &[u8] = include_bytes!("../../../fonts/LiberationSans-Regular.ttf");

    #[test]
    fn a_font_is_copied_only_where_it_has_to_differ() {
        let font = FontRef::new(SANS).unwrap();
        assert_eq!(with_passed_writes(&font), (None, Vec::new()));
        let copy = line::with_typo_line(&font).unwrap();
        assert_eq!(copy.iter().zip(SANS).filter(|(a, b)| a != b).count(), 1);
        assert_eq!(copy.len(), SANS.len());
        // The copy needs no other one.
        let equivalent = Equivalent::of(&FontRef::new(&copy).unwrap()).unwrap();
        assert!(equivalent.font.is_none() && equivalent.uncertain.is_empty());
    }
}
