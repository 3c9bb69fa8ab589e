//! Converts hinted fonts to neural ones.

use std::process::ExitCode;

use clap::Parser;
use nfr_tools as cli;

fn main() -> ExitCode {
    cli::interrupt::watch();
    cli::finish(cli::convert::run(&cli::convert::Args::parse()))
}
