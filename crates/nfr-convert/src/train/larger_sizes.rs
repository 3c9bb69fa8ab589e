//! Sizes larger than the hinted ones, where the model learns the unhinted glyph. They make the field the outline itself:
//! at hinted sizes alone, a field that lies elsewhere and a warp that moves it back draw the same bitmaps.

use burn::tensor::{Device, Tensor, TensorData};

use super::batch::Extent;
use crate::error::Error;
use crate::fit::Parameters;
use crate::training_samples::GlyphSamples;

/// Training samples and parameters with unhinted, larger sizes after the hinted ones.
pub(super) fn with_larger_sizes(
    samples: &GlyphSamples,
    parameters: &Parameters,
    units: f32,
) -> Result<(GlyphSamples, Parameters), Error> {
    let (mut samples, mut parameters) = (samples.clone(), parameters.clone());
    for unhinted in samples.larger_sizes()? {
        for (hinted, knots) in parameters.hinted.iter_mut().zip(&parameters.knots) {
            hinted.extend(knots.iter().map(|knot| f32::from(*knot) / units * f32::from(unhinted.ppem)));
        }
        parameters.embedding.resize(parameters.embedding.len() + parameters.rank, 0.0);
        samples.sizes.push(unhinted);
    }
    Ok((samples, parameters))
}

/// Removes the sizes after the first `sizes` from a glyph's parameters.
pub(super) fn without_larger_sizes(parameters: &mut Parameters, sizes: usize) {
    for (hinted, knots) in parameters.hinted.iter_mut().zip(&parameters.knots) {
        hinted.truncate(sizes * knots.len());
    }
    parameters.embedding.truncate(sizes * parameters.rank);
}

/// 1 for weights of hinted sizes, which are trained and stored; 0 for those of larger sizes, which are fixed.
pub(super) struct TrainedMask {
    /// Hinted positions of each axis, as in `ParameterTensors`.
    pub(super) hinted: [Tensor<1>; 2],
    /// The embedding `[glyphs · sizes, rank]`.
    pub(super) embedding: Tensor<2>,
}

impl TrainedMask {
    /// The first `sizes` of a chunk's sizes are hinted.
    pub(super) fn new(sizes: usize, extent: Extent, device: &Device) -> Self {
        let rows = extent.glyphs * extent.sizes;
        let mask = |each: usize| -> Vec<f32> {
            let row = |row: usize| if row % extent.sizes < sizes { 1.0 } else { 0.0 };
            (0..rows).flat_map(|k| std::iter::repeat_n(row(k), each)).collect()
        };
        let hinted = extent.knots.map(|knots| {
            let mut mask = mask(knots);
            // A tensor has at least one element, even if the axis has no knots.
            mask.resize((rows * knots).max(1), 0.0);
            let count = mask.len();
            Tensor::from_data(TensorData::new(mask, [count]), device)
        });
        let embedding = TensorData::new(mask(extent.rank), [rows, extent.rank]);
        Self { hinted, embedding: Tensor::from_data(embedding, device) }
    }
}
