//! Polynomial in the invariants, to the third degree: neo-Hooke, Mooney and Rivlin (1951), Yeoh
//! (1993). `W = sum C_ij (I1 - 3)^i (I2 - 3)^j + sum (J - 1)^(2 i) / D_i`, isochoric invariants.
//!
//! Parameters: C10, C01, C20, C11, C02, C30, C21, C12, C03, D1, D2, D3. All `D` zero: constant
//! volume.
// SPDX-License-Identifier: BSD-3-Clause

use super::hyperelastic::{Energy, Hyperelastic, Stretches};
use crate::base::Real;
use crate::base::jet::Jet;

pub type Polynomial = Hyperelastic<PolynomialEnergy>;

/// Powers of both invariants, by coefficient.
const POWERS: [[usize; 2]; 9] =
    [[1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3]];

#[derive(Clone, Debug)]
pub struct PolynomialEnergy {
    c: [f64; 9],
    d: [f64; 3],
}

impl Energy for PolynomialEnergy {
    const NAME: &'static str = "polynomial";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[180.0, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.002, 0.0, 0.0],
        &[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0],
        &[0.5, 0.1, 0.02, 0.01, 0.03, 0.005, 0.001, 0.002, 0.003, 0.1, 0.5, 2.0],
    ];

    fn new(parameters: &[f64]) -> Result<Self, String> {
        let (Ok(c), Ok(d)) = (
            parameters.get(..9).unwrap_or_default().try_into(),
            parameters.get(9..).unwrap_or_default().try_into(),
        ) else {
            return Err(format!("polynomial takes 12 numbers, not {}", parameters.len()));
        };
        Ok(Self { c, d })
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
        let has = |k: usize| self.c.iter().zip(POWERS).any(|(&c, p)| c != 0.0 && p[k] > 0);
        let invariants = [
            if has(0) { s.first() } else { Jet::zero() },
            if has(1) { s.second() } else { Jet::zero() },
        ];
        for (&c, powers) in self.c.iter().zip(POWERS) {
            if c == 0.0 {
                continue;
            }
            let mut term = Jet::constant(T::one());
            for (n, invariant) in powers.into_iter().zip(&invariants) {
                for _ in 0..n {
                    term = term * *invariant;
                }
            }
            w += term.scale(c);
        }
        w
    }
}
