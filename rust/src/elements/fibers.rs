//! Beams of laws with a history, by fibers over the cross-section at stations along the axis.
//!
//! Axial strain and curvature of the stations (Gauss-Lobatto, those at the ends included) are free
//! but for compatibility with the nodes: what they have beyond an elongation and a cubic deflection
//! are internal modes, for which the energy of the increment is least. At this minimum the axial
//! force is constant and the moment linear along the element, as in a force-based element (Spacone,
//! Filippou and Taucer 1996): equilibrium is exact at every station, an elastic beam has its exact
//! stiffness, and a plastic hinge stands at the node. The shear angle is elastic and one more mode.
// SPDX-License-Identifier: BSD-3-Clause

use super::line::{Row, add, apply};
use crate::base::Real;
use crate::base::small::{Mat, ldlt, ldlt_solve};
use crate::kinematics::integrate::{History, KEPT, Local, Section};
use std::cmp::Ordering;

/// Points along a beam.
pub const STATIONS: usize = 5;
/// Internal modes: Legendre polynomials 1 to 4 of the axial strain and 2 to 4 of the curvature, and
/// the shear angle.
pub const MODES: usize = 8;
/// Elongation, and the rotations of both ends from the chord.
const BASIC: usize = 3;
const ALL: usize = BASIC + MODES;
/// The mode of the shear angle.
const SHEAR: usize = ALL - 1;
/// Least stiffness of a mode, relative to the elastic one.
const LEAST: f64 = 1e-9;
/// Longest first step of the modes, relative to the deformation, in the norm of the elastic energy.
const LONGEST: f64 = 2.0;
/// Share of its slope at the start beyond which a step has run past the minimum.
const OVERSHOT: f64 = 0.5;
/// Energy that a step gains, relative to that of the deformation, after which one more is exact to
/// round-off; and one that is round-off.
const SMALL: f64 = 1e-16;
const ROUNDING: f64 = 1e-30;
const MAX_ITERATIONS: usize = 100;

/// A point along the axis: place and weight on a unit length, Legendre polynomials 1 to 4.
struct Station {
    at: f64,
    weight: f64,
    legendre: [f64; 4],
}

const fn station(x: f64, weight: f64, even: [f64; 2], odd: f64) -> Station {
    Station { at: 0.5 * (1.0 + x), weight, legendre: [x, even[0], odd, even[1]] }
}

/// `(3/7)^(1/2)`.
const INNER: f64 = 0.654_653_670_707_977_1;
const ALONG: [Station; STATIONS] = [
    station(-1.0, 0.05, [1.0, 1.0], -1.0),
    station(-INNER, 49.0 / 180.0, [1.0 / 7.0, -3.0 / 7.0], INNER * 3.0 / 7.0),
    station(0.0, 16.0 / 45.0, [-0.5, 0.375], 0.0),
    station(INNER, 49.0 / 180.0, [1.0 / 7.0, -3.0 / 7.0], -INNER * 3.0 / 7.0),
    station(1.0, 0.05, [1.0, 1.0], 1.0),
];

/// Stress and modulus of the law of a point in one dimension, and the lanes that failed; the stress
/// acts on the volume `w`.
#[inline(always)]
pub fn answer<T: Real>(
    strain: T,
    w: T,
    point: usize,
    section: &Section<2>,
    history: &mut History<'_>,
) -> (T, T, T::Mask) {
    let own = history.per_point;
    let law = own.law::<T, 2>(0, section);
    let answer = history.answer(point, law, [strain, T::zero(), T::zero()], w);
    let state = history.point(point, law.n_state());
    let mut modulus = answer.tangent[0][0];
    if law.ideal()
        && let Some(member) = law.plastic_member()
    {
        let end = T::load(&state.new[member * state.stride..]);
        let kept = T::real(KEPT * law.moduli()[0][0]);
        modulus += T::select(state.get::<T>(member).lt(end), kept, T::zero());
    }
    (answer.stress[0], modulus, answer.failed)
}

/// The state of a point after an evaluation.
pub struct FiberState {
    pub stress: f64,
    /// Recoverable energy, and work of the flow in the increment, by volume.
    pub energy: f64,
    pub work: f64,
    pub plastic: f64,
    pub outputs: Vec<f64>,
}

/// The state of a point with a strain.
pub fn state(
    strain: f64,
    point: usize,
    section: &Section<2>,
    history: &mut History<'_>,
) -> FiberState {
    let own = history.per_point;
    let law = own.law::<f64, 2>(0, section);
    let members = law.n_state();
    let mut state = history.point(point, members);
    let strain = [strain, 0.0, 0.0];
    let stress = law.update(strain, &mut state).stress;
    let values: Vec<f64> = (0..members).map(|m| state.new[m * state.stride]).collect();
    let done = |m: usize| values[m] - state.old[m * state.stride];
    FiberState {
        stress: stress[0],
        energy: law.energy(strain, stress, &values),
        work: law.work_member().map_or(0.0, done),
        plastic: law.plastic_member().map_or(0.0, |m| values[m]),
        outputs: (0..law.outputs().len()).map(|i| law.output(i, stress, &values)).collect(),
    }
}

/// A beam with its deformation.
pub struct Deformed<T: Real> {
    pub length: T,
    /// Elongation without that of the initial strain, rotations of both ends from the chord.
    pub basic: [T; BASIC],
}

/// Sums over all fibers: forces and, of the symmetric matrix, the lower triangle.
struct Sums<T: Real> {
    force: [T; ALL],
    stiffness: Mat<T, ALL>,
    /// Twice the elastic energy of the stress.
    energy: T,
    failed: T::Mask,
}

/// Strain and curvature of a station with their derivatives by all unknowns.
struct Kinematics<T> {
    strain: T,
    curvature: T,
    by_strain: [T; ALL],
    by_curvature: [T; ALL],
}

/// Remove what is left of the modes' force by its linear part, and the modes.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn condense<T: Real>(
    sums: &Sums<T>,
    factor: &Mat<T, MODES>,
    mut modes: [T; MODES],
    step: [T; MODES],
    section: &Section<2>,
    history: &mut History<'_>,
    failed: T::Mask,
) -> ([T; BASIC], Mat<T, BASIC>, T::Mask) {
    let zero = T::zero();
    let mut memory = history.memory(section);
    for m in 0..MODES {
        modes[m] += -step[m];
        memory.set(m, modes[m]);
    }
    let (mut force, mut stiffness) = ([zero; BASIC], [[zero; BASIC]; BASIC]);
    for b in 0..BASIC {
        let mut column = [zero; MODES];
        force[b] = sums.force[b];
        for m in 0..MODES {
            column[m] = sums.stiffness[BASIC + m][b];
            force[b] = (-column[m]).fma(step[m], force[b]);
        }
        ldlt_solve(factor, MODES, &mut column);
        for a in b..BASIC {
            let mut v = sums.stiffness[a][b];
            for m in 0..MODES {
                v = (-sums.stiffness[BASIC + m][a]).fma(column[m], v);
            }
            stiffness[a][b] = v;
            stiffness[b][a] = v;
        }
    }
    (force, stiffness, failed)
}

impl<T: Real> Deformed<T> {
    #[inline(always)]
    fn at(&self, station: &Station, modes: &[T; MODES], sheared: bool) -> Kinematics<T> {
        let per_length = self.length.recip();
        let zero = T::zero();
        let (mut by_strain, mut by_curvature) = ([zero; ALL], [zero; ALL]);
        by_strain[0] = per_length;
        let ends = [6.0 * station.at - 4.0, 6.0 * station.at - 2.0];
        for k in 0..2 {
            by_curvature[1 + k] = per_length.scale(ends[k]);
        }
        for k in 0..4 {
            by_strain[BASIC + k] = T::real(station.legendre[k]);
            if k > 0 {
                by_curvature[BASIC + 3 + k] = per_length.scale(station.legendre[k]);
            }
        }
        if sheared {
            by_curvature[SHEAR] = per_length.scale(-ends[0] - ends[1]);
        }
        let (mut strain, mut curvature) = (zero, zero);
        for k in 0..ALL {
            let value = if k < BASIC { self.basic[k] } else { modes[k - BASIC] };
            strain = by_strain[k].fma(value, strain);
            curvature = by_curvature[k].fma(value, curvature);
        }
        Kinematics { strain, curvature, by_strain, by_curvature }
    }

    #[inline(always)]
    fn sums(&self, modes: &[T; MODES], section: &Section<2>, history: &mut History<'_>) -> Sums<T> {
        let zero = T::zero();
        let own = history.per_point;
        let law = own.law::<T, 2>(0, section);
        let count = section.fibers.len();
        let young = law.moduli()[0][0];
        let sheared = section.profile[2] > 0.0;
        let mut sums = Sums {
            force: [zero; ALL],
            stiffness: [[zero; ALL]; ALL],
            energy: zero,
            failed: T::none(),
        };
        for (p, station) in ALONG.iter().enumerate() {
            let at = self.at(station, modes, sheared);
            let weight = self.length.scale(station.weight);
            let [mut normal, mut moment, mut nn, mut nm, mut mm] = [zero; 5];
            for (f, &[y, area, initial]) in section.fibers.iter().enumerate() {
                let strain = at.curvature.fma(T::real(-y), at.strain - T::real(initial));
                let (stress, modulus, failed) =
                    answer(strain, weight.scale(area), p * count + f, section, history);
                normal = stress.fma(T::real(area), normal);
                moment = stress.fma(T::real(-area * y), moment);
                nn = modulus.fma(T::real(area), nn);
                nm = modulus.fma(T::real(-area * y), nm);
                mm = modulus.fma(T::real(area * y * y), mm);
                let share = T::real(area * station.weight / young);
                sums.energy = (stress * stress).fma(share, sums.energy);
                sums.failed = T::or(sums.failed, failed);
            }
            let (e, c) = (&at.by_strain, &at.by_curvature);
            for i in 0..ALL {
                let of = [weight * e[i], weight * c[i]];
                sums.force[i] += of[0].fma(normal, of[1] * moment);
                let row = [of[0].fma(nn, of[1] * nm), of[0].fma(nm, of[1] * mm)];
                for j in 0..=i {
                    sums.stiffness[i][j] = row[0].fma(e[j], row[1].fma(c[j], sums.stiffness[i][j]));
                }
            }
        }
        sums.energy = sums.energy * self.length;
        let stiff = self.length.scale(law.moduli()[2][2] * section.profile[2]);
        sums.force[SHEAR] = stiff.fma(modes[SHEAR - BASIC], sums.force[SHEAR]);
        sums.stiffness[SHEAR][SHEAR] += stiff;
        sums
    }

    /// Axial force and the moments on both ends, with their tangent, by the modes of the least
    /// energy, which are kept in the history. Fails in the lanes where these were not reached.
    ///
    /// Newton's method: steps are bounded by the deformation, since a hinge may have next to no
    /// stiffness, and one that runs past the minimum along it is shortened to where the slope
    /// vanishes.
    #[inline(always)]
    fn basic_into(
        &self,
        section: &Section<2>,
        history: &mut History<'_>,
    ) -> ([T; BASIC], Mat<T, BASIC>, T::Mask) {
        let zero = T::zero();
        let mut modes: [T; MODES] = {
            let memory = history.memory(section);
            std::array::from_fn(
                #[inline(always)]
                |m| memory.get(m),
            )
        };
        let own = history.per_point;
        let young = own.law::<T, 2>(0, section).moduli()[0][0];
        // Elastic stiffness of the modes, by which they are measured.
        let axial = self.length.scale(young * section.profile[0]);
        let bending = T::real(young * section.profile[1]) / self.length;
        let elastic: [T; MODES] = std::array::from_fn(
            #[inline(always)]
            |m| if m < 4 { axial } else { bending },
        );
        let mut least = elastic;
        for v in &mut least {
            *v = v.scale(LEAST);
        }
        let stretched = self.basic[0] / self.length;
        let turned = self.basic[1].fma(self.basic[1], self.basic[2] * self.basic[2]);
        let deformed = (axial * stretched).fma(stretched, bending * turned);
        let (mut size, mut radius) = (zero, zero);
        let mut base = modes;
        let mut direction = [zero; MODES];
        let (mut length, mut reach) = (T::one(), zero);
        // Work of the modes' force along the step at its start.
        let mut start = T::real(-f64::MAX);
        let mut settled = T::none();
        let mut round = 0;
        loop {
            let sums = self.sums(&modes, section, history);
            let mut factor = [[zero; MODES]; MODES];
            let mut step = [zero; MODES];
            for i in 0..MODES {
                step[i] = sums.force[BASIC + i];
                for j in 0..=i {
                    factor[i][j] = sums.stiffness[BASIC + i][BASIC + j];
                }
            }
            ldlt(&mut factor, MODES, &least);
            ldlt_solve(&factor, MODES, &mut step);
            let (mut along, mut work, mut norm) = (zero, zero, zero);
            for m in 0..MODES {
                along = sums.force[BASIC + m].fma(direction[m], along);
                work = sums.force[BASIC + m].fma(step[m], work);
                norm = (elastic[m] * step[m]).fma(step[m], norm);
            }
            norm = norm.sqrt();
            if round == 0 {
                size = (deformed + sums.energy).sqrt().max(T::real(f64::MIN_POSITIVE));
                radius = size.scale(LONGEST);
            }
            let (square, zero_work) = (size * size, T::real(f64::MIN_POSITIVE));
            let exact = work.lt(square.scale(ROUNDING).max(zero_work));
            // Derivatives need a step from the solution on.
            let end = if T::STIFFNESS { T::or(settled, exact) } else { settled };
            let open = T::real(0.5).lt(T::select(end, zero, T::one()));
            if !T::any(open) || round == MAX_ITERATIONS {
                let failed = T::or(sums.failed, open);
                return condense(&sums, &factor, modes, step, section, history, failed);
            }
            let better = along.lt(start.scale(-OVERSHOT));
            let small = T::and(better, work.lt(square.scale(SMALL).max(zero_work)));
            let held = settled;
            settled = T::or(settled, small);
            let share = T::select(radius.lt(norm), radius / norm, T::one());
            let shorter = start / (start - along);
            let shorter = T::select(shorter.lt(T::real(0.7)), shorter, T::real(0.7));
            let shorter = shorter.max(T::real(0.02));
            length = T::select(better, T::one(), length * shorter);
            reach = T::select(better, norm.min(radius), reach);
            radius = T::select(better, radius.scale(2.0), length * reach);
            start = T::select(better, -(work * share), start);
            for m in 0..MODES {
                base[m] = T::select(better, modes[m], base[m]);
                direction[m] = T::select(better, -(step[m] * share), direction[m]);
                // The small step is still taken, so that the tangent too is exact.
                modes[m] = T::select(held, modes[m], length.fma(direction[m], base[m]));
            }
            round += 1;
        }
    }

    /// Force and stiffness of the nodes, by the rows of the basic deformations.
    #[inline(always)]
    pub fn law_into(
        &self,
        rows: [&Row<T, 2, 3>; BASIC],
        section: &Section<2>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, 2, 3>,
    ) {
        let (force, k, failed) = self.basic_into(section, history);
        for i in 0..BASIC {
            let with = [(k[i][0], rows[0]), (k[i][1], rows[1]), (k[i][2], rows[2])];
            add(out, rows[i], force[i], &with, tangent);
        }
        out.failed = failed;
    }
}

/// State of the fibers of a beam for output, of the history that an evaluation wrote.
#[derive(Clone, Debug, Default)]
pub struct FiberStates {
    /// Axial force and moments on both ends.
    pub force: [f64; BASIC],
    /// Stress, total strain and equivalent plastic strain by station and fiber.
    pub values: Vec<[f64; 3]>,
    /// Recoverable energy.
    pub energy: f64,
    /// Plastic rotations of both halves: of their curvature, what the moment would not give.
    pub hinges: [f64; 2],
    /// Outputs of the law: energies by volume are means, others the largest of all fibers.
    pub outputs: Vec<f64>,
    /// Work dissipated and stored by flow, as the law accounts it.
    pub work: f64,
}

/// Outputs that are densities, of which a beam has the mean.
const DENSITIES: [&str; 3] = ["PWORK", "PDISS", "CWORK"];

impl Deformed<f64> {
    /// States of the fibers after an evaluation.
    pub fn states(
        &self,
        initial: f64,
        section: &Section<2>,
        history: &mut History<'_>,
    ) -> FiberStates {
        let own = history.per_point;
        let law = own.law::<f64, 2>(0, section);
        let (names, count) = (law.outputs(), section.fibers.len());
        let [area, inertia, shear_area] = section.profile;
        let (young, shear) = (law.moduli()[0][0], law.moduli()[2][2] * shear_area);
        let mut found = FiberStates { outputs: vec![0.0; names.len()], ..FiberStates::default() };
        let modes: [f64; MODES] = {
            let memory = history.memory(section);
            std::array::from_fn(|m| memory.new[m * memory.stride])
        };
        let sums = self.sums(&modes, section, history);
        found.force = std::array::from_fn(|i| sums.force[i]);
        let angle = modes[SHEAR - BASIC];
        found.energy = 0.5 * shear * self.length * angle * angle;
        for (p, station) in ALONG.iter().enumerate() {
            let at = self.at(station, &modes, shear > 0.0);
            let mut moment = 0.0;
            for (f, &[y, part, own_strain]) in section.fibers.iter().enumerate() {
                let total = at.strain - y * at.curvature;
                let fiber = state(total - own_strain, p * count + f, section, history);
                let volume = part * self.length * station.weight;
                moment -= y * part * fiber.stress;
                found.energy += volume * fiber.energy;
                found.work += volume * fiber.work;
                found.values.push([fiber.stress, total + initial, fiber.plastic]);
                for ((name, sum), value) in names.iter().zip(&mut found.outputs).zip(fiber.outputs)
                {
                    if DENSITIES.contains(name) {
                        *sum += value * volume / (area * self.length);
                    } else if part > 0.0 {
                        *sum = sum.max(value);
                    }
                }
            }
            let plastic =
                (at.curvature - moment / (young * inertia)) * station.weight * self.length;
            let first = match p.cmp(&(STATIONS / 2)) {
                Ordering::Less => 1.0,
                Ordering::Equal => 0.5,
                Ordering::Greater => 0.0,
            };
            found.hinges[0] += plastic * first;
            found.hinges[1] += plastic * (1.0 - first);
        }
        found
    }
}

/// Deformation of a beam with an initial axial strain, and the rows that give it.
#[inline(always)]
pub fn deformed<T: Real>(
    rows: [&Row<T, 2, 3>; BASIC],
    q: &Row<T, 2, 3>,
    length: T,
    initial: T,
) -> Deformed<T> {
    let [e, a, b] = rows;
    Deformed { length, basic: [apply(e, q) - length * initial, apply(a, q), apply(b, q)] }
}
