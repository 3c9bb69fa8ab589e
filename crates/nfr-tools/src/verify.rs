//! `nfr verify`: proves what a neural font keeps of its original's hinting.

use std::io::{self, Write};
use std::path::PathBuf;

use super::args::{SelectionArgs, all_cores, jobs};
use super::failure::Failure;
use super::files::{modelled, open_neural, read};
use super::progress::print_line;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::open::{has_models, open};
use nfr_convert::ppem::PpemList;

/// Proves what a neural font keeps: compares hinted points, advance widths and side bearings with the original's
///
/// Every point, on the curve or off it, is compared along x and y in 1/64 pixel with where skrifa's interpreter puts it, with the
/// settings that the font was converted with. Exits with 0 if everything is equal, with 1 if something differs or a glyph cannot be
/// compared, and with 2 if an error keeps it from comparing.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The hinted font
    original: PathBuf,
    /// The neural font made from it
    neural: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Sizes in pixels per em, as in 12, 8-64, 8-64:2 or 9,12,16-20 [default: all trained sizes]
    #[arg(long, value_name = "SIZES")]
    ppem: Option<PpemList>,
    /// The font's index, if the original is a collection
    #[arg(long, value_name = "N", default_value_t = 0)]
    index: u32,
    /// Threads; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = all_cores(), value_parser = jobs)]
    jobs: usize,
    /// Accept points that are off by so much along x or y, in 1/64 pixel, and side bearings; advance widths must be
    /// equal all the same
    #[arg(long, value_name = "N", default_value_t = 0)]
    at_most: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs `nfr verify`.
///
/// # Errors
///
/// With exit code 1 if something differs or a glyph cannot be compared, with 2 for fonts that cannot be read or do not belong
/// together.
pub fn run(args: &Args) -> Result<(), Failure> {
    let failures = verify(args).map_err(Failure::with_code_of_errors)?;
    if failures.is_empty() { Ok(()) } else { Err(Failure::failed(failures.join("; "))) }
}

/// Compares the fonts and prints the result. Returns what is not equal.
fn verify(args: &Args) -> Result<Vec<String>, Failure> {
    let (original, neural) = (read(&args.original)?, read(&args.neural)?);
    check_roles(args, &original, &neural)?;
    open_neural(&args.neural, &neural)?;
    let pair = FontPair::open_edited(&original, args.index, &neural)?;
    let gids = args.selection.resolve(pair.original(), modelled(pair.font())?, print_line)?;
    let (first, last) = pair.font().ppem_range();
    let trained = || PpemList::from(first..=last);
    let ppem = args.ppem.clone().unwrap_or_else(trained);
    let names = [&args.original, &args.neural].map(|path| path.display().to_string());
    let verification = pair.verify([&names[0], &names[1]], &gids, &ppem, args.jobs)?;
    let text = if args.json {
        serde_json::to_string(&verification).map_err(|e| Failure::failed(e.to_string()))? + "\n"
    } else {
        verification.to_string()
    };
    io::stdout().write_all(text.as_bytes())?;
    Ok(verification.failures(args.at_most))
}

/// Refuses an original that was converted itself: its hints are gone.
fn check_roles(args: &Args, original: &[u8], neural: &[u8]) -> Result<(), Failure> {
    let [first, second] = [&args.original, &args.neural].map(|path| path.display());
    let original = open(original, args.index).map_err(|e| Failure::from(e).at(&first))?;
    if !has_models(&original) {
        return Ok(());
    }
    Err(Failure::failed(if open(neural, 0).is_ok_and(|font| !has_models(&font)) {
        format!(
            "{first} is the neural font and {second} is not: the arguments are swapped; write nfr verify {second} {first}"
        )
    } else {
        format!(
            "{first}: the font was converted itself and has no hints left to compare with; pass the hinted font that the neural \
             one was made from"
        )
    }))
}
