//! Contact pairs with lines or single nodes for Python.
// SPDX-License-Identifier: BSD-3-Clause

use super::contact::{Contact, bad, depths, edges, rows};
use crate::contact::discretization;
use crate::contact::{Contact as Pair, Distances, Edge, Rigid, Slave, Surface};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

type Floats<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Numbers<'py> = PyReadonlyArray2<'py, i64>;

/// Edges of a side with the distance of lines to their surfaces, negative for edges of bodies.
fn of_side(x: &[[f64; 3]], side: &(Numbers, Floats, Floats), name: &str) -> PyResult<Vec<Edge>> {
    let half = side.2.as_slice()?;
    let mut found = if half.is_empty() { Vec::new() } else { edges(x, &side.0, &side.1, name)? };
    if half.len() != found.len() {
        return Err(bad(format!("{name}: {} edges, {} heights", found.len(), half.len())));
    }
    for (edge, &half) in found.iter_mut().zip(half) {
        edge.half = (half >= 0.0).then_some(half);
    }
    Ok(found)
}

/// A contact pair in which lines or single nodes take part, or a tie of such nodes.
///
/// ``slave`` and ``master`` are edges: nodes, bulge factors and the distance of a line to its
/// surfaces, negative for edges of bodies. ``thickness`` is that of the slave edges; ``points`` are
/// slave nodes without edges. In place of ``master`` a rigid curve: segments, node, point and whether
/// it turns, as in ``Contact.rigid``.
#[pyfunction]
#[pyo3(signature = (
    reference, slave, thickness, points, master, rigid=None, *, method="line", reach, margin,
    depth=f64::INFINITY
))]
#[allow(clippy::too_many_arguments)]
fn line_contact(
    reference: Rows<'_>,
    slave: (Numbers<'_>, Floats<'_>, Floats<'_>),
    thickness: Floats<'_>,
    points: PyReadonlyArray1<'_, i64>,
    master: (Numbers<'_>, Floats<'_>, Floats<'_>),
    rigid: Option<(Rows<'_>, i64, [f64; 2], bool)>,
    method: &str,
    reach: f64,
    margin: f64,
    depth: f64,
) -> PyResult<Contact> {
    let x = rows::<3, f64>(&reference, "reference")?;
    let own = of_side(x, &slave, "slave")?;
    let node = |&n: &i64| {
        u32::try_from(n)
            .ok()
            .filter(|&n| (n as usize) < x.len())
            .ok_or_else(|| bad(format!("slave: node {n} is out of range")))
    };
    let points: Vec<u32> = points.as_slice()?.iter().map(node).collect::<PyResult<_>>()?;
    if own.is_empty() == points.is_empty() {
        return Err(bad("the slave is edges or nodes"));
    }
    let slave = if own.is_empty() {
        Slave::of_nodes(points)
    } else {
        Slave::new(x, own.clone(), depths(&thickness)?)
    };
    let first = match &rigid {
        Some((segments, node, point, turns)) => {
            let node = u32::try_from(*node).ok();
            let at = match node {
                Some(n) => x
                    .get(n as usize)
                    .map(|p| [p[0], p[1]])
                    .ok_or_else(|| bad(format!("reference node {n} is out of range")))?,
                None => *point,
            };
            let segments = rows::<7, f64>(segments, "segments")?;
            Surface::Rigid(Rigid::new(segments, (node, *turns), at).map_err(bad)?)
        }
        None => Surface::Edges(of_side(x, &master, "master")?),
    };
    if first.is_empty() {
        return Err(bad("the master has no edges"));
    }
    let entry = discretization::find(method).map_err(bad)?;
    let faces = if entry.joins { first } else { Surface::Both(Box::new(first), own) };
    let distances = Distances { reach, margin, depth };
    Ok(Contact::of(Pair::with(x, slave, Some(faces), entry, distances, false), x.len()))
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(line_contact, m)?)
}
