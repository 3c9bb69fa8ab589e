//! Failures of tools, and exit codes.

use std::io::{self, Write};
use std::process::ExitCode;

use nfr_convert::error::Error;

const FAILED: u8 = 1;
const WRONG_USAGE: u8 = 2;

/// A failure: a line for stderr and an exit code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    code: u8,
    /// Empty for a closed pipe, which nobody reads.
    message: String,
}

impl Failure {
    /// A failure with exit code 1.
    pub fn failed(message: impl Into<String>) -> Self {
        Self { code: FAILED, message: message.into() }
    }

    /// Wrong usage: exit code 2.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { code: WRONG_USAGE, message: message.into() }
    }

    /// The same failure with exit code 2, for a tool whose exit code 1 says that it has compared and found a difference.
    pub(super) fn with_code_of_errors(self) -> Self {
        Self { code: WRONG_USAGE, ..self }
    }

    /// Prepends the place, such as a file's name.
    pub(super) fn at(self, place: impl std::fmt::Display) -> Self {
        Self { message: format!("{place}: {}", self.message), ..self }
    }
}

/// The line without its beginning "error: ".
impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            // The parameter is one from the command line, and the text names it.
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
            // The reader of the output, such as `head`, has closed it.
            io::ErrorKind::BrokenPipe => Self::failed(""),
            _ => Self::failed(format!("cannot write to stdout ({error}); make room where it leads to")),
        }
    }
}

/// Prints the failure, if any, and gives the process's exit code.
pub fn finish(result: Result<(), Failure>) -> ExitCode {
    let Err(failure) = result else { return ExitCode::SUCCESS };
    if !failure.message.is_empty() {
        // A closed stderr leaves only the exit code.
        let _ = writeln!(io::stderr(), "error: {}", failure.message);
    }
    ExitCode::from(failure.code)
}
