//! Complementarity problems, and crossings of nodes, for Python.
// SPDX-License-Identifier: BSD-3-Clause

use super::contact::{bad, rows};
use crate::contact::complementarity;
use crate::contact::crossing::{self, Piece, Way};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

type Floats<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Found<'py> = Option<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<bool>>)>;

/// Solve ``y = c + m x, x >= 0, y >= 0, x y = 0`` by Lemke's method; rows and columns of like size.
///
/// ``start`` are the x in the basis at the beginning; their y are zero. Gives x and which of them are
/// in the basis at the end. None if the method ends on a ray, where there is no solution or it
/// cannot find one, or if the basis of ``start`` is singular.
#[pyfunction]
#[pyo3(signature = (c, m, start=None))]
fn lemke<'py>(
    py: Python<'py>,
    c: Floats<'py>,
    m: Rows<'py>,
    start: Option<PyReadonlyArray1<'py, bool>>,
) -> PyResult<Found<'py>> {
    let (c, start) = (c.as_array().to_vec(), start.as_ref().map(|s| s.as_slice()).transpose()?);
    let n = c.len();
    if m.as_array().shape() != [n, n] || start.is_some_and(|s| s.len() != n) {
        return Err(bad(format!("m and start do not fit {n} numbers")));
    }
    let m: Vec<f64> = m.as_array().iter().copied().collect();
    let found = py.detach(|| complementarity::lemke(&c, &m, start));
    Ok(found.map(|(x, basic)| (x.into_pyarray(py), basic.into_pyarray(py))))
}

fn pieces(array: &PyReadonlyArray3<'_, f64>) -> PyResult<Vec<Piece>> {
    if array.as_array().shape()[1..] != [2, 2] {
        return Err(bad("a piece has two ends"));
    }
    let flat: Vec<f64> = array.as_array().iter().copied().collect();
    Ok(flat.as_chunks::<4>().0.iter().map(|&[a, b, c, d]| [[a, b], [c, d]]).collect())
}

/// Shares of the way after which nodes go through a piece from outside; infinite if they do not.
///
/// All move evenly: pieces (m, 2, 2), the body on their left, from ``first`` to ``last`` with nodes
/// ``ends`` (m, 2), and ``nodes`` (k,) of positions from ``old`` to ``new`` (n_nodes, 3). ``outside``
/// (k,) are the distances at which the outer side begins for each; ``depth`` is a distance from a
/// piece that is none, at the start and at the end.
#[pyfunction]
#[pyo3(signature = (first, last, ends, old, new, nodes, outside, depth=0.0))]
#[allow(clippy::too_many_arguments)]
fn times_of_crossing<'py>(
    py: Python<'py>,
    first: PyReadonlyArray3<'py, f64>,
    last: PyReadonlyArray3<'py, f64>,
    ends: PyReadonlyArray2<'py, i64>,
    old: Rows<'py>,
    new: Rows<'py>,
    nodes: PyReadonlyArray1<'py, i64>,
    outside: Floats<'py>,
    depth: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (first, last, ends) = (pieces(&first)?, pieces(&last)?, rows::<2, i64>(&ends, "ends")?);
    let (old, new) = (rows::<3, f64>(&old, "old")?, rows::<3, f64>(&new, "new")?);
    if first.len() != last.len() || first.len() != ends.len() {
        return Err(bad("the pieces are not the same"));
    }
    let way = |(&node, &outside): (&i64, &f64)| {
        let at = |x: &[[f64; 3]]| x.get(node as usize).map(|x| [x[0], x[1]]);
        let (from, to) = at(old).zip(at(new)).ok_or_else(|| bad(format!("no node {node}")))?;
        Ok(Way { node, from, to, outside })
    };
    let ways = nodes.as_slice()?.iter().zip(outside.as_slice()?).map(way);
    let ways = ways.collect::<PyResult<Vec<Way>>>()?;
    Ok(crossing::times_of_crossing([&first, &last], ends, &ways, depth).into_pyarray(py))
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(lemke, m)?)?;
    m.add_function(wrap_pyfunction!(times_of_crossing, m)?)
}
