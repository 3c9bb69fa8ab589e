//! Bitmaps as the networks' batches.

use std::collections::HashMap;

use burn::tensor::{Device, Int, Tensor, TensorData};

use super::SquareBitmap;
use super::classes::{class_of, coverage_of};
use super::implicit::{Implicit, ImplicitConfig, Pixels, Statistics, focal_loss};
use super::masked::{Enlarged, Masked, masked_loss};
use super::tensors::values;
use super::train::TrainableNetwork;
use nfr::internals::network::{self, Architecture, CLASSES};
use nfr_convert::error::Error;

/// A bitmap to learn.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingSample {
    /// The number of its size among those learnt, counted from 0.
    pub size: usize,
    /// The condition of a family: which weight this is.
    pub weight: Option<f64>,
    /// The bitmap.
    pub truth: SquareBitmap,
}

/// Bitmaps as the implicit network sees them.
pub struct ImplicitSamples {
    config: ImplicitConfig,
    sizes: usize,
    device: Device,
    /// For each side, the encoded places of its pixels.
    positions: HashMap<usize, Tensor<2>>,
    items: Vec<(TrainingSample, Tensor<2>)>,
}

/// Pixels and their classes, one-hot `[pixels, classes]`.
pub type ImplicitBatch = (Pixels, Tensor<2>);

impl TrainableNetwork for Implicit {
    type Batch = ImplicitBatch;

    fn loss(&self, (pixels, classes): &Self::Batch) -> Tensor<1> {
        focal_loss(self.forward(pixels, Statistics::Training), classes.clone())
    }
}

impl TrainableNetwork for Masked {
    type Batch = Enlarged;

    fn loss(&self, batch: &Self::Batch) -> Tensor<1> {
        masked_loss(self.forward(batch.sizes.clone()), batch)
    }
}

/// The layout of the inputs; the widths do not matter here.
fn inputs(config: ImplicitConfig) -> Architecture {
    Architecture {
        width: 1,
        latent: 0,
        encoder: 0,
        frequencies: config.frequencies,
        residual: config.residual,
    }
}

/// The rows of the network's input for a box, those that the renderer computes too.
fn positions(side: usize, config: ImplicitConfig, device: &Device) -> Tensor<2> {
    let architecture = inputs(config);
    let pixels = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
    let values: Vec<f32> =
        pixels.flat_map(|(row, column)| network::positions(&architecture, row, column, side)).collect();
    Tensor::from_data(TensorData::new(values, [side * side, architecture.positions()]), device)
}

impl ImplicitSamples {
    /// Encodes bitmaps of `sizes` sizes.
    pub fn new(samples: Vec<TrainingSample>, sizes: usize, config: ImplicitConfig, device: &Device) -> Self {
        let mut by_side = HashMap::new();
        let item = |sample: TrainingSample| {
            let side = sample.truth.side;
            by_side.entry(side).or_insert_with(|| positions(side, config, device));
            let mut hot = vec![0.0f32; side * side * CLASSES];
            for (row, pixel) in hot.chunks_exact_mut(CLASSES).zip(&sample.truth.pixels) {
                row[class_of(*pixel)] = 1.0;
            }
            let hot = Tensor::from_data(TensorData::new(hot, [side * side, CLASSES]), device);
            (sample, hot)
        };
        let items = samples.into_iter().map(item).collect();
        Self { config, sizes, device: device.clone(), positions: by_side, items }
    }

    /// The number of bitmaps.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The bitmaps.
    pub fn samples(&self) -> impl Iterator<Item = &TrainingSample> {
        self.items.iter().map(|(sample, _)| sample)
    }

    /// A batch of some bitmaps.
    pub fn batch(&self, numbers: &[usize]) -> ImplicitBatch {
        let items: Vec<_> = numbers.iter().map(|k| &self.items[*k]).collect();
        let positions = items.iter().map(|(sample, _)| self.positions[&sample.truth.side].clone());
        let classes = items.iter().map(|(_, hot)| hot.clone());
        let row = |values: Vec<Vec<f32>>| {
            let columns = values.first().map_or(0, Vec::len);
            Tensor::from_data(TensorData::new(values.concat(), [items.len(), columns]), &self.device)
        };
        let architecture = inputs(self.config);
        let size = |(sample, _): &&(TrainingSample, Tensor<2>)| {
            network::condition(&architecture, sample.size, self.sizes)
        };
        let weight =
            |(sample, _): &&(TrainingSample, Tensor<2>)| vec![sample.weight.unwrap_or_default() as f32];
        let pixels = Pixels {
            sizes: self.config.size.then(|| row(items.iter().map(size).collect())),
            weights: self.config.weight.then(|| row(items.iter().map(weight).collect())),
            bitmap: (items.len() > 1).then(|| self.numbers(&items)),
            positions: joined(positions.collect()),
        };
        (pixels, joined(classes.collect()))
    }

    /// For each pixel the number of its bitmap.
    fn numbers(&self, items: &[&(TrainingSample, Tensor<2>)]) -> Tensor<1, Int> {
        let numbers: Vec<i32> = (0i32..)
            .zip(items)
            .flat_map(|(k, (sample, _))| std::iter::repeat_n(k, sample.truth.pixels.len()))
            .collect();
        let count = numbers.len();
        Tensor::from_data(TensorData::new(numbers, [count]), &self.device)
    }
}

fn joined(mut tensors: Vec<Tensor<2>>) -> Tensor<2> {
    if tensors.len() == 1 { tensors.remove(0) } else { Tensor::cat(tensors, 0) }
}

/// The bitmap that scores `[side², classes]` choose: for each pixel the likeliest class.
///
/// # Errors
///
/// `Unsupported` for scores of another number of pixels.
pub fn likeliest(scores: Tensor<2>, side: usize) -> Result<SquareBitmap, Error> {
    let classes = values::<i32>(&scores.argmax(1).into_data().convert::<i32>(), side * side)?;
    Ok(SquareBitmap { side, pixels: classes.into_iter().map(|class| coverage_of(class as usize)).collect() })
}
