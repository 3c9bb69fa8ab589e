//! `nfr lab report`: every experiment, and a page of what came of them.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::options::{ExperimentArgs, SET, open_dataset, open_family};
use crate::failure::Failure;
use nfr_lab::dataset::{Dataset, SIDES};
use nfr_lab::family::{FamilyMember, weight_of};
use nfr_lab::report::{ReportContext, write};
use nfr_lab::study::StudyPlan;

/// Runs every experiment of the paper's evaluation and writes a page with its charts, pictures and tables
///
/// Trainings are kept: after an interruption the same command with --resume goes on.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The directory of the fonts that the project ships
    #[arg(long, value_name = "DIR", default_value = "fonts")]
    fonts: PathBuf,
    /// The characters that all models learn
    #[arg(long, value_name = "TEXT", default_value = "liagmw")]
    text: String,
    /// Those of them that the ablations, the weights and the stored networks are shown with
    #[arg(long, value_name = "TEXT", default_value = "lagm")]
    part: String,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

const FONTS: [&str; 3] = ["LiberationSerif-Regular.ttf", "LiberationSans-Regular.ttf", "DejaVuSans.ttf"];
const WEIGHTS: [&str; 3] = ["Roboto_500Medium.ttf", "Roboto_600SemiBold.ttf", "Roboto_700Bold.ttf"];

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let path = |name: &str| args.fonts.join(name);
    let fonts = FONTS.iter().map(|name| open_dataset(&args.experiment, &path(name), SET));
    let fonts = fonts.collect::<Result<Vec<Dataset>, Failure>>()?;
    let data = crate::files::read(&path(FONTS[0]))?;
    let all_sizes = Dataset::open(path(FONTS[0]), data, SET, &SIDES.collect::<Vec<_>>())?;
    let [medium, between, bold] = open_three(args, &WEIGHTS.map(path))?;
    let styles = open_family(&args.experiment, &[&path(FONTS[0]), &path(FONTS[1])], SET)?;
    let few = |count: usize| args.part.chars().skip(1).take(count).collect::<String>();
    let plan = StudyPlan {
        fonts: &fonts,
        all_sizes: &all_sizes,
        glyphs: &args.text,
        ablated: &args.part,
        stored: &few(1),
        weights: [
            FamilyMember { dataset: &medium, weight: weight_of(&medium.data)? },
            FamilyMember { dataset: &bold, weight: weight_of(&bold.data)? },
        ],
        between: &between,
        weighted: &few(2),
        styles: [
            FamilyMember { dataset: &styles[0], weight: -1.0 },
            FamilyMember { dataset: &styles[1], weight: 1.0 },
        ],
        styled: &few(1),
    };
    args.experiment.with(|context| {
        let results = plan.run(context)?;
        let directory = args.experiment.out().join("report");
        write(&directory, ReportContext { experiment: context, plan: &plan, results: &results })?;
        writeln!(io::stdout(), "{}\n{}", context.settings.label(), directory.join("index.html").display())?;
        Ok(())
    })
}

fn open_three(args: &Args, paths: &[PathBuf; 3]) -> Result<[Dataset; 3], Failure> {
    let paths = paths.each_ref().map(PathBuf::as_path);
    let datasets = open_family(&args.experiment, &paths as &[&Path], SET)?;
    datasets.try_into().map_err(|_| Failure::failed("three weights are needed"))
}
