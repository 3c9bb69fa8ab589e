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

/// The floating-point operations of a training step's products with a layer's weights, for so many rows: the outputs, the
/// gradient of the weights, and that of the inputs, two for each weight and row.
pub(super) fn step_operations(layer: &Linear, rows: usize) -> f64 {
    let [inputs, outputs] = layer.weight.dims();
    6.0 * (inputs * outputs * rows) as f64
}

/// The same of layers on top of each other. The inputs of the first are data, which have no gradient.
pub(super) fn stack_operations(layers: &[Linear], rows: usize) -> f64 {
    let first = layers.first().map_or(0.0, |layer| step_operations(layer, rows) / 3.0);
    layers.iter().map(|layer| step_operations(layer, rows)).sum::<f64>() - first
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
