//! Opening a font: what is none is refused, and says why.

use nfr::{Error, Font, Rasterizer};

use crate::samples::{bytes, table, with_table};

#[test]
fn what_is_no_converted_font_is_refused_by_its_cause() {
    let data = bytes("serif");
    let refused = |data: Vec<u8>| Font::new(data).unwrap_err();
    for no_font in [b"not a font at all".as_slice(), b"", b"OTTO", &[0; 4096]] {
        assert_eq!(refused(no_font.to_vec()), Error::NotAFont);
    }
    assert_eq!(Font::from_index(data.clone(), 1).unwrap_err(), Error::NoSuchFont { index: 1, count: 1 });
    assert_eq!(refused(with_table(&data, b"Nfrt", None)), Error::NotConverted);
    for tag in [b"head", b"maxp", b"hhea", b"hmtx"] {
        assert_eq!(refused(with_table(&data, tag, None)), Error::MissingTable { tag: *tag });
        assert_eq!(refused(with_table(&data, tag, Some(&[0, 1]))), Error::MalformedTable { tag: *tag });
    }
    let mut newer = data[table(&data, b"Nfrt")].to_vec();
    newer[1] = 9;
    assert_eq!(refused(with_table(&data, b"Nfrt", Some(&newer))), Error::UnknownVersion { major: 9 });
    for length in [0, 1, 51, 60, 1000] {
        let short = &data[table(&data, b"Nfrt")][..length];
        let error = refused(with_table(&data, b"Nfrt", Some(short)));
        assert!(matches!(error, Error::MalformedModels { .. }), "{length}: {error:?}");
    }
    for units in [0u16, 15, 16_385, 65_535] {
        let mut head = data[table(&data, b"head")].to_vec();
        head[18..20].copy_from_slice(&units.to_be_bytes());
        assert_eq!(refused(with_table(&data, b"head", Some(&head))), Error::UnitsPerEm(units));
    }
}

#[test]
fn a_broken_character_map_or_metrics_are_errors_and_never_silent() {
    let data = bytes("serif");
    let refused = |tag: &[u8; 4], bytes: &[u8]| Font::new(with_table(&data, tag, Some(bytes))).unwrap_err();
    // A character map whose subtables lie outside.
    let mut cmap = data[table(&data, b"cmap")].to_vec();
    let records = usize::from(u16::from_be_bytes([cmap[2], cmap[3]]));
    for record in 0..records {
        cmap[4 + record * 8 + 4..][..4].fill(0xFF);
    }
    assert_eq!(refused(b"cmap", &cmap), Error::MalformedTable { tag: *b"cmap" });
    assert_eq!(refused(b"cmap", &[0]), Error::MalformedTable { tag: *b"cmap" });
    // No metrics at all.
    let mut hhea = data[table(&data, b"hhea")].to_vec();
    hhea[34..36].fill(0);
    assert_eq!(refused(b"hhea", &hhea), Error::MalformedTable { tag: *b"hmtx" });
    // More metrics than there are.
    hhea[34..36].fill(0xFF);
    assert_eq!(refused(b"hhea", &hhea), Error::MalformedTable { tag: *b"hmtx" });
    // A table that the directory places outside the file.
    let mut far = data.clone();
    let tables = usize::from(u16::from_be_bytes([far[4], far[5]]));
    for record in 0..tables {
        let at = 12 + record * 16;
        if &far[at..at + 4] == b"cmap" {
            far[at + 8..at + 12].copy_from_slice(&0x7FFF_0000u32.to_be_bytes());
        }
    }
    assert_eq!(Font::new(far).unwrap_err(), Error::MalformedTable { tag: *b"cmap" });
    // A font without any character map can be drawn by its glyphs' numbers.
    let font = Font::new(with_table(&data, b"cmap", None)).unwrap();
    assert_eq!((font.glyph_for_char('a'), font.characters().count()), (None, 0));
    assert!(Rasterizer::new(&font).render(font.modelled_glyphs().next().unwrap(), 16.0).is_ok());
}
