//! Draws, compares, verifies, describes, subsets, bakes and times neural fonts.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use nfr_tools as cli;

/// Draws, compares, verifies, describes, subsets, bakes and times neural fonts
#[derive(Debug, Parser)]
#[command(name = "nfr", version)]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(cli::render::Args),
    Diff(cli::diff::Args),
    Verify(cli::verify::Args),
    Info(cli::info::Args),
    Subset(cli::subset::Args),
    Bake(cli::bake::Args),
    Bench(cli::bench::Args),
    Lab(cli::lab::Args),
}

fn main() -> ExitCode {
    cli::finish(match Args::parse().command {
        Command::Render(args) => cli::render::run(&args),
        Command::Diff(args) => cli::diff::run(&args),
        Command::Verify(args) => cli::verify::run(&args),
        Command::Info(args) => cli::info::run(&args),
        Command::Subset(args) => cli::subset::run(&args),
        Command::Bake(args) => cli::bake::run(&args),
        Command::Bench(args) => cli::bench::run(&args),
        Command::Lab(args) => cli::lab::run(&args),
    })
}
