//! A copy of the font on which skrifa gives what FreeType gives on the font itself.
//!
//! FreeType is what most people see, and `docs/upstream.md` tells where skrifa 0.49 follows other rules. The teacher stays
//! skrifa as it is published; it runs the programs of a copy of the font that says in data what the rule would have said:
//!
//! - `line`: where vertical phantom points are without `vmtx`.
//!
//! Most of a font's bytes are copied as they are, and a font that needs no copy has none.

mod line;

use read_fonts::FontRef;
use skrifa::font::Font;

use crate::error::Error;
use crate::input::open::owned_bytes;

/// The copy of a font.
pub(super) struct Equivalent {
    /// The copy, if it has to differ from the font.
    pub(super) font: Option<Font>,
}

impl Equivalent {
    /// Makes the copy of a font that needs one.
    ///
    /// # Errors
    ///
    /// `Malformed` if its table directory cannot be read.
    pub(super) fn of(font: &FontRef<'_>) -> Result<Self, Error> {
        let index = font.ttc_index().unwrap_or(0);
        let copy = line::with_typo_line(font).map(|data| owned_bytes(data, index)).transpose()?;
        Ok(Self { font: copy })
    }
}
