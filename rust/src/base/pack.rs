//! Several numbers at once: the processor's vector registers as a [`Real`], chosen at run time.
//!
//! One of the places with `unsafe` code: a [`Pack`] conjures the token that proves that the
//! processor has the instructions. It is sound because nobody outside this file can name `Pack`:
//! a kernel meets it only as the type parameter of [`Kernel::run`], and [`dispatch`] calls that
//! after the features of the processor were read.
// SPDX-License-Identifier: BSD-3-Clause
#![allow(unsafe_code)]

use super::real::{Job, Real};
use pulp::{Simd, WithSimd, bytemuck};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Widest pack of any processor; arrays by lane have this length.
pub const MAX_LANES: usize = 8;

/// Instructions that batches of elements use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lanes {
    /// The widest of the processor. Measured (Zen 4, ns an element with scatter): 8 lanes take
    /// from 27 % less (Q4I) to 12 % more (Q8, Q8R: their matrices fill the nearest cache) than 4.
    #[default]
    Best,
    /// Plain numbers.
    Scalar,
    /// 256-bit registers (x86-64 with AVX2 and FMA), else as [`Lanes::Best`].
    Four,
    /// 512-bit registers (x86-64 with AVX-512, feature `avx512`), else as [`Lanes::Best`].
    Eight,
}

impl Lanes {
    pub fn new(name: &str) -> Result<Self, String> {
        match name {
            "best" => Ok(Self::Best),
            "scalar" => Ok(Self::Scalar),
            "4" => Ok(Self::Four),
            "8" => Ok(Self::Eight),
            _ => Err(format!("lanes must be best, scalar, 4 or 8, not {name:?}")),
        }
    }

    /// How many numbers really travel together on this processor.
    pub fn width(self) -> usize {
        struct Width;
        impl Kernel for Width {
            type Output = usize;
            #[inline(always)]
            fn run<T: Real>(self) -> usize {
                T::LANES
            }
        }
        dispatch(self, Width)
    }
}

/// Work that is written for any number type.
pub trait Kernel {
    type Output;
    /// Must be `#[inline(always)]`, and so must everything on its way: only what is inlined is
    /// compiled for the processor's instructions.
    fn run<T: Real>(self) -> Self::Output;
}

struct Run<K>(K);

impl<K: Kernel> WithSimd for Run<K> {
    type Output = K::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> K::Output {
        self.0.run::<Pack<S>>()
    }
}

/// Run a kernel with the widest type that is wanted and there.
pub fn dispatch<K: Kernel>(lanes: Lanes, kernel: K) -> K::Output {
    if lanes == Lanes::Scalar {
        return one_by_one(kernel);
    }
    #[cfg(target_arch = "x86_64")]
    {
        #[cfg(feature = "avx512")]
        if lanes != Lanes::Four
            && let Some(simd) = pulp::x86::V4::try_new()
        {
            return Simd::vectorize(simd, Run(kernel));
        }
        if let Some(simd) = pulp::x86::V3::try_new() {
            return Simd::vectorize(simd, Run(kernel));
        }
        one_by_one(kernel)
    }
    #[cfg(target_arch = "aarch64")]
    {
        match pulp::aarch64::Neon::try_new() {
            Some(simd) => Simd::vectorize(simd, Run(kernel)),
            None => one_by_one(kernel),
        }
    }
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    one_by_one(kernel)
}

/// Run a kernel with plain numbers; out of line, for all that end here.
#[inline(never)]
fn one_by_one<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<f64>()
}

/// One vector register.
#[derive(Clone, Copy)]
struct Pack<S: Simd>(S::f64s);

/// Truth by lane.
#[derive(Clone, Copy)]
struct Mask<S: Simd>(S::m64s);

/// Proof that the processor has the instructions of `S`.
#[inline(always)]
fn token<S: Simd>() -> S {
    const { assert!(size_of::<S>() == 0) };
    // SAFETY: the token has no bytes to be wrong, and `S` is in use only below `vectorize`, which
    // takes a token that `try_new` gave (see the head of this file).
    unsafe { std::mem::zeroed() }
}

/// A job that is compiled by itself.
struct Apart<J>(J);

impl<J: Job> WithSimd for Apart<J> {
    type Output = J::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> J::Output {
        self.0.run()
    }
}

impl<S: Simd> Add for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self(token::<S>().add_f64s(self.0, o.0))
    }
}
impl<S: Simd> Sub for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self(token::<S>().sub_f64s(self.0, o.0))
    }
}
impl<S: Simd> Mul for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self(token::<S>().mul_f64s(self.0, o.0))
    }
}
impl<S: Simd> Div for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        Self(token::<S>().div_f64s(self.0, o.0))
    }
}
impl<S: Simd> Neg for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(token::<S>().neg_f64s(self.0))
    }
}
impl<S: Simd> AddAssign for Pack<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}
impl<S: Simd> SubAssign for Pack<S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<S: Simd> Pack<S> {
    /// A function of plain numbers, lane by lane.
    #[inline(always)]
    fn each(mut self, f: impl Fn(f64) -> f64) -> Self {
        for v in bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut self.0)) {
            *v = f(*v);
        }
        self
    }
}

impl<S: Simd> Real for Pack<S> {
    type Mask = Mask<S>;
    const LANES: usize = S::F64_LANES;

    #[inline(always)]
    fn apart<J: Job>(job: J) -> J::Output {
        token::<S>().vectorize(Apart(job))
    }
    #[inline(always)]
    fn real(v: f64) -> Self {
        Self(token::<S>().splat_f64s(v))
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        Self(token::<S>().mul_add_e_f64s(self.0, a.0, b.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(token::<S>().sqrt_f64s(self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(token::<S>().abs_f64s(self.0))
    }
    #[inline(always)]
    fn round(self) -> Self {
        // Adding and taking away 1.5 * 2^52 leaves no room for a fraction; larger numbers have
        // none.
        let large = Self::real(6_755_399_441_055_744.0);
        Self::select(self.abs().lt(Self::real(2_251_799_813_685_248.0)), self + large - large, self)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.each(f64::exp)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.each(f64::ln)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self::from_lanes(|l| self.lane(l).atan2(x.lane(l)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask<S> {
        Mask(token::<S>().less_than_f64s(self.0, other.0))
    }
    #[inline(always)]
    fn select(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Self(token::<S>().select_f64s(mask.0, yes.0, no.0))
    }
    #[inline(always)]
    fn any(mask: Mask<S>) -> bool {
        token::<S>().first_true_m64s(mask.0) < S::F64_LANES
    }
    #[inline(always)]
    fn or(a: Mask<S>, b: Mask<S>) -> Mask<S> {
        Mask(token::<S>().or_m64s(a.0, b.0))
    }
    #[inline(always)]
    fn and(a: Mask<S>, b: Mask<S>) -> Mask<S> {
        Mask(token::<S>().and_m64s(a.0, b.0))
    }
    #[inline(always)]
    fn none() -> Mask<S> {
        Self::zero().lt(Self::zero())
    }
    #[inline(always)]
    fn mask_lane(mask: Mask<S>, lane: usize) -> bool {
        Self::select(mask, Self::one(), Self::zero()).lane(lane) > 0.5
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.lanes()[lane]
    }
    #[inline(always)]
    fn lanes(&self) -> &[f64] {
        bytemuck::cast_slice(std::slice::from_ref(&self.0))
    }
    #[inline(always)]
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        let mut pack = Self::zero();
        let values = bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut pack.0));
        for (l, v) in values.iter_mut().enumerate() {
            *v = f(l);
        }
        pack
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        Self(bytemuck::pod_read_unaligned(bytemuck::cast_slice(&from[..S::F64_LANES])))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[..S::F64_LANES].copy_from_slice(self.lanes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on packs against the same on plain numbers.
    struct Operations;

    impl Kernel for Operations {
        type Output = ();
        #[allow(clippy::float_cmp)] // Infinities and zeros must be the same.
        fn run<T: Real>(self) {
            let cases = [
                0.5,
                -1.5,
                2.5,
                -0.0,
                1e300,
                -7.25,
                3.0,
                0.1,
                1e17,
                -2.5,
                0.499_999_999_999_999_94,
            ];
            for (i, &a) in cases.iter().enumerate() {
                for (j, &b) in cases.iter().enumerate() {
                    // Each lane has its own numbers.
                    let at = |k: usize, l: usize| cases[(k + l) % cases.len()];
                    let x = T::from_lanes(|l| at(i, l));
                    let y = T::from_lanes(|l| at(j, l));
                    let same = |pack: T, f: &dyn Fn(f64, f64) -> f64| {
                        for l in 0..T::LANES {
                            let (got, want) = (pack.lane(l), f(at(i, l), at(j, l)));
                            let close = (got - want).abs() <= 4e-16 * want.abs();
                            assert!(got == want || close || (got.is_nan() && want.is_nan()));
                        }
                    };
                    same(x + y, &|a, b| a + b);
                    same(x - y, &|a, b| a - b);
                    same(x * y, &|a, b| a * b);
                    same(x / y, &|a, b| a / b);
                    same(-x, &|a, _| -a);
                    same(x.abs(), &|a, _| a.abs());
                    same(x.abs().sqrt(), &|a, _| a.abs().sqrt());
                    same(x.round(), &|a, _| a.round_ties_even());
                    same(x.atan2(y), &f64::atan2);
                    same(x.scale(1e-301).exp(), &|a, _| (a * 1e-301).exp());
                    same(x.abs().ln(), &|a, _| a.abs().ln());
                    same(x.max(y), &|a, b| if a < b { b } else { a });
                    same(x.min(y), &|a, b| if b < a { b } else { a });
                    same(x.fma(T::real(2.0), T::one()), &|a, _| a.mul_add(2.0, 1.0));
                    let less = x.lt(y);
                    let mut any = false;
                    for l in 0..T::LANES {
                        let want = at(i, l) < at(j, l);
                        assert_eq!(T::mask_lane(less, l), want);
                        assert!(!T::mask_lane(T::and(less, T::none()), l));
                        assert_eq!(T::mask_lane(T::or(less, T::none()), l), want);
                        any |= want;
                    }
                    assert_eq!(T::any(less), any);
                    let mut out = [0.0; MAX_LANES];
                    x.store(&mut out);
                    same(T::load(&out), &|a, _| a);
                    let _ = (a, b);
                }
            }
            assert!(!T::any(T::none()));
        }
    }

    #[test]
    fn packs_agree_with_plain_numbers() {
        for lanes in [Lanes::Best, Lanes::Scalar, Lanes::Four, Lanes::Eight] {
            dispatch(lanes, Operations);
        }
    }
}
