//! `EdgeLoads` for Python.
// SPDX-License-Identifier: BSD-3-Clause

use crate::loads::edge::{self, Edge, EdgeForce, EdgeStiffness, Place};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// Force (n_nodes, 3) flat, and its derivative as triplets (row, column, value).
type Answer<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<f64>>,
);

/// Loaded edges, all with the same kind of load.
///
/// EdgeLoads(points, nodes, thickness, alpha_b, ring=False): ``points`` (n_nodes, 2) undeformed; ``nodes``
/// (n, 3) uint32, the third repeated from the first where the edge is straight; ``thickness`` (n, 3)
/// of these nodes. ``ring``: the edges are turned about the axis.
#[pyclass(name = "EdgeLoads")]
pub struct PyEdgeLoads {
    edges: Vec<Edge>,
}

#[pymethods]
impl PyEdgeLoads {
    #[new]
    #[pyo3(signature = (points, nodes, thickness, alpha_b, ring = false))]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        nodes: PyReadonlyArray2<'_, u32>,
        thickness: PyReadonlyArray2<'_, f64>,
        alpha_b: PyReadonlyArray1<'_, f64>,
        ring: bool,
    ) -> PyResult<Self> {
        let (t, b) = (thickness.as_slice()?.as_chunks::<3>().0, alpha_b.as_slice()?);
        let points = points.as_slice()?.as_chunks::<2>().0;
        let rows = nodes.as_slice()?.as_chunks::<3>().0;
        let edges = rows.iter().zip(t).zip(b).map(|((&nodes, &thickness), &alpha_b)| {
            let n_nodes = if nodes[2] == nodes[0] { 2 } else { 3 };
            let x = nodes.map(|n| points[n as usize]);
            Edge { nodes, n_nodes, thickness, alpha_b, x, ring }
        });
        Ok(Self { edges: edges.collect() })
    }

    /// Force of a dead traction at displacements and rotations ``u`` (n_nodes, 3), and its
    /// derivative as triplets with row and column = 3 node + dof; undeformed for an empty ``u``.
    fn traction<'py>(
        &self,
        py: Python<'py>,
        u: PyReadonlyArray2<'py, f64>,
        n_nodes: usize,
        t: [f64; 2],
    ) -> PyResult<Answer<'py>> {
        Ok(self.sum(py, u.as_slice()?, n_nodes, false, |edge, at| edge::traction(edge, at, t)))
    }

    /// Force of a following pressure; arguments and results as for a traction.
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        u: PyReadonlyArray2<'py, f64>,
        n_nodes: usize,
        p: f64,
    ) -> PyResult<Answer<'py>> {
        Ok(self.sum(py, u.as_slice()?, n_nodes, true, |edge, at| edge::pressure(edge, at, p)))
    }
}

impl PyEdgeLoads {
    /// The same entries at every state: those of the chord that follows, and all of drilling edges.
    fn sum<'py>(
        &self,
        py: Python<'py>,
        u: &[f64],
        n_nodes: usize,
        chord: bool,
        load: impl Fn(&Edge, &Place) -> (EdgeForce, EdgeStiffness),
    ) -> Answer<'py> {
        let u = u.as_chunks::<3>().0;
        let mut f = vec![0.0; 3 * n_nodes];
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for e in &self.edges {
            let mut at = e.undeformed();
            if !u.is_empty() {
                let moved = e.nodes.map(|n| u[n as usize]);
                for (x, m) in at.x.iter_mut().zip(&moved) {
                    *x = [x[0] + m[0], x[1] + m[1]];
                }
                at.differ = moved[0][2] - moved[1][2];
            }
            let (force, k) = load(e, &at);
            for a in 0..e.n_nodes {
                for i in 0..3 {
                    f[3 * e.nodes[a] as usize + i] += force[a][i];
                }
            }
            if u.is_empty() {
                continue;
            }
            for a in 0..e.n_nodes {
                for b in 0..e.n_nodes {
                    for i in 0..3 {
                        for j in 0..3 {
                            if e.alpha_b > 0.0
                                || (chord && i < 2 && j < 2 && (i != j || (e.ring && j == 0)))
                            {
                                rows.push(3 * e.nodes[a] + i as u32);
                                columns.push(3 * e.nodes[b] + j as u32);
                                values.push(k[a][b][i][j]);
                            }
                        }
                    }
                }
            }
        }
        (
            f.into_pyarray(py),
            rows.into_pyarray(py),
            columns.into_pyarray(py),
            values.into_pyarray(py),
        )
    }
}

pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyEdgeLoads>()
}
