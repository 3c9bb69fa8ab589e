//! Errors of converting and comparing. Their texts say what to do.

use std::fmt;

use nfr::internals::Damage;

/// An error of this crate. Its text says what is wrong, where, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The input's bytes contradict their own format.
    Malformed(String),
    /// The input is well-formed, but of a kind that is not handled here.
    Unsupported(String),
    /// The input asks for more memory or work than the limits allow.
    LimitExceeded(String),
    /// The font has no glyph of this number.
    NoSuchGlyph(u32),
    /// The font has no model for this glyph.
    MissingGlyph(u16),
    /// A glyph needs a field, which is trained, and this build lacks the feature `train`.
    TrainingNotBuilt {
        /// The glyph.
        gid: u16,
        /// Whether it needs a field because outlines are dropped; otherwise fields are asked for.
        outlines_dropped: bool,
    },
    /// A parameter that the caller passed does not make sense.
    InvalidParameter(String),
    /// Reading or writing a file failed.
    Io(String),
    /// The time that was given is over, and the work is not done.
    TimeLimit,
    /// The device that networks are trained on is missing, or failed.
    Device(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed(what) => write!(f, "malformed font: {what}"),
            Self::Unsupported(what) => write!(f, "unsupported: {what}"),
            Self::LimitExceeded(what) => write!(f, "limit exceeded: {what}"),
            Self::NoSuchGlyph(gid) => write!(f, "the font has no glyph {gid}; leave it out of the selection"),
            Self::MissingGlyph(gid) => {
                write!(f, "glyph {gid} has no model in this font; convert the font with it selected")
            }
            Self::TrainingNotBuilt { gid, outlines_dropped } => {
                let (reason, otherwise) = match outlines_dropped {
                    true => ("its outline is to be dropped", "keep the outlines (no --drop-outlines)"),
                    false => {
                        ("the shape asked for is 'field'", "learn the hints of its outline (--shape outline)")
                    }
                };
                write!(
                    f,
                    "glyph {gid} needs a trained field, as {reason}, and this program is built without training; \
                     build it with `cargo build --release --bins --features train`, or {otherwise}"
                )
            }
            Self::InvalidParameter(what) => write!(f, "invalid parameter: {what}"),
            Self::TimeLimit => write!(f, "the time limit is reached; go on with --resume"),
            Self::Io(what) | Self::Device(what) => write!(f, "{what}"),
        }
    }
}

impl std::error::Error for Error {}

impl Error {
    /// Adds the glyph and the size to an error that knows only an outline.
    pub(crate) fn of_glyph(self, gid: u16, ppem: u16) -> Self {
        match self {
            Self::Malformed(what) => Self::Malformed(format!("glyph {gid} at {ppem} ppem: {what}")),
            Self::LimitExceeded(what) => Self::LimitExceeded(format!("glyph {gid} at {ppem} ppem: {what}")),
            other => other,
        }
    }

    /// Whether the same conversion may succeed another time: it lacked time, room or a device.
    pub fn may_pass(&self) -> bool {
        matches!(self, Self::TimeLimit | Self::Io(_) | Self::Device(_))
    }
}

impl From<nfr::Error> for Error {
    fn from(error: nfr::Error) -> Self {
        use nfr::Error as Cause;
        let again = || format!("{error}; convert the font again");
        match error {
            Cause::NotAFont => Self::Malformed(
                "these bytes are no OpenType font; pass a .ttf file or a collection of them".into(),
            ),
            Cause::NoSuchFont { count, .. } if count <= 1 => {
                Self::InvalidParameter(format!("{error}; use index 0"))
            }
            Cause::NoSuchFont { count, .. } => {
                Self::InvalidParameter(format!("{error}; use 0–{}", count.saturating_sub(1)))
            }
            Cause::MissingTable { .. } | Cause::MalformedTable { .. } => {
                Self::Malformed(format!("{error}; get the file again"))
            }
            Cause::UnitsPerEm(_) => Self::Malformed(format!("{error}; repair the font")),
            Cause::NotConverted => Self::Unsupported(format!("{error}; make one with nfr-convert")),
            Cause::UnknownVersion { .. } => Self::Unsupported(again()),
            Cause::Renumbered { .. } => Self::InvalidParameter(format!(
                "{error}; make the subset with nfr's module for fontTools (python/), or that of the original font, and convert it"
            )),
            Cause::StaleModel(_) => Self::InvalidParameter(again()),
            Cause::MalformedModels { .. } | Cause::MalformedModel { .. } => Self::Malformed(again()),
            Cause::ModelTooLarge { .. } => Self::LimitExceeded(again()),
            Cause::BitmapTooLarge { .. } | Cause::DecodedTooLarge { .. } | Cause::TooMuchWork { .. } => {
                Self::LimitExceeded(error.to_string())
            }
            Cause::NoSuchGlyph(glyph) => Self::NoSuchGlyph(glyph),
            Cause::MissingModel(glyph) => match u16::try_from(glyph) {
                Ok(glyph) => Self::MissingGlyph(glyph),
                Err(_) => Self::InvalidParameter(error.to_string()),
            },
            Cause::FieldsNotBuilt(_)
            | Cause::NetworksNotBuilt(_)
            | Cause::NetworkSize { .. }
            | Cause::NetworkOffset { .. }
            | Cause::NetworkSubpixels(_) => Self::Unsupported(error.to_string()),
            Cause::InvalidSize(_) | Cause::InvalidOffset(_) | Cause::BufferTooSmall { .. } => {
                Self::InvalidParameter(error.to_string())
            }
            _ => Self::Malformed(error.to_string()),
        }
    }
}

impl From<Damage> for Error {
    fn from(damage: Damage) -> Self {
        match damage {
            Damage::Malformed(what) => Self::Malformed(format!("a model {what}")),
            Damage::Stale => Self::InvalidParameter("a model belongs to another outline".into()),
            Damage::TooLarge { what, count, limit } => {
                Self::LimitExceeded(format!("a model has {count} {what}, {limit} are allowed"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_glyph_that_is_not_in_the_font_is_not_said_to_lack_a_model() {
        let error = Error::from(nfr::Error::NoSuchGlyph(70_000));
        assert_eq!(error, Error::NoSuchGlyph(70_000));
        assert_eq!(error.to_string(), "the font has no glyph 70000; leave it out of the selection");
        let error = Error::from(nfr::Error::MissingModel(36));
        assert_eq!(error, Error::MissingGlyph(36));
        assert!(error.to_string().contains("convert the font with it selected"));
    }
}
