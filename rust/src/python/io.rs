//! Bulk data of decks for Python.
// SPDX-License-Identifier: BSD-3-Clause

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;

use crate::io::{rows, tokens};

type Ints<'py> = Bound<'py, PyArray1<i64>>;
type Floats<'py> = Bound<'py, PyArray1<f64>>;
type Odd = Vec<(usize, i64)>;

fn part(data: &[u8], start: usize, stop: usize) -> &[u8] {
    data.get(start..stop.min(data.len())).unwrap_or_default()
}

/// parse_nodes(data, start, stop, line) -> labels (n,), coordinates (3 n,), lines (n,), odd
///
/// ``odd`` lists first byte (from ``start``) and number of the lines that are not plainly right.
#[pyfunction]
fn parse_nodes<'py>(
    py: Python<'py>,
    data: &[u8],
    start: usize,
    stop: usize,
    line: i64,
) -> (Ints<'py>, Floats<'py>, Ints<'py>, Odd) {
    let found = py.detach(|| rows::nodes(part(data, start, stop), line));
    (
        found.labels.into_pyarray(py),
        found.points.into_pyarray(py),
        found.lines.into_pyarray(py),
        found.odd,
    )
}

/// parse_table(data, start, stop, line, width) -> values (width n,), lines (n,), odd
#[pyfunction]
fn parse_table<'py>(
    py: Python<'py>,
    data: &[u8],
    start: usize,
    stop: usize,
    line: i64,
    width: usize,
) -> (Ints<'py>, Ints<'py>, Odd) {
    let found = py.detach(|| rows::table(part(data, start, stop), line, width));
    (found.values.into_pyarray(py), found.lines.into_pyarray(py), found.odd)
}

/// parse_labels(data, start, stop, line) -> labels (n,), or None if there is anything else
#[pyfunction]
fn parse_labels<'py>(
    py: Python<'py>,
    data: &[u8],
    start: usize,
    stop: usize,
    line: i64,
) -> Option<Ints<'py>> {
    py.detach(|| rows::labels(part(data, start, stop), line)).map(|v| v.into_pyarray(py))
}

/// parse_reals(data, start, stop) -> numbers (n,), or the byte (from ``start``) of a wrong one
#[pyfunction]
fn parse_reals<'py>(
    py: Python<'py>,
    data: &[u8],
    start: usize,
    stop: usize,
) -> PyResult<Bound<'py, PyAny>> {
    match py.detach(|| tokens::reals(part(data, start, stop))) {
        Ok(values) => Ok(values.into_pyarray(py).into_any()),
        Err(at) => Ok(at.into_pyobject(py)?.into_any()),
    }
}

/// Adds the functions to the module.
pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(parse_nodes, m)?)?;
    m.add_function(wrap_pyfunction!(parse_reals, m)?)?;
    m.add_function(wrap_pyfunction!(parse_table, m)?)?;
    m.add_function(wrap_pyfunction!(parse_labels, m)?)
}
