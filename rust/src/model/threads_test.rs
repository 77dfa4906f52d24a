//! Sums do not depend on the number of threads, to the last bit.
// SPDX-License-Identifier: BSD-3-Clause

use super::build::{BlockInput, Options};
use super::chunk::Kinematics;
use super::problem::Problem;
use crate::materials::Plane;

/// A sheet of quadrilaterals, numbered at random if that is wanted.
fn sheet(n: usize, shuffled: bool) -> Problem {
    let points = (n + 1) * (n + 1);
    let step = if shuffled { 10_007 } else { 1 };
    let number = |k: usize| k * step % points;
    let mut x = vec![[0.0; 2]; points];
    for k in 0..points {
        let (i, j) = (k % (n + 1), k / (n + 1));
        x[number(k)] = [i as f64 + 0.1 * (j as f64).sin(), j as f64];
    }
    let cell = |e: usize| {
        let e = e * step % (n * n);
        let k = e % n + e / n * (n + 1);
        [k, k + 1, k + n + 2, k + n + 1].map(|k| number(k) as u32)
    };
    let input = BlockInput {
        element: "Q4I".into(),
        law: "elastic".into(),
        parameters: vec![1000.0, 0.3],
        plane: Plane::Stress,
        ring: false,
        local_strain: "green_lagrange".into(),
        thickness: 1.0,
        nodal_thickness: Vec::new(),
        sides: Vec::new(),
        profile: [0.0; 3],
        table: Vec::new(),
        fibers: vec![],
        rho: 1.0,
        nodal_density: Vec::new(),
        by_temperature: Vec::new(),
        options: Options::default(),
        nodes: (0..n * n).flat_map(cell).collect(),
    };
    Problem::new(x, &[input], &[]).unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for shuffled in [false, true] {
        let run = |threads: usize| {
            let mut problem = sheet(60, shuffled);
            problem.set_threads(threads);
            let (n, nnz) = (problem.dofs.n_dofs(), problem.dofs.indices.len());
            let u: Vec<f64> = (0..n).map(|i| 0.1 * (i as f64).cos()).collect();
            let mut out = [vec![0.0; n], vec![0.0; n], vec![0.0; nnz]];
            let [force, scale, values] = &mut out;
            problem.assemble(&u, Kinematics::Finite, force, scale, values).unwrap();
            out.map(|v| v.into_iter().map(f64::to_bits).collect::<Vec<_>>())
        };
        let one = run(1);
        for threads in [2, 3, 8] {
            assert!(run(threads) == one, "{threads} threads, shuffled {shuffled}");
        }
    }
}

#[test]
fn any_number_of_threads_recovers_the_same_bits() {
    let run = |threads: usize| {
        let mut problem = sheet(60, true);
        problem.set_threads(threads);
        let u: Vec<f64> = (0..problem.dofs.n_dofs()).map(|i| 0.1 * (i as f64).cos()).collect();
        let f = problem.recover(&u, true).remove(0);
        let sums = vec![f.total_energy(), f.largest_strain];
        let all = [f.points, f.stress, f.strain, f.mises, f.energy, f.volume, f.rotation, sums];
        all.map(|v| v.into_iter().map(f64::to_bits).collect::<Vec<_>>())
    };
    let one = run(1);
    // Nothing is left out: neighbors differ.
    assert!(one.iter().take(5).all(|v| v.windows(2).all(|w| w[0] != w[1])));
    for threads in [2, 3, 8] {
        assert!(run(threads) == one, "{threads} threads");
    }
}
