// SPDX-License-Identifier: BSD-3-Clause
//! Backward error of all solvers, agreement among them, and one answer for any threads.

use super::super::{Ldlt, LinearSolver, Lu, Pattern};
use super::models::{Model, dense};
use super::{Random, Symmetric};

fn vector(n: usize, random: &mut Random) -> Vec<f64> {
    (0..n).map(|_| random.signed()).collect()
}

#[test]
fn symmetric_backward_error() {
    let mut random = Random::new(11);
    for case in 0..200 {
        let n = 1 + random.below(60);
        let a = Symmetric::random(n, 0.2, [0.0, 4.0][case % 2], &mut random);
        let upper = a.upper(1 + case % 3);
        let mut solver = Ldlt::default();
        solver.analyze(&upper.pattern()).unwrap();
        solver.factorize(&upper.values).unwrap();
        let b = [vector(n, &mut random), vector(n, &mut random)].concat();
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        for (x, b) in x.chunks(n).zip(b.chunks(n)) {
            let error = a.backward_error(x, b);
            assert!(error < 1e-14, "case {case}: {error:e}");
        }
    }
}

#[test]
fn saddle_points_with_exchanges() {
    let mut random = Random::new(12);
    for case in 0..60 {
        // Two plates held by multipliers only: nothing can be eliminated in plain order.
        let model = Model::rectangle(3 + case % 5, 3, 1.0, &mut random);
        let plate = dense(&model.upper(&[]));
        let n = plate.n;
        let m = 3 + random.below(n / 4);
        let mut a = Symmetric::zero(n + m);
        for j in 0..n {
            for i in 0..=j {
                if plate.dense[i + j * n] != 0.0 {
                    a.add(i, j, plate.dense[i + j * n]);
                }
            }
        }
        for k in 0..m {
            a.add(n + k, n + k, 0.0);
            for _ in 0..3 {
                a.add(random.below(n), n + k, random.signed());
            }
        }
        let mut upper = a.upper(1);
        if case % 2 == 0 {
            upper.after = (n as u32..(n + m) as u32).collect();
        }
        let mut solver = Ldlt::default();
        solver.analyze(&upper.pattern()).unwrap();
        let inertia = solver.factorize(&upper.values).unwrap().unwrap();
        assert_eq!((inertia.positive, inertia.negative), (n, m), "case {case}");
        let b = vector(n + m, &mut random);
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        let error = a.backward_error(&x, &b);
        assert!(error < 1e-14, "case {case}: {error:e}");
    }
}

#[test]
fn pivoting_lu_takes_over() {
    let mut random = Random::new(13);
    let a = Symmetric::random(30, 0.3, 0.0, &mut random);
    let upper = a.upper(1);
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    solver.factorize(&upper.values).unwrap();
    let b = vector(30, &mut random);
    let x = solver.solve_without_ldlt(&b).unwrap();
    let error = a.backward_error(&x, &b);
    assert!(error < 1e-14, "{error:e}");
}

#[test]
fn threads_do_not_change_a_bit() {
    let mut random = Random::new(15);
    let upper = Model::rectangle(150, 150, 0.5, &mut random).upper(&(0..302).collect::<Vec<_>>());
    let b = vector(upper.node.len(), &mut random);
    let mut first: Option<Vec<f64>> = None;
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    assert!(solver.pieces() > 8, "the tree must be cut for this test to mean anything");
    for threads in [1, 2, 3, 8] {
        solver.set_threads(threads);
        solver.factorize(&upper.values).unwrap();
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        let reference = first.get_or_insert_with(|| x.clone());
        assert!(x.iter().zip(reference).all(|(p, q)| p.to_bits() == q.to_bits()));
    }
}

#[test]
fn large_saddle_point_with_any_threads() {
    // A free plate held by multipliers alone, some far apart: columns wait in many fronts.
    let mut random = Random::new(17);
    let model = Model::rectangle(110, 110, 0.5, &mut random);
    let mut upper = model.upper(&[]);
    let n = upper.node.len();
    for k in 0..40 {
        let tied = if k < 4 { [2 * k, n - 1 - 31 * k] } else { [97 * k, 97 * k + 222 + 5 * k] };
        for (row, value) in tied.iter().zip([1.0, if k < 4 { 0.5 } else { -1.0 }]) {
            upper.row_idx.push(*row as u32);
            upper.values.push(value);
        }
        upper.col_ptr.push(upper.row_idx.len());
        upper.node.push((n + k) as u32);
        upper.after.push((n + k) as u32);
    }
    let b = vector(n + 40, &mut random);
    for named in [true, false] {
        if !named {
            upper.after.clear();
        }
        let mut solver = Ldlt::default();
        solver.analyze(&upper.pattern()).unwrap();
        let mut first: Option<Vec<f64>> = None;
        for threads in [1, 2, 3] {
            solver.set_threads(threads);
            let inertia = solver.factorize(&upper.values).unwrap().unwrap();
            assert_eq!((inertia.positive, inertia.negative, inertia.zero), (n, 40, 0));
            let mut x = b.clone();
            solver.solve(&mut x).unwrap(); // refuses a backward error above 1e-9 itself
            let reference = first.get_or_insert_with(|| x.clone());
            assert!(x.iter().zip(reference).all(|(p, q)| p.to_bits() == q.to_bits()));
        }
    }
}

#[test]
fn unsymmetric_backward_error() {
    let mut random = Random::new(16);
    for case in 0..100 {
        let n = 1 + random.below(50);
        let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
        let mut rows = vec![0.0; n * n];
        for c in 0..n {
            for r in 0..n {
                if r == c || random.signed().abs() < 0.2 {
                    let v = random.signed() * if case % 2 == 0 { 1.0 } else { 1e6 };
                    row_idx.push(r as u32);
                    values.push(v);
                    rows[r * n + c] = v;
                }
            }
            col_ptr.push(row_idx.len());
        }
        let node: Vec<u32> = (0..n as u32).collect();
        let pattern =
            Pattern { col_ptr: &col_ptr, row_idx: &row_idx, node_of_dof: &node, after: &[] };
        let mut solver = Lu::default();
        solver.analyze(&pattern).unwrap();
        assert_eq!(solver.factorize(&values).unwrap(), None);
        let b = vector(n, &mut random);
        let mut x = b.clone();
        solver.solve(&mut x).unwrap();
        let (mut residual, mut size) = (0.0_f64, 0.0_f64);
        for r in 0..n {
            let row = &rows[r * n..(r + 1) * n];
            let sum: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            residual = residual.max((sum - b[r]).abs());
            size = size.max(row.iter().zip(&x).map(|(a, x)| (a * x).abs()).sum::<f64>());
        }
        assert!(residual < 1e-13 * (size + 1.0), "case {case}: {residual:e} of {size:e}");
    }
}
