//! Training a network from its first weights to its last epoch, and the bitmaps that it draws then.

use std::time::Instant;

use burn::tensor::Device;

use super::SquareBitmap;
use super::implicit::{Implicit, ImplicitConfig, Statistics};
use super::masked::Masked;
use super::masked_samples::MaskedSamples;
use super::samples::{ImplicitSamples, PixelLayout, TrainingSample, likeliest};
use super::train::checkpoint::Checkpoint;
use super::train::{Epoch, TrainableNetwork, Training, TrainingSchedule};
use nfr_convert::error::Error;

/// Checkpoints are written this often, in seconds of training for each network in them.
const SAVE_INTERVAL: f64 = 60.0;

/// A training that is finished, or has fewer epochs than its schedule, since its time was up.
pub struct TrainedNetwork<N> {
    /// The network.
    pub network: N,
    /// Its epochs.
    pub history: Vec<Epoch>,
    /// Floating-point operations of the matrix products of all steps.
    pub operations: u64,
    /// Its bitmap for each training sample.
    pub drawn: Vec<SquareBitmap>,
}

/// How a training runs.
#[derive(Clone, Copy)]
pub struct TrainingRun<'r> {
    /// Where tensors live, with autodiff.
    pub device: &'r Device,
    /// How the pixels of the implicit network lie in tensors.
    pub layout: PixelLayout,
    /// Where the training is saved, and goes on from.
    pub checkpoint: Option<&'r Checkpoint>,
    /// When it has to stop: after the epoch in which this passes.
    pub deadline: Option<Instant>,
    /// Called after every epoch with the number of those done.
    pub on_epoch: &'r (dyn Fn(usize) + Sync),
}

/// Trains an implicit network on bitmaps of `sizes` sizes.
///
/// # Errors
///
/// As the checkpoint's; `Device` for a device that fails, `Unsupported` for one whose numbers cannot be read.
pub fn train_implicit(
    samples: Vec<TrainingSample>,
    sizes: usize,
    config: ImplicitConfig,
    schedule: &TrainingSchedule,
    run: TrainingRun<'_>,
) -> Result<TrainedNetwork<Implicit>, Error> {
    let set = ImplicitSamples::new(samples, sizes, config, run.layout, run.device);
    let network = Implicit::new(config, schedule.seed, run.device);
    let training = train(network, schedule, set.len(), |numbers| set.batch(numbers), run)?;
    let statistics = if config.memorisation { Statistics::Batch } else { Statistics::Running };
    let draw = |(k, sample): (usize, &TrainingSample)| {
        likeliest(training.network.forward(&set.batch(&[k]).0, statistics), sample.truth.side)
    };
    let drawn = set.samples().enumerate().map(draw).collect::<Result<_, _>>()?;
    let operations =
        operations(&training.network, training.epochs(), set.len(), |numbers| set.batch(numbers));
    Ok(trained(training, operations, drawn))
}

/// Trains a masked network on bitmaps of different sizes, whose boxes ascend.
///
/// # Errors
///
/// As [`train_implicit`].
pub fn train_masked(
    samples: &[TrainingSample],
    widths: &[usize],
    schedule: &TrainingSchedule,
    run: TrainingRun<'_>,
) -> Result<TrainedNetwork<Masked>, Error> {
    let set = MaskedSamples::new(samples, run.device);
    let network = Masked::new(widths, set.len(), set.largest(), schedule.seed, run.device);
    let training = train(network, schedule, set.len(), |numbers| set.batch(numbers), run)?;
    let drawn = set.draw(&training.network)?;
    let operations =
        operations(&training.network, training.epochs(), set.len(), |numbers| set.batch(numbers));
    Ok(trained(training, operations, drawn))
}

/// A training of one network.
fn trained<L>(mut training: Training<L>, operations: u64, drawn: Vec<SquareBitmap>) -> TrainedNetwork<L> {
    let history = training.histories.pop().unwrap_or_default();
    TrainedNetwork { drawn, operations, network: training.network, history }
}

/// The operations of all epochs: those of an epoch do not depend on how it is cut into batches.
pub(super) fn operations<L: TrainableNetwork>(
    network: &L,
    epochs: usize,
    samples: usize,
    batch: impl Fn(&[usize]) -> L::Batch,
) -> u64 {
    let epoch: f64 = (0..samples).map(|k| network.operations(&batch(&[k]))).sum();
    epoch as u64 * epochs as u64
}

/// Trains a network that may be in a checkpoint, and writes one now and then.
pub(super) fn train<L: TrainableNetwork>(
    network: L,
    schedule: &TrainingSchedule,
    samples: usize,
    batch: impl Fn(&[usize]) -> L::Batch,
    run: TrainingRun<'_>,
) -> Result<Training<L>, Error> {
    let training = match run.checkpoint {
        Some(checkpoint) => checkpoint.begin(network)?,
        None => Training::new(network),
    };
    let mut unsaved = 0.0;
    training.train(schedule, samples, batch, |training| {
        (run.on_epoch)(training.epochs());
        let finished = training.epochs() == schedule.rates.len();
        let late = !finished && run.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        unsaved += training.histories[0].last().map_or(0.0, |epoch| epoch.seconds);
        if let Some(checkpoint) = run.checkpoint
            && (unsaved >= SAVE_INTERVAL || finished || late)
        {
            unsaved = 0.0;
            checkpoint.save(training)?;
        }
        Ok(!late)
    })
}
