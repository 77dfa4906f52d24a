//! Loads on element edges at current positions: dead tractions and following pressure.
//!
//! A side of a drilling element is a parabola: its middle lies `alpha_b l0 / 8 (phi_0 - phi_1)`
//! off the chord, along the chord's current normal. (l0 is the undeformed length. Contact sees
//! the same curve, see `contact::curve`.) The work of a load on that bulge is a potential
//!
//! ```text
//! W = (phi_0 - phi_1) h(e),   e the current chord
//! h = alpha_b l0 t p |e| / 12           pressure p: times the area between chord and curve
//! h = alpha_b l0^2 t (q . S e / |e|) / 12   dead traction q: its work on the bulge
//! ```
//!
//! whose gradient is the pair of end moments and its partner, a pair of forces at the ends. So
//! this part of the load stiffness is symmetric for every edge. The chord's part of a pressure
//! integrates the turned tangent; its stiffness is symmetric for closed or fully held
//! boundaries and not at open ends.
// SPDX-License-Identifier: BSD-3-Clause

use std::f64::consts::TAU;

/// One loaded edge of two nodes, or three with the middle last.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Nodes in the order that keeps the element on the left.
    pub nodes: [u32; 3],
    /// 2 or 3.
    pub n_nodes: usize,
    /// Thickness of the nodes; of edges that are turned about the axis a factor.
    pub thickness: [f64; 3],
    pub alpha_b: f64,
    /// Undeformed positions of the nodes.
    pub x: [[f64; 2]; 3],
    /// Whether it is turned about the axis: a pressure acts on the current circumference.
    pub ring: bool,
}

/// Where an edge is: positions of its nodes, and the difference of its end rotations.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub x: [[f64; 2]; 3],
    pub differ: f64,
}

/// Force on the nodes of an edge: x, y, moment.
pub type EdgeForce = [[f64; 3]; 3];
/// Derivative of an [`EdgeForce`] with respect to the nodal displacements and rotations.
pub type EdgeStiffness = [[[[f64; 3]; 3]; 3]; 3];

impl Edge {
    /// The undeformed edge.
    pub fn undeformed(&self) -> Place {
        Place { x: self.x, differ: 0.0 }
    }

    /// Thickness where the shape functions are `n`.
    fn thickness(&self, n: &[f64; 3]) -> f64 {
        (0..self.n_nodes).map(|a| n[a] * self.thickness[a]).sum()
    }

    /// That of the middle of a straight edge; by it a bulge weighs, which is symmetric to it.
    fn middle(&self) -> f64 {
        0.5 * (self.thickness[0] + self.thickness[1])
    }

    fn length(&self) -> f64 {
        let e = chord(&self.x);
        e[0].hypot(e[1])
    }
}

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

/// Dead traction `t` [force/length^2 of the undeformed edge], and the derivative of its force.
pub fn traction(edge: &Edge, at: &Place, t: [f64; 2]) -> (EdgeForce, EdgeStiffness) {
    let mut f = EdgeForce::default();
    let mut k = EdgeStiffness::default();
    for (w, n, dn) in samples(edge.n_nodes) {
        let d = tangent(&edge.x, &dn);
        let dl = w * edge.thickness(&n) * (d[0] * d[0] + d[1] * d[1]).sqrt();
        for a in 0..edge.n_nodes {
            f[a][0] += n[a] * t[0] * dl;
            f[a][1] += n[a] * t[1] * dl;
        }
    }
    if edge.alpha_b > 0.0 {
        let c = edge.alpha_b * edge.middle() * edge.length().powi(2) / 12.0;
        let (l, unit, normal) = frame(&at.x);
        let (along, across) =
            (c * (t[0] * unit[0] + t[1] * unit[1]), c * (t[0] * normal[0] + t[1] * normal[1]));
        // h = across; its gradient and second derivative by the chord.
        let slope = normal.map(|n| -along * n / l);
        let mut second = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                let mixed = unit[i] * normal[j] + normal[i] * unit[j];
                second[i][j] = (along * mixed - across * normal[i] * normal[j]) / (l * l);
            }
        }
        add_bulge(at.differ, across, slope, second, &mut f, &mut k);
    }
    (f, k)
}

/// Pressure `p` (positive into the element) on the current edge, and the derivative of its force.
pub fn pressure(edge: &Edge, at: &Place, p: f64) -> (EdgeForce, EdgeStiffness) {
    let mut f = EdgeForce::default();
    let mut k = EdgeStiffness::default();
    for (w, n, dn) in samples(edge.n_nodes) {
        let d = tangent(&at.x, &dn);
        let radius: f64 = (0..edge.n_nodes).map(|a| n[a] * at.x[a][0]).sum();
        let thickness = edge.thickness(&n);
        let depth = if edge.ring { TAU * radius * thickness } else { thickness };
        let s = w * depth * p;
        // Inward normal times length: the tangent turned to the left.
        for a in 0..edge.n_nodes {
            f[a][0] -= s * n[a] * d[1];
            f[a][1] += s * n[a] * d[0];
            for b in 0..edge.n_nodes {
                k[a][b][0][1] -= s * n[a] * dn[b];
                k[a][b][1][0] += s * n[a] * dn[b];
                if edge.ring {
                    let growth = w * p * TAU * thickness * n[a] * n[b];
                    k[a][b][0][0] -= growth * d[1];
                    k[a][b][1][0] += growth * d[0];
                }
            }
        }
    }
    if edge.alpha_b > 0.0 {
        let c = edge.alpha_b * edge.middle() * edge.length() * p / 12.0;
        let (l, unit, normal) = frame(&at.x);
        let mut second = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                second[i][j] = c * normal[i] * normal[j] / l;
            }
        }
        add_bulge(at.differ, c * l, unit.map(|e| c * e), second, &mut f, &mut k);
    }
    (f, k)
}

/// Add the gradient and the second derivative of `differ h(e)`, given those of h.
fn add_bulge(
    differ: f64,
    h: f64,
    slope: [f64; 2],
    second: [[f64; 2]; 2],
    f: &mut EdgeForce,
    k: &mut EdgeStiffness,
) {
    let turns = [1.0, -1.0];
    for a in 0..2 {
        // The chord grows with its last end.
        f[a][2] += turns[a] * h;
        for i in 0..2 {
            f[a][i] -= turns[a] * differ * slope[i];
            for b in 0..2 {
                let signs = turns[a] * turns[b];
                k[a][b][2][i] -= signs * slope[i];
                k[a][b][i][2] -= signs * slope[i];
                for j in 0..2 {
                    k[a][b][i][j] += signs * differ * second[i][j];
                }
            }
        }
    }
}

fn chord(x: &[[f64; 2]; 3]) -> [f64; 2] {
    [x[1][0] - x[0][0], x[1][1] - x[0][1]]
}

/// Length of the chord, its direction, and its normal into the element.
fn frame(x: &[[f64; 2]; 3]) -> (f64, [f64; 2], [f64; 2]) {
    let e = chord(x);
    let l = e[0].hypot(e[1]);
    let unit = [e[0] / l, e[1] / l];
    (l, unit, [-unit[1], unit[0]])
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
