//! How long a glyph takes, beside other renderers.
//!
//! `cargo run --release --example speed -- NEURAL.ttf ORIGINAL.ttf [--json] [--ppem 12,16,24,40,63]
//! [--unicodes U+21-7E] [--rounds 31]`: microseconds a glyph on one core, the mean over the glyphs and the median of
//! the rounds. In each round every renderer has its turn of a millisecond or more, in an order that changes from round
//! to round, and draws all glyphs once, untimed, before its turn. Every renderer goes from a glyph's number to
//! coverage in memory, including the bitmap's box, and keeps what its interface lets it keep: `warm.rs` and `cold.rs`
//! say what each does.

#![allow(clippy::print_stdout)]

mod buffer;
mod cold;
mod round;
#[path = "../shared/skrifa_zeno.rs"]
mod skrifa_zeno;
mod table;
mod warm;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::ppem::PpemList;
use nfr_convert::select::{CodePoints, Selection};

use round::Candidate;

/// Times the drawing of glyphs beside other renderers
#[derive(Parser)]
struct Args {
    /// The neural font
    neural: PathBuf,
    /// The font that it was converted from
    original: PathBuf,
    /// Print one JSON object a line for each size, in microseconds a glyph
    #[arg(long)]
    json: bool,
    /// The sizes, in pixels per em
    #[arg(long, default_value = "12,16,24,40,63")]
    ppem: PpemList,
    /// The characters; those that have no model are left out
    #[arg(long, default_value = "U+21-7E")]
    unicodes: CodePoints,
    /// Turns of each renderer at each size
    #[arg(long, default_value_t = 31, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    let (neural, original) = (read(&args.neural)?, read(&args.original)?);
    let pair = FontPair::open(&original, 0, &neural)?;
    let gids = glyphs(&pair, &args.unicodes)?;
    let mut candidates = warm::candidates(&pair, &original)?;
    candidates.extend(cold::candidates(&pair, neural.as_slice().into(), original.as_slice().into())?);
    if !args.json {
        println!("{}\n", table::title(&args.neural, gids.len(), args.rounds));
    }
    let mut results = Vec::new();
    for &ppem in args.ppem.sizes() {
        let times = round::medians(&mut candidates, ppem, &gids, args.rounds)?;
        if args.json {
            println!("{}", table::json(ppem, &candidates, &times));
        }
        results.push((ppem, times));
    }
    if !args.json {
        let names: Vec<&str> = candidates.iter().map(Candidate::name).collect();
        print!("{}", table::for_people(&names, &results));
    }
    Ok(())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|e| format!("cannot read {} ({e})", path.display()))
}

/// The glyphs to draw: those of the characters that have models.
fn glyphs(pair: &FontPair<'_>, unicodes: &CodePoints) -> Result<Vec<u16>, Box<dyn Error>> {
    let selection = Selection { unicodes: unicodes.clone(), ..Selection::default() };
    let mut gids = selection.resolve(pair.original(), [])?;
    gids.retain(|gid| pair.font().has_model((*gid).into()));
    if gids.is_empty() {
        return Err("none of these characters has a model; choose others with --unicodes".into());
    }
    pair.check_outlines(&gids)?;
    Ok(gids)
}
