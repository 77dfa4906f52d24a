//! Isotropic linear elasticity. Parameters: E, nu.
// SPDX-License-Identifier: BSD-3-Clause

use super::material::{Material, Plane, PointState, Response, broadcast, hooke};
use crate::base::Real;
use crate::base::small::Mat;

#[derive(Clone, Debug)]
pub struct Elastic {
    moduli: Mat<f64, 3>,
    plane: Plane,
    young: f64,
    nu: f64,
}

impl Material for Elastic {
    const NAME: &'static str = "elastic";
    const EXAMPLES: &'static [&'static [f64]] = &[&[1000.0, 0.3], &[7.0, 0.3]];
    const SHORT: bool = true;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[e, nu] = parameters else {
            return Err(format!("elastic takes E and nu, not {} numbers", parameters.len()));
        };
        if !(e > 0.0 && e.is_finite() && nu > -1.0 && nu < 0.5) {
            return Err(format!("elastic needs E > 0 and -1 < nu < 0.5, not {e} and {nu}"));
        }
        let g = e / (2.0 * (1.0 + nu));
        let (c, d) = match plane {
            Plane::Stress => (e / (1.0 - nu * nu), nu),
            Plane::Strain => (e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)), nu / (1.0 - nu)),
        };
        let moduli = [[c, c * d, 0.0], [c * d, c, 0.0], [0.0, 0.0, g]];
        Ok(Self { moduli, plane, young: e, nu })
    }
    fn line(parameters: &[f64]) -> Result<Self, String> {
        let law = Self::new(parameters, Plane::Stress)?;
        let (e, g) = (law.young, law.moduli[2][2]);
        Ok(Self { moduli: [[e, 0.0, 0.0], [0.0, e, 0.0], [0.0, 0.0, g]], ..law })
    }
    fn is_linear(&self) -> bool {
        true
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], _: &mut PointState<'_>) -> Response<T> {
        Response {
            stress: hooke(&self.moduli, strain),
            tangent: broadcast(&self.moduli),
            failed: T::none(),
        }
    }
    fn bulk(&self) -> Option<f64> {
        Some(self.young / (3.0 * (1.0 - 2.0 * self.nu)))
    }
    fn out_of_plane(&self, strain: [f64; 3], stress: [f64; 3], _: &[f64]) -> (f64, f64) {
        match self.plane {
            Plane::Stress => (-self.nu / (1.0 - self.nu) * (strain[0] + strain[1]), 0.0),
            Plane::Strain => (0.0, self.nu * (stress[0] + stress[1])),
        }
    }
    fn energy(&self, e: [f64; 3], s: [f64; 3], _: &[f64]) -> f64 {
        0.5 * (e[0] * s[0] + e[1] * s[1] + e[2] * s[2])
    }
    fn energy_solid(&self, e: [f64; 4], s: [f64; 4], _: &[f64]) -> f64 {
        0.5 * (e[0] * s[0] + e[1] * s[1] + e[2] * s[2] + e[3] * s[3])
    }
    fn initial_energy(&self, _: [f64; 3], _: f64, initial: f64) -> f64 {
        0.5 * initial * initial / self.young
    }
}
