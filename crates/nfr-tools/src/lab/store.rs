//! `nfr lab store`: the paper's network in a font.

use std::io::{self, Write};
use std::path::PathBuf;

use super::bench::BenchArgs;
use super::train::{GlyphArgs, open};
use crate::failure::Failure;
use crate::files::Output;
use nfr::internals::model::network::NetworkWeights;
use nfr::internals::table::Precision;
use nfr_lab::output;
use nfr_lab::single::implicit;
use nfr_lab::stored::{drawn, font, weights};
use nfr_lab::{bench::Glyph, error::Summary, single::measure};

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
    bench: BenchArgs,
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
    let (subject, chosen) = open(&args.glyphs, &args.bench)?;
    args.bench.with(|bench| {
        let trained = bench.each(&chosen, |glyph| {
            let (outcome, network) = implicit(bench, &subject, *glyph, &[])?;
            output::outcome(bench, &outcome)?;
            Ok((outcome, weights(&network, bench.settings.implicit, &subject, *glyph)?))
        })?;
        let networks: Vec<(Glyph, NetworkWeights)> =
            chosen.iter().copied().zip(trained.iter().map(|(_, weights)| weights.clone())).collect();
        let file = font(&subject, &networks, args.bits, bench.settings.seed)?;
        output.write(&file)?;
        let mut out = io::stdout().lock();
        writeln!(out, "{}", bench.settings.label())?;
        for (glyph, (outcome, _)) in chosen.iter().zip(&trained) {
            let (squares, bytes) = drawn(&file, &subject, *glyph)?;
            let rows = measure("stored", &subject, glyph.0, &outcome.truth, &squares)?;
            let mse = Summary::of(rows.iter().map(|row| row.mse)).map_or(0.0, |summary| summary.mean);
            let (before, bits) = (outcome.mse(), args.bits.bits());
            writeln!(
                out,
                "{:?}  {bits} bits  {bytes} bytes  mse {mse:.3e} ({before:.3e} in training, with what it draws beside the glyph)",
                glyph.0
            )?;
        }
        Ok(())
    })
}
