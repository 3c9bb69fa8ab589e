//! `nfr lab implicit`, `nfr lab masked` and `nfr lab grid-fit`: one of the models for some glyphs.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::options::{ExperimentArgs, GlyphArgs, open_glyphs};
use crate::failure::Failure;
use nfr_lab::memorisation::{self, train};
use nfr_lab::network_variant::{Ablation, NetworkVariant};
use nfr_lab::output;

/// Trains the implicit network: from a pixel's place and the size to its intensity class
#[derive(Debug, clap::Args)]
pub(super) struct ImplicitArgs {
    #[command(flatten)]
    glyphs: GlyphArgs,
    /// Ablations: leave out frequencies, memorisation, residuals or size
    #[arg(long, value_name = "PARTS", value_delimiter = ',')]
    without: Vec<Ablation>,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

/// Trains the masked network: from a size to a bitmap of the largest size, most of it masked
#[derive(Debug, clap::Args)]
pub(super) struct MaskedArgs {
    #[command(flatten)]
    glyphs: GlyphArgs,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

/// Trains the grid-fit field, this project's own model, at the same sizes: with default options, whatever --epochs says
#[derive(Debug, clap::Args)]
pub(super) struct GridFitArgs {
    #[command(flatten)]
    glyphs: GlyphArgs,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

pub(super) fn implicit(args: &ImplicitArgs) -> Result<(), Failure> {
    run(&args.glyphs, &args.experiment, &NetworkVariant::Implicit(args.without.clone()))
}

pub(super) fn masked(args: &MaskedArgs) -> Result<(), Failure> {
    run(&args.glyphs, &args.experiment, &NetworkVariant::Masked)
}

fn run(glyphs: &GlyphArgs, args: &ExperimentArgs, model: &NetworkVariant) -> Result<(), Failure> {
    let (dataset, chosen) = open_glyphs(glyphs, args)?;
    let labels = dataset.label_font()?;
    args.with(|context| {
        let evaluations = context.each(&chosen, |glyph| {
            let evaluation = train(context, &dataset, *glyph, model)?;
            output::evaluation(context, &labels, &evaluation)?;
            Ok(evaluation)
        })?;
        output::settings(context)?;
        Ok(io::stdout().write_all(output::summary(&context.settings, &evaluations).as_bytes())?)
    })
}

pub(super) fn grid_fit(args: &GridFitArgs) -> Result<(), Failure> {
    let (dataset, chosen) = open_glyphs(&args.glyphs, &args.experiment)?;
    let labels = dataset.label_font()?;
    args.experiment.with(|context| {
        let (evaluations, bytes): (Vec<_>, Vec<_>) =
            memorisation::grid_fit(context, &dataset, &chosen)?.into_iter().unzip();
        evaluations.iter().try_for_each(|evaluation| output::evaluation(context, &labels, evaluation))?;
        output::settings(context)?;
        let mut text = output::summary(&context.settings, &evaluations);
        for (evaluation, bytes) in evaluations.iter().zip(bytes) {
            // A string takes everything that is written to it.
            let _ = writeln!(text, "{:?}  {bytes} bytes", evaluation.glyph);
        }
        Ok(io::stdout().write_all(text.as_bytes())?)
    })
}
