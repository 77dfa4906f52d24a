//! Linear complementarity problems by Lemke's method.
//!
//! Sought are `x >= 0` and `y = c + M x >= 0` with `x y = 0`. R. W. Cottle, J.-S. Pang, R. E. Stone,
//! *The Linear Complementarity Problem* (2009): block principal pivots ch. 2.3, Lemke's method
//! ch. 4.4, ties of the ratio test by lexicographic order ch. 4.9.
// SPDX-License-Identifier: BSD-3-Clause

use std::collections::HashSet;

/// Size of a pivot that is rounding, relative to the largest entry of its column.
const ZERO: f64 = 1e-11;
/// Relative difference of ratios that is rounding.
pub(super) const TIE: f64 = 1e-10;
/// Relative error of a solution from a given basis, the square root of rounding: a basis that is
/// singular to rounding has lost all digits, and half of them are enough.
const HALF_OF_THE_DIGITS: f64 = 3.16e-5;

/// `x`, and which of them are in the basis at the end; the `y` of these are zero.
pub type Solution = (Vec<f64>, Vec<bool>);

/// Solution of a problem with the rows of `m` one after the other.
///
/// The method begins with the `y` in the basis, in exchange for the `x` of `start` if there is one.
/// None if it ends on a ray, where there is no solution or it cannot find one, if that basis is
/// singular, or if a number is not finite.
pub fn lemke(c: &[f64], m: &[f64], start: Option<&[bool]>) -> Option<Solution> {
    if !c.iter().chain(m).all(|v| v.is_finite()) {
        return None;
    }
    let mut tableau = Tableau::new(c, m);
    if let Some(start) = start {
        tableau.exchange(start)?;
    }
    let found = tableau.solve()?;
    (start.is_none() || is_solved(c, m, &found.0)).then_some(found)
}

/// Largest size of some numbers.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, v| most.max(v.abs()))
}

fn is_solved(c: &[f64], m: &[f64], x: &[f64]) -> bool {
    let size = largest(c.iter().copied()) + largest(m.iter().copied()) * largest(x.iter().copied());
    let error = |(i, row): (usize, &[f64])| {
        let y = c[i] + row.iter().zip(x).map(|(m, x)| m * x).sum::<f64>();
        x[i].min(y).abs()
    };
    m.chunks_exact(c.len().max(1)).enumerate().all(|row| error(row) <= HALF_OF_THE_DIGITS * size)
}

/// `y - M x - d t = c` with the artificial variable t, solved for the basis.
///
/// The variables are y (0 to n), x (n to 2 n) and t (2 n).
struct Tableau {
    n: usize,
    /// A row for each variable in the basis: coefficients of those outside, right-hand side.
    entries: Vec<f64>,
    inside: Vec<usize>,
    outside: Vec<usize>,
}

impl Tableau {
    fn new(c: &[f64], m: &[f64]) -> Self {
        let n = c.len();
        let mut entries = Vec::with_capacity(n * (n + 2));
        for (row, &c) in m.chunks_exact(n.max(1)).zip(c) {
            entries.extend(row.iter().map(|m| -m));
            entries.extend([0.0, c]);
        }
        Self { n, entries, inside: (0..n).collect(), outside: (n..=2 * n).collect() }
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.entries[row * (self.n + 2) + column]
    }

    fn right_side(&self, row: usize) -> f64 {
        self.at(row, self.n + 1)
    }

    /// Exchanges the variable of a row for that of a column.
    fn pivot(&mut self, row: usize, column: usize) {
        let width = self.n + 2;
        let mut own = self.entries[row * width..][..width].to_vec();
        let pivot = std::mem::replace(&mut own[column], 1.0);
        for v in &mut own {
            *v /= pivot;
        }
        for (i, other) in self.entries.chunks_exact_mut(width).enumerate() {
            let factor = std::mem::replace(&mut other[column], 0.0);
            if i == row {
                other.copy_from_slice(&own);
            } else if factor != 0.0 {
                for (v, p) in other.iter_mut().zip(&own) {
                    *v -= factor * p;
                }
            }
        }
        std::mem::swap(&mut self.inside[row], &mut self.outside[column]);
    }

    /// Brings the x of `start` into the basis, each in its row, for their y; None if it is singular.
    fn exchange(&mut self, start: &[bool]) -> Option<()> {
        let width = self.n + 2;
        let rows: Vec<usize> = (0..self.n).filter(|&i| start[i]).collect();
        for (done, &k) in rows.iter().enumerate() {
            let size = |&r: &usize| self.at(r, k).abs();
            let row = *rows[done..].iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
            if self.at(row, k) == 0.0 {
                return None;
            }
            let (low, high) = (k.min(row), k.max(row));
            if low < high {
                let (head, tail) = self.entries.split_at_mut(high * width);
                head[low * width..][..width].swap_with_slice(&mut tail[..width]);
                self.inside.swap(low, high);
            }
            self.pivot(k, k);
        }
        Some(())
    }

    fn solve(&mut self) -> Option<Solution> {
        let n = self.n;
        let least =
            |a: usize, b: usize| if self.right_side(b) < self.right_side(a) { b } else { a };
        let mut row = (0..n).reduce(least);
        if row.is_none_or(|row| self.right_side(row) >= 0.0) {
            return Some(self.solution());
        }
        for row in self.entries.chunks_exact_mut(n + 2) {
            row[n] = -1.0;
        }
        let (first, mut column) = (self.inside.clone(), n);
        // No basis comes twice, but by rounding.
        let mut seen = HashSet::new();
        while seen.insert(self.inside.clone()) {
            self.pivot(row?, column);
            let leaving = self.outside[column];
            if leaving == 2 * n {
                return Some(self.solution());
            }
            let entering = if leaving < n { leaving + n } else { leaving - n };
            column = self.outside.iter().position(|&v| v == entering)?;
            row = self.leaving(column, &first);
        }
        None
    }

    fn solution(&self) -> Solution {
        let (mut x, mut basic) = (vec![0.0; self.n], vec![false; self.n]);
        for (row, &v) in self.inside.iter().enumerate() {
            if (self.n..2 * self.n).contains(&v) {
                x[v - self.n] = self.right_side(row).max(0.0);
                basic[v - self.n] = true;
            }
        }
        (x, basic)
    }

    /// Row that leaves the basis for a column: of ties the artificial variable, then the
    /// lexicographic least in the variables of the `first` basis. None on a ray.
    fn leaving(&self, column: usize, first: &[usize]) -> Option<usize> {
        let pivot = |r: usize| self.at(r, column);
        let most = largest((0..self.n).map(pivot));
        let mut tied: Vec<usize> =
            (0..self.n).filter(|&r| pivot(r) > ZERO * most.max(1.0)).collect();
        let size = largest((0..self.n).map(|r| self.right_side(r))) / most.max(1e-300);
        let size = size.max(1e-300);
        let ratio = |r: usize| self.right_side(r).max(0.0) / pivot(r);
        keep_least(&mut tied, ratio, |least, _| size.min(least.max(1e-4 * size)));
        if let Some(&row) = tied.iter().find(|&&r| self.inside[r] == 2 * self.n) {
            return Some(row);
        }
        for &v in first {
            if tied.len() <= 1 {
                break;
            }
            let outside = self.outside.iter().position(|&o| o == v);
            let entry = |r: usize| match outside {
                Some(k) => self.at(r, k),
                None => f64::from(self.inside[r] == v),
            };
            keep_least(&mut tied, |r| entry(r) / pivot(r), |_, most| most.max(1.0));
        }
        // Of rows that are equal to rounding, the one with the largest pivot.
        tied.into_iter().reduce(|a, b| if pivot(b) > pivot(a) { b } else { a })
    }
}

/// Keeps the rows with the least value, and those that tie at a size of the least and the largest.
fn keep_least(rows: &mut Vec<usize>, value: impl Fn(usize) -> f64, size: impl Fn(f64, f64) -> f64) {
    let least = rows.iter().map(|&r| value(r)).fold(f64::INFINITY, f64::min);
    let bound = least + TIE * size(least, largest(rows.iter().map(|&r| value(r))));
    rows.retain(|&r| value(r) <= bound);
}

#[cfg(test)]
mod tests {
    use super::lemke;

    #[test]
    fn a_body_on_two_supports_leaves_the_one_that_it_is_pulled_from() {
        let (x, basic) = lemke(&[-1.0, 0.5], &[2.0, 1.0, 1.0, 2.0], None).expect("a solution");
        assert_eq!((x, basic), (vec![0.5, 0.0], vec![true, false]));
    }

    #[test]
    fn the_solution_is_the_same_from_every_basis() {
        let (c, m) = ([-1.0, -2.0, 3.0], [4.0, 1.0, 0.0, 1.0, 3.0, 1.0, -1.0, 1.0, 2.0]);
        let (x, basic) = lemke(&c, &m, None).expect("a solution");
        for start in 0..8 {
            let start = [0, 1, 2].map(|i| start >> i & 1 == 1);
            let (again, same) = lemke(&c, &m, Some(&start)).expect("a solution");
            assert_eq!(same, basic);
            assert!(again.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14));
        }
    }

    #[test]
    fn without_a_solution_the_method_ends_on_a_ray() {
        assert!(lemke(&[-1.0], &[-1.0], None).is_none());
        assert!(lemke(&[1.0, f64::NAN], &[1.0, 0.0, 0.0, 1.0], None).is_none());
        assert!(lemke(&[], &[], Some(&[])).is_some());
    }

    #[test]
    fn from_a_singular_basis_no_wrong_solution_comes() {
        assert!(lemke(&[-1.0, 1.0], &[0.0, 1.0, -1.0, 0.0], Some(&[true, false])).is_none());
        // Two equal rows whose elimination leaves a pivot of rounding.
        let m = [2.0, 1.0, 1.0, 1.0, 3.0, 3.0, 1.0, 3.0, 3.0].map(|m| 1.1 * m);
        let c = [-1.0, -0.3, -0.31];
        if let Some((x, _)) = lemke(&c, &m, Some(&[true; 3])) {
            let row = |i: usize| c[i] + (0..3).map(|j| m[3 * i + j] * x[j]).sum::<f64>();
            assert!((0..3).all(|i| x[i].min(row(i)).abs() < 1e-9));
        }
    }
}
