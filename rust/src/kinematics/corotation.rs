//! The frame that rides with an element, written once for any node count, with or without
//! drilling rotations: best-fit rotation, local dofs, force and consistent tangent
//! (Felippa & Haugen 2005; rotation: Battini 2008, Cho et al. 2017, eq. 1).
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::small::{Blocks, Nodal, dot, symmetric_times};
use crate::base::{Real, shared_dual};

/// Element frame in a configuration, and the local dofs seen from it.
pub struct Frame<T, const N: usize, const M: usize> {
    pub cos: T,
    pub sin: T,
    /// Local (deformational) dofs.
    pub q: Nodal<T, N, M>,
    /// Gradient of the frame rotation with respect to the local dofs.
    g: Nodal<T, N, M>,
    /// Change of the local dofs by a unit frame rotation: `(S x, 1)`.
    a: Nodal<T, N, M>,
}

impl<T: Real, const N: usize, const M: usize> Frame<T, N, M> {
    /// Frame of an element with reference positions `x` and displacements `u`; with
    /// `turning == false` the frame stays (geometrically linear analysis).
    #[inline(always)]
    pub fn new(x: &Nodal<T, N, 2>, u: &Nodal<T, N, M>, nlgeom: bool) -> Self {
        shared_dual::<T, _>(
            #[inline(always)]
            || Self::new_inline(x, u, nlgeom),
        )
    }

    #[inline(always)]
    fn new_inline(x: &Nodal<T, N, 2>, u: &Nodal<T, N, M>, nlgeom: bool) -> Self {
        let mut g = [[T::zero(); M]; N];
        let mut a = [[T::zero(); M]; N];
        if !nlgeom {
            return Self { cos: T::one(), sin: T::zero(), q: *u, g, a };
        }
        let share = 1.0 / N as f64;
        let (mut mean_x, mut mean_u) = ([T::zero(); 2], [T::zero(); 2]);
        for n in 0..N {
            for i in 0..2 {
                mean_x[i] = x[n][i].fma(T::real(share), mean_x[i]);
                mean_u[i] = u[n][i].fma(T::real(share), mean_u[i]);
            }
        }
        let (mut along, mut across) = (T::zero(), T::zero());
        let mut reference = [[T::zero(); 2]; N];
        let mut moved = [[T::zero(); 2]; N];
        for n in 0..N {
            let r = [x[n][0] - mean_x[0], x[n][1] - mean_x[1]];
            // Relative displacement first: adding it to the position would lose its digits.
            let m = [u[n][0] - mean_u[0], u[n][1] - mean_u[1]];
            let c = [r[0] + m[0], r[1] + m[1]];
            along = r[0].fma(c[0], r[1].fma(c[1], along));
            across = r[0].fma(c[1], (-r[1]).fma(c[0], across));
            reference[n] = r;
            moved[n] = m;
        }
        let d = along.fma(along, across * across).sqrt();
        let inverse = d.recip();
        let (cos, sin) = (along * inverse, across * inverse);
        // 1 - cos without cancellation.
        let versine = sin * sin / (T::one() + cos);
        let small = T::real(0.0).lt(cos);
        let one_less = T::select(small, versine, T::one() - cos);
        let theta = if M == 3 { sin.atan2(cos) } else { T::zero() };
        let mut q = [[T::zero(); M]; N];
        for n in 0..N {
            let (r, m) = (reference[n], moved[n]);
            // q = R^T (r + m) - r
            q[n][0] = cos.fma(m[0], sin.fma(m[1], sin.fma(r[1], -(one_less * r[0]))));
            q[n][1] = cos.fma(m[1], (-sin).fma(m[0], (-sin).fma(r[0], -(one_less * r[1]))));
            g[n][0] = -r[1] * inverse;
            g[n][1] = r[0] * inverse;
            a[n][0] = -(r[1] + q[n][1]);
            a[n][1] = r[0] + q[n][0];
            if M == 3 {
                let turn = u[n][M - 1] - theta;
                let turns = turn.scale(0.5 / std::f64::consts::PI).round();
                q[n][M - 1] = turns.fma(T::real(-2.0 * std::f64::consts::PI), turn);
                a[n][M - 1] = T::one();
            }
        }
        Self { cos, sin, q, g, a }
    }

    /// Rotation angle in (-pi, pi].
    pub fn angle(&self) -> T {
        self.sin.atan2(self.cos)
    }

    /// Force in global axes from the local one: `E (f - g (a . f))`.
    #[inline(always)]
    pub fn force(&self, local: &Nodal<T, N, M>) -> Nodal<T, N, M> {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let n = self.balanced(local);
                let mut f = n;
                for b in 0..N {
                    let v = self.to_global([n[b][0], n[b][1]]);
                    f[b][0] = v[0];
                    f[b][1] = v[1];
                }
                f
            },
        )
    }

    /// Tangent in global axes: the exact derivative of [`Frame::force`], as a symmetric
    /// rank-two update `E (K + p g^T + g p^T) E^T`; blocks `a <= b` in place.
    #[inline(always)]
    pub fn stiffness(&self, local_force: &Nodal<T, N, M>, k: &mut Blocks<T, N, M>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || self.stiffness_inline(local_force, k),
        );
    }

    #[inline(always)]
    fn stiffness_inline(&self, local_force: &Nodal<T, N, M>, k: &mut Blocks<T, N, M>) {
        let n = self.balanced(local_force);
        let ka = symmetric_times(k, &self.a);
        let mut p = [[T::zero(); M]; N];
        for b in 0..N {
            p[b][0] = -n[b][1] - ka[b][0];
            p[b][1] = n[b][0] - ka[b][1];
            if M == 3 {
                p[b][M - 1] = -ka[b][M - 1];
            }
        }
        // a . (S n - K a) = a . p, so the last term is -a.p / 2 up to its sign.
        let half = dot(&self.a, &p).scale(-0.5);
        for b in 0..N {
            for i in 0..M {
                p[b][i] = half.fma(self.g[b][i], p[b][i]);
            }
        }
        // A 2 x 2 block is turned by its deviator, which turns by the double angle.
        let turned =
            (self.cos.fma(self.cos, -(self.sin * self.sin)).scale(0.5), self.cos * self.sin);
        let half = T::real(0.5);
        for a in 0..N {
            for b in a..N {
                let m = &mut k[a][b];
                for i in 0..M {
                    for j in 0..M {
                        m[i][j] = p[a][i].fma(self.g[b][j], m[i][j]);
                        m[i][j] = self.g[a][i].fma(p[b][j], m[i][j]);
                    }
                }
                let (sum, skew) = (m[0][0] + m[1][1], m[0][1] - m[1][0]);
                let (d, e) = (m[0][0] - m[1][1], m[0][1] + m[1][0]);
                let normal = turned.0.fma(d, -(turned.1 * e));
                let shear = turned.1.fma(d, turned.0 * e);
                m[0][0] = half.fma(sum, normal);
                m[1][1] = half.fma(sum, -normal);
                m[0][1] = half.fma(skew, shear);
                m[1][0] = (-half).fma(skew, shear);
                if M == 3 {
                    let column = self.to_global([m[0][M - 1], m[1][M - 1]]);
                    let row = self.to_global([m[M - 1][0], m[M - 1][1]]);
                    for i in 0..2 {
                        m[i][M - 1] = column[i];
                        m[M - 1][i] = row[i];
                    }
                }
            }
        }
    }

    /// Turn columns of local forces, `k[a][b][i][0]` for column `b`, to global axes in place: the
    /// derivative of [`Frame::force`] by what changes the local force beside the local dofs.
    #[inline(always)]
    pub fn turn_columns(&self, k: &mut Blocks<T, N, M>) {
        for b in 0..N {
            let mut moment = T::zero();
            for a in 0..N {
                for i in 0..2 {
                    moment = self.a[a][i].fma(k[a][b][i][0], moment);
                }
            }
            for a in 0..N {
                let at = |i: usize| (-self.g[a][i]).fma(moment, k[a][b][i][0]);
                let v = self.to_global([at(0), at(1)]);
                k[a][b][0][0] = v[0];
                k[a][b][1][0] = v[1];
            }
        }
    }

    #[inline(always)]
    fn balanced(&self, local: &Nodal<T, N, M>) -> Nodal<T, N, M> {
        let moment = dot(&self.a, local);
        let mut n = *local;
        for b in 0..N {
            for i in 0..M {
                n[b][i] = (-self.g[b][i]).fma(moment, n[b][i]);
            }
        }
        n
    }

    #[inline(always)]
    pub fn to_global(&self, v: [T; 2]) -> [T; 2] {
        [self.cos.fma(v[0], -(self.sin * v[1])), self.sin.fma(v[0], self.cos * v[1])]
    }
}
