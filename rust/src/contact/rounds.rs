//! Straight element edges of a round master are arcs where gaps are integrals.
//!
//! A polygon on a circle lies up to h^2 / 8 R inside it, or outside in a hollow: rounds that fit, but whose
//! nodes are not opposite, would overlap or gape. Such an edge is therefore the parabola through
//! its nodes with the curvature of the undeformed boundary, a constant height over the chord: flat
//! boundaries stay flat, and a common rotation changes nothing.
// SPDX-License-Identifier: BSD-3-Clause

use super::boundary::followers;
use super::corners::{LEAST_TURN_AT_CORNERS, turn};
use super::curve::{Edge, outward, unit};
use super::master::Surface;

/// Least turn at a vertex of a round; less is rounding.
const LEAST_TURN: f64 = 1e-3;

/// Gives linear edges their height over the chord; `x` is the reference configuration.
pub fn bulge(edges: &mut [Edge], x: &[[f64; 3]]) {
    let next = followers(&Surface::Edges(edges.to_vec()), x);
    let normals: Vec<_> = edges.iter().map(|e| unit(outward(e.place(x).d))).collect();
    let mut curvature = vec![[None; 2]; edges.len()];
    for (j, k) in next.iter().enumerate().filter_map(|(j, k)| k.map(|k| (j, k))) {
        let angle = turn([normals[j], normals[k]]);
        if angle.abs() <= LEAST_TURN_AT_CORNERS {
            let angle = if angle.abs() < LEAST_TURN { 0.0 } else { angle };
            let there = Some(2.0 * angle / (edges[j].length + edges[k].length));
            (curvature[j][1], curvature[k][0]) = (there, there);
        }
    }
    for (edge, ends) in edges.iter_mut().zip(curvature) {
        if edge.n_nodes == 2 {
            edge.sagitta = 0.125 * edge.length * edge.length * between(ends);
        }
    }
}

/// Curvature of an edge from those at its vertices: beside a corner or an end that of the other, the
/// mean else. A vertex between a flat and a round has half, and the flat stays flat.
fn between(ends: [Option<f64>; 2]) -> f64 {
    match ends {
        [Some(a), Some(b)] if a * b <= 0.0 => 0.0,
        [Some(a), Some(b)] => a.signum() * (0.5 * (a + b)).abs().min(2.0 * a.abs().min(b.abs())),
        [a, b] => a.or(b).unwrap_or(0.0),
    }
}
