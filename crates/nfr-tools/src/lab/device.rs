//! `nfr lab device`: whether a device trains as the processor does, and how fast.

use std::io::{self, Write};

use super::options::{ExperimentArgs, GlyphArgs, open_glyphs};
use crate::failure::Failure;
use nfr_lab::device_check::{ROUND, compare_losses, time_steps};

/// Losses that are further apart are a fault of the device or its driver.
const APART: f64 = 0.01;

/// Takes the same training steps on the processor and on a device, compares the losses, and times a step
///
/// The steps are short ones, at a rate of 1e-5, which do not magnify rounding. Fails if the losses of the last step are more than 1 % apart.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    glyphs: GlyphArgs,
    /// Steps to compare, or 0 to compare none
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    steps: u32,
    /// The box whose step is timed, in pixels
    #[arg(long = "box", value_name = "N", default_value_t = 40)]
    side: usize,
    /// Time so many implicit networks in lockstep, each on one bitmap (more than once: of several)
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u8).range(1..))]
    together: Vec<u8>,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (dataset, glyphs) = open_glyphs(&args.glyphs, &args.experiment)?;
    let (_, gid) = glyphs[0];
    let samples = dataset.samples(gid, None)?;
    let Some(timed) = samples.iter().find(|sample| sample.truth.side == args.side) else {
        return Err(Failure::usage(format!("there is no box of {} pixels; name one of --boxes", args.side)));
    };
    args.experiment.with(|context| {
        let (settings, accelerator) = (&context.settings, &context.accelerator);
        let mut out = io::stdout();
        writeln!(out, "{}\non {accelerator}", settings.label())?;
        for &together in args.together.iter().filter(|_| accelerator.is_timed()) {
            let time = time_steps(settings, timed, together.into(), accelerator)?;
            let (side, milliseconds) = (args.side, time.seconds * 1e3);
            let (billions, rate) = (time.operations / 1e9, time.operations / time.seconds / 1e12);
            let networks = match together {
                1 => "the implicit network".to_owned(),
                _ => format!("{together} implicit networks in lockstep, each"),
            };
            writeln!(
                out,
                "a step of {networks} on {side}×{side} pixels: {milliseconds:.2} ms, {billions:.1} GFLOP, \
                 {rate:.2} TFLOP/s; the first {ROUND} steps {:.1} s",
                time.first
            )?;
        }
        if args.steps == 0 {
            return Ok(());
        }
        let mut wrong = Vec::new();
        for found in compare_losses(settings, &samples, args.steps as usize, accelerator)? {
            let last = |losses: &[f64]| losses.last().copied().unwrap_or(f64::NAN);
            let first = found.processor.first().copied().unwrap_or(f64::NAN);
            let (processor, device, apart) = (last(&found.processor), last(&found.device), found.apart());
            writeln!(
                out,
                "{} network, loss from {first:.4e} in step 1 to {processor:.6e} on the CPU and {device:.6e} here in step {}: \
                 {:.3} % apart",
                found.network,
                args.steps,
                apart * 100.0
            )?;
            if accelerator.is_timed() {
                let [processor, device] = found.seconds;
                writeln!(out, "  {processor:.1} s on the CPU, {device:.1} s here with the compiling of kernels")?;
            }
            if apart.is_nan() || apart > APART {
                wrong.push(found.network);
            }
        }
        if wrong.is_empty() {
            return Ok(());
        }
        Err(Failure::failed(format!(
            "the device does not train as the CPU does ({}); update its driver, or use --device cpu",
            wrong.join(", ")
        )))
    })
}
