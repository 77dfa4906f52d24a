//! The border to Python: conversions, names, docstrings; no numerics.
// SPDX-License-Identifier: BSD-3-Clause

mod blocks;
mod contact;
mod contact_kernels;
mod contact_law;
mod contact_line;
mod edges;
mod io;
mod linear;
mod material;
mod memory;
mod problem;

use pyo3::prelude::*;

/// Compiled core of Corota.
#[pymodule]
fn _core(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    contact::register(m)?;
    contact_kernels::register(m)?;
    contact_line::register(m)?;
    contact_law::register(m)?;
    edges::register(m)?;
    io::register(m)?;
    linear::register(m)?;
    material::register(m)?;
    memory::register(m)?;
    problem::register(m)?;
    Ok(())
}
