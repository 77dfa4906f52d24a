//! Mean dilatation: the volume strain replaced by its mean over the element (Nagtegaal, Parks &
//! Rice 1974; Hughes 1980), so that deformation at constant volume does not lock in plane strain.
//!
//! The volume strain is the trace of the local strain. Of the logarithmic strain this is
//! `ln det F`, so that the element sees the deformation gradient `(J / det F)^(1/2) F` with the
//! geometric mean `J` of `det F` (de Souza Neto, Peric, Dutko & Owen 1996), with the stress and
//! the symmetric tangent of its energy.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::{INTERNAL, Internal, Section, gradient};
use super::local_strain::LocalStrain;
use crate::base::Real;
use crate::base::small::{Blocks, Mat, Nodal, nodal};
use crate::elements::{Element, Operator, Sample};

/// Mean volume strain of an element with its derivatives by the nodal values and the internal
/// modes, and the sums that belong to it.
pub struct Dilatation<T, const N: usize, const M: usize> {
    kind: LocalStrain,
    mean: T,
    rows: Nodal<T, N, M>,
    modes: [T; INTERNAL],
    /// Inverse of the area that the mean is taken over.
    inverse: T,
    /// Sum of the mean in-plane stress.
    pressure: T,
    /// Stiffness between the mean and the nodal values, the internal modes and itself.
    mixed: Nodal<T, N, M>,
    mixed_modes: [T; INTERNAL],
    square: T,
}

/// Products of a column of gradient components with the internal modes.
#[inline(always)]
pub(super) fn by_modes<T: Real, const A: usize>(modes: &[[T; 2]; A], p: &[T; 4]) -> [T; INTERNAL] {
    let mut f = [T::zero(); INTERNAL];
    for m in 0..A {
        for i in 0..2 {
            f[2 * m + i] = modes[m][0].fma(p[2 * i], modes[m][1] * p[2 * i + 1]);
        }
    }
    f
}

impl<T: Real, const N: usize, const M: usize> Dilatation<T, N, M> {
    /// For an element with local dofs `q` and internal modes `alpha`, where the section has a mean
    /// dilatation.
    #[inline(always)]
    pub fn new<E, const A: usize>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, M>,
        alpha: &Nodal<T, A, 2>,
        prepared: &E::Prepared<T>,
        section: &Section<N>,
    ) -> Option<Self>
    where
        E: Element<N, M, A>,
    {
        if const { !E::MEAN_DILATATION } || !section.mean_dilatation {
            return None;
        }
        let o = T::zero();
        let mut bar = Self {
            kind: section.strain,
            mean: o,
            rows: nodal(),
            modes: [o; INTERNAL],
            inverse: o,
            pressure: o,
            mixed: nodal(),
            mixed_modes: [o; INTERNAL],
            square: o,
        };
        let mut area = o;
        for point in &section.points {
            let s = E::sample(x, prepared, point);
            let h = gradient(&s, q, alpha);
            let (mut value, slope) = bar.kind.volume(&h);
            let slope = times(&slope, s.weight);
            let mut around = o;
            if const { E::Op::<T>::HOOP } {
                let [e, first, _] = bar.kind.hoop(s.op.drill(q));
                value += e;
                around = first * s.weight;
            }
            bar.mean = s.weight.fma(value, bar.mean);
            s.op.add_force(&slope, around, &mut bar.rows);
            for (sum, v) in bar.modes.iter_mut().zip(by_modes(&s.modes, &slope)) {
                *sum += v;
            }
            area += s.weight;
        }
        bar.inverse = area.recip();
        bar.mean = bar.mean * bar.inverse;
        for v in bar.rows.as_flattened_mut().iter_mut().chain(&mut bar.modes) {
            *v = *v * bar.inverse;
        }
        Some(bar)
    }

    /// Put the mean into a strain.
    #[inline(always)]
    pub fn apply(&self, e: &mut [T; 3]) {
        let change = (self.mean - e[0] - e[1]).scale(0.5);
        e[0] += change;
        e[1] += change;
    }

    /// Put the mean into the strain of a ring, whose hoop strain is `around`.
    #[inline(always)]
    pub fn apply_to_ring(&self, e: &mut [T; 3], around: &mut T) {
        let change = (self.mean - e[0] - e[1] - *around).scale(1.0 / 3.0);
        e[0] += change;
        e[1] += change;
        *around += change;
    }

    /// [`Dilatation::gradient`] of a ring: gradient in the plane, and hoop stretch less one.
    #[inline(always)]
    pub fn ring_gradient(&self, h: &[T; 4], w: T) -> ([T; 4], T) {
        let volume = self.kind.volume(h).0 + self.kind.hoop(w)[0];
        let change = (self.mean - volume).scale(1.0 / 3.0);
        let [mut a, b, c, mut d] = *h;
        match self.kind {
            LocalStrain::Logarithmic => {
                let k = change.exp();
                let scaled = |v: T| (v + T::one()).fma(k, -T::one());
                ([scaled(a), b * k, c * k, scaled(d)], scaled(w))
            }
            LocalStrain::GreenLagrange => (*h, w),
            LocalStrain::Linear | LocalStrain::Stressed(_) => {
                a += change;
                d += change;
                ([a, b, c, d], w + change)
            }
        }
    }

    /// Take the mean stress of a ring out of its parts, and keep it with the weight `w`.
    #[inline(always)]
    pub fn split_ring_stress(&mut self, s: &mut [T; 3], around: &mut T, w: T) {
        let mean = (s[0] + s[1] + *around).scale(1.0 / 3.0);
        s[0] -= mean;
        s[1] -= mean;
        *around -= mean;
        self.pressure = mean.fma(w, self.pressure);
    }

    /// [`Dilatation::split_tangent`] of a ring, whose tangent has the rows xx, yy, xy, zz.
    #[inline(always)]
    pub fn split_ring_tangent(d: &mut Mat<T, 4>) -> ([T; 4], T) {
        const NORMAL: [usize; 3] = [0, 1, 3];
        let mut column = [T::zero(); 4];
        for i in 0..4 {
            column[i] = (d[i][0] + d[i][1] + d[i][3]).scale(1.0 / 3.0);
        }
        let square = (column[0] + column[1] + column[3]).scale(1.0 / 3.0);
        for i in 0..4 {
            for k in NORMAL {
                d[i][k] -= column[i];
                d[k][i] -= column[i];
            }
        }
        for i in NORMAL {
            for k in NORMAL {
                d[i][k] += square;
            }
            column[i] -= square;
        }
        (column, square)
    }

    /// Gradient that has the strain with the mean, up to a rotation; the Green-Lagrange strain
    /// keeps that of the point.
    #[inline(always)]
    pub fn gradient(&self, h: &[T; 4]) -> [T; 4] {
        let change = (self.mean - self.kind.volume(h).0).scale(0.5);
        let [mut a, b, c, mut d] = *h;
        match self.kind {
            LocalStrain::Logarithmic => {
                let k = change.exp();
                let scaled = |v: T| (v + T::one()).fma(k, -T::one());
                [scaled(a), b * k, c * k, scaled(d)]
            }
            LocalStrain::GreenLagrange => *h,
            LocalStrain::Linear | LocalStrain::Stressed(_) => {
                a += change;
                d += change;
                [a, b, c, d]
            }
        }
    }

    /// Take the mean in-plane part out of a stress, and keep it with the weight `w`.
    #[inline(always)]
    pub fn split_stress(&mut self, s: &mut [T; 3], w: T) {
        let mean = (s[0] + s[1]).scale(0.5);
        s[0] -= mean;
        s[1] -= mean;
        self.pressure = mean.fma(w, self.pressure);
    }

    /// The same for a tangent; returns what the mean has with the strain of the point, and with
    /// itself.
    #[inline(always)]
    pub fn split_tangent(d: &mut Mat<T, 3>) -> ([T; 3], T) {
        let mut column = [T::zero(); 3];
        for i in 0..3 {
            column[i] = (d[i][0] + d[i][1]).scale(0.5);
        }
        let square = (column[0] + column[1]).scale(0.5);
        for i in 0..3 {
            for k in 0..2 {
                d[i][k] -= column[i];
                d[k][i] -= column[i];
            }
        }
        for i in 0..2 {
            for k in 0..2 {
                d[i][k] += square;
            }
            column[i] -= square;
        }
        (column, square)
    }

    /// Add what [`Dilatation::split_tangent`] gave at a point, as a weighted column of gradient
    /// components; `around` is that of the hoop.
    #[inline(always)]
    pub fn add<Op, const A: usize>(
        &mut self,
        s: &Sample<T, Op, A>,
        mixed: &[T; 4],
        around: T,
        square: T,
    ) where
        Op: Operator<T, N, M>,
    {
        s.op.add_force(mixed, around, &mut self.mixed);
        for (sum, v) in self.mixed_modes.iter_mut().zip(by_modes(&s.modes, mixed)) {
            *sum += v;
        }
        self.square += square;
    }

    /// Weighted second derivative of the mean by the gradient of a point, times the pressure.
    #[inline(always)]
    pub fn curvature(&self, h: &[T; 4], weight: T) -> Mat<T, 4> {
        let factor = self.pressure * self.inverse * weight;
        let mut a = self.kind.volume_curvature(h);
        for v in a.as_flattened_mut() {
            *v = *v * factor;
        }
        a
    }

    /// [`Dilatation::curvature`] by the hoop stretch.
    #[inline(always)]
    pub fn hoop_curvature(&self, w: T, weight: T) -> T {
        self.kind.hoop(w)[2] * self.pressure * self.inverse * weight
    }

    /// Add the force of the mean in-plane stress.
    #[inline(always)]
    pub fn finish_force(&self, f: &mut Nodal<T, N, M>) {
        add_multiple(f.as_flattened_mut(), self.rows.as_flattened(), self.pressure);
    }

    /// Add the stiffness of the mean, blocks `a <= b`.
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

    /// Add force and stiffness of the internal modes, and their coupling with the nodal values.
    #[inline(always)]
    pub(super) fn finish_modes<const A: usize>(&self, sums: &mut Internal<T, N, M>) {
        for r in 0..2 * A {
            let (mode, mixed) = (self.modes[r], self.mixed_modes[r]);
            let both = mode.fma(self.square, mixed);
            sums.force[r] = mode.fma(self.pressure, sums.force[r]);
            for c in 0..=r {
                let v = self.mixed_modes[c].fma(mode, sums.stiffness[r][c]);
                sums.stiffness[r][c] = self.modes[c].fma(both, v);
            }
            let coupling = sums.coupling[r].as_flattened_mut();
            add_multiple(coupling, self.rows.as_flattened(), both);
            add_multiple(coupling, self.mixed.as_flattened(), mode);
        }
    }
}

/// Gradient components times a number.
#[inline(always)]
pub(super) fn times<T: Real>(p: &[T; 4], factor: T) -> [T; 4] {
    [p[0] * factor, p[1] * factor, p[2] * factor, p[3] * factor]
}

/// `y += factor x`.
#[inline(always)]
fn add_multiple<T: Real>(y: &mut [T], x: &[T], factor: T) {
    for (y, &x) in y.iter_mut().zip(x) {
        *y = x.fma(factor, *y);
    }
}
