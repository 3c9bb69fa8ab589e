//! Converts fonts and prints how close the models come, as a Markdown table.
//!
//! `cargo run --release --example figures [-- OPTIONS] [FONT.ttf ...]`: printable ASCII at 8–64 ppem; without fonts,
//! the three that README speaks of. `--quality 0,25,50,75,100` prints a line for each of these settings, and
//! `--target mono` hints in x too, `--hinter auto` learns from the autohinter, and `--shape field` trains fields, in a build with `--features train`. `--train-ppem 8-64:2`
//! learns from these sizes alone and measures the error at the others.
//! The error is measured on the finished files; the last but one column is against the plain outline, at sizes above
//! the trained ones.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::thread::available_parallelism;
use std::time::Instant;

use clap::Parser;
use nfr::{Font, Rasterizer, Target};
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::metrics::Sums;
use nfr_convert::ppem::PpemList;
use nfr_convert::teacher::Teacher;
use nfr_convert::{Hinter, Options, Progress, Quality, Shape, convert};

const FONTS: [&str; 3] =
    ["fonts/LiberationSans-Regular.ttf", "fonts/LiberationSerif-Regular.ttf", "fonts/DejaVuSans.ttf"];

#[derive(Parser)]
struct Args {
    /// The fonts to convert
    fonts: Vec<String>,
    /// Qualities to convert them with, 0 to 100
    #[arg(long, value_delimiter = ',', default_value = "50")]
    quality: Vec<f32>,
    /// What to hint for
    #[arg(long, default_value_t, value_parser = nfr_tools::target)]
    target: Target,
    /// Whose hints to learn: the font's, or those of skrifa's autohinter
    #[arg(long, default_value_t, value_parser = nfr_tools::hinter)]
    hinter: Hinter,
    /// Where models have their shapes from
    #[arg(long, default_value = "auto", value_parser = nfr_tools::shape)]
    shape: Shape,
    /// The sizes to learn
    #[arg(long, default_value = "8-64")]
    train_ppem: PpemList,
    /// The sizes to measure, other than those to learn if those have a step
    #[arg(long)]
    ppem: Option<PpemList>,
    /// The characters
    #[arg(long, default_value = "U+21-7E")]
    unicodes: String,
}

/// Sizes above the trained range, at which the plain outline is drawn.
const LARGE_SIZES: [f32; 8] = [65.0, 72.0, 80.0, 96.0, 128.0, 160.0, 192.0, 256.0];

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _gid: u16, _mae: f64) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let fonts = if args.fonts.is_empty() { FONTS.map(String::from).to_vec() } else { args.fonts.clone() };
    println!(
        "| font | quality | mae (unhinted) | bad16 (unhinted) | mae 8–15 ppem | worst glyph | bytes a glyph | plain outline at 65–256 ppem | time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for path in fonts {
        for quality in &args.quality {
            println!("{}", line(&path, *quality, &args)?);
        }
    }
    Ok(())
}

fn line(path: &str, quality: f32, args: &Args) -> Result<String, Box<dyn Error>> {
    let jobs = available_parallelism()?.get();
    let original = std::fs::read(path)?;
    let font = read_fonts::FontRef::new(&original)?;
    let selection = nfr_convert::select::Selection { unicodes: args.unicodes.parse()?, ..Default::default() };
    let (ppem, ppem_step) = args.train_ppem.evenly_spaced().ok_or("train on evenly spaced sizes")?;
    let options = Options {
        gids: selection.resolve(&font, [])?.gids,
        jobs,
        target: args.target,
        hinter: args.hinter,
        shape: args.shape,
        ppem: ppem.clone(),
        ppem_step,
        ..Options::default().with_quality(Quality::new(quality).ok_or("a quality is 0 to 100")?)
    };
    let start = Instant::now();
    let conversion = convert(&original, &options, &Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let others: Vec<String> =
        ppem.clone().filter(|s| (s - ppem.start()) % ppem_step != 0).map(|s| s.to_string()).collect();
    let measured = match &args.ppem {
        Some(list) => list.clone(),
        None if others.is_empty() => args.train_ppem.clone(),
        None => others.join(",").parse()?,
    };
    let pair = FontPair::open(&original, 0, &conversion.font)?;
    let report = pair.report([path, "converted"], &options.gids, &measured, jobs)?;
    let (neural, unhinted) = (&report.totals.neural.figures, &report.totals.unhinted.figures);
    let worst = report.by_glyph.first().map_or(0.0, |g| g.compared.neural.figures.mae);
    let small = report.bands.first().map_or(0.0, |b| b.compared.neural.figures.mae);
    let large = large_size_mae(
        &Teacher::with_hinter(&font, args.target, args.hinter)?,
        &conversion.font,
        &options.gids,
    )?;
    Ok(format!(
        "| {path} | {quality} | {:.5} ({:.4}) | {:.3} % ({:.1} %) | {small:.5} | {worst:.5} | {:.1} | {large:.5} | {seconds:.1} s |",
        neural.mae,
        unhinted.mae,
        100.0 * neural.bad16,
        100.0 * unhinted.bad16,
        report.header.bytes_per_glyph,
    ))
}

/// The mean absolute error against the plain outline.
fn large_size_mae(teacher: &Teacher, converted: &[u8], gids: &[u16]) -> Result<f64, Box<dyn Error>> {
    let font = Font::new(converted.to_vec())?;
    let mut rasterizer = Rasterizer::new(&font);
    let mut sums = Sums::default();
    for (gid, ppem) in gids.iter().flat_map(|gid| LARGE_SIZES.map(|ppem| (*gid, ppem))) {
        sums.add(&teacher.unhinted(gid, ppem)?.rasterize()?, &rasterizer.render(gid.into(), ppem)?);
    }
    Ok(sums.mae())
}
