//! Stand-ins for the commands of `nfr` whose features this build lacks: whatever the arguments, they say how to build the command.

use std::ffi::OsString;

use super::failure::Failure;

/// Not in this build; calling it tells how to build it
#[derive(Debug, clap::Args)]
#[command(disable_help_flag = true)]
pub struct Args {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

fn refuse(command: &str) -> Result<(), Failure> {
    Err(Failure::usage(format!(
        "this program is built without `nfr {command}`; build it with `cargo build --release --bins --features {command}`"
    )))
}

/// In place of `nfr bench`.
#[cfg(not(feature = "bench"))]
pub mod bench {
    pub use super::Args;
    use crate::failure::Failure;

    /// Refuses to run.
    ///
    /// # Errors
    ///
    /// Wrong usage, always.
    pub fn run(_: &Args) -> Result<(), Failure> {
        super::refuse("bench")
    }
}

/// In place of `nfr lab`.
#[cfg(not(feature = "lab"))]
pub mod lab {
    pub use super::Args;
    use crate::failure::Failure;

    /// Refuses to run.
    ///
    /// # Errors
    ///
    /// Wrong usage, always.
    pub fn run(_: &Args) -> Result<(), Failure> {
        super::refuse("lab")
    }
}
