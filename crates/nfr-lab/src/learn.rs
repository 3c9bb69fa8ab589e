//! One training from its bitmaps to what the network has learnt of them.

use burn::tensor::{Device, Tensor, TensorData};

use super::Square;
use super::enlarge::Enlargement;
use super::implicit::{Implicit, ImplicitConfig, Statistics};
use super::masked::{Enlarged, Masked};
use super::samples::{ImplicitSet, Sample, likeliest};
use super::tensors::values;
use super::train::checkpoint::Checkpoint;
use super::train::{Course, Epoch, Learner, Run};
use nfr_convert::error::Error;

/// Checkpoints are written this often, in seconds of training.
const SAVE_INTERVAL: f64 = 60.0;

/// A finished training.
pub struct Learnt<N> {
    /// The network.
    pub network: N,
    /// Its epochs.
    pub history: Vec<Epoch>,
    /// What it draws for each bitmap that it was shown.
    pub drawn: Vec<Square>,
}

/// Called after every epoch with the number of those done.
pub type Tell<'a> = &'a (dyn Fn(usize) + Sync);

/// Trains an implicit network on bitmaps of `sizes` sizes.
///
/// # Errors
///
/// As the checkpoint's, and `Unsupported` for a device whose numbers cannot be read.
pub fn implicit(
    samples: Vec<Sample>,
    sizes: usize,
    config: ImplicitConfig,
    course: &Course,
    device: &Device,
    checkpoint: Option<&Checkpoint>,
    tell: Tell<'_>,
) -> Result<Learnt<Implicit>, Error> {
    let set = ImplicitSet::new(samples, sizes, config, device);
    let network = Implicit::new(config, course.seed, device);
    let run = finished(network, course, set.len(), |numbers| set.batch(numbers), checkpoint, tell)?;
    let statistics = if config.memorisation { Statistics::Batch } else { Statistics::Running };
    let draw = |(k, sample): (usize, &Sample)| {
        likeliest(run.network.forward(&set.batch(&[k]).0, statistics), sample.truth.side)
    };
    let drawn = set.samples().enumerate().map(draw).collect::<Result<_, _>>()?;
    Ok(Learnt { drawn, network: run.network, history: run.history })
}

/// Trains a masked network on bitmaps of different sizes, whose boxes ascend.
///
/// # Errors
///
/// As the checkpoint's, and `Unsupported` for a device whose numbers cannot be read.
pub fn masked(
    samples: &[Sample],
    widths: &[usize],
    course: &Course,
    device: &Device,
    checkpoint: Option<&Checkpoint>,
    tell: Tell<'_>,
) -> Result<Learnt<Masked>, Error> {
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
    let network = Masked::new(widths, items.len(), largest, course.seed, device);
    let run = finished(network, course, items.len(), batch, checkpoint, tell)?;
    let draw = |(k, (sample, enlargement)): (usize, &(&Sample, Enlargement))| {
        let drawn = run.network.forward(batch(&[k]).sizes).into_data();
        let levels = values::<f32>(&drawn, largest * largest)?;
        let pixels = enlargement.shrink(&levels).into_iter().map(|v| (v * 255.0).round() as u8).collect();
        Ok(Square { side: sample.truth.side, pixels })
    };
    let drawn = items.iter().enumerate().map(draw).collect::<Result<_, Error>>()?;
    Ok(Learnt { drawn, network: run.network, history: run.history })
}

fn finished<L: Learner>(
    network: L,
    course: &Course,
    samples: usize,
    batch: impl Fn(&[usize]) -> L::Batch,
    checkpoint: Option<&Checkpoint>,
    tell: Tell<'_>,
) -> Result<Run<L>, Error> {
    let run = match checkpoint {
        Some(checkpoint) => checkpoint.begin(network)?,
        None => Run::new(network),
    };
    let mut unsaved = 0.0;
    run.train(course, samples, batch, |run| {
        tell(run.history.len());
        let Some(checkpoint) = checkpoint else { return Ok(()) };
        unsaved += run.history.last().map_or(0.0, |epoch| epoch.seconds);
        if unsaved >= SAVE_INTERVAL || run.history.len() == course.rates.len() {
            unsaved = 0.0;
            checkpoint.save(run)?;
        }
        Ok(())
    })
}
