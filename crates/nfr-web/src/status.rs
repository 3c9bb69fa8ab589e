//! What a call came to. The numbers are those of `nfr.h`; `web/check` compares the script's with them.

use nfr::Error;

/// Done.
pub(crate) const OK: u32 = 0;
/// A number is none of those that the argument may have.
pub(crate) const INVALID_ARGUMENT: u32 = 2;

/// The status for an error of the library.
pub(crate) fn of(error: &Error) -> u32 {
    match error {
        Error::NotAFont => 3,
        Error::NoSuchFont { .. } => 4,
        Error::MissingTable { .. }
        | Error::MalformedTable { .. }
        | Error::UnitsPerEm(_)
        | Error::MalformedModels { .. } => 5,
        Error::NotConverted => 6,
        Error::UnknownVersion { .. } => 7,
        Error::Renumbered { .. } | Error::StaleModel(_) => 8,
        Error::MalformedModel { .. } | Error::ModelTooLarge { .. } | Error::MalformedOutline(_) => 9,
        Error::NoSuchGlyph(_) => 10,
        Error::MissingModel(_) => 11,
        Error::InvalidSize(_) => 12,
        Error::InvalidOffset(_) => 13,
        Error::BufferTooSmall { .. } => 14,
        Error::BitmapTooLarge { .. } | Error::DecodedTooLarge { .. } | Error::TooMuchWork { .. } => 15,
        Error::FieldsNotBuilt(_)
        | Error::NetworksNotBuilt(_)
        | Error::NetworkSize { .. }
        | Error::NetworkOffset { .. }
        | Error::NetworkSubpixels(_) => 16,
        // A variant that was added to the library and not here.
        _ => 17,
    }
}
