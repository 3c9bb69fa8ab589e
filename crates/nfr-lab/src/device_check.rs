//! Whether a device trains as the processor does, and how fast.

use std::time::Instant;

use burn::tensor::Device;

use super::accelerator::Accelerator;
use super::guard::guarded;
use super::implicit::Implicit;
use super::lockstep::{Lockstep, LockstepSamples};
use super::masked::Masked;
use super::masked_samples::MaskedSamples;
use super::network_variant::NetworkVariant;
use super::samples::{ImplicitSamples, PixelLayout, TrainingSample};
use super::settings::Settings;
use super::train::{TrainableNetwork, Training, TrainingSchedule, order};
use nfr_convert::error::Error;

/// The rate of the steps whose losses are compared. The implicit network's first one, a hundred times as high, magnifies
/// rounding: at the published width, adding in another order on the same processor changes the loss by a tenth in ten steps.
/// At this rate it falls to a quarter in thirty steps, and such an order changes it by less than a ten-thousandth.
const RATE: f64 = 1e-5;
/// Networks in lockstep whose losses are compared.
const TOGETHER: usize = 2;
/// Rounds of steps that are timed; the median counts.
const ROUNDS: usize = 5;
/// Steps of a round.
pub const ROUND: usize = 20;

/// The losses of the same steps on the processor and on a device.
#[derive(Debug, Clone, PartialEq)]
pub struct LossComparison {
    /// The network.
    pub network: String,
    /// The loss of each step on the processor.
    pub processor: Vec<f64>,
    /// The loss of each step on the device.
    pub device: Vec<f64>,
    /// Seconds that the steps took on each, with the compiling of kernels.
    pub seconds: [f64; 2],
}

impl LossComparison {
    /// How far the losses of the last step are apart, as a share of the processor's.
    pub fn apart(&self) -> f64 {
        let last = |losses: &[f64]| losses.last().copied().unwrap_or(f64::NAN);
        (last(&self.device) / last(&self.processor) - 1.0).abs()
    }
}

/// Steps on one bitmap, timed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepTime {
    /// Seconds of the first [`ROUND`] steps, in which kernels are compiled and chosen.
    pub first: f64,
    /// Seconds of a step: the median of some rounds.
    pub seconds: f64,
    /// Floating-point operations of a step in its matrix products.
    pub operations: f64,
}

/// The losses of a network's steps on a device.
type Losses<'l> = dyn Fn(&Device, PixelLayout) -> Result<Vec<f64>, Error> + 'l;

/// Trains both networks for some steps at a low rate on the processor and on a device, from the same weights and in the same order.
///
/// # Errors
///
/// `Device` for a device that fails.
pub fn compare_losses(
    settings: &Settings,
    samples: &[TrainingSample],
    steps: usize,
    accelerator: &Accelerator,
) -> Result<Vec<LossComparison>, Error> {
    let implicit = |device: &Device, layout: PixelLayout| {
        let schedule = settings.implicit_schedule(settings.implicit);
        let set = ImplicitSamples::new(samples.to_vec(), samples.len(), settings.implicit, layout, device);
        let network = Implicit::new(settings.implicit, schedule.seed, device);
        losses(network, &schedule, set.len(), steps, |numbers| set.batch(numbers))
    };
    let lockstep = |device: &Device, _: PixelLayout| {
        let schedule = settings.implicit_schedule(settings.implicit);
        let (set, network) = in_lockstep(settings, samples, TOGETHER, device)?;
        losses(network, &schedule, set.len(), steps, |numbers| set.batch(numbers[0]).clone())
    };
    let masked = |device: &Device, _: PixelLayout| {
        let schedule = settings.masked_schedule();
        let set = MaskedSamples::new(samples, device);
        let network = Masked::new(&settings.masked_widths, set.len(), set.largest(), schedule.seed, device);
        losses(network, &schedule, set.len(), steps, |numbers| set.batch(numbers))
    };
    let compare = |network: String, run: &Losses<'_>| {
        let start = Instant::now();
        let cpu = Accelerator::processor();
        let processor = run(&cpu.device.clone().autodiff(), cpu.layout())?;
        let first = start.elapsed().as_secs_f64();
        let device = guarded(|| run(&accelerator.device.clone().autodiff(), accelerator.layout()))?;
        let seconds = [first, start.elapsed().as_secs_f64() - first];
        Ok::<_, Error>(LossComparison { network, processor, device, seconds })
    };
    Ok(vec![
        compare(NetworkVariant::Implicit(Vec::new()).name(), &implicit)?,
        compare(format!("{TOGETHER} in lockstep, each an implicit"), &lockstep)?,
        compare(NetworkVariant::Masked.name(), &masked)?,
    ])
}

/// So many implicit networks in lockstep that learn the same bitmaps.
fn in_lockstep(
    settings: &Settings,
    samples: &[TrainingSample],
    together: usize,
    device: &Device,
) -> Result<(LockstepSamples, Lockstep), Error> {
    let networks = vec![Implicit::new(settings.implicit, settings.seed, device); together];
    let members = vec![(samples.to_vec(), settings.implicit); together];
    Ok((LockstepSamples::new(&members, &networks, device)?, Lockstep::new(&networks)))
}

/// The losses of the first steps of a training, but at [`RATE`].
fn losses<L: TrainableNetwork>(
    network: L,
    schedule: &TrainingSchedule,
    samples: usize,
    steps: usize,
    batch: impl Fn(&[usize]) -> L::Batch,
) -> Result<Vec<f64>, Error> {
    let epochs = (0..steps).flat_map(|epoch| {
        let order = order(schedule.seed, epoch, samples);
        order.chunks(schedule.batch).map(&batch).collect::<Vec<_>>()
    });
    let (_, losses) = Training::new(network).steps(RATE, epochs.take(steps))?;
    Ok(losses)
}

/// Times steps of the implicit network on one bitmap, or of several in lockstep, each on one.
///
/// # Errors
///
/// `Device` for a device that fails.
pub fn time_steps(
    settings: &Settings,
    sample: &TrainingSample,
    together: usize,
    accelerator: &Accelerator,
) -> Result<StepTime, Error> {
    let device = accelerator.device.clone().autodiff();
    let rate = settings.implicit_schedule(settings.implicit).rates.first().copied().unwrap_or_default();
    let samples = vec![sample.clone()];
    guarded(|| {
        if together > 1 {
            let (set, network) = in_lockstep(settings, &samples, together, &device)?;
            return timed(network, rate, || set.batch(0).clone());
        }
        let layout = accelerator.layout();
        let set = ImplicitSamples::new(samples.clone(), 1, settings.implicit, layout, &device);
        timed(Implicit::new(settings.implicit, settings.seed, &device), rate, || set.batch(&[0]))
    })
}

fn timed<L: TrainableNetwork>(
    network: L,
    rate: f64,
    batch: impl Fn() -> L::Batch,
) -> Result<StepTime, Error> {
    let operations = network.operations(&batch());
    let mut training = Training::new(network);
    let round = |training| {
        let start = Instant::now();
        let (training, _) = Training::steps(training, rate, (0..ROUND).map(|_| batch()))?;
        Ok::<_, Error>((training, start.elapsed().as_secs_f64()))
    };
    let first;
    (training, first) = round(training)?;
    let mut seconds = [0.0; ROUNDS];
    for seconds in &mut seconds {
        let elapsed;
        (training, elapsed) = round(training)?;
        *seconds = elapsed / ROUND as f64;
    }
    seconds.sort_by(f64::total_cmp);
    Ok(StepTime { first, seconds: seconds[ROUNDS / 2], operations })
}
