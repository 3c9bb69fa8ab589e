//! The memory that reading networks allocates.
#![allow(clippy::unwrap_used)]

#[path = "../../../benches/network/mod.rs"]
mod noise;
mod packed;

use nfr::internals::network::Precision;
use nfr::internals::network::{Architecture, MAX_ENCODER, MAX_LATENT, MAX_WIDTH, Network};
use nfr::internals::network::{Head, decode, encode};
use nfr::internals::table::Header;
use nfr::{Error, Font, Limits, Rasterizer};
use nfr_convert::writer::GlyphNetwork;
use nfr_lab::network_font::with_networks;
use proptest::prelude::*;

use noise::network;
use packed::{blocks, frame, header, pack};

/// The most that is allocated at once while `work` runs.
fn peak<T>(work: impl FnOnce() -> T) -> usize {
    let mut kept = None;
    let info = allocation_counter::measure(|| kept = Some(work()));
    usize::try_from(info.bytes_max).unwrap()
}

/// What unpacking a frame takes beside its contents: tables, and the buffers of a block.
const UNPACKING: usize = 1 << 20;

#[test]
fn a_frame_that_does_not_hold_what_the_shape_needs_is_refused_before_that_much_is_allocated() {
    let architecture = Architecture {
        width: MAX_WIDTH,
        latent: MAX_LATENT,
        encoder: MAX_ENCODER,
        frequencies: true,
        residual: true,
    };
    // The head of a small network, made that of the largest.
    let small = Architecture { width: 1, latent: 0, encoder: 0, ..architecture };
    let mut head = encode(&network(small, &[8], 1), Precision::Sixteen).unwrap().head;
    for (at, number) in [(2, MAX_WIDTH), (4, MAX_LATENT), (6, MAX_ENCODER)] {
        head[at..at + 2].copy_from_slice(&number.to_be_bytes());
    }
    let needed = Head::parse(&head).unwrap().0.numbers_len();
    assert!(needed > 30 << 20, "{needed}");
    let some = blocks(&[0; 5000]);
    for (what, frame) in [
        ("nothing", Vec::new()),
        ("an end after the header", header(needed)),
        ("too little", [header(needed), some.clone()].concat()),
        ("an end after a block", [header(needed), some[..4096 + 3].to_vec()].concat()),
        ("a larger window than contents", [header(needed + 1), some.clone()].concat()),
        ("the largest window", [&[0x28, 0xb5, 0x2f, 0xfd, 0x80, 0xff][..], &[0; 4], &some].concat()),
    ] {
        let bytes = [head.clone(), frame].concat();
        let mut refused = false;
        let peak = peak(|| refused = decode(&bytes).is_err());
        assert!(refused && peak <= UNPACKING, "{what}: {peak} bytes");
    }
}

#[test]
fn a_frame_that_holds_more_than_the_shape_needs_is_given_up_early() {
    let architecture = Architecture { width: 40, latent: 7, encoder: 9, frequencies: true, residual: true };
    let encoded = encode(&network(architecture, &[8, 12], 3), Precision::Eight).unwrap();
    // 100,000 blocks of a repeated byte, 4 bytes each, that unpack to 400 MB.
    let block = [(4096u32 << 3 | 1 << 1).to_le_bytes()[..3].to_vec(), vec![0]].concat();
    let bomb = [encoded.head, header(encoded.numbers.len()), block.repeat(100_000)].concat();
    let mut refused = false;
    let peak = peak(|| refused = decode(&bomb).is_err());
    assert!(refused && peak <= UNPACKING, "{peak} bytes");
}

/// What drawing may allocate before it refuses: a network's head and sizes are read for that.
const REFUSING: usize = 1 << 10;
/// The glyph that has a network in [`one_network`].
const GLYPH: u32 = 68;

/// Liberation Sans with one network.
fn one_network(bytes: Vec<u8>) -> Font {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fonts/LiberationSans-Regular.ttf");
    let network = GlyphNetwork { gid: GLYPH as u16, bytes };
    Font::new(with_networks(&std::fs::read(path).unwrap(), 0, &[network], &Header::default()).unwrap())
        .unwrap()
}

#[test]
fn a_network_that_is_larger_than_a_decoded_glyph_may_be_is_refused_before_it_is_unpacked() {
    // About 11 MiB unpacked, which is above the default of 8 MiB.
    let wide = Architecture { width: 512, latent: 0, encoder: 0, frequencies: true, residual: true };
    let packed = pack(&network(wide, &[8], 5), Precision::Eight);
    let head = Head::parse(&packed).unwrap().0;
    let font = one_network(packed);
    let limit = Limits::default().decoded_bytes;
    let mut rasterizer = Rasterizer::new(&font);
    let mut refused = Ok(());
    let little = peak(|| refused = rasterizer.render(GLYPH, 8.0).map(drop));
    assert_eq!(refused, Err(Error::DecodedTooLarge { glyph: GLYPH, bytes: head.memory(), limit }));
    assert!(little <= REFUSING, "{little} bytes");
    // With higher limits it is drawn.
    let mut limits = Limits::default();
    (limits.decoded_bytes, limits.work) = (usize::MAX, u64::MAX);
    let mut rasterizer = rasterizer.with_limits(limits);
    let much = peak(|| rasterizer.render(GLYPH, 8.0).unwrap());
    assert!(much > head.memory(), "{much} bytes");
}

#[test]
fn a_network_that_takes_too_much_work_is_refused_before_it_is_evaluated() {
    let architecture = Architecture { width: 40, latent: 7, encoder: 9, frequencies: true, residual: true };
    let font = one_network(pack(&network(architecture, &[30], 6), Precision::Eight));
    let mut buffer = [77; 30 * 30];
    let mut draw = |work| {
        let mut limits = Limits::default();
        limits.work = work;
        let mut rasterizer = Rasterizer::new(&font).with_limits(limits);
        // Unpacks the network and keeps it.
        assert_eq!(rasterizer.placement(GLYPH, 30.0).unwrap().area(), buffer.len());
        let mut drawn = Ok(());
        let peak = peak(|| drawn = rasterizer.render_into(GLYPH, 30.0, &mut buffer, 30).map(drop));
        (drawn, peak, buffer.iter().all(|pixel| *pixel == 77))
    };
    let (refused, nothing, untouched) = draw(0);
    let Err(Error::TooMuchWork { glyph: GLYPH, work, limit: 0 }) = refused else { panic!("{refused:?}") };
    assert!(nothing == 0 && untouched, "{nothing} bytes");
    assert_eq!(draw(work - 1), (Err(Error::TooMuchWork { glyph: GLYPH, work, limit: work - 1 }), 0, true));
    let (drawn, features, untouched) = draw(work);
    // The features of all pixels in f32.
    assert!(drawn.is_ok() && features > 4 * 32 * 32 * 40 && !untouched, "{drawn:?}, {features} bytes");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_network_does_not_make_the_reader_allocate_more_than_its_numbers_are_worth(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4), narrow in any::<bool>(),
        in_head in any::<bool>(),
    ) {
        let (width, latent) = if narrow { (1, 1) } else { (40, 7) };
        let architecture = Architecture { width, latent, encoder: 9, frequencies: true, residual: true };
        let encoded = encode(&network(architecture, &[8, 12], 3), Precision::Eight).unwrap();
        let head = encoded.head.len();
        let mut bytes = [encoded.head, frame(&encoded.numbers)].concat();
        for (at, value) in damage {
            let at = if in_head { at.index(head) } else { head + at.index(bytes.len() - head) };
            bytes[at] = value;
        }
        let peak = peak(|| decode(&bytes).map(|weights| Network::new(weights).unwrap()));
        // A weight's byte becomes four, and those of one output are filled up to those of four.
        let limit = 20 * encoded.numbers.len() + UNPACKING;
        prop_assert!(peak <= limit, "{peak} bytes of {limit}");
    }
}
