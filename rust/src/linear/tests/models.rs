// SPDX-License-Identifier: BSD-3-Clause
//! Plane trusses and bilinear quadrilaterals to make matrices of real structures.

use super::{Random, Symmetric, Upper};

/// Sparse upper triangle built from element matrices, with some equations left out.
pub struct Model {
    pub n_nodes: usize,
    pub triplets: Vec<(u32, u32, f64)>,
}

impl Model {
    pub fn new(n_nodes: usize) -> Self {
        Self { n_nodes, triplets: Vec::new() }
    }

    /// Bar of stiffness `k` (force per length) along the unit vector `(c, s)`.
    pub fn bar(&mut self, a: usize, b: usize, direction: (f64, f64), k: f64) {
        let (c, s) = direction;
        let g = [(2 * a, -c), (2 * a + 1, -s), (2 * b, c), (2 * b + 1, s)];
        for (i, u) in g {
            for (j, v) in g {
                if i <= j {
                    self.triplets.push((i as u32, j as u32, k * u * v));
                }
            }
        }
    }

    /// Unit-square bilinear element (plane stress, E = 1, nu = .3) scaled by `k`.
    pub fn quad(&mut self, nodes: [usize; 4], k: f64) {
        let ke = quad_matrix();
        for i in 0..8 {
            for j in 0..8 {
                let (r, c) = (2 * nodes[i / 2] + i % 2, 2 * nodes[j / 2] + j % 2);
                if r <= c {
                    self.triplets.push((r as u32, c as u32, k * ke[i][j]));
                }
            }
        }
    }

    /// Rectangle of `nx` by `ny` elements with stiffness varying by `spread` decades.
    pub fn rectangle(nx: usize, ny: usize, spread: f64, random: &mut Random) -> Self {
        let mut model = Self::new((nx + 1) * (ny + 1));
        let at = |i: usize, j: usize| i * (ny + 1) + j;
        for i in 0..nx {
            for j in 0..ny {
                let k = 10.0_f64.powf(spread * random.signed());
                model.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], k);
            }
        }
        model
    }

    /// Upper triangle without the equations `fixed`.
    pub fn upper(&self, fixed: &[usize]) -> Upper {
        let n = 2 * self.n_nodes;
        let mut number = vec![u32::MAX; n];
        let mut node = Vec::new();
        for d in (0..n).filter(|d| !fixed.contains(d)) {
            number[d] = node.len() as u32;
            node.push((d / 2) as u32);
        }
        let mut list: Vec<(u32, u32, f64)> = self
            .triplets
            .iter()
            .map(|&(r, c, v)| (number[c as usize], number[r as usize], v))
            .filter(|t| t.0 != u32::MAX && t.1 != u32::MAX)
            .collect();
        list.sort_by_key(|t| (t.0, t.1));
        let (mut col_ptr, mut row_idx) = (vec![0_usize; node.len() + 1], Vec::<u32>::new());
        let mut values: Vec<f64> = Vec::new();
        let mut last = None;
        for (c, r, v) in list {
            if last == Some((c, r)) {
                *values.last_mut().unwrap() += v;
            } else {
                row_idx.push(r);
                values.push(v);
                col_ptr[c as usize + 1] += 1;
                last = Some((c, r));
            }
        }
        for c in 0..node.len() {
            col_ptr[c + 1] += col_ptr[c];
        }
        Upper { col_ptr, row_idx, values, node, after: Vec::new() }
    }
}

/// Upper triangle as a dense matrix.
pub fn dense(upper: &Upper) -> Symmetric {
    let n = upper.node.len();
    let mut a = Symmetric::zero(n);
    for c in 0..n {
        for k in upper.col_ptr[c]..upper.col_ptr[c + 1] {
            a.add(upper.row_idx[k] as usize, c, upper.values[k]);
        }
    }
    a
}

fn quad_matrix() -> [[f64; 8]; 8] {
    let (nu, g) = (0.3, 1.0 / 3.0_f64.sqrt());
    let c = 1.0 / (1.0 - nu * nu);
    let d = [[c, c * nu, 0.0], [c * nu, c, 0.0], [0.0, 0.0, c * (1.0 - nu) / 2.0]];
    let mut ke = [[0.0; 8]; 8];
    for (x, y) in [(-g, -g), (g, -g), (g, g), (-g, g)] {
        let dx = [-(1.0 - y), 1.0 - y, 1.0 + y, -(1.0 + y)].map(|v| v / 2.0);
        let dy = [-(1.0 - x), -(1.0 + x), 1.0 + x, 1.0 - x].map(|v| v / 2.0);
        let mut b = [[0.0; 8]; 3];
        for i in 0..4 {
            b[0][2 * i] = dx[i];
            b[1][2 * i + 1] = dy[i];
            b[2][2 * i] = dy[i];
            b[2][2 * i + 1] = dx[i];
        }
        for i in 0..8 {
            for j in 0..8 {
                for p in 0..3 {
                    for q in 0..3 {
                        ke[i][j] += b[p][i] * d[p][q] * b[q][j] / 4.0;
                    }
                }
            }
        }
    }
    ke
}
