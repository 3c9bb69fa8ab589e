//! `nfr diff`: a neural font against the hinted one that it was made from.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::args::{SelectionArgs, all_cores, jobs};
use super::failure::Failure;
use super::files::{Output, modelled, open_neural, read};
use super::pace::Part;
use super::progress::{Meter, Verbosity, print_line};
use super::source::SourceArgs;
use nfr_convert::Hinter;
use nfr_convert::compare::diff::Sources;
use nfr_convert::compare::fonts::FontPair;
use nfr_convert::compare::html::{self, SampleText, TextFont};
use nfr_convert::compare::picture::{LabelFont, SheetRow, png, sheet, text_line};
use nfr_convert::compare::report::Report;
use nfr_convert::compare::sample_text::{PANGRAM, WORD, sample_characters, sample_glyphs};
use nfr_convert::compare::source::BitmapSource;
use nfr_convert::compare::threshold::FailOn;
use nfr_convert::error::Error;
use nfr_convert::ppem::PpemList;
use nfr_convert::select::Selection;

/// The sizes of the web page's text, in pixels per em: those at which hinting shows.
const PAGE_SIZES: std::ops::RangeInclusive<u16> = 9..=24;
/// The sizes of the picture. A shorter list than this is shown whole.
const PICTURE_SIZES: [u16; 4] = [9, 12, 16, 24];
/// The most sizes shown where none of the usual ones was compared.
const FALLBACK_SIZES: usize = 6;

/// Compares a neural font with the hinted font that it was made from
///
/// The error is that of the models' bitmaps against the hinted ones, over the union of their boxes; the same
/// figures for the unhinted outlines stand beside it. A font that was converted with --hinter auto is compared with autohinted bitmaps.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The font that it was made from: a font file, a collection, a web font (WOFF, WOFF2), or a variable font
    original: PathBuf,
    /// The neural font made from it
    neural: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Sizes in pixels per em, as in 12, 8-64, 8-64:2 or 9,12,16-20
    #[arg(long, value_name = "SIZES", default_value = "8-64")]
    ppem: PpemList,
    #[command(flatten)]
    source: SourceArgs,
    /// Threads; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = all_cores(), value_parser = jobs)]
    jobs: usize,
    /// Write the whole report as JSON; "-" prints it instead of the table
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a web page, DIR/index.html: figures, the worst glyphs, any text at any size, and a search for glyphs
    #[arg(long, value_name = "DIR")]
    html: Option<PathBuf>,
    /// Draw text as neural, hinted and unhinted bitmaps side by side
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
    /// Enlarge that picture's pixels so many times
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=64))]
    zoom: u32,
    /// Exit with 1 if any condition holds, as in 'mae>0.006 || bad16>0.02'
    ///
    /// Conditions are joined by "," or "||". Each is a metric (mae, rmse, max, bad16, exact, bytes_per_glyph),
    /// a comparison (>, >=, <, <=) and a decimal number, and is checked on the figures of all glyphs and sizes.
    #[arg(long, value_name = "EXPR")]
    fail_on: Option<FailOn>,
    /// Print no progress
    #[arg(long, short)]
    quiet: bool,
}

/// Runs `nfr diff`.
///
/// # Errors
///
/// Fonts that do not belong together, a glyph without a model, a place that cannot be written, or a
/// condition of `--fail-on` that holds.
pub fn run(args: &Args) -> Result<(), Failure> {
    let (original, neural) = (args.source.load(&args.original)?, read(&args.neural)?);
    open_neural(&args.neural, &neural)?;
    let pair = FontPair::open(&original.data, original.index, &neural)?;
    let selection = args.selection.selection()?;
    let gids = args.selection.resolve(pair.original(), modelled(pair.font())?, print_line)?;
    let json_to_stdout = args.json.as_deref() == Some(Path::new("-"));
    let json = args.json.as_deref().filter(|_| !json_to_stdout).map(Output::new).transpose()?;
    let page = args.html.as_deref().map(page_in).transpose()?;
    let picture = args.png.as_deref().map(Output::new).transpose()?;

    let names = [&args.original, &args.neural].map(|path| path.display().to_string());
    let meter = Meter::new(if args.quiet { Verbosity::Quiet } else { Verbosity::Normal });
    meter.plan(&[Part::Comparing], gids.len());
    let pair = pair.watched_by(meter.watch(|| Part::Comparing));
    let report = pair.report([&names[0], &names[1]], &gids, &args.ppem, args.jobs)?;
    drop(meter);
    let as_json = serde_json::to_string_pretty(&report).map_err(|e| Failure::failed(e.to_string()))? + "\n";
    let table = if json_to_stdout { as_json.clone() } else { report.to_string() };
    io::stdout().write_all(table.as_bytes())?;
    if let Some(output) = json {
        output.write(as_json.as_bytes())?;
    }
    if let Some(output) = page {
        output.write(draw_page(args, &pair, &report, &selection, &gids)?.as_bytes())?;
    }
    if let Some(output) = picture {
        let text = sample_glyphs(pair.original(), &selection, &gids, WORD)?;
        output.write(&pair.with_sources(&gids, |sources| draw(args, &pair, &report, sources, &text))?)?;
    }
    let failures = args.fail_on.as_ref().map_or(Vec::new(), |conditions| conditions.failures(&report));
    if failures.is_empty() { Ok(()) } else { Err(Failure::failed(failures.join("; "))) }
}

/// The page of `--html`.
fn draw_page(
    args: &Args,
    pair: &FontPair<'_>,
    report: &Report,
    selection: &Selection,
    gids: &[u16],
) -> Result<String, Error> {
    let sample = sample_glyphs(pair.original(), selection, gids, PANGRAM)?;
    let sizes = sizes_to_show(&args.ppem, |ppem| PAGE_SIZES.contains(&ppem));
    let advance = |gid: u16, ppem: u16| pair.font().advance(gid.into(), ppem.into());
    let text = SampleText { gids: &sample, sizes: &sizes, advance: &advance };
    let (characters, units_per_em) = (pair.characters(gids)?, pair.teacher().units_per_em());
    let font = TextFont {
        characters: &characters,
        units_per_em,
        sizes: args.ppem.sizes(),
        first_text: &sample_characters(selection, &characters, PANGRAM),
        advance: &|gid| advance(gid, units_per_em),
    };
    pair.with_sources(gids, |sources| html::page(report, sources, &text, &font))
}

/// The page's file, with its directory made.
fn page_in(directory: &Path) -> Result<Output, Failure> {
    fs::create_dir_all(directory).map_err(|e| {
        Failure::failed(format!(
            "cannot make the directory {} ({e}); choose a place that you may write to",
            directory.display()
        ))
    })?;
    Output::new(&directory.join("index.html"))
}

/// Those of the usual sizes that were compared, or else the first ones.
fn sizes_to_show(ppem: &PpemList, usual: impl Fn(u16) -> bool) -> Vec<u16> {
    let sizes: Vec<u16> = ppem.sizes().iter().copied().filter(|&size| usual(size)).collect();
    if sizes.is_empty() { ppem.sizes().iter().copied().take(FALLBACK_SIZES).collect() } else { sizes }
}

/// The picture of `--png`.
fn draw(
    args: &Args,
    pair: &FontPair<'_>,
    report: &Report,
    sources: Sources<'_>,
    text: &[u16],
) -> Result<Vec<u8>, Error> {
    let few = args.ppem.sizes().len() <= PICTURE_SIZES.len();
    let mut rows = Vec::new();
    for ppem in sizes_to_show(&args.ppem, |size| few || PICTURE_SIZES.contains(&size)) {
        let line = |source: &dyn BitmapSource| {
            text_line(source.at(ppem)?.as_mut(), text, |gid| pair.font().advance(gid.into(), ppem.into()))
        };
        let bitmaps = vec![line(sources.neural)?, line(sources.truth)?, line(sources.unhinted)?];
        rows.push(SheetRow { label: ppem.to_string(), bitmaps });
    }
    let heading = |name: &str, mae: f64| format!("{name} - mae {mae:.4}");
    let totals = &report.totals;
    let headings = [
        heading("neural", totals.neural.figures.mae),
        if pair.teacher().hinter() == Hinter::Auto { "autohinted" } else { "hinted" }.to_owned(),
        heading("unhinted", totals.unhinted.figures.mae),
    ];
    let font = LabelFont::new(pair.original())?;
    png(&sheet(&font, &headings.each_ref().map(String::as_str), &rows, args.zoom)?)
}
