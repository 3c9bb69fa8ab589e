//! `nfr bench`: how long a glyph takes, beside other renderers.
//!
//! All renderers are timed in one process on one thread. In each round every one has its turn of a millisecond or more,
//! in an order that changes from round to round, after drawing all glyphs once for the caches. Every renderer goes from
//! a glyph's number to coverage in memory, including the bitmap's box, and keeps what its interface lets it keep:
//! `warm.rs`, `cold.rs` and `peers.rs` say what each does.

mod buffer;
mod cold;
mod peers;
mod renderer;
mod round;
pub mod skrifa_zeno;
mod table;
mod warm;

use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;

use super::args::SelectionArgs;
use super::failure::Failure;
use super::files::{open_neural, read};
use super::progress::print_line;
use super::source::read_unpacked;
use nfr::Font;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::ppem::PpemList;

use peers::Original;
use round::{Candidate, medians};
use table::Measured;

/// What is drawn unless glyphs are selected: printable ASCII.
const PRINTABLE: std::ops::RangeInclusive<char> = ' '..='~';

/// Times the drawing of glyphs beside other renderers
///
/// Prints microseconds a glyph on one core: the mean over the glyphs, the median of rounds in which every renderer has its
/// turn. The table says what each row measures. Without a selection, the printable ASCII characters that have models
/// are drawn.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The hinted font
    original: PathBuf,
    /// The neural font made from it
    neural: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Sizes in pixels per em, as in 12, 8-64, 8-64:2 or 9,12,16-20
    #[arg(long, value_name = "SIZES", default_value = "12,16,24,40,63")]
    ppem: PpemList,
    /// The font's index, if the original is a collection
    #[arg(long, value_name = "N", default_value_t = 0)]
    index: u32,
    /// Turns of each renderer at each size
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
    /// Print one JSON object a line for each size; its fields are named as the table's rows
    #[arg(long)]
    json: bool,
}

/// Runs `nfr bench`.
///
/// # Errors
///
/// Fonts that do not belong together, a glyph without a model, or a renderer that cannot draw a glyph.
pub fn run(args: &Args) -> Result<(), Failure> {
    let (original, neural) = (read_unpacked(&args.original)?, read(&args.neural)?);
    open_neural(&args.neural, &neural)?;
    let pair = FontPair::open(&original, args.index, &neural)?;
    let gids = glyphs(args, &pair)?;
    let peer = Original { data: &original, index: args.index, target: pair.font().target() };
    let mut candidates = candidates(&pair, &peer, neural.as_slice().into()).map_err(failed)?;
    let mut out = io::stdout().lock();
    let mut sizes = Vec::new();
    for &ppem in args.ppem.sizes() {
        let times = medians(&mut candidates, ppem, &gids, args.rounds).map_err(failed)?;
        let measured = Measured { ppem, times: candidates.iter().map(Candidate::name).zip(times).collect() };
        if args.json {
            let json = serde_json::to_string(&measured).map_err(|e| Failure::failed(e.to_string()))?;
            writeln!(out, "{json}")?;
        }
        sizes.push(measured);
    }
    if !args.json {
        let (count, rounds) = (gids.len(), args.rounds);
        writeln!(out, "{count} glyphs, microseconds a glyph, median of {rounds} rounds\n")?;
        let rows: Vec<_> = candidates.iter().map(|candidate| (candidate.name(), candidate.about())).collect();
        write!(out, "{}", table::for_people(&rows, &sizes))?;
    }
    Ok(())
}

fn candidates<'a>(
    pair: &'a FontPair<'a>,
    original: &Original<'a>,
    neural: Arc<[u8]>,
) -> Result<Vec<Candidate<'a>>, Box<dyn Error>> {
    let mut candidates = vec![warm::nfr(pair.font())];
    candidates.extend(cold::candidates(pair.font(), neural));
    candidates.extend(peers::candidates(original)?);
    Ok(candidates)
}

/// The glyphs to draw, ascending.
fn glyphs(args: &Args, pair: &FontPair<'_>) -> Result<Vec<u16>, Failure> {
    let gids = args.selection.resolve(pair.original(), printable(pair.font()), print_line)?;
    if gids.is_empty() {
        return Err(Failure::failed(
            "no character of printable ASCII has a model; choose others, with --unicodes or --gids",
        ));
    }
    if let Some(gid) = gids.iter().find(|gid| !pair.font().has_model((**gid).into())) {
        return Err(nfr_convert::Error::MissingGlyph(*gid).into());
    }
    pair.check_outlines(&gids)?;
    Ok(gids)
}

/// The glyphs of printable ASCII that have models.
fn printable(font: &Font) -> impl Iterator<Item = u16> + '_ {
    let glyphs = PRINTABLE.filter_map(|character| font.glyph_for_char(character));
    glyphs.filter(|glyph| font.has_model(*glyph)).filter_map(|glyph| u16::try_from(glyph).ok())
}

// `map_err` hands its error over.
#[allow(clippy::needless_pass_by_value)]
fn failed(error: Box<dyn Error>) -> Failure {
    Failure::failed(error.to_string())
}
