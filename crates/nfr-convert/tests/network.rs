//! Networks survive being written and read, are drawn by the calls that draw models, and damaged ones are errors.
#![allow(clippy::unwrap_used)]

mod samples;

use std::sync::LazyLock;

use nfr::internals::model::compose::{Composed, Part};
use nfr::internals::model::gridfit::{Scale, Weights};
use nfr::internals::model::network::{
    MAX_BOX, MAX_ENCODER, MAX_LATENT, MAX_WIDTH, Network, NetworkWeights, Shape,
};
use nfr::internals::table::network::{decode, encode};
use nfr::internals::table::{self, GlyphModel, GlyphNetwork, Header, PartsDecoder, Precision, TAG, Table};
use nfr::{Error, Font, Glyph, Placement, Rasterizer, Setting, Target};
use nfr_convert::with_networks;
use proptest::prelude::*;
use read_fonts::{FontRef, TableProvider};

use samples::{font, gid, network};

const SHAPE: Shape = Shape { width: 12, latent: 5, encoder: 6, frequencies: true, residual: true };
/// Without sizes among its inputs, and as small as can be.
const PLAIN: Shape = Shape { width: 3, latent: 0, encoder: 0, frequencies: false, residual: false };
const SCALE: Scale = Scale { units_per_em: 1000, first_ppem: 8, last_ppem: 64 };
const ABOUT: Header = Header {
    target: Target::Mono,
    first_ppem: 8,
    last_ppem: 64,
    outline_hash: 0,
    outlines_dropped: false,
    seed: 9,
    steps: 700,
    knots: 0,
    rank: 0,
    cell: 0,
};

fn shape() -> impl Strategy<Value = Shape> {
    (1u16..30, 0u16..20, 1u16..9, any::<[bool; 2]>()).prop_map(
        |(width, latent, encoder, [frequencies, residual])| Shape {
            width,
            latent,
            encoder,
            frequencies,
            residual,
        },
    )
}

fn precision() -> impl Strategy<Value = Precision> {
    prop_oneof![Just(Precision::Eight), Just(Precision::Sixteen)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn a_network_is_read_as_it_was_written_but_for_rounding(
        shape in shape(), precision in precision(), seed in any::<u64>(),
    ) {
        let written = network(shape, &[8, 9, 30], seed);
        let read = decode(&encode(&written, precision).unwrap()).unwrap();
        prop_assert_eq!((read.shape, &read.sizes, &read.norms), (written.shape, &written.sizes, &written.norms));
        let most = if precision == Precision::Eight { 127.0 } else { 32767.0 };
        for (read, written) in read.dense.iter().zip(&written.dense) {
            prop_assert_eq!(&read.bias, &written.bias);
            for output in 0..written.outputs {
                let column = |weights: &[f32]| -> Vec<f32> {
                    weights.iter().skip(output).step_by(written.outputs).copied().collect()
                };
                let (read, written) = (column(&read.weights), column(&written.weights));
                let largest = written.iter().fold(0f32, |largest, weight| largest.max(weight.abs()));
                for (read, written) in read.iter().zip(&written) {
                    prop_assert!((read - written).abs() <= largest / most * 0.505);
                }
            }
        }
        // What was rounded once is rounded to the same again.
        let again = decode(&encode(&read, precision).unwrap()).unwrap();
        for (again, read) in again.dense.iter().zip(&read.dense) {
            for (again, read) in again.weights.iter().zip(&read.weights) {
                prop_assert!((again - read).abs() <= 1e-6 * read.abs());
            }
        }
    }

    #[test]
    fn a_network_that_is_cut_off_or_too_long_is_malformed(
        shape in shape(), precision in precision(), at in any::<prop::sample::Index>(),
    ) {
        let mut bytes = encode(&network(shape, &[8], 1), precision).unwrap();
        prop_assert!(matches!(decode(&bytes[..at.index(bytes.len())]), Err(Error::Malformed(_))));
        bytes.push(0);
        prop_assert!(matches!(decode(&bytes), Err(Error::Malformed(_))));
    }

    #[test]
    fn random_bytes_are_a_network_or_an_error(
        mut bytes in prop::collection::vec(any::<u8>(), 0..3000), likely in any::<bool>(),
    ) {
        if likely && bytes.len() > 9 {
            bytes[..9].copy_from_slice(&[3, 8, 0, 1, 0, 0, 0, 0, 1]);
            bytes.resize(encode(&network(Shape { width: 1, latent: 0, encoder: 0, ..SHAPE }, &[8], 1),
                Precision::Eight).unwrap().len(), 7);
        }
        match decode(&bytes) {
            Ok(weights) => prop_assert!(Network::new(weights).is_ok()),
            Err(Error::Malformed(_) | Error::LimitExceeded(_)) => {}
            Err(other) => return Err(TestCaseError::fail(format!("the wrong kind of error: {other:?}"))),
        }
    }
}

#[test]
fn weights_of_0_and_huge_ones_can_be_stored() {
    let mut weights = network(PLAIN, &[8], 1);
    weights.dense[1].weights.fill(0.0);
    weights.dense[2].weights.fill(f32::MAX);
    weights.dense[3].weights.fill(f32::MIN_POSITIVE / 8.0);
    for precision in [Precision::Eight, Precision::Sixteen] {
        let read = decode(&encode(&weights, precision).unwrap()).unwrap();
        assert_eq!(read.dense[1].weights, weights.dense[1].weights);
        assert!(read.dense[2].weights.iter().all(|weight| *weight > 0.99 * f32::MAX));
        assert!(Network::new(read).unwrap().levels(0).is_ok());
    }
}

/// The bytes of a network, changed at some places.
fn changed(weights: &NetworkWeights, changes: &[(usize, &[u8])]) -> Result<NetworkWeights, Error> {
    let mut bytes = encode(weights, Precision::Eight).unwrap();
    for (at, value) in changes {
        bytes[*at..][..value.len()].copy_from_slice(value);
    }
    decode(&bytes)
}

#[test]
fn what_is_beyond_the_limits_is_refused_before_it_is_read() {
    let weights = network(SHAPE, &[8, 9], 1);
    assert!(changed(&weights, &[]).is_ok());
    let limits = [(2, MAX_WIDTH), (4, MAX_LATENT), (6, MAX_ENCODER)];
    for (at, most) in limits {
        let change = (most + 1).to_be_bytes();
        assert!(matches!(changed(&weights, &[(at, &change)]), Err(Error::LimitExceeded(_))), "{at}");
        // Within the limits there are too few bytes.
        assert!(matches!(changed(&weights, &[(at, &most.to_be_bytes())]), Err(Error::Malformed(_))), "{at}");
    }
    assert!(matches!(changed(&weights, &[(2, &[0, 0])]), Err(Error::LimitExceeded(_))));
    assert!(matches!(changed(&weights, &[(6, &[0, 0])]), Err(Error::LimitExceeded(_))));
    const FIRST_SIZE: usize = 9;
    let malformed: [(usize, &[u8]); 12] = [
        (0, &[4]),
        (1, &[4]),
        (8, &[0]),
        (8, &[65]),
        (FIRST_SIZE, &[0, 0]),
        (FIRST_SIZE, &[4, 1]),
        (FIRST_SIZE + 2, &[0]),
        (FIRST_SIZE + 2, &[12]),
        (FIRST_SIZE + 7, &[3]),
        (FIRST_SIZE + 10, &[10]),
        // The first scale: not a number, and one that makes weights infinite.
        (FIRST_SIZE + 22, &[0x7f, 0xc0, 0, 0]),
        (FIRST_SIZE + 22, &[0x7f, 0x7f, 0, 0]),
    ];
    for (at, bytes) in malformed {
        assert!(matches!(changed(&weights, &[(at, bytes)]), Err(Error::Malformed(_))), "{bytes:?} at {at}");
    }
    let box_too_large = [(FIRST_SIZE + 13, [MAX_BOX + 1].as_slice())];
    assert!(matches!(changed(&weights, &box_too_large), Err(Error::Malformed(_))));
}

/// Networks for the letters a, b and c: the first two in 8 bits, the last in 16.
static NETWORKS: LazyLock<[GlyphNetwork; 3]> = LazyLock::new(|| {
    let sans = font("LiberationSans-Regular");
    let of = |letter, shape, ppems: &[u16], precision| {
        let gid = gid(&sans, letter);
        GlyphNetwork { gid, weights: network(shape, ppems, gid.into()), precision }
    };
    [
        of('a', SHAPE, &[8, 12, 20], Precision::Eight),
        of('b', PLAIN, &[9, 12], Precision::Eight),
        of('c', Shape { residual: false, ..SHAPE }, &[12, 40], Precision::Sixteen),
    ]
});

/// Liberation Sans with them.
static SANS: LazyLock<Vec<u8>> =
    LazyLock::new(|| with_networks(&font("LiberationSans-Regular"), 0, &*NETWORKS, &ABOUT).unwrap());

#[test]
fn a_font_with_networks_tells_what_it_has() {
    let font = Font::parse(&SANS).unwrap();
    assert_eq!((font.ppem_range(), font.target(), font.header().seed), ((8, 40), Target::Mono, 9));
    assert!(font.outlines_match() && !font.outlines_dropped());
    let gids: Vec<u16> = NETWORKS.iter().map(|network| network.gid).collect();
    assert!(font.modelled_glyphs().eq(gids.iter().copied()) && font.networks().eq(gids.iter().copied()));
    for network in &*NETWORKS {
        let bytes = encode(&network.weights, network.precision).unwrap().len();
        assert!(font.has_model(network.gid) && font.is_network(network.gid));
        assert_eq!(font.model_len(network.gid), Ok(bytes));
        assert_eq!(font.precision(network.gid), Ok(network.precision));
        assert_eq!(font.glyph(network.gid).unwrap().network().unwrap().sizes(), network.weights.sizes);
    }
    let other = gids[2] + 1;
    assert!(!font.has_model(other) && !font.is_network(other));
    assert_eq!(font.precision(other), Err(Error::MissingGlyph(other)));
    assert_eq!(font.model_len(other), Err(Error::MissingGlyph(other)));
    assert!(matches!(font.glyph(other), Err(Error::MissingGlyph(_))));
    // The outlines are there for other renderers.
    assert!(FontRef::new(&SANS).unwrap().glyf().is_ok());
}

#[test]
fn all_calls_draw_the_part_of_the_box_that_the_size_names() {
    let font = Font::parse(&SANS).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    for network in &*NETWORKS {
        let rounded = decode(&encode(&network.weights, network.precision).unwrap()).unwrap();
        let whole = Network::new(rounded).unwrap();
        let glyph = font.glyph(network.gid).unwrap();
        for (index, size) in network.weights.sizes.iter().enumerate() {
            let (side, ppem) = (usize::from(size.side), f32::from(size.ppem));
            let placement = rasterizer.placement(network.gid, ppem).unwrap();
            // The crop leaves a border of one pixel; the pen is two pixels from the left, the baseline three rows from
            // the end.
            let length = u32::from(size.side) - 2;
            let expected = Placement { left: -1, top: length as i32 - 2, width: length, height: length };
            assert_eq!(placement, expected);
            let levels = whole.levels(index).unwrap();
            let rows = levels.chunks(side).skip(1).take(side - 2);
            let pixels: Vec<u8> = rows.flat_map(|row| row[1..side - 1].to_vec()).collect();
            let drawn = rasterizer.render(network.gid, ppem).unwrap();
            assert_eq!((drawn.placement, &drawn.pixels), (placement, &pixels));
            assert_eq!(glyph.render(ppem + 0.4).unwrap(), drawn);
            let mut buffer = vec![77; pixels.len() + 3];
            assert_eq!(rasterizer.render_into(network.gid, ppem - 0.5, &mut buffer), Ok(placement));
            assert!(buffer.starts_with(&pixels) && buffer.ends_with(&[77; 3]));
            let small = rasterizer.render_into(network.gid, ppem, &mut buffer[..pixels.len() - 1]);
            assert!(matches!(small, Err(Error::InvalidParameter(_))));
        }
    }
}

#[test]
fn bitmaps_are_not_all_of_one_level() {
    let font = Font::parse(&SANS).unwrap();
    let drawn = font.glyph(NETWORKS[0].gid).unwrap().render(20.0).unwrap();
    let mut levels = drawn.pixels.clone();
    levels.sort_unstable();
    levels.dedup();
    assert!(levels.len() > 4, "{levels:?}");
}

#[test]
fn a_size_that_was_not_trained_is_unsupported_and_the_error_names_those_that_were() {
    let font = Font::parse(&SANS).unwrap();
    let mut rasterizer = Rasterizer::new(&font);
    for ppem in [7.4, 13.0, 11.4, 12.5, 200.0] {
        let refused = rasterizer.render(NETWORKS[0].gid, ppem);
        assert!(matches!(&refused, Err(Error::Unsupported(why)) if why.contains("8, 12, 20")), "{refused:?}");
    }
    assert!(matches!(rasterizer.render(NETWORKS[0].gid, -1.0), Err(Error::InvalidParameter(_))));
}

#[test]
fn whole_pixels_move_the_box_and_parts_of_one_are_unsupported() {
    let font = Font::parse(&SANS).unwrap();
    let glyph = font.glyph(NETWORKS[1].gid).unwrap();
    let still = glyph.render(12.0).unwrap();
    let moved = glyph.render(Setting { ppem: 12.0, pen: [-3.0, 5.0] }).unwrap();
    assert_eq!(
        (moved.placement.left, moved.placement.top),
        (still.placement.left - 3, still.placement.top + 5)
    );
    assert_eq!(moved.pixels, still.pixels);
    for pen in [[0.25, 0.0], [0.0, -0.5]] {
        let refused = glyph.render(Setting { ppem: 12.0, pen });
        assert!(matches!(refused, Err(Error::Unsupported(why)) if why.contains("round the pen")));
    }
}

#[test]
fn the_first_of_several_sizes_of_one_ppem_is_drawn() {
    let mut weights = network(SHAPE, &[10, 12, 20], 4);
    weights.sizes[2].ppem = 12;
    let drawn = Glyph::of_network(Network::new(weights).unwrap()).render(12.0).unwrap();
    assert_eq!(drawn.placement.width, 12);
}

#[test]
fn a_glyph_without_ink_has_no_pixels() {
    let mut weights = network(SHAPE, &[10], 4);
    weights.sizes[0].crop = [3, 3, 0, 0];
    let drawn = Glyph::of_network(Network::new(weights).unwrap()).render(10.0).unwrap();
    assert_eq!((drawn.placement, drawn.pixels.len()), (Placement::default(), 0));
}

#[test]
fn a_cache_that_holds_no_network_still_draws_them_all() {
    let font = Font::parse(&SANS).unwrap();
    let (mut none, mut all) = (Rasterizer::with_cache(&font, 0), Rasterizer::new(&font));
    for _ in 0..2 {
        for network in &*NETWORKS {
            assert_eq!(none.render(network.gid, 12.0), all.render(network.gid, 12.0));
        }
    }
    let glyph = font.glyph(NETWORKS[0].gid).unwrap();
    let weights: usize = NETWORKS[0].weights.dense.iter().map(|dense| 4 * dense.weights.len()).sum();
    assert!(glyph.memory() > weights, "{} for {weights}", glyph.memory());
}

#[test]
fn models_composed_glyphs_and_networks_share_a_table() {
    let models = [1, 7].map(|gid| GlyphModel { gid, weights: Weights::default() });
    let part = Part { gid: 7, ..Part::default() };
    let composed = [Composed { gid: 5, parts: vec![part] }];
    let networks = [2u16, 6, 900].map(|gid| GlyphNetwork {
        gid,
        weights: network(PLAIN, &[8], gid.into()),
        precision: Precision::Sixteen,
    });
    let write = |networks: &[GlyphNetwork]| table::write(&ABOUT, &models, &composed, networks, SCALE);
    let (bytes, lengths) = write(&networks).unwrap();
    let table = Table::parse(&bytes).unwrap();
    assert_eq!((table.header(), lengths.len()), (&ABOUT, 2));
    assert_eq!(table.gids().collect::<Vec<_>>(), [1, 2, 5, 6, 7, 900]);
    assert_eq!((table.gids().len(), table.network_gids().len()), (6, 3));
    assert_eq!(PartsDecoder::default().parts(&table, 5, SCALE).unwrap(), composed[0].parts);
    for gid in table.gids() {
        assert!(table.contains(gid));
        assert_eq!(table.is_network(gid), networks.iter().any(|network| network.gid == gid));
        assert_eq!(table.network(gid).is_ok(), table.is_network(gid));
        assert_eq!(table.weights(gid, SCALE).is_ok(), gid == 1 || gid == 7);
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
        assert!(matches!(write(&networks), Err(Error::InvalidParameter(_))), "{gids:?}");
    }
    // A part is a model, never a network.
    let part = Part { gid: 2, ..Part::default() };
    let composed = [Composed { gid: 5, parts: vec![part] }];
    let refused = table::write(&ABOUT, &models, &composed, &networks, SCALE);
    assert!(matches!(refused, Err(Error::InvalidParameter(_))));
}

#[test]
fn networks_that_do_not_fit_a_font_are_refused() {
    let sans = font("LiberationSans-Regular");
    let with = |networks: &[GlyphNetwork]| with_networks(&sans, 0, networks, &ABOUT);
    assert!(matches!(with(&[]), Err(nfr_convert::Error::InvalidParameter(_))));
    let far = GlyphNetwork { gid: 60_000, ..NETWORKS[0].clone() };
    assert_eq!(with(&[far]), Err(nfr_convert::Error::MissingGlyph(60_000)));
    let mut broken = NETWORKS[0].clone();
    broken.weights.dense[3].bias[0] = f32::NAN;
    assert!(matches!(with(&[broken]), Err(nfr_convert::Error::InvalidParameter(_))));
    assert!(matches!(
        with(&[NETWORKS[1].clone(), NETWORKS[0].clone()]),
        Err(nfr_convert::Error::InvalidParameter(_))
    ));
    let again = with_networks(&SANS, 0, &*NETWORKS, &ABOUT);
    assert!(matches!(again, Err(nfr_convert::Error::Unsupported(why)) if why.contains("already")));
}

/// Does with a font what an application does.
fn use_font(data: &[u8]) -> Result<usize, Error> {
    let font = Font::parse(data)?;
    let mut rasterizer = Rasterizer::new(&font);
    let mut drawn = 0;
    for gid in font.modelled_glyphs().take(12) {
        let _ = (font.precision(gid), font.model_len(gid));
        match rasterizer.render(gid, 12.0) {
            Ok(bitmap) => drawn += bitmap.pixels.len(),
            Err(
                Error::Malformed(_)
                | Error::LimitExceeded(_)
                | Error::MissingGlyph(_)
                | Error::Unsupported(_),
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
        // Near: among counts, ends, and the first network's shape and sizes.
        let length = if near { NETWORKS_AT + 80 } else { range.len() };
        for (at, value) in damage {
            data[range.start + at.index(length)] = value;
        }
        if let Err(error) = use_font(&data) {
            prop_assert!(matches!(error, Error::Malformed(_) | Error::Unsupported(_)), "{error:?}");
        }
    }
}

#[test]
fn a_table_that_is_cut_off_anywhere_is_an_error() {
    let table = &SANS[table_range()];
    assert!(Table::parse(table).is_ok());
    for length in 0..table.len() {
        assert!(matches!(Table::parse(&table[..length]), Err(Error::Malformed(_))), "{length}");
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
        assert!(matches!(table.network(first), Err(Error::Malformed(_))), "{end}");
        assert!(matches!(table.network(NETWORKS[1].gid), Err(Error::Malformed(_))), "{end}");
        assert!(table.network(NETWORKS[2].gid).is_ok());
    }
}
