//! The number type that every kernel is generic in.
// SPDX-License-Identifier: BSD-3-Clause

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Work that is compiled by itself, see [`Real::apart`].
pub trait Job {
    type Output;
    /// Must be `#[inline(always)]`: a closure need not be inlined, and what is not has no vector
    /// instructions.
    fn run(self) -> Self::Output;
}

/// Call a function out of line: one instance for all who share its arguments' types.
#[inline(never)]
fn out_of_line<R>(f: impl FnOnce() -> R) -> R {
    f()
}

/// Call a closure out of line where numbers travel alone.
///
/// The closure must be `#[inline(always)]`: lanes have vector instructions only in what is inlined.
#[inline(always)]
pub fn shared<T: Real, R>(f: impl FnOnce() -> R) -> R {
    if const { T::LANES == 1 } { out_of_line(f) } else { f() }
}

/// Call a closure out of line where numbers carry derivatives, beside which a call costs nothing.
#[inline(always)]
pub fn shared_dual<T: Real, R>(f: impl FnOnce() -> R) -> R {
    if const { T::DERIVATIVES > 0 } { out_of_line(f) } else { f() }
}

/// A real number, or several at once (lanes), or one with its derivatives.
///
/// Kernels branch only through [`Real::select`], so that all lanes take the same way.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + 'static
{
    /// Truth value for each lane.
    type Mask: Copy;
    /// How many numbers travel together.
    const LANES: usize;
    /// Whether kernels that give a force and its stiffness give the stiffness too: numbers that
    /// carry their derivatives need none.
    const STIFFNESS: bool = true;
    /// Derivatives that a number carries and stores behind its value.
    const DERIVATIVES: usize = 0;

    fn real(v: f64) -> Self;
    /// `self * a + b`, fused where the hardware does it.
    fn fma(self, a: Self, b: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn round(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn atan2(self, x: Self) -> Self;

    fn lt(self, other: Self) -> Self::Mask;
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    fn any(mask: Self::Mask) -> bool;
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn none() -> Self::Mask;
    fn mask_lane(mask: Self::Mask, lane: usize) -> bool;

    /// Value of one lane.
    fn lane(self, lane: usize) -> f64;
    /// Values of all lanes.
    fn lanes(&self) -> &[f64];
    /// Build from a function of the lane.
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self;
    /// The first `LANES` numbers of a slice.
    fn load(from: &[f64]) -> Self;
    /// Write to the first `LANES` numbers of a slice.
    fn store(self, to: &mut [f64]);

    /// Run a job out of line, compiled for the instructions of this number type.
    #[inline(never)]
    fn apart<J: Job>(job: J) -> J::Output {
        job.run()
    }
    #[inline(always)]
    fn zero() -> Self {
        Self::real(0.0)
    }
    #[inline(always)]
    fn one() -> Self {
        Self::real(1.0)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
    /// Times a plain number.
    #[inline(always)]
    fn scale(self, k: f64) -> Self {
        self * Self::real(k)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        Self::one() / self
    }
    /// `exp(x) - 1` to all digits of a small one (Kahan; Higham 2002, section 1.14.1).
    #[inline(always)]
    fn exp_m1(self) -> Self {
        let e = self.exp();
        let less = e - Self::one();
        let exact = less * self / e.ln();
        let near = less.abs().lt(Self::real(f64::MIN_POSITIVE));
        let exact = Self::select(near, self, exact);
        Self::select(self.abs().lt(Self::one()), exact, less)
    }
}

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn real(v: f64) -> Self {
        v
    }
    // Without the hardware instruction a fused operation is a slow library call.
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn round(self) -> Self {
        f64::round_ties_even(self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn or(a: bool, b: bool) -> bool {
        a | b
    }
    #[inline(always)]
    fn and(a: bool, b: bool) -> bool {
        a & b
    }
    #[inline(always)]
    fn none() -> bool {
        false
    }
    #[inline(always)]
    fn mask_lane(mask: bool, _: usize) -> bool {
        mask
    }
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn lanes(&self) -> &[f64] {
        std::slice::from_ref(self)
    }
    #[inline(always)]
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
    }
}
