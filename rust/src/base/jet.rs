//! Second-order differentiation over any number type: a value with its gradient and Hessian by
//! three variables.
// SPDX-License-Identifier: BSD-3-Clause

use super::real::{Real, shared};
use std::ops::{Add, AddAssign, Mul, Sub};

/// Rows and columns of the entries of [`Jet::h`].
pub const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// A value with its derivatives by three variables.
#[derive(Clone, Copy, Debug)]
pub struct Jet<T> {
    pub v: T,
    pub d: [T; 3],
    /// Second derivatives, by [`PAIRS`].
    pub h: [T; 6],
}

impl<T: Real> Jet<T> {
    #[inline(always)]
    pub fn constant(v: T) -> Self {
        Self { v, d: [T::zero(); 3], h: [T::zero(); 6] }
    }

    #[inline(always)]
    pub fn zero() -> Self {
        Self::constant(T::zero())
    }

    /// The `i`-th variable with value `v`.
    #[inline(always)]
    pub fn variable(v: T, i: usize) -> Self {
        let mut x = Self::constant(v);
        x.d[i] = T::one();
        x
    }

    /// A function of this number with value `v`, first and second derivative.
    #[inline(always)]
    pub fn chain(self, v: T, first: T, second: T) -> Self {
        shared::<T, _>(
            #[inline(always)]
            || {
                let mut y = Self::constant(v);
                for i in 0..3 {
                    y.d[i] = first * self.d[i];
                }
                for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                    y.h[k] = first.fma(self.h[k], second * self.d[i] * self.d[j]);
                }
                y
            },
        )
    }

    /// Times a plain number.
    #[inline(always)]
    pub fn scale(mut self, k: f64) -> Self {
        self.v = self.v.scale(k);
        for i in 0..3 {
            self.d[i] = self.d[i].scale(k);
        }
        for h in &mut self.h {
            *h = h.scale(k);
        }
        self
    }

    /// Plus a plain number.
    #[inline(always)]
    pub fn plus(mut self, c: f64) -> Self {
        self.v += T::real(c);
        self
    }

    /// `exp(k x)`.
    #[inline(always)]
    pub fn exp(self, k: f64) -> Self {
        let e = self.v.scale(k).exp();
        self.chain(e, e.scale(k), e.scale(k * k))
    }

    /// `exp(k x) - 1`, to all digits of a small value.
    #[inline(always)]
    pub fn exp_m1(self, k: f64) -> Self {
        let (e, less) = (self.v.scale(k).exp(), self.v.scale(k).exp_m1());
        self.chain(less, e.scale(k), e.scale(k * k))
    }
}

impl<T: Real> Add for Jet<T> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, o: Self) -> Self {
        self.v += o.v;
        for i in 0..3 {
            self.d[i] += o.d[i];
        }
        for k in 0..6 {
            self.h[k] += o.h[k];
        }
        self
    }
}

impl<T: Real> AddAssign for Jet<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<T: Real> Sub for Jet<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + o.scale(-1.0)
    }
}

impl<T: Real> Mul for Jet<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        shared::<T, _>(
            #[inline(always)]
            || {
                let mut y = Self::constant(self.v * o.v);
                for i in 0..3 {
                    y.d[i] = self.d[i].fma(o.v, self.v * o.d[i]);
                }
                for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                    let mixed = self.d[i].fma(o.d[j], self.d[j] * o.d[i]);
                    y.h[k] = self.h[k].fma(o.v, self.v.fma(o.h[k], mixed));
                }
                y
            },
        )
    }
}
