//! Damaged tables and files are errors, never panics.

use std::sync::LazyLock;

use nfr::internals::table::{TAG, Table};
use nfr::{Error, Font, Limits, MissingModel, Rasterizer};
use proptest::collection::vec;
use proptest::prelude::*;
use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

use crate::samples::{converted, font};

/// A converted font with a few models.
static CONVERTED: LazyLock<Vec<u8>> =
    LazyLock::new(|| converted(&font("LiberationSans-Regular"), "aij.", 0).font);

/// The same, with nothing but the tables that the renderer reads, so that damage hits them.
static SLIM: LazyLock<Vec<u8>> = LazyLock::new(|| slim(&CONVERTED));

/// A font with so many models that the table counts them in several blocks.
static BLOCKS: LazyLock<Vec<u8>> =
    LazyLock::new(|| slim(&converted(&font("LiberationSans-Regular"), &crate::samples::ascii(), 0).font));

fn slim(data: &[u8]) -> Vec<u8> {
    let original = FontRef::new(data).unwrap();
    let mut builder = FontBuilder::new();
    for tag in
        [TAG, Tag::new(b"head"), Tag::new(b"maxp"), Tag::new(b"hhea"), Tag::new(b"hmtx"), Tag::new(b"cmap")]
    {
        builder.add_raw(tag, original.table_data(tag).unwrap().as_bytes().to_vec());
    }
    builder.build()
}

/// A font that is mostly composed glyphs, with the tables that the renderer reads.
static COMPOSED: LazyLock<Vec<u8>> =
    LazyLock::new(|| slim(&converted(&font("LiberationSans-Regular"), "aeáàâéèê", 0).font));

/// The `Nfrt` table's bytes.
fn nfrt(font: &[u8]) -> &[u8] {
    FontRef::new(font).unwrap().table_data(TAG).unwrap().as_bytes()
}

/// The table's header, the bytes of its directory (glyphs, lengths and blocks), and those of its models.
fn layout(nfrt: &[u8]) -> [std::ops::Range<usize>; 3] {
    const HEADER: usize = 52;
    let models = usize::from(u16::from_be_bytes([nfrt[10], nfrt[11]]));
    let payload = u32::from_be_bytes(nfrt[28..32].try_into().unwrap()) as usize;
    let models_at = HEADER + 4 * models + 4 * models.div_ceil(64);
    [0..HEADER, HEADER..models_at, models_at..models_at + payload]
}

/// Where a font's `Nfrt` table begins in the file.
fn table_start(font: &[u8]) -> usize {
    nfrt(font).as_ptr() as usize - font.as_ptr() as usize
}

/// Whether an error is about a file, and not about how it is used.
fn is_about_the_file(error: &Error) -> bool {
    !matches!(error, Error::InvalidSize(_) | Error::InvalidOffset(_) | Error::BufferTooSmall { .. })
}

/// Does with a font what an application does. Errors are fine, panics are not.
fn use_font(data: &[u8]) -> Result<usize, Error> {
    let font = Font::new(data.to_vec())?;
    let _ =
        (font.outlines_match(), font.advance(36, 16.0), font.glyph_for_char('a'), font.line_metrics(16.0));
    let _ = font.characters().take(500).count();
    // A damaged model may ask for any size up to the limit.
    let mut limits = Limits::default();
    limits.bitmap_side = 200;
    let mut rasterizer = Rasterizer::new(&font).with_limits(limits).with_missing_model(MissingModel::Outline);
    let mut drawn = 0;
    let glyphs: Vec<u32> = font.modelled_glyphs().take(12).collect();
    for (glyph, ppem) in glyphs.into_iter().flat_map(|glyph| [12.0, 33.5].map(|ppem| (glyph, ppem))) {
        let placement = rasterizer.placement(glyph, ppem);
        match rasterizer.draw(glyph, ppem) {
            Ok(bitmap) => {
                assert_eq!(placement, Ok(bitmap.placement));
                drawn += 1;
            }
            Err(error) => assert!(is_about_the_file(&error), "{error:?}"),
        }
    }
    Ok(drawn)
}

/// Fails for an error that is not about the file.
fn survives(data: &[u8]) -> Result<(), TestCaseError> {
    match use_font(data) {
        Err(error) if !is_about_the_file(&error) => Err(TestCaseError::fail(format!("{error:?}"))),
        _ => Ok(()),
    }
}

/// An offset in a file and the bytes to write there.
fn damage() -> impl Strategy<Value = Vec<(prop::sample::Index, u8)>> {
    vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)
}

fn damaged(data: &[u8], from: usize, to: usize, damage: &[(prop::sample::Index, u8)]) -> Vec<u8> {
    let mut data = data.to_vec();
    for (at, value) in damage {
        data[from + at.index(to - from)] = *value;
    }
    data
}

proptest! {
    // A longer run: PROPTEST_CASES=1000000 cargo test --release -p nfr-convert --test all table_damage::
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damage_anywhere_in_the_file_is_survived(damage in damage()) {
        survives(&damaged(&CONVERTED, 0, CONVERTED.len(), &damage))?;
    }

    #[test]
    fn damage_to_the_tables_that_are_read_is_survived(damage in damage()) {
        survives(&damaged(&SLIM, 0, SLIM.len(), &damage))?;
    }

    #[test]
    fn damage_to_the_models_is_survived(damage in damage()) {
        let start = table_start(&SLIM);
        survives(&damaged(&SLIM, start, start + nfrt(&SLIM).len(), &damage))?;
    }

    #[test]
    fn damage_to_the_directory_is_survived(damage in damage()) {
        let [_, directory, _] = layout(nfrt(&BLOCKS));
        let start = table_start(&BLOCKS);
        survives(&damaged(&BLOCKS, start + directory.start, start + directory.end, &damage))?;
    }

    #[test]
    fn damage_to_composed_glyphs_is_survived(damage in damage(), counts in any::<bool>()) {
        const COUNTS_AT: usize = 40;
        let (start, table) = (table_start(&COMPOSED), nfrt(&COMPOSED));
        let [header, _, models] = layout(table);
        let (from, to) = if counts { (COUNTS_AT, header.end) } else { (models.end, table.len()) };
        survives(&damaged(&COMPOSED, start + from, start + to, &damage))?;
    }

    #[test]
    fn damage_by_cutting_the_file_off_is_survived(at in any::<prop::sample::Index>()) {
        survives(&CONVERTED[..at.index(CONVERTED.len())])?;
        survives(&SLIM[..at.index(SLIM.len())])?;
    }

    #[test]
    fn damage_by_cutting_the_table_off_is_an_error(at in any::<prop::sample::Index>()) {
        let table = nfrt(&SLIM);
        let cut = Table::parse(&table[..at.index(table.len())]).and_then(|table| table.check());
        let refused = matches!(cut, Err(Error::MalformedModels { .. }));
        prop_assert!(refused);
    }
}

#[test]
fn a_whole_font_is_drawn() {
    assert_eq!(use_font(&CONVERTED), Ok(8));
    assert_eq!(use_font(&BLOCKS), Ok(24));
    assert_eq!(use_font(&COMPOSED), Ok(22));
}
