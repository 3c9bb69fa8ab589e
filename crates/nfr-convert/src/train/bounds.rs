//! Constraints of the training: a model's bitmap stays within the box of the teacher's.

use burn::tensor::{Device, Tensor};

use super::batch::Extent;
use super::tensors::hinted_tensors;
use crate::fit::Parameters;
use crate::training_samples::GlyphSamples;
use nfr::{Bitmap, Placement};

/// Rows and columns at a bitmap's border whose pixels are all at most this, of 255, are left out.
const FAINT: u8 = 2;

/// The box of a bitmap without faint rows and columns at its border.
fn inked(bitmap: &Bitmap) -> Placement {
    let place = bitmap.placement;
    let (width, height) = (place.width as usize, place.height as usize);
    let row = |j: &usize| bitmap.pixels[j * width..(j + 1) * width].iter().any(|v| *v > FAINT);
    let column = |i: &usize| (0..height).any(|j| bitmap.pixels[j * width + i] > FAINT);
    let (Some(top), Some(bottom)) = ((0..height).find(row), (0..height).rfind(row)) else {
        return Placement::default();
    };
    let (Some(left), Some(right)) = ((0..width).find(column), (0..width).rfind(column)) else {
        return Placement::default();
    };
    Placement {
        left: place.left + left as i32,
        top: place.top - top as i32,
        width: (right - left + 1) as u32,
        height: (bottom - top + 1) as u32,
    }
}

/// Clamps hinted positions to their bounds (projected gradient descent).
pub(super) fn clamped(hinted: [Tensor<1>; 2], low: [Tensor<1>; 2], high: [Tensor<1>; 2]) -> [Tensor<1>; 2] {
    let [x, y] = hinted;
    let ([low_x, low_y], [high_x, high_y]) = (low, high);
    let clamp = |at: Tensor<1>, low: Tensor<1>, high: Tensor<1>| {
        let (low, high) = (low.inner(), high.inner());
        Tensor::from_inner(at.inner().max_pair(low).min_pair(high)).require_grad()
    };
    [clamp(x, low_x, high_x), clamp(y, low_y, high_y)]
}

/// Lower and upper bounds of the hinted positions. The outermost knots determine the bitmap's box, which stays within the
/// teacher's. Knots of sizes after the first `hinted` ones are fixed.
pub(super) fn box_bounds(
    glyphs: &[GlyphSamples],
    parameters: &[Parameters],
    hinted: usize,
    extent: Extent,
    device: &Device,
) -> [[Tensor<1>; 2]; 2] {
    let bound = |upper: bool| {
        let each: Vec<[Vec<f32>; 2]> = glyphs
            .iter()
            .zip(parameters)
            .map(|(samples, parameters)| {
                let inked: Vec<Placement> = samples.sizes.iter().map(|s| inked(&s.bitmap)).collect();
                [0, 1].map(|axis| {
                    let at = |size: usize| {
                        let place = inked[size];
                        let (width, height) = (place.width as i32, place.height as i32);
                        match (place.area(), axis, upper) {
                            (0, _, false) => -f32::MAX,
                            (0, _, true) => f32::MAX,
                            (_, 0, false) => place.left as f32,
                            (_, 0, true) => (place.left + width) as f32,
                            (_, _, false) => (place.top - height) as f32,
                            (_, _, true) => place.top as f32,
                        }
                    };
                    let knots = parameters.knots[axis].len();
                    let within = (0..hinted).flat_map(|size| std::iter::repeat_n(at(size), knots));
                    within.chain(parameters.hinted[axis][hinted * knots..].iter().copied()).collect()
                })
            })
            .collect();
        let each: Vec<_> = each.iter().collect();
        hinted_tensors(&each, parameters, extent, 0.0, device)
    };
    [bound(false), bound(true)]
}
