//! `nfr lab report`: every experiment, and a page of what came of them.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::options::{ExperimentArgs, SET, open_dataset, open_family};
use crate::failure::Failure;
use nfr_lab::dataset::{Dataset, SIDES};
use nfr_lab::experiment::Experiment;
use nfr_lab::family::{FamilyMember, weight_of};
use nfr_lab::queue::{self, QueueNetworks, QueuePart, QueueShare, QueueState};
use nfr_lab::report::{OtherReport, ReportContext, write};
use nfr_lab::settings::ExperimentScale;
use nfr_lab::study::StudyPlan;

/// Runs every experiment of the paper's evaluation and writes a page with its charts, pictures and tables
///
/// The trainings are a queue, the most telling first. Each is kept when it is finished, and its state every minute: after an
/// interruption the same command with --resume goes on. The page shows what is finished.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The directory of the fonts that the project ships
    #[arg(long, value_name = "DIR", default_value = "fonts")]
    fonts: PathBuf,
    /// The characters that both networks learn [default: liagmw, at the scale of the paper a-z]
    #[arg(long, value_name = "TEXT")]
    text: Option<String>,
    /// Those of them that come first, and that pictures show
    #[arg(long, value_name = "TEXT", default_value = "lagm")]
    part: String,
    /// The characters of the ablations [default: those of --part, at the scale of the paper g]
    #[arg(long, value_name = "TEXT")]
    ablated: Option<String>,
    /// The characters of the experiment on weights [default: ag, at the scale of the paper agmt]
    #[arg(long, value_name = "TEXT")]
    weighted: Option<String>,
    /// Stop after so many minutes, with everything saved
    #[arg(long, value_name = "MINUTES", value_parser = minutes)]
    time_limit: Option<Duration>,
    /// Do one part of several of the queue: 2/3 is every third training from the second on
    #[arg(long, value_name = "K/N", default_value = "1/1")]
    share: QueueShare,
    /// Train the networks of one kind: implicit (with those of weights and typefaces) or masked
    #[arg(long, value_name = "NAME", default_value = "all")]
    networks: QueueNetworks,
    /// Train so many implicit networks in lockstep, which a large GPU does in less time than one after the other
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..))]
    together: u8,
    /// Use the results of another run, on another machine perhaps, that are in this directory (more than once: of several)
    #[arg(long, value_name = "DIR")]
    merge: Vec<PathBuf>,
    /// Train, but write no page
    #[arg(long)]
    train_only: bool,
    /// Show the verdicts of another report beside these: that of the published scale, say
    #[arg(long, value_name = "REPORT")]
    beside: Option<PathBuf>,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

const FONTS: [&str; 3] = ["LiberationSerif-Regular.ttf", "LiberationSans-Regular.ttf", "DejaVuSans.ttf"];
const WEIGHTS: [&str; 3] = ["Roboto_500Medium.ttf", "Roboto_600SemiBold.ttf", "Roboto_700Bold.ttf"];
/// The character of the experiment on typefaces, and of the stored network.
const SINGLE: &str = "a";

fn minutes(text: &str) -> Result<Duration, String> {
    let minutes: f64 = text.parse().map_err(|_| format!("{text:?} is no number of minutes"))?;
    Duration::try_from_secs_f64(minutes * 60.0).map_err(|_| format!("{text:?} is no time that can pass"))
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let deadline = args.time_limit.and_then(|limit| Instant::now().checked_add(limit));
    for directory in &args.merge {
        if !directory.is_dir() {
            return Err(Failure::failed(format!("{} is no directory of results", directory.display())));
        }
    }
    let beside = args.beside.as_deref().map(OtherReport::read).transpose()?;
    let path = |name: &str| args.fonts.join(name);
    let fonts = FONTS.iter().map(|name| open_dataset(&args.experiment, &path(name), SET));
    let fonts = fonts.collect::<Result<Vec<Dataset>, Failure>>()?;
    let data = crate::files::read(&path(FONTS[0]))?;
    let all_sizes = Dataset::open(path(FONTS[0]), data, SET, &SIDES.collect::<Vec<_>>())?;
    let [medium, between, bold] = open_three(args, &WEIGHTS.map(path))?;
    let styles = open_family(&args.experiment, &[&path(FONTS[0]), &path(FONTS[1])], SET)?;
    let scale = args.experiment.settings().scale;
    let or = |given: &Option<String>, small: &str, paper: &str| match (given, scale) {
        (Some(given), _) => given.clone(),
        (None, ExperimentScale::Small) => small.to_owned(),
        (None, ExperimentScale::Paper) => paper.to_owned(),
    };
    let text = or(&args.text, "liagmw", &('a'..='z').collect::<String>());
    let known = |wanted: &str| wanted.chars().filter(|glyph| text.contains(*glyph)).collect::<String>();
    let (ablated, single) = (or(&args.ablated, &args.part, "g"), known(SINGLE));
    let weighted = or(&args.weighted, "ag", "agmt");
    let plan = StudyPlan {
        fonts: &fonts,
        all_sizes: &all_sizes,
        glyphs: &text,
        shown: &known(&args.part),
        ablated: &known(&ablated),
        stored: &single,
        weights: [
            FamilyMember { dataset: &medium, weight: weight_of(&medium.data)? },
            FamilyMember { dataset: &bold, weight: weight_of(&bold.data)? },
        ],
        between: &between,
        weighted: &known(&weighted),
        styles: [
            FamilyMember { dataset: &styles[0], weight: -1.0 },
            FamilyMember { dataset: &styles[1], weight: 1.0 },
        ],
        styled: &single,
    };
    args.experiment.with(|context| {
        let together = args.together.into();
        let context = &Experiment { merged: args.merge.clone(), deadline, together, ..context.clone() };
        let state = queue::run(&plan, context, QueuePart { networks: args.networks, share: args.share })?;
        let mut out = io::stdout();
        writeln!(out, "{}\non {}", context.settings.label(), context.accelerator)?;
        let QueueState { finished, jobs } = state;
        let more = if finished < jobs { "; go on with --resume" } else { "" };
        writeln!(out, "{finished} of {jobs} trainings are finished{more}")?;
        if args.train_only {
            return Ok(());
        }
        let results = plan.results(context)?;
        let directory = args.experiment.out().join("report");
        let report =
            ReportContext { experiment: context, plan: &plan, results: &results, beside: beside.as_ref() };
        write(&directory, report)?;
        writeln!(out, "{}", directory.join("index.html").display())?;
        Ok(())
    })
}

fn open_three(args: &Args, paths: &[PathBuf; 3]) -> Result<[Dataset; 3], Failure> {
    let paths = paths.each_ref().map(PathBuf::as_path);
    let datasets = open_family(&args.experiment, &paths as &[&Path], SET)?;
    datasets.try_into().map_err(|_| Failure::failed("three weights are needed"))
}
