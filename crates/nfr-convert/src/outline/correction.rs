//! Corrections: of what the tracks leave, that which is worth its bits.

use super::distortion::noise;
use super::samples::OutlineSamples;
use crate::options::Fidelity;
use nfr::internals::model::outline::{AxisHints, Correction, Tracks, in_64ths};

/// The bits that a correction takes, roughly.
const CORRECTION_BITS: f64 = 9.0;

/// The corrections that put points where hinting does, if that is worth it. `error` is what 1/64 pixel costs at a point at a size,
/// in pixels.
pub(super) fn correct(
    samples: &OutlineSamples,
    axis: usize,
    hints: &AxisHints,
    fidelity: Fidelity,
    error: impl Fn(usize, usize) -> f64,
) -> Vec<Correction> {
    let price = CORRECTION_BITS * fidelity.error_per_bit();
    let mut corrections = Vec::new();
    let noise = noise(samples, axis, fidelity);
    for size in 0..samples.sizes() {
        let mut places = vec![0; samples.points.len()];
        let tracks =
            Tracks::new(hints, hints.moves_at(size), &samples.points.on_curve, samples.interpolation(axis));
        for contour in samples.points.contours() {
            let units = &samples.points.coordinates[axis];
            tracks.place(units, contour, samples.scales[size], &mut places);
        }
        for (point, (place, hinted)) in places.iter().zip(samples.hinted_at(axis, size)).enumerate() {
            let place = in_64ths(*place);
            let saved = (f64::from(place.abs_diff(*hinted)) - noise).max(0.0) * error(point, size);
            if place != *hinted && saved >= price {
                corrections.push(Correction {
                    size: size as u16,
                    point: point as u16,
                    by: (hinted - place).clamp(i16::MIN.into(), i16::MAX.into()) as i16,
                });
            }
        }
    }
    corrections
}
