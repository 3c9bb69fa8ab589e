//! `nfr verify`: measures again what a neural font's certificate says, and proves what it keeps of its original's hinting.

use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use super::args::{SelectionArgs, all_cores, jobs};
use super::failure::Failure;
use super::files::{modelled, open_neural, read};
use super::pace::Part;
use super::progress::{Meter, Verbosity, print_line};
use super::source::{Source, SourceArgs};
use nfr_convert::compare::certificate::CertificateCheck;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::verification::Verification;
use nfr_convert::open::{has_models, open};
use nfr_convert::ppem::PpemList;

/// Checks a neural font against its original: its certificate, and hinted points, advance widths and side bearings
///
/// The errors of each glyph's bitmaps are measured again, at all sizes of the models, and have to be no larger than the font's
/// certificate says. Every point, on the curve or off it, is compared along x and y in 1/64 pixel with where skrifa's interpreter puts
/// it, or its autohinter if the certificate names that, with the settings that the font was converted with; it has to be there if the font was converted to be exact (--quality 100),
/// or if --at-most says how far it may be. Exits with 0 if all of that holds, with 1 if not, or if a glyph has no model or another
/// outline, and with 2 if an error keeps it from comparing.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The font that it was made from: a font file, a collection, a web font (WOFF, WOFF2), or a variable font
    original: PathBuf,
    /// The neural font made from it
    neural: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Sizes at which points are compared, in pixels per em, as in 12, 8-64, 8-64:2 or 9,12,16-20 [default: all trained sizes]
    #[arg(long, value_name = "SIZES")]
    ppem: Option<PpemList>,
    #[command(flatten)]
    source: SourceArgs,
    /// Threads; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = all_cores(), value_parser = jobs)]
    jobs: usize,
    /// Points and side bearings may be off by so much along x or y, in 1/64 pixel; advance widths must be equal
    #[arg(long, value_name = "N")]
    at_most: Option<u32>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
}

/// Runs `nfr verify`.
///
/// # Errors
///
/// With exit code 1 if something does not hold, with 2 for fonts that cannot be read or do not belong
/// together.
pub fn run(args: &Args) -> Result<(), Failure> {
    let failures = verify(args).map_err(Failure::with_code_of_errors)?;
    if failures.is_empty() { Ok(()) } else { Err(Failure::failed(failures.join("; "))) }
}

/// Compares the fonts and prints the result. Returns what does not hold.
fn verify(args: &Args) -> Result<Vec<String>, Failure> {
    let (original, neural) = (args.source.load(&args.original)?, read(&args.neural)?);
    check_roles(args, &original, &neural)?;
    open_neural(&args.neural, &neural)?;
    let pair = FontPair::open_edited(&original.data, original.index, &neural)?;
    let gids = args.selection.resolve(pair.original(), modelled(pair.font())?, print_line)?;
    let (first, last) = pair.font().ppem_range();
    let trained = || PpemList::from(first..=last);
    let ppem = args.ppem.clone().unwrap_or_else(trained);
    let names = [&args.original, &args.neural].map(|path| path.display().to_string());
    let meter = Meter::new(if args.quiet { Verbosity::Quiet } else { Verbosity::Normal });
    meter.plan(&[Part::Verifying, Part::Certifying], gids.len());
    let is_verified = Arc::new(AtomicBool::new(false));
    let part = is_verified.clone();
    let pair = pair.watched_by(meter.watch(move || match part.load(Ordering::Relaxed) {
        false => Part::Verifying,
        true => Part::Certifying,
    }));
    let verification = pair.verify([&names[0], &names[1]], &gids, &ppem, args.jobs)?;
    is_verified.store(true, Ordering::Relaxed);
    let certificate = pair.check_certificate(&gids, args.jobs)?;
    drop(meter);
    let checked = Checked { verification, certificate };
    let text = if args.json {
        serde_json::to_string(&checked).map_err(|e| Failure::failed(e.to_string()))? + "\n"
    } else {
        let certificate = checked.certificate.as_ref().map(CertificateCheck::to_string);
        format!("{}{}", checked.verification, certificate.unwrap_or_else(|| "certificate   none\n".into()))
    };
    io::stdout().write_all(text.as_bytes())?;
    Ok(checked.failures(args.at_most))
}

/// What was compared.
#[derive(Debug, Serialize)]
struct Checked {
    #[serde(flatten)]
    verification: Verification,
    certificate: Option<CertificateCheck>,
}

impl Checked {
    fn failures(&self, at_most: Option<u32>) -> Vec<String> {
        let is_exact = self.certificate.as_ref().is_some_and(|certificate| certificate.is_exact);
        let mut failures = match at_most.or(is_exact.then_some(0)) {
            Some(at_most) => self.verification.failures(at_most),
            None => self.verification.undrawn().into_iter().collect(),
        };
        match &self.certificate {
            Some(certificate) => failures.extend(certificate.failures()),
            None if at_most.is_none() => {
                failures
                    .push("the font has no certificate; say with --at-most how far points may be off".into());
            }
            None => {}
        }
        failures
    }
}

/// Refuses an original that was converted itself: its hints are gone.
fn check_roles(args: &Args, original: &Source, neural: &[u8]) -> Result<(), Failure> {
    let [first, second] = [&args.original, &args.neural].map(|path| path.display());
    let original = open(&original.data, original.index).map_err(|e| Failure::from(e).at(&first))?;
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
