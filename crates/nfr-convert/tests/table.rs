//! Models survive being written and read; damaged tables and files are errors, never panics.
#![allow(clippy::unwrap_used)]

mod samples;

use std::sync::LazyLock;

use nfr::internals::Damage;
use nfr::internals::model::compose::{Composed, Part};
use nfr::internals::model::gridfit::{AxisWarp, DEFORM_NODES, Scale, Weights};
use nfr::internals::table::codec::{MAX_CELLS, MAX_KNOTS, MAX_RANK, decode, encode};
use nfr::internals::table::{self, Header, MAX_PARTS, MAX_TRAINED_PPEM, TAG, Table};
use nfr::{Error, Font, Limits, MissingModel, Rasterizer, Target};
use nfr_convert::Error as Refusal;
use nfr_convert::writer::{self, GlyphModel};
use proptest::collection::{btree_set, vec};
use proptest::prelude::*;
use read_fonts::FontRef;
use read_fonts::types::Tag;
use write_fonts::FontBuilder;

use samples::{converted, font};

/// Whatever has the right lengths is a model.
fn weights(sizes: usize) -> impl Strategy<Value = Weights> {
    let shape = (
        [1..=MAX_CELLS, 1..=MAX_CELLS],
        [
            btree_set(any::<i16>(), 0..=usize::from(MAX_KNOTS)),
            btree_set(any::<i16>(), 1..=usize::from(MAX_KNOTS)),
        ],
        prop_oneof![Just(0), 1..=MAX_RANK],
        any::<[i16; 4]>(),
    );
    let inked = shape.prop_flat_map(move |(cells, knots, rank, bounds)| {
        let warp = |knots: &std::collections::BTreeSet<i16>| {
            let knots: Vec<i16> = knots.iter().copied().collect();
            // Mostly near the em, now and then anything.
            let position = prop_oneof![9 => -4096..4096, 1 => any::<i32>()];
            vec(position, knots.len() * sizes)
                .prop_map(move |hinted| AxisWarp { knots: knots.clone(), hinted })
        };
        let field = (usize::from(cells[0]) + 2) * (usize::from(cells[1]) + 2);
        let rank_len = usize::from(rank);
        (
            vec(any::<i8>(), field),
            warp(&knots[0]),
            warp(&knots[1]),
            vec(any::<i8>(), rank_len * DEFORM_NODES * DEFORM_NODES),
            vec(any::<i8>(), rank_len * sizes),
        )
            .prop_map(move |(field, warp_x, warp_y, patterns, embedding)| Weights {
                bounds,
                cells,
                field,
                warp_x,
                warp_y,
                rank,
                patterns,
                embedding,
            })
    });
    let blank = any::<[i16; 4]>().prop_map(|bounds| Weights { bounds, ..Weights::default() });
    prop_oneof![9 => inked, 1 => blank]
}

fn scale() -> impl Strategy<Value = Scale> {
    (16u16..=16384, 1..=MAX_TRAINED_PPEM, 0u16..40).prop_map(|(units_per_em, first_ppem, more)| {
        let last_ppem = (first_ppem + more).min(MAX_TRAINED_PPEM);
        Scale::new(units_per_em, first_ppem, last_ppem).unwrap()
    })
}

fn scale_and<T: std::fmt::Debug, S: Strategy<Value = T>>(
    strategy: impl Fn(usize) -> S,
) -> impl Strategy<Value = (Scale, T)> {
    scale().prop_flat_map(move |scale| (Just(scale), strategy(scale.sizes())))
}

fn header(scale: Scale) -> Header {
    Header { first_ppem: scale.first_ppem(), last_ppem: scale.last_ppem(), ..Header::default() }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(128) })]

    #[test]
    fn a_model_is_decoded_as_it_was_encoded((scale, weights) in scale_and(weights)) {
        prop_assert_eq!(decode(&encode(&weights, scale).unwrap(), scale), Ok(weights));
    }

    #[test]
    fn a_model_of_another_length_is_malformed_or_another_model(
        (scale, weights) in scale_and(weights), part in 0.0..1.0f64,
    ) {
        let mut bytes = encode(&weights, scale).unwrap();
        let cut = (bytes.len() as f64 * part) as usize;
        if let Ok(other) = decode(&bytes[..cut], scale) {
            prop_assert_ne!(&other, &weights);
        }
        bytes.push(0);
        prop_assert!(matches!(decode(&bytes, scale), Err(Damage::Malformed(_))));
    }

    #[test]
    fn random_bytes_are_a_model_or_an_error((scale, bytes) in scale_and(|_| vec(any::<u8>(), 0..600))) {
        match decode(&bytes, scale) {
            Ok(_) | Err(Damage::Malformed(_)) => {}
            Err(Damage::TooLarge { count, limit, .. }) => prop_assert!(count > limit || count == 0),
        }
    }

    #[test]
    fn the_cost_of_a_model_is_what_it_takes((scale, weights) in scale_and(weights)) {
        let (bytes, cost) = (encode(&weights, scale).unwrap().len() as f64, nfr_convert::cost::cost(&weights, scale).total() / 8.0);
        prop_assert!((bytes - cost).abs() < 3.0 + 0.005 * cost, "{bytes} for {cost}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn a_table_is_read_as_it_was_written(
        (scale, models) in scale_and(|sizes| vec((any::<u16>(), weights(sizes)), 0..5)),
        target in prop_oneof![Just(Target::Smooth), Just(Target::Mono), Just(Target::Lcd)],
        (outline_hash, seed, steps, knots, rank, cell) in any::<(u64, u64, u16, u8, u8, u16)>(),
    ) {
        let mut models: Vec<_> = models.into_iter().map(|(gid, weights)| GlyphModel { gid, weights }).collect();
        models.sort_by_key(|m| m.gid);
        models.dedup_by_key(|m| m.gid);
        let header = Header { target, outline_hash, seed, steps, knots, rank, cell, ..header(scale) };
        let (bytes, lengths) = writer::write(&header, &models, &[], &[], scale).unwrap();
        let table = Table::parse(&bytes).unwrap();
        prop_assert_eq!(table.header(), &header);
        prop_assert_eq!(table.header().scale(scale.units_per_em()), Some(scale));
        prop_assert_eq!(table.table_len(), bytes.len());
        prop_assert!(table.gids().eq(models.iter().map(|m| m.gid)));
        for (model, length) in models.iter().zip(lengths) {
            let glyph = u32::from(model.gid);
            prop_assert!(table.contains(glyph));
            prop_assert_eq!(table.model_len(glyph), Ok(length));
            prop_assert_eq!(&table.weights(glyph, scale, usize::MAX).unwrap(), &model.weights);
        }
        if let Some(missing) = (0..=u16::MAX).find(|gid| models.iter().all(|m| m.gid != *gid)) {
            let missing = missing.into();
            prop_assert!(!table.contains(missing));
            prop_assert_eq!(table.weights(missing, scale, usize::MAX), Err(Error::MissingModel(missing)));
        }
    }
}

/// Composed glyphs whose parts are among `models` glyphs, numbered from 0.
fn composed(models: u16, sizes: usize) -> impl Strategy<Value = Vec<Composed>> {
    // Few different places, so that some are shared.
    let snaps = move || prop_oneof![Just(Vec::new()), (-2i8..=2).prop_map(move |place| vec![place; sizes])];
    let part = (0..models, any::<[i16; 2]>(), [snaps(), snaps()]);
    let part = part.prop_map(|(gid, offset, snaps)| Part { gid, offset, snaps });
    vec(vec(part, 1..=MAX_PARTS), 0..6).prop_map(move |glyphs| {
        let numbered = (models..).step_by(3).zip(glyphs);
        numbered.map(|(gid, parts)| Composed { gid, parts }).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn composed_glyphs_are_read_as_they_were_written(
        (scale, composed) in scale_and(|sizes| composed(3, sizes)), outlines_dropped in any::<bool>(),
    ) {
        let header = Header { outlines_dropped, ..header(scale) };
        let models: Vec<_> = (0..3).map(|gid| GlyphModel { gid, weights: Weights::default() }).collect();
        let (bytes, _) = writer::write(&header, &models, &composed, &[], scale).unwrap();
        let table = Table::parse(&bytes).unwrap();
        prop_assert_eq!(table.header(), &header);
        prop_assert_eq!(table.gids().len(), 3 + composed.len());
        prop_assert!(table.gids().eq((0..3).chain(composed.iter().map(|glyph| glyph.gid))));
        let places = table.places(0, scale, usize::MAX).unwrap();
        for glyph in &composed {
            let (gid, parts) = (u32::from(glyph.gid), &glyph.parts);
            prop_assert!(table.contains(gid) && table.is_composed(gid));
            prop_assert_eq!(&table.parts(gid, scale, &places).unwrap(), parts);
            prop_assert_eq!(table.model_len(gid), Ok(6 + 10 * parts.len()));
            prop_assert_eq!(table.weights(gid, scale, usize::MAX), Err(Error::MissingModel(gid)));
        }
        prop_assert!(!table.is_composed(0) && !table.contains(4));
        prop_assert_eq!(table.parts(0, scale, &places), Err(Error::MissingModel(0)));
    }
}

#[test]
fn reserved_bytes_are_written_as_0_and_not_read() {
    const RESERVED_AT: usize = 38;
    let scale = Scale::new(1000, 8, 11).unwrap();
    let (mut bytes, _) = writer::write(&header(scale), &[], &[], &[], scale).unwrap();
    let reserved = &mut bytes[RESERVED_AT..][..2];
    assert_eq!(reserved, [0, 0]);
    reserved.fill(7);
    assert_eq!(Table::parse(&bytes).unwrap().header(), &header(scale));
}

#[test]
fn sizes_that_make_no_range_are_malformed() {
    let scale = Scale::new(1000, 8, 11).unwrap();
    for (first_ppem, last_ppem) in [(0, 11), (12, 11), (8, MAX_TRAINED_PPEM + 1)] {
        let header = Header { first_ppem, last_ppem, ..header(scale) };
        let (bytes, _) = writer::write(&header, &[], &[], &[], scale).unwrap();
        assert!(
            matches!(Table::parse(&bytes), Err(Error::MalformedModels { .. })),
            "{first_ppem}–{last_ppem}"
        );
    }
}

#[test]
fn parts_that_readers_would_refuse_are_not_written() {
    let scale = Scale::new(1000, 8, 10).unwrap();
    let models = [GlyphModel { gid: 1, weights: Weights::default() }];
    let write = |part: Part, count: usize| {
        writer::write(&header(scale), &models, &[Composed { gid: 5, parts: vec![part; count] }], &[], scale)
    };
    let part = Part { gid: 1, ..Part::default() };
    assert!(write(part.clone(), MAX_PARTS).is_ok());
    assert!(matches!(write(part.clone(), MAX_PARTS + 1), Err(Refusal::LimitExceeded(_))));
    // A composed glyph is not a part, and so there are neither chains nor rings.
    let refused = |part: Part| matches!(write(part, 1), Err(Refusal::InvalidParameter(_)));
    assert!(refused(Part { gid: 5, ..part.clone() }));
    assert!(refused(Part { snaps: [vec![], vec![0; 2]], ..part }));
}

#[test]
fn a_part_without_a_model_or_places_is_malformed() {
    let scale = Scale::new(1000, 8, 10).unwrap();
    let models = [GlyphModel { gid: 1, weights: Weights::default() }];
    let part = Part { gid: 1, ..Part::default() };
    let composed = [Composed { gid: 5, parts: vec![part] }];
    let (bytes, _) = writer::write(&header(scale), &models, &composed, &[], scale).unwrap();
    // The part's five numbers are the last bytes: the model, the offset, and twice that there are no places.
    let part_at = bytes.len() - 10;
    let parts = |at: usize, number: u16| {
        let mut bytes = bytes.clone();
        bytes[part_at + at..][..2].copy_from_slice(&number.to_be_bytes());
        let table = Table::parse(&bytes).unwrap();
        table.parts(5, scale, &table.places(5, scale, usize::MAX)?)
    };
    assert_eq!(parts(0, 0).unwrap(), composed[0].parts);
    for (at, number) in [(0, 1), (0, u16::MAX), (6, 0), (8, 0)] {
        assert!(matches!(parts(at, number), Err(Error::MalformedModel { glyph: 5, .. })), "{number} at {at}");
    }
}

#[test]
fn a_model_that_readers_would_refuse_is_not_written() {
    let scale = Scale::new(1000, 1, MAX_TRAINED_PPEM).unwrap();
    let knots: Vec<i16> = (0..i16::from(MAX_KNOTS)).collect();
    let hinted = |value: i32| vec![value; knots.len() * scale.sizes()];
    let fits = Weights {
        cells: [1, 1],
        field: vec![0; 9],
        warp_y: AxisWarp { hinted: hinted(0), knots: knots.clone() },
        ..Weights::default()
    };
    let write =
        |weights: Weights| writer::write(&header(scale), &[GlyphModel { gid: 7, weights }], &[], &[], scale);
    assert!(write(fits.clone()).is_ok());
    let refused = |weights: Weights| matches!(write(weights), Err(Refusal::LimitExceeded(_)));
    // A hundred thousand bytes, and nothing that predicts them.
    let scattered = (0..(knots.len() * scale.sizes()) as u64)
        .map(|k| table::fnv1a(table::FNV_BASIS, &k.to_le_bytes()) as i32)
        .collect();
    assert!(refused(Weights {
        warp_y: AxisWarp { hinted: scattered, knots: knots.clone() },
        ..fits.clone()
    }));
    assert!(refused(Weights { cells: [MAX_CELLS + 1, 1], ..fits.clone() }));
    assert!(refused(Weights { rank: MAX_RANK + 1, ..fits }));
}

/// A converted font with a few models.
static CONVERTED: LazyLock<Vec<u8>> =
    LazyLock::new(|| converted(&font("LiberationSans-Regular"), "aij.", 0).font);

/// The same, with nothing but the tables that the renderer reads, so that damage hits them.
static SLIM: LazyLock<Vec<u8>> = LazyLock::new(|| slim(&CONVERTED));

/// A font with so many models that the table counts them in several blocks.
static BLOCKS: LazyLock<Vec<u8>> =
    LazyLock::new(|| slim(&converted(&font("LiberationSans-Regular"), &samples::ascii(), 0).font));

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

/// The kinds of error that a damaged file may be.
fn survives(data: &[u8]) -> Result<(), TestCaseError> {
    match use_font(data) {
        Err(error) if !is_about_the_file(&error) => Err(TestCaseError::fail(format!("{error:?}"))),
        _ => Ok(()),
    }
}

/// A place in a file and what to put there.
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
    // A longer run: PROPTEST_CASES=1000000 cargo test --release --test table damage_to
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
        let cut = Table::parse(&table[..at.index(table.len())]);
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
