//! Laws of users as compiled functions: the points of a batch go out through the C interface, stress
//! and tangent come back. A [`Convention`] says how a function is called.
//!
//! The state of a point is what the function saw and gave last, then the history of the function.
// SPDX-License-Identifier: BSD-3-Clause

use super::clock::Clock;
use super::material::{Material, Plane, PointState, Response, SolidResponse};
use crate::base::small::Mat;
use crate::base::{MAX_LANES, Real};
use std::cell::RefCell;
use std::fmt::Debug;
use std::sync::{PoisonError, RwLock};

/// Members of the state before the history: strain and stress xx, yy, xy, zz, work done, energy,
/// dissipated work, equivalent plastic strain, strain through the thickness.
const STRESS: usize = 4;
const WORK: usize = 8;
const ENERGY: usize = 9;
const DISSIPATED: usize = 10;
const PLASTIC: usize = 11;
const NORMAL: usize = 12;
const FIRST: usize = 13;
/// History members that are outputs, after the first two names.
const NAMES: &[&str] = &[
    "PEEQ", "PWORK", "SDV1", "SDV2", "SDV3", "SDV4", "SDV5", "SDV6", "SDV7", "SDV8", "SDV9",
    "SDV10", "SDV11", "SDV12", "SDV13", "SDV14", "SDV15", "SDV16", "SDV17", "SDV18", "SDV19",
    "SDV20",
];

/// Addresses of functions that this process may call, by convention; numbers in files are no
/// addresses, so that no file names what is called.
static FUNCTIONS: RwLock<Vec<(&'static str, usize)>> = RwLock::new(Vec::new());

/// Let laws of a convention call the function at an address; its handle.
pub fn register(convention: &'static str, address: usize) -> usize {
    let mut functions = FUNCTIONS.write().unwrap_or_else(PoisonError::into_inner);
    functions.push((convention, address));
    functions.len()
}

/// Address of the function with a handle.
pub fn address(convention: &str, handle: f64) -> Result<usize, String> {
    let functions = FUNCTIONS.read().unwrap_or_else(PoisonError::into_inner);
    match functions.get((handle as usize).wrapping_sub(1)) {
        Some((name, address)) if *name == convention => Ok(*address),
        _ => Err(format!("{convention}: no function with the handle {handle} was registered")),
    }
}

/// Answer of a function at one point; rows xx, yy, xy, zz.
#[derive(Clone, Copy)]
pub struct Answer {
    pub stress: [f64; 4],
    pub tangent: Mat<f64, 4>,
    /// Strain through the thickness in plane stress.
    pub normal: f64,
    /// Recoverable energy density and dissipated work; zero if the function gives neither.
    pub energies: [f64; 2],
    pub plastic: f64,
    pub failed: bool,
}

impl Answer {
    const NONE: Self = Self {
        stress: [0.0; 4],
        tangent: [[0.0; 4]; 4],
        normal: 0.0,
        energies: [0.0; 2],
        plastic: 0.0,
        failed: false,
    };
}

/// Points that one call of a function takes.
pub struct Points<'a> {
    pub count: usize,
    /// Whether there is a strain through the thickness: a ring.
    pub solid: bool,
    pub clock: Clock,
    pub strain: [[f64; 4]; MAX_LANES],
    /// Strain and stress at the committed state.
    pub old_strain: [[f64; 4]; MAX_LANES],
    pub old_stress: [[f64; 4]; MAX_LANES],
    pub old_energies: [[f64; 2]; MAX_LANES],
    /// History, point by point; `new` begins as a copy.
    pub old: &'a [f64],
    pub new: &'a mut [f64],
    pub answers: [Answer; MAX_LANES],
}

/// How functions are called.
pub trait Convention: Clone + Debug + Sized + Send + Sync + 'static {
    const NAME: &'static str;
    /// See [`Material::EXAMPLES`]; the handle 0 is the function of tests.
    const EXAMPLES: &'static [&'static [f64]];
    /// Whether the function gives an equivalent plastic strain.
    const GIVES_PLASTIC: bool;
    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String>;
    /// Members of the function's history.
    fn members(&self) -> usize;
    /// The same for infinitesimal displacements.
    fn linearized(self) -> Self {
        self
    }
    fn call(&self, points: &mut Points<'_>);
}

/// The law of a function.
#[derive(Clone, Debug)]
pub struct External<C> {
    convention: C,
    plane: Plane,
    moduli: Mat<f64, 3>,
}

thread_local! {
    /// Histories of the points of a batch, before and after.
    static HISTORIES: RefCell<[Vec<f64>; 2]> = const { RefCell::new([Vec::new(), Vec::new()]) };
}

impl<C: Convention> External<C> {
    #[inline(always)]
    fn answer<T: Real>(
        &self,
        strain: &[T; 4],
        solid: bool,
        state: &mut PointState<'_>,
    ) -> SolidResponse<T> {
        let members = self.convention.members();
        let mut rows = [[[0.0; 4]; MAX_LANES]; 3];
        for i in 0..4 {
            let old: [T; 2] = [state.get(i), state.get(STRESS + i)];
            for l in 0..T::LANES {
                rows[0][l][i] = strain[i].lanes()[l];
                rows[1][l][i] = old[0].lanes()[l];
                rows[2][l][i] = old[1].lanes()[l];
            }
        }
        let old: [T; 3] = [state.get(WORK), state.get(ENERGY), state.get(DISSIPATED)];
        let mut work = [0.0; MAX_LANES];
        let mut old_energies = [[0.0; 2]; MAX_LANES];
        for l in 0..T::LANES {
            work[l] = old[0].lanes()[l];
            old_energies[l] = [old[1].lanes()[l], old[2].lanes()[l]];
        }
        let [strains, old_strain, old_stress] = rows;
        let mut histories = HISTORIES.take();
        let [old, new] = &mut histories;
        old.clear();
        old.resize(members * T::LANES, 0.0);
        for m in 0..members {
            let v: T = state.get(FIRST + m);
            for l in 0..T::LANES {
                old[l * members + m] = v.lanes()[l];
            }
        }
        new.clone_from(old);
        let mut points = Points {
            count: T::LANES,
            solid,
            clock: state.clock,
            strain: strains,
            old_strain,
            old_stress,
            old_energies,
            old,
            new,
            answers: [Answer::NONE; MAX_LANES],
        };
        self.convention.call(&mut points);
        let answers = points.answers;
        for m in 0..members {
            state.set(FIRST + m, T::from_lanes(|l| points.new[l * members + m]));
        }
        HISTORIES.set(histories);
        let each = |f: &dyn Fn(&Answer, usize) -> f64| T::from_lanes(|l| f(&answers[l], l));
        let mut stress = [T::zero(); 4];
        let mut tangent = [[T::zero(); 4]; 4];
        for i in 0..4 {
            stress[i] = each(&|a, _| a.stress[i]);
            state.set(i, each(&|_, l| strains[l][i]));
            state.set(STRESS + i, stress[i]);
            for j in 0..4 {
                // Elements take symmetric tangents; numbers that carry derivatives the true one.
                tangent[i][j] = if T::STIFFNESS {
                    each(&|a, _| 0.5 * (a.tangent[i][j] + a.tangent[j][i]))
                } else {
                    each(&|a, _| a.tangent[i][j])
                };
            }
        }
        let done = |a: &Answer, l: usize| {
            let mean = |i: usize| 0.5 * (a.stress[i] + old_stress[l][i]);
            let moved = |i: usize| strains[l][i] - old_strain[l][i];
            work[l] + (0..4).map(|i| mean(i) * moved(i)).sum::<f64>()
        };
        state.set(WORK, each(&done));
        state.set(ENERGY, each(&|a, _| a.energies[0]));
        state.set(DISSIPATED, each(&|a, _| a.energies[1]));
        state.set(PLASTIC, each(&|a, _| a.plastic));
        state.set(NORMAL, each(&|a, _| a.normal));
        let wrong = |a: &Answer, _: usize| {
            let finite = a.stress.iter().chain(a.tangent.as_flattened()).all(|v| v.is_finite());
            if a.failed || !finite { 1.0 } else { 0.0 }
        };
        let failed = T::real(0.5).lt(each(&wrong));
        if !T::STIFFNESS {
            for i in 0..4 {
                for j in 0..4 {
                    let moved = strain[j] - each(&|_, l| strains[l][j]);
                    stress[i] = tangent[i][j].fma(moved, stress[i]);
                }
            }
        }
        SolidResponse { stress, tangent, failed }
    }
}

impl<C: Convention> Material for External<C> {
    const NAME: &'static str = C::NAME;
    const EXAMPLES: &'static [&'static [f64]] = C::EXAMPLES;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let convention = C::new(parameters, plane)?;
        let mut law = Self { convention, plane, moduli: [[0.0; 3]; 3] };
        let (old, mut new) = (vec![0.0; law.n_state()], vec![0.0; law.n_state()]);
        let mut state = PointState { old: &old, new: &mut new, stride: 1, clock: Clock::default() };
        let rest = law.update([0.0; 3], &mut state);
        let stiff = (0..3).all(|i| rest.tangent[i][i] > 0.0);
        if rest.failed || !stiff {
            return Err(format!(
                "{}: the function gives no positive moduli without strain and time: its tangent is \
                 {:?}",
                C::NAME,
                rest.tangent
            ));
        }
        law.moduli = rest.tangent;
        Ok(law)
    }
    fn n_state(&self) -> usize {
        FIRST + self.convention.members()
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    fn linearized(self) -> Self {
        Self { convention: self.convention.linearized(), ..self }
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T> {
        let [x, y, xy] = strain;
        let all = self.answer(&[x, y, xy, T::zero()], false, state);
        let mut tangent = [[T::zero(); 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                tangent[i][j] = all.tangent[i][j];
            }
        }
        let [sx, sy, sxy, _] = all.stress;
        Response { stress: [sx, sy, sxy], tangent, failed: all.failed }
    }
    #[inline(always)]
    fn update_solid<T: Real>(
        &self,
        strain: [T; 4],
        state: &mut PointState<'_>,
    ) -> SolidResponse<T> {
        self.answer(&strain, true, state)
    }
    fn out_of_plane(&self, _: [f64; 3], _: [f64; 3], state: &[f64]) -> (f64, f64) {
        match self.plane {
            Plane::Stress => (state[NORMAL], 0.0),
            Plane::Strain => (0.0, state[STRESS + 3]),
        }
    }
    fn energy(&self, _: [f64; 3], _: [f64; 3], state: &[f64]) -> f64 {
        // A function without an energy stores all the work that it does not dissipate.
        if state[ENERGY] == 0.0 { state[WORK] - state[DISSIPATED] } else { state[ENERGY] }
    }
    fn energy_solid(&self, _: [f64; 4], _: [f64; 4], state: &[f64]) -> f64 {
        self.energy([0.0; 3], [0.0; 3], state)
    }
    fn without_normal_strain(&self, s: [f64; 3], _: f64) -> [f64; 3] {
        s
    }
    fn outputs(&self) -> &'static [&'static str] {
        let first = usize::from(!C::GIVES_PLASTIC);
        &NAMES[first..(2 + self.convention.members()).min(NAMES.len())]
    }
    fn output(&self, i: usize, _: [f64; 3], state: &[f64]) -> f64 {
        match i + usize::from(!C::GIVES_PLASTIC) {
            0 => state[PLASTIC],
            1 => state[DISSIPATED],
            k => state[FIRST + k - 2],
        }
    }
    fn plastic_member(&self) -> Option<usize> {
        C::GIVES_PLASTIC.then_some(PLASTIC)
    }
    fn work_member(&self) -> Option<usize> {
        Some(DISSIPATED)
    }
}
