//! Fitted and encoded outlines as bytes of a work file. They are read by the version that wrote them only, and a checksum guards them.

use super::fit::FittedOutline;
use nfr::internals::model::outline::{AxisHints, Correction, OutlineWeights};

/// The message of an outline model, and the weights that it has.
pub(crate) type Encoded = (Vec<u8>, OutlineWeights);

/// A fitted outline as bytes; none stands for a glyph that cannot have one.
pub(crate) fn keep_fitted(outline: Option<&FittedOutline>) -> Vec<u8> {
    let mut out = vec![u8::from(outline.is_some())];
    if let Some(outline) = outline {
        put_weights(&mut out, &outline.weights);
        for costs in outline.costs.iter().flatten() {
            put_list(&mut out, costs, |cost| cost.to_bits().to_be_bytes());
        }
    }
    out
}

/// Reads what [`keep_fitted`] has written: none if it cannot be read.
pub(crate) fn kept_fitted(bytes: &[u8]) -> Option<Option<FittedOutline>> {
    let (is_some, mut bytes) = bytes.split_first()?;
    if *is_some == 0 {
        return Some(None);
    }
    let bytes = &mut bytes;
    let weights = weights(bytes)?;
    let mut costs = [Vec::new(), Vec::new()];
    for (costs, hints) in costs.iter_mut().zip(&weights.axes) {
        for _ in &hints.levels {
            costs.push(list(bytes, |bits| f64::from_bits(u64::from_be_bytes(bits)))?);
        }
    }
    Some(Some(FittedOutline { weights, costs }))
}

/// An encoded outline as bytes.
pub(crate) fn keep_encoded((message, weights): &Encoded) -> Vec<u8> {
    let mut out = Vec::new();
    put_list(&mut out, message, |byte| [*byte]);
    put_weights(&mut out, weights);
    out
}

/// Reads what [`keep_encoded`] has written: none if it cannot be read.
pub(crate) fn kept_encoded(mut bytes: &[u8]) -> Option<Encoded> {
    let bytes = &mut bytes;
    Some((list(bytes, |[byte]| byte)?, weights(bytes)?))
}

fn put_weights(out: &mut Vec<u8>, weights: &OutlineWeights) {
    for hints in &weights.axes {
        out.push(hints.is_hinted.into());
        out.extend((hints.first_size as u32).to_be_bytes());
        put_list(out, &hints.levels, |level| level.to_be_bytes());
        put_list(out, &hints.track_of, |track| [*track]);
        put_list(out, &hints.is_local, |is_local| [u8::from(*is_local)]);
        put_list(out, &hints.moves, |by| by.to_be_bytes());
        put_list(out, &hints.corrections, |c| {
            let [size, point, by] = [c.size.to_be_bytes(), c.point.to_be_bytes(), c.by.to_be_bytes()];
            [size[0], size[1], point[0], point[1], by[0], by[1]]
        });
    }
    put_list(out, &weights.advances, |advance| advance.to_be_bytes());
}

fn weights(bytes: &mut &[u8]) -> Option<OutlineWeights> {
    let mut weights = OutlineWeights::default();
    for hints in &mut weights.axes {
        let [is_hinted] = take(bytes)?;
        *hints = AxisHints {
            is_hinted: is_hinted != 0,
            first_size: u32::from_be_bytes(take(bytes)?) as usize,
            levels: list(bytes, i16::from_be_bytes)?,
            track_of: list(bytes, |[track]| track)?,
            is_local: list(bytes, |[is_local]| is_local != 0)?,
            moves: list(bytes, i16::from_be_bytes)?,
            corrections: list(bytes, |c: [u8; 6]| Correction {
                size: u16::from_be_bytes([c[0], c[1]]),
                point: u16::from_be_bytes([c[2], c[3]]),
                by: i16::from_be_bytes([c[4], c[5]]),
            })?,
        };
    }
    weights.advances = list(bytes, i8::from_be_bytes)?;
    Some(weights)
}

/// Appends the number of items (`u32`, big-endian) and the items.
fn put_list<T, const N: usize>(out: &mut Vec<u8>, items: &[T], bytes: impl Fn(&T) -> [u8; N]) {
    out.extend((items.len() as u32).to_be_bytes());
    items.iter().for_each(|item| out.extend(bytes(item)));
}

fn list<T, const N: usize>(bytes: &mut &[u8], item: impl Fn([u8; N]) -> T) -> Option<Vec<T>> {
    let length = u32::from_be_bytes(take(bytes)?) as usize;
    let (items, rest) = bytes.split_at_checked(length.checked_mul(N)?)?;
    *bytes = rest;
    Some(items.as_chunks().0.iter().map(|bytes| item(*bytes)).collect())
}

fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn outline() -> FittedOutline {
        let hints = AxisHints {
            is_hinted: true,
            first_size: 1,
            levels: vec![-3, 700],
            track_of: vec![0, 1, 255],
            is_local: vec![true, false],
            moves: vec![-64, 12, 0, 300],
            corrections: vec![Correction { size: 1, point: 2, by: -7 }],
        };
        let axes = [AxisHints::default(), hints];
        let costs = [Vec::new(), vec![vec![0.1, f64::MAX], vec![1e-300, 0.0]]];
        FittedOutline { weights: OutlineWeights { axes, advances: vec![0, -1] }, costs }
    }

    #[test]
    fn outlines_are_read_as_they_were_kept() {
        assert!(kept_fitted(&keep_fitted(None)).unwrap().is_none());
        let read = kept_fitted(&keep_fitted(Some(&outline()))).unwrap().unwrap();
        assert_eq!((read.weights, read.costs), (outline().weights, outline().costs));
        let encoded = (b"message".to_vec(), outline().weights);
        assert_eq!(kept_encoded(&keep_encoded(&encoded)), Some(encoded));
    }

    #[test]
    fn bytes_that_are_cut_off_are_no_outline() {
        let (fitted, encoded) = (keep_fitted(Some(&outline())), keep_encoded(&(vec![1], outline().weights)));
        assert!((0..fitted.len()).all(|cut| kept_fitted(&fitted[..cut]).is_none()));
        assert!((0..encoded.len()).all(|cut| kept_encoded(&encoded[..cut]).is_none()));
    }
}
