// SPDX-License-Identifier: BSD-3-Clause
//! Motions without stiffness, found from a factorization at little cost.
//!
//! A small pivot alone says little: rounding leaves a free rotation a pivot of
//! 1e-6 or more when the nodes eliminated last stand close together. So every
//! front with a small pivot gets a few steps of inverse iteration on its own
//! columns, and what costs almost nothing there is carried down to the whole
//! model. Its energy over its squared length is compared with rounding.

use super::backsolve::Backsolve;
use super::delayed_pivots::Special;

/// Fronts with a pivot below this (of a unit diagonal) are looked at.
const SUSPECT_PIVOT: f64 = 1e-4;
/// Stiffness of a front's motion below which it is carried down to the model.
const SUSPECT_FRONT: f64 = 1e-9;
/// Steps of inverse iteration on a front.
const STEPS: usize = 4;
/// Most motions looked for.
pub const MOST: usize = 6;

/// A motion and its stiffness: energy over squared length, both in scaled equations.
pub struct Motion {
    pub stiffness: f64,
    /// In elimination order.
    pub vector: Vec<f64>,
}

/// Motions with a stiffness of at most `limit`, softest front last eliminated first.
pub fn motions(solve: &Backsolve<'_>, limit: f64) -> Vec<Motion> {
    let sym = solve.symbolic;
    let mut found: Vec<Motion> = Vec::new();
    for s in (0..sym.fronts.len()).rev() {
        if found.len() >= MOST {
            break;
        }
        if let Some(special) = &solve.numeric.special[s] {
            from_special(solve, special, limit, &mut found);
            continue;
        }
        let f = &sym.fronts[s];
        let d = &solve.numeric.d[f.first..f.first + f.width];
        if d.iter().all(|v| v.abs() >= SUSPECT_PIVOT) {
            continue;
        }
        let panel = &solve.numeric.panels[sym.panel_range(s)];
        let front = FrontMatrix { panel, height: f.height(), d };
        for y in front.soft_motions() {
            let x = front.transposed(&y);
            let energy: f64 = x.iter().zip(d).map(|(v, d)| d * v * v).sum();
            let mut vector = vec![0.0; sym.n];
            vector[f.first..f.first + f.width].copy_from_slice(&x);
            assess(solve, vector, energy, limit, &mut found);
        }
    }
    found
}

/// Carries a motion of a front down to the model and keeps it if it costs nothing.
fn assess(
    solve: &Backsolve<'_>,
    mut vector: Vec<f64>,
    energy: f64,
    limit: f64,
    found: &mut Vec<Motion>,
) {
    solve.backward_whole(&mut vector);
    let square: f64 = vector.iter().map(|v| v * v).sum();
    let stiffness = energy.abs() / square;
    if stiffness <= limit && found.len() < MOST {
        found.push(Motion { stiffness, vector });
    }
}

fn from_special(solve: &Backsolve<'_>, special: &Special, limit: f64, found: &mut Vec<Motion>) {
    let start = |parts: &[(usize, f64)]| {
        let mut vector = vec![0.0; solve.symbolic.n];
        for &(k, v) in parts {
            vector[special.equations[k] as usize] = v;
        }
        vector
    };
    for k in special.pivots..special.pivots + special.null {
        assess(solve, start(&[(k, 1.0)]), 0.0, limit, found);
    }
    // Soft directions of D: its small pivots, and the eigenvectors of small 2x2 pivots.
    let mut soft: Vec<(f64, Vec<(usize, f64)>)> = Vec::new();
    let mut k = 0;
    while k < special.pivots {
        let (a, b) = (special.d[k], special.e[k]);
        if b == 0.0 {
            soft.push((a, vec![(k, 1.0)]));
            k += 1;
            continue;
        }
        let c = special.d[k + 1];
        let angle = 0.5 * (2.0 * b).atan2(a - c);
        let (sin, cos) = angle.sin_cos();
        let (mean, radius) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
        soft.push((mean + radius, vec![(k, cos), (k + 1, sin)]));
        soft.push((mean - radius, vec![(k, -sin), (k + 1, cos)]));
        k += 2;
    }
    soft.retain(|(pivot, _)| pivot.abs() < SUSPECT_PIVOT);
    soft.sort_by(|p, q| p.0.abs().total_cmp(&q.0.abs()));
    for (pivot, parts) in soft.iter().take(MOST) {
        assess(solve, start(parts), *pivot, limit, found);
    }
}

/// What the elimination left to the columns of one front: `L D Lᵀ`.
struct FrontMatrix<'a> {
    panel: &'a [f64],
    height: usize,
    d: &'a [f64],
}

impl FrontMatrix<'_> {
    fn below_diagonal(&self, j: usize) -> &[f64] {
        &self.panel[j * self.height + j + 1..j * self.height + self.d.len()]
    }

    /// `Lᵀ y`.
    fn transposed(&self, y: &[f64]) -> Vec<f64> {
        (0..y.len()).map(|j| y[j] + product(self.below_diagonal(j), &y[j + 1..])).collect()
    }

    /// `y <- (L D Lᵀ)⁻¹ y`.
    fn solve(&self, y: &mut [f64]) {
        let n = y.len();
        for j in 0..n {
            let v = y[j];
            for (t, l) in y[j + 1..].iter_mut().zip(self.below_diagonal(j)) {
                *t -= l * v;
            }
        }
        for (v, d) in y.iter_mut().zip(self.d) {
            *v /= d;
        }
        for j in (0..n).rev() {
            y[j] -= product(self.below_diagonal(j), &y[j + 1..]);
        }
    }

    /// Unit motions of the columns with almost no stiffness, orthogonal to each other.
    fn soft_motions(&self) -> Vec<Vec<f64>> {
        let n = self.d.len();
        let mut found: Vec<Vec<f64>> = Vec::new();
        while found.len() < MOST.min(n) {
            // Start from a fixed sequence without symmetry that a motion could miss.
            let mut y: Vec<f64> =
                (0..n).map(|i| 0.5 + ((i + 1) as f64 * 0.618_033_988_75).fract()).collect();
            let mut stiffness = f64::INFINITY;
            for _ in 0..STEPS {
                remove(&found, &mut y);
                normalize(&mut y);
                self.solve(&mut y);
                remove(&found, &mut y);
                stiffness = 1.0 / normalize(&mut y);
            }
            if stiffness.is_nan() || stiffness > SUSPECT_FRONT {
                break;
            }
            found.push(y);
        }
        found
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(p, q)| p * q).sum()
}

fn remove(found: &[Vec<f64>], y: &mut [f64]) {
    for other in found {
        let share = product(other, y);
        for (v, o) in y.iter_mut().zip(other) {
            *v -= share * o;
        }
    }
}

fn normalize(y: &mut [f64]) -> f64 {
    let length = product(y, y).sqrt();
    for v in y.iter_mut() {
        *v /= length;
    }
    length
}
