//! Layers that both networks are made of, initialised as in the paper's framework.

use burn::module::Param;
use burn::nn::Linear;
use burn::tensor::{Device, Tensor, TensorData};

use super::random::Random;

/// A dense layer: Glorot's uniform weights of shape `[inputs, outputs]`, bias 0. `fan_in` is the number of inputs
/// that all parts of the layer have together.
pub(super) fn dense(
    inputs: usize,
    fan_in: usize,
    outputs: usize,
    bias: bool,
    random: &mut Random,
    device: &Device,
) -> Linear {
    let limit = (6.0 / (fan_in + outputs) as f32).sqrt();
    let weights: Vec<f32> = (0..inputs * outputs).map(|_| (random.uniform() * 2.0 - 1.0) * limit).collect();
    Linear {
        weight: Param::from_data(TensorData::new(weights, [inputs, outputs]), device),
        bias: bias.then(|| Param::from_tensor(Tensor::zeros([outputs], device))),
    }
}

/// Several dense layers, each as wide as given, the first with so many inputs.
pub(super) fn stack(inputs: usize, widths: &[usize], random: &mut Random, device: &Device) -> Vec<Linear> {
    let mut inputs = inputs;
    let layer = |&outputs: &usize| {
        let layer = dense(inputs, inputs, outputs, true, random, device);
        inputs = outputs;
        layer
    };
    widths.iter().map(layer).collect()
}
