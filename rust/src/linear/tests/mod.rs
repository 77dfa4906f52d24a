// SPDX-License-Identifier: BSD-3-Clause
//! What every solver owes: backward error, inertia, refusals, one answer for any threads.

mod accuracy;
mod inertia;
mod models;
mod refusals;

/// Small fixed generator, so that each test sees the same numbers on every machine.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11
    }

    /// Between -1 and 1.
    pub fn signed(&mut self) -> f64 {
        self.bits() as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
}

/// Dense symmetric matrix with the pattern of what was ever visited.
#[derive(Clone)]
pub struct Symmetric {
    pub n: usize,
    pub dense: Vec<f64>,
    visited: Vec<bool>,
}

/// Upper triangle in compressed columns.
pub struct Upper {
    pub col_ptr: Vec<usize>,
    pub row_idx: Vec<u32>,
    pub values: Vec<f64>,
    pub node: Vec<u32>,
    pub after: Vec<u32>,
}

impl Upper {
    pub fn pattern(&self) -> super::Pattern<'_> {
        super::Pattern {
            col_ptr: &self.col_ptr,
            row_idx: &self.row_idx,
            node_of_dof: &self.node,
            after: &self.after,
        }
    }
}

impl Symmetric {
    pub fn zero(n: usize) -> Self {
        Self { n, dense: vec![0.0; n * n], visited: vec![false; n * n] }
    }

    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        let n = self.n;
        self.dense[i + j * n] += v;
        self.dense[j + i * n] = self.dense[i + j * n];
        self.visited[i + j * n] = true;
        self.visited[j + i * n] = true;
    }

    /// Random pattern of about `density` and values in (-1, 1), plus `shift` on the diagonal.
    pub fn random(n: usize, density: f64, shift: f64, random: &mut Random) -> Self {
        let mut a = Self::zero(n);
        for j in 0..n {
            for i in 0..j {
                if random.signed().abs() < density {
                    a.add(i, j, random.signed());
                }
            }
            let v = random.signed();
            a.add(j, j, v + shift);
        }
        a
    }

    pub fn upper(&self, dofs_per_node: usize) -> Upper {
        let n = self.n;
        let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
        for c in 0..n {
            for r in 0..=c {
                if self.visited[r + c * n] {
                    row_idx.push(r as u32);
                    values.push(self.dense[r + c * n]);
                }
            }
            col_ptr.push(row_idx.len());
        }
        let node = (0..n).map(|d| (d / dofs_per_node) as u32).collect();
        Upper { col_ptr, row_idx, values, node, after: Vec::new() }
    }

    /// All eigenvalues by cyclic Jacobi rotations.
    pub fn eigenvalues(&self) -> Vec<f64> {
        let n = self.n;
        let mut a = self.dense.clone();
        for _ in 0..60 {
            let mut off = 0.0;
            for p in 0..n {
                for q in p + 1..n {
                    let apq = a[p + q * n];
                    off += apq * apq;
                    if apq.abs() < 1e-300 {
                        continue;
                    }
                    let theta = (a[q + q * n] - a[p + p * n]) / (2.0 * apq);
                    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                    let c = 1.0 / t.hypot(1.0);
                    let s = t * c;
                    for k in 0..n {
                        let (x, y) = (a[k + p * n], a[k + q * n]);
                        a[k + p * n] = c * x - s * y;
                        a[k + q * n] = s * x + c * y;
                    }
                    for k in 0..n {
                        let (x, y) = (a[p + k * n], a[q + k * n]);
                        a[p + k * n] = c * x - s * y;
                        a[q + k * n] = s * x + c * y;
                    }
                }
            }
            if off < 1e-28 {
                break;
            }
        }
        (0..n).map(|i| a[i + i * n]).collect()
    }

    /// Largest residual of `A x = b` over `|A| |x| + |b|`.
    pub fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        let n = self.n;
        let (mut residual, mut norm) = (0.0_f64, 0.0_f64);
        for i in 0..n {
            let row = (0..n).map(|j| self.dense[i + j * n]);
            let sum: f64 = row.clone().zip(x).map(|(a, x)| a * x).sum();
            residual = residual.max((b[i] - sum).abs());
            norm = norm.max(row.map(f64::abs).sum());
        }
        let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        residual / (norm * largest(x) + largest(b))
    }
}
