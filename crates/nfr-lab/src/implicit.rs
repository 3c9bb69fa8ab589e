//! The paper's implicit network: from a pixel's position, the bitmap's size and, for families, the weight to the pixel's
//! intensity class.

use burn::module::Module;
use burn::nn::{BatchNorm, BatchNormConfig, Linear};
use burn::tensor::activation::{relu, softmax, tanh};
use burn::tensor::module::{batch_norm, batch_norm_train};
use burn::tensor::{Device, Int, Tensor};

use super::dense::{dense, stack, stack_operations, step_operations};
use super::groups::{applied, flat, normalised, spread};
use super::random::Random;
use nfr::internals::network::{self, CLASSES, CONDITIONED, ENCODED, NORM_EPSILON, NORMALISED, REPLACING};

/// The focal loss's exponent in the paper's code.
pub const FOCUS: f64 = 6.0;
/// Probabilities are kept this far from 0 and 1 in the loss.
pub const CLIP: f64 = 1e-6;
/// The momentum of running statistics, which only the ablation uses.
const NORM_MOMENTUM: f64 = 0.01;
/// Hidden layers of the encoders of conditions.
const ENCODER_LAYERS: usize = network::ENCODER_LAYERS - 1;
/// Layers of the trunk; the output follows.
const TRUNK_LAYERS: usize = network::TRUNK_LAYERS - 1;

/// The configuration of an implicit network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ImplicitConfig {
    /// Width of the trunk's layers.
    pub width: usize,
    /// Length of the latent vector, if there are conditions.
    pub latent: usize,
    /// Width of the encoders' hidden layers.
    pub encoder: usize,
    /// Whether the size is an input. The paper's text has it; its code for single weights leaves it out and
    /// distinguishes sizes by the positions of their pixels, and by the statistics of the batch.
    pub size: bool,
    /// Whether the weight is an input.
    pub weight: bool,
    /// Ablation: without frequencies a number is an input as it is.
    pub frequencies: bool,
    /// Ablation: without the memorisation adaptations, batches mix bitmaps and drawing uses running statistics.
    pub memorisation: bool,
    /// Ablation: without residual additions every layer replaces its input.
    pub residual: bool,
}

impl ImplicitConfig {
    /// The number of inputs that encode one number.
    fn encoded(&self) -> usize {
        1 + if self.frequencies { ENCODED } else { 0 }
    }

    fn latent(&self) -> usize {
        if self.size || self.weight { self.latent } else { 0 }
    }
}

/// The network.
#[derive(Module, Debug)]
pub struct Implicit {
    weight_encoder: Vec<Linear>,
    size_encoder: Vec<Linear>,
    trunk: Vec<Linear>,
    /// The shares of the latent vector in layers of the trunk: a layer over concatenated inputs is a sum of two.
    from_latent: Vec<Linear>,
    norms: Vec<BatchNorm>,
    output: Linear,
    #[module(skip)]
    residual: bool,
    /// Whether drawing uses the running statistics, so that training has to follow them.
    #[module(skip)]
    running: bool,
}

/// The pixels of some bitmaps, and the conditions of these.
#[derive(Debug, Clone)]
pub struct Pixels {
    /// For each pixel, its encoded row and column (see [`positions`](nfr::internals::network::positions)), in groups
    /// `[groups, pixels of a group, inputs]`.
    pub positions: Tensor<3>,
    /// The share of each pixel in sums over the batch, `[groups, pixels of a group, 1]`: one divided by the number of pixels, or
    /// 0 for what fills the last group. Without it, all pixels are in one group, and have equal shares.
    pub shares: Option<Tensor<3>>,
    /// The number of pixels, without what fills the last group.
    pub count: usize,
    /// For each bitmap, the encoded size.
    pub sizes: Option<Tensor<2>>,
    /// For each bitmap, the weight.
    pub weights: Option<Tensor<2>>,
    /// For each pixel, the number of its bitmap, if there are several.
    pub bitmap: Option<Tensor<1, Int>>,
}

/// The statistics that batch normalisation uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statistics {
    /// The batch at hand. The running ones follow it.
    Training,
    /// The batch at hand: the paper's adaptation for memorising.
    Batch,
    /// The running ones, as is usual.
    Running,
}

impl Implicit {
    /// A network with random weights.
    pub fn new(config: ImplicitConfig, seed: u64, device: &Device) -> Self {
        let mut random = Random::new(seed, 0);
        let (width, latent, encoded) = (config.width, config.latent(), config.encoded());
        let mut hidden = [config.encoder; ENCODER_LAYERS + 1];
        hidden[ENCODER_LAYERS] = latent;
        let weight_encoder = if config.weight { stack(1, &hidden, &mut random, device) } else { Vec::new() };
        let weight_latent = if config.weight { latent } else { 0 };
        let size_encoder = if config.size {
            stack(encoded + weight_latent, &hidden, &mut random, device)
        } else {
            Vec::new()
        };
        let layer = |k: usize, random: &mut Random| {
            let inputs = if k == 0 { 2 * encoded } else { width };
            let fan_in = inputs + if CONDITIONED.contains(&k) { latent } else { 0 };
            dense(inputs, fan_in, width, true, random, device)
        };
        let trunk: Vec<Linear> = (0..TRUNK_LAYERS).map(|k| layer(k, &mut random)).collect();
        let from_latent = if latent == 0 {
            Vec::new()
        } else {
            let inputs = CONDITIONED.map(|k| latent + if k == 0 { 2 * encoded } else { width });
            inputs.map(|fan_in| dense(latent, fan_in, width, false, &mut random, device)).into()
        };
        let norm = |_| {
            let norm = BatchNormConfig::new(width).with_epsilon(NORM_EPSILON).with_momentum(NORM_MOMENTUM);
            norm.init(device)
        };
        Self {
            weight_encoder,
            size_encoder,
            trunk,
            from_latent,
            norms: NORMALISED.iter().map(norm).collect(),
            output: dense(width, width, CLASSES, true, &mut random, device),
            residual: config.residual,
            running: !config.memorisation,
        }
    }

    /// The number of parameters of a network of this configuration.
    pub fn parameters(config: ImplicitConfig) -> usize {
        let dense = |inputs: usize, outputs: usize| (inputs + 1) * outputs;
        let (width, latent, encoded) = (config.width, config.latent(), config.encoded());
        let encoder = |inputs: usize| {
            let hidden = dense(config.encoder, config.encoder) * (ENCODER_LAYERS - 1);
            dense(inputs, config.encoder) + hidden + dense(config.encoder, latent)
        };
        let weight_latent = if config.weight { latent } else { 0 };
        let weight = if config.weight { encoder(1) } else { 0 };
        let size = if config.size { encoder(encoded + weight_latent) } else { 0 };
        let trunk = dense(2 * encoded + latent, width) + dense(width + latent, width);
        let rest = dense(width, width) * (TRUNK_LAYERS - CONDITIONED.len());
        weight + size + trunk + rest + dense(width, CLASSES) + NORMALISED.len() * 2 * width
    }

    /// The statistics that training uses: running ones are followed where drawing needs them.
    pub(super) fn training_statistics(&self) -> Statistics {
        if self.running { Statistics::Training } else { Statistics::Batch }
    }

    /// The floating-point operations of a training step's matrix products, for so many pixels of so many bitmaps.
    pub(super) fn step_operations(&self, pixels: usize, bitmaps: usize) -> f64 {
        let encoders =
            stack_operations(&self.weight_encoder, bitmaps) + stack_operations(&self.size_encoder, bitmaps);
        let shares: f64 = self.from_latent.iter().map(|layer| step_operations(layer, bitmaps)).sum();
        encoders + shares + stack_operations(&self.trunk, pixels) + step_operations(&self.output, pixels)
    }

    /// The size's encoder, the trunk, the shares of the latent vector in its conditioned layers, and the output.
    pub(super) fn layers(&self) -> (&[Linear], &[Linear], &[Linear], &Linear) {
        (&self.size_encoder, &self.trunk, &self.from_latent, &self.output)
    }

    /// The batch normalisations.
    pub(super) fn norms(&self) -> &[BatchNorm] {
        &self.norms
    }

    /// The layers of [`Self::layers`]: the size's encoder, the trunk, the shares of the latent vector, and the output.
    pub(super) fn layers_mut(&mut self) -> (&mut [Linear], &mut [Linear], &mut [Linear], &mut Linear) {
        (&mut self.size_encoder, &mut self.trunk, &mut self.from_latent, &mut self.output)
    }

    /// The batch normalisations.
    pub(super) fn norms_mut(&mut self) -> &mut [BatchNorm] {
        &mut self.norms
    }

    /// Whether layers add their inputs.
    pub(super) fn is_residual(&self) -> bool {
        self.residual
    }

    /// The latent vectors `[bitmaps, latent]` of weights `[bitmaps, 1]`.
    pub fn weight_latents(&self, weights: Tensor<2>) -> Tensor<2> {
        encode(&self.weight_encoder, weights)
    }

    /// The latent vectors of bitmaps, from those of their weights: the size's is added to these.
    fn latents(&self, sizes: Option<&Tensor<2>>, of_weights: Option<Tensor<2>>) -> Option<Tensor<2>> {
        let Some(sizes) = sizes else { return of_weights };
        Some(match of_weights {
            None => encode(&self.size_encoder, sizes.clone()),
            Some(of_weights) => {
                let inputs = Tensor::cat(vec![sizes.clone(), of_weights.clone()], 1);
                encode(&self.size_encoder, inputs) + of_weights
            }
        })
    }

    /// Scores `[pixels, classes]`, before softmax. What fills the last group has scores, too.
    pub fn forward(&self, pixels: &Pixels, statistics: Statistics) -> Tensor<2> {
        let of_weights = pixels.weights.as_ref().map(|weights| self.weight_latents(weights.clone()));
        self.forward_from(pixels, of_weights, statistics)
    }

    /// Scores, with the latent vectors of the weights given: what is rendered between two weights.
    pub fn forward_from(
        &self,
        pixels: &Pixels,
        of_weights: Option<Tensor<2>>,
        statistics: Statistics,
    ) -> Tensor<2> {
        let latents = self.latents(pixels.sizes.as_ref(), of_weights);
        let mut x = pixels.positions.clone();
        for (k, layer) in self.trunk.iter().enumerate() {
            let mut sum = applied(layer, x.clone());
            if let (Some(latents), Some(at)) = (&latents, CONDITIONED.iter().position(|c| *c == k)) {
                let share = self.from_latent[at].forward(latents.clone());
                sum = sum
                    + match &pixels.bitmap {
                        // The pixels of several bitmaps are in one group.
                        Some(bitmap) => share.select(0, bitmap.clone()).unsqueeze(),
                        None => spread(share, x.dims()[1]),
                    };
            }
            let out = relu(sum);
            x = if self.residual && !REPLACING.contains(&k) { x + out } else { out };
            if let Some(at) = NORMALISED.iter().position(|n| *n == k) {
                x = normalise(&self.norms[at], x, pixels.shares.as_ref(), statistics);
            }
        }
        flat(applied(&self.output, x))
    }
}

fn encode(layers: &[Linear], mut x: Tensor<2>) -> Tensor<2> {
    for (k, layer) in layers.iter().enumerate() {
        x = layer.forward(x);
        x = if k + 1 == layers.len() { tanh(x) } else { relu(x) };
    }
    x
}

fn normalise(
    norm: &BatchNorm,
    x: Tensor<3>,
    shares: Option<&Tensor<3>>,
    statistics: Statistics,
) -> Tensor<3> {
    match shares {
        Some(shares) => normalised(norm, x, shares),
        None => {
            let shape = x.dims();
            normalise_rows(norm, flat(x), statistics).reshape(shape)
        }
    }
}

fn normalise_rows(norm: &BatchNorm, x: Tensor<2>, statistics: Statistics) -> Tensor<2> {
    let (gamma, beta) = (norm.gamma.val(), norm.beta.val());
    match statistics {
        Statistics::Training => norm.forward(x),
        Statistics::Batch => batch_norm_train(x, gamma, beta, norm.epsilon).output,
        Statistics::Running => {
            let (mean, variance) = (norm.running_mean.value(), norm.running_var.value());
            batch_norm(x, gamma, beta, mean, variance, norm.epsilon)
        }
    }
}

/// The focal loss of scores `[pixels, classes]` for one-hot classes: the mean of −(1 − p)^γ · ln p, p being the
/// probability that a pixel's class is given. `shares` are those of [`Pixels`].
pub fn focal_loss(scores: Tensor<2>, classes: Tensor<2>, shares: Option<&Tensor<3>>) -> Tensor<1> {
    let p = (softmax(scores, 1) * classes).sum_dim(1).clamp(CLIP, 1.0 - CLIP);
    let miss = p.clone().neg() + 1.0;
    let losses = miss.powf_scalar(FOCUS) * p.log();
    -match shares {
        Some(shares) => (losses * flat(shares.clone())).sum(),
        None => losses.mean(),
    }
}
