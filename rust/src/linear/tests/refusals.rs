// SPDX-License-Identifier: BSD-3-Clause
//! What has no answer is refused, with the equation named, before any number is returned.

use super::super::{Ldlt, LinearError, LinearSolver, Lu, Pattern, Singular};
use super::models::{Model, dense};
use super::{Random, Symmetric, Upper};

fn refused(upper: &Upper) -> Singular {
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    match solver.factorize(&upper.values) {
        Err(LinearError::Singular(s)) => s,
        other => panic!("not refused: {other:?}"),
    }
}

/// Each mode is a null vector and the equation named moves fully in the first.
fn check_modes(upper: &Upper, s: &Singular, count: usize) {
    assert_eq!(s.nullity, count);
    let n = upper.node.len();
    assert_eq!(s.modes.len(), n * count);
    assert!((s.modes[s.equation].abs() - 1.0).abs() < 1e-12);
    let (mut product, mut size) = (vec![0.0; n], vec![0.0; n]);
    for mode in s.modes.chunks(n) {
        product.fill(0.0);
        size.fill(0.0);
        for c in 0..n {
            for k in upper.col_ptr[c]..upper.col_ptr[c + 1] {
                let (r, v) = (upper.row_idx[k] as usize, upper.values[k]);
                product[r] += v * mode[c];
                size[r] += v.abs();
                if r != c {
                    product[c] += v * mode[r];
                    size[c] += v.abs();
                }
            }
        }
        for (p, s) in product.iter().zip(&size) {
            assert!(p.abs() <= 1e-8 * s, "not a null vector: {p:e} of {s:e}");
        }
    }
}

#[test]
fn free_bodies() {
    let mut random = Random::new(21);
    for case in 0..50 {
        let (nx, ny) = (1 + random.below(40), 1 + random.below(20));
        let upper = Model::rectangle(nx, ny, 1.0, &mut random).upper(&[]);
        let s = refused(&upper);
        assert_eq!(s.nullity, 3, "case {case}: {nx} x {ny}");
        check_modes(&upper, &s, 3);
    }
}

#[test]
fn one_support_short() {
    let mut random = Random::new(22);
    for case in 0..50 {
        let (nx, ny) = (1 + random.below(40), 1 + random.below(20));
        let model = Model::rectangle(nx, ny, 1.0, &mut random);
        let node = random.below(model.n_nodes);
        // A pin lets the body turn; two rollers of one direction let it slide.
        let fixed = if case % 2 == 0 {
            vec![2 * node, 2 * node + 1]
        } else {
            let column = node % (ny + 1);
            vec![2 * column + 1, 2 * (column + nx * (ny + 1)) + 1]
        };
        let upper = model.upper(&fixed);
        check_modes(&upper, &refused(&upper), 1);
    }
}

#[test]
fn mechanisms() {
    let mut random = Random::new(23);
    for case in 0..50 {
        // A held plate with a second one on a hinge, or with a loose truss node.
        let (nx, ny) = (2 + random.below(12), 1 + random.below(8));
        let mut model = Model::rectangle(nx, ny, 1.0, &mut random);
        let first = model.n_nodes;
        let fixed: Vec<usize> = (0..2 * (ny + 1)).collect();
        let corner = first - 1;
        if case % 2 == 0 {
            let (mx, my) = (1 + random.below(10), 1 + random.below(6));
            model.n_nodes += (mx + 1) * (my + 1) - 1;
            let at = |i: usize, j: usize| {
                let k = i * (my + 1) + j;
                if k == 0 { corner } else { first + k - 1 }
            };
            for i in 0..mx {
                for j in 0..my {
                    model.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], 1.0);
                }
            }
        } else {
            model.n_nodes += 1;
            let angle = random.signed();
            model.bar(corner, first, (angle.cos(), angle.sin()), 1.0);
        }
        let upper = model.upper(&fixed);
        let s = refused(&upper);
        assert!(s.equation >= 2 * first - fixed.len(), "case {case}: names the held plate");
        check_modes(&upper, &s, 1);
    }
}

#[test]
fn loose_node_deep_in_a_large_model() {
    // The column without stiffness travels through all pieces up to the root.
    let mut model = Model::rectangle(120, 120, 0.5, &mut Random::new(29));
    let (inside, loose) = (121 * 60 + 60, model.n_nodes);
    model.n_nodes += 1;
    model.bar(inside, loose, (0.6, 0.8), 1.0);
    let fixed: Vec<usize> = (0..242).collect();
    let upper = model.upper(&fixed);
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    for threads in [1, 2] {
        solver.set_threads(threads);
        match solver.factorize(&upper.values) {
            Err(LinearError::Singular(s)) => {
                assert!(s.equation >= upper.node.len() - 2, "names the loose node");
                check_modes(&upper, &s, 1);
            }
            other => panic!("not refused: {other:?}"),
        }
    }
}

#[test]
fn well_held_models_pass() {
    let mut random = Random::new(24);
    for case in 0..50 {
        let (nx, ny) = (1 + random.below(60), 1 + random.below(10));
        let model = Model::rectangle(nx, ny, 1.0, &mut random);
        let upper = model.upper(&[0, 1, 2 * model.n_nodes - 1]);
        let mut solver = Ldlt::default();
        solver.analyze(&upper.pattern()).unwrap();
        let inertia = solver.factorize(&upper.values).unwrap().unwrap();
        assert_eq!(inertia.positive, upper.node.len(), "case {case}");
        let mut x = vec![1.0; upper.node.len()];
        solver.solve(&mut x).unwrap();
    }
}

#[test]
fn slender_cantilever_passes() {
    // Length over height of a thousand: soft, but not singular.
    let upper = Model::rectangle(2000, 2, 0.0, &mut Random::new(25)).upper(&[0, 1, 2, 3, 4, 5]);
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    let inertia = solver.factorize(&upper.values).unwrap().unwrap();
    assert_eq!(inertia.positive, upper.node.len());
}

#[test]
fn node_without_stiffness() {
    let mut model = Model::rectangle(4, 4, 0.0, &mut Random::new(26));
    model.n_nodes += 1;
    for d in [50_u32, 51] {
        model.triplets.push((d, d, 0.0));
    }
    let upper = model.upper(&(0..10).collect::<Vec<_>>());
    let s = refused(&upper);
    assert!(s.equation >= upper.node.len() - 2);
    check_modes(&upper, &s, 2);
}

#[test]
fn dependent_multipliers() {
    let mut random = Random::new(27);
    let model = Model::rectangle(4, 3, 0.0, &mut random);
    let plate = dense(&model.upper(&(0..8).collect::<Vec<_>>()));
    let n = plate.n;
    let mut a = Symmetric::zero(n + 2);
    for j in 0..n {
        for i in 0..=j {
            a.add(i, j, plate.dense[i + j * n]);
        }
    }
    for k in n..n + 2 {
        a.add(k, k, 0.0);
        a.add(3, k, 1.0);
        a.add(7, k, -1.0);
    }
    let mut upper = a.upper(1);
    upper.after = vec![n as u32, n as u32 + 1];
    let s = refused(&upper);
    assert!(s.equation >= n, "the multipliers are what is not determined");
    check_modes(&upper, &s, 1);
}

#[test]
fn numbers_that_are_none() {
    let upper = Model::rectangle(5, 5, 0.0, &mut Random::new(28)).upper(&[0, 1, 2, 3]);
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut values = upper.values.clone();
        let (c, k) = (20, upper.col_ptr[20] + 1);
        values[k] = bad;
        let row = upper.row_idx[k] as usize;
        assert_eq!(solver.factorize(&values), Err(LinearError::NotFinite { row, column: c }));
    }
    solver.factorize(&upper.values).unwrap();
    let mut b = vec![1.0; upper.node.len()];
    b[7] = f64::NAN;
    assert_eq!(solver.solve(&mut b), Err(LinearError::RhsNotFinite { equation: 7 }));
}

#[test]
fn calls_out_of_order_and_bad_patterns() {
    let mut solver = Ldlt::default();
    assert!(matches!(solver.solve(&mut [1.0]), Err(LinearError::Order(_))));
    let refuses = |col_ptr: &[usize], row_idx: &[u32], node: &[u32]| {
        let pattern = Pattern { col_ptr, row_idx, node_of_dof: node, after: &[] };
        matches!(Ldlt::default().analyze(&pattern), Err(LinearError::Pattern(_)))
    };
    assert!(refuses(&[0, 1, 3], &[0, 1, 0], &[0, 0]), "rows fall");
    assert!(refuses(&[0, 2, 3], &[0, 1, 1], &[0, 0]), "below the diagonal");
    assert!(refuses(&[0, 1, 2], &[0, 1], &[0]), "too few nodes");
    assert!(refuses(&[0, 1, 1], &[0, 1], &[0, 0]), "entries left over");
    assert!(!refuses(&[0, 1, 3], &[0, 0, 1], &[0, 0]));
    assert!(!refuses(&[0], &[], &[]), "no equations at all");
}

#[test]
fn singular_lu() {
    let col_ptr = [0, 2, 4];
    let pattern =
        Pattern { col_ptr: &col_ptr, row_idx: &[0, 1, 0, 1], node_of_dof: &[0, 0], after: &[] };
    let mut solver = Lu::default();
    solver.analyze(&pattern).unwrap();
    let made = solver.factorize(&[1.0, 2.0, 2.0, 4.0]);
    let refused = made.and_then(|_| solver.solve(&mut [1.0, 3.0]));
    assert!(matches!(refused, Err(LinearError::Singular(_))), "{refused:?}");
}
