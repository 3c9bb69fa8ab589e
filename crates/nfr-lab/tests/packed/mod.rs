//! Networks packed without the C library that the converter packs them with.
#![allow(dead_code, reason = "every test file uses a part of it")]

use nfr::internals::network::Precision;
use nfr::internals::network::encode;
use nfr::internals::network::{Architecture, NetworkWeights};
use ruzstd::encoding::{CompressionLevel, compress_to_vec};

/// A small network.
pub(crate) const CONDITIONED_ARCHITECTURE: Architecture =
    Architecture { width: 12, latent: 5, encoder: 6, frequencies: true, residual: true };
/// Without sizes among its inputs, and as small as can be.
pub(crate) const PLAIN_ARCHITECTURE: Architecture =
    Architecture { width: 3, latent: 0, encoder: 0, frequencies: false, residual: false };

/// Bytes of a block; 128 KiB are allowed (RFC 8878, sec. 3.1.1.2.3).
const BLOCK: usize = 4 << 10;
/// The length of the header that ruzstd writes: magic number, descriptor and window.
const RUZSTD_HEADER: usize = 6;

/// A network as the table stores it.
pub(crate) fn pack(weights: &NetworkWeights, precision: Precision) -> Vec<u8> {
    let encoded = encode(weights, precision).unwrap();
    [encoded.head, frame(&encoded.numbers)].concat()
}

/// The header of a frame that says that it holds so many bytes, in a single segment (RFC 8878, sec. 3.1.1.1).
pub(crate) fn header(length: usize) -> Vec<u8> {
    let length = u32::try_from(length).unwrap().to_le_bytes();
    [[0x28, 0xb5, 0x2f, 0xfd, 0xa0].as_slice(), &length].concat()
}

/// A compressed frame. ruzstd's own header does not say how much a frame holds.
pub(crate) fn frame(plain: &[u8]) -> Vec<u8> {
    let packed = compress_to_vec(plain, CompressionLevel::Fastest);
    [header(plain.len()), packed[RUZSTD_HEADER..].to_vec()].concat()
}

/// A frame that holds bytes as they are.
pub(crate) fn stored(plain: &[u8]) -> Vec<u8> {
    [header(plain.len()), blocks(plain)].concat()
}

/// Blocks that hold bytes as they are.
pub(crate) fn blocks(plain: &[u8]) -> Vec<u8> {
    let last = plain.len().div_ceil(BLOCK).saturating_sub(1);
    let block = |(k, bytes): (usize, &[u8])| {
        let header = (bytes.len() as u32) << 3 | u32::from(k == last);
        [&header.to_le_bytes()[..3], bytes].concat()
    };
    plain.chunks(BLOCK).enumerate().flat_map(block).collect()
}
