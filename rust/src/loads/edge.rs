//! Tractions on element edges: dead tractions and following pressure, each with the end
//! moments of drilling elements.
//!
//! A normal traction q (outward) on a drilling edge of length l gives the end moments
//! `-/+ alpha_b q t l^2 / 12`, since a difference of the end rotations bulges the edge.
//! Pressure integrates the turned tangent of the deformed edge, so it needs no square root
//! and its load stiffness is exact; that stiffness is symmetric for closed or fully held
//! boundaries and not at open ends.
// SPDX-License-Identifier: BSD-3-Clause

/// One loaded edge of two nodes, or three with the middle last.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Nodes in the order that keeps the element on the left.
    pub nodes: [u32; 3],
    /// 2 or 3.
    pub n_nodes: usize,
    pub thickness: f64,
    pub alpha_b: f64,
}

/// Force on the nodes of an edge: x, y, moment.
pub type EdgeForce = [[f64; 3]; 3];
/// Derivative of an [`EdgeForce`] with respect to the nodal displacements.
pub type EdgeStiffness = [[[[f64; 2]; 3]; 3]; 3];

/// Gauss points of the edge, shape functions and derivatives for 2 or 3 nodes.
fn samples(n_nodes: usize) -> Vec<(f64, [f64; 3], [f64; 3])> {
    let a = 0.6_f64.sqrt();
    [(-a, 5.0 / 9.0), (0.0, 8.0 / 9.0), (a, 5.0 / 9.0)]
        .iter()
        .map(|&(r, w)| {
            if n_nodes == 2 {
                (w, [0.5 - 0.5 * r, 0.5 + 0.5 * r, 0.0], [-0.5, 0.5, 0.0])
            } else {
                let n = [0.5 * r * (r - 1.0), 0.5 * r * (r + 1.0), 1.0 - r * r];
                (w, n, [r - 0.5, r + 0.5, -2.0 * r])
            }
        })
        .collect()
}

/// Dead traction `t` [force/length^2] on an edge at positions `x`.
pub fn traction(edge: &Edge, x: &[[f64; 2]; 3], t: [f64; 2]) -> EdgeForce {
    let mut f = EdgeForce::default();
    for (w, n, dn) in samples(edge.n_nodes) {
        let d = tangent(x, &dn);
        let dl = w * edge.thickness * (d[0] * d[0] + d[1] * d[1]).sqrt();
        for a in 0..edge.n_nodes {
            f[a][0] += n[a] * t[0] * dl;
            f[a][1] += n[a] * t[1] * dl;
        }
    }
    if edge.alpha_b > 0.0 {
        let e = [x[1][0] - x[0][0], x[1][1] - x[0][1]];
        // q l = t . (outward normal times length)
        let ql = t[0] * e[1] - t[1] * e[0];
        let l = (e[0] * e[0] + e[1] * e[1]).sqrt();
        let moment = edge.alpha_b * edge.thickness * ql * l / 12.0;
        f[0][2] -= moment;
        f[1][2] += moment;
    }
    f
}

/// Pressure `p` (positive into the element) on an edge at current positions `x`, and the
/// derivative of the force with respect to them.
pub fn pressure(edge: &Edge, x: &[[f64; 2]; 3], p: f64) -> (EdgeForce, EdgeStiffness) {
    let mut f = EdgeForce::default();
    let mut k = EdgeStiffness::default();
    for (w, n, dn) in samples(edge.n_nodes) {
        let d = tangent(x, &dn);
        let s = w * edge.thickness * p;
        // Inward normal times length: the tangent turned to the left.
        for a in 0..edge.n_nodes {
            f[a][0] -= s * n[a] * d[1];
            f[a][1] += s * n[a] * d[0];
            for b in 0..edge.n_nodes {
                k[a][b][0][1] -= s * n[a] * dn[b];
                k[a][b][1][0] += s * n[a] * dn[b];
            }
        }
    }
    if edge.alpha_b > 0.0 {
        let e = [x[1][0] - x[0][0], x[1][1] - x[0][1]];
        let c = edge.alpha_b * edge.thickness * p / 12.0;
        let moment = c * (e[0] * e[0] + e[1] * e[1]);
        f[0][2] += moment;
        f[1][2] -= moment;
        for i in 0..2 {
            for (b, sign) in [(0, -1.0), (1, 1.0)] {
                k[0][b][2][i] += 2.0 * c * sign * e[i];
                k[1][b][2][i] -= 2.0 * c * sign * e[i];
            }
        }
    }
    (f, k)
}

fn tangent(x: &[[f64; 2]; 3], dn: &[f64; 3]) -> [f64; 2] {
    let mut d = [0.0; 2];
    for a in 0..3 {
        for i in 0..2 {
            d[i] += x[a][i] * dn[a];
        }
    }
    d
}
