//! What a font calls itself.

use read_fonts::FontRef;
use skrifa::MetadataProvider;
use skrifa::string::StringId;

/// The names of a font, as far as it has them (OpenType 1.9, "name").
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FaceNames {
    /// For people, as in "Liberation Sans Bold".
    pub full: Option<String>,
    /// For files and programs, as in "LiberationSans-Bold".
    pub postscript: Option<String>,
}

impl FaceNames {
    /// Reads the names, in English where they are translated.
    pub fn of(font: &FontRef<'_>) -> Self {
        let name = |id| name(font, id);
        Self { full: name(StringId::FULL_NAME), postscript: name(StringId::POSTSCRIPT_NAME) }
    }
}

/// A string of `name` that is not blank.
pub(super) fn name(font: &FontRef<'_>, id: StringId) -> Option<String> {
    let text = font.localized_strings(id).english_or_first()?.to_string();
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}
