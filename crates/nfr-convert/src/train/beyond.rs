//! Sizes beyond the hinted ones, where the plain glyph is learnt. Nothing is moved there, so that the field has to be
//! the outline itself: at hinted sizes alone, a field that lies elsewhere and knots that move it back draw the same.

use burn::tensor::{Device, Tensor, TensorData};

use super::batch::Extent;
use crate::error::Error;
use crate::start::Draft;
use crate::teach::Lesson;

/// A lesson and a first guess with the plain glyph at larger sizes after the hinted ones.
///
/// # Errors
///
/// As [`Lesson::beyond`].
pub(super) fn extended(lesson: &Lesson, draft: &Draft, units: f32) -> Result<(Lesson, Draft), Error> {
    let (mut lesson, mut draft) = (lesson.clone(), draft.clone());
    for plain in lesson.beyond()? {
        for (hinted, knots) in draft.hinted.iter_mut().zip(&draft.knots) {
            hinted.extend(knots.iter().map(|knot| f32::from(*knot) / units * f32::from(plain.ppem)));
        }
        draft.embedding.resize(draft.embedding.len() + draft.rank, 0.0);
        lesson.sizes.push(plain);
    }
    Ok((lesson, draft))
}

/// Takes the sizes after the first `sizes` off a draft again.
pub(super) fn cut(draft: &mut Draft, sizes: usize) {
    for (hinted, knots) in draft.hinted.iter_mut().zip(&draft.knots) {
        hinted.truncate(sizes * knots.len());
    }
    draft.embedding.truncate(sizes * draft.rank);
}

/// 1 for what is learnt and stored for each size, 0 for what stands still at the sizes beyond.
pub(super) struct Learnt {
    /// Hinted positions of each axis, as `Parameters` has them.
    pub(super) hinted: [Tensor<1>; 2],
    /// The embedding `[glyphs · sizes, rank]`.
    pub(super) embedding: Tensor<2>,
}

impl Learnt {
    /// The first `sizes` of a chunk's sizes are hinted.
    pub(super) fn new(sizes: usize, extent: Extent, device: &Device) -> Self {
        let rows = extent.glyphs * extent.sizes;
        let mask = |each: usize| -> Vec<f32> {
            let row = |row: usize| if row % extent.sizes < sizes { 1.0 } else { 0.0 };
            (0..rows).flat_map(|k| std::iter::repeat_n(row(k), each)).collect()
        };
        let hinted = extent.knots.map(|knots| {
            let mut mask = mask(knots);
            // Without knots there is one number that nothing reads.
            mask.resize((rows * knots).max(1), 0.0);
            let count = mask.len();
            Tensor::from_data(TensorData::new(mask, [count]), device)
        });
        let embedding = TensorData::new(mask(extent.rank), [rows, extent.rank]);
        Self { hinted, embedding: Tensor::from_data(embedding, device) }
    }
}
