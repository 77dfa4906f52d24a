//! J2 plasticity with a rate, with creep, and with softening by heat: the return map of
//! [`super::mises`] with a flow stress that depends on the step and its time. Implicit, one scalar
//! equation.
//!
//! Parameters: those of [`J2`], then three lists, each after its length: hardening (empty; as
//! [`Isotropic::new`]; or 3, initial, factor, exponent of a power of Ludwik 1909), rate
//! ([`Rate::new`]) and heat ([`Heat::new`]).
//!
//! Creep is by the overstress above the hardening (none: by the stress), and only where slow
//! processes take part; without them the hardening is that of a body without a rate, and a law
//! without hardening is elastic. Laws in powers of the time are exact over an increment of constant
//! stress, of any length.
// SPDX-License-Identifier: BSD-3-Clause

use super::hardening::Isotropic;
use super::material::PointState;
use super::mises::{Flow, J2, LEAST_STEP};
use crate::base::{Real, shared};

pub type Viscoplastic = J2<RateFlow>;

/// Members of the state: equivalent relative stress, equivalent creep strain, its work, its error in
/// the increment, rise of the temperature.
const STRESS: usize = 0;
const CREEP: usize = 1;
const WORK: usize = 2;
const ERROR: usize = 3;
const RISE: usize = 4;
/// Strength that is left from melting on, so that a tangent exists.
const MOLTEN: f64 = 1e-3;
/// Iterations for the stress of a step that heats.
const MAX_ITERATIONS: usize = 40;
/// Relative change of that stress after which one more is exact to round-off.
const TOLERANCE: f64 = 1e-9;
/// Share of a power below which its growth is summed as a series.
const SMALL: f64 = 1e-2;

/// Yield stress without rate.
#[derive(Clone, Debug)]
enum Hardening {
    /// Every stress flows.
    None,
    Isotropic(Isotropic),
    /// `initial + factor p^exponent`.
    Power {
        initial: f64,
        factor: f64,
        exponent: f64,
    },
}

impl Hardening {
    fn new(numbers: &[f64]) -> Result<Self, String> {
        match *numbers {
            [] => Ok(Self::None),
            [3.0, initial, factor, exponent] => {
                let fit = initial > 0.0 && factor >= 0.0 && exponent > 0.0;
                if fit && numbers.iter().all(|v| v.is_finite()) {
                    return Ok(Self::Power { initial, factor, exponent });
                }
                Err("a power of the plastic strain needs A > 0, B >= 0 and n > 0".into())
            }
            _ => Isotropic::new(numbers).map(Self::Isotropic),
        }
    }

    /// Yield stress and its slope.
    #[inline(always)]
    fn at<T: Real>(&self, p: T) -> (T, T) {
        match self {
            Self::None => (T::zero(), T::zero()),
            Self::Isotropic(law) => law.at(p),
            Self::Power { initial, factor, exponent } => {
                let p = p.max(T::real(1e-300));
                let grown = power(p, *exponent).scale(*factor);
                (grown + T::real(*initial), grown.scale(*exponent) / p)
            }
        }
    }

    /// Integral of the yield stress over a step.
    #[inline(always)]
    fn work<T: Real>(&self, p: T, dp: T) -> T {
        match self {
            Self::None => T::zero(),
            Self::Isotropic(law) => law.work(p, dp),
            Self::Power { initial, exponent, .. } => {
                let part =
                    |p: T| (self.at(p).0 - T::real(*initial)) * p.scale(1.0 / (exponent + 1.0));
                dp.scale(*initial) + part(p + dp) - part(p)
            }
        }
    }

    fn stored(&self, p: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Isotropic(law) => law.stored(p),
            Self::Power { factor, exponent, .. } => {
                factor * p.powf(exponent + 1.0) / (exponent + 1.0)
            }
        }
    }
}

/// Power of a positive number.
#[inline(always)]
fn power<T: Real>(x: T, exponent: f64) -> T {
    x.ln().scale(exponent).exp()
}

/// What a rate adds to the yield stress.
#[derive(Clone, Debug)]
enum Rate {
    None,
    /// Times `1 + (p' / rate)^(1 / exponent)` (Cowper and Symonds 1957; Perzyna 1966).
    Power {
        rate: f64,
        exponent: f64,
    },
    /// Times `1 + factor ln max(p' / rate, 1)` (Johnson and Cook 1983).
    Logarithm {
        factor: f64,
        rate: f64,
    },
    /// Times a ratio, straight between rates.
    Ratio {
        rate: Vec<f64>,
        ratio: Vec<f64>,
    },
    /// Curves, straight between rates.
    Curves {
        rate: Vec<f64>,
        curve: Vec<Isotropic>,
    },
    /// The overstress whose creep rate is `factor q^exponent t^time` (Norton 1929), or the same by
    /// the creep strain instead of the time.
    Creep {
        factor: f64,
        exponent: f64,
        time: f64,
        strain: bool,
    },
}

impl Rate {
    /// From the kind and its numbers: none; 1, rate, exponent; 2, factor, rate; 3, pairs of ratio and
    /// rate; 4, number of rates, the rates, numbers of [`Isotropic::new`] of each, as many;
    /// 5, factor, exponent, time, whether by strain.
    fn new(numbers: &[f64]) -> Result<Self, String> {
        let rising = |v: &[f64]| v.windows(2).all(|w| w[0] < w[1]);
        if !numbers.iter().all(|v| v.is_finite()) {
            return Err("the numbers of a rate must be finite".into());
        }
        let (law, fit) = match *numbers {
            [] => (Self::None, true),
            [1.0, rate, exponent] => (Self::Power { rate, exponent }, rate > 0.0 && exponent > 0.0),
            [2.0, factor, rate] => (Self::Logarithm { factor, rate }, factor >= 0.0 && rate > 0.0),
            [3.0, ref pairs @ ..] if pairs.len() >= 2 && pairs.len() % 2 == 0 => {
                let ratio: Vec<_> = pairs.iter().step_by(2).copied().collect();
                let rate: Vec<_> = pairs.iter().skip(1).step_by(2).copied().collect();
                let fit = rising(&rate)
                    && rate[0] == 0.0
                    && ratio[0] > 0.0
                    && ratio.windows(2).all(|w| w[0] <= w[1]);
                (Self::Ratio { rate, ratio }, fit)
            }
            [4.0, count, ref rest @ ..]
                if count >= 2.0
                    && rest.len() > count as usize
                    && (rest.len() - count as usize).is_multiple_of(count as usize) =>
            {
                let count = count as usize;
                let (rate, numbers) = rest.split_at(count);
                let each = numbers.chunks(numbers.len() / count).map(Isotropic::new);
                let curve = each.collect::<Result<Vec<_>, _>>()?;
                let fit = rising(rate) && rate[0] == 0.0;
                (Self::Curves { rate: rate.to_vec(), curve }, fit)
            }
            [5.0, factor, exponent, time, strain] => (
                Self::Creep { factor, exponent, time, strain: strain != 0.0 },
                factor > 0.0 && exponent > 0.0 && time > -1.0,
            ),
            _ => return Err(format!("no rate from {} numbers", numbers.len())),
        };
        if fit {
            return Ok(law);
        }
        Err("a rate needs numbers > 0, rates that rise from 0, stresses that do not fall with the \
             rate, and creep a power of the time > -1"
            .into())
    }

    /// Place among rising rates: value and slope by rate of what `value` gives at each of them.
    #[inline(always)]
    fn between<T: Real>(rate: &[f64], at: T, value: impl Fn(usize) -> T) -> (T, T) {
        let (mut sum, mut slope) = (value(0), T::zero());
        let mut low = sum;
        for k in 1..rate.len() {
            let high = value(k);
            let rise = (high - low).scale(1.0 / (rate[k] - rate[k - 1]));
            let past = at - T::real(rate[k - 1]);
            let inside = past.max(T::zero()).min(T::real(rate[k] - rate[k - 1]));
            sum = inside.fma(rise, sum);
            slope = T::select(past.lt(T::zero()), slope, rise);
            low = high;
        }
        let last = T::real(rate[rate.len() - 1]);
        (sum, T::select(at.lt(last), slope, T::zero()))
    }
}

/// Softening by temperature, `1 - ((T - transition) / (melting - transition))^exponent`, and heating
/// by plastic work.
#[derive(Clone, Debug)]
struct Heat {
    /// Rise of the temperature by plastic work.
    share: f64,
    transition: f64,
    range: f64,
    exponent: f64,
    temperature: f64,
}

impl Heat {
    /// From the rise of the temperature by plastic work, transition, melting, exponent and the
    /// temperature.
    fn new(numbers: &[f64]) -> Result<Option<Self>, String> {
        let &[share, transition, melting, exponent, temperature] = numbers else {
            if numbers.is_empty() {
                return Ok(None);
            }
            return Err(format!("heat takes 5 numbers, not {}", numbers.len()));
        };
        let fit = share >= 0.0 && melting > transition && exponent > 0.0;
        if !(fit && numbers.iter().all(|v| v.is_finite())) {
            return Err("heat needs a melting above the transition and an exponent > 0".into());
        }
        let range = melting - transition;
        Ok(Some(Self { share, transition, range, exponent, temperature }))
    }

    /// Strength that is left at a rise of the temperature, and its slope.
    #[inline(always)]
    fn left<T: Real>(&self, rise: T) -> (T, T) {
        let x = (rise + T::real(self.temperature - self.transition)).scale(1.0 / self.range);
        let least = T::real(1e-12);
        let cold = x.lt(least);
        let x = x.max(least);
        let grown = power(x, self.exponent);
        let left = T::one() - grown;
        let molten = left.lt(T::real(MOLTEN));
        let slope = (grown / x).scale(-self.exponent / self.range);
        let left = T::select(cold, T::one(), T::select(molten, T::real(MOLTEN), left));
        (left, T::select(T::or(cold, molten), T::zero(), slope))
    }
}

/// Flow stress with a rate.
#[derive(Clone, Debug)]
pub struct RateFlow {
    hardening: Hardening,
    rate: Rate,
    heat: Option<Heat>,
}

/// What an increment starts from.
#[derive(Clone, Copy)]
pub struct Start<T: Real> {
    p: T,
    /// Time of the increment, for creep of the factor on its stress.
    time: f64,
    /// Whether anything flows, and whether it creeps.
    flows: bool,
    creeps: bool,
    /// Equivalent creep strain and rise of the temperature.
    creep: T,
    rise: T,
    /// Yield stress, and flow stress where the step begins.
    yielded: T,
    begin: T,
}

impl RateFlow {
    /// `(p + dp)^k - p^k` and its derivative.
    #[inline(always)]
    fn growth<T: Real>(p: T, dp: T, k: f64) -> (T, T) {
        let whole = p + dp;
        let now = power(whole, k);
        let before = power(p.max(T::real(1e-300)), k);
        let x = dp / whole;
        // 1 - (1 - x)^k by its series: the difference of the powers cancels.
        let mut sum = T::one();
        for i in (1..10).rev() {
            let factor = (f64::from(i) - k) / f64::from(i + 1);
            sum = (x.scale(factor)).fma(sum, T::one());
        }
        let series = now * x.scale(k) * sum;
        let direct = now - T::select(T::zero().lt(p), before, T::zero());
        (T::select(x.lt(T::real(SMALL)), series, direct), now.scale(k) / whole)
    }

    /// Overstress of a creep step, and its derivative.
    #[inline(always)]
    fn overstress<T: Real>(&self, start: &Start<T>, dp: T) -> (T, T) {
        let Rate::Creep { factor, exponent, time, strain } = self.rate else {
            return (T::zero(), T::zero());
        };
        if !strain || time == 0.0 {
            let over = power(dp.scale(1.0 / (factor * start.time)), 1.0 / exponent);
            return (over, over.scale(1.0 / exponent) / dp);
        }
        let k = 1.0 / (time + 1.0);
        let (grown, slope) = Self::growth(start.creep, dp, k);
        let over = power(grown.scale(1.0 / start.time), 1.0 / (k * exponent));
        let over = over.scale((factor * k).powf(-1.0 / exponent));
        (over, over.scale(1.0 / (k * exponent)) * slope / grown)
    }

    /// Creep strain that a constant overstress makes.
    #[inline(always)]
    fn crept<T: Real>(&self, start: &Start<T>, over: T) -> T {
        let Rate::Creep { factor, exponent, time, strain } = self.rate else { return T::zero() };
        let rate = power(over.max(T::real(1e-100)), exponent).scale(factor);
        if !strain || time == 0.0 {
            return rate.scale(start.time);
        }
        let k = 1.0 / (time + 1.0);
        let before = start.creep.max(T::real(1e-300));
        let grown = power(rate.scale(k), k).scale(start.time) + power(before, k);
        power(grown, 1.0 / k) - start.creep
    }

    /// Flow stress without softening, and its derivative.
    #[inline(always)]
    fn cold<T: Real>(&self, start: &Start<T>, dp: T) -> (T, T) {
        shared::<T, _>(
            #[inline(always)]
            || {
                let (y, h) = self.hardening.at(start.p + dp);
                match &self.rate {
                    Rate::Power { rate, exponent } => {
                        let x = power(dp.scale(1.0 / (rate * start.time)), 1.0 / exponent);
                        let slope = y * x.scale(1.0 / exponent) / dp;
                        (x.fma(y, y), x.fma(h, h) + slope)
                    }
                    Rate::Logarithm { factor, rate } => {
                        let ratio = dp.scale(1.0 / (rate * start.time));
                        let slow = ratio.lt(T::one());
                        let l = ratio.max(T::one()).ln().scale(*factor);
                        let slope = T::select(slow, T::zero(), y.scale(*factor) / dp);
                        (l.fma(y, y), l.fma(h, h) + slope)
                    }
                    Rate::Ratio { rate, ratio } => {
                        let at = dp.scale(1.0 / start.time);
                        let (r, slope) = Rate::between(rate, at, |k| T::real(ratio[k]));
                        (y * r, (y * slope).fma(T::real(1.0 / start.time), h * r))
                    }
                    Rate::Curves { rate, curve } => {
                        let (at, p) = (dp.scale(1.0 / start.time), start.p + dp);
                        let (y, slope) = Rate::between(rate, at, |k| curve[k].at(p).0);
                        let (h, _) = Rate::between(rate, at, |k| curve[k].at(p).1);
                        (y, slope.fma(T::real(1.0 / start.time), h))
                    }
                    Rate::Creep { .. } if start.creeps => {
                        let (over, slope) = self.overstress(start, dp);
                        (y + over, h + slope)
                    }
                    Rate::None | Rate::Creep { .. } => (y, h),
                }
            },
        )
    }
}

impl Flow for RateFlow {
    const NAME: &'static str = "viscoplastic";
    const EXAMPLES: &'static [&'static [f64]] = &[
        // Recall, hardening of Voce and a power of the rate.
        &[1000.0, 0.3, 1.0, 50.0, 2.0, 5.0, 2.0, 80.0, 20.0, 5.0, 100.0, 3.0, 1.0, 40.0, 5.0, 0.0],
        // A power of the rate; a ratio by rate; curves by rate.
        &[7.0, 0.3, 1.0, 0.8, 0.0, 3.0, 0.0, 0.05, 0.4, 3.0, 1.0, 2.0, 3.0, 0.0],
        &[7.0, 0.3, 0.0, 3.0, 0.0, 0.05, 0.4, 7.0, 3.0, 1.0, 0.0, 1.2, 0.01, 1.5, 1.0, 0.0],
        &[
            7.0, 0.3, 0.0, 5.0, 1.0, 0.05, 0.0, 0.07, 0.1, 14.0, 4.0, 2.0, 0.0, 0.1, 1.0, 0.05,
            0.0, 0.07, 0.1, 1.0, 0.06, 0.0, 0.09, 0.1, 0.0,
        ],
        // Johnson and Cook, cold, and with heat that its work makes.
        &[7.0, 0.3, 0.0, 4.0, 3.0, 0.05, 0.03, 0.4, 3.0, 2.0, 0.05, 1e-3, 0.0],
        &[
            7.0, 0.3, 0.0, 4.0, 3.0, 0.05, 0.03, 0.4, 3.0, 2.0, 0.05, 1e-3, 5.0, 9e4, 20.0, 1500.0,
            1.03, 20.0,
        ],
        // Creep by time and by strain, alone and above a yield stress.
        &[7.0, 0.3, 0.0, 0.0, 5.0, 5.0, 300.0, 5.0, 0.0, 0.0, 0.0],
        &[7.0, 0.3, 0.0, 0.0, 5.0, 5.0, 300.0, 4.0, -0.4, 1.0, 0.0],
        &[7.0, 0.3, 1.0, 0.8, 0.0, 3.0, 0.0, 0.03, 0.4, 5.0, 5.0, 30.0, 3.0, 0.3, 0.0, 0.0],
    ];
    const MEMBERS: usize = 5;
    const STEEP: bool = true;
    const OUTPUTS: &'static [&'static str] =
        &["PEEQ", "YRATIO", "PWORK", "PDISS", "CEEQ", "CWORK", "TRISE"];
    type Start<T: Real> = Start<T>;

    fn new(numbers: &[f64]) -> Result<Self, String> {
        let mut rest = numbers;
        let mut list = || -> Result<&[f64], String> {
            let (&count, after) = rest.split_first().ok_or("the length of a list is missing")?;
            let (own, after) =
                after.split_at_checked(count as usize).ok_or("a list is too short")?;
            rest = after;
            Ok(own)
        };
        let law = Self {
            hardening: Hardening::new(list()?)?,
            rate: Rate::new(list()?)?,
            heat: Heat::new(list()?)?,
        };
        if !rest.is_empty() {
            return Err(format!("{} numbers are left over", rest.len()));
        }
        if matches!(law.hardening, Hardening::None) && !matches!(law.rate, Rate::Creep { .. }) {
            return Err("a law without creep needs a yield stress".into());
        }
        Ok(law)
    }

    #[inline(always)]
    fn start<T: Real>(&self, state: &PointState<'_>, p: T, first: usize) -> Start<T> {
        let clock = state.clock;
        let creeps = matches!(self.rate, Rate::Creep { .. }) && clock.lasting;
        let mut time = clock.increment;
        if let Rate::Creep { time: m, strain: false, .. } = self.rate
            && m != 0.0
        {
            let before = clock.end - clock.increment;
            time = (clock.end.powf(m + 1.0) - before.max(0.0).powf(m + 1.0)) / (m + 1.0);
        }
        let bare = matches!(self.hardening, Hardening::None) && !creeps;
        let zero = T::zero();
        let mut start = Start {
            p,
            time,
            flows: time > 0.0 && !bare,
            creeps,
            creep: state.get(first + CREEP),
            rise: state.get(first + RISE),
            yielded: self.hardening.at(p).0,
            begin: zero,
        };
        if start.flows {
            start.begin = self.limit(&start).max(state.get(first + STRESS));
        }
        start
    }
    #[inline(always)]
    fn limit<T: Real>(&self, start: &Start<T>) -> T {
        if !start.flows {
            return T::real(f64::INFINITY);
        }
        let cold = self.cold(start, T::real(LEAST_STEP)).0;
        match &self.heat {
            Some(heat) => cold * heat.left(start.rise).0,
            None => cold,
        }
    }
    #[inline(always)]
    fn after<T: Real>(&self, start: &Start<T>, dp: T) -> (T, T) {
        shared::<T, _>(
            #[inline(always)]
            || {
                let dp = dp.max(T::real(LEAST_STEP));
                let (cold, slope) = self.cold(start, dp);
                let Some(heat) = &self.heat else { return (cold, slope) };
                if heat.share == 0.0 {
                    let left = heat.left(start.rise).0;
                    return (cold * left, slope * left);
                }
                // The work of the step is the mean of the stresses at both ends times the step.
                let half = dp.scale(0.5 * heat.share);
                let mut s = cold * heat.left(start.rise).0;
                let (mut low, mut high) = (T::zero(), s);
                for _ in 0..MAX_ITERATIONS {
                    let (left, by_rise) = heat.left(half.fma(start.begin + s, start.rise));
                    let excess = s - cold * left;
                    let above = T::zero().lt(excess);
                    high = T::select(above, s, high);
                    low = T::select(above, low, s);
                    let next = s - excess / (T::one() - cold * by_rise * half);
                    let settled = (next - s).abs().lt(s.scale(TOLERANCE));
                    let inside = T::or(settled, T::and(low.lt(next), next.lt(high)));
                    s = T::select(inside, next, (low + high).scale(0.5));
                    let open = T::select(settled, T::zero(), T::one());
                    if !T::any(T::real(0.5).lt(open)) {
                        break;
                    }
                }
                let (left, by_rise) = heat.left(half.fma(start.begin + s, start.rise));
                let heating = (start.begin + s).scale(0.5 * heat.share);
                let slope = slope * left + cold * by_rise * heating;
                (s, slope / (T::one() - cold * by_rise * half))
            },
        )
    }
    #[inline(always)]
    fn work<T: Real>(&self, start: &Start<T>, dp: T, end: T) -> T {
        if self.heat.is_some() {
            return (start.begin + end) * dp.scale(0.5);
        }
        let yields = self.hardening.at(start.p + dp).0;
        let over = (start.begin - start.yielded) + (end - yields);
        dp.scale(0.5).fma(over, self.hardening.work(start.p, dp))
    }
    #[inline(always)]
    fn keep<T: Real>(
        &self,
        start: &Start<T>,
        dp: T,
        q: T,
        state: &mut PointState<'_>,
        first: usize,
    ) {
        let work: T = state.get(first + WORK);
        let stress: T = state.get(first + STRESS);
        state.set(
            first + STRESS,
            if start.flows || state.clock.increment > 0.0 { q } else { stress },
        );
        let (mut crept, mut rise, mut error) = (T::zero(), start.rise, T::zero());
        let mut done = T::zero();
        if start.flows {
            if start.creeps {
                crept = dp;
                done = Flow::work(self, start, dp, q);
                error = (dp - self.crept(start, stress - start.yielded)).abs();
            } else if let Some(heat) = &self.heat {
                rise += ((start.begin + q) * dp).scale(0.5 * heat.share);
            }
        }
        state.set(first + CREEP, start.creep + crept);
        state.set(first + WORK, work + done);
        state.set(first + ERROR, error);
        state.set(first + RISE, rise);
    }
    fn yield_stress(&self, p: f64) -> f64 {
        self.hardening.at(p).0
    }
    fn stored(&self, p: f64) -> f64 {
        self.hardening.stored(p)
    }
    fn creep_work(&self, members: &[f64]) -> f64 {
        members[WORK]
    }
    fn output(&self, i: usize, members: &[f64]) -> f64 {
        members[[CREEP, WORK, RISE][i - 4]]
    }
    fn creep_error(&self) -> Option<usize> {
        matches!(self.rate, Rate::Creep { .. }).then_some(ERROR)
    }
}
