//! `nfr render`: bitmaps from the models, as JSON lines for scripts or as a sheet for people.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use super::args::SelectionArgs;
use super::failure::Failure;
use super::files::{Output, modelled, open_neural, read};
use super::progress::print_line;
use nfr::Font;
use nfr_convert::compare::picture::{LabelFont, SheetRow, png, sheet, specimen, text_line};
use nfr_convert::compare::source::{BitmapSource, Neural};
use nfr_convert::ppem::PpemList;

/// A sheet's lines break at about this width, in pixels of the picture.
const SHEET_WIDTH: u32 = 1600;

/// Draws glyphs from their models
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The neural font
    font: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Sizes in pixels per em, as in 12, 8-64, 8-64:2 or 9,12,16-20
    #[arg(long, value_name = "SIZES", default_value = "8-64")]
    ppem: PpemList,
    /// Print one JSON object a line for each glyph and size: gid, ppem, left, top, width, height, advance,
    /// hinted_advance, hinted_side_bearing, and the coverage in base64
    #[arg(long)]
    json: bool,
    /// Draw a sheet: the text in a line for each size, or else the glyphs in order
    #[arg(long, value_name = "FILE")]
    png: Option<PathBuf>,
    /// Enlarge the sheet's pixels so many times
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    zoom: u32,
}

/// One glyph at one size, as printed.
#[derive(Debug, Serialize)]
struct RenderedGlyph {
    gid: u16,
    ppem: u16,
    left: i32,
    top: i32,
    width: u32,
    height: u32,
    advance: f32,
    hinted_advance: f32,
    hinted_side_bearing: f32,
    pixels: String,
}

/// Runs `nfr render`.
///
/// # Errors
///
/// Wrong usage, a font without models, a glyph without one, or a place that cannot be written.
pub fn run(args: &Args) -> Result<(), Failure> {
    if !args.json && args.png.is_none() {
        return Err(Failure::usage("nothing to write; add --json for pixels or --png FILE for a picture"));
    }
    let data = read(&args.font)?;
    let (file, font) = open_neural(&args.font, &data)?;
    let selection = args.selection.selection()?;
    let gids = args.selection.resolve(&file, modelled(&font)?, print_line)?;
    let source = Neural::new(&font, &gids)?;
    if let Some(path) = &args.png {
        let text = selection.text.is_some().then(|| selection.text_glyphs(&file)).transpose()?;
        let labels = LabelFont::neural(&file, &font)?;
        draw_sheet(args, path, &labels, &font, &source, &gids, text.as_deref())?;
    }
    if args.json {
        print_lines(args, &font, &source, &gids)?;
    }
    Ok(())
}

fn print_lines(args: &Args, font: &Font, source: &Neural, gids: &[u16]) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    let mut rasterizer = nfr::Rasterizer::new(font);
    for &gid in gids {
        for &ppem in args.ppem.sizes() {
            let bitmap = source.at(ppem)?.bitmap(gid)?;
            let place = bitmap.placement;
            let line = RenderedGlyph {
                gid,
                ppem,
                left: place.left,
                top: place.top,
                width: place.width,
                height: place.height,
                advance: font.advance(gid.into(), ppem.into()),
                hinted_advance: rasterizer.hinted_advance(gid.into(), ppem.into())?,
                hinted_side_bearing: rasterizer.hinted_side_bearing(gid.into(), ppem.into())?,
                pixels: STANDARD.encode(&bitmap.pixels),
            };
            serde_json::to_writer(&mut out, &line).map_err(io::Error::from)?;
            out.write_all(b"\n")?;
        }
    }
    Ok(out.flush()?)
}

fn draw_sheet(
    args: &Args,
    path: &Path,
    labels: &LabelFont,
    font: &Font,
    source: &Neural,
    gids: &[u16],
    text: Option<&[u16]>,
) -> Result<(), Failure> {
    let output = Output::new(path)?;
    let mut rows = Vec::new();
    for &ppem in args.ppem.sizes() {
        let mut at = source.at(ppem)?;
        let advance = |gid: u16| font.advance(gid.into(), ppem.into());
        let lines = match text {
            Some(text) => vec![text_line(at.as_mut(), text, advance)?],
            None => specimen(at.as_mut(), gids, advance, (SHEET_WIDTH / args.zoom).into())?,
        };
        let row_labels = std::iter::once(ppem.to_string()).chain(std::iter::repeat(String::new()));
        rows.extend(
            lines.into_iter().zip(row_labels).map(|(line, label)| SheetRow { label, bitmaps: vec![line] }),
        );
    }
    output.write(&png(&sheet(labels, &[], &rows, args.zoom)?)?)
}
