//! `nfr bake`: bitmaps at some sizes, for software that can load nothing else.

mod atlas;
mod bdf;
mod draw;
mod face;
mod lvgl;
mod output;
mod sfnt;
mod strike;
mod strikes;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use nfr::{MissingModel, Target};

use self::draw::{check_models, draw, size_warning};
use self::face::Face;
use self::output::{Format, Job, baked};
use super::args::SelectionArgs;
use super::failure::Failure;
use super::files::{Output, modelled, open_neural, read, same_file};
use super::progress::print_line;
use nfr_convert::ppem::PpemList;

/// Writes glyphs as bitmaps, for software that can load nothing else
///
/// Coverages are rounded to the nearest level that the bits allow. Where a format has one size a file and several are given, each file has
/// its size in its name: OUT sans.bdf becomes sans_12.bdf and sans_16.bdf.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The neural font
    font: PathBuf,
    /// The file to write
    output: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// Sizes in pixels per em, as in 12, 8-64, 8-64:2 or 9,12,16-20
    #[arg(long, value_name = "SIZES")]
    ppem: PpemList,
    /// ttf: strikes in the font (EBLC, EBDT); bdf; lvgl: C for LVGL 9; png: an atlas with JSON beside it. By default what OUT ends in: .ttf,
    /// .otb, .bdf, .c or .png
    #[arg(long, value_name = "FORMAT", value_parser = Format::from_name)]
    format: Option<Format>,
    /// Bits a pixel: 1, 2, 4 or 8. By default 8 for ttf and png, 4 for lvgl, 1 for bdf
    #[arg(long, value_name = "N", value_parser = bits)]
    bits: Option<u8>,
    /// What is drawn for a selected glyph without a model: error, blank or outline, which is unhinted
    #[arg(long, value_name = "WHAT", default_value = "error", value_parser = missing)]
    missing: MissingModel,
    /// With ttf: leave out outlines and models, which makes an OpenType bitmap font, as if OUT ended in .otb
    #[arg(long)]
    strikes_only: bool,
}

fn bits(text: &str) -> Result<u8, String> {
    text.parse()
        .ok()
        .filter(|bits| [1, 2, 4, 8].contains(bits))
        .ok_or_else(|| "use 1, 2, 4 or 8 bits a pixel".into())
}

fn missing(text: &str) -> Result<MissingModel, String> {
    match text {
        "error" => Ok(MissingModel::Error),
        "blank" => Ok(MissingModel::Blank),
        "outline" => Ok(MissingModel::Outline),
        _ => Err("use error, blank or outline".into()),
    }
}

/// Runs `nfr bake`. All files are made before the first is written.
///
/// # Errors
///
/// Wrong usage, a font without models, a glyph without one, what a format cannot hold, or a place that cannot be written.
pub fn run(args: &Args) -> Result<(), Failure> {
    let format = match args.format {
        Some(format) => format,
        None => Format::of_path(&args.output)?,
    };
    if args.strikes_only && format != Format::Ttf {
        return Err(Failure::usage(
            "--strikes-only is about fonts; use it with --format ttf, or leave it out",
        ));
    }
    let strikes_only = args.strikes_only || format == Format::Ttf && has_extension(&args.output, "otb");
    let bits = args.bits.unwrap_or(format.default_bits());
    let data = read(&args.font)?;
    let (file, font) = open_neural(&args.font, &data)?;
    let gids = args.selection.resolve(&file, modelled(&font)?, print_line)?;
    if gids.is_empty() {
        return Err(Failure::failed(format!(
            "{}: no glyph has a model; select glyphs, with --missing outline",
            args.font.display()
        )));
    }
    let face = Face::new(&file, &font, &args.selection.selection()?, gids)?;
    if args.missing == MissingModel::Error {
        check_models(&font, &face)?;
    }
    let sizes = args.ppem.sizes();
    let thresholded = (bits == 1 && font.target() != Target::Mono).then(|| {
        format!(
            "warning: the models' target is {}, and 1 bit leaves black or white; convert with --target mono for it",
            font.target()
        )
    });
    size_warning(&font, sizes).into_iter().chain(thresholded).for_each(|warning| print_line(&warning));
    let strikes: Vec<_> =
        sizes.iter().map(|ppem| draw(&font, &face, *ppem, bits, args.missing)).collect::<Result<_, _>>()?;
    let job =
        Job { format, file: &file, font_bytes: data.len(), face: &face, strikes: &strikes, strikes_only };
    let files = baked(&job, &args.output, print_line)?;
    if files.iter().any(|made| same_file(&made.path, &args.font)) {
        return Err(Failure::usage("the output is the input; write to another file"));
    }
    let outputs = files.iter().map(|made| Output::new(&made.path)).collect::<Result<Vec<_>, _>>()?;
    for (made, output) in files.iter().zip(outputs) {
        output.write(&made.bytes)?;
        writeln!(io::stdout().lock(), "{}: {}", made.path.display(), made.summary)?;
    }
    Ok(())
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}
