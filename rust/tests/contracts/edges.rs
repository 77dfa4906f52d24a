//! Edge loads: resultants, end moments and load stiffness.
// SPDX-License-Identifier: BSD-3-Clause

use crate::common::Random;
use corota::loads::edge::{Edge, EdgeForce, pressure, traction};

const ROUNDOFF: f64 = 1e-13;

fn edges() -> [Edge; 4] {
    let edge = |n_nodes, alpha_b| Edge { nodes: [0, 1, 2], n_nodes, thickness: 1.7, alpha_b };
    [edge(2, 0.0), edge(2, 1.0), edge(2, 1.5), edge(3, 0.0)]
}

/// A random edge, straight where it has two nodes.
fn place(edge: &Edge, random: &mut Random) -> [[f64; 2]; 3] {
    let mut x = [[random.signed(), random.signed()], [2.0, random.signed()], [0.0; 2]];
    if edge.n_nodes == 3 {
        let bulge = 0.1 * random.signed();
        x[2] = [0.5 * (x[0][0] + x[1][0]) - bulge, 0.5 * (x[0][1] + x[1][1]) + bulge];
    }
    x
}

fn sum(f: &EdgeForce) -> [f64; 2] {
    [f[0][0] + f[1][0] + f[2][0], f[0][1] + f[1][1] + f[2][1]]
}

/// Moment of the nodal forces and moments about the origin.
fn moment(f: &EdgeForce, x: &[[f64; 2]; 3]) -> f64 {
    (0..3).map(|a| x[a][0] * f[a][1] - x[a][1] * f[a][0] + f[a][2]).sum()
}

#[test]
fn a_uniform_traction_has_its_resultant_and_its_end_moments() {
    let mut random = Random::new(10);
    for edge in edges().iter().filter(|e| e.n_nodes == 2) {
        let x = place(edge, &mut random);
        let t = [random.signed(), random.signed()];
        let f = traction(edge, &x, t);
        let e = [x[1][0] - x[0][0], x[1][1] - x[0][1]];
        let length = e[0].hypot(e[1]);
        let total = sum(&f);
        let middle = [0.5 * (x[0][0] + x[1][0]), 0.5 * (x[0][1] + x[1][1])];
        for i in 0..2 {
            assert!((total[i] - 1.7 * length * t[i]).abs() < ROUNDOFF);
        }
        let expected = 1.7 * length * (middle[0] * t[1] - middle[1] * t[0]);
        assert!((moment(&f, &x) - expected).abs() < ROUNDOFF);
        // The element lies on the left, so the outward normal is (e_y, -e_x) / l.
        let q = (t[0] * e[1] - t[1] * e[0]) / length;
        let end = edge.alpha_b * q * 1.7 * length * length / 12.0;
        assert!((f[1][2] - end).abs() < ROUNDOFF && (f[0][2] + end).abs() < ROUNDOFF);
    }
}

#[test]
fn quadratic_edges_take_one_four_one() {
    let edge = &edges()[3];
    let x = [[0.0, 0.0], [3.0, 0.0], [1.5, 0.0]];
    let f = traction(edge, &x, [0.0, -2.0]);
    for (a, share) in [(0, 1.0 / 6.0), (1, 1.0 / 6.0), (2, 4.0 / 6.0)] {
        assert!((f[a][1] + share * 3.0 * 1.7 * 2.0).abs() < ROUNDOFF);
    }
}

#[test]
fn pressure_on_a_straight_edge_is_a_traction_into_the_element() {
    let mut random = Random::new(11);
    for edge in &edges() {
        let mut x = place(edge, &mut random);
        x[2] = [0.5 * (x[0][0] + x[1][0]), 0.5 * (x[0][1] + x[1][1])];
        let e = [x[1][0] - x[0][0], x[1][1] - x[0][1]];
        let length = e[0].hypot(e[1]);
        let p = 0.8;
        let inward = [-e[1] / length * p, e[0] / length * p];
        let (f, _) = pressure(edge, &x, p);
        let expected = traction(edge, &x, inward);
        for a in 0..edge.n_nodes {
            for i in 0..3 {
                assert!((f[a][i] - expected[a][i]).abs() < ROUNDOFF, "{edge:?} node {a} dof {i}");
            }
        }
    }
}

#[test]
fn pressure_around_a_closed_curve_balances() {
    let mut random = Random::new(12);
    for edge in &edges() {
        let corners: Vec<[f64; 2]> = (0..5)
            .map(|k| {
                let (s, c) = (f64::from(k) * 0.4 * std::f64::consts::PI).sin_cos();
                [c + 0.1 * random.signed(), s + 0.1 * random.signed()]
            })
            .collect();
        let (mut total, mut turning) = ([0.0; 2], 0.0);
        for k in 0..5 {
            let (a, b) = (corners[k], corners[(k + 1) % 5]);
            let c = [0.5 * (a[0] + b[0]) + 0.05, 0.5 * (a[1] + b[1]) - 0.03];
            let x = [a, b, if edge.n_nodes == 3 { c } else { [0.0; 2] }];
            let (f, _) = pressure(edge, &x, 1.3);
            let part = sum(&f);
            total = [total[0] + part[0], total[1] + part[1]];
            turning += moment(&f, &x);
        }
        assert!(total[0].abs() + total[1].abs() + turning.abs() < ROUNDOFF, "{edge:?}");
    }
}

#[test]
fn load_stiffness_is_the_derivative_of_the_pressure_force() {
    let mut random = Random::new(13);
    for edge in &edges() {
        let x = place(edge, &mut random);
        let (_, k) = pressure(edge, &x, 1.1);
        for b in 0..edge.n_nodes {
            for j in 0..2 {
                // The force is quadratic in the positions: central differences are exact.
                let (mut low, mut high) = (x, x);
                low[b][j] -= 0.5;
                high[b][j] += 0.5;
                let (below, above) = (pressure(edge, &low, 1.1).0, pressure(edge, &high, 1.1).0);
                for a in 0..edge.n_nodes {
                    for i in 0..3 {
                        let slope = above[a][i] - below[a][i];
                        assert!((slope - k[a][b][i][j]).abs() < 10.0 * ROUNDOFF, "{edge:?}");
                    }
                }
            }
        }
    }
}
