//! A training's history in files: rate, loss and seconds of each epoch, as big-endian `f64`.

use super::Epoch;

/// Bytes of a number.
const NUMBER: usize = 8;
/// Bytes of an epoch.
const EPOCH: usize = 3 * NUMBER;

/// The history as bytes.
pub(super) fn written_history(history: &[Epoch]) -> Vec<u8> {
    let numbers = history.iter().flat_map(|epoch| [epoch.rate, epoch.loss, epoch.seconds]);
    numbers.flat_map(f64::to_be_bytes).collect()
}

/// The history that bytes hold; `None` if an epoch is cut off.
pub(super) fn read_history(bytes: &[u8]) -> Option<Vec<Epoch>> {
    let epochs = bytes.chunks_exact(EPOCH);
    if !epochs.remainder().is_empty() {
        return None;
    }
    let number = |epoch: &[u8], k: usize| {
        epoch[k * NUMBER..][..NUMBER].try_into().map(f64::from_be_bytes).unwrap_or_default()
    };
    let epoch =
        |epoch: &[u8]| Epoch { rate: number(epoch, 0), loss: number(epoch, 1), seconds: number(epoch, 2) };
    Some(epochs.map(epoch).collect())
}
