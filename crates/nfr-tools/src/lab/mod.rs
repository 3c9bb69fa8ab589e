//! `nfr lab`: the models and experiments of the paper "Neural Font Rendering".

mod device;
mod family;
mod options;
mod report;
mod store;
mod train;
mod truth;

use clap::Subcommand;

use super::failure::Failure;

/// The models and experiments of the paper "Neural Font Rendering" (Anderson, Shamir, Fried)
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Truth(truth::Args),
    Implicit(train::ImplicitArgs),
    Masked(train::MaskedArgs),
    GridFit(train::GridFitArgs),
    Store(store::Args),
    Weights(family::WeightsArgs),
    Styles(family::StylesArgs),
    Device(device::Args),
    Report(report::Args),
}

/// Runs `nfr lab`.
///
/// # Errors
///
/// A font that cannot be read or teaches nothing, a training with other settings in the same place, or a place that
/// cannot be written.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::Truth(args) => truth::run(args),
        Command::Implicit(args) => train::implicit(args),
        Command::Masked(args) => train::masked(args),
        Command::GridFit(args) => train::grid_fit(args),
        Command::Store(args) => store::run(args),
        Command::Weights(args) => family::weights(args),
        Command::Styles(args) => family::styles(args),
        Command::Device(args) => device::run(args),
        Command::Report(args) => report::run(args),
    }
}
