//! Models are read as they were written, and what readers refuse is not written.
#![allow(clippy::unwrap_used)]

use nfr::internals::Damage;
use nfr::internals::model::compose::{Composed, Part};
use nfr::internals::model::gridfit::MAX_TRAINED_PPEM;
use nfr::internals::model::gridfit::{AxisWarp, DEFORM_NODES, Scale, Weights};
use nfr::internals::table::codec::{MAX_CELLS, MAX_KNOTS, MAX_RANK, decode, encode};
use nfr::internals::table::{self, Header, MAX_PARTS, Table};
use nfr::{Error, Target};
use nfr_convert::Error as Refusal;
use nfr_convert::writer::{self, GlyphModel};
use proptest::collection::{btree_set, vec};
use proptest::prelude::*;

/// Models of any weights, with the right lengths.
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
            Err(Damage::Stale) => prop_assert!(false, "a field has no outline"),
        }
    }

    #[test]
    fn the_cost_of_a_model_is_what_it_takes((scale, weights) in scale_and(weights)) {
        let (bytes, cost) = (encode(&weights, scale).unwrap().len() as f64, nfr_convert::cost::cost(&weights, scale).unwrap().total() / 8.0);
        prop_assert!((bytes - cost).abs() < 3.0 + 0.005 * cost, "{bytes} for {cost}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn a_table_is_read_as_it_was_written(
        (scale, models) in scale_and(|sizes| vec((any::<u16>(), weights(sizes)), 0..5)),
        target in prop_oneof![Just(Target::Smooth), Just(Target::Mono), Just(Target::Lcd)],
        (outline_hash, seed, steps, knots, rank, cell, glyph_count) in any::<(u64, u64, u16, u8, u8, u16, u16)>(),
    ) {
        let mut models: Vec<_> = models.into_iter().map(|(gid, weights)| GlyphModel { gid, weights }).collect();
        models.sort_by_key(|m| m.gid);
        models.dedup_by_key(|m| m.gid);
        let header = Header { target, outline_hash, seed, steps, knots, rank, cell, glyph_count, ..header(scale) };
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
    // Few different offsets, so that some are shared.
    let grid_offsets =
        move || prop_oneof![Just(Vec::new()), (-2i8..=2).prop_map(move |pixels| vec![pixels; sizes])];
    let part = (0..models, any::<[i16; 2]>(), [grid_offsets(), grid_offsets()]);
    let part = part.prop_map(|(gid, offset, grid_offsets)| Part { gid, offset, grid_offsets });
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
        let offsets = table.part_offsets(0, scale, usize::MAX).unwrap();
        for glyph in &composed {
            let (gid, parts) = (u32::from(glyph.gid), &glyph.parts);
            prop_assert!(table.contains(gid) && table.is_composed(gid));
            prop_assert_eq!(&table.parts(gid, scale, &offsets).unwrap(), parts);
            prop_assert_eq!(table.model_len(gid), Ok(6 + 10 * parts.len()));
            prop_assert_eq!(table.weights(gid, scale, usize::MAX), Err(Error::MissingModel(gid)));
        }
        prop_assert!(!table.is_composed(0) && !table.contains(4));
        prop_assert_eq!(table.parts(0, scale, &offsets), Err(Error::MissingModel(0)));
    }
}

#[test]
fn the_number_of_glyphs_stands_where_the_specification_says() {
    const GLYPH_COUNT_AT: usize = 38;
    let scale = Scale::new(1000, 8, 11).unwrap();
    let header = Header { glyph_count: 0x0102, ..header(scale) };
    let (bytes, _) = writer::write(&header, &[], &[], &[], scale).unwrap();
    assert_eq!(bytes[GLYPH_COUNT_AT..][..2], [1, 2]);
    assert_eq!(Table::parse(&bytes).unwrap().header(), &header);
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
    assert!(refused(Part { grid_offsets: [vec![], vec![0; 2]], ..part }));
}

#[test]
fn a_part_without_a_model_or_places_is_malformed() {
    let scale = Scale::new(1000, 8, 10).unwrap();
    let models = [GlyphModel { gid: 1, weights: Weights::default() }];
    let part = Part { gid: 1, ..Part::default() };
    let composed = [Composed { gid: 5, parts: vec![part] }];
    let (bytes, _) = writer::write(&header(scale), &models, &composed, &[], scale).unwrap();
    // The part's five numbers are the last bytes: the model, the offset, and twice that there are no grid-fitted offsets.
    let part_at = bytes.len() - 10;
    let parts = |at: usize, number: u16| {
        let mut bytes = bytes.clone();
        bytes[part_at + at..][..2].copy_from_slice(&number.to_be_bytes());
        let table = Table::parse(&bytes).unwrap();
        table.parts(5, scale, &table.part_offsets(5, scale, usize::MAX)?)
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
