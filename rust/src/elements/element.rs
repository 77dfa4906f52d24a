//! What an element is: sizes, quadrature, and the operator that gives the local
//! displacement gradient at a point. Everything else is written once elsewhere.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::small::{Blocks, Mat, Nodal};
use crate::base::{Real, shared_dual};
use crate::elements::line::Resultants;
use crate::elements::shapes;
use crate::kinematics::corotation::Frame;
use crate::kinematics::integrate::{self, History, Local, PointKinematics, Section};
use crate::kinematics::per_point::PerPoint;

/// What is wanted of [`Element::respond`].
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// Whether frames turn.
    pub nlgeom: bool,
    /// Whether the tangent has the stress stiffness of a linear state.
    pub stressed: bool,
    pub tangent: bool,
}

/// Quadrature point with the shape functions there, computed once per block.
#[derive(Clone, Debug)]
pub struct Point<const N: usize> {
    /// Natural coordinates; area coordinates (L1, L2) for triangles.
    pub xi: [f64; 2],
    pub weight: f64,
    /// Shape functions and their natural derivatives.
    pub n: [f64; N],
    pub dn: [[f64; 2]; N],
}

/// The gradient operator of an element: rows `u,x  u,y  v,x  v,y` of the local displacement
/// gradient as linear functions of the nodal values, by node blocks.
pub trait Operator<T: Real, const N: usize, const M: usize>: Copy {
    /// Whether the operator carries a drilling row (skew gradient minus rotation).
    const DRILL: bool;
    /// Whether the fifth row is the hoop stretch, see [`Hoop`].
    const HOOP: bool = false;

    /// Gradient that the nodal values give.
    fn gradient(&self, q: &Nodal<T, N, M>) -> [T; 4];
    /// Value of the fifth row: of drilling, or of the hoop.
    fn drill(&self, q: &Nodal<T, N, M>) -> T;
    /// `f += H^T p + r^T drill`.
    fn add_force(&self, p: &[T; 4], drill: T, f: &mut Nodal<T, N, M>);
    /// `K += H^T A H + gamma r^T r`, blocks `a <= b`; `A` symmetric.
    fn add_stiffness(&self, a: &Mat<T, 4>, gamma: T, k: &mut Blocks<T, N, M>);
    /// `K += H^T c r^T + r c^T H`: coupling of the gradient with the fifth row; only with a hoop.
    #[inline(always)]
    fn add_coupling(&self, _c: &[T; 4], _k: &mut Blocks<T, N, M>) {}
    /// Rows of one nodal value: gradient and fifth row of dof `i` of node `a`.
    fn column(&self, a: usize, i: usize) -> ([T; 4], T);
}

/// Sample of an element at one point.
#[derive(Clone, Copy)]
pub struct Sample<T, Op, const A: usize> {
    pub op: Op,
    /// Gradients of the internal (incompatible or bubble) modes, each a displacement vector.
    pub modes: [[T; 2]; A],
    /// Jacobian determinant times quadrature weight, [length^2].
    pub weight: T,
}

/// An element with `N` nodes, `M` dofs a node (2, or 3 with the drilling rotation) and `A`
/// internal displacement modes of two components each.
pub trait Element<const N: usize, const M: usize, const A: usize>:
    Copy + Send + Sync + 'static
{
    const NAME: &'static str;
    /// Kind of cell that it fits.
    const CELL: &'static str;
    /// Zero-energy modes beyond the three rigid ones.
    const HOURGLASS: usize = 0;
    /// Share of the normal edge traction that goes into end moments (0 without drilling).
    const ALPHA_B: f64 = 0.0;
    /// Number of each edge for [`Element::prepare`], where the thickness is uniform.
    const EDGE: f64 = Self::ALPHA_B;
    /// Whether it is a line element (truss, beam, spring) and no part of the plane.
    const LINE: bool = false;
    /// Whether it is a spring: a line element without mass, section and axial strain.
    const SPRING: bool = false;
    /// Whether its frame turns with it.
    const TURNS: bool = true;
    /// Whether it is a solid of revolution, see [`crate::elements::ring`].
    const RING: bool = false;
    /// Names of its resultants; line elements only.
    const OUTPUTS: &'static [&'static str] = &[];
    /// Names of what it gives beside them where its law has a history.
    const FLOW_OUTPUTS: &'static [&'static str] = &[];

    /// Whether the volume can stay constant (plastic flow, Poisson's ratio of a half) in plane
    /// strain without locking.
    const FREE_VOLUME: bool = false;
    /// Cells through the width of a slender part below which the element is too stiff in bending;
    /// 0 for none.
    const BENDING_CELLS: usize = 0;
    /// Whether nonlinear strains are linear about the mean gradient, see
    /// [`crate::kinematics::about_mean`].
    const ABOUT_MEAN: bool = false;

    /// Whether it may have a mean dilatation: not with the constant volume strain of a triangle, nor
    /// with incompatible modes, which would have no stiffness then.
    const MEAN_DILATATION: bool = !Self::LINE && Self::MEMORY == 0 && N != 3 && N != 6 && A < 2;
    /// Numbers of history of the element as a whole, beside those of its points, where the law
    /// has a history.
    const MEMORY: usize = 0;
    /// Member of this memory with the work that the element has dissipated beside its points.
    const DISSIPATED: Option<usize> = None;

    /// Element whose compiled code evaluates this one: itself, or one with another rule.
    type Code: Element<N, M, A>;
    type Op<T: Real>: Operator<T, N, M>;
    /// What is computed once per element before its points.
    type Prepared<T: Real>: Copy;

    /// Natural coordinates and weights of the stiffness rule.
    fn rule() -> Vec<[f64; 3]>;
    /// Natural coordinates and weights of the mass rule.
    fn mass_rule() -> Vec<[f64; 3]>;
    /// Shape functions and natural derivatives.
    fn shape(xi: [f64; 2]) -> ([f64; N], [[f64; 2]; N]);
    /// Functions of the mid-sides, one for each edge (a, a + 1); drilling elements and beams only.
    fn sides(_xi: [f64; 2]) -> [f64; N] {
        [0.0; N]
    }
    /// A number that the element derives from the elastic moduli (plane, 3 x 3).
    fn parameter(_moduli: &Mat<f64, 3>) -> f64 {
        0.0
    }
    /// The same number from a weight of the higher-order stiffness; elements that have one.
    fn parameter_of(_beta0: f64) -> Option<f64> {
        None
    }
    /// Number of an edge for [`Element::prepare`], from its share [`Element::ALPHA_B`] and its mean
    /// thickness over that of the element.
    fn edge(share: f64, _thickness: f64) -> f64 {
        share
    }
    /// `sides` are the numbers of the edges (a, a + 1). The share of an edge is less where the
    /// element shares it with one of a smaller share.
    fn prepare<T: Real>(x: &Nodal<T, N, 2>, parameter: f64, sides: &[T; N]) -> Self::Prepared<T>;
    fn sample<T: Real>(
        x: &Nodal<T, N, 2>,
        prepared: &Self::Prepared<T>,
        point: &Point<N>,
    ) -> Sample<T, Self::Op<T>, A>;

    /// Operator of the mean gradient, of elements with [`Element::ABOUT_MEAN`]; internal modes
    /// must not have one.
    fn mean<T: Real>(_x: &Nodal<T, N, 2>, _prepared: &Self::Prepared<T>) -> Self::Op<T> {
        unreachable!("an element that is linear about the mean gradient gives its operator")
    }

    /// Area (length of line elements) that belongs to a point.
    #[inline(always)]
    fn measure<T: Real>(x: &Nodal<T, N, 2>, point: &Point<N>) -> T {
        shapes::gradients(x, point).1
    }
    /// Local force and stiffness into a zero `out`: of planar elements the integral over the
    /// points.
    #[inline(always)]
    fn law_into<T: Real>(
        x: &Nodal<T, N, 2>,
        q: &Nodal<T, N, M>,
        section: &Section<N>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, N, M>,
    ) {
        integrate::local_into::<Self, T, N, M, A>(x, q, section, history, tangent, out);
    }
    /// Force and, with `tangent`, stiffness in global axes at displacements `u`, into a zero `out`.
    #[inline(always)]
    fn respond<T: Real>(
        x: &Nodal<T, N, 2>,
        u: &Nodal<T, N, M>,
        section: &Section<N>,
        history: &mut History<'_>,
        wanted: Wanted,
        out: &mut Local<T, N, M>,
    ) {
        let mut frame = Frame::new(x, u, wanted.nlgeom && Self::TURNS);
        let (q, tangent) = (&frame.q, wanted.tangent && T::STIFFNESS);
        if const { T::LANES == 1 } {
            integrate::single_into::<Self, T, N, M, A>(x, q, section, history, tangent, out);
        } else {
            Self::law_into(x, q, section, history, tangent, out);
        }
        let local = out.force;
        out.force = frame.force(&local);
        if wanted.stressed && Self::TURNS {
            // Forces turn with the element, from the reference on.
            frame = Frame::new(x, &[[T::zero(); M]; N], true);
        }
        if const { T::STIFFNESS && Self::TURNS } && tangent {
            frame.stiffness(&local, &mut out.stiffness);
        }
    }
    /// Kinematics at the points, with the internal modes `alpha`.
    fn kinematics(
        x: &Nodal<f64, N, 2>,
        u: &Nodal<f64, N, M>,
        alpha: &Nodal<f64, A, 2>,
        section: &Section<N>,
        own: &PerPoint<'_>,
        nlgeom: bool,
    ) -> Vec<PointKinematics> {
        let frame = Frame::new(x, u, nlgeom && Self::TURNS);
        integrate::kinematics::<Self, N, M, A>(x, &frame.q, alpha, section, own)
    }
    /// [`integrate::absorbed`] at local dofs.
    fn absorbed_at(
        x: &Nodal<f64, N, 2>,
        q: &Nodal<f64, N, M>,
        section: &Section<N>,
        history: &mut History<'_>,
    ) -> f64 {
        integrate::absorbed::<Self, N, M, A>(x, q, section, history)
    }
    /// The same at displacements `u`.
    fn absorbed(
        x: &Nodal<f64, N, 2>,
        u: &Nodal<f64, N, M>,
        section: &Section<N>,
        history: &mut History<'_>,
        nlgeom: bool,
    ) -> f64 {
        let frame = Frame::new(x, u, nlgeom && Self::TURNS);
        Self::absorbed_at(x, &frame.q, section, history)
    }
    /// Energies of what keeps an element of a reduced rule from deforming freely between its points,
    /// each with the stiffness to which it is proportional; `memory` of the state, empty where the
    /// law has none.
    #[inline(always)]
    fn stabilization<T: Real>(
        _x: &Nodal<T, N, 2>,
        _q: &Nodal<T, N, M>,
        _section: &Section<N>,
        _own: &PerPoint<'_>,
        _memory: &[f64],
    ) -> [[T; 2]; 2] {
        [[T::zero(), T::one()]; 2]
    }
    /// Resultants of line elements, with the history of an evaluation.
    fn resultants(
        _x: &Nodal<f64, N, 2>,
        _q: &Nodal<f64, N, M>,
        _section: &Section<N>,
        _history: &mut History<'_>,
    ) -> Resultants {
        Resultants::default()
    }

    /// The points of a rule with the shape functions there.
    fn points(rule: &[[f64; 3]]) -> Vec<Point<N>> {
        tabulate(rule, Self::shape)
    }
}

fn tabulate<const N: usize>(
    rule: &[[f64; 3]],
    shape: fn([f64; 2]) -> ([f64; N], [[f64; 2]; N]),
) -> Vec<Point<N>> {
    let at = |&[r, s, weight]: &[f64; 3]| {
        let (n, dn) = shape([r, s]);
        Point { xi: [r, s], weight, n, dn }
    };
    rule.iter().map(at).collect()
}

/// Operator of elements whose displacement is interpolated from the nodes: only the
/// derivatives of the shape functions are stored, the zeros are known.
#[derive(Clone, Copy)]
pub struct Grad<T, const N: usize>(pub [[T; 2]; N]);

impl<T: Real, const N: usize> Operator<T, N, 2> for Grad<T, N> {
    const DRILL: bool = false;

    #[inline(always)]
    fn gradient(&self, q: &Nodal<T, N, 2>) -> [T; 4] {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let mut h = [T::zero(); 4];
                for a in 0..N {
                    for i in 0..2 {
                        for j in 0..2 {
                            h[2 * i + j] = self.0[a][j].fma(q[a][i], h[2 * i + j]);
                        }
                    }
                }
                h
            },
        )
    }
    #[inline(always)]
    fn drill(&self, _: &Nodal<T, N, 2>) -> T {
        T::zero()
    }
    #[inline(always)]
    fn add_force(&self, p: &[T; 4], _: T, f: &mut Nodal<T, N, 2>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                for a in 0..N {
                    for i in 0..2 {
                        for j in 0..2 {
                            f[a][i] = self.0[a][j].fma(p[2 * i + j], f[a][i]);
                        }
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn add_stiffness(&self, m: &Mat<T, 4>, _: T, k: &mut Blocks<T, N, 2>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                for b in 0..N {
                    // t[r][j]: row r of A H for component j of node b
                    let mut t = [[T::zero(); 2]; 4];
                    for r in 0..4 {
                        for j in 0..2 {
                            t[r][j] = m[r][2 * j].fma(self.0[b][0], m[r][2 * j + 1] * self.0[b][1]);
                        }
                    }
                    for a in 0..=b {
                        for i in 0..2 {
                            for j in 0..2 {
                                let v = self.0[a][0].fma(t[2 * i][j], k[a][b][i][j]);
                                k[a][b][i][j] = self.0[a][1].fma(t[2 * i + 1][j], v);
                            }
                        }
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn column(&self, a: usize, i: usize) -> ([T; 4], T) {
        let mut c = [T::zero(); 4];
        c[2 * i] = self.0[a][0];
        c[2 * i + 1] = self.0[a][1];
        (c, T::zero())
    }
}

/// Operator of elements whose strain is assumed: all rows of all dofs are stored.
#[derive(Clone, Copy)]
pub struct Full<T, const N: usize>(pub [[[T; 4]; 3]; N]);

impl<T: Real, const N: usize> Operator<T, N, 3> for Full<T, N> {
    const DRILL: bool = false;

    #[inline(always)]
    fn gradient(&self, q: &Nodal<T, N, 3>) -> [T; 4] {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let mut h = [T::zero(); 4];
                for a in 0..N {
                    for i in 0..3 {
                        for r in 0..4 {
                            h[r] = self.0[a][i][r].fma(q[a][i], h[r]);
                        }
                    }
                }
                h
            },
        )
    }
    #[inline(always)]
    fn drill(&self, _: &Nodal<T, N, 3>) -> T {
        T::zero()
    }
    #[inline(always)]
    fn add_force(&self, p: &[T; 4], _: T, f: &mut Nodal<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                for a in 0..N {
                    for i in 0..3 {
                        for r in 0..4 {
                            f[a][i] = self.0[a][i][r].fma(p[r], f[a][i]);
                        }
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn add_stiffness(&self, m: &Mat<T, 4>, _: T, k: &mut Blocks<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                for b in 0..N {
                    let mut t = [[T::zero(); 4]; 3];
                    for j in 0..3 {
                        t[j] = times(m, &self.0[b][j]);
                    }
                    for a in 0..=b {
                        for i in 0..3 {
                            for j in 0..3 {
                                let mut v = k[a][b][i][j];
                                for r in 0..4 {
                                    v = self.0[a][i][r].fma(t[j][r], v);
                                }
                                k[a][b][i][j] = v;
                            }
                        }
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn column(&self, a: usize, i: usize) -> ([T; 4], T) {
        (self.0[a][i], T::zero())
    }
}

/// Operator of elements with interpolated displacements and drilling rotations: the drilling
/// row is the skew gradient minus the interpolated rotation, so it needs no storage.
#[derive(Clone, Copy)]
pub struct Drilling<T, const N: usize> {
    /// Derivatives of the shape functions.
    pub grad: [[T; 2]; N],
    /// Gradient rows of the rotations.
    pub turn: [[T; 4]; N],
    /// Shape functions, which interpolate the rotation.
    pub n: [f64; N],
}

impl<T: Real, const N: usize> Operator<T, N, 3> for Drilling<T, N> {
    const DRILL: bool = true;

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
                    for r in 0..4 {
                        h[r] = self.turn[a][r].fma(q[a][2], h[r]);
                    }
                }
                h
            },
        )
    }
    #[inline(always)]
    fn drill(&self, q: &Nodal<T, N, 3>) -> T {
        let h = self.gradient(q);
        let mut s = (h[2] - h[1]).scale(0.5);
        for a in 0..N {
            s = T::real(-self.n[a]).fma(q[a][2], s);
        }
        s
    }
    #[inline(always)]
    fn add_force(&self, p: &[T; 4], drill: T, f: &mut Nodal<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let half = drill.scale(0.5);
                let p = [p[0], p[1] - half, p[2] + half, p[3]];
                for a in 0..N {
                    for i in 0..2 {
                        for j in 0..2 {
                            f[a][i] = self.grad[a][j].fma(p[2 * i + j], f[a][i]);
                        }
                    }
                    f[a][2] = T::real(-self.n[a]).fma(drill, f[a][2]);
                    for r in 0..4 {
                        f[a][2] = self.turn[a][r].fma(p[r], f[a][2]);
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn add_stiffness(&self, m: &Mat<T, 4>, gamma: T, k: &mut Blocks<T, N, 3>) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let (half, quarter) = (gamma.scale(0.5), gamma.scale(0.25));
                let mut m = *m;
                for (i, j) in [(1, 2), (2, 1)] {
                    m[i][i] += quarter;
                    m[i][j] -= quarter;
                }
                // Rows of the product for the rotation of each node; the fifth is that of the
                // interpolated rotation.
                let mut t = [[T::zero(); 5]; N];
                for b in 0..N {
                    let h = &self.turn[b];
                    let v = times(&m, h);
                    let n = T::real(self.n[b]);
                    let skew = half * (h[1] - h[2]);
                    t[b] =
                        [v[0], n.fma(half, v[1]), (-n).fma(half, v[2]), v[3], n.fma(gamma, skew)];
                }
                for b in 0..N {
                    let g = &self.grad[b];
                    let mut s = [[T::zero(); 2]; 4];
                    for r in 0..4 {
                        for j in 0..2 {
                            s[r][j] = m[r][2 * j].fma(g[0], m[r][2 * j + 1] * g[1]);
                        }
                    }
                    for a in 0..=b {
                        let ga = &self.grad[a];
                        let k = &mut k[a][b];
                        for i in 0..2 {
                            for j in 0..2 {
                                k[i][j] =
                                    ga[0].fma(s[2 * i][j], ga[1].fma(s[2 * i + 1][j], k[i][j]));
                            }
                            k[i][2] = ga[0].fma(t[b][2 * i], ga[1].fma(t[b][2 * i + 1], k[i][2]));
                            k[2][i] = g[0].fma(t[a][2 * i], g[1].fma(t[a][2 * i + 1], k[2][i]));
                        }
                        k[2][2] = T::real(self.n[a]).fma(t[b][4], k[2][2]);
                        for r in 0..4 {
                            k[2][2] = self.turn[a][r].fma(t[b][r], k[2][2]);
                        }
                    }
                }
            },
        );
    }
    #[inline(always)]
    fn column(&self, a: usize, i: usize) -> ([T; 4], T) {
        let mut h = [T::zero(); 4];
        if i < 2 {
            h[2 * i] = self.grad[a][0];
            h[2 * i + 1] = self.grad[a][1];
        } else {
            h = self.turn[a];
        }
        let skew = (h[2] - h[1]).scale(0.5);
        (h, if i < 2 { skew } else { skew - T::real(self.n[a]) })
    }
}

#[inline(always)]
fn times<T: Real>(m: &Mat<T, 4>, h: &[T; 4]) -> [T; 4] {
    let mut t = [T::zero(); 4];
    for r in 0..4 {
        t[r] = m[r][0].fma(h[0], m[r][1] * h[1]);
        t[r] = m[r][2].fma(h[2], t[r]);
        t[r] = m[r][3].fma(h[3], t[r]);
    }
    t
}
