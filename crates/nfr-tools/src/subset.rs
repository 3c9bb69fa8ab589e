//! `nfr subset`: some glyphs of a neural font.
//!
//! A subsetter has to rewrite layout, variations and colours along with the outlines. fontTools does that for most of the web's fonts, and
//! knows `Nfrt` through the module in `python/`, so it runs as a process; what is left is then encoded without what no glyph needs any
//! more.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::args::SelectionArgs;
use super::failure::Failure;
use super::files::{Output, modelled, open_neural, read, same_file};
use super::interrupt::delete_at_end;
use super::progress::print_line;
use nfr_convert::closure::LayoutFeatures;
use nfr_convert::combine::compact;

/// The module for fontTools: the package `nfr` without what is compiled.
const MODULE: [(&str, &str); 7] = [
    ("__init__.py", include_str!("../../../python/nfr/__init__.py")),
    ("coder.py", include_str!("../../../python/nfr/coder.py")),
    ("composed.py", include_str!("../../../python/nfr/composed.py")),
    ("errors.py", include_str!("../../../python/nfr/errors.py")),
    ("subset.py", include_str!("../../../python/nfr/subset.py")),
    ("table.py", include_str!("../../../python/nfr/table.py")),
    ("outline-priors.txt", include_str!("../../../spec/outline-priors.txt")),
];

/// Keeps some glyphs of a neural font, and their models with them
///
/// Glyphs are renumbered, as by pyftsubset, which does it: Python and fontTools have to be installed. What layout makes of the
/// selected glyphs is kept, too, and so are components, .notdef and its outline.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The neural font
    neural: PathBuf,
    /// The font to write
    output: PathBuf,
    #[command(flatten)]
    selection: SelectionArgs,
    /// The features that are kept: tags, as in default,smcp,onum, or * or none
    ///
    /// "default" are those that pyftsubset keeps by default.
    #[arg(long, value_name = "LIST", default_value = "default")]
    layout_features: LayoutFeatures,
    /// The Python that has fontTools
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    python: PathBuf,
}

/// Runs `nfr subset`.
///
/// # Errors
///
/// Wrong usage, a font without models, a missing Python or fontTools, an output that cannot be written. An existing output is then as it
/// was.
pub fn run(args: &Args) -> Result<(), Failure> {
    if same_file(&args.neural, &args.output) {
        return Err(Failure::usage("the output is the input; write to another file"));
    }
    if args.selection.is_empty() {
        return Err(Failure::usage("nothing is selected; give --text, --unicodes, --gids or --glyphs"));
    }
    let data = read(&args.neural)?;
    let (file, font) = open_neural(&args.neural, &data)?;
    let gids = args.selection.resolve(&file, modelled(&font)?, print_line)?;
    let output = Output::new(&args.output)?;
    let subset = pyftsubset(args, &gids)?;
    output.write(&compact(&subset)?)
}

/// The subset as pyftsubset writes it.
fn pyftsubset(args: &Args, gids: &[u16]) -> Result<Vec<u8>, Failure> {
    let failed =
        |e: std::io::Error| Failure::failed(format!("cannot write a temporary file ({e}); make room for it"));
    let directory = tempfile::tempdir().map_err(failed)?;
    delete_at_end(directory.path());
    let package = directory.path().join("nfr");
    std::fs::create_dir(&package).map_err(failed)?;
    for (name, content) in MODULE {
        std::fs::write(package.join(name), content).map_err(failed)?;
    }
    let subset = directory.path().join("subset.ttf");
    let gids: Vec<String> = gids.iter().map(u16::to_string).collect();
    let run = Command::new(&args.python)
        .env("PYTHONPATH", directory.path())
        .args(["-m", "nfr.subset"])
        .arg(std::path::absolute(&args.neural).unwrap_or_else(|_| args.neural.clone()))
        .args([
            format!("--gids={}", gids.join(",")),
            format!("--layout-features={}", args.layout_features),
            format!("--output-file={}", subset.display()),
        ])
        .args(["--notdef-outline", "--glyph-names"])
        .output();
    let run = run.map_err(|e| {
        Failure::failed(format!(
            "cannot run {} ({e}); install Python, and fontTools with it (pip install fonttools)",
            args.python.display()
        ))
    })?;
    if !run.status.success() {
        return Err(Failure::failed(told(&args.python, &String::from_utf8_lossy(&run.stderr))));
    }
    read(&subset)
}

/// What Python's last line says, and what to do about it.
fn told(python: &Path, errors: &str) -> String {
    let last = errors.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it says nothing");
    let advice = if last.contains("fontTools is not installed") {
        ", or name a Python that has it with --python"
    } else {
        ""
    };
    format!("pyftsubset fails under {}: {last}{advice}", python.display())
}
