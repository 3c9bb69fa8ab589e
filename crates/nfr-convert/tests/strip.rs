//! Removing programs from `glyf`: byte by byte on small glyphs, and on damaged data.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use nfr_convert::Error;
use nfr_convert::assemble::{assemble, hint_bytes};
use nfr_convert::strip::{Stripped, strip};
use proptest::prelude::*;
use proptest::sample::Index;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};

/// The bounding box, which the tests do not look at.
const BOX: [u8; 8] = [0, 1, 0, 2, 0, 3, 0, 4];
/// Two points that share their flags (repeated once): x takes one byte for each, y none.
const POINTS: [u8; 4] = [0x02 | 0x08 | 0x20, 1, 7, 9];

/// One contour of two points.
fn simple(program: &[u8]) -> Vec<u8> {
    let length = (program.len() as u16).to_be_bytes();
    [&[0, 1], &BOX[..], &[0, 1], &length, program, &POINTS].concat()
}

/// Components with word and byte arguments, and with each kind of transform.
fn composite(program: Option<&[u8]>) -> Vec<u8> {
    let program_flag = if program.is_some() { 0x01 } else { 0x00 };
    let words_and_matrix = [0x00, 0x01 | 0x80 | 0x20, 0, 5, 0, 10, 0, 20, 0x40, 0, 0, 0, 0, 0, 0x40, 0];
    let words_and_scale = [0x00, 0x01 | 0x08 | 0x20, 0, 6, 0, 11, 0, 21, 0x20, 0];
    let x_and_y_scale = [0x00, 0x40 | 0x20, 0, 7, 1, 2, 0x20, 0, 0x40, 0];
    let last = [program_flag, 0x02, 0, 6, 3, 4];
    let mut glyph =
        [&[0xFF, 0xFF], &BOX[..], &words_and_matrix, &words_and_scale, &x_and_y_scale, &last].concat();
    if let Some(program) = program {
        glyph.extend((program.len() as u16).to_be_bytes());
        glyph.extend(program);
    }
    glyph
}

/// `glyf` and a long `loca` of these glyphs, without padding.
fn tables(glyphs: &[Vec<u8>]) -> (Vec<u8>, Vec<u8>) {
    let mut loca = vec![0; 4];
    let mut end = 0;
    for glyph in glyphs {
        end += glyph.len() as u32;
        loca.extend(end.to_be_bytes());
    }
    (glyphs.concat(), loca)
}

fn strip_all(glyphs: &[Vec<u8>]) -> Result<Stripped, Error> {
    let (glyf, loca) = tables(glyphs);
    strip(&glyf, &loca, true, glyphs.len() as u16)
}

fn message(result: Result<Stripped, Error>) -> String {
    match result {
        Err(Error::Malformed(message)) => message,
        other => panic!("not reported as malformed: {other:?}"),
    }
}

#[test]
fn a_simple_glyph_keeps_all_but_its_program() {
    let stripped = strip_all(&[simple(&[1, 2, 3])]).unwrap();
    assert_eq!(stripped.glyf, simple(&[]));
    assert_eq!(stripped.program_bytes, 3);
}

#[test]
fn a_composite_glyph_loses_its_program_and_the_flag_that_announces_it() {
    let stripped = strip_all(&[composite(Some(&[1, 2, 3, 4]))]).unwrap();
    assert_eq!(stripped.glyf, composite(None));
    assert_eq!(stripped.program_bytes, 4);
}

#[test]
fn an_empty_glyph_stays_empty_and_one_without_contours_keeps_its_header() {
    let header = [&[0, 0], &BOX[..]].concat();
    let with_program = [&header[..], &[0, 2, 8, 9]].concat();
    let with_length_only = [&header[..], &[0xFF, 0xFF]].concat();
    let stripped = strip_all(&[vec![], header.clone(), with_program, with_length_only]).unwrap();
    assert_eq!(stripped.glyf, [&header[..], &header, &[0, 0], &header, &[0, 0]].concat());
    assert_eq!(stripped.loca, [0, 0, 0, 0, 0, 5, 0, 11, 0, 17]);
    assert_eq!(stripped.program_bytes, 2);
}

#[test]
fn bytes_behind_the_last_coordinate_are_padding_and_go() {
    let padded = [simple(&[1, 2]), vec![0xEE; 3]].concat();
    assert_eq!(strip_all(&[padded]).unwrap().glyf, simple(&[]));
}

#[test]
fn a_flag_repeated_beyond_the_last_point_is_cut_there() {
    let mut glyph = simple(&[]);
    let repeats = glyph.len() - 3;
    glyph[repeats] = 200;
    assert_eq!(strip_all(&[glyph.clone()]).unwrap().glyf, glyph);
}

#[test]
fn loca_is_short_up_to_its_last_offset_and_long_beyond() {
    // Glyphs of 18 bytes as stripped: 7281 of them end at 131058, the last one that fits 2 · 65535.
    let fits = strip_all(&vec![simple(&[1]); 7281]).unwrap();
    assert!(!fits.long_offsets);
    assert_eq!(fits.loca.len(), 2 * 7282);
    assert_eq!(fits.loca[2 * 7281..], 65529_u16.to_be_bytes());

    let over_limit = strip_all(&vec![simple(&[1]); 7282]).unwrap();
    assert!(over_limit.long_offsets);
    assert_eq!(over_limit.loca.len(), 4 * 7283);
    // Long offsets are aligned to 4 bytes.
    assert_eq!(over_limit.loca[4 * 7282..], (7282_u32 * 20).to_be_bytes());
    assert_eq!(over_limit.glyf.len(), 7282 * 20);
}

#[test]
fn a_glyph_cut_anywhere_is_malformed_and_named() {
    for whole in [simple(&[1, 2, 3]), composite(Some(&[1, 2, 3]))] {
        for length in 1..whole.len() {
            let cut = message(strip_all(&[simple(&[]), whole[..length].to_vec()]));
            assert!(cut.contains("glyph 1"), "{length} bytes: {cut}");
        }
    }
}

#[test]
fn offsets_that_decrease_or_leave_glyf_are_malformed_and_the_glyph_is_named() {
    let (glyf, mut loca) = tables(&[simple(&[]), simple(&[]), simple(&[])]);
    loca[4..8].copy_from_slice(&40_u32.to_be_bytes());
    assert!(message(strip(&glyf, &loca, true, 3)).contains("glyph 1 at bytes 40 to 36"));
    let (glyf, loca) = tables(&[simple(&[]), simple(&[])]);
    assert!(message(strip(&glyf[..20], &loca, true, 2)).contains("glyph 1 at bytes 18 to 36"));
}

#[test]
fn a_loca_for_fewer_glyphs_is_malformed() {
    let (glyf, loca) = tables(&[simple(&[])]);
    assert!(message(strip(&glyf, &loca, true, 2)).contains("offsets for 1 glyphs"));
    assert!(message(strip(&glyf, &[], true, 2)).contains("offsets for 0 glyphs"));
}

/// A real font; the smallest, as it is damaged hundreds of times.
const FONT: &[u8] = include_bytes!("../fonts/Roboto_500Medium.ttf");
/// Glyphs that the damage tests run over: all of ASCII, and composites.
const GLYPHS: u16 = 400;

/// `glyf` and `loca` of the first glyphs of a real font.
fn real_tables() -> (Vec<u8>, Vec<u8>) {
    let font = FontRef::new(FONT).unwrap();
    let end = 2 * (usize::from(GLYPHS) + 1);
    let loca = font.table_data(Tag::new(b"loca")).unwrap().as_bytes()[..end].to_vec();
    let last = usize::from(u16::from_be_bytes([loca[end - 2], loca[end - 1]]));
    (font.glyf().unwrap().offset_data().as_bytes()[..2 * last].to_vec(), loca)
}

fn damage(data: &mut Vec<u8>, flips: &[(Index, u8)], keep: Option<Index>) {
    for (at, value) in flips {
        let at = at.index(data.len());
        data[at] = *value;
    }
    if let Some(keep) = keep {
        data.truncate(keep.index(data.len() + 1));
    }
}

proptest! {
    // Some milliseconds for each hundred.
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn what_is_left_does_not_depend_on_the_program(program in prop::collection::vec(any::<u8>(), 0..300)) {
        let stripped = strip_all(&[simple(&program), composite(Some(&program))]).unwrap();
        prop_assert_eq!(stripped.program_bytes, 2 * program.len());
        let without = strip_all(&[simple(&[]), composite(None)]).unwrap();
        prop_assert_eq!((stripped.glyf, stripped.loca), (without.glyf, without.loca));
    }

    #[test]
    fn a_glyph_of_any_bytes_is_stripped_or_malformed(glyph in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Ok(once) = strip_all(&[glyph]) {
            let twice = strip(&once.glyf, &once.loca, once.long_offsets, 1).unwrap();
            prop_assert_eq!(twice, Stripped { program_bytes: 0, ..once });
        }
    }

    #[test]
    fn damaged_outlines_are_stripped_or_malformed(
        in_glyf in prop::collection::vec(any::<(Index, u8)>(), 0..8),
        in_loca in prop::collection::vec(any::<(Index, u8)>(), 0..3),
        keep in any::<[Option<Index>; 2]>(),
        long_offsets in prop::bool::weighted(0.1),
        num_glyphs in prop_oneof![8 => Just(GLYPHS), 1 => any::<u16>()],
    ) {
        let (mut glyf, mut loca) = real_tables();
        damage(&mut glyf, &in_glyf, keep[0]);
        damage(&mut loca, &in_loca, keep[1]);
        match strip(&glyf, &loca, long_offsets, num_glyphs) {
            Ok(_) | Err(Error::Malformed(_)) => {}
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn a_damaged_font_file_is_assembled_or_refused(
        in_directory in prop::collection::vec(any::<(Index, u8)>(), 0..4),
        anywhere in prop::collection::vec(any::<(Index, u8)>(), 0..8),
        keep in prop::option::weighted(0.3, any::<Index>()),
    ) {
        let mut font = FONT.to_vec();
        let mut directory: Vec<u8> = font[..DIRECTORY_BYTES].to_vec();
        damage(&mut directory, &in_directory, None);
        font[..DIRECTORY_BYTES].copy_from_slice(&directory);
        damage(&mut font, &anywhere, keep);
        if let Ok(font) = FontRef::new(&font) {
            let assembled = assemble(&font, b"models", &BTreeSet::new());
            prop_assert!(assembled.is_err() || hint_bytes(&font).is_ok());
        }
    }
}

/// The header and the records of the font's 18 tables.
const DIRECTORY_BYTES: usize = 12 + 18 * 16;

#[test]
fn a_file_that_asks_for_a_huge_copy_of_itself_is_refused() {
    // Many tables that all are the whole file. Tags that sort after the real ones.
    const COPIES: usize = 8000;
    let old = FontRef::new(FONT).unwrap();
    let records = old.table_directory().table_records();
    let shift = (16 * COPIES) as u32;
    let size = FONT.len() as u32 + shift;
    let mut font = FONT[..12].to_vec();
    font[4..6].copy_from_slice(&((records.len() + COPIES) as u16).to_be_bytes());
    let mut record = |tag: [u8; 4], offset: u32, length: u32| {
        font.extend(tag);
        font.extend([0; 4]);
        font.extend(offset.to_be_bytes());
        font.extend(length.to_be_bytes());
    };
    for old in records {
        record(old.tag().to_be_bytes(), old.offset() + shift, old.length());
    }
    for copy in 0..COPIES as u32 {
        record((u32::from_be_bytes(*b"z   ") + copy).to_be_bytes(), 1, size - 1);
    }
    font.extend(&FONT[DIRECTORY_BYTES..]);
    let error = assemble(&FontRef::new(&font).unwrap(), &[], &BTreeSet::new()).unwrap_err();
    assert!(matches!(error, Error::LimitExceeded(_)), "{error}");
}

#[test]
fn fonts_that_carry_no_truetype_outlines_are_refused() {
    let rename = |from: &[u8; 4], to: &[u8; 4]| {
        let mut font = FONT.to_vec();
        let at = font[..DIRECTORY_BYTES].windows(4).position(|tag| tag == from).unwrap();
        font[at..at + 4].copy_from_slice(to);
        assemble(&FontRef::new(&font).unwrap(), &[], &BTreeSet::new()).unwrap_err()
    };
    assert!(matches!(rename(b"glyf", b"glyg"), Error::Unsupported(_)));
    assert!(matches!(rename(b"GDEF", b"CFF "), Error::Unsupported(_)));
    let error = rename(b"loca", b"locb").to_string();
    assert!(error.contains("'loca' is missing"), "{error}");
}
