//! Optimal three-node triangle with drilling rotations (Felippa 2003, the OPT instance of the
//! assumed natural deviatoric strain template; co-rotational: Felippa & Haugen 2005).
//!
//! The strain is given directly: a basic part that passes the traction patch test and a
//! higher-order part driven by the hierarchical rotations. There is no displacement field; the
//! skew gradient is that of the constant-strain triangle. Where the thickness varies, the basic part
//! is the mean gradient over the volume, and the higher-order part has no mean: a constant stress then
//! has the forces of the basic part alone, as under uniform thickness.
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Full, Point, Sample};
use super::shapes;
use crate::base::Real;
use crate::base::small::{Mat, Nodal};

#[derive(Clone, Copy)]
pub struct Opt;

/// Template parameters beta_1 ... beta_9 by rows.
const BETA: [[f64; 3]; 3] = [[1.0, 2.0, 1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, -2.0]];
/// Share of the boundary rotation in the basic part.
const ALPHA_B: f64 = 1.5;

#[derive(Clone, Copy)]
pub struct Prepared<T> {
    /// Rows of the gradient from the basic part, by node and dof.
    basic: [[[T; 4]; 3]; 3],
    /// Strains (x, y, xy) from the hierarchical rotation of each node at each corner.
    corner: [[[T; 3]; 3]; 3],
    /// Mean rotation of the linear triangle: coefficient of each translation.
    mean: [[T; 2]; 3],
    double_area: T,
}

impl Element<3, 3, 0> for Opt {
    const NAME: &'static str = "OPT";
    const CELL: &'static str = "tri3";
    const ALPHA_B: f64 = ALPHA_B;
    type Code = Self;
    type Op<T: Real> = Full<T, 3>;
    type Prepared<T: Real> = Prepared<T>;

    fn rule() -> Vec<[f64; 3]> {
        shapes::triangle_sides()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::triangle_6()
    }
    fn shape(xi: [f64; 2]) -> ([f64; 3], [[f64; 2]; 3]) {
        shapes::triangle_linear(xi)
    }
    fn sides(xi: [f64; 2]) -> [f64; 3] {
        let (l, _) = shapes::triangle_linear(xi);
        [4.0 * l[0] * l[1], 4.0 * l[1] * l[2], 4.0 * l[2] * l[0]]
    }
    /// Factor `(3/2) sqrt(beta_0)` of the higher-order strain, with beta_0 that makes the
    /// in-plane bending of a rectangle exact for general moduli (Felippa 2003, section 5.3).
    fn parameter(c: &Mat<f64, 3>) -> f64 {
        let mean = c[0][0] + c[1][1];
        let c11 = (3.0 * mean + 2.0 * c[0][1] + 4.0 * c[2][2]) / 8.0;
        let c12 = (mean + 6.0 * c[0][1] - 4.0 * c[2][2]) / 8.0;
        let ratio = c12 / c11;
        1.5 * (0.5 * (1.0 - 4.0 * ratio * ratio)).max(0.01).sqrt()
    }
    fn parameter_of(beta0: f64) -> Option<f64> {
        (beta0 > 0.0).then(|| 1.5 * beta0.sqrt())
    }
    fn edge(share: f64, thickness: f64) -> f64 {
        share * thickness
    }

    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, 3, 2>, parameter: f64, sides: &[T; 3]) -> Prepared<T> {
        let dx = |i: usize, j: usize| x[i][0] - x[j][0];
        let dy = |i: usize, j: usize| x[i][1] - x[j][1];
        let double_area = dx(1, 0) * dy(2, 0) - dx(2, 0) * dy(1, 0);
        let r = double_area.recip();
        let mut basic = [[[T::zero(); 4]; 3]; 3];
        let mut mean = [[T::zero(); 2]; 3];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (y_jk, x_kj) = (dy(j, k) * r, dx(k, j) * r);
            // Gradient of the linear triangle: (y_jk, x_kj) / 2A.
            basic[i][0] = [y_jk, x_kj, T::zero(), T::zero()];
            basic[i][1] = [T::zero(), T::zero(), y_jk, x_kj];
            mean[i] = [x_kj.scale(-0.5), y_jk.scale(0.5)];
        }
        // Thickness of the nodes over the mean one; 1 where a neighbor reduces a side.
        let all = sides[0] + sides[1] + sides[2];
        let reduced = all.lt(T::real((3.0 - 1e-9) * ALPHA_B));
        let thick: [T; 3] = std::array::from_fn(|i| {
            let excess = sides[i] + sides[(i + 2) % 3] - sides[(i + 1) % 3];
            T::select(reduced, T::one(), excess.scale(1.0 / ALPHA_B))
        });
        // A side (a, b) bulges by 4 L_a L_b along its normal: opposite moments at its ends. The mean of
        // its gradient over the volume is that of the normal traction where the thickness is uniform.
        for a in 0..3 {
            let b = (a + 1) % 3;
            let share = T::select(reduced, sides[a], T::real(ALPHA_B)).scale(1.0 / 24.0);
            let (n_x, n_y) = (dy(b, a) * share, dx(a, b) * share);
            let (to_a, to_b) = (thick[b] + T::real(3.0), thick[a] + T::real(3.0));
            let g_x = to_a.fma(basic[a][0][0], to_b * basic[b][0][0]);
            let g_y = to_a.fma(basic[a][0][1], to_b * basic[b][0][1]);
            let half = n_x.fma(g_y, n_y * g_x).scale(0.5);
            for (r, v) in [n_x * g_x, half, half, n_y * g_y].into_iter().enumerate() {
                basic[b][2][r] += v;
                basic[a][2][r] -= v;
            }
        }
        // Natural strains along the edges (21, 32, 13): squared lengths and directions.
        let mut squared = [T::zero(); 3];
        let mut to_xy = [[T::zero(); 3]; 3];
        let r2 = r * r;
        for e in 0..3 {
            let (i, j, k) = (e, (e + 1) % 3, (e + 2) % 3);
            let l2 = dx(j, i) * dx(j, i) + dy(j, i) * dy(j, i);
            squared[e] = l2;
            to_xy[e] = [
                dy(j, k) * dy(i, k) * l2 * r2,
                dx(j, k) * dx(i, k) * l2 * r2,
                (dy(j, k) * dx(k, i) + dx(k, j) * dy(i, k)) * l2 * r2,
            ];
        }
        // corner[c] = T_e Q_c: row e of Q_c is (A / l_e^2) times a permuted row of BETA.
        let mut corner = [[[T::zero(); 3]; 3]; 3];
        let third = double_area.scale(parameter / 3.0);
        for c in 0..3 {
            for e in 0..3 {
                let scale = third / squared[e];
                for n in 0..3 {
                    let beta = BETA[(e + 3 - c) % 3][(n + 3 - c) % 3];
                    for s in 0..3 {
                        corner[c][n][s] = to_xy[e][s].fma(scale.scale(beta), corner[c][n][s]);
                    }
                }
            }
        }
        for n in 0..3 {
            for s in 0..3 {
                let mut excess = T::zero();
                for c in 0..3 {
                    let share = (thick[c] + T::real(3.0)).scale(1.0 / 12.0);
                    excess = corner[c][n][s].fma(share, excess);
                }
                for c in 0..3 {
                    corner[c][n][s] -= excess;
                }
            }
        }
        Prepared { basic, corner, mean, double_area }
    }

    #[inline(always)]
    fn sample<T: Real>(
        _: &Nodal<T, 3, 2>,
        p: &Prepared<T>,
        point: &Point<3>,
    ) -> Sample<T, Full<T, 3>, 0> {
        let mut h = p.basic;
        // Strain from the hierarchical rotations: nodal rotation minus the mean one.
        let mut total = [T::zero(); 4];
        for n in 0..3 {
            let mut e = [T::zero(); 3];
            for c in 0..3 {
                for s in 0..3 {
                    e[s] = p.corner[c][n][s].fma(T::real(point.n[c]), e[s]);
                }
            }
            let rows = [e[0], e[2].scale(0.5), e[2].scale(0.5), e[1]];
            for r in 0..4 {
                h[n][2][r] += rows[r];
                total[r] += rows[r];
            }
        }
        for n in 0..3 {
            for i in 0..2 {
                for r in 0..4 {
                    h[n][i][r] -= total[r] * p.mean[n][i];
                }
            }
        }
        Sample { op: Full(h), modes: [], weight: p.double_area.scale(point.weight) }
    }
}
