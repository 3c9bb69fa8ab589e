//! What the training must not do: a model's bitmap stays within the box of the teacher's.

use burn::tensor::{Device, Tensor};

use super::batch::Extent;
use super::field::hinted_tensors;
use crate::start::Draft;
use crate::teach::Lesson;
use nfr::{Bitmap, Placement};

/// Rows and columns at a bitmap's border whose pixels are all at most this, of 255, are not worth drawing.
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

/// Keeps hinted positions between their bounds.
pub(super) fn within(hinted: [Tensor<1>; 2], low: [Tensor<1>; 2], high: [Tensor<1>; 2]) -> [Tensor<1>; 2] {
    let [x, y] = hinted;
    let ([low_x, low_y], [high_x, high_y]) = (low, high);
    let clamp = |at: Tensor<1>, low: Tensor<1>, high: Tensor<1>| {
        let (low, high) = (low.inner(), high.inner());
        Tensor::from_inner(at.inner().max_pair(low).min_pair(high)).require_grad()
    };
    [clamp(x, low_x, high_x), clamp(y, low_y, high_y)]
}

/// Bounds of the hinted positions: the knots, the outermost of which make the bitmap's box, stay within the
/// teacher's. Beyond the first `hinted` sizes they stay where they are.
pub(super) fn box_bounds(
    lessons: &[Lesson],
    drafts: &[Draft],
    hinted: usize,
    extent: Extent,
    device: &Device,
) -> [[Tensor<1>; 2]; 2] {
    let bound = |upper: bool| {
        let each: Vec<[Vec<f32>; 2]> = lessons
            .iter()
            .zip(drafts)
            .map(|(lesson, draft)| {
                let inked: Vec<Placement> = lesson.sizes.iter().map(|s| inked(&s.bitmap)).collect();
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
                    let knots = draft.knots[axis].len();
                    let within = (0..hinted).flat_map(|size| std::iter::repeat_n(at(size), knots));
                    within.chain(draft.hinted[axis][hinted * knots..].iter().copied()).collect()
                })
            })
            .collect();
        let each: Vec<_> = each.iter().collect();
        hinted_tensors(&each, drafts, extent, 0.0, device)
    };
    [bound(false), bound(true)]
}
