//! Draws, compares, verifies, describes, subsets, bakes and times neural fonts.

use std::process::ExitCode;

use clap::Parser;
use nfr_tools as cli;

fn main() -> ExitCode {
    cli::interrupt::watch();
    cli::finish(cli::program::run(&cli::program::Args::parse()))
}
