//! Batch norm, over the pixels of the bitmap that is drawn.

use alloc::vec;
use alloc::vec::Vec;

use wide::f32x8;

use super::dense::LANES;
use super::layout::Norm;
use crate::number::sqrt_f64;

/// Is added to variances, so that none is 0.
pub const EPSILON: f64 = 1e-3;

/// Normalises each feature over the first `pixels` pixels of `x`, in place. `x` has `gamma.len()` features of eight pixels
/// each for one tile after the other.
pub(super) fn norm(norm: &Norm, x: &mut [f32x8], pixels: usize) {
    let count = pixels as f64;
    let means: Vec<f64> = over(norm, x, pixels, |value, _| value).iter().map(|sum| sum / count).collect();
    let squares = over(norm, x, pixels, |value, feature| {
        let off = value - means[feature];
        off * off
    });
    let scale = |(gamma, sum): (&f32, f64)| (f64::from(*gamma) / sqrt_f64(sum / count + EPSILON)) as f32;
    let scales: Vec<f32> = norm.gamma.iter().zip(squares).map(scale).collect();
    for tile in x.chunks_exact_mut(norm.gamma.len()) {
        for (k, x) in tile.iter_mut().enumerate() {
            *x = (*x - f32x8::splat(means[k] as f32)) * f32x8::splat(scales[k]) + f32x8::splat(norm.beta[k]);
        }
    }
}

/// For each feature, the sum of `term(value, feature)` over the pixels in their order.
fn over(norm: &Norm, x: &[f32x8], pixels: usize, term: impl Fn(f64, usize) -> f64) -> Vec<f64> {
    let mut sums = vec![0.0; norm.gamma.len()];
    let mut left = pixels;
    for tile in x.chunks_exact(norm.gamma.len()) {
        for (feature, (sum, x)) in sums.iter_mut().zip(tile).enumerate() {
            for value in x.to_array().iter().take(left) {
                *sum += term(f64::from(*value), feature);
            }
        }
        left = left.saturating_sub(LANES);
    }
    sums
}
