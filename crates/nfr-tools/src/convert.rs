//! `nfr-convert`: from a hinted font to a neural one.

mod arguments;
mod dry_run;
mod face;
mod faces;
mod into;
mod kept;
mod prepare;
mod summary;

use std::io::{self, Write};

use super::failure::Failure;
use super::files::Output;

pub use arguments::Args;

/// Runs `nfr-convert`.
///
/// # Errors
///
/// Wrong usage, an input that cannot teach, an output that cannot be written. An existing output is then as
/// it was.
pub fn run(args: &Args) -> Result<(), Failure> {
    if args.all_faces {
        return faces::convert_all(args);
    }
    args.check_paths(&args.output)?;
    let source = args.source.load(&args.input)?;
    let report = args.report.as_deref().map(Output::new).transpose()?;
    let Some(converted) = face::convert(args, &source, &args.output)? else { return Ok(()) };
    if let Some(file) = report {
        file.write(converted.report.as_bytes())?;
    }
    if !args.quiet {
        io::stdout().write_all(converted.summary.as_bytes())?;
    }
    Ok(())
}
