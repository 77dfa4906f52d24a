//! Line elements: trusses, beams and springs. They ride in the same
//! frame, which for two nodes is the chord. The local law of springs and elastic beams is one of
//! resultants; trusses and other beams ask their material, see [`super::fibers`].
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Full, Grad, Point, Sample};
use super::fibers::{self, MODES};
use crate::base::Real;
use crate::base::small::{Blocks, Nodal};
use crate::kinematics::integrate::{History, Local, Section};
use crate::kinematics::per_point::PerPoint;

/// Resultants of a line element and what they store.
#[derive(Clone, Debug, Default)]
pub struct Resultants {
    /// In the order of [`Element::OUTPUTS`], then of [`Element::FLOW_OUTPUTS`] and those of the
    /// law, where it has a history.
    pub outputs: Vec<f64>,
    /// Axial stress and strain, and the direction of the axis on the reference.
    pub stress: f64,
    pub strain: f64,
    pub axis: [f64; 2],
    /// Stored energy [force*length].
    pub energy: f64,
    /// Stress, strain and equivalent plastic strain by station and fiber.
    pub fibers: Vec<[f64; 3]>,
}

/// A deformation that is linear in the local dofs, with the row that gives it.
pub type Row<T, const N: usize, const M: usize> = Nodal<T, N, M>;

/// `f += r s`, and with `tangent` `K += r k r^T`, blocks `a <= b`.
#[inline(always)]
pub fn add<T: Real, const N: usize, const M: usize>(
    out: &mut Local<T, N, M>,
    row: &Row<T, N, M>,
    force: T,
    with: &[(T, &Row<T, N, M>)],
    tangent: bool,
) {
    for a in 0..N {
        for i in 0..M {
            out.force[a][i] = row[a][i].fma(force, out.force[a][i]);
        }
    }
    if const { T::STIFFNESS } && tangent {
        for &(k, other) in with {
            add_product(&mut out.stiffness, row, other, k);
        }
    }
}

#[inline(always)]
fn add_product<T: Real, const N: usize, const M: usize>(
    stiffness: &mut Blocks<T, N, M>,
    r: &Row<T, N, M>,
    s: &Row<T, N, M>,
    k: T,
) {
    for a in 0..N {
        for b in a..N {
            for i in 0..M {
                for j in 0..M {
                    let m = &mut stiffness[a][b][i][j];
                    *m = (k * r[a][i]).fma(s[b][j], *m);
                }
            }
        }
    }
}

#[inline(always)]
pub fn apply<T: Real, const N: usize, const M: usize>(row: &Row<T, N, M>, q: &Nodal<T, N, M>) -> T {
    crate::base::small::dot(row, q)
}

/// Unit vector from the first to the second node, and the distance.
#[inline(always)]
fn axis<T: Real>(x: &Nodal<T, 2, 2>) -> ([T; 2], T) {
    let e = [x[1][0] - x[0][0], x[1][1] - x[0][1]];
    let length = e[0].fma(e[0], e[1] * e[1]).sqrt();
    ([e[0] / length, e[1] / length], length)
}

/// Row of the elongation.
#[inline(always)]
fn stretch<T: Real, const M: usize>(t: [T; 2]) -> Row<T, 2, M> {
    let mut row = [[T::zero(); M]; 2];
    for i in 0..2 {
        row[0][i] = -t[i];
        row[1][i] = t[i];
    }
    row
}

/// Young's and shear modulus of an isotropic law in plane stress.
#[inline(always)]
fn moduli<T: Real, const N: usize>(section: &Section<N>, own: &PerPoint<'_>) -> (f64, f64) {
    let m = own.law::<T, N>(0, section).moduli();
    (m[0][0] - m[0][1] * m[0][1] / m[1][1], m[2][2])
}

/// Exact for the square of the deflection of a beam.
fn three_points() -> Vec<[f64; 3]> {
    let r = 0.6_f64.sqrt();
    vec![[-r, 0.0, 5.0 / 9.0], [0.0, 0.0, 8.0 / 9.0], [r, 0.0, 5.0 / 9.0]]
}

fn linear(xi: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
    ([0.5 * (1.0 - xi[0]), 0.5 * (1.0 + xi[0])], [[-0.5, 0.0], [0.5, 0.0]])
}

/// What bars of two nodes have in common: one point, a mass along the line, no strain operator.
macro_rules! bar {
    ($op:ident, $zero:expr) => {
        type Code = Self;
        type Op<T: Real> = $op<T, 2>;
        type Prepared<T: Real> = ();

        fn rule() -> Vec<[f64; 3]> {
            vec![[0.0, 0.0, 2.0]]
        }
        fn mass_rule() -> Vec<[f64; 3]> {
            three_points()
        }
        fn shape(xi: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
            linear(xi)
        }
        #[inline(always)]
        fn measure<T: Real>(x: &Nodal<T, 2, 2>, point: &Point<2>) -> T {
            axis(x).1.scale(0.5 * point.weight)
        }
        #[inline(always)]
        fn prepare<T: Real>(_: &Nodal<T, 2, 2>, _: f64, _: &[T; 2]) {}
        #[inline(always)]
        fn sample<T: Real>(
            x: &Nodal<T, 2, 2>,
            (): &(),
            point: &Point<2>,
        ) -> Sample<T, $op<T, 2>, 0> {
            Sample { op: $op([$zero; 2]), modes: [], weight: Self::measure(x, point) }
        }
    };
}

/// Bar of two nodes that carries an axial force only. Profile: area.
#[derive(Clone, Copy)]
pub struct Truss;

impl Element<2, 2, 0> for Truss {
    const NAME: &'static str = "TRUSS";
    const CELL: &'static str = "line2";
    const LINE: bool = true;
    const OUTPUTS: &'static [&'static str] = &["N"];
    bar!(Grad, [T::zero(); 2]);

    #[inline(always)]
    fn law_into<T: Real>(
        x: &Nodal<T, 2, 2>,
        q: &Nodal<T, 2, 2>,
        section: &Section<2>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, 2, 2>,
    ) {
        let (t, length) = axis(x);
        let row = stretch::<T, 2>(t);
        let strain = apply(&row, q) / length - history.initial_strain(0, 0);
        let area = section.profile[0];
        let (stress, modulus, failed) =
            fibers::answer(strain, length.scale(area), 0, section, history);
        let k = modulus.scale(area) / length;
        add(out, &row, stress.scale(area), &[(k, &row)], tangent);
        out.failed = failed;
    }
    fn absorbed_at(
        x: &Nodal<f64, 2, 2>,
        q: &Nodal<f64, 2, 2>,
        section: &Section<2>,
        history: &mut History<'_>,
    ) -> f64 {
        let (t, length) = axis(x);
        let strain = apply(&stretch::<f64, 2>(t), q) / length - history.initial_strain::<f64>(0, 0);
        let at = fibers::state(strain, 0, section, history);
        (at.energy + at.work) * section.profile[0] * length
    }
    fn resultants(
        x: &Nodal<f64, 2, 2>,
        q: &Nodal<f64, 2, 2>,
        section: &Section<2>,
        history: &mut History<'_>,
    ) -> Resultants {
        let (t, length) = axis(x);
        let strain = apply(&stretch::<f64, 2>(t), q) / length;
        let initial: f64 = history.initial_strain(0, 0);
        let at = fibers::state(strain - initial, 0, section, history);
        let area = section.profile[0];
        let mut outputs = vec![at.stress * area];
        outputs.extend(at.outputs);
        Resultants {
            outputs,
            stress: at.stress,
            strain,
            axis: t,
            energy: at.energy * area * length,
            fibers: Vec::new(),
        }
    }
}

/// Straight beam of two nodes with shear deformation, exact for loads at its nodes
/// (Timoshenko; Przemieniecki 1968). Profile: area, second moment, shear area (0: no shear
/// deformation). Outputs: axial force, shear force, moments at both ends; moments are positive
/// where they stretch the right side of the way from the first node to the second; with fibers the
/// plastic rotations of both halves.
#[derive(Clone, Copy)]
pub struct Beam;

/// Chord-relative rotations of both ends: rows.
#[inline(always)]
fn bendings<T: Real>(t: [T; 2], length: T) -> [Row<T, 2, 3>; 2] {
    let z = T::zero();
    // Turn of the chord: transverse displacements over the length.
    let n = [-t[1] / length, t[0] / length];
    let turn = |own: usize| {
        let mut row = [[n[0], n[1], z], [-n[0], -n[1], z]];
        row[own][2] = T::one();
        row
    };
    [turn(0), turn(1)]
}

/// Stiffness of both end rotations: diagonal and coupling.
#[inline(always)]
fn bending_stiffness<T: Real>(section: &Section<2>, own: &PerPoint<'_>, length: T) -> [T; 2] {
    let (e, g) = moduli::<T, 2>(section, own);
    let [_, inertia, shear] = section.profile;
    let compliance = if shear > 0.0 { 12.0 * e * inertia / (g * shear) } else { 0.0 };
    let phi = T::real(compliance) / (length * length);
    let base = T::real(e * inertia) / (length * (T::one() + phi));
    [base * (T::real(4.0) + phi), base * (T::real(2.0) - phi)]
}

impl Element<2, 3, 0> for Beam {
    const NAME: &'static str = "BEAM";
    const CELL: &'static str = "line2";
    const LINE: bool = true;
    const OUTPUTS: &'static [&'static str] = &["N", "V", "M1", "M2"];
    const FLOW_OUTPUTS: &'static [&'static str] = &["PR1", "PR2"];
    const ALPHA_B: f64 = 1.0;
    const MEMORY: usize = MODES;
    bar!(Full, [[T::zero(); 4]; 3]);

    /// Deflection of the axis by the difference of the end rotations, exact without shear force:
    /// a load per length and the weight have the consistent end moments `q l^2 / 12`.
    fn sides(xi: [f64; 2]) -> [f64; 2] {
        [1.0 - xi[0] * xi[0], 0.0]
    }
    #[inline(always)]
    fn law_into<T: Real>(
        x: &Nodal<T, 2, 2>,
        q: &Nodal<T, 2, 3>,
        section: &Section<2>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, 2, 3>,
    ) {
        let (t, length) = axis(x);
        let row = stretch::<T, 3>(t);
        let [r, s] = bendings(t, length);
        let initial = history.initial_strain(0, 0);
        if !section.fibers.is_empty() {
            let rows = [&row, &r, &s];
            let deformed = fibers::deformed(rows, q, length, initial);
            deformed.law_into(rows, section, history, tangent, out);
            return;
        }
        let k =
            T::real(moduli::<T, 2>(section, &history.per_point).0 * section.profile[0]) / length;
        let e = apply(&row, q) - length * initial;
        add(out, &row, k * e, &[(k, &row)], tangent);
        let [d, c] = bending_stiffness(section, &history.per_point, length);
        let turn = [apply(&r, q), apply(&s, q)];
        add(out, &r, d.fma(turn[0], c * turn[1]), &[(d, &r), (c, &s)], tangent);
        add(out, &s, c.fma(turn[0], d * turn[1]), &[(c, &r), (d, &s)], tangent);
    }
    fn absorbed_at(
        x: &Nodal<f64, 2, 2>,
        q: &Nodal<f64, 2, 3>,
        section: &Section<2>,
        history: &mut History<'_>,
    ) -> f64 {
        let (t, length) = axis(x);
        let initial = history.initial_strain(0, 0);
        let (row, [r, s]) = (stretch(t), bendings(t, length));
        let deformed = fibers::deformed([&row, &r, &s], q, length, initial);
        let states = deformed.states(0.0, section, history);
        states.energy + states.work
    }
    fn resultants(
        x: &Nodal<f64, 2, 2>,
        q: &Nodal<f64, 2, 3>,
        section: &Section<2>,
        history: &mut History<'_>,
    ) -> Resultants {
        let (t, length) = axis(x);
        let (row, [r, s]) = (stretch::<f64, 3>(t), bendings(t, length));
        let strain = apply(&row, q) / length;
        let initial = history.initial_strain(0, 0);
        if !section.fibers.is_empty() {
            let deformed = fibers::deformed([&row, &r, &s], q, length, initial);
            let states = deformed.states(initial, section, history);
            let [axial, first, second] = states.force;
            let shear = -(first + second) / length;
            let mut outputs = vec![axial, shear, -first, second];
            outputs.extend(states.hinges);
            outputs.extend(states.outputs);
            return Resultants {
                outputs,
                stress: axial / section.profile[0],
                strain,
                axis: t,
                energy: states.energy,
                fibers: states.values,
            };
        }
        let own = &history.per_point;
        let elastic = strain - initial;
        let stress = moduli::<f64, 2>(section, own).0 * elastic;
        let [d, c] = bending_stiffness(section, own, length);
        let turn = [apply(&r, q), apply(&s, q)];
        // Moments that act on the ends; the inner one at the first end is its opposite.
        let end = [d * turn[0] + c * turn[1], c * turn[0] + d * turn[1]];
        let axial = stress * section.profile[0];
        let energy = 0.5 * (axial * elastic * length + end[0] * turn[0] + end[1] * turn[1]);
        let shear = -(end[0] + end[1]) / length;
        let outputs = vec![axial, shear, -end[0], end[1]];
        Resultants { outputs, stress, strain, axis: t, energy, fibers: Vec::new() }
    }
}

/// Force and stiffness of a spring: linear, or along the section's table, constant outside.
#[inline(always)]
fn spring<T: Real, const N: usize>(section: &Section<N>, e: T) -> (T, T) {
    let Some(first) = section.table.first() else {
        let k = T::real(section.profile[0]);
        return (k * e, k);
    };
    let (mut force, mut stiffness) = (T::real(first[1]), T::zero());
    for pair in section.table.windows(2) {
        let ([e0, f0], [e1, f1]) = (pair[0], pair[1]);
        let slope = T::real((f1 - f0) / (e1 - e0));
        let way = T::real(e1).lt(e);
        let way = T::select(way, T::real(e1), e) - T::real(e0);
        let behind = way.lt(T::zero());
        force = T::select(behind, T::zero(), way).fma(slope, force);
        let inside = T::select(e.lt(T::real(e1)), slope, T::zero());
        stiffness += T::select(behind, T::zero(), inside);
    }
    (force, stiffness)
}

/// Resultants of a spring with an elongation.
fn spring_resultants<const N: usize>(section: &Section<N>, e: f64) -> Resultants {
    let force = spring(section, e).0;
    // Work from no elongation: the table's own integral from there.
    let energy = match section.table.first() {
        None => 0.5 * force * e,
        Some(first) => {
            let integral = |x: f64| {
                let segments = section.table.windows(2).map(|pair| {
                    let ([e0, f0], [e1, f1]) = (pair[0], pair[1]);
                    let way = (x - e0).clamp(0.0, e1 - e0);
                    (f1 - f0) / (e1 - e0) * way * (0.5 * way + (x - e1).max(0.0))
                });
                first[1] * x + segments.sum::<f64>()
            };
            integral(e) - integral(0.0)
        }
    };
    Resultants { outputs: vec![force], energy, ..Resultants::default() }
}

/// Spring along the line between two nodes. Profile: stiffness [force/length].
#[derive(Clone, Copy)]
pub struct Spring;

impl Element<2, 2, 0> for Spring {
    const NAME: &'static str = "SPRING";
    const CELL: &'static str = "line2";
    const LINE: bool = true;
    const SPRING: bool = true;
    const OUTPUTS: &'static [&'static str] = &["N"];
    type Code = Self;
    type Op<T: Real> = Grad<T, 2>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        vec![[0.0, 0.0, 2.0]]
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        vec![[0.0, 0.0, 2.0]]
    }
    fn shape(xi: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        linear(xi)
    }
    #[inline(always)]
    fn measure<T: Real>(_: &Nodal<T, 2, 2>, _: &Point<2>) -> T {
        T::zero()
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 2, 2>, _: f64, _: &[T; 2]) {}
    #[inline(always)]
    fn sample<T: Real>(_: &Nodal<T, 2, 2>, (): &(), _: &Point<2>) -> Sample<T, Grad<T, 2>, 0> {
        Sample { op: Grad([[T::zero(); 2]; 2]), modes: [], weight: T::zero() }
    }
    #[inline(always)]
    fn law_into<T: Real>(
        x: &Nodal<T, 2, 2>,
        q: &Nodal<T, 2, 2>,
        section: &Section<2>,
        _: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, 2, 2>,
    ) {
        let row = stretch::<T, 2>(axis(x).0);
        let (force, k) = spring(section, apply(&row, q));
        add(out, &row, force, &[(k, &row)], tangent);
    }
    fn resultants(
        x: &Nodal<f64, 2, 2>,
        q: &Nodal<f64, 2, 2>,
        section: &Section<2>,
        _: &mut History<'_>,
    ) -> Resultants {
        let t = axis(x).0;
        let e = apply(&stretch::<f64, 2>(t), q);
        Resultants { axis: t, ..spring_resultants(section, e) }
    }
}

/// Springs between fixed directions, or rotations, of one node and the ground (`N = 1`) or of
/// two nodes. Profile: stiffness, dof of the first node, dof of the second.
macro_rules! dof_spring {
    ($type:ident, $name:literal, $cell:literal, $n:literal, $m:literal, $op:ident, $zero:expr) => {
        #[derive(Clone, Copy)]
        pub struct $type;

        impl $type {
            #[inline(always)]
            fn row<T: Real>(section: &Section<$n>) -> Row<T, $n, $m> {
                let mut row = [[T::zero(); $m]; $n];
                row[0][section.profile[1] as usize] = T::one();
                if $n == 2 {
                    row[$n - 1][section.profile[2] as usize] = -T::one();
                }
                row
            }
        }

        impl Element<$n, $m, 0> for $type {
            const NAME: &'static str = $name;
            const CELL: &'static str = $cell;
            const LINE: bool = true;
            const SPRING: bool = true;
            const TURNS: bool = false;
            const OUTPUTS: &'static [&'static str] = &["N"];
            type Code = Self;
            type Op<T: Real> = $op<T, $n>;
            type Prepared<T: Real> = ();

            fn rule() -> Vec<[f64; 3]> {
                vec![[0.0, 0.0, 1.0]]
            }
            fn mass_rule() -> Vec<[f64; 3]> {
                vec![[0.0, 0.0, 1.0]]
            }
            fn shape(_: [f64; 2]) -> ([f64; $n], [[f64; 2]; $n]) {
                ([1.0 / f64::from($n); $n], [[0.0; 2]; $n])
            }
            #[inline(always)]
            fn measure<T: Real>(_: &Nodal<T, $n, 2>, _: &Point<$n>) -> T {
                T::zero()
            }
            #[inline(always)]
            fn prepare<T: Real>(_: &Nodal<T, $n, 2>, _: f64, _: &[T; $n]) {}
            #[inline(always)]
            fn sample<T: Real>(
                _: &Nodal<T, $n, 2>,
                (): &(),
                _: &Point<$n>,
            ) -> Sample<T, $op<T, $n>, 0> {
                Sample { op: $op([$zero; $n]), modes: [], weight: T::zero() }
            }
            #[inline(always)]
            fn law_into<T: Real>(
                _: &Nodal<T, $n, 2>,
                q: &Nodal<T, $n, $m>,
                section: &Section<$n>,
                _: &mut History<'_>,
                tangent: bool,
                out: &mut Local<T, $n, $m>,
            ) {
                let row = Self::row::<T>(section);
                let (force, k) = spring(section, apply(&row, q));
                add(out, &row, force, &[(k, &row)], tangent);
            }
            fn resultants(
                _: &Nodal<f64, $n, 2>,
                q: &Nodal<f64, $n, $m>,
                section: &Section<$n>,
                _: &mut History<'_>,
            ) -> Resultants {
                spring_resultants(section, apply(&Self::row::<f64>(section), q))
            }
        }
    };
}

dof_spring!(Ground, "SPRING1", "point1", 1, 2, Grad, [T::zero(); 2]);
dof_spring!(GroundTurn, "SPRING1R", "point1", 1, 3, Full, [[T::zero(); 4]; 3]);
dof_spring!(Between, "SPRING2", "line2", 2, 2, Grad, [T::zero(); 2]);
dof_spring!(BetweenTurn, "SPRING2R", "line2", 2, 3, Full, [[T::zero(); 4]; 3]);
