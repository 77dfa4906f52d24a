//! Orthotropic linear elasticity, axes turned in the plane. Parameters: E1, E2, E3, nu12,
//! nu13, nu23, G12, angle of axis 1 from x in radians (Jones, Mechanics of Composite
//! Materials, section 2.3). Axis 3 is normal to the plane.
// SPDX-License-Identifier: BSD-3-Clause

use super::material::{Material, Plane, PointState, Response, SolidResponse, broadcast, hooke};
use crate::base::Real;
use crate::base::small::Mat;

#[derive(Clone, Debug)]
pub struct Orthotropic {
    moduli: Mat<f64, 3>,
    /// Thickness strain (plane stress) from the stress, or thickness stress (plane strain)
    /// from the stress in the plane.
    through: [f64; 3],
    /// Compliance through the thickness.
    normal: f64,
    plane: Plane,
}

impl Material for Orthotropic {
    const NAME: &'static str = "orthotropic";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[1000.0, 300.0, 200.0, 0.25, 0.2, 0.3, 150.0, 0.4],
        &[9.0, 4.0, 3.0, 0.25, 0.2, 0.3, 1.7, 0.6],
    ];
    const SHORT: bool = true;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[e1, e2, e3, nu12, nu13, nu23, g12, angle] = parameters else {
            return Err(format!("orthotropic takes 8 numbers, not {}", parameters.len()));
        };
        if !(e1 > 0.0 && e2 > 0.0 && e3 > 0.0 && g12 > 0.0) {
            return Err("orthotropic needs E1, E2, E3, G12 > 0".into());
        }
        // Compliance of the normal components; positive definite or refused.
        let (s12, s13, s23) = (-nu12 / e1, -nu13 / e1, -nu23 / e2);
        let (s11, s22, s33) = (1.0 / e1, 1.0 / e2, 1.0 / e3);
        let minor = s11 * s22 - s12 * s12;
        let det = s11 * (s22 * s33 - s23 * s23) - s12 * (s12 * s33 - s23 * s13)
            + s13 * (s12 * s23 - s22 * s13);
        if !(minor > 0.0 && det > 0.0) {
            return Err("the orthotropic constants are not positive definite: reduce nu".into());
        }
        let (a11, a12, a22) = match plane {
            Plane::Stress => (s11, s12, s22),
            // Thickness strain held at zero: reduced compliance.
            Plane::Strain => (s11 - s13 * s13 / s33, s12 - s13 * s23 / s33, s22 - s23 * s23 / s33),
        };
        let d = a11 * a22 - a12 * a12;
        let local = [[a22 / d, -a12 / d, 0.0], [-a12 / d, a11 / d, 0.0], [0.0, 0.0, g12]];
        // Strain in material axes = T strain in global axes (engineering shear).
        let (c, s) = (angle.cos(), angle.sin());
        let t = [
            [c * c, s * s, c * s],
            [s * s, c * c, -c * s],
            [-2.0 * c * s, 2.0 * c * s, c * c - s * s],
        ];
        let mut moduli = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for p in 0..3 {
                    for q in 0..3 {
                        moduli[i][j] += t[p][i] * local[p][q] * t[q][j];
                    }
                }
            }
        }
        // e33 = s13 s1 + s23 s2 (+ s33 s3): coefficients on the stress in global axes.
        let through =
            [s13 * c * c + s23 * s * s, s13 * s * s + s23 * c * c, 2.0 * c * s * (s13 - s23)];
        let scale = if plane == Plane::Stress { 1.0 } else { -1.0 / s33 };
        Ok(Self { moduli, through: through.map(|x| x * scale), normal: s33, plane })
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
    #[inline(always)]
    fn update_solid<T: Real>(&self, e: [T; 4], _: &mut PointState<'_>) -> SolidResponse<T> {
        // A strain through the thickness acts as the strain that it gives an unloaded plane.
        let mut rows = [[0.0; 4]; 3];
        for i in 0..3 {
            rows[i][i] = 1.0;
            rows[i][3] = self.through[i];
        }
        let mut tangent = [[T::zero(); 4]; 4];
        let mut stress = [T::zero(); 4];
        for i in 0..4 {
            for j in 0..4 {
                let mut v = if i == 3 && j == 3 { 1.0 / self.normal } else { 0.0 };
                for r in 0..3 {
                    for q in 0..3 {
                        v += rows[r][i] * self.moduli[r][q] * rows[q][j];
                    }
                }
                tangent[i][j] = T::real(v);
                stress[i] = e[j].fma(tangent[i][j], stress[i]);
            }
        }
        SolidResponse { stress, tangent, failed: T::none() }
    }
    fn out_of_plane(&self, _: [f64; 3], s: [f64; 3], _: &[f64]) -> (f64, f64) {
        let t = &self.through;
        let value = t[0] * s[0] + t[1] * s[1] + t[2] * s[2];
        match self.plane {
            Plane::Stress => (value, 0.0),
            Plane::Strain => (0.0, value),
        }
    }
    fn energy(&self, e: [f64; 3], s: [f64; 3], _: &[f64]) -> f64 {
        0.5 * (e[0] * s[0] + e[1] * s[1] + e[2] * s[2])
    }
    fn energy_solid(&self, e: [f64; 4], s: [f64; 4], _: &[f64]) -> f64 {
        0.5 * (e[0] * s[0] + e[1] * s[1] + e[2] * s[2] + e[3] * s[3])
    }
    fn initial_energy(&self, _: [f64; 3], _: f64, initial: f64) -> f64 {
        0.5 * initial * initial * self.normal
    }
}
