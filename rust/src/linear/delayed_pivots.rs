// SPDX-License-Identifier: BSD-3-Clause
//! Fronts that need exchanges: threshold pivoting with 1x1 and 2x2 pivots.
//!
//! Columns without an acceptable pivot are held back and eliminated in the parent;
//! at a root their number is the rank deficiency of the matrix.

use faer::{Accum, MatMut, MatRef};

use super::dense::{self, GROWTH, TINY_PIVOT};
use super::etree::NONE;
use super::symbolic::Symbolic;

/// Pivots taken before the rest of the front is updated.
const BLOCK: usize = 48;

/// Contribution of a child to the front of its parent.
pub struct Child<'a> {
    /// Lower part of a square: held columns first, then the rows below.
    pub square: &'a [f64],
    /// Elimination numbers of the columns held back.
    pub held: &'a [u32],
    /// Places of the rows below in the parent's front.
    pub relative: &'a [u32],
    /// How many of those are columns of the parent.
    pub into_columns: usize,
}

/// Square with columns that wait for the parent.
pub struct DelayedFront {
    pub equations: Vec<u32>,
    pub square: Vec<f64>,
}

/// Factor of a front with exchanges.
pub struct Special {
    /// Rows in order: pivots, columns left over, rows below (elimination numbers).
    pub equations: Vec<u32>,
    pub pivots: usize,
    /// Columns left over at a root: no pivot exists for them.
    pub null: usize,
    /// Unit-lower part, `equations.len()` by `pivots`.
    pub l: Vec<f64>,
    /// Diagonal of D and, where a 2x2 pivot starts, its coupling.
    pub d: Vec<f64>,
    pub e: Vec<f64>,
}

/// A dense symmetric front being eliminated (lower part of a square).
struct Dense {
    side: usize,
    candidates: usize,
    values: Vec<f64>,
    equations: Vec<u32>,
    /// `L D` of the pivots not yet applied to the rest.
    product: Vec<f64>,
    applied: usize,
    pivots: usize,
    d: Vec<f64>,
    e: Vec<f64>,
}

/// Assembles and factorizes front `s` with exchanges.
pub fn factorize(
    sym: &Symbolic,
    s: usize,
    values: &[f64],
    children: &[Child<'_>],
) -> (Special, DelayedFront) {
    let mut front = Dense::assemble(sym, s, values, children);
    let root = sym.fronts[s].parent == NONE;
    front.eliminate(root);
    front.finish(root)
}

impl Dense {
    fn assemble(sym: &Symbolic, s: usize, values: &[f64], children: &[Child<'_>]) -> Self {
        let f = &sym.fronts[s];
        let held: usize = children.iter().map(|c| c.held.len()).sum();
        let candidates = f.width + held;
        let side = candidates + f.below;
        let shift = |place: usize| if place < f.width { place } else { place + held };
        let mut square = vec![0.0; side * side];
        let height = f.height();
        for &(k, place) in sym.entries_of(s) {
            let (row, column) = (place as usize % height, place as usize / height);
            square[shift(row) + column * side] += values[k as usize];
        }
        let mut equations: Vec<u32> = (f.first as u32..(f.first + f.width) as u32).collect();
        for child in children {
            let offset = equations.len();
            equations.extend_from_slice(child.held);
            let waiting = child.held.len();
            let size = waiting + child.relative.len();
            let place = |k: usize| {
                if k < waiting { offset + k } else { shift(child.relative[k - waiting] as usize) }
            };
            for j in 0..size {
                let pj = place(j);
                for i in j..size {
                    let pi = place(i);
                    square[pi.max(pj) + pi.min(pj) * side] += child.square[i + j * size];
                }
            }
        }
        equations.extend_from_slice(sym.rows_of(s));
        Self {
            side,
            candidates,
            values: square,
            equations,
            product: vec![0.0; side * (BLOCK + 2)],
            applied: 0,
            pivots: 0,
            d: Vec::with_capacity(candidates),
            e: Vec::with_capacity(candidates),
        }
    }

    /// Column `j` with all pivots so far applied, rows from the first free one on.
    fn column(&self, j: usize, out: &mut [f64]) {
        let (n, k) = (self.side, self.pivots);
        for i in k..j {
            out[i] = self.values[j + i * n];
        }
        out[j..n].copy_from_slice(&self.values[j + j * n..n + j * n]);
        for l in self.applied..k {
            let w = self.product[j + (l - self.applied) * n];
            if w != 0.0 {
                let factor = &self.values[k + l * n..n + l * n];
                for (o, &v) in out[k..n].iter_mut().zip(factor) {
                    *o -= v * w;
                }
            }
        }
    }

    /// Symmetric exchange of rows and columns `a < b`, none of them a pivot yet.
    fn exchange(&mut self, a: usize, b: usize) {
        if a == b {
            return;
        }
        let n = self.side;
        let v = &mut self.values;
        for l in 0..self.pivots {
            v.swap(a + l * n, b + l * n);
        }
        for l in 0..self.pivots - self.applied {
            self.product.swap(a + l * n, b + l * n);
        }
        for l in self.pivots..a {
            v.swap(a + l * n, b + l * n);
        }
        v.swap(a + a * n, b + b * n);
        for i in a + 1..b {
            v.swap(i + a * n, b + i * n);
        }
        for i in b + 1..n {
            v.swap(i + a * n, i + b * n);
        }
        self.equations.swap(a, b);
    }

    fn eliminate(&mut self, root: bool) {
        let n = self.side;
        let (mut first, mut second) = (vec![0.0; n], vec![0.0; n]);
        let mut j = 0;
        let mut failed = 0;
        while self.pivots < self.candidates {
            let k = self.pivots;
            if failed >= self.candidates - k {
                // At a root nothing can wait: the best pivot of all that is left is taken.
                self.apply();
                match if root { self.best_left() } else { None } {
                    None => break,
                    Some((a, b)) => {
                        self.column(a, &mut first);
                        self.column(b, &mut second);
                        self.take(a, b, &mut first, &mut second);
                    }
                }
                failed = 0;
                continue;
            }
            if j < k || j >= self.candidates {
                j = k;
            }
            self.column(j, &mut first);
            let mut found = None;
            if one_by_one(&first[k..], j - k) {
                found = Some(j);
            } else if let Some(r) = partner(&first, k, self.candidates, j) {
                self.column(r, &mut second);
                if two_by_two(&first[k..], &second[k..], j - k, r - k) {
                    found = Some(r);
                }
            }
            if let Some(r) = found {
                self.take(j, r, &mut first, &mut second);
                failed = 0;
            } else {
                failed += 1;
                j += 1;
            }
            if self.pivots - self.applied >= BLOCK {
                self.apply();
            }
        }
        self.apply();
    }

    /// Takes the pivot of columns `j` and `r` (one if equal), given up to date.
    fn take(&mut self, j: usize, r: usize, first: &mut [f64], second: &mut [f64]) {
        let k = self.pivots;
        self.exchange(k, j);
        first.swap(k, j);
        if j == r {
            self.take_one(first);
            return;
        }
        second.swap(k, j);
        let r = if r == k { j } else { r };
        self.exchange(k + 1, r);
        first.swap(k + 1, r);
        second.swap(k + 1, r);
        self.take_two(first, second);
    }

    /// Largest pivot of what is left, all pivots being applied: Bunch and Parlett's choice.
    fn best_left(&self) -> Option<(usize, usize)> {
        const ALPHA: f64 = 0.64;
        let (n, k) = (self.side, self.pivots);
        let (mut diagonal, mut coupling) = ((0.0_f64, k), (0.0_f64, k, k));
        for j in k..self.candidates {
            let v = self.values[j + j * n].abs();
            if v > diagonal.0 {
                diagonal = (v, j);
            }
            for i in j + 1..self.candidates {
                let v = self.values[i + j * n].abs();
                if v > coupling.0 {
                    coupling = (v, j, i);
                }
            }
        }
        if diagonal.0.max(coupling.0) < TINY_PIVOT {
            None
        } else if diagonal.0 >= ALPHA * coupling.0 {
            Some((diagonal.1, diagonal.1))
        } else {
            Some((coupling.1, coupling.2))
        }
    }

    fn take_one(&mut self, column: &[f64]) {
        let (n, k) = (self.side, self.pivots);
        let pivot = column[k];
        let at = (k - self.applied) * n;
        self.product[at + k..at + n].copy_from_slice(&column[k..]);
        for i in k + 1..n {
            self.values[i + k * n] = column[i] / pivot;
        }
        self.values[k + k * n] = 1.0;
        self.d.push(pivot);
        self.e.push(0.0);
        self.pivots += 1;
    }

    fn take_two(&mut self, first: &[f64], second: &[f64]) {
        let (n, k) = (self.side, self.pivots);
        let (a, b, c) = (first[k], first[k + 1], second[k + 1]);
        let at = (k - self.applied) * n;
        self.product[at + k..at + n].copy_from_slice(&first[k..]);
        self.product[at + n + k..at + 2 * n].copy_from_slice(&second[k..]);
        // Inverse of [[a, b], [b, c]] with the large coupling b divided out.
        let (ab, cb) = (a / b, c / b);
        let scale = 1.0 / (b * (ab * cb - 1.0));
        for i in k + 2..n {
            let (x, y) = (first[i], second[i]);
            self.values[i + k * n] = scale * (cb * x - y);
            self.values[i + (k + 1) * n] = scale * (ab * y - x);
        }
        self.values[k + k * n] = 1.0;
        self.values[k + 1 + k * n] = 0.0;
        self.values[k + 1 + (k + 1) * n] = 1.0;
        self.d.extend([a, c]);
        self.e.extend([b, 0.0]);
        self.pivots += 2;
    }

    /// Applies the pivots since the last time to the rest of the front.
    fn apply(&mut self) {
        let (n, k0, k) = (self.side, self.applied, self.pivots);
        if k == k0 || k == n {
            self.applied = k;
            return;
        }
        let (done, rest) = self.values.split_at_mut(k * n);
        let l = MatRef::from_column_major_slice(&done[k0 * n..], n, k - k0).subrows(k, n - k);
        let product = MatRef::from_column_major_slice(&self.product[..(k - k0) * n], n, k - k0);
        let product = product.subrows(k, n - k);
        let target = MatMut::from_column_major_slice_mut(rest, n, n - k);
        let (_, target) = target.split_at_row_mut(k);
        dense::update(target, l, product, 0, n - k, Accum::Add);
        self.applied = k;
    }

    fn finish(mut self, root: bool) -> (Special, DelayedFront) {
        let (n, k) = (self.side, self.pivots);
        let left = self.candidates - k;
        let mut held = DelayedFront { equations: Vec::new(), square: Vec::new() };
        if !root {
            held.equations = self.equations[k..self.candidates].to_vec();
            held.square.reserve((n - k) * (n - k));
            for j in k..n {
                held.square.extend_from_slice(&self.values[k + j * n..n + j * n]);
            }
        }
        self.values.truncate(k * n);
        self.values.shrink_to_fit();
        let special = Special {
            equations: self.equations,
            pivots: k,
            null: if root { left } else { 0 },
            l: self.values,
            d: self.d,
            e: self.e,
        };
        (special, held)
    }
}

/// Whether entry `j` of a column is a good pivot for it.
fn one_by_one(column: &[f64], j: usize) -> bool {
    let pivot = column[j].abs();
    if pivot.is_nan() || pivot < TINY_PIVOT {
        return false;
    }
    let largest = column
        .iter()
        .enumerate()
        .fold(0.0_f64, |m, (i, v)| if i == j { m } else { m.max(v.abs()) });
    largest * largest <= GROWTH * pivot
}

/// Candidate with the largest coupling to column `j`.
fn partner(column: &[f64], k: usize, candidates: usize, j: usize) -> Option<usize> {
    let best = (k..candidates)
        .filter(|&i| i != j)
        .max_by(|&a, &b| column[a].abs().total_cmp(&column[b].abs()))?;
    (column[best].abs() >= TINY_PIVOT).then_some(best)
}

/// Whether columns `j` and `r` make a good 2x2 pivot.
fn two_by_two(first: &[f64], second: &[f64], j: usize, r: usize) -> bool {
    let (a, b, c) = (first[j], first[r], second[r]);
    let (ab, cb) = (a / b, c / b);
    let determinant = (ab * cb - 1.0).abs();
    if determinant.is_nan() || determinant < 1e-8 || b.abs() < TINY_PIVOT {
        return false;
    }
    let scale = 1.0 / (b.abs() * determinant);
    let (mut x, mut y) = (0.0_f64, 0.0_f64);
    for i in 0..first.len() {
        if i != j && i != r {
            x = x.max(first[i].abs());
            y = y.max(second[i].abs());
        }
    }
    scale * (cb.abs() * x * x + 2.0 * x * y + ab.abs() * y * y) <= GROWTH
}
