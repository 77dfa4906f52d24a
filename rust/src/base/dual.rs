//! Forward differentiation: a value with its exact derivatives.
// SPDX-License-Identifier: BSD-3-Clause

use super::real::Real;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A value and its derivatives with respect to `D` variables.
///
/// With `STORED`, derivatives are also loaded and stored: a number then takes `1 + D` places of a
/// slice, so that histories carry their derivatives through the kernels.
#[derive(Clone, Copy, Debug)]
pub struct Dual<const D: usize, const STORED: bool = false> {
    pub v: f64,
    pub d: [f64; D],
}

impl<const D: usize, const STORED: bool> Dual<D, STORED> {
    /// The `i`-th variable with value `v`.
    pub fn variable(v: f64, i: usize) -> Self {
        let mut d = [0.0; D];
        d[i] = 1.0;
        Self { v, d }
    }

    pub(super) fn chain(self, v: f64, dv: f64) -> Self {
        let mut d = self.d;
        for x in &mut d {
            *x *= dv;
        }
        Self { v, d }
    }
}

impl<const D: usize, const STORED: bool> Add for Dual<D, STORED> {
    type Output = Self;
    fn add(mut self, o: Self) -> Self {
        self.v += o.v;
        for i in 0..D {
            self.d[i] += o.d[i];
        }
        self
    }
}
impl<const D: usize, const STORED: bool> Sub for Dual<D, STORED> {
    type Output = Self;
    fn sub(mut self, o: Self) -> Self {
        self.v -= o.v;
        for i in 0..D {
            self.d[i] -= o.d[i];
        }
        self
    }
}
impl<const D: usize, const STORED: bool> Mul for Dual<D, STORED> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let mut d = [0.0; D];
        for i in 0..D {
            d[i] = self.d[i] * o.v + self.v * o.d[i];
        }
        Self { v: self.v * o.v, d }
    }
}
impl<const D: usize, const STORED: bool> Div for Dual<D, STORED> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let v = self.v / o.v;
        let mut d = [0.0; D];
        for i in 0..D {
            d[i] = (self.d[i] - v * o.d[i]) / o.v;
        }
        Self { v, d }
    }
}
impl<const D: usize, const STORED: bool> Neg for Dual<D, STORED> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.v, -1.0)
    }
}
impl<const D: usize, const STORED: bool> AddAssign for Dual<D, STORED> {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<const D: usize, const STORED: bool> SubAssign for Dual<D, STORED> {
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<const D: usize, const STORED: bool> Real for Dual<D, STORED> {
    type Mask = bool;
    const LANES: usize = 1;
    const STIFFNESS: bool = false;
    const DERIVATIVES: usize = if STORED { D } else { 0 };

    fn real(v: f64) -> Self {
        Self { v, d: [0.0; D] }
    }
    fn fma(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn sqrt(self) -> Self {
        let r = self.v.sqrt();
        // The derivative at zero is unbounded; kernels only meet it on a flat spot.
        self.chain(r, if r > 0.0 { 0.5 / r } else { 0.0 })
    }
    fn abs(self) -> Self {
        if self.v < 0.0 { -self } else { self }
    }
    fn round(self) -> Self {
        Self::real(self.v.round_ties_even())
    }
    fn exp(self) -> Self {
        let e = self.v.exp();
        self.chain(e, e)
    }
    fn ln(self) -> Self {
        self.chain(self.v.ln(), 1.0 / self.v)
    }
    fn atan2(self, x: Self) -> Self {
        let r2 = self.v * self.v + x.v * x.v;
        let mut d = [0.0; D];
        for i in 0..D {
            d[i] = (x.v * self.d[i] - self.v * x.d[i]) / r2;
        }
        Self { v: self.v.atan2(x.v), d }
    }
    fn lt(self, other: Self) -> bool {
        self.v < other.v
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    fn any(mask: bool) -> bool {
        mask
    }
    fn or(a: bool, b: bool) -> bool {
        a | b
    }
    fn and(a: bool, b: bool) -> bool {
        a & b
    }
    fn none() -> bool {
        false
    }
    fn mask_lane(mask: bool, _: usize) -> bool {
        mask
    }
    fn lane(self, _: usize) -> f64 {
        self.v
    }
    fn lanes(&self) -> &[f64] {
        std::slice::from_ref(&self.v)
    }
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        Self::real(f(0))
    }
    fn load(from: &[f64]) -> Self {
        let mut number = Self::real(from[0]);
        if STORED {
            number.d.copy_from_slice(&from[1..=D]);
        }
        number
    }
    fn store(self, to: &mut [f64]) {
        to[0] = self.v;
        if STORED {
            to[1..=D].copy_from_slice(&self.d);
        }
    }
}
