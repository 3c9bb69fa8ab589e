//! The arguments of the program `nfr`.

use clap::{Parser, Subcommand};

use super::failure::Failure;
use super::help::help_template;

/// Draws, compares, verifies, describes, subsets, bakes and times neural fonts
#[derive(Debug, Parser)]
#[command(name = "nfr", version, help_template = help_template!(
    "nfr diff in.ttf out.ttf --ppem 9,12,16,24 --png out.png",
    "nfr render out.ttf --text Magic --ppem 12 --png magic.png"
))]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(super::render::Args),
    Diff(super::diff::Args),
    Verify(super::verify::Args),
    Info(super::info::Args),
    Subset(super::subset::Args),
    Bake(super::bake::Args),
    Bench(super::bench::Args),
    Lab(super::lab::Args),
    Completions(super::shell::CompletionsArgs),
    Man(super::shell::ManArgs),
}

/// Runs `nfr`.
///
/// # Errors
///
/// Those of the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::Render(args) => super::render::run(args),
        Command::Diff(args) => super::diff::run(args),
        Command::Verify(args) => super::verify::run(args),
        Command::Info(args) => super::info::run(args),
        Command::Subset(args) => super::subset::run(args),
        Command::Bake(args) => super::bake::run(args),
        Command::Bench(args) => super::bench::run(args),
        Command::Lab(args) => super::lab::run(args),
        Command::Completions(args) => super::shell::completions(args, command),
        Command::Man(args) => super::shell::man(args, command),
    }
}

/// The definition of the program's arguments.
fn command() -> clap::Command {
    <Args as clap::CommandFactory>::command()
}
