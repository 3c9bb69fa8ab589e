//! Web fonts that ask for too much, and damage of all kinds: an error each time, and no panic.

use std::time::{Duration, Instant};

use nfr_convert::Error;
use nfr_convert::open::open;
use nfr_convert::web_font::{is_packed, unpack};
use proptest::prelude::*;

const WOFF: &[u8] = include_bytes!("inputs/small.woff");
const WOFF2: &[u8] = include_bytes!("inputs/small.woff2");
const PLAIN: &[u8] = include_bytes!("inputs/small.ttf");
/// A bomb is refused long before it would have been unpacked.
const AT_ONCE: Duration = Duration::from_secs(5);

/// A file of so many bytes that claims to be WOFF 1.0 with so many tables, each of all these bytes, which unpack to `original`.
fn overlapping(tables: u16, bytes: u32, original: u32) -> Vec<u8> {
    let mut data =
        [b"wOFF".as_slice(), &[0, 1, 0, 0], &bytes.to_be_bytes(), &tables.to_be_bytes(), &[0; 30]].concat();
    for table in 0..tables {
        let entry = [u32::from(table), 0, bytes, original, 0];
        data.extend(entry.iter().flat_map(|field| field.to_be_bytes()));
    }
    data.resize(bytes as usize, 0);
    data
}

#[test]
fn what_is_packed_comes_out_and_other_files_stay_as_they_are() {
    for packed in [WOFF, WOFF2] {
        assert!(is_packed(packed));
        let data = unpack(packed).unwrap();
        let (font, plain) = (open(&data, 0).unwrap(), open(PLAIN, 0).unwrap());
        for tag in [b"cvt ", b"fpgm", b"hmtx", b"cmap"] {
            let table = |font: &read_fonts::FontRef<'_>| {
                font.table_data(read_fonts::types::Tag::new(tag)).unwrap().as_bytes().to_vec()
            };
            assert!(table(&font) == table(&plain), "{}", String::from_utf8_lossy(tag));
        }
    }
    assert!(!is_packed(PLAIN));
    assert_eq!(unpack(PLAIN).unwrap(), PLAIN);
    assert_eq!(unpack(b"").unwrap(), b"".as_slice());
}

#[test]
fn a_file_that_unpacks_to_gigabytes_is_refused_at_once() {
    let start = Instant::now();
    // Stored as they are, and compressed.
    for original in [2 << 20, 1 << 30] {
        let refused = unpack(&overlapping(2000, 2 << 20, original)).unwrap_err();
        assert!(matches!(refused, Error::LimitExceeded(_)), "{refused}");
    }
    // The first table's original length, in the notation that WOFF 2.0 has for numbers, behind a byte for its tag.
    let mut claims = WOFF2.to_vec();
    claims.splice(49..50, [0x8F, 0xFF, 0xFF, 0xFF, 0x7F]);
    let length = (claims.len() as u32).to_be_bytes();
    claims[8..12].copy_from_slice(&length);
    let refused = unpack(&claims).unwrap_err();
    assert!(matches!(refused, Error::Malformed(_)), "{refused}");
    assert!(start.elapsed() < AT_ONCE);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damage_is_an_error_or_another_font(
        is_second: bool,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        let mut data = if is_second { WOFF2.to_vec() } else { WOFF.to_vec() };
        for (at, byte) in changes {
            let at = at.index(data.len());
            data[at] = byte;
        }
        if let Ok(font) = unpack(&data) {
            let _ = open(&font, 0);
        }
    }
}
