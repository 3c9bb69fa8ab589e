//! Fonts, and texts set in them.

use std::sync::LazyLock;

use cosmic_text::{Attrs, Buffer, Family, FontSystem, Metrics, Shaping, fontdb};
use nfr_convert::{Options, Progress, convert};
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;

pub(crate) const FAMILY: &str = "Liberation Sans";

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _: u16, _: f64) {}
}

pub(crate) static ORIGINAL: LazyLock<Vec<u8>> = LazyLock::new(|| {
    std::fs::read(format!("{}/../../fonts/LiberationSans-Regular.ttf", env!("CARGO_MANIFEST_DIR"))).unwrap()
});

/// With models of the letters from a to m and the space.
pub(crate) static NEURAL: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let gids = (' '..=' ').chain('a'..='m').map(|c| glyph_of(&ORIGINAL, c)).collect();
    convert(&ORIGINAL, &Options { gids, ..Options::default() }, &Silent).unwrap().font
});

pub(crate) fn glyph_of(font: &[u8], character: char) -> u16 {
    let glyph = FontRef::new(font).unwrap().cmap().unwrap().map_codepoint(character);
    glyph.unwrap().to_u32() as u16
}

/// A `FontSystem` with this font alone.
pub(crate) fn system(font: &[u8]) -> FontSystem {
    let mut db = fontdb::Database::new();
    db.load_font_data(font.to_vec());
    FontSystem::new_with_locale_and_db("en".into(), db)
}

/// A text, set in the font.
pub(crate) fn buffer(
    fonts: &mut FontSystem,
    text: &str,
    size: f32,
    change: impl FnOnce(Attrs<'_>) -> Attrs<'_>,
) -> Buffer {
    let mut buffer = Buffer::new(fonts, Metrics::new(size, size * 1.25));
    let attrs = change(Attrs::new().family(Family::Name(FAMILY)));
    buffer.set_text(text, &attrs, Shaping::Advanced, None);
    buffer.shape_until_scroll(fonts, false);
    buffer
}

/// The font with a table changed or added.
pub(crate) fn with_table(font: &[u8], tag: &[u8; 4], change: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    let font = FontRef::new(font).unwrap();
    let tag = Tag::new(tag);
    let mut bytes = font.table_data(tag).map(|data| data.as_bytes().to_vec()).unwrap_or_default();
    change(&mut bytes);
    let mut builder = FontBuilder::new();
    builder.add_raw(tag, bytes).copy_missing_tables(font);
    builder.build()
}
