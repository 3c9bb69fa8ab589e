//! `nfr lab store`: the paper's network in a font.

use std::io::{self, Write};
use std::path::PathBuf;

use super::options::{ExperimentArgs, GlyphArgs, open_glyphs};
use crate::failure::Failure;
use crate::files::Output;
use nfr::internals::network::{NetworkWeights, Precision};
use nfr_lab::dataset::CharGlyph;
use nfr_lab::evaluation::measure;
use nfr_lab::memorisation::implicit;
use nfr_lab::output;
use nfr_lab::statistics::Summary;
use nfr_lab::stored_network::{network_weights, render_stored, stored_font};

/// Trains implicit networks, or takes trained ones, and stores them in a font that the library draws
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    glyphs: GlyphArgs,
    /// The font to write
    output: PathBuf,
    /// Bits of a weight: 16 or 8
    #[arg(long, value_name = "N", default_value = "16", value_parser = precision)]
    bits: Precision,
    #[command(flatten)]
    experiment: ExperimentArgs,
}

fn precision(bits: &str) -> Result<Precision, String> {
    match bits {
        "16" => Ok(Precision::Sixteen),
        "8" => Ok(Precision::Eight),
        _ => Err("use 16 or 8".into()),
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let output = Output::new(&args.output)?;
    let (dataset, chosen) = open_glyphs(&args.glyphs, &args.experiment)?;
    let labels = dataset.label_font()?;
    args.experiment.with(|context| {
        let trained = context.each(&chosen, |glyph| {
            let (evaluation, network) = implicit(context, &dataset, *glyph, &[])?;
            output::evaluation(context, &labels, &evaluation)?;
            Ok((evaluation, network_weights(&network, context.settings.implicit, &dataset, *glyph)?))
        })?;
        let networks: Vec<(CharGlyph, NetworkWeights)> =
            chosen.iter().copied().zip(trained.iter().map(|(_, weights)| weights.clone())).collect();
        let file = stored_font(&dataset, &networks, args.bits, context.settings.seed)?;
        output.write(&file)?;
        let mut out = io::stdout().lock();
        writeln!(out, "{}", context.settings.label())?;
        for (glyph, (evaluation, _)) in chosen.iter().zip(&trained) {
            let (squares, bytes) = render_stored(&file, &dataset, *glyph)?;
            let rows = measure("stored", &dataset, glyph.0, &evaluation.truth, &squares)?;
            let mse = Summary::of(rows.iter().map(|row| row.mse)).map_or(0.0, |summary| summary.mean);
            let (before, bits) = (evaluation.mse(), args.bits.bits());
            writeln!(
                out,
                "{:?}  {bits} bits  {bytes} bytes  mse {mse:.3e} ({before:.3e} in training, with what it draws beside the glyph)",
                glyph.0
            )?;
        }
        Ok(())
    })
}
