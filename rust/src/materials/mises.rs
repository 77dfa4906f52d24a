//! J2 (von Mises) plasticity with isotropic and kinematic hardening: implicit return map in
//! plane stress (projected, Simo & Taylor 1986; de Souza Neto, Peric & Owen 2008, chapter 9)
//! and plane strain, as one scalar equation.
//!
//! Parameters: E, nu, number of back-stresses n, n pairs (C, gamma), then the numbers of the
//! [`Flow`], here of [`Isotropic::new`].
//!
//! Tensors are held by sum `11 + 22`, difference `11 - 22` and shear, in which elasticity and
//! the yield norm are diagonal; in plane strain the sum is that of the deviator. With the step
//! `dp` of the equivalent plastic strain as the unknown, the multiplier is
//! `g = 3 dp / (2 sy(p + dp))`, each component of the relative stress is its trial value over
//! `1 + g (k + 2/3 sum C)`, and `sy / q = 1` is nearly linear in `dp`.
//!
//! The tangent is symmetric for linear kinematic hardening. With recall (`gamma > 0`) the exact
//! one is not; its symmetric part is returned.
// SPDX-License-Identifier: BSD-3-Clause

use super::hardening::{BackStress, Isotropic};
use super::material::{Material, Plane, PointState, Response, TensorOutput, broadcast, in_plane};
use crate::base::small::Mat;
use crate::base::{Real, shared_dual};
use std::fmt::Debug;

/// Most back-stresses of a material.
pub const MAX_BACK: usize = 6;
/// Iterations of the scalar equation; bisection alone reaches round-off in this many.
const MAX_ITERATIONS: usize = 80;
/// Relative error of the yield condition after which one more Newton step is exact to
/// round-off (its error is the square of this).
const TOLERANCE: f64 = 1e-12;
/// Excess over the yield stress, relative to the stresses it is the difference of, that is
/// rounding. A committed plastic state lies on the yield surface up to that, and up to the last
/// step of the modes of an element; neither must choose between the tangents there, and the
/// elastic one is taken.
pub(super) const ROUNDING: f64 = 1e-9;
/// Step of the equivalent plastic strain that is nothing: a stress that makes less is elastic.
pub const LEAST_STEP: f64 = 1e-30;
/// Longest change of the logarithm of a step.
const LONGEST: f64 = 100.0;
/// Members of the state: plastic strain (3), equivalent plastic strain, plastic work.
const EQUIVALENT: usize = 3;
const WORK: usize = 4;
const BACK: usize = 5;

/// The flow stress of a J2 law.
pub trait Flow: Clone + Debug + Sized {
    const NAME: &'static str;
    /// See [`Material::EXAMPLES`].
    const EXAMPLES: &'static [&'static [f64]];
    /// Members of the state beside those of every J2 law.
    const MEMBERS: usize = 0;
    /// Whether the slope of the flow stress may be infinite at the start of a step. The step is
    /// then sought on the scale of its logarithm.
    const STEEP: bool = false;
    const OUTPUTS: &'static [&'static str] = &["PEEQ", "YRATIO", "PWORK", "PDISS"];
    /// What an increment starts from.
    type Start<T: Real>: Copy;

    fn new(numbers: &[f64]) -> Result<Self, String>;
    /// `p` is the equivalent plastic strain, `first` the first of the law's members.
    fn start<T: Real>(&self, state: &PointState<'_>, p: T, first: usize) -> Self::Start<T>;
    /// Flow stress where a step begins to flow.
    fn limit<T: Real>(&self, start: &Self::Start<T>) -> T;
    /// Flow stress after a step `dp` and its derivative.
    fn after<T: Real>(&self, start: &Self::Start<T>, dp: T) -> (T, T);
    /// Work of the flow stress over a step that ends with the stress `end`.
    fn work<T: Real>(&self, start: &Self::Start<T>, dp: T, end: T) -> T;
    /// Write the members; `q` is the equivalent relative stress at the end.
    fn keep<T: Real>(
        &self,
        _start: &Self::Start<T>,
        _dp: T,
        _q: T,
        _state: &mut PointState<'_>,
        _first: usize,
    ) {
    }
    /// Whether the flow stress has a limit, whatever the rate.
    fn saturates(&self) -> bool {
        false
    }
    /// Yield stress without rate; 0 where every stress flows.
    fn yield_stress(&self, p: f64) -> f64;
    /// Energy density that the hardening stores.
    fn stored(&self, p: f64) -> f64;
    /// Part of the plastic work that is creep, by the law's members.
    fn creep_work(&self, _members: &[f64]) -> f64 {
        0.0
    }
    /// Value of an output that only this law has.
    fn output(&self, _i: usize, _members: &[f64]) -> f64 {
        0.0
    }
    /// See [`Material::creep_error_member`], from the law's members on.
    fn creep_error(&self) -> Option<usize> {
        None
    }
}

impl Flow for Isotropic {
    const NAME: &'static str = "mises";
    const EXAMPLES: &'static [&'static [f64]] = &[
        // a back-stress with recall, hardening of Voce
        &[1000.0, 0.3, 1.0, 50.0, 2.0, 2.0, 80.0, 20.0, 5.0, 100.0],
        // perfectly plastic; linear isotropic and kinematic; Voce; table
        &[7.0, 0.3, 0.0, 0.0, 0.05, 0.0],
        &[7.0, 0.3, 1.0, 0.8, 0.0, 0.0, 0.05, 0.4],
        &[7.0, 0.3, 0.0, 2.0, 0.05, 0.03, 40.0, 0.1],
        &[7.0, 0.3, 0.0, 1.0, 0.05, 0.0, 0.07, 0.01, 0.08, 0.2],
    ];
    type Start<T: Real> = T;

    fn new(numbers: &[f64]) -> Result<Self, String> {
        Isotropic::new(numbers)
    }
    #[inline(always)]
    fn start<T: Real>(&self, _: &PointState<'_>, p: T, _: usize) -> T {
        p
    }
    #[inline(always)]
    fn limit<T: Real>(&self, p: &T) -> T {
        self.at(*p).0
    }
    #[inline(always)]
    fn after<T: Real>(&self, p: &T, dp: T) -> (T, T) {
        self.at(*p + dp)
    }
    #[inline(always)]
    fn work<T: Real>(&self, p: &T, dp: T, _: T) -> T {
        Isotropic::work(self, *p, dp)
    }
    fn saturates(&self) -> bool {
        Isotropic::saturates(self)
    }
    fn yield_stress(&self, p: f64) -> f64 {
        self.at(p).0
    }
    fn stored(&self, p: f64) -> f64 {
        Isotropic::stored(self, p)
    }
}

pub type Mises = J2<Isotropic>;

#[derive(Clone, Debug)]
pub struct J2<F> {
    young: f64,
    nu: f64,
    plane: Plane,
    moduli: Mat<f64, 3>,
    flow_stress: F,
    back: Vec<BackStress>,
    /// Whether hardening ends.
    ideal: bool,
    /// Stress of a unit elastic strain, without the mean stress in plane strain.
    elastic: [f64; 3],
    /// Stress that a unit plastic strain takes away.
    relief: [f64; 3],
    /// Plastic strain for a unit relative stress and multiplier.
    flow: [f64; 3],
    /// Squared norm of the deviator.
    norm: [f64; 3],
    /// Work of stress on plastic strain.
    work: [f64; 3],
    /// Sum of the in-plane mean stress for a unit strain sum (plane strain).
    volume: f64,
}

/// The state at a trial step `dp`.
struct Trial<T: Real> {
    dp: T,
    /// Flow stress.
    sy: T,
    /// Multiplier and its derivative.
    g: T,
    dg: T,
    /// Relative stress, its derivative, and the divisor of the trial value.
    eta: [T; 3],
    d_eta: [T; 3],
    divisor: [T; 3],
    /// Equivalent relative stress.
    q: T,
    /// `sy' - q'`, positive.
    slope: T,
    /// `sy / q - 1` and its derivative.
    value: T,
    derivative: T,
}

impl<F: Flow> J2<F> {
    #[inline(always)]
    fn equivalent<T: Real>(&self, s: &[T; 3]) -> T {
        let mut sum = T::zero();
        for k in 0..3 {
            sum = (s[k] * s[k]).fma(T::real(1.5 * self.norm[k]), sum);
        }
        sum.sqrt()
    }

    #[inline(always)]
    fn trial<T: Real>(
        &self,
        y: &[T; 3],
        start: &F::Start<T>,
        old: &[[T; 3]; MAX_BACK],
        dp: T,
    ) -> Trial<T> {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let (sy, h) = self.flow_stress.after(start, dp);
                let r = sy.recip();
                let g = dp.scale(1.5) * r;
                let dg = (T::real(1.5) - g * h) * r;
                let (mut modulus, mut d_modulus) = (T::zero(), T::zero());
                let (mut shift, mut d_shift) = ([T::zero(); 3], [T::zero(); 3]);
                for (b, beta) in self.back.iter().zip(old) {
                    let (kept, d_kept) = b.kept(dp);
                    modulus = kept.fma(T::real(b.modulus * 2.0 / 3.0), modulus);
                    d_modulus = d_kept.fma(T::real(b.modulus * 2.0 / 3.0), d_modulus);
                    for k in 0..3 {
                        shift[k] = kept.fma(beta[k], shift[k]);
                        d_shift[k] = d_kept.fma(beta[k], d_shift[k]);
                    }
                }
                let (mut eta, mut d_eta) = ([T::zero(); 3], [T::zero(); 3]);
                let mut divisor = [T::zero(); 3];
                for k in 0..3 {
                    let stiff = T::real(self.relief[k] * self.flow[k]) + modulus;
                    divisor[k] = g.fma(stiff, T::one());
                    let inverse = divisor[k].recip();
                    eta[k] = (y[k] - shift[k]) * inverse;
                    let d = dg.fma(stiff, g * d_modulus);
                    d_eta[k] = -(eta[k].fma(d, d_shift[k])) * inverse;
                }
                let q = self.equivalent(&eta).max(T::real(f64::MIN_POSITIVE));
                let inverse = q.recip();
                let mut dq = T::zero();
                for k in 0..3 {
                    dq = (eta[k] * d_eta[k]).fma(T::real(1.5 * self.norm[k]), dq);
                }
                dq = dq * inverse;
                let value = (sy - q) * inverse;
                let derivative = (h - sy * dq * inverse) * inverse;
                Trial { dp, sy, g, dg, eta, d_eta, divisor, q, slope: h - dq, value, derivative }
            },
        )
    }

    /// Step of the equivalent plastic strain in the lanes that yield, by Newton's method from
    /// zero inside a shrinking bracket; also the lanes in which it did not settle.
    ///
    /// A steep flow stress starts from the other end, with the logarithms of step and stress: those
    /// of sums of powers are convex in each other, so that Newton's method comes from above.
    #[inline(always)]
    fn solve<T: Real>(
        &self,
        y: &[T; 3],
        start: &F::Start<T>,
        old: &[[T; 3]; MAX_BACK],
        excess: T,
        yields: T::Mask,
    ) -> (T, T::Mask) {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let mut softest = f64::MAX;
                for k in 0..3 {
                    if self.norm[k] > 0.0 {
                        softest = softest.min(self.relief[k] * self.flow[k]);
                    }
                }
                // Recall can only bring back what the old back-stresses hold.
                let mut most = excess;
                if F::STEEP {
                    // What softens may end below the stress where it began.
                    most += self.flow_stress.limit(start);
                }
                for (b, beta) in self.back.iter().zip(old) {
                    if b.recall > 0.0 {
                        most += self.equivalent(beta);
                    }
                }
                let (mut low, mut high) = (T::zero(), most.scale((1.0 + 1e-9) / (1.5 * softest)));
                let mut dp = T::zero();
                if F::STEEP {
                    // Lanes that do not flow need a number with a logarithm.
                    high = T::select(yields, high, T::one());
                    dp = high;
                    low = T::real(LEAST_STEP).min(high);
                }
                let mut open = T::zero();
                for _ in 0..MAX_ITERATIONS {
                    let at = self.trial(y, start, old, dp);
                    let settled = at.value.abs().lt(T::real(TOLERANCE));
                    let short = at.value.lt(T::zero());
                    low = T::select(short, dp, low);
                    high = T::select(short, high, dp);
                    if F::STEEP {
                        let ratio = at.value + T::one();
                        let step = ratio.ln() * ratio / (at.derivative * dp);
                        let step = step.max(T::real(-LONGEST)).min(T::real(LONGEST));
                        let next = dp * (-step).exp();
                        let inside = T::or(settled, T::and(low.lt(next), next.lt(high)));
                        let middle = (low.sqrt() * high.sqrt()).max(low);
                        dp = T::select(yields, T::select(inside, next, middle), T::one());
                    } else {
                        let next = dp - at.value / at.derivative;
                        let inside = T::or(settled, T::and(low.lt(next), next.lt(high)));
                        let next = T::select(inside, next, (low + high).scale(0.5));
                        dp = T::select(yields, next, T::zero());
                    }
                    let rest = T::select(settled, T::zero(), T::one());
                    open = T::select(yields, rest, T::zero());
                    if !T::any(T::real(0.5).lt(open)) {
                        break;
                    }
                }
                (T::select(yields, dp, T::zero()), T::real(0.5).lt(open))
            },
        )
    }

    /// [`J2::solve`]; where numbers carry derivatives, of plain numbers, and these follow by one step
    /// of Newton's method about the solution.
    #[inline(always)]
    fn step<T: Real>(
        &self,
        y: &[T; 3],
        start: &F::Start<T>,
        old: &[[T; 3]; MAX_BACK],
        excess: T,
        yields: T::Mask,
        state: &PointState<'_>,
    ) -> (T, T::Mask) {
        if T::DERIVATIVES == 0 {
            return self.solve(y, start, old, excess, yields);
        }
        let plain = |v: &[T; 3]| v.map(|v| v.lane(0));
        let begin = self.flow_stress.start(state, state.get(EQUIVALENT), self.first());
        let all = old.each_ref().map(plain);
        let (dp, open) = self.solve::<f64>(&plain(y), &begin, &all, excess.lane(0), true);
        let at = self.trial(y, start, old, T::real(dp));
        let failed = if open { T::zero().lt(T::one()) } else { T::none() };
        (T::real(dp) - at.value / at.derivative, failed)
    }

    /// Elastic tangent less the plastic part, symmetric.
    #[inline(always)]
    fn tangent<T: Real>(&self, at: &Trial<T>, yields: T::Mask) -> Mat<T, 3> {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                const WEIGHT: [f64; 3] = [0.5, 0.5, 1.0];
                let scale = T::select(yields, at.slope.recip(), T::zero());
                let to_norm = at.q.recip().scale(1.5);
                let (mut left, mut right) = ([T::zero(); 3], [T::zero(); 3]);
                let mut b = [[T::zero(); 3]; 3];
                for k in 0..3 {
                    let inverse = at.divisor[k].recip();
                    let stiff = self.relief[k] * self.flow[k];
                    let rest = T::one() - at.g.scale(stiff) * inverse;
                    b[k][k] = rest.scale(WEIGHT[k] * self.elastic[k]);
                    left[k] = at.dg.fma(at.eta[k], at.g * at.d_eta[k]).scale(WEIGHT[k] * stiff);
                    right[k] =
                        (at.eta[k] * inverse * to_norm).scale(self.norm[k] * self.elastic[k]);
                    right[k] = right[k] * scale;
                }
                b[0][0] += T::real(0.5 * self.volume);
                for i in 0..3 {
                    for j in i..3 {
                        let sum = left[i].fma(right[j], left[j] * right[i]);
                        b[i][j] = sum.fma(T::real(-0.5), b[i][j]);
                    }
                }
                in_plane(&b)
            },
        )
    }

    /// A tensor of the state as 11, 22, 33, 12.
    fn tensor_at(state: &[f64], first: usize) -> [f64; 4] {
        let [sum, difference, shear] = [state[first], state[first + 1], state[first + 2]];
        [0.5 * (sum + difference), 0.5 * (sum - difference), -sum, shear]
    }

    /// Deviator of a back-stress; in plane stress the state holds the tensor with zero 33.
    fn back_at(&self, state: &[f64], i: usize) -> [f64; 4] {
        let first = BACK + 3 * i;
        let mut b = Self::tensor_at(state, first);
        if self.plane == Plane::Stress {
            let mean = state[first] / 3.0;
            b[0] -= mean;
            b[1] -= mean;
            b[2] = -mean;
        }
        b
    }

    /// Stress through the thickness.
    fn normal(&self, s: [f64; 3], state: &[f64]) -> f64 {
        match self.plane {
            Plane::Stress => 0.0,
            Plane::Strain => self.nu * (s[0] + s[1]) + self.young * state[0],
        }
    }

    /// First member of the flow stress.
    fn first(&self) -> usize {
        BACK + 3 * self.back.len()
    }

    #[inline(always)]
    fn answer<T: Real>(&self, strain: &[T; 3], state: &mut PointState<'_>) -> Response<T> {
        let e = [strain[0] + strain[1], strain[0] - strain[1], strain[2]];
        let mut y = [T::zero(); 3];
        let mut plastic = [T::zero(); 3];
        for k in 0..3 {
            plastic[k] = state.get(k);
            y[k] = e[k].fma(T::real(self.elastic[k]), plastic[k].scale(-self.relief[k]));
        }
        let p: T = state.get(EQUIVALENT);
        let mut old = [[T::zero(); 3]; MAX_BACK];
        let mut eta = y;
        for i in 0..self.back.len() {
            for k in 0..3 {
                old[i][k] = state.get(BACK + 3 * i + k);
                eta[k] -= old[i][k];
            }
        }
        let start = self.flow_stress.start(state, p, self.first());
        let limit = self.flow_stress.limit(&start);
        let excess = self.equivalent(&eta) - limit;
        let yields = T::zero().lt(excess);
        let (sum, tangent, failed);
        if T::any(yields) {
            let (dp, open) = self.step(&y, &start, &old, excess, yields, state);
            failed = open;
            let at = self.trial(&y, &start, &old, dp);
            let mut done: T = state.get(WORK);
            let mut step = [T::zero(); 3];
            for k in 0..3 {
                step[k] = (at.g * at.eta[k]).scale(self.flow[k]);
                y[k] = step[k].fma(T::real(-self.relief[k]), y[k]);
                state.set(k, plastic[k] + step[k]);
            }
            state.set(EQUIVALENT, p + at.dp);
            // Work of the return path, from the yield surface on: that of the yield stress is
            // exact, that of the back-stress is the mean of both ends.
            done += self.flow_stress.work(&start, at.dp, at.sy);
            for (i, b) in self.back.iter().enumerate() {
                let (kept, _) = b.kept(at.dp);
                for k in 0..3 {
                    let gain = (at.g * at.eta[k]).scale(b.modulus * 2.0 / 3.0);
                    let new = kept * (old[i][k] + gain);
                    state.set(BACK + 3 * i + k, new);
                    done = ((old[i][k] + new) * step[k]).fma(T::real(0.5 * self.work[k]), done);
                }
            }
            state.set(WORK, done);
            sum = e[0].fma(T::real(self.volume), y[0]);
            let mut size = limit;
            for k in 0..3 {
                size = e[k].abs().fma(T::real(self.elastic[k]), size);
            }
            tangent = self.tangent(&at, size.scale(ROUNDING).lt(excess));
            self.flow_stress.keep(&start, at.dp, at.q, state, self.first());
        } else {
            failed = T::none();
            for k in 0..3 {
                state.set(k, plastic[k]);
            }
            state.set(EQUIVALENT, p);
            let done: T = state.get(WORK);
            state.set(WORK, done);
            for i in 0..self.back.len() {
                for k in 0..3 {
                    state.set(BACK + 3 * i + k, old[i][k]);
                }
            }
            sum = e[0].fma(T::real(self.volume), y[0]);
            tangent = broadcast(&self.moduli);
            let q = self.equivalent(&eta);
            self.flow_stress.keep(&start, T::zero(), q, state, self.first());
        }
        let stress = [(sum + y[1]).scale(0.5), (sum - y[1]).scale(0.5), y[2]];
        Response { stress, tangent, failed }
    }

    fn hardening_energy(&self, state: &[f64]) -> f64 {
        let mut sum = self.flow_stress.stored(state[EQUIVALENT]);
        for (i, b) in self.back.iter().enumerate() {
            for k in 0..3 {
                let v = state[BACK + 3 * i + k];
                sum += 0.75 / b.modulus * self.norm[k] * v * v;
            }
        }
        sum
    }
}

impl<F: Flow> Material for J2<F> {
    const NAME: &'static str = F::NAME;
    const EXAMPLES: &'static [&'static [f64]] = F::EXAMPLES;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[young, nu, count, ref rest @ ..] = parameters else {
            return Err(format!("{} takes E, nu, back-stresses and a hardening", F::NAME));
        };
        if !(young > 0.0 && young.is_finite() && nu > -1.0 && nu < 0.5) {
            return Err(format!("{} needs E > 0, -1 < nu < 0.5, not {young}, {nu}", F::NAME));
        }
        let count = count as usize;
        if count > MAX_BACK || rest.len() < 2 * count {
            return Err(format!("{} takes at most {MAX_BACK} back-stresses", F::NAME));
        }
        let (pairs, numbers) = rest.split_at(2 * count);
        let back: Result<Vec<_>, _> =
            pairs.as_chunks::<2>().0.iter().map(|&[c, gamma]| BackStress::new(c, gamma)).collect();
        let g = young / (2.0 * (1.0 + nu));
        let bulk = young / (3.0 * (1.0 - 2.0 * nu));
        let (c11, c12) = match plane {
            Plane::Stress => (young / (1.0 - nu * nu), nu * young / (1.0 - nu * nu)),
            Plane::Strain => (bulk + 4.0 * g / 3.0, bulk - 2.0 * g / 3.0),
        };
        let sum = young / (1.0 - nu);
        let (elastic, relief, flow, norm, work, volume) = match plane {
            Plane::Stress => (sum, sum, 1.0 / 3.0, 1.0 / 6.0, 0.5, 0.0),
            Plane::Strain => (2.0 * g / 3.0, 2.0 * g, 1.0, 1.5, 1.5, 2.0 * bulk),
        };
        let (flow_stress, back) = (F::new(numbers)?, back?);
        Ok(Self {
            young,
            nu,
            plane,
            moduli: [[c11, c12, 0.0], [c12, c11, 0.0], [0.0, 0.0, g]],
            ideal: flow_stress.saturates() && back.iter().all(|b| b.recall > 0.0),
            flow_stress,
            back,
            elastic: [elastic, 2.0 * g, g],
            relief: [relief, 2.0 * g, g],
            flow: [flow, 1.0, 2.0],
            norm: [norm, 0.5, 2.0],
            work: [work, 0.5, 1.0],
            volume,
        })
    }
    /// Stress and strain are as large in their sum as in their difference, each of which takes half
    /// of the norm and of the work.
    fn line(parameters: &[f64]) -> Result<Self, String> {
        let law = Self::new(parameters, Plane::Stress)?;
        let (e, g) = (law.young, law.moduli[2][2]);
        Ok(Self {
            moduli: [[e, 0.0, 0.0], [0.0, e, 0.0], [0.0, 0.0, g]],
            elastic: [e, e, 0.0],
            relief: [e, e, 0.0],
            flow: [2.0 / 3.0, 2.0 / 3.0, 0.0],
            norm: [1.0 / 3.0, 1.0 / 3.0, 0.0],
            work: [0.5, 0.5, 0.0],
            ..law
        })
    }
    fn n_state(&self) -> usize {
        self.first() + F::MEMBERS
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T> {
        self.answer(&strain, state)
    }
    fn bulk(&self) -> Option<f64> {
        Some(self.young / (3.0 * (1.0 - 2.0 * self.nu)))
    }
    fn out_of_plane(&self, _: [f64; 3], s: [f64; 3], state: &[f64]) -> (f64, f64) {
        match self.plane {
            Plane::Stress => (-self.nu / self.young * (s[0] + s[1]) - state[0], 0.0),
            Plane::Strain => (0.0, self.normal(s, state)),
        }
    }
    fn energy(&self, e: [f64; 3], s: [f64; 3], state: &[f64]) -> f64 {
        let p = Self::tensor_at(state, 0);
        let inside = s[0] * (e[0] - p[0]) + s[1] * (e[1] - p[1]) + s[2] * (e[2] - p[3]);
        0.5 * (inside - self.normal(s, state) * p[2])
    }
    fn spherical(&self) -> bool {
        self.plane == Plane::Strain
    }
    fn initial_energy(&self, s: [f64; 3], normal: f64, initial: f64) -> f64 {
        let thrice = 3.0 * (1.0 - 2.0 * self.nu) / self.young;
        initial * thrice * ((s[0] + s[1] + normal) / 3.0 + 0.5 * initial)
    }
    fn outputs(&self) -> &'static [&'static str] {
        F::OUTPUTS
    }
    fn output(&self, i: usize, s: [f64; 3], state: &[f64]) -> f64 {
        match i {
            0 => state[EQUIVALENT],
            1 => {
                let mean = match self.plane {
                    Plane::Stress => 0.0,
                    Plane::Strain => (s[0] + s[1] + self.normal(s, state)) / 3.0,
                };
                let mut eta = [s[0] + s[1] - 2.0 * mean, s[0] - s[1], s[2]];
                for n in 0..self.back.len() {
                    for k in 0..3 {
                        eta[k] -= state[BACK + 3 * n + k];
                    }
                }
                let limit = self.flow_stress.yield_stress(state[EQUIVALENT]);
                if limit > 0.0 { self.equivalent(&eta) / limit } else { 0.0 }
            }
            2 => state[WORK] - self.flow_stress.creep_work(&state[self.first()..]),
            3 => state[WORK] - self.hardening_energy(state),
            _ => self.flow_stress.output(i, &state[self.first()..]),
        }
    }
    fn tensors(&self) -> &'static [TensorOutput] {
        const PLASTIC: TensorOutput = TensorOutput { name: "PE", engineering: true };
        const BACK: TensorOutput = TensorOutput { name: "ALPHA", engineering: false };
        if self.back.is_empty() { &[PLASTIC] } else { &[PLASTIC, BACK] }
    }
    fn tensor(&self, i: usize, state: &[f64]) -> [f64; 4] {
        if i == 0 {
            return Self::tensor_at(state, 0);
        }
        let mut sum = [0.0; 4];
        for n in 0..self.back.len() {
            let b = self.back_at(state, n);
            for c in 0..4 {
                sum[c] += b[c];
            }
        }
        sum
    }
    fn plastic_member(&self) -> Option<usize> {
        Some(EQUIVALENT)
    }
    fn creep_error_member(&self) -> Option<usize> {
        self.flow_stress.creep_error().map(|m| self.first() + m)
    }
    #[inline(always)]
    fn ideal(&self) -> bool {
        self.ideal
    }
    fn work_member(&self) -> Option<usize> {
        Some(WORK)
    }
}
