//! Solids of revolution: x is the radius, y the axis.
//!
//! An element that interpolates displacements is turned about the axis. Its frame takes the rotation
//! in the plane away; the hoop stretch `u_r / R` is a row for itself, of the radial displacements in
//! global axes, which the frame does not change. So the local dofs of a node are three: two of the
//! frame and the radial displacement. The energy is a function of them, and the chain rule to the two
//! global dofs gives forces and the symmetric tangent exactly. Weights are those of the whole
//! circumference, `2 pi R` times the area.
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Operator, Point, Sample, Wanted};
use super::shapes;
use crate::base::small::{Blocks, Mat, Nodal, blocks};
use crate::base::{Real, shared_dual};
use crate::kinematics::corotation::Frame;
use crate::kinematics::integrate::{self, History, Local, PointKinematics, Section};
use crate::kinematics::per_point::PerPoint;
use std::f64::consts::TAU;
use std::marker::PhantomData;

/// Operator of an element of revolution: derivatives of the shape functions, and the hoop row.
#[derive(Clone, Copy)]
pub struct Hoop<T, const N: usize> {
    pub grad: [[T; 2]; N],
    /// `N_a / R`.
    pub row: [T; N],
}

impl<T: Real, const N: usize> Operator<T, N, 3> for Hoop<T, N> {
    const DRILL: bool = false;
    const HOOP: bool = true;

    #[inline(always)]
    fn gradient(&self, q: &Nodal<T, N, 3>) -> [T; 4] {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let mut h = [T::zero(); 4];
                for a in 0..N {
                    for i in 0..2 {
                        for j in 0..2 {
                            h[2 * i + j] = self.grad[a][j].fma(q[a][i], h[2 * i + j]);
                        }
                    }
                }
                h
            },
        )
    }
    #[inline(always)]
    fn drill(&self, q: &Nodal<T, N, 3>) -> T {
        let mut w = T::zero();
        for a in 0..N {
            w = self.row[a].fma(q[a][2], w);
        }
        w
    }
    #[inline(always)]
    fn add_force(&self, p: &[T; 4], hoop: T, f: &mut Nodal<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                for a in 0..N {
                    for i in 0..2 {
                        for j in 0..2 {
                            f[a][i] = self.grad[a][j].fma(p[2 * i + j], f[a][i]);
                        }
                    }
                    f[a][2] = self.row[a].fma(hoop, f[a][2]);
                }
            },
        );
    }
    #[inline(always)]
    fn add_stiffness(&self, m: &Mat<T, 4>, gamma: T, k: &mut Blocks<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                for b in 0..N {
                    let mut t = [[T::zero(); 2]; 4];
                    for r in 0..4 {
                        for j in 0..2 {
                            t[r][j] =
                                m[r][2 * j].fma(self.grad[b][0], m[r][2 * j + 1] * self.grad[b][1]);
                        }
                    }
                    let hoop = gamma * self.row[b];
                    for a in 0..=b {
                        let k = &mut k[a][b];
                        for i in 0..2 {
                            for j in 0..2 {
                                let v = self.grad[a][0].fma(t[2 * i][j], k[i][j]);
                                k[i][j] = self.grad[a][1].fma(t[2 * i + 1][j], v);
                            }
                        }
                        k[2][2] = self.row[a].fma(hoop, k[2][2]);
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn add_coupling(&self, c: &[T; 4], k: &mut Blocks<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let mut t = [[T::zero(); 2]; N];
                for a in 0..N {
                    for i in 0..2 {
                        t[a][i] = self.grad[a][0].fma(c[2 * i], self.grad[a][1] * c[2 * i + 1]);
                    }
                }
                for b in 0..N {
                    for a in 0..=b {
                        for i in 0..2 {
                            k[a][b][i][2] = t[a][i].fma(self.row[b], k[a][b][i][2]);
                            k[a][b][2][i] = self.row[a].fma(t[b][i], k[a][b][2][i]);
                        }
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn column(&self, a: usize, i: usize) -> ([T; 4], T) {
        let mut c = [T::zero(); 4];
        if i == 2 {
            return (c, self.row[a]);
        }
        c[2 * i] = self.grad[a][0];
        c[2 * i + 1] = self.grad[a][1];
        (c, T::zero())
    }
}

/// Radius of a point on the reference.
#[inline(always)]
pub fn radius<T: Real, const N: usize>(x: &Nodal<T, N, 2>, n: &[f64; N]) -> T {
    let mut r = T::zero();
    for a in 0..N {
        r = x[a][0].fma(T::real(n[a]), r);
    }
    r
}

/// An element that can be turned about the axis.
pub trait Revolved<const N: usize, const A: usize>: Element<N, 2, A> {
    /// Sample at a point, weighted with the circumference. Means of the internal modes over the ring
    /// vanish, so that they do no work on a uniform stress.
    #[inline(always)]
    fn ring<T: Real>(
        x: &Nodal<T, N, 2>,
        prepared: &Self::Prepared<T>,
        point: &Point<N>,
    ) -> Sample<T, Hoop<T, N>, A> {
        let Sample { op, modes, weight } = Self::sample(x, prepared, point);
        let r = radius(x, &point.n);
        let inverse = r.recip();
        let grad = std::array::from_fn(
            #[inline(always)]
            |a| {
                let rows = op.column(a, 0).0;
                [rows[0], rows[1]]
            },
        );
        let row = point.n.map(
            #[inline(always)]
            |n| inverse.scale(n),
        );
        Sample { op: Hoop { grad, row }, modes, weight: (weight * r).scale(TAU) }
    }
    /// Local force and stiffness into a zero `out`.
    #[inline(always)]
    fn ring_into<T: Real>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, 3>,
        section: &Section<N>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, N, 3>,
    ) {
        integrate::local_into::<LocalRing<Self>, T, N, 3, A>(x, q, section, history, tangent, out);
    }
    /// See [`Element::stabilization`].
    #[inline(always)]
    fn ring_stabilization<T: Real>(
        _x: &Nodal<T, N, 2>,
        _q: &Nodal<T, N, 3>,
        _section: &Section<N>,
        _own: &PerPoint<'_>,
        _memory: &[f64],
    ) -> [[T; 2]; 2] {
        [[T::zero(), T::one()]; 2]
    }
}

/// The turned element in its local dofs: two of the frame and the radial displacement.
#[derive(Clone, Copy)]
pub struct LocalRing<E>(PhantomData<E>);

impl<E, const N: usize, const A: usize> Element<N, 3, A> for LocalRing<E>
where
    E: Revolved<N, A>,
{
    const NAME: &'static str = E::NAME;
    const CELL: &'static str = E::CELL;
    const ABOUT_MEAN: bool = E::ABOUT_MEAN;
    const MEAN_DILATATION: bool = E::MEAN_DILATATION;
    const MEMORY: usize = E::MEMORY;
    const DISSIPATED: Option<usize> = E::DISSIPATED;
    type Code = Self;
    type Op<T: Real> = Hoop<T, N>;
    type Prepared<T: Real> = E::Prepared<T>;

    fn rule() -> Vec<[f64; 3]> {
        E::rule()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        E::mass_rule()
    }
    fn shape(xi: [f64; 2]) -> ([f64; N], [[f64; 2]; N]) {
        E::shape(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, N, 2>, parameter: f64, sides: &[T; N]) -> Self::Prepared<T> {
        E::prepare(x, parameter, sides)
    }
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, N, 2>,
        prepared: &Self::Prepared<T>,
        point: &Point<N>,
    ) -> Sample<T, Hoop<T, N>, A> {
        E::ring(x, prepared, point)
    }
    #[inline(always)]
    fn mean<T: Real>(x: &Nodal<T, N, 2>, prepared: &Self::Prepared<T>) -> Hoop<T, N> {
        let op = E::mean(x, prepared);
        let grad = std::array::from_fn(
            #[inline(always)]
            |a| {
                let rows = op.column(a, 0).0;
                [rows[0], rows[1]]
            },
        );
        Hoop { grad, row: [T::zero(); N] }
    }
    #[inline(always)]
    fn law_into<T: Real>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, 3>,
        section: &Section<N>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, N, 3>,
    ) {
        E::ring_into(x, q, section, history, tangent, out);
    }
    #[inline(always)]
    fn stabilization<T: Real>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, 3>,
        section: &Section<N>,
        own: &PerPoint<'_>,
        memory: &[f64],
    ) -> [[T; 2]; 2] {
        E::ring_stabilization(x, q, section, own, memory)
    }
}

/// The turned element in global dofs.
#[derive(Clone, Copy)]
pub struct Ring<E>(PhantomData<E>);

/// Local dofs: those of the frame, and the radial displacement.
#[inline(always)]
fn local_dofs<T: Real, const N: usize>(
    frame: &Frame<T, N, 2>,
    u: &Nodal<T, N, 2>,
) -> Nodal<T, N, 3> {
    std::array::from_fn(
        #[inline(always)]
        |a| [frame.q[a][0], frame.q[a][1], u[a][0]],
    )
}

impl<E, const N: usize, const A: usize> Element<N, 2, A> for Ring<E>
where
    E: Revolved<N, A>,
{
    const NAME: &'static str = E::NAME;
    const CELL: &'static str = E::CELL;
    const RING: bool = true;
    const FREE_VOLUME: bool = E::FREE_VOLUME;
    const BENDING_CELLS: usize = E::BENDING_CELLS;
    const ABOUT_MEAN: bool = E::ABOUT_MEAN;
    const MEAN_DILATATION: bool = E::MEAN_DILATATION;
    const MEMORY: usize = E::MEMORY;
    const DISSIPATED: Option<usize> = E::DISSIPATED;
    type Code = Self;
    type Op<T: Real> = E::Op<T>;
    type Prepared<T: Real> = E::Prepared<T>;

    fn rule() -> Vec<[f64; 3]> {
        E::rule()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        E::mass_rule()
    }
    fn shape(xi: [f64; 2]) -> ([f64; N], [[f64; 2]; N]) {
        E::shape(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, N, 2>, parameter: f64, sides: &[T; N]) -> Self::Prepared<T> {
        E::prepare(x, parameter, sides)
    }
    /// That of the plane element: what integrates goes through [`LocalRing`].
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, N, 2>,
        prepared: &Self::Prepared<T>,
        point: &Point<N>,
    ) -> Sample<T, Self::Op<T>, A> {
        E::sample(x, prepared, point)
    }
    #[inline(always)]
    fn measure<T: Real>(x: &Nodal<T, N, 2>, point: &Point<N>) -> T {
        (shapes::gradients(x, point).1 * radius(x, &point.n)).scale(TAU)
    }
    #[inline(always)]
    fn respond<T: Real>(
        x: &Nodal<T, N, 2>,
        u: &Nodal<T, N, 2>,
        section: &Section<N>,
        history: &mut History<'_>,
        wanted: Wanted,
        out: &mut Local<T, N, 2>,
    ) {
        let mut frame = Frame::new(x, u, wanted.nlgeom);
        let q = local_dofs(&frame, u);
        let mut local = Local::<T, N, 3>::zero();
        let (out_local, tangent) = (&mut local, wanted.tangent && T::STIFFNESS);
        if const { T::LANES == 1 } {
            integrate::single_into::<LocalRing<E>, T, N, 3, A>(
                x, &q, section, history, tangent, out_local,
            );
        } else {
            E::ring_into(x, &q, section, history, tangent, out_local);
        }
        out.failed = local.failed;
        let mut force = [[T::zero(); 2]; N];
        for a in 0..N {
            force[a] = [local.force[a][0], local.force[a][1]];
        }
        out.force = frame.force(&force);
        for a in 0..N {
            out.force[a][0] += local.force[a][2];
        }
        if wanted.stressed {
            frame = Frame::new(x, &[[T::zero(); 2]; N], true);
        }
        if const { !T::STIFFNESS } || !tangent {
            return;
        }
        // Coupling of the local dofs (rows) with the radial displacements (columns).
        let mut coupling = blocks::<T, N, 2>();
        for a in 0..N {
            for b in a..N {
                let k = &local.stiffness[a][b];
                for i in 0..2 {
                    for j in 0..2 {
                        out.stiffness[a][b][i][j] = k[i][j];
                    }
                    coupling[a][b][i][0] = k[i][2];
                    coupling[b][a][i][0] = k[2][i];
                }
            }
        }
        frame.stiffness(&force, &mut out.stiffness);
        frame.turn_columns(&mut coupling);
        for a in 0..N {
            for b in a..N {
                let m = &mut out.stiffness[a][b];
                m[0][0] += local.stiffness[a][b][2][2];
                for i in 0..2 {
                    m[i][0] += coupling[a][b][i][0];
                    m[0][i] += coupling[b][a][i][0];
                }
            }
        }
    }
    fn kinematics(
        x: &Nodal<f64, N, 2>,
        u: &Nodal<f64, N, 2>,
        alpha: &Nodal<f64, A, 2>,
        section: &Section<N>,
        own: &PerPoint<'_>,
        nlgeom: bool,
    ) -> Vec<PointKinematics> {
        let q = local_dofs(&Frame::new(x, u, nlgeom), u);
        integrate::kinematics::<LocalRing<E>, N, 3, A>(x, &q, alpha, section, own)
    }
    fn absorbed(
        x: &Nodal<f64, N, 2>,
        u: &Nodal<f64, N, 2>,
        section: &Section<N>,
        history: &mut History<'_>,
        nlgeom: bool,
    ) -> f64 {
        let q = local_dofs(&Frame::new(x, u, nlgeom), u);
        integrate::absorbed::<LocalRing<E>, N, 3, A>(x, &q, section, history)
    }
    #[inline(always)]
    fn stabilization<T: Real>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, 2>,
        section: &Section<N>,
        own: &PerPoint<'_>,
        memory: &[f64],
    ) -> [[T; 2]; 2] {
        // The radial displacement is no part of it.
        let q = q.map(
            #[inline(always)]
            |[a, b]| [a, b, T::zero()],
        );
        E::ring_stabilization(x, &q, section, own, memory)
    }
}
