//! Forward differentiation twice over: a value with its exact gradient and Hessian.
// SPDX-License-Identifier: BSD-3-Clause

use super::dual::Dual;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A number that geometry can be written in: plain, or with its derivatives.
pub trait Smooth:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    fn real(v: f64) -> Self;
    fn value(self) -> f64;
    /// Times a plain number.
    fn scale(self, k: f64) -> Self;
    fn sqrt(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
}

impl Smooth for f64 {
    fn real(v: f64) -> Self {
        v
    }
    fn value(self) -> f64 {
        self
    }
    fn scale(self, k: f64) -> Self {
        self * k
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
}

impl<const D: usize> Smooth for Dual<D> {
    fn real(v: f64) -> Self {
        Self { v, d: [0.0; D] }
    }
    fn value(self) -> f64 {
        self.v
    }
    fn scale(self, k: f64) -> Self {
        self.chain(self.v * k, k)
    }
    fn sqrt(self) -> Self {
        super::Real::sqrt(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.v.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
}

/// A value with gradient and Hessian with respect to `D` variables.
///
/// The Hessian is kept in full and symmetric to the last bit.
#[derive(Clone, Copy, Debug)]
pub struct Hyper<const D: usize> {
    pub v: f64,
    pub d: [f64; D],
    pub h: [[f64; D]; D],
}

impl<const D: usize> Hyper<D> {
    /// The `i`-th variable with value `v`.
    pub fn variable(v: f64, i: usize) -> Self {
        let mut x = Self::real(v);
        x.d[i] = 1.0;
        x
    }

    /// A function of this number with value `v`, first and second derivative.
    pub fn chain(mut self, v: f64, first: f64, second: f64) -> Self {
        for i in 0..D {
            for j in 0..D {
                self.h[i][j] = first * self.h[i][j] + second * (self.d[i] * self.d[j]);
            }
        }
        for d in &mut self.d {
            *d *= first;
        }
        self.v = v;
        self
    }

    fn zip(mut self, o: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        self.v = f(self.v, o.v);
        for i in 0..D {
            self.d[i] = f(self.d[i], o.d[i]);
            for j in 0..D {
                self.h[i][j] = f(self.h[i][j], o.h[i][j]);
            }
        }
        self
    }
}

impl<const D: usize> Add for Hyper<D> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        self.zip(&o, |a, b| a + b)
    }
}
impl<const D: usize> Sub for Hyper<D> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self.zip(&o, |a, b| a - b)
    }
}
impl<const D: usize> AddAssign for Hyper<D> {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<const D: usize> Mul for Hyper<D> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let mut r = Self::real(self.v * o.v);
        for i in 0..D {
            r.d[i] = self.d[i] * o.v + self.v * o.d[i];
            for j in 0..D {
                let mixed = self.d[i] * o.d[j] + self.d[j] * o.d[i];
                r.h[i][j] = (self.h[i][j] * o.v + self.v * o.h[i][j]) + mixed;
            }
        }
        r
    }
}
impl<const D: usize> Div for Hyper<D> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let r = 1.0 / o.v;
        self * o.chain(r, -r * r, 2.0 * r * r * r)
    }
}
impl<const D: usize> Neg for Hyper<D> {
    type Output = Self;
    fn neg(self) -> Self {
        self.scale(-1.0)
    }
}

impl<const D: usize> Smooth for Hyper<D> {
    fn real(v: f64) -> Self {
        Self { v, d: [0.0; D], h: [[0.0; D]; D] }
    }
    fn value(self) -> f64 {
        self.v
    }
    fn scale(mut self, k: f64) -> Self {
        self.v *= k;
        for i in 0..D {
            self.d[i] *= k;
            for j in 0..D {
                self.h[i][j] *= k;
            }
        }
        self
    }
    fn sqrt(self) -> Self {
        let r = self.v.sqrt();
        self.chain(r, 0.5 / r, -0.25 / (r * self.v))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.v.sin_cos();
        (self.chain(s, c, -s), self.chain(c, -s, -c))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gradient and Hessian of `x sqrt(y) / x^2 - sin(x) cos(y)` worked out by hand.
    #[test]
    fn derivatives_are_those_by_hand() {
        let (a, b) = (0.7_f64, 1.9_f64);
        let (x, y) = (Hyper::<2>::variable(a, 0), Hyper::<2>::variable(b, 1));
        let f = x * y.sqrt() / (x * x) - x.sin_cos().0 * y.sin_cos().1;
        let (root, sa, ca, sb, cb) = (b.sqrt(), a.sin(), a.cos(), b.sin(), b.cos());
        let near = |p: f64, q: f64| assert!((p - q).abs() < 1e-14 * (1.0 + q.abs()), "{p} {q}");
        near(f.v, root / a - sa * cb);
        near(f.d[0], -root / (a * a) - ca * cb);
        near(f.d[1], 0.5 / (root * a) + sa * sb);
        near(f.h[0][0], 2.0 * root / a.powi(3) + sa * cb);
        near(f.h[0][1], -0.5 / (root * a * a) + ca * sb);
        near(f.h[1][0], f.h[0][1]);
        near(f.h[1][1], -0.25 / (b * root * a) + sa * cb);
    }
}
