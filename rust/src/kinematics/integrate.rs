//! Integration of the local element law over its points, with the internal modes condensed:
//! written once for every element, material and local strain.
// SPDX-License-Identifier: BSD-3-Clause

use super::about_mean::AboutMean;
use super::dilatation::{Dilatation, by_modes, times};
use super::law_tape::{LawTape, WIDTH, Way};
use super::local_strain::{LocalStrain, det};
use super::modes::{condense, linear_modes, relax};
use super::per_point::PerPoint;
use crate::base::small::{Blocks, Mat, Nodal, blocks, ldlt, ldlt_solve, nodal};
use crate::base::{Job, Real};
use crate::elements::fibers::STATIONS;
use crate::elements::{Element, Operator, Point, Sample};
use crate::materials::{Clock, Law, Plane, PointState, Response, SolidResponse};

/// Least stiffness of an internal mode, relative to the elastic one in shear. Where all points
/// of an element flow alike without hardening, a mode may have none at all; then its coupling
/// with the nodes vanishes too, and the lifted pivot only keeps it where it is.
const LEAST_PIVOT: f64 = 1e-6;
/// Share of the elastic stiffness in the plane that a flowing point of an ideal law keeps in the
/// tangent of an element. Where all points of a part flow alike, modes that spread the flow unevenly
/// have no stiffness, and no force drives them: this keeps them where they are. Forces are exact, and
/// an iteration of Newton gains nine digits still.
pub const KEPT: f64 = 1e-9;
/// Most internal components of an element (two for each mode).
pub(super) const INTERNAL: usize = 4;

/// What all elements of a block share.
#[derive(Clone, Debug)]
pub struct Section<const N: usize> {
    pub points: Vec<Point<N>>,
    pub law: Law,
    pub plane: Plane,
    /// Whether it is a solid of revolution.
    pub ring: bool,
    pub strain: LocalStrain,
    /// Thickness; of line elements the area of the cross-section.
    pub thickness: f64,
    /// Numbers of line elements, see each.
    pub profile: [f64; 3],
    /// Pairs of elongation and force of nonlinear springs, rising; empty for linear ones.
    pub table: Vec<[f64; 2]>,
    /// Distance from the axis to the left, area and initial strain of the fibers of a beam; empty for
    /// an elastic one, whose profile says all.
    pub fibers: Vec<[f64; 3]>,
    /// [`Element::parameter`] of the law's moduli.
    pub parameter: f64,
    /// Whether the volume strain is its mean over the element.
    pub mean_dilatation: bool,
    /// Whether displacements are finite, so that a cell may turn inside out; infinitesimal
    /// ones have no size of their own.
    pub finite: bool,
}

impl<const N: usize> Section<N> {
    /// Points of an element where its law has a history.
    pub fn n_histories(&self) -> usize {
        if self.fibers.is_empty() { self.points.len() } else { STATIONS * self.fibers.len() }
    }

    /// The same section for a geometrically linear analysis.
    pub fn linearized(&self) -> Self {
        let law = self.law.linearized();
        Self { law, strain: LocalStrain::Linear, finite: false, ..self.clone() }
    }

    /// The same section about a state of such an analysis, with the stiffness of its stress.
    pub fn stressed(&self) -> Self {
        let law = self.law.linearized();
        Self { law, strain: self.strain.stressed(), finite: false, ..self.clone() }
    }
}

/// History of a batch of elements: state members by point, internal modes; `stride` apart.
pub struct History<'a> {
    pub old: &'a [f64],
    pub new: &'a mut [f64],
    pub alpha: &'a mut [f64],
    /// Initial strain: by point rows xx, yy, xy and, through the thickness, a strain in plane
    /// stress and around a ring, or a stress in plane strain (see
    /// [`crate::materials::Material::spherical`]); empty where there is none.
    pub initial: &'a [f64],
    pub stride: usize,
    pub clock: Clock,
    pub per_point: PerPoint<'a>,
    /// Laws linear about the state, for numbers with derivatives.
    pub tape: Option<&'a mut LawTape>,
}

impl History<'_> {
    /// Answer of a law at a point, whose stress acts on the volume `w`.
    #[inline(always)]
    pub fn answer<T: Real>(&mut self, p: usize, law: &Law, e: [T; 3], w: T) -> Response<T> {
        // Laws have no instance for numbers that only go backwards.
        if const { T::DERIVATIVES > 0 } && (const { T::DERIVATIVES < WIDTH } || self.tape.is_some())
        {
            let tape = self.tape.take().expect("derivatives go backwards along a tape");
            let state = &mut self.point(p, law.n_state());
            let update = |e, state: &mut PointState<'_>| {
                let answer = law.update(e, state);
                (answer.stress, answer.tangent, answer.failed)
            };
            let (stress, tangent, failed) = tape.answer(p, e, w, state, update);
            self.tape = Some(tape);
            return Response { stress, tangent, failed };
        }
        law.update(e, &mut self.point(p, law.n_state()))
    }
    /// The same with a strain through the thickness.
    #[inline(always)]
    pub fn solid_answer<T: Real>(
        &mut self,
        p: usize,
        law: &Law,
        e: [T; 4],
        w: T,
    ) -> SolidResponse<T> {
        if const { T::DERIVATIVES > 0 } && (const { T::DERIVATIVES < WIDTH } || self.tape.is_some())
        {
            let tape = self.tape.take().expect("derivatives go backwards along a tape");
            let state = &mut self.point(p, law.n_state());
            let update = |e, state: &mut PointState<'_>| {
                let answer = law.update_solid(e, state);
                (answer.stress, answer.tangent, answer.failed)
            };
            let (stress, tangent, failed) = tape.answer(p, e, w, state, update);
            self.tape = Some(tape);
            return SolidResponse { stress, tangent, failed };
        }
        law.update_solid(e, &mut self.point(p, law.n_state()))
    }
    /// Initial strain of a point, zero where there is none.
    #[inline(always)]
    pub fn initial_strain<T: Real>(&self, p: usize, row: usize) -> T {
        if self.initial.is_empty() {
            return T::zero();
        }
        T::load(&self.initial[(4 * p + row) * self.stride..])
    }
    /// Strain that the law sees.
    #[inline(always)]
    fn elastic<T: Real>(&self, p: usize, mut strain: [T; 3]) -> [T; 3] {
        if !self.initial.is_empty() {
            for (row, e) in strain.iter_mut().enumerate() {
                *e -= self.initial_strain(p, row);
            }
        }
        strain
    }
    /// Part of the initial stress through the thickness that acts in the plane.
    #[inline(always)]
    fn spherical<T: Real, const N: usize>(&self, p: usize, section: &Section<N>) -> T {
        if section.plane == Plane::Strain && !section.ring && section.law.spherical() {
            self.initial_strain(p, 3)
        } else {
            T::zero()
        }
    }
    /// Largest initial strain of the element.
    #[inline(always)]
    pub(super) fn largest<T: Real, const N: usize>(&self, section: &Section<N>) -> T {
        let mut size = T::zero();
        if self.initial.is_empty() {
            return size;
        }
        let softness = 1.0 / self.per_point.law::<T, N>(0, section).moduli()[0][0];
        for p in 0..section.points.len() {
            for row in 0..3 {
                size = size.max(self.initial_strain::<T>(p, row).abs());
            }
            if section.ring {
                size = size.max(self.initial_strain::<T>(p, 3).abs());
            }
            size = size.max(self.spherical::<T, N>(p, section).scale(softness).abs());
        }
        size
    }
    /// History of the element as a whole.
    #[inline(always)]
    pub fn memory<const N: usize>(&mut self, section: &Section<N>) -> PointState<'_> {
        self.point(section.n_histories(), section.law.n_state())
    }
    /// History of the law at a point.
    #[inline(always)]
    pub fn point(&mut self, p: usize, members: usize) -> PointState<'_> {
        // An empty history may not be sliced past its end.
        let start = if members == 0 { 0 } else { p * members * self.stride };
        PointState {
            old: &self.old[start..],
            new: &mut self.new[start..],
            stride: self.stride,
            clock: self.clock,
        }
    }
}

/// Local force and stiffness (blocks `a <= b`), and the lanes that failed.
pub struct Local<T: Real, const N: usize, const M: usize> {
    pub force: Nodal<T, N, M>,
    pub stiffness: Blocks<T, N, M>,
    pub failed: T::Mask,
}

impl<T: Real, const N: usize, const M: usize> Local<T, N, M> {
    /// Zero, to be filled by [`local_into`].
    #[inline(always)]
    pub fn zero() -> Self {
        Self { force: nodal(), stiffness: blocks(), failed: T::none() }
    }
}

/// Gradient at a point: nodal part plus internal modes.
#[inline(always)]
pub fn gradient<T: Real, Op, const N: usize, const M: usize, const A: usize>(
    s: &Sample<T, Op, A>,
    q: &Nodal<T, N, M>,
    alpha: &Nodal<T, A, 2>,
) -> [T; 4]
where
    Op: Operator<T, N, M>,
{
    let mut h = s.op.gradient(q);
    for m in 0..A {
        for i in 0..2 {
            for j in 0..2 {
                h[2 * i + j] = s.modes[m][j].fma(alpha[m][i], h[2 * i + j]);
            }
        }
    }
    h
}

/// Whether the nodes have folded an element of three or four, at the points of integration, which
/// lie 0.58 of the way to the corners. Modes and rotations can hide it from the gradient.
#[inline(always)]
fn folded<T: Real, const N: usize, const M: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
) -> T::Mask {
    let place = |a: usize| [x[a % N][0] + q[a % N][0], x[a % N][1] + q[a % N][1]];
    let mut turns = [T::zero(); N];
    let mut mean = T::zero();
    for (a, turn) in turns.iter_mut().enumerate() {
        let (before, at, after) = (place(a + N - 1), place(a), place(a + 1));
        let (next, last) =
            ([after[0] - at[0], after[1] - at[1]], [before[0] - at[0], before[1] - at[1]]);
        *turn = next[0] * last[1] - next[1] * last[0];
        mean += turn.scale(1.0 / N as f64);
    }
    let mut failed = T::none();
    for turn in turns {
        failed = T::or(failed, (mean + (turn - mean).scale(0.577)).lt(T::zero()));
    }
    failed
}

/// Hoop strain of a ring at a point, and what the law gives there beside the plane.
struct Around<T> {
    /// Hoop stretch less one.
    w: T,
    strain: T,
    /// Derivatives of the strain by the stretch.
    slope: T,
    curvature: T,
    stress: T,
    /// Tangent between the plane and the hoop, and of the hoop.
    column: [T; 3],
    square: T,
}

impl<T: Real> Around<T> {
    /// None unless the operator has a hoop row.
    #[inline(always)]
    fn new<Op, const N: usize, const M: usize>(
        op: &Op,
        q: &Nodal<T, N, M>,
        kind: LocalStrain,
    ) -> Option<Self>
    where
        Op: Operator<T, N, M>,
    {
        if const { !Op::HOOP } {
            return None;
        }
        let o = T::zero();
        let w = op.drill(q);
        let [strain, slope, curvature] = kind.hoop(w);
        Some(Self { w, strain, slope, curvature, stress: o, column: [o; 3], square: o })
    }

    /// Take the answer of a law apart: what remains is that in the plane.
    #[inline(always)]
    fn take(&mut self, solid: &SolidResponse<T>) -> Response<T> {
        let [xx, yy, xy, zz] = solid.stress;
        self.stress = zz;
        Response { stress: [xx, yy, xy], tangent: self.part(&solid.tangent), failed: solid.failed }
    }

    /// Take a tangent with the rows xx, yy, xy, zz apart.
    #[inline(always)]
    fn part(&mut self, d: &Mat<T, 4>) -> Mat<T, 3> {
        let mut plane = [[T::zero(); 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                plane[i][j] = d[i][j];
            }
            self.column[i] = d[i][3];
        }
        self.square = d[3][3];
        plane
    }

    /// The whole tangent.
    #[inline(always)]
    fn join(&self, plane: &Mat<T, 3>) -> Mat<T, 4> {
        let mut d = [[self.square; 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                d[i][j] = plane[i][j];
            }
            (d[i][3], d[3][i]) = (self.column[i], self.column[i]);
        }
        d
    }
}

/// Drilling row of an internal mode: its skew gradient.
#[inline(always)]
fn mode_drill<T: Real>(mode: &[T; 2], i: usize) -> T {
    if i == 0 { mode[1].scale(-0.5) } else { mode[0].scale(0.5) }
}

/// Sums over the points for the internal modes; of the symmetric matrix the lower triangle.
pub(super) struct Internal<T: Real, const N: usize, const M: usize> {
    pub(super) force: [T; INTERNAL],
    pub(super) stiffness: Mat<T, INTERNAL>,
    /// Least pivots: see [`LEAST_PIVOT`].
    pub(super) least: [T; INTERNAL],
    /// Largest component of the stress.
    pub(super) stress: T,
    pub(super) coupling: [Nodal<T, N, M>; INTERNAL],
    /// Tangent of the material at the last point.
    pub(super) tangent: Mat<T, 3>,
    pub(super) failed: T::Mask,
}

/// One pass over the points. Adds to `out`, if given, nodal force and, with `tangent`, nodal
/// stiffness; without it the coupling stays zero.
#[inline(always)]
pub(super) fn pass<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    alpha: &Nodal<T, A, 2>,
    section: &Section<N>,
    history: &mut History<'_>,
    out: Option<&mut Local<T, N, M>>,
    tangent: bool,
) -> Internal<T, N, M>
where
    E: Element<N, M, A>,
{
    if const { T::LANES == 1 && A > 0 } {
        single_pass::<E, T, N, M, A>(x, q, alpha, section, history, out, tangent)
    } else {
        points::<E, T, N, M, A>(x, q, alpha, section, history, out, tangent)
    }
}

/// [`points`] out of line: one instance for the internal modes and for what follows.
#[inline(never)]
fn single_pass<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    alpha: &Nodal<T, A, 2>,
    section: &Section<N>,
    history: &mut History<'_>,
    out: Option<&mut Local<T, N, M>>,
    tangent: bool,
) -> Internal<T, N, M>
where
    E: Element<N, M, A>,
{
    let tangent = tangent && T::STIFFNESS;
    points::<E, T, N, M, A>(x, q, alpha, section, history, out, tangent)
}

/// The loop of [`pass`].
#[inline(always)]
fn points<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    alpha: &Nodal<T, A, 2>,
    section: &Section<N>,
    history: &mut History<'_>,
    mut out: Option<&mut Local<T, N, M>>,
    tangent: bool,
) -> Internal<T, N, M>
where
    E: Element<N, M, A>,
{
    let o = T::zero();
    let mut sums = Internal {
        force: [o; INTERNAL],
        stiffness: [[o; INTERNAL]; INTERNAL],
        least: [o; INTERNAL],
        stress: o,
        coupling: [nodal(); INTERNAL],
        tangent: [[o; 3]; 3],
        failed: T::none(),
    };
    let members = section.law.n_state();
    let own = history.per_point;
    let parameter = own.parameter::<T, N>(section);
    let stiff = if A > 0 { LEAST_PIVOT * own.law::<T, N>(0, section).moduli()[2][2] } else { 0.0 };
    // On a tape the modes are known once forces are wanted.
    let known = T::DERIVATIVES > 0 && history.tape.is_some() && out.is_some();
    let matrices = tangent || (A > 0 && !known);
    let prepared = E::prepare(x, parameter, &own.sides(E::EDGE));
    let mut bar = Dilatation::<T, N, M>::new::<E, A>(x, q, alpha, &prepared, section);
    let mut about = AboutMean::<T, E::Op<T>, N, M>::new::<E, A>(x, q, &prepared, section);
    if section.finite && (A > 0 || M == 3 || E::MEMORY > 0) && (N == 3 || N == 4) {
        sums.failed = folded(x, q);
    }
    // Coupling of the internal modes with the mean gradient.
    let mut to_mean = [[o; 4]; INTERNAL];
    for (p, point) in section.points.iter().enumerate() {
        let s = E::sample(x, &prepared, point);
        let w = s.weight * own.thickness::<T, N>(p, section);
        let h = gradient(&s, q, alpha);
        let mut strain = if const { E::ABOUT_MEAN }
            && let Some(about) = &about
        {
            about.strain(&h)
        } else {
            section.strain.strain(&h)
        };
        let mut around = Around::<T>::new::<E::Op<T>, N, M>(&s.op, q, section.strain);
        if const { E::MEAN_DILATATION }
            && let Some(bar) = &bar
        {
            if const { E::Op::<T>::HOOP }
                && let Some(around) = &mut around
            {
                bar.apply_to_ring(&mut strain, &mut around.strain);
            } else {
                bar.apply(&mut strain);
            }
        }
        let strain = history.elastic(p, strain);
        let law = own.law::<T, N>(p, section);
        let mut answer;
        if const { E::Op::<T>::HOOP }
            && let Some(around) = &mut around
        {
            if !history.initial.is_empty() {
                around.strain -= history.initial_strain(p, 3);
            }
            let [xx, yy, xy] = strain;
            answer = around.take(&history.solid_answer(p, law, [xx, yy, xy, around.strain], w));
        } else {
            answer = history.answer(p, law, strain, w);
            if !history.initial.is_empty() {
                let pressure = history.spherical::<T, N>(p, section);
                answer.stress[0] += pressure;
                answer.stress[1] += pressure;
            }
        }
        sums.tangent = answer.tangent;
        if law.ideal()
            && let Some(member) = law.plastic_member()
        {
            let state = history.point(p, members);
            let flows = state.get::<T>(member).lt(T::load(&state.new[member * state.stride..]));
            let (kept, moduli) = (T::select(flows, T::real(KEPT), T::zero()), law.moduli());
            for i in 0..3 {
                for j in 0..3 {
                    answer.tangent[i][j] = kept.fma(T::real(moduli[i][j]), answer.tangent[i][j]);
                }
            }
        }
        for v in &answer.stress {
            sums.stress = sums.stress.max(v.abs());
        }
        sums.failed = T::or(sums.failed, answer.failed);
        if section.finite {
            let seen = if const { E::ABOUT_MEAN }
                && let Some(about) = &about
            {
                &about.h
            } else {
                &h
            };
            sums.failed = T::or(sums.failed, det(seen).lt(o));
            if const { E::Op::<T>::HOOP }
                && let Some(around) = &around
            {
                sums.failed = T::or(sums.failed, (around.w + T::one()).lt(o));
            }
        }
        if const { E::MEAN_DILATATION }
            && let Some(bar) = &mut bar
        {
            if const { E::Op::<T>::HOOP }
                && let Some(around) = &mut around
            {
                bar.split_ring_stress(&mut answer.stress, &mut around.stress, w);
            } else {
                bar.split_stress(&mut answer.stress, w);
            }
        }
        let mut stress = if const { E::ABOUT_MEAN }
            && let Some(about) = &about
        {
            about.pull(&answer.stress)
        } else {
            section.strain.pull(&h, &answer.stress)
        };
        for v in &mut stress {
            *v = *v * w;
        }
        if const { E::ABOUT_MEAN }
            && let Some(about) = &mut about
            && out.is_some()
        {
            for v in &mut answer.stress {
                *v = *v * w;
            }
            about.keep(&h, &answer.stress, &stress);
        }
        let mut gamma = if const { E::Op::<T>::DRILL } { w.scale(parameter) } else { o };
        let mut drill = o;
        if const { E::Op::<T>::HOOP }
            && let Some(around) = &around
        {
            drill = around.stress * around.slope * w;
        }
        if const { E::Op::<T>::DRILL } {
            drill = s.op.drill(q);
            for m in 0..A {
                for i in 0..2 {
                    drill = mode_drill(&s.modes[m], i).fma(alpha[m][i], drill);
                }
            }
            drill = drill * gamma;
        }
        if let Some(out) = out.as_deref_mut() {
            s.op.add_force(&stress, drill, &mut out.force);
        }
        for m in 0..A {
            let mode = &s.modes[m];
            for i in 0..2 {
                let force = &mut sums.force[2 * m + i];
                for j in 0..2 {
                    *force = mode[j].fma(stress[2 * i + j], *force);
                }
                if const { E::Op::<T>::DRILL } {
                    *force = mode_drill(mode, i).fma(drill, *force);
                }
            }
        }
        if const { A == 0 && !T::STIFFNESS } || !matrices {
            continue;
        }
        if const { E::MEAN_DILATATION }
            && let Some(bar) = &mut bar
        {
            if const { E::Op::<T>::HOOP }
                && let Some(around) = &mut around
            {
                let mut d = around.join(&answer.tangent);
                let (mixed, square) = Dilatation::<T, N, M>::split_ring_tangent(&mut d);
                answer.tangent = around.part(&d);
                let plane = section.strain.pull(&h, &[mixed[0], mixed[1], mixed[2]]);
                bar.add(&s, &times(&plane, w), mixed[3] * around.slope * w, square * w);
            } else {
                let (mixed, square) = Dilatation::<T, N, M>::split_tangent(&mut answer.tangent);
                bar.add(&s, &times(&section.strain.pull(&h, &mixed), w), o, square * w);
            }
        }
        // Derivative of the hoop force by the hoop stretch, and of the stress in the plane.
        let (mut coupling, mut by_hoop) = ([o; 4], [o; 3]);
        if const { E::Op::<T>::HOOP }
            && let Some(around) = &around
        {
            let slope = around.slope;
            gamma = (around.square * slope).fma(slope, around.stress * around.curvature) * w;
            for r in 0..3 {
                by_hoop[r] = around.column[r] * slope * w;
            }
            coupling = if const { E::ABOUT_MEAN }
                && let Some(about) = &about
            {
                about.pull(&by_hoop)
            } else {
                section.strain.pull(&h, &by_hoop)
            };
        }
        let mut a = if const { E::ABOUT_MEAN }
            && let Some(about) = &about
        {
            about.tangent(&answer.tangent)
        } else {
            section.strain.tangent(&h, &answer.stress, &answer.tangent)
        };
        for row in &mut a {
            for v in row {
                *v = *v * w;
            }
        }
        let mut by_mean = None;
        if const { E::ABOUT_MEAN }
            && let Some(about) = &mut about
            && out.is_some()
        {
            for row in &mut answer.tangent {
                for v in row {
                    *v = *v * w;
                }
            }
            let part = about.mixed(&h, &answer.stress, &answer.tangent, &by_hoop);
            about.add(&s.op, &part);
            by_mean = Some(part.mixed);
        }
        if const { T::STIFFNESS }
            && tangent
            && let Some(out) = out.as_deref_mut()
        {
            s.op.add_stiffness(&a, gamma, &mut out.stiffness);
            s.op.add_coupling(&coupling, &mut out.stiffness);
        }
        if const { A == 0 } {
            continue;
        }
        for m in 0..A {
            let square = s.modes[m][0].fma(s.modes[m][0], s.modes[m][1] * s.modes[m][1]);
            let least = square * w.scale(stiff);
            for i in 0..2 {
                let r = 2 * m + i;
                let mode = &s.modes[m];
                sums.least[r] += least;
                if let Some(by_mean) = &by_mean {
                    for c in 0..4 {
                        to_mean[r][c] = mode[0].fma(by_mean[2 * i][c], to_mean[r][c]);
                        to_mean[r][c] = mode[1].fma(by_mean[2 * i + 1][c], to_mean[r][c]);
                    }
                }
                // Row of A H for this mode.
                let mut t = [o; 4];
                for c in 0..4 {
                    t[c] = mode[0].fma(a[2 * i][c], mode[1] * a[2 * i + 1][c]);
                }
                let skew = if const { E::Op::<T>::HOOP } {
                    mode[0].fma(coupling[2 * i], mode[1] * coupling[2 * i + 1])
                } else {
                    mode_drill(mode, i) * gamma
                };
                for n in 0..=m {
                    for j in 0..2 {
                        let k = &mut sums.stiffness[r][2 * n + j];
                        let other = &s.modes[n];
                        *k = other[0].fma(t[2 * j], *k);
                        *k = other[1].fma(t[2 * j + 1], *k);
                        if const { E::Op::<T>::DRILL } {
                            *k = skew.fma(mode_drill(other, j), *k);
                        }
                    }
                }
                if out.is_some() {
                    s.op.add_force(&t, skew, &mut sums.coupling[r]);
                }
            }
        }
    }
    if const { E::ABOUT_MEAN }
        && let Some(about) = &about
        && let Some(out) = out.as_deref_mut()
    {
        about.finish_force(&mut out.force);
        if const { T::STIFFNESS } && tangent {
            about.finish_stiffness(&mut out.stiffness);
        }
        for r in 0..2 * A {
            about.add_rows(&to_mean[r], &mut sums.coupling[r]);
        }
    }
    if const { E::MEAN_DILATATION }
        && let Some(bar) = &bar
    {
        T::apart(FinishDilatation::<E, T, N, M, A> {
            bar,
            x,
            q,
            alpha,
            prepared: &prepared,
            section,
            sums: &mut sums,
            out,
            tangent,
            matrices,
        });
    }
    sums
}

/// Adds what the mean dilatation gives once the stress of all points is known.
struct FinishDilatation<'a, E, T: Real, const N: usize, const M: usize, const A: usize>
where
    E: Element<N, M, A>,
{
    bar: &'a Dilatation<T, N, M>,
    x: &'a Nodal<T, N, 2>,
    q: &'a Nodal<T, N, M>,
    alpha: &'a Nodal<T, A, 2>,
    prepared: &'a E::Prepared<T>,
    section: &'a Section<N>,
    sums: &'a mut Internal<T, N, M>,
    out: Option<&'a mut Local<T, N, M>>,
    tangent: bool,
    matrices: bool,
}

impl<E, T: Real, const N: usize, const M: usize, const A: usize> Job
    for FinishDilatation<'_, E, T, N, M, A>
where
    E: Element<N, M, A>,
{
    type Output = ();
    #[inline(always)]
    fn run(mut self) {
        let (bar, section, sums) = (self.bar, self.section, self.sums);
        if let Some(out) = self.out.as_deref_mut() {
            bar.finish_force(&mut out.force);
            if const { T::STIFFNESS } && self.tangent {
                bar.finish_stiffness(&mut out.stiffness);
            }
        }
        bar.finish_modes::<A>(sums);
        if const { A == 0 && !T::STIFFNESS } || section.strain.is_linear() || !self.matrices {
            return;
        }
        for point in &section.points {
            let s = E::sample(self.x, self.prepared, point);
            let a = bar.curvature(&gradient(&s, self.q, self.alpha), s.weight);
            if const { T::STIFFNESS }
                && self.tangent
                && let Some(out) = self.out.as_deref_mut()
            {
                let mut gamma = T::zero();
                if const { E::Op::<T>::HOOP } {
                    gamma = bar.hoop_curvature(s.op.drill(self.q), s.weight);
                }
                s.op.add_stiffness(&a, gamma, &mut out.stiffness);
            }
            for m in 0..A {
                for i in 0..2 {
                    let r = 2 * m + i;
                    let mut t = [T::zero(); 4];
                    for c in 0..4 {
                        t[c] = s.modes[m][0].fma(a[2 * i][c], s.modes[m][1] * a[2 * i + 1][c]);
                    }
                    for (c, v) in by_modes(&s.modes, &t).into_iter().enumerate().take(r + 1) {
                        sums.stiffness[r][c] += v;
                    }
                    s.op.add_force(&t, T::zero(), &mut sums.coupling[r]);
                }
            }
        }
    }
}

/// [`Element::law_into`] out of line: all that evaluates single elements shares one instance of
/// each. Not for packs, which are compiled for the processor's instructions where they are inlined.
#[inline(never)]
pub fn single_into<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    section: &Section<N>,
    history: &mut History<'_>,
    tangent: bool,
    out: &mut Local<T, N, M>,
) where
    E: Element<N, M, A>,
{
    E::law_into(x, q, section, history, tangent && T::STIFFNESS, out);
}

/// Local force and stiffness of an element with local dofs `q`, into a zero `out`: a matrix of packs is
/// too large to be moved about.
///
/// Internal modes are found by a damped Newton iteration that starts from the stored ones and
/// are stored again; laws that are linear take one pass.
#[inline(always)]
pub fn local_into<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    section: &Section<N>,
    history: &mut History<'_>,
    tangent: bool,
    out: &mut Local<T, N, M>,
) where
    E: Element<N, M, A>,
{
    if const { A == 0 } {
        let none = [[T::zero(); 2]; A];
        let sums = pass::<E, T, N, M, A>(x, q, &none, section, history, Some(&mut *out), tangent);
        out.failed = sums.failed;
        return;
    }
    let mut alpha = [[T::zero(); 2]; A];
    let mut failed = T::none();
    if T::DERIVATIVES > 0 || !(section.law.is_linear() && section.strain.is_linear()) {
        for m in 0..A {
            for i in 0..2 {
                alpha[m][i] = T::load(&history.alpha[(2 * m + i) * history.stride..]);
            }
        }
    }
    // Only elements that remember something themselves go without a tape; they have no modes.
    if const { T::DERIVATIVES > 0 } {
        taped_into::<E, T, N, M, A>(x, q, section, history, &mut alpha, out);
        return;
    }
    if !(section.law.is_linear() && section.strain.is_linear()) {
        failed = relax::<E, T, N, M, A>(x, q, section, history, &mut alpha);
    }
    let sums = pass::<E, T, N, M, A>(x, q, &alpha, section, history, Some(&mut *out), tangent);
    // What is left of the internal force is removed by its linear part.
    let mut factor = sums.stiffness;
    ldlt(&mut factor, 2 * A, &sums.least);
    let mut step = sums.force;
    ldlt_solve(&factor, 2 * A, &mut step);
    for r in 0..2 * A {
        alpha[r / 2][r % 2] -= step[r];
        for a in 0..N {
            for i in 0..M {
                out.force[a][i] = (-sums.coupling[r][a][i]).fma(step[r], out.force[a][i]);
            }
        }
    }
    for m in 0..A {
        for i in 0..2 {
            alpha[m][i].store(&mut history.alpha[(2 * m + i) * history.stride..]);
        }
    }
    if tangent {
        condense::<T, N, M, A>(&factor, &sums.coupling, &mut out.stiffness);
    }
    out.failed = T::or(failed, sums.failed);
}

/// [`local_into`] with the laws on a tape, about settled modes `alpha`.
///
/// Backwards their derivatives are the solution of their adjoint equations. Forwards the modes stay,
/// and the tape takes the derivatives of their forces, of which these solutions are the weights.
#[inline(always)]
fn taped_into<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<T, N, 2>,
    q: &Nodal<T, N, M>,
    section: &Section<N>,
    history: &mut History<'_>,
    alpha: &mut Nodal<T, A, 2>,
    out: &mut Local<T, N, M>,
) where
    E: Element<N, M, A>,
{
    let mut failed = T::none();
    if history.tape.as_ref().is_some_and(|tape| tape.way == Way::Backwards) {
        failed = linear_modes::<E, T, N, M, A>(x, q, section, history, alpha);
        for (k, v) in alpha.as_flattened().iter().enumerate() {
            v.store(&mut history.alpha[k * history.stride..]);
        }
    }
    let sums = pass::<E, T, N, M, A>(x, q, alpha, section, history, Some(&mut *out), false);
    if let Some(tape) = history.tape.as_mut() {
        tape.take_forces(&sums.force[..2 * A]);
    }
    out.failed = T::or(failed, sums.failed);
}

/// Kinematics of a point, for output.
#[derive(Clone, Copy, Debug)]
pub struct PointKinematics {
    /// Local gradient that gives the Cauchy stress, and the hoop stretch less one.
    pub h: [f64; 4],
    pub hoop: f64,
    /// Total local strain xx, yy, zz, xy; zz is that of the hoop, else zero.
    pub strain: [f64; 4],
    /// Reference volume.
    pub volume: f64,
    /// Energy of the drilling penalty.
    pub penalty: f64,
}

/// Kinematics at the points of an element with local dofs `q` and internal modes `alpha`.
pub fn kinematics<E, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<f64, N, 2>,
    q: &Nodal<f64, N, M>,
    alpha: &Nodal<f64, A, 2>,
    section: &Section<N>,
    own: &PerPoint<'_>,
) -> Vec<PointKinematics>
where
    E: Element<N, M, A>,
{
    let parameter = own.parameter::<f64, N>(section);
    let prepared = E::prepare(x, parameter, &own.sides(E::EDGE));
    let bar = Dilatation::<f64, N, M>::new::<E, A>(x, q, alpha, &prepared, section);
    let about = AboutMean::<f64, E::Op<f64>, N, M>::new::<E, A>(x, q, &prepared, section);
    let mut all = Vec::with_capacity(section.points.len());
    for (p, point) in section.points.iter().enumerate() {
        let s = E::sample(x, &prepared, point);
        let volume = s.weight * own.thickness::<f64, N>(p, section);
        let mut h = gradient(&s, q, alpha);
        let mut strain = if const { E::ABOUT_MEAN }
            && let Some(about) = &about
        {
            about.strain(&h)
        } else {
            section.strain.strain(&h)
        };
        let (mut hoop, mut around) = (0.0, 0.0);
        if const { E::Op::<f64>::HOOP } {
            hoop = s.op.drill(q);
            around = section.strain.hoop(hoop)[0];
        }
        if const { E::MEAN_DILATATION }
            && let Some(bar) = &bar
        {
            if const { E::Op::<f64>::HOOP } {
                bar.apply_to_ring(&mut strain, &mut around);
                (h, hoop) = bar.ring_gradient(&h, hoop);
            } else {
                bar.apply(&mut strain);
                h = bar.gradient(&h);
            }
        }
        if const { E::ABOUT_MEAN }
            && let Some(about) = &about
        {
            h = about.h;
        }
        let mut penalty = 0.0;
        if const { E::Op::<f64>::DRILL } {
            let mut drill = s.op.drill(q);
            for m in 0..A {
                for i in 0..2 {
                    drill += mode_drill(&s.modes[m], i) * alpha[m][i];
                }
            }
            penalty = 0.5 * volume * parameter * drill * drill;
        }
        let strain = [strain[0], strain[1], around, strain[2]];
        all.push(PointKinematics { h, hoop, strain, volume, penalty });
    }
    all
}

/// Work that an element has absorbed at local dofs `q`, with the stored internal modes: its
/// recoverable energy, and the plastic work since the start of the increment.
pub fn absorbed<E, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<f64, N, 2>,
    q: &Nodal<f64, N, M>,
    section: &Section<N>,
    history: &mut History<'_>,
) -> f64
where
    E: Element<N, M, A>,
{
    let mut alpha = [[0.0; 2]; A];
    for m in 0..A {
        for i in 0..2 {
            alpha[m][i] = history.alpha[(2 * m + i) * history.stride];
        }
    }
    let own = history.per_point;
    let points = kinematics::<E, N, M, A>(x, q, &alpha, section, &own);
    let (mut energy, memory) = absorbed_by_points(&points, section, history, E::MEMORY);
    if let (Some(m), true) = (E::DISSIPATED, !memory.is_empty()) {
        let stride = history.stride;
        energy += memory[m] - history.memory(section).old[m * stride];
    }
    let [first, second] = E::stabilization(x, q, section, &own, &memory);
    energy + first[0] + second[0]
}

/// The part of [`absorbed`] at the points, and what an element of so many members remembers.
fn absorbed_by_points<const N: usize>(
    points: &[PointKinematics],
    section: &Section<N>,
    history: &mut History<'_>,
    memory: usize,
) -> (f64, Vec<f64>) {
    let members = section.law.n_state();
    let own = history.per_point;
    let mut energy = 0.0;
    for (p, at) in points.iter().enumerate() {
        let w = at.volume;
        let initial = [0, 1, 2, 3].map(|row| history.initial_strain::<f64>(p, row));
        let [xx, yy, zz, xy] = at.strain;
        let strain = [xx - initial[0], yy - initial[1], xy - initial[2]];
        let mut state = history.point(p, members);
        let law = own.law::<f64, N>(p, section);
        let values = |state: &PointState<'_>| -> Vec<f64> {
            (0..members).map(|m| state.new[m * state.stride]).collect()
        };
        if section.ring {
            let solid = [strain[0], strain[1], strain[2], zz - initial[3]];
            let stress = law.update_solid(solid, &mut state).stress;
            energy += w * law.energy_solid(solid, stress, &values(&state));
        } else {
            let stress = law.update(strain, &mut state).stress;
            energy += w * law.energy(strain, stress, &values(&state));
        }
        if let Some(work) = section.law.work_member() {
            energy += w * (state.new[work * state.stride] - state.old[work * state.stride]);
        }
        // An initial stress through the thickness acts in the plane, beside that of the law.
        energy += w * history.spherical::<f64, N>(p, section) * (strain[0] + strain[1]);
        energy += at.penalty;
    }
    // Elements of laws without a history have no memory either.
    let memory = if members > 0 { memory } else { 0 };
    if memory == 0 {
        return (energy, Vec::new());
    }
    let state = history.memory(section);
    (energy, (0..memory).map(|m| state.new[m * state.stride]).collect())
}

/// Whether the law of any point has flowed since the start of the increment.
pub fn flowed<const N: usize>(section: &Section<N>, history: &History<'_>) -> bool {
    let Some(member) = section.law.plastic_member() else { return false };
    (0..section.n_histories()).any(|p| {
        let at = (p * section.law.n_state() + member) * history.stride;
        history.new[at] > history.old[at]
    })
}
