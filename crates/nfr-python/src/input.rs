//! A font's bytes from what Python programs have: a path, bytes, or a file object.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyByteArray, PyBytes, PyMemoryView, PyString};

/// The bytes of `file`. Those of a `bytes` object are not copied.
pub(crate) fn bytes(file: &Bound<'_, PyAny>) -> PyResult<PyBackedBytes> {
    let py = file.py();
    if file.is_instance_of::<PyBytes>() || file.is_instance_of::<PyByteArray>() {
        return Ok(file.extract()?);
    }
    if file.is_instance_of::<PyString>() || file.hasattr("__fspath__")? {
        // Python opens it: its errors have the path, and audit hooks see it.
        let opened = py.import("io")?.call_method1("open", (file, "rb"))?;
        let content = opened.call_method0("read");
        opened.call_method0("close")?;
        return Ok(content?.extract()?);
    }
    if let Ok(view) = PyMemoryView::from(file) {
        return Ok(view.call_method0("tobytes")?.extract()?);
    }
    let name = file.get_type().name()?;
    if !file.hasattr("read")? {
        let message = format!("a path, bytes or a file open for reading is needed, not {name}");
        return Err(PyTypeError::new_err(message));
    }
    file.call_method0("read")?.extract().map_err(|_| {
        PyTypeError::new_err(format!(
            "{name}.read() gave no bytes; open the file in binary mode: open(path, \"rb\")"
        ))
    })
}
