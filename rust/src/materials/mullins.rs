//! Softening of rubber by its largest stretch so far (Mullins), after Ogden and Roxburgh (1999) as
//! in Abaqus. With the energy `u` of the shape of a parent law, and its largest value `top` so far,
//! `eta = 1 - erf(x) / r` with `x = (top - u) / (m + beta top)` reduces the stress of the shape:
//! the energy is `W = eta u + phi(eta) + volume` with `d phi / d eta = -u`. On the primary curve
//! `u = top` and the law is its parent. Of foams the whole energy is that of the shape.
//!
//! Parameters: number of the parent in [`PARENTS`], r, m, beta, then the parameters of the parent.
// SPDX-License-Identifier: BSD-3-Clause

use super::hyperelastic::{Energy, Hyperelastic, OfEnergy, Stretches};
use super::material::Material;
use crate::base::Real;
use crate::base::jet::Jet;
use std::f64::consts::FRAC_2_SQRT_PI;

pub type Mullins = Hyperelastic<SofteningEnergy>;

macro_rules! parents {
    ($($file:ident::$name:ident),+ $(,)?) => {
        /// Laws that can soften, by their numbers.
        const PARENTS: &[&str] = &[$(super::$file::$name::NAME),+];

        /// Energy of a law that softens.
        #[derive(Clone, Debug)]
        enum Parent { $($name(<super::$file::$name as OfEnergy>::Energy)),+ }

        impl Parent {
            fn new(kind: f64, numbers: &[f64]) -> Result<Self, String> {
                let law = PARENTS.get(kind as usize);
                $(if law == Some(&super::$file::$name::NAME) {
                    return Energy::new(numbers).map(Self::$name);
                })+
                Err(format!("parents are {PARENTS:?} by their numbers, not {kind}"))
            }
        }

        /// Call a method of the energy of a parent.
        macro_rules! of {
            ($parent:expr, $energy:ident => $call:expr) => {
                match $parent { $(Parent::$name($energy) => $call),+ }
            };
        }
    };
}
super::hyperelastic_laws!(parents, [], []);

#[derive(Clone, Debug)]
pub struct SofteningEnergy {
    parent: Parent,
    r: f64,
    m: f64,
    beta: f64,
}

/// The error function of a number >= 0, to round-off, by that of `exp(-x^2)` as well.
#[inline(always)]
fn erf<T: Real>(x: T, bell: T) -> T {
    // Below `far` the series of the integral (its terms are positive), above a continued fraction.
    const FAR: f64 = 3.0;
    const TERMS: usize = 48;
    const FRACTIONS: usize = 20;
    let near = x.min(T::real(FAR));
    let square = near * near;
    let mut sum = T::one();
    for n in (1..TERMS).rev() {
        sum = (sum * square).scale(2.0 / (2 * n + 1) as f64) + T::one();
    }
    let mut y = (near * sum * bell).scale(FRAC_2_SQRT_PI);
    let far = T::real(FAR).lt(x);
    if T::any(far) {
        let x = x.max(T::real(FAR));
        let mut below = x;
        for n in (1..FRACTIONS).rev() {
            below = x + T::real(0.5 * n as f64) / below;
        }
        y = T::select(far, T::one() - bell.scale(0.5 * FRAC_2_SQRT_PI) / below, y);
    }
    y
}

impl SofteningEnergy {
    /// `eta`, its derivative by the energy of the shape, and `phi`.
    #[inline(always)]
    fn soften<T: Real>(&self, u: T, top: T) -> [T; 3] {
        // Where `exp(-x^2)` is zero.
        const LONGEST: f64 = 30.0;
        // Round-off of an energy at rest is no energy.
        let u = u.max(T::zero());
        let below = u.lt(top);
        if !T::any(below) {
            return [T::one(), T::zero(), T::zero()];
        }
        let width = T::select(below, top.scale(self.beta) + T::real(self.m), T::one());
        let x = (T::select(below, top - u, T::zero()) / width).min(T::real(LONGEST));
        let bell = (-(x * x)).exp();
        let (share, k) = (erf(x, bell), 0.5 * FRAC_2_SQRT_PI);
        let eta = T::one() - share.scale(1.0 / self.r);
        let slope = bell.scale(FRAC_2_SQRT_PI / self.r) / width;
        let phi = (top * share - (width * (T::one() - bell)).scale(k)).scale(1.0 / self.r);
        [
            T::select(below, eta, T::one()),
            T::select(below, slope, T::zero()),
            T::select(below, phi, T::zero()),
        ]
    }
}

impl Energy for SofteningEnergy {
    const NAME: &'static str = "mullins";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[0.0, 2.0, 5.0, 0.1, 180.0, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.002, 0.0, 0.0],
        &[0.0, 2.0, 0.01, 0.5, 0.5, 0.1, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0],
        &[1.0, 1.5, 0.01, 0.0, 1.2, 1.7, 0.01, 0.05, -2.0, 0.0],
        &[2.0, 3.0, 0.02, 0.1, 1.0, 2.5, 0.01],
        &[3.0, 2.0, 0.01, 0.1, 0.5, 8.0, 0.0, 0.1, -2.0, 0.3],
    ];
    const REMEMBERS: bool = true;

    fn new(parameters: &[f64]) -> Result<Self, String> {
        let &[kind, r, m, beta, ref rest @ ..] = parameters else {
            return Err(
                "mullins takes a parent, r, m, beta and the parameters of the parent".into()
            );
        };
        if !(r > 1.0 && m >= 0.0 && beta >= 0.0 && m + beta > 0.0) {
            return Err("the softening needs r > 1, m >= 0 and beta >= 0, one of them > 0".into());
        }
        let parent = Parent::new(kind, rest)?;
        Ok(Self { parent, r, m, beta })
    }
    fn is_incompressible(&self) -> bool {
        of!(&self.parent, energy => energy.is_incompressible())
    }
    #[inline(always)]
    fn shape<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        of!(&self.parent, energy => energy.shape(s))
    }
    #[inline(always)]
    fn volume<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        of!(&self.parent, energy => energy.volume(s))
    }
    #[inline(always)]
    fn density<T: Real>(&self, s: &Stretches<T>, largest: T) -> Jet<T> {
        let shape = self.shape(s);
        let [eta, slope, phi] = self.soften(shape.v, largest);
        shape.chain(eta * shape.v + phi, eta, slope) + self.volume(s)
    }
    fn lost(&self, largest: f64) -> f64 {
        self.soften(0.0, largest)[2]
    }
}
