//! Internal modes of an element: found at fixed nodal dofs, and condensed out of the stiffness.
// SPDX-License-Identifier: BSD-3-Clause

use super::integrate::{History, INTERNAL, Section, pass};
use super::law_tape::largest_derivative;
use crate::base::Real;
use crate::base::small::{Blocks, Mat, Nodal, ldlt, ldlt_forward, ldlt_solve};
use crate::elements::Element;

/// Longest first step of an internal mode, relative to the largest local dof.
const MODE_STEP: f64 = 2.0;
/// Share of its slope at the start beyond which a step has run past the minimum.
const OVERSHOT: f64 = 0.5;
/// Local iterations before the increment is given up.
const MAX_LOCAL: usize = 50;
/// Local step, relative to the largest local dof, below which one linear correction is exact
/// to round-off (its error is the square of this).
const LOCAL_STEP: f64 = 1e-8;
/// Step of the derivatives of the modes, relative to them, that ends their iteration, and where it
/// does not fall any more.
const DERIVATIVE_STEP: f64 = 1e-13;
const DERIVATIVE_ROUNDED: f64 = 1e-6;
/// Local step, relative to the element, that is zero: the work along smaller ones may underflow.
const ZERO_STEP: f64 = 1e-100;
/// Rounding errors of the stress of a body that does not deform, in units of its last place.
const NOISE: f64 = 16.0;

/// `K -= (L^-1 C)^T D^-1 (L^-1 C)`, blocks `a <= b`.
#[inline(always)]
pub(super) fn condense<T: Real, const N: usize, const M: usize, const A: usize>(
    factor: &Mat<T, INTERNAL>,
    coupling: &[Nodal<T, N, M>; INTERNAL],
    k: &mut Blocks<T, N, M>,
) {
    let mut reduced = [[[T::zero(); INTERNAL]; M]; N];
    for b in 0..N {
        for j in 0..M {
            let c = &mut reduced[b][j];
            for r in 0..2 * A {
                c[r] = coupling[r][b][j];
            }
            ldlt_forward(factor, 2 * A, c);
            let mut d = *c;
            for r in 0..2 * A {
                d[r] = d[r] * -factor[r][r];
            }
            for a in 0..=b {
                for i in 0..M {
                    if a == b && i > j {
                        // Below the diagonal; copied from above it afterwards.
                        continue;
                    }
                    let mut v = k[a][b][i][j];
                    for r in 0..2 * A {
                        v = reduced[a][i][r].fma(d[r], v);
                    }
                    k[a][b][i][j] = v;
                }
            }
        }
        for i in 0..M {
            for j in 0..i {
                k[b][b][i][j] = k[b][b][j][i];
            }
        }
    }
}

/// Newton iteration for the internal modes at fixed nodal dofs. A plastic element may have
/// next to no stiffness left in them, so steps are bounded by the size of the nodal dofs, and
/// one that runs past the minimum along it is shortened to where the slope vanishes. Returns
/// the lanes that did not settle.
#[inline(always)]
pub(super) fn relax<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    section: &Section<N>,
    history: &mut History<'_>,
    alpha: &mut Nodal<T, A, 2>,
) -> T::Mask
where
    E: Element<N, M, A>,
{
    let (mut size, mut extent) = (T::zero(), T::zero());
    for a in 0..N {
        for i in 0..2 {
            size = size.max(q[a][i].abs());
            extent = extent.max((x[a][i] - x[0][i]).abs());
        }
    }
    // What is held and heated, or has come back to its shape after flow, has no displacement
    // to measure the modes with: the elastic strain of its stress does.
    let moduli = history.per_point.law::<T, N>(0, section).moduli();
    let softness = 1.0 / moduli[0][0];
    // Nor has what only moves as a body: its stress is the rounding of a stiff volume, and moves
    // soft modes by that much.
    let rounding = NOISE * f64::EPSILON * moduli[0][0] / moduli[2][2];
    size = size.max(extent * history.largest::<T, N>(section));
    let (mut tolerance, mut radius) = (T::zero(), T::zero());
    let mut base = *alpha;
    let mut direction = [T::zero(); INTERNAL];
    let mut length = T::one();
    let mut reach = T::zero();
    // Work of the internal force along the step at its start.
    let mut start = T::real(-f64::MAX);
    let mut settled = T::none();
    for round in 0..MAX_LOCAL {
        let sums = pass::<E, T, N, M, A>(x, q, alpha, section, history, None, false);
        if round == 0 {
            size = size.max(extent * sums.stress.scale(softness));
            tolerance = size.scale(LOCAL_STEP).max(extent.scale(rounding));
            tolerance = tolerance.max(T::real(f64::MIN_POSITIVE));
            radius = size.scale(MODE_STEP);
        }
        let mut factor = sums.stiffness;
        ldlt(&mut factor, 2 * A, &sums.least);
        let mut step = sums.force;
        ldlt_solve(&factor, 2 * A, &mut step);
        let (mut along, mut work) = (T::zero(), T::zero());
        let mut largest = T::zero();
        for r in 0..2 * A {
            along = sums.force[r].fma(direction[r], along);
            work = sums.force[r].fma(step[r], work);
            largest = largest.max(step[r].abs());
        }
        let better = along.lt(start.scale(-OVERSHOT));
        let small = T::and(better, largest.lt(tolerance));
        let held = settled;
        settled = T::or(settled, T::or(small, largest.lt(extent.scale(ZERO_STEP))));
        let share = T::select(radius.lt(largest), radius / largest, T::one());
        let shorter = start / (start - along);
        let shorter = T::select(shorter.lt(T::real(0.7)), shorter, T::real(0.7));
        let shorter = shorter.max(T::real(0.1));
        // What was too far once bounds the next steps as well: a mode without stiffness may
        // have to stop at the kink where a point begins to unload.
        length = T::select(better, T::one(), length * shorter);
        reach = T::select(better, largest.min(radius), reach);
        radius = T::select(better, radius.scale(2.0), length * reach);
        start = T::select(better, -(work * share), start);
        for r in 0..2 * A {
            step[r] = step[r] * share;
        }
        for r in 0..2 * A {
            let at = &mut alpha[r / 2][r % 2];
            let origin = &mut base[r / 2][r % 2];
            *origin = T::select(better, *at, *origin);
            direction[r] = T::select(better, -step[r], direction[r]);
            // The small step is still taken, so that the tangent too is exact; lanes that had
            // settled before stay where they are.
            *at = T::select(held, *at, length.fma(direction[r], *origin));
        }
        let done = T::select(settled, T::one(), T::zero());
        if !T::any(done.lt(T::real(0.5))) {
            return T::none();
        }
    }
    let open = T::select(settled, T::zero(), T::one());
    T::real(0.5).lt(open)
}

/// Derivatives of the internal modes about their solution, where the laws are on a tape: what is left
/// of them an element removes. One step is exact with an exact tangent; some laws have a symmetric
/// one that is not quite their derivative. Returns whether they did not settle.
#[inline(always)]
pub(super) fn linear_modes<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    section: &Section<N>,
    history: &mut History<'_>,
    alpha: &mut Nodal<T, A, 2>,
) -> T::Mask
where
    E: Element<N, M, A>,
{
    let mut before = f64::INFINITY;
    for _ in 0..MAX_LOCAL {
        let sums = pass::<E, T, N, M, A>(x, q, alpha, section, history, None, false);
        let mut factor = sums.stiffness;
        ldlt(&mut factor, 2 * A, &sums.least);
        let mut step = sums.force;
        ldlt_solve(&factor, 2 * A, &mut step);
        let (mut change, mut size) = (0.0f64, 0.0f64);
        for r in 0..2 * A {
            let at = &mut alpha[r / 2][r % 2];
            *at -= step[r];
            change = change.max(largest_derivative(step[r]));
            size = size.max(largest_derivative(*at));
        }
        let exact = history.tape.as_ref().is_some_and(|tape| tape.exact) && !section.law.ideal();
        let rounded = change <= DERIVATIVE_ROUNDED * size && change >= before;
        if exact || change <= DERIVATIVE_STEP * size || rounded {
            return T::none();
        }
        before = change;
    }
    T::zero().lt(T::one())
}
