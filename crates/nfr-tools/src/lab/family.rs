//! `nfr lab weights` and `nfr lab styles`: one network for several fonts.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::options::{ExperimentArgs, SET, open_family};
use crate::failure::Failure;
use nfr_lab::experiment::Experiment;
use nfr_lab::family::{FamilyMember, weight_of};
use nfr_lab::interpolation::{Interpolation, InterpolationTarget, interpolate};
use nfr_lab::output;

/// Trains one network for several weights of a family and draws a weight between them
#[derive(Debug, clap::Args)]
pub(super) struct WeightsArgs {
    /// Two fonts of the family or more, from light to bold
    #[arg(required = true, num_args = 2..)]
    fonts: Vec<PathBuf>,
    /// A real font with a weight between theirs, to compare with
    #[arg(long, value_name = "FONT")]
    between: PathBuf,
    #[command(flatten)]
    family: FamilyArgs,
}

/// Trains one network for several typefaces and draws what lies half-way between the first and the last
#[derive(Debug, clap::Args)]
pub(super) struct StylesArgs {
    /// Two fonts or more
    #[arg(required = true, num_args = 2..)]
    fonts: Vec<PathBuf>,
    #[command(flatten)]
    family: FamilyArgs,
}

#[derive(Debug, clap::Args)]
struct FamilyArgs {
    /// The characters to train, a network for each
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    text: String,
    /// The glyphs that have to fit the box, in all fonts
    #[arg(long, value_name = "TEXT", default_value = SET, hide_default_value = true, allow_hyphen_values = true)]
    set: String,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

pub(super) fn weights(args: &WeightsArgs) -> Result<(), Failure> {
    let paths: Vec<&Path> = args.fonts.iter().chain([&args.between]).map(PathBuf::as_path).collect();
    let mut datasets = open_family(&args.family.experiment, &paths, &args.family.set)?;
    let Some(between) = datasets.pop() else { return Err(Failure::usage("no fonts are given")) };
    let members =
        datasets.iter().map(|dataset| Ok(FamilyMember { dataset, weight: weight_of(&dataset.data)? }));
    let members = members.collect::<Result<Vec<_>, Failure>>()?;
    let at = weight_of(&between.data)?;
    let (first, last) = (members[0].weight, members[members.len() - 1].weight);
    if !(first < at && at < last) {
        return Err(Failure::failed(format!(
            "{} has the weight {:.0}, which is not between {:.0} and {:.0}; order the fonts from light to bold",
            args.between.display(),
            at * 1000.0,
            first * 1000.0,
            last * 1000.0
        )));
    }
    let target = InterpolationTarget {
        name: &between.name,
        share: (at - first) / (last - first),
        real: Some(&between),
    };
    run(&args.family, "weights", &members, target)
}

pub(super) fn styles(args: &StylesArgs) -> Result<(), Failure> {
    let paths: Vec<&Path> = args.fonts.iter().map(PathBuf::as_path).collect();
    let datasets = open_family(&args.family.experiment, &paths, &args.family.set)?;
    // As in the paper's code: evenly from −1 to 1.
    let last = (datasets.len() - 1) as f64;
    let member = |(k, dataset)| FamilyMember { dataset, weight: 2.0 * k as f64 / last - 1.0 };
    let members: Vec<FamilyMember<'_>> = datasets.iter().enumerate().map(member).collect();
    run(&args.family, "styles", &members, InterpolationTarget { name: "half-way", share: 0.5, real: None })
}

fn run(
    args: &FamilyArgs,
    experiment: &str,
    members: &[FamilyMember<'_>],
    target: InterpolationTarget<'_>,
) -> Result<(), Failure> {
    let text: Vec<char> = args.text.chars().collect();
    if text.is_empty() {
        return Err(Failure::usage("no characters are given; name some with --text"));
    }
    let labels = members[0].dataset.label_font()?;
    args.experiment.with(|context| {
        let found = context.each(&text, |glyph| {
            let found = interpolate(context, experiment, members, target, *glyph)?;
            output::interpolation(context, &labels, experiment, &found)?;
            Ok(found)
        })?;
        output::settings(context)?;
        Ok(io::stdout().write_all(table(context, &found).as_bytes())?)
    })
}

fn table(context: &Experiment<'_>, found: &[Interpolation]) -> String {
    let mut text = format!("{}\n", context.settings.label());
    for one in found {
        for rendering in one.ends.iter().chain(&one.between) {
            let mse = rendering.mse().map_or("no truth".into(), |mse| format!("mse {mse:.3e}"));
            // A string takes everything that is written to it.
            let _ = writeln!(text, "{:?}  {:24}  {:22}  {mse}", one.glyph, rendering.of, rendering.name);
        }
    }
    text
}
