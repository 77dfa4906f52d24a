//! Compressible foam (Ogden 1972; Storakers 1986):
//! `W = sum 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3
//! + (J^(-alpha_i beta_i) - 1) / beta_i)` with `beta = nu / (1 - 2 nu)`.
//!
//! Parameters: mu_i, alpha_i, nu_i for each of one to six terms.
// SPDX-License-Identifier: BSD-3-Clause

use super::hyperelastic::{Energy, Hyperelastic, Stretches};
use super::ogden;
use crate::base::Real;
use crate::base::jet::Jet;

pub type Hyperfoam = Hyperelastic<FoamEnergy>;

#[derive(Clone, Debug)]
pub struct FoamEnergy {
    /// `2 mu / alpha^2` and `alpha`.
    terms: Vec<[f64; 2]>,
    beta: Vec<f64>,
}

impl Energy for FoamEnergy {
    const NAME: &'static str = "hyperfoam";
    const EXAMPLES: &'static [&'static [f64]] =
        &[&[400.0, 3.0, 0.1], &[0.5, 8.0, 0.0, 0.1, -2.0, 0.3], &[1.0, 2.0, 0.3, 0.2, 5.0, 0.2]];

    fn new(parameters: &[f64]) -> Result<Self, String> {
        let (terms, ratios) = ogden::terms(Self::NAME, parameters)?;
        if ratios.iter().any(|nu| !(-1.0 < *nu && *nu < 0.5)) {
            return Err("hyperfoam needs -1 < nu < 0.5".into());
        }
        Ok(Self { terms, beta: ratios.iter().map(|nu| nu / (1.0 - 2.0 * nu)).collect() })
    }
    #[inline(always)]
    fn shape<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        let mut w = Jet::zero();
        for (&[factor, alpha], &beta) in self.terms.iter().zip(&self.beta) {
            let (grown, shape) = (s.theta.exp_m1(alpha / 3.0), s.powers(alpha));
            let k = -alpha * beta;
            let e = s.theta.v.scale(k).exp();
            let value = match beta {
                0.0 => s.theta.v.scale(-alpha),
                _ => s.theta.v.scale(k).exp_m1().scale(1.0 / beta),
            };
            let volume = s.theta.chain(value, e.scale(-alpha), e.scale(-alpha * k));
            w += (grown * shape + shape + grown.scale(3.0) + volume).scale(factor);
        }
        w
    }
}
