//! Linear viscoelasticity on an elastic or hyperelastic parent, as a Prony series of its stress:
//! every term holds a share `g` of the deviator and `k` of the mean stress of the parent, which
//! relaxes in the time `tau`. The recursive update (Taylor, Pister and Goudreau 1970; Simo 1987) is
//! exact for a parent's stress that is linear in time over the increment, of any length.
//!
//! Parameters: number of the parent in [`PARENTS`]; its parameters, after their number; triples
//! (g, k, tau), after the number of these numbers; and the shift of times by Williams, Landel and
//! Ferry (1955), empty or C1, C2, its temperature and that of the body, after their number.
//!
//! The parent is that of short times. Where no slow process takes part it answers alone.
//!
//! Where a parent couples its volume to its deviator (foams) and the shares of both differ, the
//! exact tangent is not symmetric; its symmetric part is returned.
// SPDX-License-Identifier: BSD-3-Clause

use super::law::{update, update_solid};
use super::material::{Material, Plane, PointState, Response, SolidResponse};
use crate::base::small::Mat;
use crate::base::{Real, shared};

/// Members of the state: work of the stress, strain and stress (xx, yy, xy, zz), stress of the
/// parent, error of the strain of an increment, then the stress of each term.
const WORK: usize = 0;
const STRAIN: usize = 1;
const STRESS: usize = 5;
const PARENT: usize = 9;
const ERROR: usize = 13;
const TERMS: usize = 14;
/// Iterations for the thickness strain in plane stress, longest step, and the step after which one
/// linear correction is exact to round-off.
const MAX_ITERATIONS: usize = 50;
const LONGEST_STEP: f64 = 0.5;
const TOLERANCE: f64 = 1e-9;
/// Ratio of times below which a relaxation is summed as a series.
const SMALL: f64 = 1e-2;

macro_rules! parents {
    ($($file:ident::$name:ident),+ $(,)?) => {
        /// Laws that can relax, by their numbers.
        const PARENTS: &[&str] = &[$(super::$file::$name::NAME),+];

        /// A law that relaxes.
        #[derive(Clone, Debug)]
        enum Parent { $($name(super::$file::$name)),+ }

        impl Parent {
            fn new(kind: usize, numbers: &[f64], plane: Plane) -> Result<Self, String> {
                let law = PARENTS.get(kind);
                $(if law == Some(&super::$file::$name::NAME) {
                    return super::$file::$name::new(numbers, plane).map(Self::$name);
                })+
                Err(format!("parents are {PARENTS:?} by their numbers, not {kind}"))
            }
        }

        /// Call a method of the law of a parent.
        macro_rules! of {
            ($parent:expr, $law:ident => $call:expr) => {
                match $parent { $(Parent::$name($law) => $call),+ }
            };
        }
    };
}
super::hyperelastic_laws!(parents, [elastic::Elastic,], []);

#[derive(Clone, Copy, Debug)]
struct Term {
    deviator: f64,
    mean: f64,
    time: f64,
}

/// How far a term relaxes in an increment: what is left of its stress, and its share of a stress
/// that is added evenly.
#[derive(Clone, Copy)]
struct Relaxation {
    left: f64,
    added: f64,
    /// Time of the increment over that of the term.
    time: f64,
}

impl Relaxation {
    /// Over a time, by that of the term.
    fn new(x: f64) -> Self {
        let left = (-x).exp();
        let added = if x < SMALL {
            1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0)))
        } else {
            -(-x).exp_m1() / x
        };
        Self { left, added, time: x }
    }
}

#[derive(Clone, Debug)]
pub struct Viscoelastic {
    parent: Parent,
    plane: Plane,
    /// Whether the volume is constant, in plane stress: the stress in the plane is one of deviators.
    flat: bool,
    terms: Vec<Term>,
    /// Factor on times.
    shift: f64,
    /// Shear and bulk modulus at small strain.
    shear: f64,
    bulk: f64,
    moduli: Mat<f64, 3>,
    /// Thickness strain over the sum of the strains in the plane, at small strain.
    contraction: f64,
}

/// The stress after an increment, its derivative, and what the terms hold.
struct Relaxed<T: Real> {
    stress: [T; 4],
    tangent: Mat<T, 4>,
    /// Stress of the parent.
    parent: [T; 4],
    failed: T::Mask,
}

/// Third of the trace.
#[inline(always)]
fn mean<T: Real>(s: &[T; 4]) -> T {
    (s[0] + s[1] + s[3]).scale(1.0 / 3.0)
}

/// `by` times the deviator and `of_mean` times the mean.
#[inline(always)]
fn shares<T: Real>(s: &[T; 4], by: f64, of_mean: f64) -> [T; 4] {
    let rest = mean(s).scale(of_mean - by);
    [
        s[0].fma(T::real(by), rest),
        s[1].fma(T::real(by), rest),
        s[2].scale(by),
        s[3].fma(T::real(by), rest),
    ]
}

impl Viscoelastic {
    /// The answer of the parent; in plane stress without the rows through the thickness.
    #[inline(always)]
    fn of_parent<T: Real>(&self, e: &[T; 4], state: &mut PointState<'_>) -> SolidResponse<T> {
        if !self.flat {
            return of!(&self.parent, parent => update_solid(parent, *e, state));
        }
        let flat = of!(&self.parent, parent => update(parent, [e[0], e[1], e[2]], state));
        let mut tangent = [[T::zero(); 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                tangent[i][j] = flat.tangent[i][j];
            }
        }
        let [x, y, xy] = flat.stress;
        SolidResponse { stress: [x, y, xy, T::zero()], tangent, failed: flat.failed }
    }

    /// The relaxations of an increment.
    fn relaxations(&self, state: &PointState<'_>) -> Vec<Relaxation> {
        let clock = state.clock;
        let time = if clock.lasting { clock.increment / self.shift } else { 0.0 };
        self.terms.iter().map(|term| Relaxation::new(time / term.time)).collect()
    }

    /// Shares of the parent's stress that never relax.
    fn lasting(&self) -> [f64; 2] {
        let sum = |share: fn(&Term) -> f64| 1.0 - self.terms.iter().map(share).sum::<f64>();
        [sum(|t| t.deviator), if self.flat { sum(|t| t.deviator) } else { sum(|t| t.mean) }]
    }

    /// Shares of a term of deviator and mean; in a flat parent all is deviator.
    fn of_term(&self, term: &Term) -> [f64; 2] {
        [term.deviator, if self.flat { term.deviator } else { term.mean }]
    }

    #[inline(always)]
    fn relax<T: Real>(
        &self,
        e: &[T; 4],
        state: &mut PointState<'_>,
        relaxations: &[Relaxation],
    ) -> Relaxed<T> {
        shared::<T, _>(
            #[inline(always)]
            || {
                let o = T::zero();
                let solid = self.of_parent(e, state);
                let mut change = solid.stress;
                for (i, c) in change.iter_mut().enumerate() {
                    *c -= state.get(PARENT + i);
                }
                let [mut by, mut of_mean] = self.lasting();
                let mut stress = shares(&solid.stress, by, of_mean);
                for (n, (term, over)) in self.terms.iter().zip(relaxations).enumerate() {
                    let [g, k] = self.of_term(term);
                    let added = shares(&change, g * over.added, k * over.added);
                    for i in 0..4 {
                        let before: T = state.get(TERMS + 4 * n + i);
                        stress[i] += before.fma(T::real(over.left), added[i]);
                    }
                    by += g * over.added;
                    of_mean += k * over.added;
                }
                let mut tangent = [[o; 4]; 4];
                for j in 0..4 {
                    let column = std::array::from_fn(|i| solid.tangent[i][j]);
                    let scaled = shares(&column, by, of_mean);
                    for i in 0..4 {
                        tangent[i][j] += scaled[i].scale(0.5);
                        tangent[j][i] += scaled[i].scale(0.5);
                    }
                }
                Relaxed { stress, tangent, parent: solid.stress, failed: solid.failed }
            },
        )
    }

    /// Energy of the stress of a term: that of an elastic body with its share of the moduli.
    fn energy_of(&self, term: &Term, s: &[f64; 4]) -> f64 {
        let m = mean(s);
        let square = [0, 1, 3].iter().map(|&i| (s[i] - m) * (s[i] - m)).sum::<f64>();
        let mut sum = 0.0;
        if term.deviator > 0.0 {
            sum += (square + 2.0 * s[2] * s[2]) / (4.0 * self.shear * term.deviator);
        }
        if term.mean > 0.0 && !self.flat {
            sum += 0.5 * m * m / (self.bulk * term.mean);
        }
        sum
    }

    /// Size of the strain at small strain of a stress.
    #[inline(always)]
    fn strain_of<T: Real>(&self, s: &[T; 4]) -> T {
        let m = mean(s);
        let mut square = s[2] * s[2].scale(2.0);
        for i in [0, 1, 3] {
            square += (s[i] - m) * (s[i] - m);
        }
        let round = (square.scale(1.5)).sqrt().scale(1.0 / (3.0 * self.shear));
        if self.flat { round } else { round + m.abs().scale(1.0 / (3.0 * self.bulk)) }
    }

    /// Write the state.
    ///
    /// The error is that of a strain which is not linear over the increment. Under a steady force
    /// its rate is that of the terms, so an eighth of the change of their rate is how far it bends;
    /// a strain that stays has none.
    #[inline(always)]
    fn keep<T: Real>(
        &self,
        e: &[T; 4],
        at: &Relaxed<T>,
        state: &mut PointState<'_>,
        relaxations: &[Relaxation],
    ) {
        shared::<T, _>(
            #[inline(always)]
            || {
                let mut change = at.parent;
                let mut work: T = state.get(WORK);
                for i in 0..4 {
                    change[i] -= state.get(PARENT + i);
                    let (e0, s0): (T, T) = (state.get(STRAIN + i), state.get(STRESS + i));
                    work += ((at.stress[i] + s0) * (e[i] - e0)).scale(0.5);
                    state.set(PARENT + i, at.parent[i]);
                    state.set(STRAIN + i, e[i]);
                    state.set(STRESS + i, at.stress[i]);
                }
                state.set(WORK, work);
                let mut bend = [T::zero(); 4];
                for (n, (term, over)) in self.terms.iter().zip(relaxations).enumerate() {
                    let [g, k] = self.of_term(term);
                    let added = shares(&change, g * over.added, k * over.added);
                    for i in 0..4 {
                        let before: T = state.get(TERMS + 4 * n + i);
                        let after = before.fma(T::real(over.left), added[i]);
                        state.set(TERMS + 4 * n + i, after);
                        bend[i] += (after - before).scale(over.time / 8.0);
                    }
                }
                state.set(ERROR, self.strain_of(&bend).min(self.strain_of(&change)));
            },
        );
    }

    #[inline(always)]
    fn solid<T: Real>(&self, e: &[T; 4], state: &mut PointState<'_>) -> SolidResponse<T> {
        let relaxations = self.relaxations(state);
        let at = self.relax(e, state, &relaxations);
        self.keep(e, &at, state, &relaxations);
        SolidResponse { stress: at.stress, tangent: at.tangent, failed: at.failed }
    }

    #[inline(always)]
    fn answer<T: Real>(&self, e: &[T; 3], state: &mut PointState<'_>) -> Response<T> {
        let o = T::zero();
        let in_plane = |m: &Mat<T, 4>| {
            let mut d = [[o; 3]; 3];
            for i in 0..3 {
                for j in 0..3 {
                    d[i][j] = m[i][j];
                }
            }
            d
        };
        if self.plane == Plane::Strain || self.flat {
            let z = if self.flat { -(e[0] + e[1]) } else { o };
            let SolidResponse { stress: [x, y, xy, _], tangent, failed } =
                self.solid(&[e[0], e[1], e[2], z], state);
            return Response { stress: [x, y, xy], tangent: in_plane(&tangent), failed };
        }
        let relaxations = self.relaxations(state);
        let mut z = (e[0] + e[1]).scale(self.contraction);
        let mut open = T::one();
        for _ in 0..MAX_ITERATIONS {
            let at = self.relax(&[e[0], e[1], e[2], z], state, &relaxations);
            // Against the stress even where the slope is negative.
            let step = (at.stress[3] / at.tangent[3][3].abs()).min(T::real(LONGEST_STEP));
            let step = step.max(T::real(-LONGEST_STEP));
            z -= step;
            open = T::select(step.abs().lt(T::real(TOLERANCE)), T::zero(), T::one());
            if !T::any(T::real(0.5).lt(open)) {
                break;
            }
        }
        let all = self.relax(&[e[0], e[1], e[2], z], state, &relaxations);
        // What is left of the stress through the thickness is removed by its linear part.
        let softness = all.tangent[3][3].recip();
        let mut stress = [all.stress[0], all.stress[1], all.stress[2]];
        let mut tangent = in_plane(&all.tangent);
        for i in 0..3 {
            let share = all.tangent[i][3] * softness;
            stress[i] -= share * all.stress[3];
            for j in 0..3 {
                tangent[i][j] -= share * all.tangent[3][j];
            }
        }
        let whole = [e[0], e[1], e[2], z - all.stress[3] * softness];
        let at = Relaxed { stress: [stress[0], stress[1], stress[2], o], ..all };
        self.keep(&whole, &at, state, &relaxations);
        Response { stress, tangent, failed: T::or(at.failed, T::real(0.5).lt(open)) }
    }
}

/// The first list of some numbers after its length, and the rest.
fn list(numbers: &[f64]) -> Result<(&[f64], &[f64]), String> {
    let (&count, rest) = numbers.split_first().ok_or("the length of a list is missing")?;
    rest.split_at_checked(count as usize).ok_or_else(|| "a list is too short".into())
}

impl Material for Viscoelastic {
    const NAME: &'static str = "viscoelastic";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[0.0, 2.0, 1000.0, 0.3, 6.0, 0.3, 0.1, 0.2, 0.2, 0.0, 5.0, 4.0, 17.4, 51.6, 20.0, 25.0],
        &[0.0, 2.0, 7.0, 0.3, 6.0, 0.3, 0.1, 0.2, 0.2, 0.0, 5.0, 0.0],
        &[
            1.0, 12.0, 0.5, 0.1, 0.02, 0.01, 0.03, 0.005, 0.001, 0.002, 0.003, 0.1, 0.5, 2.0, 3.0,
            0.4, 0.2, 0.3, 0.0,
        ],
        &[4.0, 3.0, 0.5, 4.0, 0.2, 3.0, 0.4, 0.4, 0.3, 0.0],
    ];

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[kind, ref rest @ ..] = parameters else {
            return Err("viscoelastic takes a parent, its parameters and terms".into());
        };
        let (numbers, rest) = list(rest)?;
        let (shares, rest) = list(rest)?;
        let (shift, rest) = list(rest)?;
        let kind = kind as usize;
        let incompressible = kind > 0 && Parent::new(kind, numbers, Plane::Strain).is_err();
        let flat = incompressible && plane == Plane::Stress;
        let parent = Parent::new(kind, numbers, if flat { plane } else { Plane::Strain })?;
        if !rest.is_empty() || shares.is_empty() || shares.len() % 3 != 0 {
            return Err("viscoelastic takes triples g, k, tau".into());
        }
        let terms: Vec<Term> = shares
            .as_chunks::<3>()
            .0
            .iter()
            .map(|&[deviator, mean, time]| Term { deviator, mean, time })
            .collect();
        let fit = |t: &Term| t.deviator >= 0.0 && t.mean >= 0.0 && t.time > 0.0;
        let sums = terms.iter().fold([0.0; 2], |s, t| [s[0] + t.deviator, s[1] + t.mean]);
        if !(terms.iter().all(fit) && sums.iter().all(|&s| s < 1.0)) {
            return Err(
                "the terms need g >= 0, k >= 0 and tau > 0, and sums of g and k below 1".into()
            );
        }
        let shift = match *shift {
            [] => 1.0,
            // Below the temperature at which the shift is infinite nothing relaxes.
            [c1, c2, at, temperature] if c2 + temperature - at <= 0.0 && c1 > 0.0 => f64::INFINITY,
            [c1, c2, at, temperature] => {
                10.0_f64.powf(-c1 * (temperature - at) / (c2 + temperature - at))
            }
            _ => return Err("the shift takes C1, C2, its temperature and that of the body".into()),
        };
        let mut law = Self {
            parent,
            plane,
            flat,
            terms,
            shift,
            shear: 0.0,
            bulk: 0.0,
            moduli: [[0.0; 3]; 3],
            contraction: 0.0,
        };
        let members = law.n_state();
        let (old, mut new) = (vec![0.0; members], vec![0.0; members]);
        let clock = super::Clock::default();
        let mut state = PointState { old: &old, new: &mut new, stride: 1, clock };
        if !flat {
            let m = law.solid(&[0.0; 4], &mut state).tangent;
            law.bulk = (m[3][3] + 2.0 * m[3][0]) / 3.0;
            law.contraction = -m[3][0] / m[3][3];
        }
        law.moduli = law.answer(&[0.0; 3], &mut state).tangent;
        law.shear = law.moduli[2][2];
        Ok(law)
    }
    fn n_state(&self) -> usize {
        TERMS + 4 * self.terms.len()
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T> {
        self.answer(&strain, state)
    }
    #[inline(always)]
    fn update_solid<T: Real>(
        &self,
        strain: [T; 4],
        state: &mut PointState<'_>,
    ) -> SolidResponse<T> {
        self.solid(&strain, state)
    }
    fn out_of_plane(&self, _: [f64; 3], _: [f64; 3], state: &[f64]) -> (f64, f64) {
        match self.plane {
            Plane::Stress => (state[STRAIN + 3], 0.0),
            Plane::Strain => (0.0, state[STRESS + 3]),
        }
    }
    fn energy(&self, e: [f64; 3], s: [f64; 3], state: &[f64]) -> f64 {
        self.energy_solid([e[0], e[1], e[2], state[STRAIN + 3]], [s[0], s[1], s[2], 0.0], state)
    }
    fn energy_solid(&self, e: [f64; 4], _: [f64; 4], state: &[f64]) -> f64 {
        let own: [f64; 4] = std::array::from_fn(|i| state[PARENT + i]);
        let [by, of_mean] = self.lasting();
        let [x, y, xy, z] = e;
        let mut sum = if self.flat {
            let plane = [own[0], own[1], own[2]];
            by * of!(&self.parent, law => law.energy([x, y, xy], plane, &[]))
        } else {
            // Of the volume alone, and of the deviator.
            let grown = (x + y + z) / 3.0;
            let p = 3.0 * self.bulk * grown;
            let (ball, round) = ([grown, grown, 0.0, grown], [p, p, 0.0, p]);
            let all = of!(&self.parent, law => law.energy_solid(e, own, &[]));
            let volume = of!(&self.parent, law => law.energy_solid(ball, round, &[]));
            by * (all - volume) + of_mean * volume
        };
        for (n, term) in self.terms.iter().enumerate() {
            let own: [f64; 4] = std::array::from_fn(|i| state[TERMS + 4 * n + i]);
            sum += self.energy_of(term, &own);
        }
        sum
    }
    fn creep_error_member(&self) -> Option<usize> {
        Some(ERROR)
    }
    fn outputs(&self) -> &'static [&'static str] {
        &["CWORK"]
    }
    fn output(&self, _: usize, _: [f64; 3], state: &[f64]) -> f64 {
        let strain = std::array::from_fn(|i| state[STRAIN + i]);
        state[WORK] - self.energy_solid(strain, [0.0; 4], state)
    }
}
