//! Deformation plasticity of Ramberg and Osgood (1943): nonlinear elasticity that follows a
//! power law under growing stress, `E e = s + a (|s| / s0)^(n-1) s` in one dimension. In three,
//! `E e = (1 + nu) S - (1 - 2 nu) p + 3/2 a (q / s0)^(n-1) S` with deviator S, mean stress p and
//! equivalent stress q.
//!
//! Parameters: E, nu, s0, n, a.
//!
//! Tensors are held by sum `11 + 22`, difference `11 - 22` and shear; in plane strain the sum is
//! that of the deviator. Each is its strain over a compliance `c0 + c1 r`, r = (q / s0)^(n-1), so
//! that one equation for q is left. Over logarithms it has slopes between 1 and n.
// SPDX-License-Identifier: BSD-3-Clause

use super::material::{Material, Plane, PointState, Response, in_plane};
use crate::base::Real;
use crate::base::small::Mat;

/// Iterations of the scalar equation; bisection alone reaches round-off in this many.
const MAX_ITERATIONS: usize = 80;
/// Error of ln q after which one more Newton step is exact to round-off.
const TOLERANCE: f64 = 1e-12;
/// Squared strain that stands for zero.
const ZERO: f64 = 1e-300;

#[derive(Clone, Debug)]
pub struct RambergOsgood {
    young: f64,
    nu: f64,
    plane: Plane,
    moduli: Mat<f64, 3>,
    /// Equivalent stress at which the power term is `offset` times the elastic strain.
    yield_stress: f64,
    exponent: f64,
    offset: f64,
    /// Strain by strain in the plane.
    share: [f64; 3],
    /// Elastic compliance, and that of the power term at the yield stress.
    elastic: [f64; 3],
    power: [f64; 3],
    /// `q^2` by squared stress.
    norm: [f64; 3],
    bulk: f64,
}

impl RambergOsgood {
    /// Equivalent stress over the yield stress, its power n - 1, and the lanes that did not settle.
    #[inline(always)]
    fn solve<T: Real>(&self, e: &[T; 3]) -> (T, T, T::Mask) {
        let n = self.exponent;
        let (mut a, mut first, mut last) = ([T::zero(); 3], T::zero(), T::zero());
        for k in 0..3 {
            let scale = (1.0 / self.yield_stress).powi(2) * self.norm[k];
            a[k] = (e[k] * e[k]).fma(T::real(scale), T::real(ZERO));
            first = a[k].fma(T::real(self.elastic[k].powi(-2)), first);
            last = a[k].fma(T::real(self.power[k].powi(-2)), last);
        }
        // Either part of the compliance alone gives too large a stress.
        let mut x = first.ln().scale(0.5).min(last.ln().scale(0.5 / n));
        let (mut low, mut high) = (x, x);
        let mut open = T::one();
        for i in 0..MAX_ITERATIONS {
            let (rho, r) = (x.exp(), x.scale(n - 1.0).exp());
            let (mut sum, mut slope) = (T::zero(), T::zero());
            for k in 0..3 {
                let (one, two) = (T::real(self.elastic[k]), r.scale(self.power[k]));
                let y = rho * (one + two);
                let t = a[k] / (y * y);
                sum += t;
                slope += t * (one + two.scale(n)) / (one + two);
            }
            let value = sum.ln().scale(-0.5);
            if i == 0 {
                low = x - value;
            }
            let settled = value.abs().lt(T::real(TOLERANCE));
            let short = value.lt(T::zero());
            low = T::select(short, x, low);
            high = T::select(short, high, x);
            let next = x - value * sum / slope;
            let inside = T::or(settled, T::and(low.lt(next), next.lt(high)));
            x = T::select(inside, next, (low + high).scale(0.5));
            open = T::select(settled, T::zero(), T::one());
            if !T::any(T::real(0.5).lt(open)) {
                break;
            }
        }
        (x.exp(), x.scale(n - 1.0).exp(), T::real(0.5).lt(open))
    }

    /// Mean stress and squared equivalent stress.
    fn invariants(&self, e: [f64; 3], s: [f64; 3]) -> (f64, f64) {
        let volume = self.bulk * (e[0] + e[1]);
        let (mean, less) = match self.plane {
            Plane::Stress => ((s[0] + s[1]) / 3.0, 0.0),
            Plane::Strain => (volume, 2.0 * volume),
        };
        let parts = [s[0] + s[1] - less, s[0] - s[1], s[2]];
        (mean, (0..3).map(|k| self.norm[k] * parts[k] * parts[k]).sum())
    }

    /// Power term at an equivalent stress of which the square is given.
    fn power_at(&self, square: f64) -> f64 {
        self.offset * (square.sqrt() / self.yield_stress).powf(self.exponent - 1.0)
    }
}

impl Material for RambergOsgood {
    const NAME: &'static str = "ramberg_osgood";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[1000.0, 0.3, 100.0, 2.0, 0.5],
        // the usual offset; auxetic; nearly perfectly plastic
        &[7.0, 0.3, 0.05, 5.0, 3.0 / 7.0],
        &[7.0, -0.4, 0.05, 5.0, 2.0],
        &[7.0, 0.49, 0.05, 40.0, 0.002],
    ];

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[young, nu, yield_stress, exponent, offset] = parameters else {
            return Err(format!("ramberg_osgood takes 5 numbers, not {}", parameters.len()));
        };
        if !(young > 0.0 && young.is_finite() && nu > -1.0 && nu < 0.5) {
            let text = "ramberg_osgood needs E > 0 and -1 < nu < 0.5";
            return Err(format!("{text}, not {young} and {nu}"));
        }
        if ![yield_stress, exponent, offset].iter().all(|v| *v > 0.0 && v.is_finite())
            || exponent < 1.0
        {
            return Err("ramberg_osgood needs a yield stress and an offset > 0, an exponent >= 1"
                .to_string());
        }
        let (soft, a) = ((1.0 + nu) / young, offset / young);
        let bulk = young / (3.0 * (1.0 - 2.0 * nu));
        let (first, share, norm) = match plane {
            Plane::Stress => (((1.0 - nu) / young, 0.5 * a), 1.0, 0.25),
            Plane::Strain => ((soft, 1.5 * a), 1.0 / 3.0, 2.25),
        };
        let g = 0.5 / soft;
        let (c11, c12) = match plane {
            Plane::Stress => (young / (1.0 - nu * nu), nu * young / (1.0 - nu * nu)),
            Plane::Strain => (bulk + 4.0 * g / 3.0, bulk - 2.0 * g / 3.0),
        };
        Ok(Self {
            young,
            nu,
            plane,
            moduli: [[c11, c12, 0.0], [c12, c11, 0.0], [0.0, 0.0, g]],
            yield_stress,
            exponent,
            offset,
            share: [share, 1.0, 1.0],
            elastic: [first.0, soft, 2.0 * soft],
            power: [first.1, 1.5 * a, 3.0 * a],
            norm: [norm, 0.75, 3.0],
            bulk,
        })
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], _: &mut PointState<'_>) -> Response<T> {
        let e = [(strain[0] + strain[1]).scale(self.share[0]), strain[0] - strain[1], strain[2]];
        let (rho, r, failed) = self.solve(&e);
        let per_stress = rho.recip().scale(1.0 / self.yield_stress);
        let growth = r.scale(self.exponent - 1.0);
        let (mut s, mut inverse, mut m) = ([T::zero(); 3], [T::zero(); 3], [T::zero(); 3]);
        let mut divisor = T::one();
        for k in 0..3 {
            inverse[k] = r.fma(T::real(self.power[k]), T::real(self.elastic[k])).recip();
            s[k] = e[k] * inverse[k];
            let part = s[k] * per_stress;
            m[k] = (part * inverse[k]).scale(self.norm[k] * self.share[k]);
            let size = (part * part).scale(self.norm[k] * self.power[k]);
            divisor = (size * inverse[k]).fma(growth, divisor);
        }
        // Halves of the derivatives of sum and difference, and that of the shear.
        let drop = growth.scale(self.offset / self.young) / divisor;
        let weight = [0.5 * self.share[0], 0.5, 1.0];
        let mut b = [[T::zero(); 3]; 3];
        for i in 0..3 {
            b[i][i] = inverse[i].scale(weight[i]);
            for j in i..3 {
                b[i][j] -= drop * m[i] * m[j];
            }
        }
        let mut sum = s[0];
        if self.plane == Plane::Strain {
            b[0][0] += T::real(self.bulk);
            sum = (strain[0] + strain[1]).fma(T::real(2.0 * self.bulk), sum);
        }
        let stress = [(sum + s[1]).scale(0.5), (sum - s[1]).scale(0.5), s[2]];
        Response { stress, tangent: in_plane(&b), failed }
    }
    fn bulk(&self) -> Option<f64> {
        Some(self.bulk)
    }
    fn out_of_plane(&self, e: [f64; 3], s: [f64; 3], _: &[f64]) -> (f64, f64) {
        let (mean, square) = self.invariants(e, s);
        match self.plane {
            Plane::Stress => {
                ((-self.nu - 0.5 * self.power_at(square)) / self.young * (s[0] + s[1]), 0.0)
            }
            Plane::Strain => (0.0, 3.0 * mean - s[0] - s[1]),
        }
    }
    fn energy(&self, e: [f64; 3], s: [f64; 3], _: &[f64]) -> f64 {
        let (mean, square) = self.invariants(e, s);
        let n = self.exponent;
        let shape = (1.0 + self.nu) / 3.0 + n / (n + 1.0) * self.power_at(square);
        0.5 * mean * mean / self.bulk + shape * square / self.young
    }
    fn spherical(&self) -> bool {
        self.plane == Plane::Strain
    }
    fn initial_energy(&self, s: [f64; 3], normal: f64, initial: f64) -> f64 {
        initial / self.bulk * ((s[0] + s[1] + normal) / 3.0 + 0.5 * initial)
    }
}
