//! `nfr lab truth`: the ground truth as pictures.

use std::io::{self, Write};
use std::path::PathBuf;

use super::options::SET;
use crate::failure::Failure;
use crate::files::read;
use nfr_convert::open::open;
use nfr_lab::dataset::{Dataset, SIDES};
use nfr_lab::truth::{Truth, store};

/// Writes the ground truth: for every size of a square box the hinted glyphs, as large as all of them fit
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A hinted TrueType font
    font: PathBuf,
    /// The directory to write: SIZE/uCODE.png and manifest.json
    #[arg(long, value_name = "DIR", default_value = "out/truth")]
    out: PathBuf,
    /// The glyphs, all of which have to fit
    #[arg(long, value_name = "TEXT", default_value = SET, hide_default_value = true, allow_hyphen_values = true)]
    set: String,
    /// The smallest box, in pixels
    #[arg(long, value_name = "N", default_value_t = *SIDES.start())]
    first: usize,
    /// The largest box, in pixels
    #[arg(long, value_name = "N", default_value_t = *SIDES.end())]
    last: usize,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if args.first == 0 || args.first > args.last || args.last > 512 {
        return Err(Failure::usage(format!(
            "boxes of {} to {} pixels; use sizes within 1–512, the smallest first",
            args.first, args.last
        )));
    }
    let data = read(&args.font)?;
    let at = |error: nfr_convert::Error| Failure::from(error).at(args.font.display());
    let font = open(&data, 0).map_err(at)?;
    let glyphs = Dataset::glyphs_of(&font, &args.set).map_err(at)?;
    let gids: Vec<u16> = glyphs.iter().map(|(_, gid)| *gid).collect();
    let truth = Truth::new(&font, &gids, args.first..=args.last).map_err(at)?;
    for warning in &truth.warnings {
        let _ = writeln!(io::stderr(), "{}: {warning}", args.font.display());
    }
    if let Some(parent) = args.out.parent() {
        std::fs::create_dir_all(parent)
            .map_err(|e| Failure::failed(format!("cannot make the directory {} ({e})", parent.display())))?;
    }
    store(&truth, &Dataset::stem(&args.font), &glyphs, &args.out)?;
    let mut out = io::stdout().lock();
    writeln!(out, "side  points  dpi  ppem")?;
    for size in &truth.sizes {
        writeln!(out, "{:4}  {:6}  {:3}  {:4}", size.side, size.point_size, size.resolution, size.ppem)?;
    }
    writeln!(
        out,
        "{} bitmaps of {} glyphs in {}",
        truth.sizes.len() * gids.len(),
        gids.len(),
        args.out.display()
    )?;
    Ok(())
}
