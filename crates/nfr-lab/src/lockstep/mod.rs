//! Several implicit networks in lockstep: each learns a bitmap of its own in every step, all in the same order.
//!
//! The products of one network leave most of a large GPU idle. Of several, with the number of the network as the first dimension of
//! every tensor, they are computed at once; no network sees anything of another, and each ends as if it had been trained alone, up
//! to rounding. Networks without some part (see [`Ablation`](super::network_variant::Ablation)) go with whole ones: inputs that one
//! lacks are zero, and so are the weights behind them, which then stay zero.

mod layers;
mod samples;
mod training;

pub use samples::LockstepSamples;
pub use training::train_in_lockstep;

use burn::module::Module;
use burn::tensor::activation::{relu, softmax, tanh};
use burn::tensor::{Device, Tensor};

use self::layers::{Layers, Norms, in_rows, normalised, spread};
use self::samples::LockstepBatch;
use super::implicit::{CLIP, FOCUS, Implicit, ImplicitConfig};
use super::train::TrainableNetwork;
use nfr::internals::network::{CONDITIONED, NORMALISED, REPLACING};

/// The networks.
#[derive(Module, Debug)]
pub struct Lockstep {
    size_encoder: Vec<Layers>,
    trunk: Vec<Layers>,
    /// The shares of the latent vector in layers of the trunk.
    from_latent: Vec<Layers>,
    norms: Vec<Norms>,
    output: Layers,
    #[module(skip)]
    networks: usize,
}

/// Whether networks of these configurations can be in lockstep: their layers are as wide, and their batches are single bitmaps.
pub fn can_join(a: &ImplicitConfig, b: &ImplicitConfig) -> bool {
    let whole =
        |config: &ImplicitConfig| ImplicitConfig { size: true, frequencies: true, residual: true, ..*config };
    a.memorisation && !a.weight && whole(a) == whole(b)
}

impl Lockstep {
    /// Networks that [can join](can_join), at least one, as one.
    pub fn new(networks: &[Implicit]) -> Self {
        let stacked = |of: &dyn Fn(&Implicit) -> &[burn::nn::Linear]| {
            let count = networks.iter().map(|network| of(network).len()).max().unwrap_or_default();
            let layer = |k: usize| Layers::stacked(networks.iter().map(|network| of(network).get(k)));
            (0..count).map(layer).collect::<Vec<_>>()
        };
        let norm = |k: usize| {
            Norms::stacked(&networks.iter().map(|network| &network.norms()[k]).collect::<Vec<_>>())
        };
        Self {
            size_encoder: stacked(&|network| network.layers().0),
            trunk: stacked(&|network| network.layers().1),
            from_latent: stacked(&|network| network.layers().2),
            norms: (0..NORMALISED.len()).map(norm).collect(),
            output: Layers::stacked(networks.iter().map(|network| Some(network.layers().3))),
            networks: networks.len(),
        }
    }

    /// The network with this number, of this configuration, by itself.
    pub fn network(&self, number: usize, config: ImplicitConfig, device: &Device) -> Implicit {
        let mut network = Implicit::new(config, 0, device);
        let (size_encoder, trunk, from_latent, output) = network.layers_mut();
        let stacks =
            [(size_encoder, &self.size_encoder), (trunk, &self.trunk), (from_latent, &self.from_latent)];
        for (layers, stacked) in stacks {
            for (layer, stacked) in layers.iter_mut().zip(stacked) {
                stacked.copy_to(number, layer);
            }
        }
        self.output.copy_to(number, output);
        for (norm, stacked) in network.norms_mut().iter_mut().zip(&self.norms) {
            stacked.copy_to(number, norm);
        }
        network
    }

    /// Scores `[networks, pixels, classes]`, before softmax, with the statistics of the batch.
    pub fn forward(&self, batch: &LockstepBatch) -> Tensor<3> {
        let side = batch.side;
        let latents = batch.sizes.clone().map(|sizes| self.latents(sizes));
        let mut x = batch.positions.clone();
        for (k, layer) in self.trunk.iter().enumerate() {
            let mut row = layer.bias();
            if let (Some(latents), Some(at)) = (&latents, CONDITIONED.iter().position(|c| *c == k)) {
                row = row + latents.clone().matmul(self.from_latent[at].weight());
            }
            let product = in_rows(x.clone().matmul(layer.weight()), side);
            let mut out = relu(product + spread(row, side));
            if !REPLACING.contains(&k) {
                let carried = in_rows(x, side);
                out = out
                    + match &batch.residual {
                        Some(residual) => carried * residual.clone(),
                        None => carried,
                    };
            }
            if let Some(at) = NORMALISED.iter().position(|n| *n == k) {
                out = normalised(&self.norms[at], out, side);
            }
            let [networks, _, _, features] = out.dims();
            x = out.reshape([networks, side * side, features]);
        }
        x.matmul(self.output.weight()) + self.output.bias()
    }

    /// Latent vectors `[networks, 1, latent]` of sizes `[networks, 1, inputs]`.
    fn latents(&self, mut x: Tensor<3>) -> Tensor<3> {
        for (k, layer) in self.size_encoder.iter().enumerate() {
            x = x.matmul(layer.weight()) + layer.bias();
            x = if k + 1 == self.size_encoder.len() { tanh(x) } else { relu(x) };
        }
        x
    }
}

impl TrainableNetwork for Lockstep {
    type Batch = LockstepBatch;

    fn networks(&self) -> usize {
        self.networks
    }

    /// The focal loss of each, as of one network ([`focal_loss`](super::implicit::focal_loss)).
    fn losses(&self, batch: &LockstepBatch) -> Tensor<1> {
        let probabilities = softmax(self.forward(batch), 2);
        let p = (probabilities * batch.classes.clone()).sum_dim(2).clamp(CLIP, 1.0 - CLIP);
        let losses = (p.clone().neg() + 1.0).powf_scalar(FOCUS) * p.log();
        -losses.mean_dim(1).reshape([self.networks])
    }

    fn operations(&self, batch: &LockstepBatch) -> f64 {
        batch.operations
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
