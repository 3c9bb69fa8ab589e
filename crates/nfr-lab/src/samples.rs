//! Bitmaps as the networks' batches.

use std::collections::HashMap;

use burn::tensor::{Device, Int, Tensor, TensorData};

use super::SquareBitmap;
use super::classes::{class_of, coverage_of};
use super::groups::GROUP;
use super::implicit::{Implicit, ImplicitConfig, Pixels, focal_loss};
use super::masked::{Enlarged, Masked, masked_loss};
use super::tensors::{fetch, values};
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

/// How the pixels of a bitmap lie in tensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelLayout {
    /// In one group.
    Whole,
    /// In groups of 512, the last of which is filled up, for GPUs.
    Groups,
}

/// Bitmaps as the implicit network sees them, all on the device.
pub struct ImplicitSamples {
    device: Device,
    /// For each side, what all its bitmaps share.
    boxes: HashMap<usize, SideTensors>,
    items: Vec<Item>,
}

/// The encoded places of a box's pixels in their groups, and their shares in sums, if these differ.
struct SideTensors {
    positions: Tensor<3>,
    shares: Option<Tensor<3>>,
}

/// A bitmap, and on the device its pixels' classes, one-hot, its encoded size and its weight.
struct Item {
    sample: TrainingSample,
    classes: Tensor<2>,
    size: Option<Tensor<2>>,
    weight: Option<Tensor<2>>,
}

/// Pixels and their classes, one-hot `[pixels, classes]`.
pub type ImplicitBatch = (Pixels, Tensor<2>);

impl TrainableNetwork for Implicit {
    type Batch = ImplicitBatch;

    fn losses(&self, (pixels, classes): &Self::Batch) -> Tensor<1> {
        let scores = self.forward(pixels, self.training_statistics());
        focal_loss(scores, classes.clone(), pixels.shares.as_ref())
    }

    fn operations(&self, (pixels, _): &Self::Batch) -> f64 {
        let conditions = [&pixels.sizes, &pixels.weights].into_iter().flatten().next();
        let bitmaps = conditions.map_or(1, |rows| rows.dims()[0]);
        self.step_operations(pixels.count, bitmaps)
    }
}

impl TrainableNetwork for Masked {
    type Batch = Enlarged;

    fn losses(&self, batch: &Self::Batch) -> Tensor<1> {
        masked_loss(self.forward(batch.sizes.clone()), batch)
    }

    fn operations(&self, batch: &Self::Batch) -> f64 {
        self.step_operations(batch.sizes.dims()[0])
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

/// The groups of a box's pixels, and the pixels of a group.
fn groups(side: usize, layout: PixelLayout) -> [usize; 2] {
    match layout {
        PixelLayout::Whole => [1, side * side],
        PixelLayout::Groups => [(side * side).div_ceil(GROUP), GROUP],
    }
}

/// The network's inputs for a box, those that the renderer computes too, and the shares of its pixels. What fills the last group is
/// zero.
fn side_tensors(side: usize, config: ImplicitConfig, layout: PixelLayout, device: &Device) -> SideTensors {
    let architecture = inputs(config);
    let pixels = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
    let values = pixels.flat_map(|(row, column)| network::positions(&architecture, row, column, side));
    let count = side * side;
    let [groups, of_group] = groups(side, layout);
    let grouped = |mut values: Vec<f32>, columns: usize| {
        values.resize(groups * of_group * columns, 0.0);
        Tensor::from_data(TensorData::new(values, [groups, of_group, columns]), device)
    };
    let shares = match layout {
        PixelLayout::Whole => None,
        PixelLayout::Groups => Some(grouped(vec![1.0 / count as f32; count], 1)),
    };
    SideTensors { positions: grouped(values.collect(), architecture.positions()), shares }
}

impl ImplicitSamples {
    /// Encodes bitmaps of `sizes` sizes. Without the memorisation adaptations batches mix bitmaps, whose pixels are in one group.
    pub fn new(
        samples: Vec<TrainingSample>,
        sizes: usize,
        config: ImplicitConfig,
        layout: PixelLayout,
        device: &Device,
    ) -> Self {
        let layout = if config.memorisation { layout } else { PixelLayout::Whole };
        let mut boxes = HashMap::new();
        let architecture = inputs(config);
        let tensor = |values: Vec<f32>, rows: usize| {
            let columns = values.len() / rows;
            Tensor::from_data(TensorData::new(values, [rows, columns]), device)
        };
        let item = |sample: TrainingSample| {
            let side = sample.truth.side;
            boxes.entry(side).or_insert_with(|| side_tensors(side, config, layout, device));
            let [groups, of_group] = groups(side, layout);
            let mut hot = vec![0.0f32; groups * of_group * CLASSES];
            for (row, pixel) in hot.chunks_exact_mut(CLASSES).zip(&sample.truth.pixels) {
                row[class_of(*pixel)] = 1.0;
            }
            Item {
                classes: tensor(hot, groups * of_group),
                size: config.size.then(|| tensor(network::condition(&architecture, sample.size, sizes), 1)),
                weight: config.weight.then(|| tensor(vec![sample.weight.unwrap_or_default() as f32], 1)),
                sample,
            }
        };
        let items = samples.into_iter().map(item).collect();
        Self { device: device.clone(), boxes, items }
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
        self.items.iter().map(|item| &item.sample)
    }

    /// A batch of some bitmaps.
    pub fn batch(&self, numbers: &[usize]) -> ImplicitBatch {
        let items: Vec<&Item> = numbers.iter().map(|k| &self.items[*k]).collect();
        let rows = |of: &dyn Fn(&Item) -> Option<Tensor<2>>| {
            let rows: Option<Vec<Tensor<2>>> = items.iter().map(|item| of(item)).collect();
            rows.map(|rows| joined(rows, 0))
        };
        let boxes: Vec<&SideTensors> =
            items.iter().map(|item| &self.boxes[&item.sample.truth.side]).collect();
        let pixels = Pixels {
            count: items.iter().map(|item| item.sample.truth.pixels.len()).sum(),
            sizes: rows(&|item| item.size.clone()),
            weights: rows(&|item| item.weight.clone()),
            bitmap: (items.len() > 1).then(|| self.numbers(&items)),
            positions: joined(boxes.iter().map(|of_side| of_side.positions.clone()).collect(), 1),
            // Groups hold one bitmap.
            shares: boxes[0].shares.clone(),
        };
        (pixels, joined(items.iter().map(|item| item.classes.clone()).collect(), 0))
    }

    /// For each pixel the number of its bitmap.
    fn numbers(&self, items: &[&Item]) -> Tensor<1, Int> {
        let numbers: Vec<i32> = (0i32..)
            .zip(items)
            .flat_map(|(k, item)| std::iter::repeat_n(k, item.sample.truth.pixels.len()))
            .collect();
        let count = numbers.len();
        Tensor::from_data(TensorData::new(numbers, [count]), &self.device)
    }
}

fn joined<const D: usize>(mut tensors: Vec<Tensor<D>>, dimension: usize) -> Tensor<D> {
    if tensors.len() == 1 { tensors.remove(0) } else { Tensor::cat(tensors, dimension) }
}

/// The bitmap that scores `[side² or more, classes]` choose: for each pixel the likeliest class.
///
/// # Errors
///
/// `Unsupported` for scores that cannot be read, `Device` for a device that fails.
pub fn likeliest(scores: Tensor<2>, side: usize) -> Result<SquareBitmap, Error> {
    let [rows, _] = scores.dims();
    let mut classes = values::<i32>(&fetch(scores.argmax(1))?.convert::<i32>(), rows)?;
    classes.truncate(side * side);
    Ok(SquareBitmap { side, pixels: classes.into_iter().map(|class| coverage_of(class as usize)).collect() })
}
