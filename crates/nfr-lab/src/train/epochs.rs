//! A training's histories in files: rate, loss and seconds of each epoch, as big-endian `f64`, network by network.

use super::Epoch;

/// Bytes of a number.
const NUMBER: usize = 8;
/// Bytes of an epoch.
const EPOCH: usize = 3 * NUMBER;

/// The histories as bytes.
pub(super) fn written_histories(histories: &[Vec<Epoch>]) -> Vec<u8> {
    let numbers = histories.iter().flatten().flat_map(|epoch| [epoch.rate, epoch.loss, epoch.seconds]);
    numbers.flat_map(f64::to_be_bytes).collect()
}

/// The histories of so many networks that bytes hold; `None` if they are not as long as each other.
pub(super) fn read_histories(bytes: &[u8], networks: usize) -> Option<Vec<Vec<Epoch>>> {
    if networks == 0 || !bytes.len().is_multiple_of(EPOCH * networks) {
        return None;
    }
    if bytes.is_empty() {
        return Some(vec![Vec::new(); networks]);
    }
    let number = |epoch: &[u8], k: usize| {
        epoch[k * NUMBER..][..NUMBER].try_into().map(f64::from_be_bytes).unwrap_or_default()
    };
    let epoch =
        |epoch: &[u8]| Epoch { rate: number(epoch, 0), loss: number(epoch, 1), seconds: number(epoch, 2) };
    let history = |bytes: &[u8]| bytes.chunks_exact(EPOCH).map(epoch).collect();
    Some(bytes.chunks_exact(bytes.len() / networks).map(history).collect())
}
