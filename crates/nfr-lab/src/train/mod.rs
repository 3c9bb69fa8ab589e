//! Training either network: epochs over shuffled bitmaps with Adam, and a history of the loss.

pub mod checkpoint;

use burn::module::Module;
use burn::optim::{AdamConfig, GradientsParams, ModuleOptimizer};
use burn::tensor::Tensor;

use super::random::Random;
use nfr_convert::error::Error;

/// Adam's epsilon in the paper's framework. There it is added to the uncorrected root of the second moment, in burn, as
/// in PyTorch, to the corrected one, so that the first steps are longer here.
const EPSILON: f32 = 1e-7;

/// A network that learns from batches.
pub trait TrainableNetwork: Module {
    /// The data of one optimiser step.
    type Batch;

    /// The loss of a batch.
    fn loss(&self, batch: &Self::Batch) -> Tensor<1>;
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
    /// How long it took.
    pub seconds: f64,
}

/// A network in training.
pub struct Training<L> {
    /// The network as it is by now.
    pub network: L,
    optimizer: ModuleOptimizer,
    /// The epochs so far.
    pub history: Vec<Epoch>,
}

impl<L: TrainableNetwork> Training<L> {
    /// A training that has not begun.
    pub fn new(network: L) -> Self {
        let optimizer = AdamConfig::new().with_epsilon(EPSILON).init();
        Self { network, optimizer, history: Vec::new() }
    }

    /// Trains until the schedule ends. `batch` makes a batch from the numbers of some of the `samples` bitmaps, `after`
    /// is called after every epoch.
    ///
    /// # Errors
    ///
    /// Those of `after`.
    pub fn train(
        mut self,
        schedule: &TrainingSchedule,
        samples: usize,
        batch: impl Fn(&[usize]) -> L::Batch,
        mut after: impl FnMut(&Self) -> Result<(), Error>,
    ) -> Result<Self, Error> {
        for epoch in self.history.len()..schedule.rates.len() {
            let start = std::time::Instant::now();
            let rate = schedule.rates[epoch];
            // Stream 0 is that of the first weights.
            let order = Random::new(schedule.seed, epoch as u64 + 1).order(samples);
            let (mut sum, mut batches) = (0.0, 0);
            for numbers in order.chunks(schedule.batch) {
                let loss = self.network.loss(&batch(numbers));
                sum += f64::from(loss.clone().inner().into_scalar::<f32>());
                batches += 1;
                let gradients = GradientsParams::from_grads(loss.backward(), &self.network);
                self.network = self.optimizer.step(rate, self.network, gradients);
            }
            let seconds = start.elapsed().as_secs_f64();
            self.history.push(Epoch { rate, loss: sum / f64::from(batches.max(1)), seconds });
            after(&self)?;
        }
        Ok(self)
    }
}
