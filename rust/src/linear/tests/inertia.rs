// SPDX-License-Identifier: BSD-3-Clause
//! Signs of the pivots against dense eigenvalues.

use super::super::{Inertia, Ldlt, LinearSolver};
use super::{Random, Symmetric, Upper};

fn signs(a: &Symmetric) -> (Inertia, f64) {
    let values = a.eigenvalues();
    let size = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let least = values.iter().fold(f64::INFINITY, |m, v| m.min(v.abs()));
    let positive = values.iter().filter(|&&v| v > 0.0).count();
    (Inertia { positive, negative: values.len() - positive, zero: 0 }, least / size)
}

fn factorized(upper: &Upper) -> Inertia {
    let mut solver = Ldlt::default();
    solver.analyze(&upper.pattern()).unwrap();
    solver.factorize(&upper.values).unwrap().unwrap()
}

#[test]
fn random_indefinite() {
    let mut random = Random::new(1);
    for case in 0..300 {
        let n = 1 + random.below(40);
        let shift = [0.0, 3.0, -3.0, 0.5][case % 4];
        let a = Symmetric::random(n, 0.25, shift, &mut random);
        let (expected, least) = signs(&a);
        assert!(least > 1e-13, "case {case} is singular by chance");
        assert_eq!(factorized(&a.upper(1 + case % 3)), expected, "case {case}, n = {n}");
    }
}

#[test]
fn nearly_singular() {
    // The last eigenvalue is moved to +-1e-9 of the largest by a shift of the diagonal.
    let mut random = Random::new(2);
    for case in 0..120 {
        let n = 4 + random.below(25);
        let mut a = Symmetric::random(n, 0.4, 0.0, &mut random);
        let mut values = a.eigenvalues();
        values.sort_by(f64::total_cmp);
        let target = values[random.below(n)];
        let size = values[0].abs().max(values[n - 1].abs());
        let side = if case % 2 == 0 { 1e-9 } else { -1e-9 };
        for i in 0..n {
            a.add(i, i, side * size - target);
        }
        let (expected, least) = signs(&a);
        assert!(least < 1e-8, "case {case} is not nearly singular");
        assert_eq!(factorized(&a.upper(1)), expected, "case {case}");
    }
}

#[test]
fn zero_diagonal() {
    // Saddle points [[K, G], [Gt, 0]] and bare couplings [[0, B], [Bt, 0]].
    let mut random = Random::new(3);
    for case in 0..150 {
        let n = 4 + random.below(20);
        let m = 1 + random.below(n / 2);
        let mut a = Symmetric::zero(n + m);
        for j in 0..n {
            if case % 3 != 0 {
                a.add(j, j, 2.0 + random.signed());
                if j > 0 {
                    a.add(j - 1, j, random.signed());
                }
            }
        }
        for k in 0..m {
            a.add(n + k, n + k, 0.0);
            a.add((2 * k) % n, n + k, 1.0 + random.signed().abs());
            a.add((2 * k + 1) % n, n + k, random.signed());
        }
        if case % 3 == 0 {
            // n - m of the first equations are coupled to nothing: hold them.
            for j in 0..n {
                a.add(j, j, if j % 2 == 0 { 0.0 } else { 1e-3 });
            }
        }
        let (expected, least) = signs(&a);
        if least < 1e-12 {
            continue;
        }
        let mut upper = a.upper(1);
        assert_eq!(factorized(&upper), expected, "case {case}");
        upper.after = (n as u32..(n + m) as u32).collect();
        assert_eq!(factorized(&upper), expected, "case {case}, multipliers named");
    }
}

#[test]
fn units_do_not_matter() {
    let mut random = Random::new(4);
    for case in 0..60 {
        let n = 3 + random.below(25);
        let a = Symmetric::random(n, 0.3, 0.0, &mut random);
        let (expected, _) = signs(&a);
        let mut upper = a.upper(1);
        let units: Vec<f64> = (0..n).map(|_| 10.0_f64.powf(6.0 * random.signed())).collect();
        for c in 0..n {
            for k in upper.col_ptr[c]..upper.col_ptr[c + 1] {
                upper.values[k] *= units[c] * units[upper.row_idx[k] as usize];
            }
        }
        assert_eq!(factorized(&upper), expected, "case {case}");
    }
}
