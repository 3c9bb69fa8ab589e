//! Which glyphs: by text, by code point, by number, by name. The options are pyftsubset's.

mod lists;
mod shaping;

use std::collections::{BTreeSet, HashMap};

use read_fonts::{FontRef, ReadError, TableProvider};
use skrifa::font::Font;
use skrifa::font::name::GlyphNameSource;

use super::open::owned;
use crate::error::Error;

pub use lists::{CodePoints, GlyphIds, GlyphNames};
use shaping::{
    DOTTED_CIRCLE, always_split, compositions, is_ignorable, is_variation_selector, needs_letter, parts,
};

/// The most unknown glyph names that one message lists.
const NAMES_LISTED: usize = 5;

/// A selection of glyphs: the union of all fields.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selection {
    /// The characters of a text. Line breaks and a byte order mark select nothing.
    pub text: Option<String>,
    /// Unicode code points.
    pub unicodes: CodePoints,
    /// Glyph numbers.
    pub gids: GlyphIds,
    /// Glyph names of the 'post' table.
    pub names: GlyphNames,
}

/// The glyphs of a selection.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selected {
    /// Glyph numbers, ascending, without repeats.
    pub gids: Vec<u16>,
    /// Code points that the font does not have, ascending.
    pub missing: Vec<u32>,
}

impl Selection {
    /// Whether nothing is asked for by name, number or character.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The characters of the text that stand for glyphs: all but line breaks and byte order marks.
    pub fn characters(&self) -> impl Iterator<Item = char> + '_ {
        self.text.iter().flat_map(|text| text.chars()).filter(|c| !matches!(c, '\n' | '\r' | '\u{feff}'))
    }

    /// The glyph numbers in `font`. An empty selection stands for `all`. In place of a character that the font does not have, what
    /// shapers put there is selected, as the letter and the accent for an accented letter. Where that is missing, too, the character
    /// is listed, as long as something else is selected, and unless it is drawn as nothing, as joiners and variation selectors are.
    /// A character of the text with a variation selector behind it stands for its variant (`cmap`, format 14).
    ///
    /// # Errors
    ///
    /// `InvalidParameter` for a selection without any glyph, and for a glyph number or name that the font does not have; it is
    /// named.
    pub fn resolve(&self, font: &FontRef<'_>, all: impl IntoIterator<Item = u16>) -> Result<Selected, Error> {
        if self.is_empty() {
            let all: BTreeSet<u16> = all.into_iter().collect();
            return Ok(Selected { gids: all.into_iter().collect(), missing: Vec::new() });
        }
        let mut gids = BTreeSet::new();
        let glyph_count = glyph_count(font)?;
        let missing: Vec<u32> = self.add_characters(font, &mut gids)?.into_iter().collect();
        for range in &self.gids.0 {
            if u32::from(*range.end()) >= glyph_count {
                return Err(Error::InvalidParameter(format!(
                    "glyph {} is not in the font, which has the glyphs 0-{}; correct --gids",
                    (*range.start()).max(u16::try_from(glyph_count).unwrap_or(u16::MAX)),
                    glyph_count.saturating_sub(1)
                )));
            }
            gids.extend(range.clone());
        }
        self.add_names(font, &mut gids)?;
        if gids.is_empty() && !missing.is_empty() {
            return Err(missing_characters(&missing));
        }
        if gids.is_empty() {
            return Err(Error::InvalidParameter(
                "the selection is empty; give --text, --unicodes, --gids or --glyphs something to select"
                    .into(),
            ));
        }
        Ok(Selected { gids: gids.into_iter().collect(), missing })
    }

    /// Adds the glyphs of characters; gives the characters that the font does not have.
    fn add_characters(&self, font: &FontRef<'_>, gids: &mut BTreeSet<u16>) -> Result<BTreeSet<u32>, Error> {
        let map = Characters::of(font)?;
        let mut missing = BTreeSet::new();
        let listed = self.unicodes.0.iter().flat_map(Clone::clone).map(|code| (code, None));
        for (code, selector) in self.text_sequences().chain(listed) {
            let found = map.glyph(code, selector).map(|gid| vec![gid]);
            let parts =
                || Some(map.parts(code)?.into_iter().filter_map(|part| map.glyph(part, None)).collect());
            match found.or_else(parts) {
                Some(found) => gids.extend(found),
                None if is_ignorable(code) => {}
                None => missing.extend([code]),
            }
        }
        Ok(missing)
    }

    /// The characters of the text, with the variation selectors behind them.
    fn text_sequences(&self) -> impl Iterator<Item = (u32, Option<u32>)> + '_ {
        let mut characters = self.characters().map(u32::from).peekable();
        std::iter::from_fn(move || {
            let code = characters.next()?;
            Some((code, characters.next_if(|next| is_variation_selector(*next))))
        })
    }

    /// The glyphs of the text in its order, without those of characters that the font lacks. No layout is applied.
    ///
    /// # Errors
    ///
    /// `Malformed` if the font's table directory cannot be read.
    pub fn text_glyphs(&self, font: &FontRef<'_>) -> Result<Vec<u16>, Error> {
        let map = Characters::of(font)?;
        Ok(self.text_sequences().filter_map(|(code, selector)| map.glyph(code, selector)).collect())
    }

    /// The code points of the text and of the list.
    fn codes(&self) -> impl Iterator<Item = u32> + '_ {
        self.characters().map(u32::from).chain(self.unicodes.0.iter().flat_map(Clone::clone))
    }

    /// The glyphs that shapers put in the place of the selected characters before layout: é for e and an accent, the halves of a vowel
    /// sign that surrounds its letter, the variants that the selected variation selectors make of the others, and the dotted circle
    /// under signs without a letter.
    ///
    /// # Errors
    ///
    /// `Malformed` if the font's table directory cannot be read.
    pub fn shaped_glyphs(&self, font: &FontRef<'_>) -> Result<Vec<u16>, Error> {
        let map = Characters::of(font)?;
        let with_parts = |code: u32| match map.glyph(code, None) {
            Some(_) => vec![code],
            None => map.parts(code).unwrap_or_default(),
        };
        let codes: BTreeSet<u32> = self.codes().collect();
        let mut shaped: BTreeSet<u32> = codes.iter().flat_map(|code| always_split(*code)).collect();
        let circle = codes.iter().any(|code| needs_letter(*code)).then_some(DOTTED_CIRCLE);
        shaped.extend(circle);
        let present = codes.iter().chain(&shaped).flat_map(|code| with_parts(*code)).collect();
        shaped.extend(compositions(&present));
        let mut glyphs: Vec<u16> = shaped.iter().filter_map(|code| map.glyph(*code, None)).collect();
        for selector in codes.iter().filter(|code| is_variation_selector(**code)) {
            glyphs.extend(codes.iter().filter_map(|code| map.variant(*code, *selector)));
        }
        Ok(glyphs)
    }

    fn add_names(&self, font: &FontRef<'_>, gids: &mut BTreeSet<u16>) -> Result<(), Error> {
        if self.names.0.is_empty() {
            return Ok(());
        }
        let names = match font.post() {
            Ok(post) => post.num_names(),
            Err(ReadError::TableIsMissing(_)) => 0,
            Err(e) => return Err(Error::Malformed(format!("table 'post' cannot be read ({e})"))),
        };
        // PostScript fonts name glyphs in 'CFF '.
        if names == 0 && font.cff().is_err() {
            return Err(Error::InvalidParameter(
                "the font's 'post' table has no glyph names; select with --gids or --unicodes instead".into(),
            ));
        }
        // The first glyph of a name wins, should a damaged font name two alike.
        let mut by_name = HashMap::new();
        for (gid, name) in glyph_names(font)? {
            by_name.entry(name).and_modify(|first: &mut u16| *first = gid.min(*first)).or_insert(gid);
        }
        let missing: Vec<_> = self.names.0.iter().filter(|name| !by_name.contains_key(*name)).collect();
        if !missing.is_empty() {
            let listed: Vec<_> = missing.iter().take(NAMES_LISTED).map(|name| format!("'{name}'")).collect();
            let more = missing.len().saturating_sub(NAMES_LISTED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            return Err(Error::InvalidParameter(format!(
                "no glyph is named {}{more} in the font's 'post' table; correct --glyphs",
                listed.join(", ")
            )));
        }
        gids.extend(self.names.0.iter().filter_map(|name| by_name.get(name)));
        Ok(())
    }
}

/// A font's character map.
struct Characters(Font);

impl Characters {
    fn of(font: &FontRef<'_>) -> Result<Self, Error> {
        Ok(Self(owned(font)?))
    }

    /// The glyph of a character, or of its variant if it has one for the variation selector.
    fn glyph(&self, code: u32, selector: Option<u32>) -> Option<u16> {
        let variant = selector.and_then(|selector| self.variant(code, selector));
        variant.or_else(|| u16::try_from(self.0.charmap().map_unicode(code)?.to_u32()).ok())
    }

    /// The glyph of a variation sequence, if the font lists it.
    fn variant(&self, code: u32, selector: u32) -> Option<u16> {
        u16::try_from(self.0.charmap().map_unicode_variant(code, selector)?.to_u32()).ok()
    }

    /// What stands for a character that the font lacks, of characters that it has.
    fn parts(&self, code: u32) -> Option<Vec<u32>> {
        parts(code, |part| self.glyph(part, None).is_some())
    }
}

/// The number of glyphs in a font ('maxp').
///
/// # Errors
///
/// `Malformed` if 'maxp' cannot be read.
pub fn glyph_count(font: &FontRef<'_>) -> Result<u32, Error> {
    let maxp = font.maxp().map_err(|e| Error::Malformed(format!("table 'maxp' cannot be read ({e})")))?;
    Ok(maxp.num_glyphs().into())
}

/// The names of the font's glyphs in 'post'; empty if it has none.
///
/// # Errors
///
/// `Malformed` if the font's table directory cannot be read.
pub fn glyph_names(font: &FontRef<'_>) -> Result<HashMap<u16, String>, Error> {
    let font = owned(font)?;
    let named = font.glyph_names().filter(|(_, name)| name.source() != GlyphNameSource::Synthesized);
    Ok(named
        .filter_map(|(gid, name)| Some((u16::try_from(gid.to_u32()).ok()?, name.as_str().to_owned())))
        .collect())
}

/// Says how many characters a font lacks, and which are the first of them.
pub fn missing_text(missing: &[u32]) -> String {
    let named = |code: &u32| match char::from_u32(*code) {
        Some(c) if !c.is_control() => format!("'{c}' (U+{code:04X})"),
        _ => format!("U+{code:04X}"),
    };
    let listed: Vec<String> = missing.iter().take(NAMES_LISTED).map(named).collect();
    match missing {
        [_] => format!("character {} is not in the font", listed.join(", ")),
        _ => {
            let more = missing.len().saturating_sub(NAMES_LISTED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("{} characters are not in the font: {}{more}", missing.len(), listed.join(", "))
        }
    }
}

/// The error for characters that a font lacks.
pub fn missing_characters(missing: &[u32]) -> Error {
    Error::InvalidParameter(format!(
        "{}; leave them out of --text and --unicodes, or pass a font that has them",
        missing_text(missing)
    ))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use read_fonts::types::Tag;
    use write_fonts::FontBuilder;

    use super::*;

    /// 'a' is glyph 68 of Liberation Sans and 'g' 74, as in every font with Arial's glyph order.
    const SANS: &[u8] = include_bytes!("../../fonts/LiberationSans-Regular.ttf");

    fn select(selection: &Selection) -> Result<Vec<u16>, Error> {
        selection.resolve(&FontRef::new(SANS).unwrap(), [9, 7, 7]).map(|selected| selected.gids)
    }

    #[test]
    fn every_way_to_name_a_glyph_finds_it() {
        let text = Selection { text: Some("a".into()), ..Default::default() };
        let unicodes = Selection { unicodes: "U+61".parse().unwrap(), ..Default::default() };
        let gids = Selection { gids: "68".parse().unwrap(), ..Default::default() };
        let names = Selection { names: "a".parse().unwrap(), ..Default::default() };
        for selection in [text, unicodes, gids, names] {
            assert_eq!(select(&selection).unwrap(), [68]);
        }
    }

    #[test]
    fn the_selection_is_the_union_in_order_without_repeats() {
        let selection = Selection {
            text: Some("ga\na".into()),
            unicodes: "61".parse().unwrap(),
            gids: "3,66-68".parse().unwrap(),
            names: "g".parse().unwrap(),
        };
        assert_eq!(select(&selection).unwrap(), [3, 66, 67, 68, 74]);
    }

    #[test]
    fn no_selection_stands_for_all() {
        assert_eq!(select(&Selection::default()).unwrap(), [7, 9]);
    }

    #[test]
    fn an_empty_text_selects_nothing_instead_of_everything() {
        let error = select(&Selection { text: Some("\n".into()), ..Default::default() }).unwrap_err();
        assert!(error.to_string().contains("selection is empty"), "{error}");
    }

    #[test]
    fn names_are_not_looked_up_in_a_post_table_that_cannot_be_read() {
        let mut builder = FontBuilder::new();
        builder.add_raw(Tag::new(b"post"), vec![0, 2, 0, 0]).copy_missing_tables(FontRef::new(SANS).unwrap());
        let data = builder.build();
        let selection = Selection { names: "a".parse().unwrap(), ..Default::default() };
        let error = selection.resolve(&FontRef::new(&data).unwrap(), []).unwrap_err();
        assert!(matches!(&error, Error::Malformed(text) if text.contains("'post'")), "{error}");
    }

    #[test]
    fn a_glyph_that_is_not_there_is_named() {
        let cases = [
            (Selection { text: Some("\u{4e00}".into()), ..Default::default() }, "U+4E00"),
            (Selection { unicodes: "U+4E01-4E09".parse().unwrap(), ..Default::default() }, "9 characters"),
            (Selection { unicodes: "D800".parse().unwrap(), ..Default::default() }, "U+D800"),
            (Selection { gids: "5-60000".parse().unwrap(), ..Default::default() }, "glyph 2620"),
            (Selection { names: "a,nosuch".parse().unwrap(), ..Default::default() }, "'nosuch'"),
        ];
        for (selection, name) in cases {
            let error = select(&selection).unwrap_err().to_string();
            assert!(error.contains(name), "{error} does not name {name}");
        }
    }

    #[test]
    fn characters_that_the_font_lacks_are_listed() {
        let font = FontRef::new(SANS).unwrap();
        let selection = Selection {
            text: Some("\u{4e00}a\u{4e00}".into()),
            unicodes: "U+4e0?".parse().unwrap(),
            ..Default::default()
        };
        let selected = selection.resolve(&font, []).unwrap();
        assert_eq!(selected.gids, [68]);
        assert_eq!(selected.missing, (0x4e00..=0x4e0f).collect::<Vec<_>>());
        let told = missing_text(&selected.missing);
        assert!(
            told.starts_with("16 characters") && told.contains("U+4E00") && told.ends_with("11 more"),
            "{told}"
        );
    }
}
