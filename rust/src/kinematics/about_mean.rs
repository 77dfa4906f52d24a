//! Strain linear about the mean gradient of an element: `E(H0) + sym(G (H - H0))`, with `G` the
//! transposed mean deformation gradient (Green-Lagrange) or its inverse (logarithmic).
//!
//! Elements with internal modes are unstable under a nonlinear strain of each point: the second
//! derivative of the strain gives their hourglass the negative stiffness of the stress, in
//! tension (logarithmic) or compression (Green-Lagrange), although the continuum is stable (de
//! Souza Neto, Peric, Huang & Owen 1995; Sussman & Bathe 2014). Here the strain is nonlinear
//! only in the mean gradient, which the modes do not change. In a uniform state the hourglass
//! then has the stiffness of the material's tangent alone, which is positive with any hardening.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::Section;
use super::local_strain::LocalStrain;
use crate::base::Real;
use crate::base::small::{Blocks, Mat, Nodal, inverse2, nodal};
use crate::elements::{Element, Operator};

/// Strain of an element about its mean gradient, and the sums over its points.
pub struct AboutMean<T, Op, const N: usize, const M: usize> {
    /// Operator of the mean gradient.
    op: Op,
    kind: LocalStrain,
    /// Whether the fluctuation counts to first order only: about a linear state.
    stressed: bool,
    /// Mean gradient.
    pub h: [T; 4],
    strain: [T; 3],
    /// G by rows.
    g: Mat<T, 2>,
    /// Sums over the points: stress, stress conjugate to the fluctuation, fluctuation times
    /// stress.
    stress: [T; 3],
    pulled: [T; 4],
    moment: Mat<T, 2>,
    /// Stiffness of the mean gradient, and between the nodal values and it.
    square: Mat<T, 4>,
    mixed: [Nodal<T, N, M>; 4],
}

/// What a point adds to the stiffness of the mean gradient.
pub struct MixedTangent<T> {
    pub mixed: Mat<T, 4>,
    square: Mat<T, 4>,
    /// With the hoop stretch.
    around: [T; 4],
}

/// Strain rows of `sym(G K)`.
#[inline(always)]
fn rows<T: Real>(g: &Mat<T, 2>) -> [[T; 4]; 3] {
    let o = T::zero();
    [[g[0][0], o, g[0][1], o], [o, g[1][0], o, g[1][1]], [g[1][0], g[0][0], g[1][1], g[0][1]]]
}

#[inline(always)]
fn times2<T: Real>(a: &Mat<T, 2>, b: &Mat<T, 2>) -> Mat<T, 2> {
    let mut c = [[T::zero(); 2]; 2];
    for i in 0..2 {
        for j in 0..2 {
            c[i][j] = a[i][0].fma(b[0][j], a[i][1] * b[1][j]);
        }
    }
    c
}

#[inline(always)]
fn tensor<T: Real>(s: &[T; 3]) -> Mat<T, 2> {
    [[s[0], s[2]], [s[2], s[1]]]
}

/// `k += X^T Y` with three rows each.
#[inline(always)]
fn add_product<T: Real>(x: &[[T; 4]; 3], y: &[[T; 4]; 3], k: &mut Mat<T, 4>) {
    for i in 0..4 {
        for j in 0..4 {
            for r in 0..3 {
                k[i][j] = x[r][i].fma(y[r][j], k[i][j]);
            }
        }
    }
}

#[inline(always)]
fn times<T: Real>(d: &Mat<T, 3>, x: &[[T; 4]; 3]) -> [[T; 4]; 3] {
    let mut y = [[T::zero(); 4]; 3];
    for r in 0..3 {
        for q in 0..3 {
            for j in 0..4 {
                y[r][j] = d[r][q].fma(x[q][j], y[r][j]);
            }
        }
    }
    y
}

impl<T: Real, Op, const N: usize, const M: usize> AboutMean<T, Op, N, M>
where
    Op: Operator<T, N, M>,
{
    /// Of elements that have it, under a strain that is not linear.
    #[inline(always)]
    pub fn new<E, const A: usize>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, M>,
        prepared: &E::Prepared<T>,
        section: &Section<N>,
    ) -> Option<Self>
    where
        E: Element<N, M, A, Op<T> = Op>,
    {
        if const { !E::ABOUT_MEAN } || section.strain.is_linear() {
            return None;
        }
        let op = E::mean(x, prepared);
        // About a linear state the mean deformation is that of the reference.
        let stressed = section.strain.is_stressed();
        let h = if stressed { [T::zero(); 4] } else { op.gradient(q) };
        let kind = section.strain.finite();
        let f = [[h[0] + T::one(), h[1]], [h[2], h[3] + T::one()]];
        let g = if kind == LocalStrain::Logarithmic {
            inverse2(&f).0
        } else {
            [[f[0][0], f[1][0]], [f[0][1], f[1][1]]]
        };
        let o = T::zero();
        Some(Self {
            op,
            kind,
            stressed,
            h,
            strain: kind.strain(&h),
            g,
            stress: [o; 3],
            pulled: [o; 4],
            moment: [[o; 2]; 2],
            square: [[o; 4]; 4],
            mixed: [nodal(); 4],
        })
    }

    #[inline(always)]
    fn fluctuation(&self, h: &[T; 4]) -> [T; 4] {
        [h[0] - self.h[0], h[1] - self.h[1], h[2] - self.h[2], h[3] - self.h[3]]
    }

    /// Fluctuation that stresses turn with.
    #[inline(always)]
    fn finite_fluctuation(&self, h: &[T; 4]) -> Mat<T, 2> {
        let k = if self.stressed { [T::zero(); 4] } else { self.fluctuation(h) };
        [[k[0], k[1]], [k[2], k[3]]]
    }

    /// Strain at a point with the gradient `h`.
    #[inline(always)]
    pub fn strain(&self, h: &[T; 4]) -> [T; 3] {
        let k = self.fluctuation(h);
        let rows = rows(&self.g);
        let mut e = self.strain;
        for r in 0..3 {
            for j in 0..4 {
                e[r] = rows[r][j].fma(k[j], e[r]);
            }
        }
        e
    }

    /// Stress conjugate to the gradient of a point.
    #[inline(always)]
    pub fn pull(&self, s: &[T; 3]) -> [T; 4] {
        let rows = rows(&self.g);
        let mut p = [T::zero(); 4];
        for r in 0..3 {
            for j in 0..4 {
                p[j] = rows[r][j].fma(s[r], p[j]);
            }
        }
        p
    }

    /// Its derivative by that gradient.
    #[inline(always)]
    pub fn tangent(&self, d: &Mat<T, 3>) -> Mat<T, 4> {
        let rows = rows(&self.g);
        let mut a = [[T::zero(); 4]; 4];
        add_product(&rows, &times(d, &rows), &mut a);
        a
    }

    /// Keep the weighted stress of a point, and what [`AboutMean::pull`] made of it.
    #[inline(always)]
    pub fn keep(&mut self, h: &[T; 4], s: &[T; 3], pulled: &[T; 4]) {
        let m = times2(&self.finite_fluctuation(h), &tensor(s));
        for i in 0..2 {
            for j in 0..2 {
                self.moment[i][j] += m[i][j];
            }
        }
        for r in 0..3 {
            self.stress[r] += s[r];
        }
        for j in 0..4 {
            self.pulled[j] += pulled[j];
        }
    }

    /// Derivatives by the mean gradient of what a point gives, for weighted stress, tangent, and
    /// derivative `around` of the stress by the hoop stretch.
    #[inline(always)]
    pub fn mixed(&self, h: &[T; 4], s: &[T; 3], d: &Mat<T, 3>, around: &[T; 3]) -> MixedTangent<T> {
        let k = self.finite_fluctuation(h);
        let own = rows(&self.g);
        let t = tensor(s);
        let o = T::zero();
        // Rows of the strain by the mean gradient at a fixed gradient of the point.
        let mut by_mean = [[o; 4]; 3];
        let mut mixed = [[o; 4]; 4];
        if self.kind == LocalStrain::Logarithmic {
            let slopes = self.slopes();
            let l = times2(&self.g, &k);
            let z = &self.g;
            let sz = times2(&t, z);
            for a in 0..2 {
                for b in 0..2 {
                    let j = 2 * a + b;
                    let both = z[0][a].fma(l[b][1], z[1][a] * l[b][0]);
                    let y = [z[0][a] * l[b][0], z[1][a] * l[b][1], both];
                    for r in 0..3 {
                        by_mean[r][j] = slopes[r][j] - own[r][j] - y[r];
                    }
                    for m in 0..2 {
                        for i in 0..2 {
                            mixed[2 * m + i][j] = -(sz[i][a] * z[b][m]);
                        }
                    }
                }
            }
        } else {
            by_mean = rows(&[[k[0][0], k[1][0]], [k[0][1], k[1][1]]]);
            for m in 0..2 {
                for i in 0..2 {
                    for j in 0..2 {
                        mixed[2 * m + i][2 * m + j] = t[i][j];
                    }
                }
            }
        }
        let stressed = times(d, &by_mean);
        add_product(&own, &stressed, &mut mixed);
        let mut square = [[o; 4]; 4];
        add_product(&by_mean, &stressed, &mut square);
        let mut with_hoop = [o; 4];
        for r in 0..3 {
            for j in 0..4 {
                with_hoop[j] = by_mean[r][j].fma(around[r], with_hoop[j]);
            }
        }
        MixedTangent { mixed, square, around: with_hoop }
    }

    /// Add what [`AboutMean::mixed`] gave, with the operator of the point.
    #[inline(always)]
    pub fn add(&mut self, op: &Op, part: &MixedTangent<T>) {
        for c in 0..4 {
            let m = &part.mixed;
            op.add_force(&[m[0][c], m[1][c], m[2][c], m[3][c]], part.around[c], &mut self.mixed[c]);
            for r in 0..4 {
                self.square[r][c] += part.square[r][c];
            }
        }
    }

    /// Derivative of the strain of the mean gradient.
    #[inline(always)]
    fn slopes(&self) -> [[T; 4]; 3] {
        let (i, o) = (T::one(), T::zero());
        [
            self.kind.pull(&self.h, &[i, o, o]),
            self.kind.pull(&self.h, &[o, i, o]),
            self.kind.pull(&self.h, &[o, o, i]),
        ]
    }

    /// Add the force of the mean gradient.
    #[inline(always)]
    pub fn finish_force(&self, f: &mut Nodal<T, N, M>) {
        let mut p = self.kind.pull(&self.h, &self.stress);
        let m = &self.moment;
        for i in 0..4 {
            p[i] -= self.pulled[i];
        }
        if self.kind == LocalStrain::Logarithmic {
            let q = times2(&times2(&self.g, m), &self.g);
            for i in 0..2 {
                for j in 0..2 {
                    p[2 * i + j] -= q[j][i];
                }
            }
        } else {
            for i in 0..2 {
                for j in 0..2 {
                    p[2 * i + j] += m[i][j];
                }
            }
        }
        self.op.add_force(&p, T::zero(), f);
    }

    /// Add the coupling of an internal mode with the mean gradient.
    #[inline(always)]
    pub fn add_rows(&self, row: &[T; 4], f: &mut Nodal<T, N, M>) {
        self.op.add_force(row, T::zero(), f);
    }

    /// Add the stiffness of the mean gradient, blocks `a <= b`.
    #[inline(always)]
    pub fn finish_stiffness(&self, k: &mut Blocks<T, N, M>) {
        let o = T::zero();
        let mut square = self.kind.tangent(&self.h, &self.stress, &[[o; 3]; 3]);
        let t = tensor(&self.stress);
        let z = &self.g;
        if self.kind == LocalStrain::Logarithmic {
            let sz = times2(&t, z);
            let q = times2(&times2(z, &self.moment), z);
            for a in 0..2 {
                for b in 0..2 {
                    for c in 0..2 {
                        for d in 0..2 {
                            let v = &mut square[2 * a + b][2 * c + d];
                            // Second derivative of G, and twice the mixed one taken back.
                            *v = z[b][c].fma(q[d][a], *v);
                            *v = z[d][a].fma(q[b][c], *v);
                            *v = sz[b][c].fma(z[d][a], *v);
                            *v = sz[d][a].fma(z[b][c], *v);
                        }
                    }
                }
            }
        } else {
            for m in 0..2 {
                for i in 0..2 {
                    for j in 0..2 {
                        square[2 * m + i][2 * m + j] -= t[i][j].scale(2.0);
                    }
                }
            }
        }
        for i in 0..4 {
            for j in 0..4 {
                square[i][j] += self.square[i][j];
            }
        }
        self.op.add_stiffness(&square, o, k);
        for b in 0..N {
            for j in 0..M {
                let column = self.op.column(b, j).0;
                for a in 0..=b {
                    for i in 0..M {
                        let row = self.op.column(a, i).0;
                        let mut v = k[a][b][i][j];
                        for c in 0..4 {
                            v = self.mixed[c][a][i].fma(column[c], v);
                            v = row[c].fma(self.mixed[c][b][j], v);
                        }
                        k[a][b][i][j] = v;
                    }
                }
            }
        }
    }
}
