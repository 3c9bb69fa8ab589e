//! Options of the experiments' commands, and the fonts that they name.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::args::{all_cores, jobs};
use crate::failure::Failure;
use crate::files::read;
use nfr_convert::ppem::PpemList;
use nfr_lab::accelerator::Accelerator;
use nfr_lab::dataset::{CharGlyph, Dataset, SIDES};
use nfr_lab::experiment::Experiment;
use nfr_lab::settings::{ExperimentScale, Settings};

/// The glyphs that the fit rule looks at unless others are given.
pub(super) const SET: &str =
    "!\"#$%&'()*+,-./0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz{|}~";

/// The time between lines of progress.
const INTERVAL: Duration = Duration::from_secs(10);

/// Options of every experiment.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct ExperimentArgs {
    /// The scale: paper for the published widths, epochs and sizes, small for two cores
    #[arg(long, value_name = "NAME", default_value = "small")]
    scale: ExperimentScale,
    /// The directory for trainings and results [default: out/lab/SCALE]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Go on with trainings that are there already, and use those that are finished
    #[arg(long)]
    resume: bool,
    /// Where to train: cpu, or gpu where that is built in
    #[arg(long, value_name = "NAME", default_value = "cpu", value_parser = device)]
    device: DeviceOption,
    /// Trainings at once; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = all_cores(), value_parser = jobs)]
    jobs: usize,
    /// Determines first weights and the order of bitmaps
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Train for so many epochs instead of the scale's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    epochs: Option<u32>,
    /// Train for boxes of so many pixels instead of the scale's, as in 20-36:4
    #[arg(long, value_name = "LIST", value_parser = boxes)]
    boxes: Option<PpemList>,
    /// Print nothing but results and errors
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Clone, Copy)]
enum DeviceOption {
    Cpu,
    #[cfg(feature = "gpu-wgsl")]
    Gpu,
}

fn device(name: &str) -> Result<DeviceOption, String> {
    match name {
        "cpu" => Ok(DeviceOption::Cpu),
        #[cfg(feature = "gpu-wgsl")]
        "gpu" => Ok(DeviceOption::Gpu),
        #[cfg(not(feature = "gpu-wgsl"))]
        "gpu" => Err("this program is built without it; build it with --features gpu".into()),
        _ => Err("use cpu or gpu".into()),
    }
}

/// Sides of boxes, written as a list of sizes.
fn boxes(list: &str) -> Result<PpemList, String> {
    let boxes: PpemList = list.parse()?;
    match boxes.sizes().iter().find(|side| !SIDES.contains(&usize::from(**side))) {
        Some(side) => {
            let (first, last) = SIDES.into_inner();
            Err(format!("a box of {side} pixels is outside the paper's {first}-{last}; choose boxes within"))
        }
        None => Ok(boxes),
    }
}

impl ExperimentArgs {
    pub(super) fn settings(&self) -> Settings {
        let mut settings = Settings { seed: self.seed, ..Settings::new(self.scale) };
        if let Some(epochs) = self.epochs {
            settings.set_epochs(epochs as usize);
        }
        if let Some(boxes) = &self.boxes {
            settings.sides = boxes.sizes().iter().copied().map(usize::from).collect();
        }
        settings
    }

    pub(super) fn out(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| Path::new("out/lab").join(self.scale.name()))
    }

    /// Runs an experiment with these options.
    pub(super) fn with<R>(
        &self,
        work: impl FnOnce(&Experiment<'_>) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        let last = Mutex::new(Instant::now());
        let on_progress = |training: &str, done: usize, epochs: usize| {
            let mut last = last.lock().unwrap_or_else(PoisonError::into_inner);
            if !self.quiet && last.elapsed() >= INTERVAL {
                *last = Instant::now();
                // A closed stderr must not stop the training.
                let _ = writeln!(io::stderr(), "{training}: {done} of {epochs} epochs");
            }
        };
        let accelerator = match self.device {
            DeviceOption::Cpu => Accelerator::processor(),
            #[cfg(feature = "gpu-wgsl")]
            DeviceOption::Gpu => Accelerator::gpu()?,
        };
        let context = Experiment {
            settings: self.settings(),
            accelerator,
            jobs: self.jobs,
            together: 1,
            directory: Some(self.out()),
            resume: self.resume,
            merged: Vec::new(),
            deadline: None,
            unfinished: false,
            keep_networks: true,
            on_progress: &on_progress,
        };
        work(&context)
    }

    /// Prints a line on stderr, unless `--quiet` is given.
    pub(super) fn note(&self, text: &str) {
        if !self.quiet {
            let _ = writeln!(io::stderr(), "{text}");
        }
    }
}

/// Opens fonts that share the sizes of their truths.
pub(super) fn open_family(
    args: &ExperimentArgs,
    paths: &[&Path],
    set: &str,
) -> Result<Vec<Dataset>, Failure> {
    let files = paths.iter().map(|path| Ok((path.to_path_buf(), read(path)?)));
    let files = files.collect::<Result<Vec<_>, Failure>>()?;
    let datasets = Dataset::family(files, set, &args.settings().sides)?;
    for dataset in &datasets {
        for warning in &dataset.truth.warnings {
            args.note(&format!("{}: {warning}", dataset.name));
        }
    }
    Ok(datasets)
}

/// Opens one font.
pub(super) fn open_dataset(args: &ExperimentArgs, path: &Path, set: &str) -> Result<Dataset, Failure> {
    let mut datasets = open_family(args, &[path], set).map_err(|failure| failure.at(path.display()))?;
    datasets.pop().ok_or_else(|| Failure::usage("no font is given"))
}

/// Which glyphs of which font.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct GlyphArgs {
    /// A hinted TrueType font
    font: PathBuf,
    /// The characters to train, a network for each
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    text: String,
    /// The glyphs that have to fit the box
    #[arg(long, value_name = "TEXT", default_value = SET, hide_default_value = true, allow_hyphen_values = true)]
    set: String,
}

/// Opens the font, and finds the glyphs.
pub(super) fn open_glyphs(
    glyphs: &GlyphArgs,
    args: &ExperimentArgs,
) -> Result<(Dataset, Vec<CharGlyph>), Failure> {
    let dataset = open_dataset(args, &glyphs.font, &glyphs.set)?;
    let chosen = dataset.glyphs(&glyphs.text)?;
    if chosen.is_empty() {
        return Err(Failure::usage("no characters are given; name some with --text"));
    }
    Ok((dataset, chosen))
}
