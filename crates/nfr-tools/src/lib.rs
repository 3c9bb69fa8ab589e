//! The command-line tools as functions; the binaries only parse their arguments.
//!
//! Exit codes: 0 done, 1 failed or a threshold missed, 2 wrong usage, 130 interrupted; `nfr verify` exits with 1 for a difference only, and with 2 for
//! every error. Results go to stdout, progress and messages to stderr.

#![forbid(unsafe_code)]

pub mod bake;
#[cfg(feature = "bench")]
pub mod bench;
pub mod convert;
pub mod diff;
pub mod info;
pub mod interrupt;
#[cfg(feature = "lab")]
pub mod lab;
pub mod program;
pub mod render;
pub mod shell;
pub mod subset;
pub mod verify;

mod args;
mod exactness;
mod failure;
mod files;
mod help;
mod pace;
mod progress;
mod source;
#[cfg(not(all(feature = "bench", feature = "lab")))]
mod unbuilt;

pub use args::{SelectionArgs, hinter, shape, target};
pub use failure::{Failure, finish};
#[cfg(not(feature = "bench"))]
pub use unbuilt::bench;
#[cfg(not(feature = "lab"))]
pub use unbuilt::lab;
