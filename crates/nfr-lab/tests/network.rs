//! Networks in fonts are drawn by the calls that draw models, and damaged ones are errors.
#![allow(clippy::unwrap_used)]

#[path = "../../../benches/network/mod.rs"]
mod noise;
mod packed;

use std::sync::LazyLock;

use nfr::internals::model::compose::{Composed, Part};
use nfr::internals::model::gridfit::{Scale, Weights};
use nfr::internals::model::sizes::Origin;
use nfr::internals::network::Precision;
use nfr::internals::network::{Architecture, CONDITIONED, Network, NetworkWeights, TRUNK_LAYERS};
use nfr::internals::network::{Head, decode};
use nfr::internals::table::{self, Header, TAG, Table};
use nfr::internals::{Damage, Glyph, decode as decode_glyph, header};
use nfr::{DrawOptions, Error, Font, Limits, Placement, Rasterizer, Target};
use nfr_convert::writer::{self, GlyphModel, GlyphNetwork};
use proptest::prelude::*;
use read_fonts::types::Tag;
use read_fonts::{FontRef, TableProvider};
use write_fonts::FontBuilder;

use noise::network;
use packed::{CONDITIONED_ARCHITECTURE, PLAIN_ARCHITECTURE, pack};

const SCALE: Scale = Scale::new(1000, 8, 64).unwrap();
const ABOUT: Header = Header {
    target: Target::Mono,
    first_ppem: 8,
    last_ppem: 64,
    outline_hash: 0,
    outlines_dropped: false,
    origin: Origin::TrueType,
    seed: 9,
    steps: 700,
    knots: 0,
    rank: 0,
    cell: 0,
    glyph_count: 0,
};

/// The bytes of Liberation Sans.
fn sans() -> Vec<u8> {
    std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/LiberationSans-Regular.ttf")).unwrap()
}

/// A network, and how it is stored in [`SANS`].
struct Stored {
    gid: u32,
    weights: NetworkWeights,
    precision: Precision,
    bytes: Vec<u8>,
}

/// Networks for the letters a, b and c: the first two in 8 bits, the last in 16.
static NETWORKS: LazyLock<[Stored; 3]> = LazyLock::new(|| {
    let sans = sans();
    let cmap = FontRef::new(&sans).unwrap().cmap().unwrap();
    let of = |letter: char, architecture, ppems: &[u16], precision| {
        let gid = cmap.map_codepoint(letter).unwrap().to_u32();
        let weights = network(architecture, ppems, u64::from(gid));
        Stored { gid, bytes: pack(&weights, precision), weights, precision }
    };
    [
        of('a', CONDITIONED_ARCHITECTURE, &[8, 12, 20], Precision::Eight),
        of('b', PLAIN_ARCHITECTURE, &[9, 12], Precision::Eight),
        of('c', Architecture { residual: false, ..CONDITIONED_ARCHITECTURE }, &[12, 40], Precision::Sixteen),
    ]
});

/// Liberation Sans with them.
static SANS: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let data = sans();
    let font = FontRef::new(&data).unwrap();
    let glyf = font.table_data(Tag::new(b"glyf")).unwrap();
    let units = font.head().unwrap().units_per_em();
    let header = Header { last_ppem: 40, outline_hash: table::outline_hash(units, glyf.as_bytes()), ..ABOUT };
    let networks = NETWORKS.each_ref().map(|n| GlyphNetwork { gid: n.gid as u16, bytes: n.bytes.clone() });
    let (table, _) = writer::write(&header, &[], &[], &networks, header.scale(units).unwrap()).unwrap();
    FontBuilder::new().add_raw(TAG, table).copy_missing_tables(font).build()
});

#[test]
fn a_font_with_networks_tells_what_it_has() {
    let font = Font::new(SANS.as_slice()).unwrap();
    assert_eq!((font.ppem_range(), font.target(), header(&font).seed), ((8, 40), Target::Mono, 9));
    assert!(font.outlines_match() && !font.outlines_dropped());
    let table = nfr::internals::table(&font).unwrap();
    let gids: Vec<u32> = NETWORKS.iter().map(|network| network.gid).collect();
    assert!(font.modelled_glyphs().eq(gids.iter().copied()));
    assert!(table.network_gids().map(u32::from).eq(gids.iter().copied()));
    for network in &*NETWORKS {
        let bytes = network.bytes.len();
        assert!(font.has_model(network.gid) && table.is_network(network.gid));
        assert_eq!(font.model_len(network.gid), Ok(bytes));
        assert_eq!(table.precision(network.gid), Ok(network.precision));
        assert_eq!(
            decode_glyph(&font, network.gid).unwrap().network().unwrap().sizes(),
            network.weights.sizes
        );
    }
    let other = gids[2] + 1;
    assert!(!font.has_model(other) && !table.is_network(other));
    assert_eq!(table.precision(other), Err(Error::MissingModel(other)));
    assert_eq!(font.model_len(other), Err(Error::MissingModel(other)));
    assert!(matches!(decode_glyph(&font, other), Err(Error::MissingModel(gid)) if gid == other));
    // The outlines are there for other renderers.
    assert!(FontRef::new(&SANS).unwrap().glyf().is_ok());
}

#[test]
fn all_calls_draw_the_part_of_the_box_that_the_size_names() {
    let font = Font::new(SANS.as_slice()).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    for network in &*NETWORKS {
        let rounded = decode(&network.bytes).unwrap();
        let whole = Network::new(rounded).unwrap();
        let glyph = decode_glyph(&font, network.gid).unwrap();
        for (index, size) in network.weights.sizes.iter().enumerate() {
            let (side, ppem) = (usize::from(size.side), f32::from(size.ppem));
            let placement = rasterizer.placement(network.gid, ppem).unwrap();
            // The crop leaves a border of one pixel; the origin is two pixels from the left, the baseline three rows from
            // the end.
            let length = u32::from(size.side) - 2;
            let expected = Placement { left: -1, top: length as i32 - 2, width: length, height: length };
            assert_eq!(placement, expected);
            let levels = whole.coverage(index).unwrap();
            let rows = levels.chunks(side).skip(1).take(side - 2);
            let pixels: Vec<u8> = rows.flat_map(|row| row[1..side - 1].to_vec()).collect();
            let drawn = rasterizer.render(network.gid, ppem).unwrap();
            assert_eq!((drawn.placement, &drawn.pixels), (placement, &pixels));
            assert_eq!(glyph.render(ppem + 0.4).unwrap(), drawn);
            let (mut buffer, pitch) = (vec![77; pixels.len() + 3], length as usize);
            assert_eq!(rasterizer.render_into(network.gid, ppem - 0.5, &mut buffer, pitch), Ok(placement));
            assert!(buffer.starts_with(&pixels) && buffer.ends_with(&[77; 3]));
            let short = pixels.len() - 1;
            let small = rasterizer.render_into(network.gid, ppem, &mut buffer[..short], pitch);
            assert_eq!(small, Err(Error::BufferTooSmall { placement, pitch, length: short }));
        }
    }
}

#[test]
fn bitmaps_are_not_all_of_one_level() {
    let font = Font::new(SANS.as_slice()).unwrap();
    let drawn = decode_glyph(&font, NETWORKS[0].gid).unwrap().render(20.0).unwrap();
    let mut levels = drawn.pixels.clone();
    levels.sort_unstable();
    levels.dedup();
    assert!(levels.len() > 4, "{levels:?}");
}

#[test]
fn a_size_that_was_not_trained_is_an_error_that_names_it() {
    let font = Font::new(SANS.as_slice()).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    for ppem in [7.4, 13.0, 11.4, 12.5, 200.0] {
        let glyph = NETWORKS[0].gid;
        assert_eq!(rasterizer.render(glyph, ppem), Err(Error::NetworkSize { glyph, ppem }));
    }
    assert_eq!(rasterizer.render(NETWORKS[0].gid, -1.0), Err(Error::InvalidSize(-1.0)));
}

#[test]
fn whole_pixels_move_the_box_and_parts_of_one_are_an_error() {
    let font = Font::new(SANS.as_slice()).unwrap();
    let glyph = decode_glyph(&font, NETWORKS[1].gid).unwrap();
    let unmoved = glyph.render(12.0).unwrap();
    let moved = glyph.render(DrawOptions::new(12.0).with_offset([-3.0, 5.0])).unwrap();
    assert_eq!(
        (moved.placement.left, moved.placement.top),
        (unmoved.placement.left - 3, unmoved.placement.top + 5)
    );
    assert_eq!(moved.pixels, unmoved.pixels);
    for offset in [[0.25, 0.0], [0.0, -0.5]] {
        let refused = glyph.render(DrawOptions::new(12.0).with_offset(offset));
        assert_eq!(refused, Err(Error::NetworkOffset { glyph: NETWORKS[1].gid, offset }));
    }
}

#[test]
fn the_first_of_several_sizes_of_one_ppem_is_drawn() {
    let mut weights = network(CONDITIONED_ARCHITECTURE, &[10, 12, 20], 4);
    weights.sizes[2].ppem = 12;
    let drawn = Glyph::of_network(Network::new(weights).unwrap()).render(12.0).unwrap();
    assert_eq!(drawn.placement.width, 12);
}

#[test]
fn a_glyph_without_ink_has_no_pixels() {
    let mut weights = network(CONDITIONED_ARCHITECTURE, &[10], 4);
    weights.sizes[0].crop = [3, 3, 0, 0];
    let drawn = Glyph::of_network(Network::new(weights).unwrap()).render(10.0).unwrap();
    assert_eq!((drawn.placement, drawn.pixels.len()), (Placement::default(), 0));
}

#[test]
fn a_cache_that_holds_no_network_still_draws_them_all() {
    let font = Font::new(SANS.as_slice()).unwrap();
    let (mut none, mut all) = (Rasterizer::new(&font).with_cache(0), Rasterizer::new(&font));
    for _ in 0..2 {
        for network in &*NETWORKS {
            assert_eq!(none.render(network.gid, 12.0), all.render(network.gid, 12.0));
        }
    }
    let glyph = decode_glyph(&font, NETWORKS[0].gid).unwrap();
    let weights: usize = NETWORKS[0].weights.dense.iter().map(|dense| 4 * dense.weights.len()).sum();
    assert!(glyph.memory() > weights, "{} for {weights}", glyph.memory());
}

/// The steps of drawing a box: a multiplication for each weight of the trunk and each pixel.
fn work(weights: &NetworkWeights, side: u8) -> u64 {
    let trunk = &weights.dense[weights.dense.len() - TRUNK_LAYERS..];
    let latent = u64::from(weights.architecture.latent);
    let multiplied: u64 = trunk.iter().map(|dense| dense.weights.len() as u64).sum();
    // The latent vector's share of two layers is computed once for all pixels of the box.
    let constant = CONDITIONED.map(|layer| latent * trunk[layer].outputs as u64).iter().sum::<u64>();
    (multiplied - constant) * u64::from(side) * u64::from(side)
}

#[test]
fn a_network_is_drawn_with_as_much_work_as_it_takes_and_refused_with_less() {
    let font = Font::new(SANS.as_slice()).unwrap();
    for Stored { gid: glyph, weights, .. } in &*NETWORKS {
        for size in &weights.sizes {
            let (ppem, work) = (f32::from(size.ppem), work(weights, size.side));
            let mut limits = Limits::default();
            limits.work = work;
            assert!(Rasterizer::new(&font).with_limits(limits).render(*glyph, ppem).is_ok());
            limits.work = work - 1;
            let mut short = Rasterizer::new(&font).with_limits(limits);
            let refused = Err(Error::TooMuchWork { glyph: *glyph, work, limit: work - 1 });
            assert_eq!(short.render(*glyph, ppem), refused);
            // The placement takes no work.
            assert_eq!(short.placement(*glyph, ppem), Rasterizer::new(&font).placement(*glyph, ppem));
            let mut buffer = vec![77; 64 * 64];
            assert_eq!(short.render_into(*glyph, ppem, &mut buffer, 64).map(drop), refused.map(drop));
            assert!(buffer.iter().all(|pixel| *pixel == 77));
        }
    }
}

#[test]
fn models_composed_glyphs_and_networks_share_a_table() {
    let models = [1, 7].map(|gid| GlyphModel { gid, weights: Weights::default() });
    let part = Part { gid: 7, ..Part::default() };
    let composed = [Composed { gid: 5, parts: vec![part] }];
    let networks = [2u16, 6, 900].map(|gid| GlyphNetwork {
        gid,
        bytes: pack(&network(PLAIN_ARCHITECTURE, &[8], gid.into()), Precision::Sixteen),
    });
    let write = |networks: &[GlyphNetwork]| writer::write(&ABOUT, &models, &composed, networks, SCALE);
    let (bytes, lengths) = write(&networks).unwrap();
    let table = Table::parse(&bytes).unwrap();
    assert_eq!((table.header(), lengths.len()), (&ABOUT, 2));
    assert_eq!(table.gids().collect::<Vec<_>>(), [1, 2, 5, 6, 7, 900]);
    assert_eq!((table.gids().len(), table.network_gids().len()), (6, 3));
    let offsets = table.part_offsets(5, SCALE, usize::MAX).unwrap();
    assert_eq!(table.parts(5, SCALE, &offsets).unwrap(), composed[0].parts);
    for gid in table.gids().map(u32::from) {
        assert!(table.contains(gid));
        assert_eq!(table.is_network(gid), networks.iter().any(|network| u32::from(network.gid) == gid));
        assert_eq!(table.network(gid, usize::MAX).is_ok(), table.is_network(gid));
        assert_eq!(table.weights(gid, SCALE, usize::MAX).is_ok(), gid == 1 || gid == 7);
    }
    // Before the networks, a table is what it is without them but for the flag and the minor version.
    let (mut plain, _) = write(&[]).unwrap();
    assert_eq!((&plain[2..4], plain[5], &bytes[2..4], bytes[5]), (&[0u8, 0][..], 0, &[0u8, 1][..], 2));
    plain[3] = 1;
    plain[5] = 2;
    assert!(bytes.starts_with(&plain));
    // Out of order, twice, or of a glyph that has a model or parts.
    for gids in [[6, 2], [6, 6], [1, 6], [5, 6]] {
        let networks = gids.map(|gid| GlyphNetwork { gid, ..networks[0].clone() });
        assert!(matches!(write(&networks), Err(nfr_convert::Error::InvalidParameter(_))), "{gids:?}");
    }
    // A part is a model, never a network.
    let part = Part { gid: 2, ..Part::default() };
    let composed = [Composed { gid: 5, parts: vec![part] }];
    let refused = writer::write(&ABOUT, &models, &composed, &networks, SCALE);
    assert!(matches!(refused, Err(nfr_convert::Error::InvalidParameter(_))));
}

/// Does with a font what an application does.
fn use_font(data: Vec<u8>) -> Result<usize, Error> {
    let font = Font::new(data)?;
    let table = nfr::internals::table(&font)?;
    let mut rasterizer = Rasterizer::new(&font);
    let mut drawn = 0;
    for gid in font.modelled_glyphs().take(12) {
        let _ = (table.precision(gid), font.model_len(gid));
        match rasterizer.render(gid, 12.0) {
            Ok(bitmap) => drawn += bitmap.pixels.len(),
            Err(
                Error::MalformedModel { .. }
                | Error::ModelTooLarge { .. }
                | Error::DecodedTooLarge { .. }
                | Error::NoSuchGlyph(_)
                | Error::MissingModel(_)
                | Error::NetworkSize { .. },
            ) => {}
            Err(other) => panic!("the wrong kind of error: {other:?}"),
        }
    }
    Ok(drawn)
}

/// Where the `Nfrt` table is in the file.
fn table_range() -> std::ops::Range<usize> {
    let bytes = FontRef::new(&SANS).unwrap().table_data(TAG).unwrap().as_bytes();
    let start = bytes.as_ptr() as usize - SANS.as_ptr() as usize;
    start..start + bytes.len()
}

/// Where its networks begin: behind the header of a table that has nothing else.
const NETWORKS_AT: usize = 52;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damage_to_networks_is_survived(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6), near in any::<bool>(),
    ) {
        let mut data = SANS.clone();
        let range = table_range();
        // Near: among counts, ends, and the first network's architecture and sizes.
        let length = if near { NETWORKS_AT + 80 } else { range.len() };
        for (at, value) in damage {
            data[range.start + at.index(length)] = value;
        }
        if let Err(error) = use_font(data) {
            let expected = matches!(
                error,
                Error::MalformedModels { .. } | Error::UnknownVersion { .. } | Error::Renumbered { .. }
            );
            prop_assert!(expected, "{error:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]

    /// Of the vectors' font, whose frames zstd itself has written.
    #[test]
    fn damage_to_a_frame_is_an_error_or_another_network(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..5), near in any::<bool>(),
        cut in any::<Option<prop::sample::Index>>(),
    ) {
        let data = include_bytes!("../../../spec/vectors/network.ttf");
        let table = FontRef::new(data).unwrap().table_data(TAG).unwrap().as_bytes();
        let ends_at = NETWORKS_AT + 2 + 2 * 2;
        let end = u32::from_be_bytes(*table[ends_at..].first_chunk().unwrap()) as usize;
        let mut bytes = table[ends_at + 4 * 2..][..end].to_vec();
        let (_, frame) = Head::parse(&bytes).unwrap();
        let start = bytes.len() - frame.len();
        // Near: in the header of the frame, or in its first block's tables.
        let length = if near { 60 } else { frame.len() };
        for (at, value) in damage {
            bytes[start + at.index(length)] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(start + cut.index(length));
        }
        match decode(&bytes) {
            Ok(weights) => prop_assert!(Network::new(weights).is_ok()),
            Err(error) => prop_assert!(matches!(error, Damage::Malformed(_)), "{error:?}"),
        }
    }
}

#[test]
fn a_table_that_is_cut_off_anywhere_is_an_error() {
    let table = &SANS[table_range()];
    assert!(Table::parse(table).is_ok());
    for length in 0..table.len() {
        assert!(matches!(Table::parse(&table[..length]), Err(Error::MalformedModels { .. })), "{length}");
    }
}

#[test]
fn networks_whose_ends_descend_or_lie_outside_are_malformed() {
    let table = SANS[table_range()].to_vec();
    let ends_at = NETWORKS_AT + 2 + 2 * NETWORKS.len();
    let first = NETWORKS[0].gid;
    for end in [0, u32::MAX, table.len() as u32] {
        let mut table = table.clone();
        table[ends_at..][..4].copy_from_slice(&end.to_be_bytes());
        let table = Table::parse(&table).unwrap();
        assert!(matches!(table.network(first, usize::MAX), Err(Error::MalformedModel { .. })), "{end}");
        assert!(
            matches!(table.network(NETWORKS[1].gid, usize::MAX), Err(Error::MalformedModel { .. })),
            "{end}"
        );
        assert!(table.network(NETWORKS[2].gid, usize::MAX).is_ok());
    }
}
