//! Logarithmic (Hencky) strain of a plane displacement gradient, `E = 1/2 ln C`, with exact
//! first and second derivatives.
//!
//! With mean `c`, half difference `d` and shear `s` of `C`, and `w = (d^2 + s^2) / c^2`,
//! `E = 1/2 (a I + b dev C)` where `a = ln det F` and `b = phi(w) / c`,
//! `phi(w) = atanh(sqrt w) / sqrt w = 1 + w/3 + w^2/5 + ...`: analytic where the principal
//! stretches coincide, so that this limit needs no case of its own.
//!
//! Batches of elements have these functions inlined, so that strain, stress and tangent share
//! their parts; single elements call one instance.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::small::Mat;
use crate::base::{Real, shared};

/// Largest `w` for which the series is summed.
const SERIES: f64 = 0.1;
/// Terms that reach round-off there.
const TERMS: usize = 18;

/// `phi` with its first and second derivatives.
#[inline(always)]
fn phi<T: Real>(w: T) -> [T; 3] {
    let mut p = [T::zero(); 3];
    let bounded = w.min(T::real(SERIES));
    for k in (0..TERMS).rev() {
        // Horner's rule for the value and both derivatives.
        p[2] = p[2].fma(bounded, p[1].scale(2.0));
        p[1] = p[1].fma(bounded, p[0]);
        p[0] = p[0].fma(bounded, T::real(1.0 / (2 * k + 1) as f64));
    }
    let far = T::real(SERIES).lt(w);
    if T::any(far) {
        let root = w.sqrt();
        let value = ((T::one() + root) / (T::one() - root)).ln().scale(0.5) / root;
        let u = (T::one() - w).recip();
        let half = w.recip().scale(0.5);
        let first = (u - value) * half;
        let second = (u * u - first.scale(3.0)) * half;
        p = [
            T::select(far, value, p[0]),
            T::select(far, first, p[1]),
            T::select(far, second, p[2]),
        ];
    }
    p
}

/// `ln(1 + x)`, without cancellation for small `x`.
#[inline(always)]
pub(super) fn log1p<T: Real>(x: T) -> T {
    let z = x / (x + T::real(2.0));
    z.scale(2.0) * phi(z * z)[0]
}

/// Mean, half difference and shear of `C`, its determinant and the function `b`.
struct Parts<T> {
    c: T,
    d: T,
    s: T,
    /// `1 / det C`.
    inverse: T,
    b: T,
    /// Derivatives of `b`: by `w` scaled so that `db/dd = b1 d`, and second so that
    /// `d2b/dd2 = b1 + b2 d^2`.
    b1: T,
    b2: T,
}

#[inline(always)]
fn parts<T: Real>(h: &[T; 4]) -> Parts<T> {
    let half = T::real(0.5);
    let square = |i: usize| h[i] * h[i];
    let c = (square(0) + square(1) + square(2) + square(3)).fma(half, T::one() + h[0] + h[3]);
    let d = (square(0) + square(2) - square(1) - square(3)).fma(half, h[0] - h[3]);
    let s = h[0].fma(h[1], h[2].fma(h[3], h[1] + h[2]));
    let det = (h[0] + T::one()) * (h[3] + T::one()) - h[1] * h[2];
    let r = c.recip();
    let w = (d.fma(d, s * s)) * r * r;
    let [p, p1, p2] = phi(w);
    let r3 = r * r * r;
    Parts {
        c,
        d,
        s,
        inverse: (det * det).recip(),
        b: p * r,
        b1: p1.scale(2.0) * r3,
        b2: p2.scale(4.0) * r3 * r * r,
    }
}

/// Strain xx, yy, xy (engineering shear).
#[inline(always)]
pub fn strain<T: Real>(h: &[T; 4]) -> [T; 3] {
    shared::<T, _>(
        #[inline(always)]
        || {
            let p = parts(h);
            let a = log1p(h[0].fma(h[3], h[0] + h[3]) - h[1] * h[2]).scale(0.5);
            let difference = (p.b * p.d).scale(0.5);
            [a + difference, a - difference, p.b * p.s]
        },
    )
}

/// Derivative by (c, d, s) of `t : E` for a fixed stress `t`.
#[inline(always)]
fn gradient<T: Real>(p: &Parts<T>, t: &[T; 3]) -> [T; 3] {
    let sum = (t[0] + t[1]).scale(0.5);
    let difference = (t[0] - t[1]).scale(0.5);
    let m = difference.fma(p.d, t[2] * p.s);
    [
        (sum * p.c - m) * p.inverse,
        (m * p.b1 - sum * p.inverse).fma(p.d, p.b * difference),
        (m * p.b1 - sum * p.inverse).fma(p.s, p.b * t[2]),
    ]
}

/// Derivative of (c, d, s) by the gradient.
#[inline(always)]
fn slopes<T: Real>(h: &[T; 4]) -> [[T; 4]; 3] {
    let (f0, f3) = (h[0] + T::one(), h[3] + T::one());
    [[f0, h[1], h[2], f3], [f0, -h[1], h[2], -f3], [h[1], f0, f3, h[2]]]
}

/// Second Piola-Kirchhoff stress 11, 22, 12 conjugate to `C / 2`.
#[inline(always)]
pub fn second_piola<T: Real>(h: &[T; 4], t: &[T; 3]) -> [T; 3] {
    let g = gradient(&parts(h), t);
    [g[0] + g[1], g[0] - g[1], g[2]]
}

/// Stress conjugate to the gradient.
#[inline(always)]
pub fn pull<T: Real>(h: &[T; 4], t: &[T; 3]) -> [T; 4] {
    shared::<T, _>(
        #[inline(always)]
        || {
            let g = gradient(&parts(h), t);
            let y = slopes(h);
            let mut p = [T::zero(); 4];
            for i in 0..4 {
                for r in 0..3 {
                    p[i] = g[r].fma(y[r][i], p[i]);
                }
            }
            p
        },
    )
}

/// Derivative of [`pull`] where the stress follows the strain with the tangent `tangent`.
#[inline(always)]
pub fn tangent<T: Real>(h: &[T; 4], t: &[T; 3], tangent: &Mat<T, 3>) -> Mat<T, 4> {
    shared::<T, _>(
        #[inline(always)]
        || tangent_inline(h, t, tangent),
    )
}

#[inline(always)]
fn tangent_inline<T: Real>(h: &[T; 4], t: &[T; 3], tangent: &Mat<T, 3>) -> Mat<T, 4> {
    let p = parts(h);
    let sum = (t[0] + t[1]).scale(0.5);
    let difference = (t[0] - t[1]).scale(0.5);
    let m = difference.fma(p.d, t[2] * p.s);
    let g = gradient(&p, t);
    // Derivative of the strain by (c, d, s).
    let unit = [
        [T::one(), T::zero(), T::zero()],
        [T::zero(), T::one(), T::zero()],
        [T::zero(), T::zero(), T::one()],
    ];
    let de = [gradient(&p, &unit[0]), gradient(&p, &unit[1]), gradient(&p, &unit[2])];
    // Second derivative of `t : E` at fixed `t`.
    let (i1, i2) = (p.inverse, p.inverse * p.inverse);
    let v = [p.c, -p.d, -p.s];
    let b_cd = [(p.d * i2).scale(-2.0), (p.s * i2).scale(-2.0)];
    let by = [difference, t[2]];
    let y = [p.d, p.s];
    let mut k = [[T::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            k[i][j] = (v[i] * v[j] * i2 * sum).scale(-2.0);
        }
    }
    k[0][0] += (m * p.c * i2).scale(2.0) + sum * i1;
    for i in 0..2 {
        k[0][i + 1] += m * b_cd[i] - by[i] * i1;
        k[i + 1][i + 1] += m * p.b1 - sum * i1;
        for j in 0..2 {
            let mixed = by[i].fma(y[j], by[j] * y[i]) * p.b1;
            k[i + 1][j + 1] += mixed + m * p.b2 * y[i] * y[j];
        }
    }
    k[1][0] = k[0][1];
    k[2][0] = k[0][2];
    for i in 0..3 {
        for j in 0..3 {
            for r in 0..3 {
                for q in 0..3 {
                    k[i][j] = (de[r][i] * tangent[r][q]).fma(de[q][j], k[i][j]);
                }
            }
        }
    }
    let dy = slopes(h);
    let mut a = [[T::zero(); 4]; 4];
    for j in 0..4 {
        let mut column = [T::zero(); 3];
        for r in 0..3 {
            for q in 0..3 {
                column[r] = k[r][q].fma(dy[q][j], column[r]);
            }
        }
        for i in 0..=j {
            for r in 0..3 {
                a[i][j] = dy[r][i].fma(column[r], a[i][j]);
            }
            a[j][i] = a[i][j];
        }
    }
    // Stress times the second derivatives of (c, d, s).
    let along = [g[0] + g[1], g[0] - g[1]];
    for i in 0..4 {
        a[i][i] += along[i % 2];
    }
    for i in [0, 2] {
        a[i][i + 1] += g[2];
        a[i + 1][i] += g[2];
    }
    a
}
