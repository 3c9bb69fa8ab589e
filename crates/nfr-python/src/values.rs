//! Small values: limits, and metrics of a line.

use nfr::{Lcd, LcdFilter, SubpixelOrder};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// An argument that counts something.
///
/// # Errors
///
/// `ValueError` for a negative number, and for one that is too large to count with.
pub(crate) fn unsigned<T: TryFrom<i64>>(name: &str, value: i64) -> PyResult<T> {
    T::try_from(value).map_err(|_| PyValueError::new_err(format!("{name} is out of range: {value}")))
}

/// How subpixels are drawn, by the names of their order and of the filter.
///
/// # Errors
///
/// `ValueError` for another name.
pub(crate) fn lcd(order: &str, filter: &str) -> PyResult<Lcd> {
    let order = match order {
        "rgb" => SubpixelOrder::Rgb,
        "bgr" => SubpixelOrder::Bgr,
        "v-rgb" => SubpixelOrder::VerticalRgb,
        "v-bgr" => SubpixelOrder::VerticalBgr,
        _ => {
            let message = format!("order is 'rgb', 'bgr', 'v-rgb' or 'v-bgr', not {order:?}");
            return Err(PyValueError::new_err(message));
        }
    };
    let filter = match filter {
        "shifted" => LcdFilter::Shifted,
        "light" => LcdFilter::Light,
        "fir5" => LcdFilter::Fir5,
        "none" => LcdFilter::Unfiltered,
        _ => {
            let message = format!("filter is 'shifted', 'light', 'fir5' or 'none', not {filter:?}");
            return Err(PyValueError::new_err(message));
        }
    };
    Ok(Lcd::new(order).with_filter(filter))
}

/// What drawing a glyph may take. A font file cannot ask for more.
#[pyclass(frozen, get_all, eq, hash, from_py_object, module = "nfr")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Limits {
    /// The longest side of a bitmap in pixels. A line of text has at most the square of it in pixels.
    bitmap_side: u32,
    /// The memory that a decoded glyph may take, in bytes.
    decoded_bytes: usize,
    /// The steps that drawing a glyph may take, about one multiplication each.
    work: u64,
}

impl From<Limits> for nfr::Limits {
    fn from(limits: Limits) -> Self {
        let mut made = Self::default();
        made.bitmap_side = limits.bitmap_side;
        made.decoded_bytes = limits.decoded_bytes;
        made.work = limits.work;
        made
    }
}

#[pymethods]
impl Limits {
    #[new]
    #[pyo3(signature = (*, bitmap_side=8192, decoded_bytes=8_388_608, work=268_435_456))]
    fn new(bitmap_side: i64, decoded_bytes: i64, work: i64) -> PyResult<Self> {
        Ok(Self {
            bitmap_side: unsigned("bitmap_side", bitmap_side)?,
            decoded_bytes: unsigned("decoded_bytes", decoded_bytes)?,
            work: unsigned("work", work)?,
        })
    }

    fn __repr__(&self) -> String {
        let Self { bitmap_side, decoded_bytes, work } = self;
        format!("nfr.Limits(bitmap_side={bitmap_side}, decoded_bytes={decoded_bytes}, work={work})")
    }
}

/// Metrics of a line of text in pixels, y up, linear in the size.
#[pyclass(frozen, get_all, eq, module = "nfr")]
#[derive(PartialEq)]
pub(crate) struct LineMetrics {
    /// From the baseline up to the top of the line.
    ascent: f32,
    /// From the baseline up to the bottom of the line: a negative number in most fonts.
    descent: f32,
    /// What is left free between two lines. Baselines are ascent - descent + line_gap apart.
    line_gap: f32,
    /// From the baseline up to the top of the underline: a negative number in most fonts.
    underline_position: f32,
    /// The underline's thickness.
    underline_thickness: f32,
}

impl From<nfr::LineMetrics> for LineMetrics {
    fn from(metrics: nfr::LineMetrics) -> Self {
        Self {
            ascent: metrics.ascent,
            descent: metrics.descent,
            line_gap: metrics.line_gap,
            underline_position: metrics.underline_position,
            underline_thickness: metrics.underline_thickness,
        }
    }
}

#[pymethods]
impl LineMetrics {
    fn __repr__(&self) -> String {
        let Self { ascent, descent, line_gap, .. } = self;
        format!("<nfr.LineMetrics ascent {ascent}, descent {descent}, line_gap {line_gap}>")
    }
}
