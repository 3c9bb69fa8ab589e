//! Networks survive being written and read, and damaged ones are errors.
#![allow(clippy::unwrap_used)]

#[path = "../../../benches/network/mod.rs"]
mod noise;
mod packed;

use nfr::internals::Damage;
use nfr::internals::network::Precision;
use nfr::internals::network::{
    Architecture, MAX_BOX, MAX_ENCODER, MAX_LATENT, MAX_WIDTH, Network, NetworkWeights,
};
use nfr::internals::network::{Head, decode, encode};
use proptest::prelude::*;

use noise::network;
use packed::{CONDITIONED_ARCHITECTURE, PLAIN_ARCHITECTURE, blocks, frame, pack, stored};

fn architecture() -> impl Strategy<Value = Architecture> {
    (1u16..30, 0u16..20, 1u16..9, any::<[bool; 2]>()).prop_map(
        |(width, latent, encoder, [frequencies, residual])| Architecture {
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
        architecture in architecture(), precision in precision(), seed in any::<u64>(),
    ) {
        let written = network(architecture, &[8, 9, 30], seed);
        let packed = pack(&written, precision);
        let read = decode(&packed).unwrap();
        let (head, frame) = Head::parse(&packed).unwrap();
        prop_assert_eq!((head.precision, head.architecture, &head.sizes), (precision, written.architecture, &written.sizes));
        prop_assert_eq!(head.numbers_len(), encode(&written, precision).unwrap().numbers.len());
        prop_assert!(packed.ends_with(frame));
        prop_assert_eq!((read.architecture, &read.sizes, &read.norms), (written.architecture, &written.sizes, &written.norms));
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
        let again = decode(&pack(&read, precision)).unwrap();
        for (again, read) in again.dense.iter().zip(&read.dense) {
            for (again, read) in again.weights.iter().zip(&read.weights) {
                prop_assert!((again - read).abs() <= 1e-6 * read.abs());
            }
        }
    }

    #[test]
    fn a_network_that_is_cut_off_or_too_long_is_malformed(
        architecture in architecture(), precision in precision(), at in any::<prop::sample::Index>(),
    ) {
        let mut bytes = pack(&network(architecture, &[8], 1), precision);
        prop_assert!(matches!(decode(&bytes[..at.index(bytes.len())]), Err(Damage::Malformed(_))));
        bytes.push(0);
        prop_assert!(matches!(decode(&bytes), Err(Damage::Malformed(_))));
    }

    #[test]
    fn random_bytes_are_a_network_or_an_error(
        mut bytes in prop::collection::vec(any::<u8>(), 0..3000), likely in any::<bool>(),
    ) {
        if likely && bytes.len() > 9 {
            bytes[..9].copy_from_slice(&[3, 8, 0, 1, 0, 0, 0, 0, 1]);
            let small = Architecture { width: 1, latent: 0, encoder: 0, ..CONDITIONED_ARCHITECTURE };
            let encoded = encode(&network(small, &[8], 1), Precision::Eight).unwrap();
            bytes.truncate(encoded.head.len());
            bytes.resize(encoded.head.len(), 7);
            bytes.extend(stored(&vec![7; encoded.numbers.len()]));
        }
        match decode(&bytes) {
            Ok(weights) => prop_assert!(Network::new(weights).is_ok()),
            Err(damage) => prop_assert!(damage != Damage::Stale),
        }
    }
}

#[test]
fn weights_of_0_and_huge_ones_can_be_stored() {
    let mut weights = network(PLAIN_ARCHITECTURE, &[8], 1);
    weights.dense[1].weights.fill(0.0);
    weights.dense[2].weights.fill(f32::MAX);
    weights.dense[3].weights.fill(f32::MIN_POSITIVE / 8.0);
    for precision in [Precision::Eight, Precision::Sixteen] {
        let read = decode(&pack(&weights, precision)).unwrap();
        assert_eq!(read.dense[1].weights, weights.dense[1].weights);
        assert!(read.dense[2].weights.iter().all(|weight| *weight > 0.99 * f32::MAX));
        assert!(Network::new(read).unwrap().coverage(0).is_some());
    }
}

/// A network, changed at some places of its bytes before they are packed.
fn changed(weights: &NetworkWeights, changes: &[(usize, &[u8])]) -> Result<NetworkWeights, Damage> {
    let encoded = encode(weights, Precision::Eight).unwrap();
    let mut bytes = [&encoded.head[..], &encoded.numbers].concat();
    for (at, value) in changes {
        bytes[*at..][..value.len()].copy_from_slice(value);
    }
    let (head, numbers) = bytes.split_at(encoded.head.len());
    decode(&[head, &frame(numbers)].concat())
}

#[test]
fn what_is_beyond_the_limits_is_refused_before_it_is_read() {
    let weights = network(CONDITIONED_ARCHITECTURE, &[8, 9], 1);
    assert!(changed(&weights, &[]).is_ok());
    let limits = [(2, MAX_WIDTH), (4, MAX_LATENT), (6, MAX_ENCODER)];
    for (at, most) in limits {
        let refused = changed(&weights, &[(at, &(most + 1).to_be_bytes())]);
        let (asked, allowed) = (u64::from(most) + 1, u64::from(most));
        assert!(
            matches!(refused, Err(Damage::TooLarge { count, limit, .. }) if (count, limit) == (asked, allowed)),
            "{refused:?}"
        );
        // Within the limits there are too few bytes.
        assert!(matches!(changed(&weights, &[(at, &most.to_be_bytes())]), Err(Damage::Malformed(_))), "{at}");
    }
    for at in [2, 6] {
        let refused = changed(&weights, &[(at, &[0, 0])]);
        assert!(
            matches!(refused, Err(Damage::Malformed(why)) if why.contains("without features")),
            "{refused:?}"
        );
    }
    const FIRST_SIZE: usize = 9;
    let malformed: [(usize, &[u8]); 10] = [
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
    ];
    for (at, bytes) in malformed {
        assert!(matches!(changed(&weights, &[(at, bytes)]), Err(Damage::Malformed(_))), "{bytes:?} at {at}");
    }
    // The first scale, whose bytes stand apart: not a number, and one that makes weights infinite.
    const NUMBERS: usize = FIRST_SIZE + 22;
    let outputs: usize = weights.dense.iter().map(|dense| dense.outputs).sum();
    let floats = 2 * outputs + 6 * usize::from(CONDITIONED_ARCHITECTURE.width);
    for second in [0xc0, 0x7f] {
        let scale: [(usize, &[u8]); 2] = [(NUMBERS, &[0x7f]), (NUMBERS + floats, &[second])];
        let refused = changed(&weights, &scale);
        assert!(matches!(&refused, Err(Damage::Malformed(why)) if why.contains("finite")), "{refused:?}");
    }
    let box_too_large = [(FIRST_SIZE + 13, [MAX_BOX + 1].as_slice())];
    assert!(matches!(changed(&weights, &box_too_large), Err(Damage::Malformed(_))));
}

#[test]
fn a_frame_that_holds_something_else_than_it_has_to_is_refused() {
    let encoded = encode(&network(CONDITIONED_ARCHITECTURE, &[8], 1), Precision::Eight).unwrap();
    let with = |frame: &[u8]| decode(&[&encoded.head[..], frame].concat());
    let length = encoded.numbers.len();
    assert!(with(&frame(&encoded.numbers)).is_ok() && with(&stored(&encoded.numbers)).is_ok());
    let refused = |frame: &[u8], what: &str| {
        let refused = with(frame);
        assert!(matches!(&refused, Err(Damage::Malformed(why)) if why.contains(what)), "{what}: {refused:?}");
    };
    refused(&stored(&encoded.numbers[1..]), "not as many numbers");
    // More than the window may be, which is checked before anything is allocated.
    refused(&stored(&[&encoded.numbers[..], &[0]].concat()), "cannot be unpacked");
    // Frames that say that they hold what they should, and hold more or less.
    let claims = |numbers: &[u8]| [packed::header(length), blocks(numbers)].concat();
    refused(&claims(&encoded.numbers[..length - 1]), "fewer numbers than it says");
    refused(&claims(&vec![0; length + 1]), "more numbers than it says");
    refused(&claims(&vec![0; 100 * length]), "more numbers than it says");
    refused(&[frame(&encoded.numbers), frame(&encoded.numbers)].concat(), "behind them");
    // Without a size of its contents, with a dictionary, one to skip, and of another format.
    refused(
        &ruzstd::encoding::compress_to_vec(&encoded.numbers[..], ruzstd::encoding::CompressionLevel::Fastest),
        "",
    );
    let mut dictionary = packed::header(length);
    dictionary[4] |= 1;
    dictionary.insert(5, 9);
    refused(&[dictionary, blocks(&encoded.numbers)].concat(), "cannot be unpacked");
    refused(
        &[&[0x50, 0x2a, 0x4d, 0x18, 2, 0, 0, 0, 1, 2][..], &frame(&encoded.numbers)].concat(),
        "cannot be unpacked",
    );
    refused(&[0x1f, 0x8b, 8, 0, 0, 0, 0, 0], "cannot be unpacked");
    refused(&[], "cannot be unpacked");
}
