//! Training a network from its first weights to its last epoch, and the bitmaps that it draws then.

use burn::tensor::{Device, Tensor, TensorData};

use super::SquareBitmap;
use super::enlarge::Enlargement;
use super::implicit::{Implicit, ImplicitConfig, Statistics};
use super::masked::{Enlarged, Masked};
use super::samples::{ImplicitSamples, TrainingSample, likeliest};
use super::tensors::values;
use super::train::checkpoint::Checkpoint;
use super::train::{Epoch, TrainableNetwork, Training, TrainingSchedule};
use nfr_convert::error::Error;

/// Checkpoints are written this often, in seconds of training.
const SAVE_INTERVAL: f64 = 60.0;

/// A finished training.
pub struct TrainedNetwork<N> {
    /// The network.
    pub network: N,
    /// Its epochs.
    pub history: Vec<Epoch>,
    /// Its bitmap for each training sample.
    pub drawn: Vec<SquareBitmap>,
}

/// Called after every epoch with the number of those done.
pub type OnEpoch<'a> = &'a (dyn Fn(usize) + Sync);

/// Trains an implicit network on bitmaps of `sizes` sizes.
///
/// # Errors
///
/// As the checkpoint's, and `Unsupported` for a device whose numbers cannot be read.
pub fn train_implicit(
    samples: Vec<TrainingSample>,
    sizes: usize,
    config: ImplicitConfig,
    schedule: &TrainingSchedule,
    device: &Device,
    checkpoint: Option<&Checkpoint>,
    on_epoch: OnEpoch<'_>,
) -> Result<TrainedNetwork<Implicit>, Error> {
    let set = ImplicitSamples::new(samples, sizes, config, device);
    let network = Implicit::new(config, schedule.seed, device);
    let training = run(network, schedule, set.len(), |numbers| set.batch(numbers), checkpoint, on_epoch)?;
    let statistics = if config.memorisation { Statistics::Batch } else { Statistics::Running };
    let draw = |(k, sample): (usize, &TrainingSample)| {
        likeliest(training.network.forward(&set.batch(&[k]).0, statistics), sample.truth.side)
    };
    let drawn = set.samples().enumerate().map(draw).collect::<Result<_, _>>()?;
    Ok(TrainedNetwork { drawn, network: training.network, history: training.history })
}

/// Trains a masked network on bitmaps of different sizes, whose boxes ascend.
///
/// # Errors
///
/// As the checkpoint's, and `Unsupported` for a device whose numbers cannot be read.
pub fn train_masked(
    samples: &[TrainingSample],
    widths: &[usize],
    schedule: &TrainingSchedule,
    device: &Device,
    checkpoint: Option<&Checkpoint>,
    on_epoch: OnEpoch<'_>,
) -> Result<TrainedNetwork<Masked>, Error> {
    let largest = samples.iter().map(|sample| sample.truth.side).max().unwrap_or(1);
    let items: Vec<_> =
        samples.iter().map(|sample| (sample, Enlargement::new(sample.truth.side, largest))).collect();
    let batch = |numbers: &[usize]| {
        let rows = |columns: usize, row: &dyn Fn(usize) -> Vec<f32>| {
            let values: Vec<f32> = numbers.iter().flat_map(|k| row(*k)).collect();
            Tensor::from_data(TensorData::new(values, [numbers.len(), columns]), device)
        };
        let hot = |k: usize| (0..items.len()).map(|size| f32::from(u8::from(size == k))).collect();
        let coverage = |k: usize| -> Vec<f32> {
            let (sample, enlargement) = &items[k];
            enlargement.enlarge(&sample.truth).pixels.iter().map(|v| f32::from(*v) / 255.0).collect()
        };
        Enlarged {
            sizes: rows(items.len(), &hot),
            coverage: rows(largest * largest, &coverage),
            mask: rows(largest * largest, &|k| items[k].1.mask()),
        }
    };
    let network = Masked::new(widths, items.len(), largest, schedule.seed, device);
    let training = run(network, schedule, items.len(), batch, checkpoint, on_epoch)?;
    let draw = |(k, (sample, enlargement)): (usize, &(&TrainingSample, Enlargement))| {
        let drawn = training.network.forward(batch(&[k]).sizes).into_data();
        let levels = values::<f32>(&drawn, largest * largest)?;
        let pixels = enlargement.shrink(&levels).into_iter().map(|v| (v * 255.0).round() as u8).collect();
        Ok(SquareBitmap { side: sample.truth.side, pixels })
    };
    let drawn = items.iter().enumerate().map(draw).collect::<Result<_, Error>>()?;
    Ok(TrainedNetwork { drawn, network: training.network, history: training.history })
}

fn run<L: TrainableNetwork>(
    network: L,
    schedule: &TrainingSchedule,
    samples: usize,
    batch: impl Fn(&[usize]) -> L::Batch,
    checkpoint: Option<&Checkpoint>,
    on_epoch: OnEpoch<'_>,
) -> Result<Training<L>, Error> {
    let training = match checkpoint {
        Some(checkpoint) => checkpoint.begin(network)?,
        None => Training::new(network),
    };
    let mut unsaved = 0.0;
    training.train(schedule, samples, batch, |training| {
        on_epoch(training.history.len());
        let Some(checkpoint) = checkpoint else { return Ok(()) };
        unsaved += training.history.last().map_or(0.0, |epoch| epoch.seconds);
        if unsaved >= SAVE_INTERVAL || training.history.len() == schedule.rates.len() {
            unsaved = 0.0;
            checkpoint.save(training)?;
        }
        Ok(())
    })
}
