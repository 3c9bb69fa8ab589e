//! The compiled part of the Python package nfr. `python/nfr/_nfr.pyi` describes it for Python.

mod bitmap;
mod error;
mod font;
mod glyphs;
mod info;
mod input;
mod line;
mod pool;
mod values;

use pyo3::prelude::*;

/// Hinted glyphs from small models in the font, drawn to numpy arrays.
#[pymodule]
mod _nfr {
    #[pymodule_export]
    use super::bitmap::Bitmap;
    #[pymodule_export]
    use super::font::Font;
    #[pymodule_export]
    use super::values::{Limits, LineMetrics};
}
