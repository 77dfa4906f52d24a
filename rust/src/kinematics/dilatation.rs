//! Mean dilatation: the trace of the local gradient replaced by its mean over the element
//! (Nagtegaal, Parks & Rice 1974; Hughes 1980), so that plastic flow at constant volume does
//! not lock in plane strain. Internal modes have no mean gradient.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::Section;
use crate::base::Real;
use crate::base::small::{Blocks, Mat, Nodal, dot, nodal};
use crate::elements::{Element, Operator};

/// Mean trace of an element as a linear function of its local dofs, and the sums that belong
/// to it.
pub struct Dilatation<T, const N: usize, const M: usize> {
    rows: Nodal<T, N, M>,
    mean: T,
    /// Sum of the mean in-plane stress.
    pressure: T,
    /// Stiffness between the mean trace and the local dofs, and of the mean trace.
    mixed: Nodal<T, N, M>,
    square: T,
}

impl<T: Real, const N: usize, const M: usize> Dilatation<T, N, M> {
    /// For an element with local dofs `q`.
    #[inline(always)]
    pub fn new<E, const A: usize>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, M>,
        prepared: &E::Prepared<T>,
        section: &Section<N>,
    ) -> Self
    where
        E: Element<N, M, A>,
    {
        let mut rows = nodal::<T, N, M>();
        let mut area = T::zero();
        for point in &section.points {
            let s = E::sample(x, prepared, point);
            let o = T::zero();
            s.op.add_force(&[s.weight, o, o, s.weight], o, &mut rows);
            area += s.weight;
        }
        let inverse = area.recip();
        for row in &mut rows {
            for v in row {
                *v = *v * inverse;
            }
        }
        let mean = dot(&rows, q);
        Self { rows, mean, pressure: T::zero(), mixed: nodal(), square: T::zero() }
    }

    /// Put the mean trace into a gradient.
    #[inline(always)]
    pub fn apply(&self, h: &mut [T; 4]) {
        let change = (self.mean - h[0] - h[3]).scale(0.5);
        h[0] += change;
        h[3] += change;
    }

    /// Take the mean in-plane part out of a weighted stress, and keep it.
    #[inline(always)]
    pub fn split_stress(&mut self, p: &mut [T; 4]) {
        let mean = (p[0] + p[3]).scale(0.5);
        p[0] -= mean;
        p[3] -= mean;
        self.pressure += mean;
    }

    /// The same for a weighted tangent; returns its coupling with the mean trace.
    #[inline(always)]
    pub fn split_tangent(a: &mut Mat<T, 4>) -> ([T; 4], T) {
        let mut column = [T::zero(); 4];
        for i in 0..4 {
            column[i] = a[i][0] + a[i][3];
        }
        let square = column[0] + column[3];
        for i in 0..4 {
            for k in [0, 3] {
                a[i][k] -= column[i].scale(0.5);
                a[k][i] -= column[i].scale(0.5);
            }
        }
        for i in [0, 3] {
            for k in [0, 3] {
                a[i][k] += square.scale(0.25);
            }
        }
        let mut mixed = column.map(|v| v.scale(0.5));
        mixed[0] -= square.scale(0.25);
        mixed[3] -= square.scale(0.25);
        (mixed, square.scale(0.25))
    }

    /// Add what [`Dilatation::split_tangent`] gave at a point.
    #[inline(always)]
    pub fn add<Op>(&mut self, op: &Op, mixed: &[T; 4], square: T)
    where
        Op: Operator<T, N, M>,
    {
        op.add_force(mixed, T::zero(), &mut self.mixed);
        self.square += square;
    }

    /// Add a multiple of the mean trace's row to a vector.
    #[inline(always)]
    pub fn add_rows(&self, factor: T, f: &mut Nodal<T, N, M>) {
        for a in 0..N {
            for i in 0..M {
                f[a][i] = self.rows[a][i].fma(factor, f[a][i]);
            }
        }
    }

    /// Add the force of the mean in-plane stress.
    #[inline(always)]
    pub fn finish_force(&self, f: &mut Nodal<T, N, M>) {
        self.add_rows(self.pressure, f);
    }

    /// Add the stiffness of the mean trace, blocks `a <= b`.
    #[inline(always)]
    pub fn finish_stiffness(&self, k: &mut Blocks<T, N, M>) {
        for b in 0..N {
            for j in 0..M {
                let (row, mixed) = (self.rows[b][j], self.mixed[b][j]);
                let both = row.fma(self.square, mixed);
                for a in 0..=b {
                    for i in 0..M {
                        let v = self.mixed[a][i].fma(row, k[a][b][i][j]);
                        k[a][b][i][j] = self.rows[a][i].fma(both, v);
                    }
                }
            }
        }
    }
}
