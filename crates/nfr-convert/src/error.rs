//! What can go wrong in converting and comparing, with what to do about it.

use std::fmt;

/// A failure of this crate. Each variant says who is at fault; its text says what was wrong, where, and
/// what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The input's bytes contradict their own format.
    Malformed(String),
    /// The input is well-formed, but of a kind that is not handled here.
    Unsupported(String),
    /// The input asks for more memory or work than the limits allow.
    LimitExceeded(String),
    /// The font has no model for this glyph.
    MissingGlyph(u16),
    /// A parameter that the caller passed does not make sense.
    InvalidParameter(String),
    /// Reading or writing a file failed.
    Io(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed(what) => write!(f, "malformed font: {what}"),
            Self::Unsupported(what) => write!(f, "unsupported: {what}"),
            Self::LimitExceeded(what) => write!(f, "limit exceeded: {what}"),
            Self::MissingGlyph(gid) => {
                write!(f, "glyph {gid} has no model in this font; convert the font with it selected")
            }
            Self::InvalidParameter(what) => write!(f, "invalid parameter: {what}"),
            Self::Io(what) => write!(f, "{what}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<nfr::Error> for Error {
    fn from(error: nfr::Error) -> Self {
        match error {
            nfr::Error::Malformed(what) => Self::Malformed(what),
            nfr::Error::Unsupported(what) => Self::Unsupported(what),
            nfr::Error::LimitExceeded(what) => Self::LimitExceeded(what),
            nfr::Error::MissingGlyph(gid) => Self::MissingGlyph(gid),
            nfr::Error::InvalidParameter(what) => Self::InvalidParameter(what),
            other => Self::Malformed(other.to_string()),
        }
    }
}
