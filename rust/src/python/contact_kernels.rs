//! Complementarity problems, and crossings of nodes, for Python.
// SPDX-License-Identifier: BSD-3-Clause

use super::contact::{bad, rows};
use crate::contact::crossing::{self, Piece, Way};
use crate::contact::law::State;
use crate::contact::unilateral::Linearized;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

type Floats<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;

type Solved<'py> = Option<(
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<i8>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
)>;

/// Solve all conditions of unilateral constraints linearized about states: ``contact/unilateral.rs``.
///
/// Of n constraints: ``states``, ``directions`` of the tractions of what slips, ``friction``, and
/// ``rubs``, which of them have shear tractions. Rows of ``normal`` and ``tangent`` (n, 1 + 2 n) hold
/// the value without inputs, then the changes by two inputs of each constraint; ``tangent`` has rows
/// for those with shear tractions alone. ``start`` are states to begin from; with ``slides``, what
/// sticks slips to begin with where nothing else is found. Gives the inputs (2 n,), states,
/// directions, pressures and tractions (n,); None where none are found.
#[pyfunction]
#[pyo3(signature = (states, directions, friction, rubs, normal, tangent, start=None, slides=false))]
#[allow(clippy::too_many_arguments)]
fn unilateral<'py>(
    py: Python<'py>,
    states: PyReadonlyArray1<'py, i8>,
    directions: Floats<'py>,
    friction: Floats<'py>,
    rubs: PyReadonlyArray1<'py, bool>,
    normal: Rows<'py>,
    tangent: Rows<'py>,
    start: Option<PyReadonlyArray1<'py, i8>>,
    slides: bool,
) -> PyResult<Solved<'py>> {
    let as_states = |numbers: &PyReadonlyArray1<'_, i8>| -> Vec<State> {
        numbers.as_array().iter().map(|&number| State::of(number)).collect()
    };
    let flat = |rows: &Rows<'_>| -> Vec<f64> { rows.as_array().iter().copied().collect() };
    let states = as_states(&states);
    let n = states.len();
    let directions = directions.as_array().to_vec();
    let mu = friction.as_array();
    let friction: Vec<Option<f64>> =
        rubs.as_array().iter().zip(mu).map(|(&rubs, &mu)| rubs.then_some(mu)).collect();
    let start = start.as_ref().map(as_states);
    let counts = [directions.len(), friction.len(), mu.len(), start.as_ref().map_or(n, Vec::len)];
    let rubbing = friction.iter().flatten().count();
    let fits = |rows: &Rows<'_>, n: usize| rows.as_array().shape() == [n, counts[0] * 2 + 1];
    if !fits(&normal, n) || !fits(&tangent, rubbing) || counts != [n; 4] {
        return Err(bad(format!("the arrays do not fit {n} constraints")));
    }
    let (normal, tangent) = (flat(&normal), flat(&tangent));
    let found = py.detach(|| {
        let constraints = Linearized {
            states: &states,
            directions: &directions,
            friction: &friction,
            normal: &normal,
            tangent: &tangent,
        };
        constraints.solve(start.as_deref(), slides)
    });
    Ok(found.map(|found| {
        (
            found.inputs.into_pyarray(py),
            found.states.into_pyarray(py),
            found.directions.into_pyarray(py),
            found.pressures.into_pyarray(py),
            found.tractions.into_pyarray(py),
        )
    }))
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
    m.add_function(wrap_pyfunction!(unilateral, m)?)?;
    m.add_function(wrap_pyfunction!(times_of_crossing, m)?)
}
