//! `nfr lab report`: every experiment, and a page of what came of them.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::bench::{BenchArgs, SET, open_family, open_subject};
use crate::failure::Failure;
use nfr_lab::bench::{SIDES, Subject};
use nfr_lab::family::{Member, weight_of};
use nfr_lab::report::{Part, write};
use nfr_lab::study::Plan;

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
    bench: BenchArgs,
}

const FONTS: [&str; 3] = ["LiberationSerif-Regular.ttf", "LiberationSans-Regular.ttf", "DejaVuSans.ttf"];
const WEIGHTS: [&str; 3] = ["Roboto_500Medium.ttf", "Roboto_600SemiBold.ttf", "Roboto_700Bold.ttf"];

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let path = |name: &str| args.fonts.join(name);
    let fonts = FONTS.iter().map(|name| open_subject(&args.bench, &path(name), SET));
    let fonts = fonts.collect::<Result<Vec<Subject>, Failure>>()?;
    let data = crate::files::read(&path(FONTS[0]))?;
    let all_sizes = Subject::open(path(FONTS[0]), data, SET, &SIDES.collect::<Vec<_>>())?;
    let [medium, between, bold] = open_three(args, &WEIGHTS.map(path))?;
    let styles = open_family(&args.bench, &[&path(FONTS[0]), &path(FONTS[1])], SET)?;
    let few = |count: usize| args.part.chars().skip(1).take(count).collect::<String>();
    let plan = Plan {
        fonts: &fonts,
        all_sizes: &all_sizes,
        glyphs: &args.text,
        ablated: &args.part,
        stored: &few(1),
        weights: [
            Member { subject: &medium, weight: weight_of(&medium.data)? },
            Member { subject: &bold, weight: weight_of(&bold.data)? },
        ],
        between: &between,
        weighted: &few(2),
        styles: [Member { subject: &styles[0], weight: -1.0 }, Member { subject: &styles[1], weight: 1.0 }],
        styled: &few(1),
    };
    args.bench.with(|bench| {
        let findings = plan.run(bench)?;
        let place = args.bench.out().join("report");
        write(&place, Part { bench, plan: &plan, findings: &findings })?;
        writeln!(io::stdout(), "{}\n{}", bench.settings.label(), place.join("index.html").display())?;
        Ok(())
    })
}

fn open_three(args: &Args, paths: &[PathBuf; 3]) -> Result<[Subject; 3], Failure> {
    let paths = paths.each_ref().map(PathBuf::as_path);
    let subjects = open_family(&args.bench, &paths as &[&Path], SET)?;
    subjects.try_into().map_err(|_| Failure::failed("three weights are needed"))
}
