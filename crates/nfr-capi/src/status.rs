//! What a call comes to: a status, and a message for the last one that failed.

use std::any::Any;
use std::cell::UnsafeCell;
use std::ffi::c_char;
use std::panic::{AssertUnwindSafe, catch_unwind};

use nfr::Error;

/// What a call came to. Later releases may add values, and keep the numbers of these.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum nfr_status {
    /// Done.
    NFR_OK = 0,
    /// A pointer is NULL that must not be.
    NFR_NULL_POINTER = 1,
    /// A number is none of those that the argument may have.
    NFR_INVALID_ARGUMENT = 2,
    /// The bytes are no OpenType font.
    NFR_NOT_A_FONT = 3,
    /// The file has no font with this index.
    NFR_NO_SUCH_FONT = 4,
    /// A table of the font, or its table of models, is missing or damaged.
    NFR_DAMAGED_FONT = 5,
    /// The font has no models: it was not converted.
    NFR_NO_MODELS = 6,
    /// The models have a format that this release does not read.
    NFR_UNKNOWN_VERSION = 7,
    /// The font was changed after its models were made: glyphs were renumbered, or this glyph's outline or advance width
    /// is another one.
    NFR_STALE = 8,
    /// The glyph's model or outline is damaged.
    NFR_DAMAGED_GLYPH = 9,
    /// The font has no glyph with this number.
    NFR_NO_SUCH_GLYPH = 10,
    /// The font has this glyph, but no model of it. See nfr_rasterizer_set_missing_model.
    NFR_MISSING_MODEL = 11,
    /// The size is not above 0 and at most 2048 pixels per em.
    NFR_INVALID_SIZE = 12,
    /// The subpixel offset is not a number, or beyond 1024 pixels.
    NFR_INVALID_OFFSET = 13,
    /// The buffer does not hold the bitmap: the placement tells its size.
    NFR_BUFFER_TOO_SMALL = 14,
    /// The glyph asks for more than the limits allow. See nfr_rasterizer_set_limits.
    NFR_LIMIT = 15,
    /// A network draws this glyph, and this build has no networks or the network does not draw this size or offset.
    NFR_UNSUPPORTED = 16,
    /// A defect of this library. Free the rasterizer of the call, if there is one: what it holds is in doubt.
    NFR_INTERNAL = 17,
}

/// The most bytes of a message, with its NUL.
const MESSAGE: usize = 256;

/// A message of this thread. It has no destructor, so that the pointer is valid as long as the thread runs.
struct Message(UnsafeCell<[u8; MESSAGE]>);

thread_local! {
    static LAST: Message = const { Message(UnsafeCell::new([0; MESSAGE])) };
}

/// Why a call failed.
pub(crate) enum Failure {
    Null(&'static str),
    Argument(&'static str),
    Nfr(Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Nfr(error)
    }
}

impl Failure {
    fn status(&self) -> nfr_status {
        match self {
            Self::Null(_) => nfr_status::NFR_NULL_POINTER,
            Self::Argument(_) => nfr_status::NFR_INVALID_ARGUMENT,
            Self::Nfr(error) => of(error),
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Null(name) => format!("the argument {name} is NULL"),
            Self::Argument(what) => (*what).to_owned(),
            Self::Nfr(error) => error.to_string(),
        }
    }
}

/// The status for an error of the library.
fn of(error: &Error) -> nfr_status {
    use nfr_status::*;
    match error {
        Error::NotAFont => NFR_NOT_A_FONT,
        Error::NoSuchFont { .. } => NFR_NO_SUCH_FONT,
        Error::MissingTable { .. }
        | Error::MalformedTable { .. }
        | Error::UnitsPerEm(_)
        | Error::MalformedModels { .. } => NFR_DAMAGED_FONT,
        Error::NotConverted => NFR_NO_MODELS,
        Error::UnknownVersion { .. } => NFR_UNKNOWN_VERSION,
        Error::Renumbered { .. } | Error::StaleModel(_) => NFR_STALE,
        Error::MalformedModel { .. } | Error::ModelTooLarge { .. } | Error::MalformedOutline(_) => {
            NFR_DAMAGED_GLYPH
        }
        Error::NoSuchGlyph(_) => NFR_NO_SUCH_GLYPH,
        Error::MissingModel(_) => NFR_MISSING_MODEL,
        Error::InvalidSize(_) => NFR_INVALID_SIZE,
        Error::InvalidOffset(_) => NFR_INVALID_OFFSET,
        Error::BufferTooSmall { .. } => NFR_BUFFER_TOO_SMALL,
        Error::BitmapTooLarge { .. } | Error::DecodedTooLarge { .. } | Error::TooMuchWork { .. } => NFR_LIMIT,
        Error::FieldsNotBuilt(_)
        | Error::NetworksNotBuilt(_)
        | Error::NetworkSize { .. }
        | Error::NetworkOffset { .. }
        | Error::NetworkSubpixels(_) => NFR_UNSUPPORTED,
        // A variant that was added to the library and not here.
        _ => NFR_INTERNAL,
    }
}

/// Does the work of a call, and keeps the message if it fails.
pub(crate) fn call(work: impl FnOnce() -> Result<(), Failure>) -> nfr_status {
    let (status, message) = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => return nfr_status::NFR_OK,
        Ok(Err(failure)) => (failure.status(), failure.message()),
        Err(panic) => (nfr_status::NFR_INTERNAL, format!("internal error: {}", reason(&*panic))),
    };
    keep(&message);
    status
}

/// The value of a call that has no status; `default` if it panics.
pub(crate) fn value<T>(default: T, work: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(default)
}

fn reason(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("a panic without a message")
}

/// Keeps a message for this thread, cut where it is too long.
fn keep(message: &str) {
    let length = message.floor_char_boundary(MESSAGE - 1);
    LAST.with(|last| {
        // SAFETY: the cell belongs to this thread and no reference to it is kept: C reads it through a pointer, and not
        // while it is in this call.
        let kept = unsafe { &mut *last.0.get() };
        kept[..length].copy_from_slice(&message.as_bytes()[..length]);
        kept[length] = 0;
    });
}

/// Why the last call on this thread failed that returned a status: one sentence in UTF-8, for people; empty before the
/// first failure. A call that succeeds does not change it.
///
/// Never NULL. The text is valid until the next call on this thread that fails, and until the thread ends.
#[unsafe(no_mangle)]
pub extern "C" fn nfr_last_error() -> *const c_char {
    LAST.with(|last| last.0.get().cast_const().cast())
}

/// The version of the library, as "0.1.0". Never NULL, valid always.
#[unsafe(no_mangle)]
pub extern "C" fn nfr_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::ffi::CStr;

    use super::*;

    fn last() -> &'static str {
        // SAFETY: the message ends with a NUL, and this thread fails in no call while it is read.
        unsafe { CStr::from_ptr(nfr_last_error()) }.to_str().unwrap()
    }

    #[test]
    fn a_panic_becomes_a_status_and_a_message() {
        assert_eq!(call(|| panic!("number {}", 7)), nfr_status::NFR_INTERNAL);
        assert_eq!(last(), "internal error: number 7");
        assert_eq!(value(3, || panic!("lost")), 3);
        assert_eq!(call(|| Ok(())), nfr_status::NFR_OK);
        assert_eq!(last(), "internal error: number 7");
    }

    #[test]
    fn a_long_message_is_cut_between_characters() {
        keep(&"×".repeat(300));
        assert_eq!(last(), "×".repeat((MESSAGE - 1) / 2));
        keep("short");
        assert_eq!(last(), "short");
    }
}
