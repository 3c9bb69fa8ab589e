//! The paper's masked network: from a one-hot size to a bitmap of the largest size, of which a mask keeps the pixels
//! of the size asked for.

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::activation::{relu, sigmoid};
use burn::tensor::{Device, Tensor};

use super::dense::{stack, stack_operations};
use super::random::Random;

/// The network.
#[derive(Module, Debug)]
pub struct Masked {
    layers: Vec<Linear>,
}

/// Some bitmaps, enlarged to the largest size.
#[derive(Debug, Clone)]
pub struct Enlarged {
    /// One-hot sizes `[bitmaps, sizes]`.
    pub sizes: Tensor<2>,
    /// Coverage 0..1 `[bitmaps, largest²]`.
    pub coverage: Tensor<2>,
    /// 1 for original pixels, 0 for duplicates, of the same shape.
    pub mask: Tensor<2>,
}

impl Masked {
    /// A network with random weights: hidden layers as wide as given, for `sizes` sizes of which the largest has
    /// `side`² pixels.
    pub fn new(widths: &[usize], sizes: usize, side: usize, seed: u64, device: &Device) -> Self {
        let widths: Vec<usize> = widths.iter().copied().chain([side * side]).collect();
        Self { layers: stack(sizes, &widths, &mut Random::new(seed, 0), device) }
    }

    /// The floating-point operations of a training step's matrix products.
    pub(super) fn step_operations(&self, bitmaps: usize) -> f64 {
        stack_operations(&self.layers, bitmaps)
    }

    /// Coverage `[bitmaps, largest²]` for one-hot sizes.
    pub fn forward(&self, sizes: Tensor<2>) -> Tensor<2> {
        let mut x = sizes;
        for (k, layer) in self.layers.iter().enumerate() {
            x = layer.forward(x);
            x = if k + 1 == self.layers.len() { sigmoid(x) } else { relu(x) };
        }
        x
    }
}

/// The masked squared error: its sum over the masks' pixels, divided by their number and, as in the paper's code, by
/// the number of bitmaps once more.
pub fn masked_loss(predicted: Tensor<2>, truth: &Enlarged) -> Tensor<1> {
    let bitmaps = predicted.dims()[0] as f64;
    let error = ((predicted - truth.coverage.clone()) * truth.mask.clone()).square().sum();
    error / truth.mask.clone().sum() / bitmaps
}
