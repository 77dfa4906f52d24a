//! Hardening laws: the yield stress as a function of the accumulated plastic strain, and
//! back-stresses. The return map of [`super::mises`] uses them only through this interface.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::Real;

/// Yield stress as a function of the equivalent plastic strain.
#[derive(Clone, Debug)]
pub enum Isotropic {
    /// `initial + slope p`.
    Linear { initial: f64, slope: f64 },
    /// Straight between the given points, constant after the last.
    Table { stress: Vec<f64>, strain: Vec<f64> },
    /// `initial + slope p + range (1 - exp(-rate p))` (Voce 1948).
    Voce { initial: f64, range: f64, rate: f64, slope: f64 },
}

impl Isotropic {
    /// From the kind (0 linear, 1 table of pairs stress, strain; 2 Voce) and its numbers.
    pub fn new(numbers: &[f64]) -> Result<Self, String> {
        let law = match *numbers {
            [0.0, initial, slope] => Self::Linear { initial, slope },
            [2.0, initial, range, rate, slope] => Self::Voce { initial, range, rate, slope },
            [1.0, ref pairs @ ..] if pairs.len() >= 2 && pairs.len() % 2 == 0 => Self::Table {
                stress: pairs.iter().step_by(2).copied().collect(),
                strain: pairs.iter().skip(1).step_by(2).copied().collect(),
            },
            _ => return Err(format!("no isotropic hardening from {} numbers", numbers.len())),
        };
        let fit = match &law {
            Self::Linear { initial, slope } => *initial > 0.0 && *slope >= 0.0,
            Self::Voce { initial, range, rate, slope } => {
                *initial > 0.0 && *range >= 0.0 && *rate >= 0.0 && *slope >= 0.0
            }
            Self::Table { stress, strain } => {
                let rising = |v: &[f64], equal: bool| {
                    v.windows(2).all(|w| if equal { w[0] <= w[1] } else { w[0] < w[1] })
                };
                stress[0] > 0.0 && strain[0] == 0.0 && rising(stress, true) && rising(strain, false)
            }
        };
        if fit && numbers.iter().all(|v| v.is_finite()) {
            Ok(law)
        } else {
            Err("hardening needs a yield stress > 0 that starts at zero plastic strain and does \
                 not fall"
                .into())
        }
    }

    /// Yield stress and its slope.
    #[inline(always)]
    pub fn at<T: Real>(&self, p: T) -> (T, T) {
        match self {
            Self::Linear { initial, slope } => {
                (p.fma(T::real(*slope), T::real(*initial)), T::real(*slope))
            }
            Self::Voce { initial, range, rate, slope } => {
                let decay = p.scale(-rate).exp();
                let value = T::real(*initial + *range) - decay.scale(*range);
                (p.fma(T::real(*slope), value), decay.fma(T::real(range * rate), T::real(*slope)))
            }
            Self::Table { stress, strain } => {
                let (mut value, mut slope) = (T::real(stress[0]), T::zero());
                for k in 1..stress.len() {
                    let length = strain[k] - strain[k - 1];
                    let rise = (stress[k] - stress[k - 1]) / length;
                    let past = p - T::real(strain[k - 1]);
                    let inside = past.max(T::zero()).min(T::real(length));
                    value = inside.fma(T::real(rise), value);
                    slope = T::select(past.lt(T::zero()), slope, T::real(rise));
                }
                let end = T::real(strain[strain.len() - 1]);
                (value, T::select(p.lt(end), slope, T::zero()))
            }
        }
    }

    /// Whether the yield stress has a limit.
    pub fn saturates(&self) -> bool {
        match self {
            Self::Linear { slope, .. } | Self::Voce { slope, .. } => *slope == 0.0,
            Self::Table { .. } => true,
        }
    }

    /// Integral of the yield stress over a step `dp` from `p`: Simpson's rule, exact for linear
    /// hardening and within a piece of a table.
    #[inline(always)]
    pub fn work<T: Real>(&self, p: T, dp: T) -> T {
        let (begin, middle) = (self.at(p).0, self.at(dp.fma(T::real(0.5), p)).0);
        let end = self.at(p + dp).0;
        (begin + middle.scale(4.0) + end) * dp.scale(1.0 / 6.0)
    }

    /// Energy density that the hardening stores: integral of the yield stress above its
    /// initial value.
    pub fn stored(&self, p: f64) -> f64 {
        match self {
            Self::Linear { slope, .. } => 0.5 * slope * p * p,
            Self::Voce { range, rate, slope, .. } => {
                let saturating =
                    if *rate > 0.0 { range * (p + (-rate * p).exp_m1() / rate) } else { 0.0 };
                saturating + 0.5 * slope * p * p
            }
            Self::Table { stress, strain } => {
                let mut sum = 0.0;
                for k in 1..stress.len() {
                    let (from, to) = (strain[k - 1], strain[k].min(p));
                    if to > from {
                        let rise = (stress[k] - stress[k - 1]) / (strain[k] - from);
                        let mean = stress[k - 1] + 0.5 * rise * (to - from) - stress[0];
                        sum += mean * (to - from);
                    }
                }
                let last = stress.len() - 1;
                sum + (stress[last] - stress[0]) * (p - strain[last]).max(0.0)
            }
        }
    }
}

/// One back-stress `b`: `db = 2/3 modulus dep - recall b dp` (Armstrong & Frederick 1966;
/// several of them: Chaboche 1986; `recall = 0`: linear, Prager 1956).
#[derive(Clone, Copy, Debug)]
pub struct BackStress {
    pub modulus: f64,
    pub recall: f64,
}

impl BackStress {
    pub fn new(modulus: f64, recall: f64) -> Result<Self, String> {
        if modulus > 0.0 && recall >= 0.0 && modulus.is_finite() && recall.is_finite() {
            Ok(Self { modulus, recall })
        } else {
            Err(format!("a back-stress needs C > 0 and gamma >= 0, not {modulus} and {recall}"))
        }
    }

    /// What is left of a unit back-stress after an implicit step `dp`, and its derivative.
    #[inline(always)]
    pub fn kept<T: Real>(&self, dp: T) -> (T, T) {
        let kept = dp.fma(T::real(self.recall), T::one()).recip();
        (kept, (kept * kept).scale(-self.recall))
    }
}
