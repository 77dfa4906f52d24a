//! Rubber as a network of eight chains (Arruda & Boyce 1993), five terms of the inverse Langevin
//! function: `W = mu sum C_i / limit^(2 i - 2) (I1^i - 3^i) + ((J^2 - 1) / 2 - ln J) / D`.
//!
//! Parameters: mu, limit (the stretch at which the chains lock), D. `D = 0`: constant volume.
// SPDX-License-Identifier: BSD-3-Clause

use super::hyperelastic::{Energy, Hyperelastic, Stretches};
use crate::base::Real;
use crate::base::jet::Jet;

pub type ArrudaBoyce = Hyperelastic<ChainEnergy>;

const FACTORS: [f64; 5] = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

#[derive(Clone, Debug)]
pub struct ChainEnergy {
    c: [f64; 5],
    d: f64,
}

impl Energy for ChainEnergy {
    const NAME: &'static str = "arruda_boyce";
    const EXAMPLES: &'static [&'static [f64]] =
        &[&[400.0, 3.0, 0.002], &[1.0, 2.5, 0.01], &[1.0, 7.0, 0.1]];

    fn new(parameters: &[f64]) -> Result<Self, String> {
        let &[mu, limit, d] = parameters else {
            return Err(format!(
                "arruda_boyce takes mu, limit and D, not {} numbers",
                parameters.len()
            ));
        };
        if !(limit > 0.0 && d >= 0.0) {
            return Err("arruda_boyce needs a limit stretch > 0 and D >= 0".into());
        }
        let mut c = FACTORS;
        for (i, c) in c.iter_mut().enumerate() {
            *c *= mu * limit.powi(-2 * i as i32);
        }
        Ok(Self { c, d })
    }
    fn is_incompressible(&self) -> bool {
        self.d == 0.0
    }
    #[inline(always)]
    fn volume<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        if self.d == 0.0 {
            return Jet::zero();
        }
        let square = s.theta.exp_m1(2.0).scale(0.5);
        (square - s.theta).scale(1.0 / self.d)
    }
    #[inline(always)]
    fn shape<T: Real>(&self, s: &Stretches<T>) -> Jet<T> {
        let mut w = Jet::zero();
        let more = s.first();
        let first = more.plus(3.0);
        // Powers of the invariant, less those of 3.
        let mut power = more;
        for (i, &c) in self.c.iter().enumerate() {
            if i > 0 {
                power = power * first + more.scale(3.0_f64.powi(i as i32));
            }
            w += power.scale(c);
        }
        w
    }
}
