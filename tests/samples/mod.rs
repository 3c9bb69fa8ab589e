//! The fonts that several test files use, and how they are changed.
#![allow(dead_code, reason = "every test file uses a part of it")]

use std::ops::Range;

use nfr::Font;
use read_fonts::FontRef;
use read_fonts::types::Tag;

/// A font of `spec/vectors` as bytes: `sans` and `mono` have no outlines, `serif` has.
pub(crate) fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/spec/vectors/{name}.ttf", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// A font of `spec/vectors`.
pub(crate) fn font(name: &str) -> Font {
    Font::new(bytes(name)).unwrap()
}

/// Where a table is in a file.
pub(crate) fn table(data: &[u8], tag: &[u8; 4]) -> Range<usize> {
    let font = FontRef::new(data).unwrap();
    let record = font.table_directory().table_records().iter().find(|record| record.tag() == Tag::new(tag));
    let record = record.unwrap();
    let start = record.offset() as usize;
    start..start + record.length() as usize
}

/// A font with a table replaced, or left out.
pub(crate) fn with_table(data: &[u8], tag: &[u8; 4], bytes: Option<&[u8]>) -> Vec<u8> {
    let font = FontRef::new(data).unwrap();
    let mut builder = write_fonts::FontBuilder::new();
    for record in font.table_directory().table_records() {
        if record.tag() != Tag::new(tag) {
            builder.add_raw(record.tag(), font.table_data(record.tag()).unwrap().as_bytes().to_vec());
        }
    }
    if let Some(bytes) = bytes {
        builder.add_raw(Tag::new(tag), bytes.to_vec());
    }
    builder.build()
}

/// A font whose `Nfrt` table has no models any more: all its glyphs lack theirs.
pub(crate) fn without_models(data: &[u8]) -> Vec<u8> {
    let mut header = data[table(data, b"Nfrt")][..52].to_vec();
    // Glyphs, bytes of their models, composed glyphs, lists of grid offsets, parts, bytes of those lists (spec/nfrt.md, section 2).
    for range in [10..12, 28..32, 40..52] {
        header[range].fill(0);
    }
    // Neither networks nor outline models follow.
    header[5] &= 1;
    with_table(data, b"Nfrt", Some(&header))
}
