//! Physical stabilization of quadrilaterals with one point.
//!
//! The hourglass `g r s` bends the element along its axes `x_r` and `x_s`. Strains that leave
//! all but the stress along the axis free (the incompatible modes of Q4I, condensed in closed
//! form) give each bending strain `g . x_r / |x_r|^2` the uniaxial stiffness of the material in
//! that direction. For a parallelogram this is exactly Q4I. The mean gradient does not enter, so
//! that no stress makes the hourglass unstable.
//!
//! Beyond yield the stiffness is that of the tangent at the point at the end of the increment
//! before, relative to the elastic one, and the hourglass stress is integrated by increments.
//! Memory: for each axis what is lost of the stiffness, then for each axis the stress at zero
//! strain over the elastic stiffness: a strain, which stays where the stiffness follows the
//! temperature. Then for each axis the stress over the elastic stiffness, and the work that both
//! have dissipated.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::{History, Local, Section, pass};
use super::per_point::PerPoint;
use crate::base::Real;
use crate::base::small::{Mat, Nodal, inverse2};
use crate::elements::ring::radius;
use crate::elements::{Element, Operator, shapes};
use std::f64::consts::TAU;

/// Members of the memory.
pub const MEMORY: usize = 7;
/// Member of the memory with the dissipated work.
pub const DISSIPATED: usize = 6;
/// Least stiffness of the hourglass, relative to the elastic one.
const LEAST: f64 = 0.01;

/// Coefficient of each nodal value in the hourglass `g`: that of `r s` in the field that the nodes
/// give, with the gradients at the center.
#[inline(always)]
pub fn gamma<T: Real>(x: &Nodal<T, 4, 2>, g: &Nodal<T, 4, 2>) -> [T; 4] {
    const SIGN: [f64; 4] = [1.0, -1.0, 1.0, -1.0];
    let mut skew = [T::zero(); 2];
    for a in 0..4 {
        for i in 0..2 {
            skew[i] = x[a][i].fma(T::real(SIGN[a]), skew[i]);
        }
    }
    std::array::from_fn(|a| {
        let linear = skew[0].fma(g[a][0], skew[1] * g[a][1]);
        (T::real(SIGN[a]) - linear).scale(0.25)
    })
}

struct Hourglass<T> {
    /// Coefficient of each nodal value in `g`.
    gamma: [T; 4],
    /// Bending strain by `g`, for each axis.
    along: Mat<T, 2>,
    /// Uniaxial stress in each axis as a stress xx, yy, xy.
    direction: [[T; 3]; 2],
    /// A third of the volume.
    weight: T,
}

impl<T: Real> Hourglass<T> {
    #[inline(always)]
    fn new(x: &Nodal<T, 4, 2>, thickness: T) -> Self {
        let dn = shapes::square_linear([0.0, 0.0]).1;
        let j = shapes::jacobian(x, &dn);
        let (inverse, det) = inverse2(&j);
        let g = shapes::push(&inverse, &dn);
        let gamma = gamma(x, &g);
        let mut along = [[T::zero(); 2]; 2];
        let mut direction = [[T::zero(); 3]; 2];
        for axis in 0..2 {
            let t = [j[0][axis], j[1][axis]];
            let r = t[0].fma(t[0], t[1] * t[1]).recip();
            along[axis] = [t[0] * r, t[1] * r];
            direction[axis] = [t[0] * t[0] * r, t[1] * t[1] * r, t[0] * t[1] * r];
        }
        Self { gamma, along, direction, weight: det.scale(4.0 / 3.0) * thickness }
    }

    #[inline(always)]
    fn strain<const M: usize>(&self, q: &Nodal<T, 4, M>) -> [T; 2] {
        let mut g = [T::zero(); 2];
        for a in 0..4 {
            for i in 0..2 {
                g[i] = self.gamma[a].fma(q[a][i], g[i]);
            }
        }
        let one = |axis: usize| self.along[axis][0].fma(g[0], self.along[axis][1] * g[1]);
        [one(0), one(1)]
    }
}

/// Adjugate of a symmetric matrix and its determinant.
#[inline(always)]
fn adjugate<T: Real>(m: &Mat<T, 3>) -> (Mat<T, 3>, T) {
    let mut c = [[T::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let (p, q, r, s) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            c[i][j] = m[p][r] * m[q][s] - m[p][s] * m[q][r];
        }
    }
    let det = m[0][0].fma(c[0][0], m[0][1].fma(c[0][1], m[0][2] * c[0][2]));
    (c, det)
}

#[inline(always)]
fn quadratic<T: Real>(c: &Mat<T, 3>, s: &[T; 3]) -> T {
    let mut v = T::zero();
    for i in 0..3 {
        for j in 0..3 {
            v = (s[i] * s[j]).fma(c[i][j], v);
        }
    }
    v
}

/// Elastic uniaxial stiffness along each axis.
#[inline(always)]
fn elastic<T: Real, const N: usize>(
    h: &Hourglass<T>,
    section: &Section<N>,
    own: &PerPoint<'_>,
) -> [T; 2] {
    let (c, det) = adjugate(&own.law::<T, N>(0, section).moduli());
    let mut compliance = [[T::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            compliance[i][j] = T::real(c[i][j] / det);
        }
    }
    let one = |axis: usize| quadratic(&compliance, &h.direction[axis]).recip();
    [one(0), one(1)]
}

/// Thickness, or the circumference at the center of a ring.
#[inline(always)]
fn depth<E, T: Real, const M: usize>(
    x: &Nodal<T, 4, 2>,
    section: &Section<4>,
    own: &PerPoint<'_>,
) -> T
where
    E: Element<4, M, 0>,
{
    if E::Op::<T>::HOOP { radius(x, &[0.25; 4]).scale(TAU) } else { own.thickness(0, section) }
}

/// Local force and stiffness into a zero `out`.
#[inline(always)]
pub fn local_into<E, T: Real, const M: usize>(
    x: &Nodal<T, 4, 2>,
    q: &Nodal<T, 4, M>,
    section: &Section<4>,
    history: &mut History<'_>,
    tangent: bool,
    out: &mut Local<T, 4, M>,
) where
    E: Element<4, M, 0>,
{
    let sums = pass::<E, T, 4, M, 0>(x, q, &[], section, history, Some(&mut *out), tangent);
    out.failed = sums.failed;
    let own = history.per_point;
    let h = Hourglass::new(x, depth::<E, T, M>(x, section, &own));
    let strain = h.strain(q);
    let modulus = elastic(&h, section, &own);
    let mut stiffness = modulus;
    let mut stress = [modulus[0] * strain[0], modulus[1] * strain[1]];
    if section.law.n_state() > 0 {
        let mut memory = history.memory(section);
        let (c, det) = adjugate(&sums.tangent);
        let mut dissipated: T = memory.get(DISSIPATED);
        for axis in 0..2 {
            let kept = T::one() - memory.get::<T>(axis);
            stiffness[axis] = kept * modulus[axis];
            let past: T = memory.get(2 + axis);
            stress[axis] = stiffness[axis].fma(strain[axis], modulus[axis] * past);
            let slope = det / quadratic(&c, &h.direction[axis]);
            // Not a number where the tangent has lost more than one rank.
            let known = T::zero().lt(slope);
            let share = T::select(known, slope / modulus[axis], T::real(LEAST));
            let lost = T::one() - share.min(T::one()).max(T::real(LEAST));
            memory.set(axis, lost);
            let next = (T::one() - lost) * strain[axis];
            let elastic = stress[axis] / modulus[axis];
            memory.set(2 + axis, elastic - next);
            // Of the work on a straight line from the last stress, what is not stored.
            let before: T = memory.get(4 + axis);
            let stored = (elastic * elastic - before * before).scale(0.5) * modulus[axis];
            dissipated = (stored * h.weight).fma(kept.recip() - T::one(), dissipated);
            memory.set(4 + axis, elastic);
        }
        memory.set(DISSIPATED, dissipated);
    }
    for axis in 0..2 {
        let force = stress[axis] * h.weight;
        let k = stiffness[axis] * h.weight;
        for a in 0..4 {
            for i in 0..2 {
                let row = h.gamma[a] * h.along[axis][i];
                out.force[a][i] = row.fma(force, out.force[a][i]);
                if !tangent {
                    continue;
                }
                let row = row * k;
                for b in a..4 {
                    for j in 0..2 {
                        let column = h.gamma[b] * h.along[axis][j];
                        out.stiffness[a][b][i][j] = row.fma(column, out.stiffness[a][b][i][j]);
                    }
                }
            }
        }
    }
}

/// Energy that the hourglass stress of each axis stores, given the memory of the state or none, and
/// the stiffness to which it is proportional.
#[inline(always)]
pub fn energy<E, T: Real, const M: usize>(
    x: &Nodal<T, 4, 2>,
    q: &Nodal<T, 4, M>,
    section: &Section<4>,
    own: &PerPoint<'_>,
    memory: &[f64],
) -> [[T; 2]; 2]
where
    E: Element<4, M, 0>,
{
    let h = Hourglass::new(x, depth::<E, T, M>(x, section, own));
    let (strain, modulus) = (h.strain(q), elastic(&h, section, own));
    [0, 1].map(|axis| {
        let mut stress = modulus[axis] * strain[axis];
        if !memory.is_empty() {
            stress = stress.fma(T::real(1.0 - memory[axis]), modulus[axis].scale(memory[2 + axis]));
        }
        [(stress * stress / modulus[axis]) * h.weight.scale(0.5), modulus[axis]]
    })
}
