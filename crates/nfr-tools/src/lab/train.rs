//! `nfr lab implicit`, `nfr lab masked` and `nfr lab grid-fit`: one of the models for some glyphs.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::PathBuf;

use super::bench::{BenchArgs, SET, open_subject};
use crate::failure::Failure;
use nfr_lab::bench::{Glyph, Subject};
use nfr_lab::output;
use nfr_lab::single::{self, Ablation, Model, train};

/// Trains the implicit network: from a pixel's place and the size to its intensity class
#[derive(Debug, clap::Args)]
pub(super) struct ImplicitArgs {
    #[command(flatten)]
    glyphs: GlyphArgs,
    /// Ablations: leave out frequencies, memorisation, residuals or size
    #[arg(long, value_name = "PARTS", value_delimiter = ',')]
    without: Vec<Ablation>,
    #[command(flatten)]
    bench: BenchArgs,
}

/// Trains the masked network: from a size to a bitmap of the largest size, most of it masked
#[derive(Debug, clap::Args)]
pub(super) struct MaskedArgs {
    #[command(flatten)]
    glyphs: GlyphArgs,
    #[command(flatten)]
    bench: BenchArgs,
}

/// Trains the grid-fit field, this project's own model, at the same sizes: with default options, whatever --epochs says
#[derive(Debug, clap::Args)]
pub(super) struct GridFitArgs {
    #[command(flatten)]
    glyphs: GlyphArgs,
    #[command(flatten)]
    bench: BenchArgs,
}

/// Which glyphs of which font.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct GlyphArgs {
    /// A hinted TrueType font
    pub(super) font: PathBuf,
    /// The characters to train, a network for each
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    pub(super) text: String,
    /// The glyphs that have to fit the box
    #[arg(long, value_name = "TEXT", default_value = SET, hide_default_value = true, allow_hyphen_values = true)]
    pub(super) set: String,
}

pub(super) fn implicit(args: &ImplicitArgs) -> Result<(), Failure> {
    run(&args.glyphs, &args.bench, &Model::Implicit(args.without.clone()))
}

pub(super) fn masked(args: &MaskedArgs) -> Result<(), Failure> {
    run(&args.glyphs, &args.bench, &Model::Masked)
}

fn run(glyphs: &GlyphArgs, args: &BenchArgs, model: &Model) -> Result<(), Failure> {
    let (subject, chosen) = open(glyphs, args)?;
    args.with(|bench| {
        let outcomes = bench.each(&chosen, |glyph| {
            let outcome = train(bench, &subject, *glyph, model)?;
            output::outcome(bench, &outcome)?;
            Ok(outcome)
        })?;
        output::settings(bench)?;
        Ok(io::stdout().write_all(output::summary(&bench.settings, &outcomes).as_bytes())?)
    })
}

pub(super) fn grid_fit(args: &GridFitArgs) -> Result<(), Failure> {
    let (subject, chosen) = open(&args.glyphs, &args.bench)?;
    args.bench.with(|bench| {
        let (outcomes, bytes): (Vec<_>, Vec<_>) =
            single::grid_fit(bench, &subject, &chosen)?.into_iter().unzip();
        outcomes.iter().try_for_each(|outcome| output::outcome(bench, outcome))?;
        output::settings(bench)?;
        let mut text = output::summary(&bench.settings, &outcomes);
        for (outcome, bytes) in outcomes.iter().zip(bytes) {
            // A string takes everything that is written to it.
            let _ = writeln!(text, "{:?}  {bytes} bytes", outcome.glyph);
        }
        Ok(io::stdout().write_all(text.as_bytes())?)
    })
}

/// Opens the font, and finds the glyphs.
pub(super) fn open(glyphs: &GlyphArgs, args: &BenchArgs) -> Result<(Subject, Vec<Glyph>), Failure> {
    let subject = open_subject(args, &glyphs.font, &glyphs.set)?;
    let chosen = subject.glyphs(&glyphs.text)?;
    if chosen.is_empty() {
        return Err(Failure::usage("no characters are given; name some with --text"));
    }
    Ok((subject, chosen))
}
