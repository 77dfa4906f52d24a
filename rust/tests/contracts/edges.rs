//! Edge loads: resultants, end moments and load stiffness, undeformed and where an edge moved.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::Random;
use corota::loads::edge::{Edge, EdgeForce, EdgeStiffness, Place, pressure, traction};

const ROUNDOFF: f64 = 1e-13;
const THICKNESS: f64 = 1.7;

/// A random undeformed edge of each kind, straight where it has two nodes.
fn edges(random: &mut Random) -> [Edge; 4] {
    [(2, 0.0), (2, 1.0), (2, 1.5), (3, 0.0)].map(|(n_nodes, alpha_b)| Edge {
        nodes: [0, 1, 2],
        n_nodes,
        thickness: [THICKNESS; 3],
        alpha_b,
        x: positions(n_nodes, random),
        ring: false,
    })
}

fn positions(n_nodes: usize, random: &mut Random) -> [[f64; 2]; 3] {
    let mut x = [[random.signed(), random.signed()], [2.0, random.signed()], [0.0; 2]];
    if n_nodes == 3 {
        let bulge = 0.1 * random.signed();
        x[2] = middle(&x).map(|m| m + bulge);
    }
    x
}

/// An edge somewhere else, with end rotations if it has any.
fn moved(edge: &Edge, random: &mut Random) -> Place {
    let differ = if edge.alpha_b > 0.0 { random.signed() } else { 0.0 };
    Place { x: positions(edge.n_nodes, random), differ }
}

fn middle(x: &[[f64; 2]; 3]) -> [f64; 2] {
    [0.5 * (x[0][0] + x[1][0]), 0.5 * (x[0][1] + x[1][1])]
}

fn chord(x: &[[f64; 2]; 3]) -> ([f64; 2], f64) {
    let e = [x[1][0] - x[0][0], x[1][1] - x[0][1]];
    (e, e[0].hypot(e[1]))
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
    for edge in edges(&mut random).iter().filter(|e| e.n_nodes == 2) {
        let t = [random.signed(), random.signed()];
        let (f, _) = traction(edge, &edge.undeformed(), t);
        let (e, length) = chord(&edge.x);
        let total = sum(&f);
        let middle = middle(&edge.x);
        for i in 0..2 {
            assert!((total[i] - THICKNESS * length * t[i]).abs() < ROUNDOFF);
        }
        let expected = THICKNESS * length * (middle[0] * t[1] - middle[1] * t[0]);
        assert!((moment(&f, &edge.x) - expected).abs() < ROUNDOFF);
        // The element lies on the left, so the outward normal is (e_y, -e_x) / l.
        let q = (t[0] * e[1] - t[1] * e[0]) / length;
        let end = edge.alpha_b * q * THICKNESS * length * length / 12.0;
        assert!((f[1][2] - end).abs() < ROUNDOFF && (f[0][2] + end).abs() < ROUNDOFF);
    }
}

#[test]
fn a_dead_traction_keeps_its_resultant_and_its_end_moments_turn_with_the_edge() {
    let mut random = Random::new(14);
    for edge in &edges(&mut random) {
        let at = moved(edge, &mut random);
        let t = [random.signed(), random.signed()];
        let (f, _) = traction(edge, &at, t);
        let total = sum(&f);
        let expected = sum(&traction(edge, &edge.undeformed(), t).0);
        for i in 0..2 {
            assert!((total[i] - expected[i]).abs() < ROUNDOFF, "{edge:?}");
        }
        // Work on a bulge of the undeformed size along the current normal.
        let (e, length) = chord(&at.x);
        let q = (t[0] * e[1] - t[1] * e[0]) / length;
        let end = edge.alpha_b * q * THICKNESS * chord(&edge.x).1.powi(2) / 12.0;
        assert!((f[1][2] - end).abs() < ROUNDOFF && (f[0][2] + end).abs() < ROUNDOFF);
    }
}

#[test]
fn quadratic_edges_take_one_four_one() {
    let mut edge = edges(&mut Random::new(10))[3].clone();
    edge.x = [[0.0, 0.0], [3.0, 0.0], [1.5, 0.0]];
    let (f, _) = traction(&edge, &edge.undeformed(), [0.0, -2.0]);
    for (a, share) in [(0, 1.0 / 6.0), (1, 1.0 / 6.0), (2, 4.0 / 6.0)] {
        assert!((f[a][1] + share * 3.0 * THICKNESS * 2.0).abs() < ROUNDOFF);
    }
}

#[test]
fn pressure_on_a_straight_edge_is_a_traction_into_the_element() {
    let mut random = Random::new(11);
    for mut edge in edges(&mut random) {
        let m = middle(&edge.x);
        edge.x[2] = m;
        let (e, length) = chord(&edge.x);
        let p = 0.8;
        let inward = [-e[1] / length * p, e[0] / length * p];
        let (f, _) = pressure(&edge, &edge.undeformed(), p);
        let (expected, _) = traction(&edge, &edge.undeformed(), inward);
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
    for edge in &edges(&mut random) {
        let corners: Vec<[f64; 2]> = (0..5)
            .map(|k| {
                let (s, c) = (f64::from(k) * 0.4 * std::f64::consts::PI).sin_cos();
                [c + 0.1 * random.signed(), s + 0.1 * random.signed()]
            })
            .collect();
        let (mut total, mut rotation_sum) = ([0.0; 2], 0.0);
        for k in 0..5 {
            let (a, b) = (corners[k], corners[(k + 1) % 5]);
            let c = [0.5 * (a[0] + b[0]) + 0.05, 0.5 * (a[1] + b[1]) - 0.03];
            let x = [a, b, if edge.n_nodes == 3 { c } else { [0.0; 2] }];
            let (f, _) = pressure(edge, &Place { x, ..moved(edge, &mut random) }, 1.3);
            let part = sum(&f);
            total = [total[0] + part[0], total[1] + part[1]];
            rotation_sum += moment(&f, &x);
        }
        assert!(total[0].abs() + total[1].abs() + rotation_sum.abs() < ROUNDOFF, "{edge:?}");
    }
}

/// Central difference of fourth order of a load by displacement or rotation `j` of node `b`.
fn slope(at: &Place, b: usize, j: usize, load: impl Fn(&Place) -> EdgeForce) -> EdgeForce {
    const STEP: f64 = 1e-3;
    let mut slope = EdgeForce::default();
    for (steps, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
        let mut there = *at;
        if j < 2 {
            there.x[b][j] += steps * STEP;
        } else {
            there.differ += [1.0, -1.0, 0.0][b] * steps * STEP;
        }
        let f = load(&there);
        for a in 0..3 {
            for i in 0..3 {
                slope[a][i] += weight * f[a][i] / (12.0 * STEP);
            }
        }
    }
    slope
}

#[test]
fn load_stiffness_is_the_derivative_of_the_force() {
    let mut random = Random::new(13);
    for edge in &edges(&mut random) {
        let at = moved(edge, &mut random);
        let t = [random.signed(), random.signed()];
        let loads: [&dyn Fn(&Place) -> (EdgeForce, EdgeStiffness); 2] =
            [&|at| pressure(edge, at, 1.1), &|at| traction(edge, at, t)];
        for load in loads {
            let (_, k) = load(&at);
            for b in 0..edge.n_nodes {
                for j in 0..3 {
                    let expected = slope(&at, b, j, |there| load(there).0);
                    for a in 0..edge.n_nodes {
                        for i in 0..3 {
                            assert!((expected[a][i] - k[a][b][i][j]).abs() < 1e-9, "{edge:?}");
                        }
                    }
                }
            }
        }
    }
}
