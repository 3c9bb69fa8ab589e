//! The arguments of `nfr-convert`.

use std::path::{Path, PathBuf};

use clap::Parser;

use crate::args::{SelectionArgs, all_cores, hinter, jobs, shape, target};
use crate::failure::Failure;
use crate::files::same_file;
use crate::help::help_template;
use crate::source::SourceArgs;
use nfr::Target;
use nfr_convert::closure::LayoutFeatures;
use nfr_convert::compare::threshold::FailOn;
use nfr_convert::options::Backend;
use nfr_convert::ppem::PpemList;
use nfr_convert::{Hinter, Options, Quality, Shape};

/// Learns a font's hinted bitmaps, glyph by glyph, and writes a font that carries the models instead of hint
/// programs
#[derive(Debug, Parser)]
#[command(name = "nfr-convert", version, help_template = help_template!(
    "nfr-convert in.ttf out.ttf --unicodes U+20-7E",
    "nfr-convert in.ttf sizes.ttf --text 'Hello, world' --ppem 10-20 --report report.json"
))]
pub struct Args {
    /// A hinted font with TrueType or PostScript outlines; or one without hints, with --hinter auto. Collections and web fonts (WOFF, WOFF2) are read, too
    pub(super) input: PathBuf,
    /// The neural font to write, or the directory of --all-faces
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) selection: SelectionArgs,
    /// The features of GSUB whose glyphs are converted with those that they stand for: tags, as in default,smcp,onum, or * or none
    ///
    /// "default" are those that pyftsubset keeps by default: what shapers apply without being asked, and a few more.
    #[arg(long, value_name = "LIST", default_value = "default")]
    pub(super) layout_features: LayoutFeatures,
    /// Convert only the glyphs that are named, without what layout and composites need, .notdef and the space
    #[arg(long)]
    pub(super) no_closure: bool,
    /// The sizes to learn, in pixels per em: a range, which may have a step, as in 8-64:2 [default: 8-64, or those of --into]
    ///
    /// With --train-ppem, the sizes that the figures are about.
    #[arg(long, value_name = "SIZES")]
    pub(super) ppem: Option<PpemList>,
    /// Learn these sizes instead of those of --ppem; what hinting does at the sizes between is predicted from
    /// them
    #[arg(long, value_name = "SIZES")]
    pub(super) train_ppem: Option<PpemList>,
    /// What to hint for: smooth, mono or lcd [default: smooth, or that of --into]
    #[arg(long, value_name = "TARGET", value_parser = target)]
    pub(super) target: Option<Target>,
    /// Whose hints to learn: those of the font, or those that skrifa's autohinter finds, which is FreeType's [default: font, or that
    /// of --into]
    #[arg(long, value_name = "HINTER", value_parser = hinter)]
    pub(super) hinter: Option<Hinter>,
    /// Where models have their shapes from: outline (the font's own), field (their own), or auto, which is outline unless the
    /// outlines are dropped; fields need a build with --features train
    #[arg(long, value_name = "SHAPE", default_value = "auto", value_parser = shape)]
    pub(super) shape: Shape,
    /// How much error is worth how many bytes: 0 for the smallest file, 100 for the least error
    ///
    /// With outlines, 100 is exact: every point is where the hints put it. A warning says for which glyphs and sizes it is not, and
    /// nfr verify tells more.
    #[arg(long, value_name = "0-100", default_value = "50", value_parser = quality)]
    pub(super) quality: Quality,
    /// The seed of whatever is drawn at random; the same seed gives the same font
    #[arg(long, value_name = "N", default_value_t = Options::default().seed)]
    pub(super) seed: u64,
    /// Threads; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = all_cores(), value_parser = jobs)]
    pub(super) jobs: usize,
    /// burn's backend for training fields: flex, or ndarray where that is built in
    #[arg(long, value_name = "NAME", default_value = "flex", value_parser = backend)]
    pub(super) backend: Backend,
    #[command(flatten)]
    pub(super) source: SourceArgs,
    /// Convert all fonts of a collection; OUTPUT is a directory then, and each font is written to a file of its PostScript name in it
    ///
    /// A font that cannot be converted does not keep the others from it; the exit code is 1 then. The report is a list.
    #[arg(long, conflicts_with_all = ["index", "into"])]
    pub(super) all_faces: bool,
    /// Leave out the outlines of the glyphs that get models, for programs that draw only with those
    ///
    /// Metrics, characters and layout stay. Everything else draws these glyphs as blanks. Their models are fields.
    #[arg(long)]
    pub(super) drop_outlines: bool,
    /// Add what is missing to the models of a neural font that was made from the same input
    ///
    /// The output has all of its models, byte for byte what they draw, and those of the selected glyphs that it lacks. The sizes and the
    /// target are its own. The output may be this font itself.
    #[arg(long, value_name = "NEURAL")]
    pub(super) into: Option<PathBuf>,
    /// Go on where an interrupted conversion to the same output stopped
    ///
    /// While it runs, a conversion keeps the glyphs that are ready in OUTPUT.partial. If it is interrupted, the
    /// same command with --resume trains only the others, and the font comes out the same. The input, the options
    /// and the version have to be the same, but --jobs and --drop-outlines may change. The file is deleted in the
    /// end.
    #[arg(long)]
    pub(super) resume: bool,
    /// Write nothing, and tell how long the conversion will take and how large the font will be
    ///
    /// A sample of the glyphs is converted and compared, with these options, and the rest is estimated from it.
    #[arg(long, conflicts_with = "all_faces")]
    pub(super) dry_run: bool,
    /// Write no font, and exit with 1, if any condition holds, as in 'mae>0.0001 || bad16>0.001'
    ///
    /// As for nfr diff, on the figures of all glyphs at the sizes of --ppem.
    #[arg(long, value_name = "EXPR")]
    pub(super) fail_on: Option<FailOn>,
    /// Write a report as JSON
    #[arg(long, value_name = "FILE")]
    pub(super) report: Option<PathBuf>,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "verbose")]
    pub(super) quiet: bool,
    /// Print a line for each glyph
    #[arg(long, short)]
    pub(super) verbose: bool,
}

fn backend(name: &str) -> Result<Backend, String> {
    match name {
        "flex" => Ok(Backend::Flex),
        #[cfg(feature = "ndarray")]
        "ndarray" => Ok(Backend::Ndarray),
        #[cfg(not(feature = "ndarray"))]
        "ndarray" => Err("this program is built without it; build it with --features ndarray".into()),
        _ => Err("use flex or ndarray".into()),
    }
}

fn quality(text: &str) -> Result<Quality, String> {
    text.parse().ok().and_then(Quality::new).ok_or_else(|| "write a number from 0 to 100".into())
}

impl Args {
    /// Refuses to write over what is read.
    pub(super) fn check_paths(&self, output: &Path) -> Result<(), Failure> {
        let refuse_same = |a: &Path, b: &Path, what: &str| {
            if same_file(a, b) {
                Err(Failure::usage(format!("{what}; write to another file")))
            } else {
                Ok(())
            }
        };
        refuse_same(&self.input, output, "the output is the input")?;
        if let Some(report) = &self.report {
            refuse_same(&self.input, report, "the report is the input")?;
            refuse_same(output, report, "the report is the output")?;
        }
        Ok(())
    }
}
