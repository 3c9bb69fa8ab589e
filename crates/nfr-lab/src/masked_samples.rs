//! Bitmaps as the masked network's batches.

use burn::tensor::{Device, Int, Tensor, TensorData};

use super::SquareBitmap;
use super::enlarge::Enlargement;
use super::masked::{Enlarged, Masked};
use super::samples::TrainingSample;
use super::tensors::{fetch, values};
use nfr_convert::error::Error;

/// Bitmaps of different sizes, enlarged to the largest, all on the device.
pub struct MaskedSamples {
    /// The sides, and the largest.
    sides: Vec<usize>,
    largest: usize,
    all: Enlarged,
    device: Device,
}

impl MaskedSamples {
    /// Enlarges bitmaps, whose boxes differ.
    pub fn new(samples: &[TrainingSample], device: &Device) -> Self {
        let sides: Vec<usize> = samples.iter().map(|sample| sample.truth.side).collect();
        let largest = sides.iter().copied().max().unwrap_or(1);
        let count = samples.len();
        let rows = |columns: usize, row: &dyn Fn(usize) -> Vec<f32>| {
            let values: Vec<f32> = (0..count).flat_map(row).collect();
            Tensor::from_data(TensorData::new(values, [count, columns]), device)
        };
        let enlargement = |k: usize| Enlargement::new(samples[k].truth.side, largest);
        let hot = |k: usize| (0..count).map(|size| f32::from(u8::from(size == k))).collect();
        let coverage = |k: usize| -> Vec<f32> {
            let enlarged = enlargement(k).enlarge(&samples[k].truth);
            enlarged.pixels.iter().map(|v| f32::from(*v) / 255.0).collect()
        };
        let all = Enlarged {
            sizes: rows(count, &hot),
            coverage: rows(largest * largest, &coverage),
            mask: rows(largest * largest, &|k| enlargement(k).mask()),
        };
        Self { sides, largest, all, device: device.clone() }
    }

    /// The number of bitmaps.
    pub fn len(&self) -> usize {
        self.sides.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    /// Pixels along a side of the largest bitmap.
    pub fn largest(&self) -> usize {
        self.largest
    }

    /// A batch of some bitmaps.
    pub fn batch(&self, numbers: &[usize]) -> Enlarged {
        let numbers: Vec<i32> = numbers.iter().map(|k| *k as i32).collect();
        let count = numbers.len();
        let numbers = Tensor::<1, Int>::from_data(TensorData::new(numbers, [count]), &self.device);
        let rows = |all: &Tensor<2>| all.clone().select(0, numbers.clone());
        Enlarged {
            sizes: rows(&self.all.sizes),
            coverage: rows(&self.all.coverage),
            mask: rows(&self.all.mask),
        }
    }

    /// The network's bitmap for each sample.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a device whose numbers cannot be read, `Device` for one that fails.
    pub fn draw(&self, network: &Masked) -> Result<Vec<SquareBitmap>, Error> {
        let pixels = self.largest * self.largest;
        let drawn = fetch(network.forward(self.all.sizes.clone()))?;
        let levels = values::<f32>(&drawn, self.len() * pixels)?;
        let square = |(levels, side): (&[f32], &usize)| {
            let small = Enlargement::new(*side, self.largest).shrink(levels);
            SquareBitmap {
                side: *side,
                pixels: small.into_iter().map(|v| (v * 255.0).round() as u8).collect(),
            }
        };
        Ok(levels.chunks_exact(pixels).zip(&self.sides).map(square).collect())
    }
}
