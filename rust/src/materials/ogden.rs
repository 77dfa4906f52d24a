//! Rubber by powers of the principal stretches (Ogden 1972):
//! `W = sum 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) + sum (J - 1)^(2 i) / D_i`
//! with isochoric stretches.
//!
//! Parameters: mu_i, alpha_i, D_i for each of one to six terms. All `D` zero: constant volume.
// SPDX-License-Identifier: BSD-3-Clause

use super::hyperelastic::{Energy, Hyperelastic, Stretches};
use crate::base::Real;
use crate::base::jet::Jet;

pub type Ogden = Hyperelastic<OgdenEnergy>;

#[derive(Clone, Debug)]
pub struct OgdenEnergy {
    /// `2 mu / alpha^2` and `alpha`.
    terms: Vec<[f64; 2]>,
    d: Vec<f64>,
}

/// Factor and power of each term from triples of parameters, of which the third are returned.
pub(super) fn terms(name: &str, parameters: &[f64]) -> Result<(Vec<[f64; 2]>, Vec<f64>), String> {
    let (triples, rest) = parameters.as_chunks::<3>();
    if !(rest.is_empty() && (1..=6).contains(&triples.len())) {
        let count = parameters.len();
        return Err(format!(
            "{name} takes three numbers for each of one to six terms, not {count}"
        ));
    }
    if triples.iter().any(|t| t[1] == 0.0) {
        return Err(format!("{name}: the powers alpha must not be zero"));
    }
    let terms = triples.iter().map(|t| [2.0 * t[0] / (t[1] * t[1]), t[1]]).collect();
    Ok((terms, triples.iter().map(|t| t[2]).collect()))
}

impl Energy for OgdenEnergy {
    const NAME: &'static str = "ogden";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[400.0, 1.3, 0.002],
        &[1.2, 1.7, 0.01, 0.01, 6.0, 0.0, 0.05, -2.0, 0.0],
        &[1.0, 11.0, 0.1],
    ];

    fn new(parameters: &[f64]) -> Result<Self, String> {
        let (terms, d) = terms(Self::NAME, parameters)?;
        Ok(Self { terms, d })
    }
    fn is_incompressible(&self) -> bool {
        self.d.iter().all(|&d| d == 0.0)
    }
    #[inline(always)]
    fn volume<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        s.volume(&self.d)
    }
    #[inline(always)]
    fn shape<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        let mut w = Jet::zero();
        for &[factor, alpha] in &self.terms {
            w += s.powers(alpha).scale(factor);
        }
        w
    }
}
