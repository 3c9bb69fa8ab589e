//! How a tool ends.

use std::io::{self, Write};
use std::process::ExitCode;

use nfr_convert::error::Error;

const FAILED: u8 = 1;
const WRONG_USAGE: u8 = 2;

/// Why a tool did not do what it was asked: a line for stderr and an exit code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    code: u8,
    /// Empty where there is nobody to tell.
    message: String,
}

impl Failure {
    /// Something did not work: exit code 1.
    pub fn failed(message: impl Into<String>) -> Self {
        Self { code: FAILED, message: message.into() }
    }

    /// The arguments make no sense: exit code 2.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { code: WRONG_USAGE, message: message.into() }
    }

    /// Adds where it happened.
    pub(super) fn at(self, place: impl std::fmt::Display) -> Self {
        Self { message: format!("{place}: {}", self.message), ..self }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            // The parameter is one that the person gave, and the text names it.
            Error::InvalidParameter(what) => Self::failed(what),
            other => Self::failed(other.to_string()),
        }
    }
}

impl From<nfr::Error> for Failure {
    fn from(error: nfr::Error) -> Self {
        Error::from(error).into()
    }
}

/// A failure to write to stdout.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            // Whoever read the output has seen enough, as `head` has.
            io::ErrorKind::BrokenPipe => Self::failed(""),
            _ => Self::failed(format!("cannot write to stdout ({error})")),
        }
    }
}

/// Prints the failure, if any, and gives the process's exit code.
pub fn finish(result: Result<(), Failure>) -> ExitCode {
    let Err(failure) = result else { return ExitCode::SUCCESS };
    if !failure.message.is_empty() {
        // Nothing is left to do where stderr is closed too.
        let _ = writeln!(io::stderr(), "error: {}", failure.message);
    }
    ExitCode::from(failure.code)
}
