//! The font file around EBLC and EBDT.

use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

use super::strikes::Tables;

const EBLC: Tag = Tag::new(b"EBLC");
const EBDT: Tag = Tag::new(b"EBDT");
/// Bitmaps, and sizes to which some of them are scaled.
const BITMAPS: [Tag; 3] = [EBLC, EBDT, Tag::new(b"EBSC")];
/// What is of use with outlines alone, or with the models.
const OUTLINES: [Tag; 4] =
    [Tag::new(b"glyf"), Tag::new(b"loca"), Tag::new(b"gasp"), nfr::internals::table::TAG];

/// The tables of bitmaps that a font has.
pub(super) fn bitmap_tables(file: &FontRef<'_>) -> Vec<String> {
    BITMAPS.iter().filter(|tag| file.table_data(**tag).is_some()).map(Tag::to_string).collect()
}

/// Writes the font with other tables of bitmaps, and without outlines and models if that is asked for. All other tables are as they were.
pub(super) fn assemble(file: &FontRef<'_>, tables: Tables, strikes_only: bool) -> Vec<u8> {
    let mut builder = FontBuilder::new();
    for record in file.table_directory().table_records() {
        let tag = record.tag();
        if BITMAPS.contains(&tag) || strikes_only && OUTLINES.contains(&tag) {
            continue;
        }
        if let Some(data) = file.table_data(tag) {
            builder.add_raw(tag, data.as_bytes());
        }
    }
    builder.add_raw(EBLC, tables.eblc);
    builder.add_raw(EBDT, tables.ebdt);
    builder.build()
}
