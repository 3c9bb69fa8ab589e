//! The library's errors as Python's: a class of `nfr.errors`, the cause's name, the message and its values.

use nfr::Error;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

/// Why a call failed.
pub(crate) enum Failure {
    Nfr(Error),
    /// A line's bitmap would have more pixels than a glyph's may have.
    LineTooLarge {
        width: u64,
        height: u64,
        limit: u64,
    },
    /// The font's character map lacks a character.
    NoSuchCharacter(char),
    /// A glyph's number that no font has.
    NoSuchGlyph(Py<PyAny>),
    Memory,
    Python(PyErr),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Nfr(error)
    }
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        let (message, (code, values)) = match failure {
            Failure::Python(error) => return error,
            Failure::Memory => return PyMemoryError::new_err("the bitmap does not fit into memory"),
            Failure::NoSuchGlyph(glyph) => (
                format!("the font has no glyph {glyph}"),
                ("no_such_glyph", vec![("glyph", Value::Object(glyph))]),
            ),
            Failure::NoSuchCharacter(character) => (
                format!("the font has no glyph for {character:?} (U+{:04X})", u32::from(character)),
                ("no_such_character", vec![text("character", character)]),
            ),
            Failure::Nfr(error) => (error.to_string(), cause(&error)),
            Failure::LineTooLarge { width, height, limit } => (
                format!("a line of {width}×{height} pixels, {limit} pixels are allowed"),
                (
                    "line_too_large",
                    vec![number("width", width), number("height", height), number("limit", limit)],
                ),
            ),
        };
        Python::attach(|py| exception(py, &message, code, &values).unwrap_or_else(|error| error))
    }
}

/// A value of an error.
enum Value {
    Number(u64),
    Real(f32),
    Point([f32; 2]),
    Text(String),
    Object(Py<PyAny>),
}

type Values = Vec<(&'static str, Value)>;

fn number(name: &'static str, value: impl Into<u64>) -> (&'static str, Value) {
    (name, Value::Number(value.into()))
}

fn size(name: &'static str, value: usize) -> (&'static str, Value) {
    (name, Value::Number(value as u64))
}

fn text(name: &'static str, value: impl Into<String>) -> (&'static str, Value) {
    (name, Value::Text(value.into()))
}

/// The name of an error's cause, and its values.
fn cause(error: &Error) -> (&'static str, Values) {
    let tag = |tag: &[u8; 4]| vec![text("tag", String::from_utf8_lossy(tag))];
    let glyph = |glyph: u32| number("glyph", glyph);
    match *error {
        Error::NotAFont => ("not_a_font", vec![]),
        Error::NoSuchFont { index, count } => {
            ("no_such_font", vec![number("index", index), number("count", count)])
        }
        Error::MissingTable { tag: of } => ("missing_table", tag(&of)),
        Error::MalformedTable { tag: of } => ("malformed_table", tag(&of)),
        Error::UnitsPerEm(units) => ("units_per_em", vec![number("units_per_em", units)]),
        Error::NotConverted => ("not_converted", vec![]),
        Error::UnknownVersion { major } => ("unknown_version", vec![number("major", major)]),
        Error::MalformedModels { what, offset } => {
            ("malformed_models", vec![text("what", what), size("offset", offset)])
        }
        Error::MalformedModel { glyph: of, what } => ("malformed_model", vec![glyph(of), text("what", what)]),
        Error::ModelTooLarge { glyph: of, what, count, limit } => (
            "model_too_large",
            vec![glyph(of), text("what", what), number("count", count), number("limit", limit)],
        ),
        Error::Renumbered { models, font } => {
            ("renumbered", vec![number("models", models), number("font", font)])
        }
        Error::StaleModel(of) => ("stale_model", vec![glyph(of)]),
        Error::NoSuchGlyph(of) => ("no_such_glyph", vec![glyph(of)]),
        Error::MissingModel(of) => ("missing_model", vec![glyph(of)]),
        Error::MalformedOutline(of) => ("malformed_outline", vec![glyph(of)]),
        Error::FieldsNotBuilt(of) => ("fields_not_built", vec![glyph(of)]),
        Error::NetworksNotBuilt(of) => ("networks_not_built", vec![glyph(of)]),
        Error::NetworkSize { glyph: of, ppem } => {
            ("network_size", vec![glyph(of), ("ppem", Value::Real(ppem))])
        }
        Error::NetworkOffset { glyph: of, offset } => {
            ("network_offset", vec![glyph(of), ("offset", Value::Point(offset))])
        }
        Error::NetworkSubpixels(of) => ("network_subpixels", vec![glyph(of)]),
        Error::InvalidSize(ppem) => ("invalid_size", vec![("ppem", Value::Real(ppem))]),
        Error::InvalidOffset(offset) => ("invalid_offset", vec![("offset", Value::Real(offset))]),
        Error::BitmapTooLarge { width, height, limit } => (
            "bitmap_too_large",
            vec![number("width", width), number("height", height), number("limit", limit)],
        ),
        Error::DecodedTooLarge { glyph: of, bytes, limit } => {
            ("decoded_too_large", vec![glyph(of), size("bytes", bytes), size("limit", limit)])
        }
        Error::TooMuchWork { glyph: of, work, limit } => {
            ("too_much_work", vec![glyph(of), number("work", work), number("limit", limit)])
        }
        // BufferTooSmall, which no call here can cause, and what the library may add.
        _ => ("other", vec![]),
    }
}

/// An exception of `nfr.errors`, which chooses the class by the cause.
fn exception(py: Python<'_>, message: &str, code: &str, values: &Values) -> PyResult<PyErr> {
    static MAKE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let dict = PyDict::new(py);
    for (name, value) in values {
        let value = match value {
            Value::Number(number) => number.into_py_any(py)?,
            Value::Real(real) => real.into_py_any(py)?,
            Value::Point([x, y]) => (*x, *y).into_py_any(py)?,
            Value::Text(text) => text.into_py_any(py)?,
            Value::Object(object) => object.clone_ref(py),
        };
        dict.set_item(name, value)?;
    }
    let made = MAKE.import(py, "nfr.errors", "error_of")?.call1((message, code, dict))?;
    Ok(PyErr::from_value(made))
}
