//! Layers over pixels that lie in groups: `[groups, pixels of a group, features]`.
//!
//! A matrix product of burn's has few large tiles, and a sum down a column few threads: on a large GPU both leave most of it idle.
//! In groups, the gradient of a layer's weights is a sum of products that are computed at once, and sums over pixels are taken
//! over the groups first, for all pixels of a group at once, then over these.

use burn::nn::{BatchNorm, Linear};
use burn::tensor::Tensor;

/// Pixels of a group: twice the rows of the largest tile of a product.
pub(super) const GROUP: usize = 512;

/// A layer on each pixel.
pub(super) fn applied(layer: &Linear, x: Tensor<3>) -> Tensor<3> {
    let [groups, pixels, _] = x.dims();
    if groups == 1 {
        return layer.forward(x);
    }
    let product = x.matmul(layer.weight.val().unsqueeze::<3>());
    match &layer.bias {
        Some(bias) => product + spread(bias.val().unsqueeze(), pixels),
        None => product,
    }
}

/// A row `[1, features]` for each pixel of a group. Its gradient is a sum over the pixels of a group alone, where a broadcast over
/// all would make it one over all of them.
pub(super) fn spread(row: Tensor<2>, pixels: usize) -> Tensor<3> {
    let [_, features] = row.dims();
    row.expand([pixels, features]).unsqueeze()
}

/// The pixels of all groups, `[pixels, features]`.
pub(super) fn flat(x: Tensor<3>) -> Tensor<2> {
    let [groups, pixels, features] = x.dims();
    x.reshape([groups * pixels, features])
}

/// Batch normalisation with the statistics of the batch, to which each pixel contributes its share `[groups, pixels of a group, 1]`.
pub(super) fn normalised(norm: &BatchNorm, x: Tensor<3>, shares: &Tensor<3>) -> Tensor<3> {
    let [_, pixels, features] = x.dims();
    let mean = |x: Tensor<3>| (x * shares.clone()).sum_dim(0).reshape([pixels, features]).sum_dim(0);
    let centred = x.clone() - spread(mean(x), pixels);
    let variance = mean(centred.clone().square());
    let scale = norm.gamma.val().unsqueeze() / (variance + norm.epsilon).sqrt();
    centred * spread(scale, pixels) + spread(norm.beta.val().unsqueeze(), pixels)
}
