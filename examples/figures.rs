//! Converts fonts and prints how close the models come, as a Markdown table.
//!
//! `cargo run --release --example figures [-- FONT.ttf ...]`: printable ASCII at 8–64 ppem; without arguments,
//! the three fonts that README speaks of. The error is measured on the finished files.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::thread::available_parallelism;
use std::time::Instant;

use nfr::compare::fonts::FontPair;
use nfr::convert::{Options, Progress, convert};

const FONTS: [&str; 3] =
    ["fonts/LiberationSans-Regular.ttf", "fonts/LiberationSerif-Regular.ttf", "fonts/DejaVuSans.ttf"];

struct Silent;

impl Progress for Silent {
    fn glyph_done(&self, _gid: u16, _mae: f64) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let fonts = if given.is_empty() { FONTS.map(String::from).to_vec() } else { given };
    let jobs = available_parallelism()?.get();
    println!(
        "| font | mae (unhinted) | bad16 (unhinted) | mae 8–15 ppem | worst glyph | bytes a glyph | time |"
    );
    println!("|---|---|---|---|---|---|---|");
    for path in fonts {
        let original = std::fs::read(&path)?;
        let font = read_fonts::FontRef::new(&original)?;
        let selection =
            nfr::convert::select::Selection { unicodes: "U+21-7E".parse()?, ..Default::default() };
        let options = Options { gids: selection.resolve(&font, [])?, jobs, ..Options::default() };
        let start = Instant::now();
        let conversion = convert(&original, &options, &Silent)?;
        let seconds = start.elapsed().as_secs_f64();
        let pair = FontPair::open(&original, 0, &conversion.font)?;
        let report = pair.report([&path, "converted"], &options.gids, &"8-64".parse()?, jobs)?;
        let (neural, unhinted) = (&report.totals.neural.figures, &report.totals.unhinted.figures);
        let worst = report.by_glyph.first().map_or(0.0, |g| g.compared.neural.figures.mae);
        let small = report.bands.first().map_or(0.0, |b| b.compared.neural.figures.mae);
        println!(
            "| {path} | {:.4} ({:.4}) | {:.2} % ({:.1} %) | {small:.4} | {worst:.4} | {:.0} | {seconds:.0} s |",
            neural.mae,
            unhinted.mae,
            100.0 * neural.bad16,
            100.0 * unhinted.bad16,
            report.subject.bytes_per_glyph,
        );
    }
    Ok(())
}
