// SPDX-License-Identifier: BSD-3-Clause
//! Memory that is free, for the drivers and readers.

use pyo3::prelude::*;

use crate::base::memory::{self, Shortage};

/// ``ResourceError`` of a shortage.
pub fn to_python(py: Python<'_>, shortage: &Shortage) -> PyErr {
    let build = || -> PyResult<PyErr> {
        let errors = py.import("corota.errors")?;
        let value = errors.getattr("ResourceError")?.call1((shortage.to_string(),))?;
        Ok(PyErr::from_value(value))
    };
    build().unwrap_or_else(|e| e)
}

/// ``ResourceError`` where an allocation has failed and memory is still short.
pub fn require_reserve(py: Python<'_>) -> PyResult<()> {
    memory::require_reserve().map_err(|s| to_python(py, &s))
}

/// require_memory(bytes, job)
///
/// Raise ``ResourceError`` if so many bytes, and a reserve, are not free for ``job``.
#[pyfunction]
fn require_memory(py: Python<'_>, bytes: f64, job: String) -> PyResult<()> {
    memory::require(bytes as usize, || job).map_err(|s| to_python(py, &s))
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    memory::require_reserve().map_err(|s| to_python(m.py(), &s))?;
    m.add_function(wrap_pyfunction!(require_memory, m)?)
}
