//! Bitmaps: numpy arrays with their place.

use nfr::Placement;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyByteArray, PyDict, PyTuple};

/// Coverage of pixels, and where they lie relative to the origin: the glyph's, or the beginning of a line on its baseline.
#[pyclass(frozen, module = "nfr")]
pub(crate) struct Bitmap {
    /// Coverage 0-255: a numpy array of uint8 with the shape (height, width), top row first, or (height, width, 3) for red, green
    /// and blue. It belongs to the caller.
    #[pyo3(get)]
    pixels: Py<PyAny>,
    placement: Placement,
}

impl Bitmap {
    /// Copies pixels, `placement.width` bytes a row.
    pub(crate) fn new(py: Python<'_>, placement: Placement, pixels: &[u8]) -> PyResult<Self> {
        Self::with_shape(py, placement, pixels, (placement.height, placement.width))
    }

    /// Copies pixels, red, green and blue one after the other.
    pub(crate) fn of_subpixels(py: Python<'_>, placement: Placement, pixels: &[[u8; 3]]) -> PyResult<Self> {
        Self::with_shape(py, placement, pixels.as_flattened(), (placement.height, placement.width, 3))
    }

    fn with_shape<'py>(
        py: Python<'py>,
        placement: Placement,
        pixels: &[u8],
        shape: impl IntoPyObject<'py>,
    ) -> PyResult<Self> {
        static NDARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        static UINT8: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let memory = PyByteArray::new(py, pixels);
        let uint8 = UINT8.import(py, "numpy", "uint8")?;
        let pixels = NDARRAY.import(py, "numpy", "ndarray")?.call1((shape, uint8, memory))?;
        Ok(Self { pixels: pixels.unbind(), placement })
    }
}

#[pymethods]
impl Bitmap {
    /// Pixels from the origin to the left edge of the left column.
    #[getter]
    fn left(&self) -> i32 {
        self.placement.left
    }

    /// Pixels from the baseline up to the top edge of the top row.
    #[getter]
    fn top(&self) -> i32 {
        self.placement.top
    }

    /// Columns.
    #[getter]
    fn width(&self) -> u32 {
        self.placement.width
    }

    /// Rows.
    #[getter]
    fn height(&self) -> u32 {
        self.placement.height
    }

    /// What numpy.asarray(bitmap) calls: the pixels.
    #[pyo3(signature = (*args, **kwargs))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        args: &Bound<'py, PyTuple>,
        kwargs: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.pixels.bind(py).call_method("__array__", args, kwargs)
    }

    fn __repr__(&self) -> String {
        let Placement { left, top, width, height } = self.placement;
        format!("<nfr.Bitmap {width}×{height}, left {left}, top {top}>")
    }
}
