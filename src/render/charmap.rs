//! The characters of a font (OpenType 1.9, "cmap").

use read_fonts::tables::cmap::{Cmap, CmapIterLimits, CmapSubtable, EncodingRecord, MapVariant, PlatformId};
use read_fonts::tables::name::MacRomanMapping;
use read_fonts::types::GlyphId;

/// Symbol fonts have their characters from here on.
const SYMBOLS: u32 = 0xf000;

/// The subtable that maps characters: for symbols, for all of Unicode, for its first plane, or for Mac Roman.
struct Charmap<'a> {
    subtable: CmapSubtable<'a>,
    is_symbol: bool,
    is_mac_roman: bool,
}

impl<'a> Charmap<'a> {
    fn new(cmap: &Cmap<'a>) -> Option<Self> {
        let (_, record, subtable) = cmap.best_subtable()?;
        Some(Self { subtable, is_symbol: record.is_symbol(), is_mac_roman: record.is_mac_roman() })
    }

    fn map(&self, code: u32) -> Option<GlyphId> {
        let code = if self.is_mac_roman && code > 0x7f {
            MacRomanMapping.encode(char::from_u32(code)?)?.into()
        } else {
            code
        };
        let map = |code: u32| self.subtable.map_codepoint(code).filter(|glyph| *glyph != GlyphId::NOTDEF);
        map(code).or_else(|| if self.is_symbol && code <= 0xff { map(SYMBOLS + code) } else { None })
    }
}

/// The glyph of a character.
pub(super) fn glyph_of(cmap: &Cmap<'_>, character: char) -> Option<GlyphId> {
    Charmap::new(cmap)?.map(character.into())
}

/// The glyph of a character with a variation selector behind it.
pub(super) fn glyph_of_variation(cmap: &Cmap<'_>, character: char, selector: char) -> Option<GlyphId> {
    let (_, variations) = cmap.uvs_subtable()?;
    match variations.map_variant(character, selector)? {
        MapVariant::UseDefault => glyph_of(cmap, character),
        MapVariant::Variant(glyph) => Some(glyph).filter(|glyph| *glyph != GlyphId::NOTDEF),
    }
}

/// All characters with their glyphs.
pub(super) fn characters<'a>(
    cmap: &Cmap<'a>,
    glyph_count: u16,
) -> impl Iterator<Item = (char, GlyphId)> + use<'a> {
    let limits = CmapIterLimits { max_char: char::MAX.into(), glyph_count: glyph_count.into() };
    let charmap = Charmap::new(cmap);
    let (roman, unicode) = match charmap {
        Some(charmap) if charmap.is_mac_roman => (Some(charmap), None),
        other => (None, other),
    };
    let roman = roman.into_iter().flat_map(|charmap| {
        let characters = (0..=u8::MAX).map(|code| MacRomanMapping.decode(code));
        characters.filter_map(move |character| Some((character, charmap.map(character.into())?)))
    });
    let unicode = unicode.into_iter().flat_map(move |charmap| charmap.subtable.iter_with_limits(limits));
    let unicode = unicode.filter_map(|(code, glyph)| Some((char::from_u32(code)?, glyph)));
    roman.chain(unicode).filter(|(_, glyph)| *glyph != GlyphId::NOTDEF)
}

/// Whether a character map can be read, if it has any for Unicode.
pub(super) fn is_readable(cmap: &Cmap<'_>) -> bool {
    let is_unicode = |record: &&EncodingRecord| {
        matches!(
            (record.platform_id(), record.encoding_id()),
            (PlatformId::Unicode, 0..=4 | 6) | (PlatformId::Windows, 0 | 1 | 10)
        )
    };
    let unicode = cmap.encoding_records().iter().filter(is_unicode);
    let mut readable = unicode.map(|record| record.subtable(cmap.offset_data()).is_ok()).peekable();
    readable.peek().is_none() || readable.any(|is| is)
}
