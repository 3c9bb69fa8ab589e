//! Training either network: epochs over shuffled bitmaps with Adam, and a history of the loss.

pub mod checkpoint;
mod epochs;
pub mod files;
pub mod result;

use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer};
use burn::tensor::Tensor;

use super::random::Random;
use super::tensors::{fetch, values};
use nfr_convert::error::Error;

/// Adam's epsilon in the paper's framework. There it is added to the uncorrected root of the second moment, in burn, as
/// in PyTorch, to the corrected one, so that the first steps are longer here.
const EPSILON: f32 = 1e-7;

/// A network that learns from batches.
pub trait TrainableNetwork: Module {
    /// The data of one optimiser step.
    type Batch;

    /// The networks that learn in it, each by itself: one, unless they are in lockstep.
    fn networks(&self) -> usize {
        1
    }

    /// The loss of each of its networks on a batch.
    fn losses(&self, batch: &Self::Batch) -> Tensor<1>;

    /// Floating-point operations of a step on a batch in its matrix products: two for each weight and row forward, as many
    /// for the gradient of the weights, and as many for that of the inputs where these are not data.
    fn operations(&self, batch: &Self::Batch) -> f64;
}

/// Epochs, learning rates and batch size of a training.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingSchedule {
    /// The learning rate of each epoch.
    pub rates: Vec<f64>,
    /// Bitmaps in a batch.
    pub batch: usize,
    /// Determines the first weights and the order of the bitmaps.
    pub seed: u64,
}

/// One epoch of a finished or unfinished training.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Epoch {
    /// Its learning rate.
    pub rate: f64,
    /// The mean loss of its batches.
    pub loss: f64,
    /// How long it took: of networks in lockstep, each one's share.
    pub seconds: f64,
}

/// The order of the bitmaps in an epoch, counted from 0.
pub(super) fn order(seed: u64, epoch: usize, samples: usize) -> Vec<usize> {
    // Stream 0 is that of the first weights.
    Random::new(seed, epoch as u64 + 1).order(samples)
}

/// A network in training.
pub struct Training<L> {
    /// The network as it is by now.
    pub network: L,
    optimizer: ModuleOptimizer,
    /// The epochs so far, for each of its networks.
    pub histories: Vec<Vec<Epoch>>,
}

impl<L: TrainableNetwork> Training<L> {
    /// A training that has not begun.
    pub fn new(network: L) -> Self {
        let optimizer = AdamConfig::new().with_epsilon(EPSILON).init();
        Self { histories: vec![Vec::new(); network.networks()], network, optimizer }
    }

    /// A training of one network that has come so far, with an optimiser that begins anew.
    pub fn of(network: L, history: Vec<Epoch>) -> Self {
        Self { histories: vec![history], ..Self::new(network) }
    }

    /// The number of epochs so far.
    pub fn epochs(&self) -> usize {
        self.histories.first().map_or(0, Vec::len)
    }

    /// Trains until the schedule ends. `batch` makes a batch from the numbers of some of the `samples` bitmaps, `after`
    /// is called after every epoch, and says whether to go on.
    ///
    /// # Errors
    ///
    /// Those of `after`.
    pub fn train(
        mut self,
        schedule: &TrainingSchedule,
        samples: usize,
        batch: impl Fn(&[usize]) -> L::Batch,
        mut after: impl FnMut(&Self) -> Result<bool, Error>,
    ) -> Result<Self, Error> {
        for epoch in self.epochs()..schedule.rates.len() {
            let start = std::time::Instant::now();
            let rate = schedule.rates[epoch];
            let order = order(schedule.seed, epoch, samples);
            let losses;
            (self, losses) = self.steps(rate, order.chunks(schedule.batch).map(&batch))?;
            let networks = self.histories.len();
            let seconds = start.elapsed().as_secs_f64() / networks as f64;
            let steps = (losses.len() / networks).max(1) as f64;
            for (number, history) in self.histories.iter_mut().enumerate() {
                let loss = losses.iter().skip(number).step_by(networks).sum::<f64>() / steps;
                history.push(Epoch { rate, loss, seconds });
            }
            if !after(&self)? {
                break;
            }
        }
        Ok(self)
    }

    /// Takes a step on each batch, and returns the losses: batch by batch, of each network. The device is waited for once, at the end.
    ///
    /// # Errors
    ///
    /// `Unsupported` for a device whose numbers cannot be read, `Device` for one that fails.
    pub fn steps(
        mut self,
        rate: f64,
        batches: impl Iterator<Item = L::Batch>,
    ) -> Result<(Self, Vec<f64>), Error> {
        let mut losses = Vec::new();
        for batch in batches {
            let of_networks = self.network.losses(&batch);
            losses.push(of_networks.clone().inner());
            // Networks share no parameters: the gradient of the sum has each one's own.
            let gradients = GradientsParams::from_grads(of_networks.sum().backward(), &self.network);
            self.network = self.optimizer.step(rate, self.network, gradients);
        }
        if losses.is_empty() {
            return Ok((self, Vec::new()));
        }
        let count = losses.len() * self.network.networks();
        let losses = values::<f32>(&fetch(Tensor::cat(losses, 0))?, count)?;
        Ok((self, losses.into_iter().map(f64::from).collect()))
    }
}
