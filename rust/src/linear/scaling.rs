// SPDX-License-Identifier: BSD-3-Clause
//! Symmetric scaling by powers of two, and products with the scaled matrix.
//!
//! Powers of two change no digit, so the guards see a matrix with a diagonal
//! near one in any system of units while the solution keeps every bit.

use rayon::prelude::*;

use super::error::LinearError;

/// Power of two nearest (in exponent) to `1 / sqrt(a)`, `a > 0`.
fn inverse_sqrt_pow2(a: f64) -> f64 {
    let half = (-0.5 * a.log2()).round().clamp(-500.0, 500.0) as i32;
    2.0_f64.powi(half)
}

/// Scale of each equation so that the diagonal, where there is one, is near one.
///
/// An equation without diagonal is scaled by its largest (scaled) coupling.
pub fn scale_of(col_ptr: &[usize], row_idx: &[u32], values: &[f64], scale: &mut [f64]) {
    let n = scale.len();
    let mut bare = false;
    for c in 0..n {
        let last = col_ptr[c + 1];
        let has = last > col_ptr[c] && row_idx[last - 1] as usize == c;
        let d = if has { values[last - 1].abs() } else { 0.0 };
        scale[c] = if d > 0.0 && d.is_finite() { inverse_sqrt_pow2(d) } else { 0.0 };
        bare |= scale[c] == 0.0;
    }
    if !bare {
        return;
    }
    let mut largest = vec![0.0_f64; n];
    for c in 0..n {
        for k in col_ptr[c]..col_ptr[c + 1] {
            let r = row_idx[k] as usize;
            let v = values[k].abs();
            let factor = |s: f64| if s > 0.0 { s } else { 1.0 };
            if scale[c] == 0.0 && v.is_finite() {
                largest[c] = largest[c].max(v * factor(scale[r]));
            }
            if scale[r] == 0.0 && r != c && v.is_finite() {
                largest[r] = largest[r].max(v * factor(scale[c]));
            }
        }
    }
    for c in 0..n {
        if scale[c] == 0.0 {
            scale[c] =
                if largest[c] > 0.0 { inverse_sqrt_pow2(largest[c] * largest[c]) } else { 1.0 };
        }
    }
}

/// Largest entry of a matrix scaled to a unit diagonal that still counts as balanced.
///
/// No entry of a positive definite one exceeds two (powers of two leave that much).
pub const BALANCED: f64 = 4.0;

/// Brings the largest entry of each row near one, for matrices whose diagonal is small.
pub fn balance(col_ptr: &[usize], row_idx: &[u32], values: &[f64], scale: &mut [f64]) {
    const ROUNDS: usize = 8;
    let mut largest = vec![0.0_f64; scale.len()];
    for _ in 0..ROUNDS {
        largest.fill(0.0);
        for c in 0..scale.len() {
            for k in col_ptr[c]..col_ptr[c + 1] {
                let r = row_idx[k] as usize;
                let v = (values[k] * scale[c] * scale[r]).abs();
                largest[c] = largest[c].max(v);
                largest[r] = largest[r].max(v);
            }
        }
        let mut done = true;
        for (s, &v) in scale.iter_mut().zip(&largest) {
            if v > 0.0 && v.is_finite() && !(1.0 / BALANCED..=BALANCED).contains(&v) {
                *s *= inverse_sqrt_pow2(v);
                done = false;
            }
        }
        if done {
            break;
        }
    }
}

/// Columns that one thread scales at a time.
const STRIPE: usize = 16_384;

/// Size of a scaled matrix.
#[derive(Debug, Clone, Copy, Default)]
pub struct Size {
    /// Largest entry.
    pub entry: f64,
    /// Largest column sum of absolute values in the upper triangle: a lower bound
    /// of the norm, so that errors relative to it are never understated.
    pub norm: f64,
}

/// `out = S K S` for the upper triangle; the first entry that is not finite is an error.
///
/// Stripes of columns go to the threads of rayon's current pool if `share`.
pub fn apply_scale(
    col_ptr: &[usize],
    row_idx: &[u32],
    values: &[f64],
    scale: &[f64],
    out: &mut [f64],
    share: bool,
) -> Result<Size, LinearError> {
    let n = scale.len();
    let mut rest = out;
    let mut stripes = Vec::with_capacity(n / STRIPE + 1);
    for first in (0..n).step_by(STRIPE) {
        let end = (first + STRIPE).min(n);
        let (own, later) = rest.split_at_mut(col_ptr[end] - col_ptr[first]);
        stripes.push((first..end, own));
        rest = later;
    }
    let stripe = |(columns, out): (std::ops::Range<usize>, &mut [f64])| {
        let offset = col_ptr[columns.start];
        let mut size = Size::default();
        for c in columns {
            let (begin, end) = (col_ptr[c], col_ptr[c + 1]);
            let s = scale[c];
            let target = &mut out[begin - offset..end - offset];
            let (mut sum, mut largest) = (0.0_f64, 0.0_f64);
            for ((o, &v), &r) in
                target.iter_mut().zip(&values[begin..end]).zip(&row_idx[begin..end])
            {
                *o = v * s * scale[r as usize];
                let a = o.abs();
                sum += a;
                largest = if a > largest { a } else { largest };
            }
            if !sum.is_finite() {
                let k = target.iter().position(|v| !v.is_finite()).unwrap_or(0);
                let row = row_idx[begin + k] as usize;
                return Err(LinearError::NotFinite { row, column: c });
            }
            size.norm = size.norm.max(sum);
            size.entry = size.entry.max(largest);
        }
        Ok(size)
    };
    let sizes: Vec<Result<Size, LinearError>> = if share {
        stripes.into_par_iter().map(stripe).collect()
    } else {
        stripes.into_iter().map(stripe).collect()
    };
    let mut whole = Size::default();
    for size in sizes {
        let size = size?;
        whole.norm = whole.norm.max(size.norm);
        whole.entry = whole.entry.max(size.entry);
    }
    Ok(whole)
}

/// `y -= A x` with the upper triangle of a symmetric `A`.
pub fn subtract_product(
    col_ptr: &[usize],
    row_idx: &[u32],
    values: &[f64],
    x: &[f64],
    y: &mut [f64],
) {
    for c in 0..x.len() {
        let xc = x[c];
        let mut sum = 0.0;
        let range = col_ptr[c]..col_ptr[c + 1];
        for (&r, &v) in row_idx[range.clone()].iter().zip(&values[range]) {
            let r = r as usize;
            if r == c {
                sum += v * xc;
            } else {
                y[r] -= v * xc;
                sum += v * x[r];
            }
        }
        y[c] -= sum;
    }
}

/// Largest magnitude of a vector.
pub fn max_abs(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, &v| m.max(v.abs()))
}

/// Place of the largest magnitude, the first of equal ones.
pub fn largest_at(x: &[f64]) -> usize {
    let best =
        x.iter().enumerate().fold(
            (0, -1.0),
            |best: (usize, f64), (i, v)| {
                if v.abs() > best.1 { (i, v.abs()) } else { best }
            },
        );
    best.0
}
