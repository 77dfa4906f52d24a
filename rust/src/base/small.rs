//! Algebra of arrays whose size is known at compile time.
// SPDX-License-Identifier: BSD-3-Clause

use super::real::Real;

/// Matrix of node blocks: `k[a][b][i][j]`; kernels fill and read `a <= b` only.
pub type Blocks<T, const N: usize, const M: usize> = [[[[T; M]; M]; N]; N];
/// Vector by nodes.
pub type Nodal<T, const N: usize, const M: usize> = [[T; M]; N];
/// Row-major square matrix.
pub type Mat<T, const D: usize> = [[T; D]; D];

#[inline(always)]
pub fn blocks<T: Real, const N: usize, const M: usize>() -> Blocks<T, N, M> {
    [[[[T::zero(); M]; M]; N]; N]
}

#[inline(always)]
pub fn nodal<T: Real, const N: usize, const M: usize>() -> Nodal<T, N, M> {
    [[T::zero(); M]; N]
}

/// `sum_a x_a . y_a` over nodes and dofs.
#[inline(always)]
pub fn dot<T: Real, const N: usize, const M: usize>(x: &Nodal<T, N, M>, y: &Nodal<T, N, M>) -> T {
    let mut s = T::zero();
    for a in 0..N {
        for i in 0..M {
            s = x[a][i].fma(y[a][i], s);
        }
    }
    s
}

/// Product of a symmetric block matrix, of which `a <= b` is stored, with a vector.
#[inline(always)]
pub fn symmetric_times<T: Real, const N: usize, const M: usize>(
    k: &Blocks<T, N, M>,
    x: &Nodal<T, N, M>,
) -> Nodal<T, N, M> {
    let mut y = nodal::<T, N, M>();
    for a in 0..N {
        for b in a..N {
            for i in 0..M {
                for j in 0..M {
                    y[a][i] = k[a][b][i][j].fma(x[b][j], y[a][i]);
                    if a != b {
                        y[b][j] = k[a][b][i][j].fma(x[a][i], y[b][j]);
                    }
                }
            }
        }
    }
    y
}

/// Inverse and determinant of a 2 x 2 matrix.
#[inline(always)]
pub fn inverse2<T: Real>(m: &Mat<T, 2>) -> (Mat<T, 2>, T) {
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let r = det.recip();
    ([[m[1][1] * r, -m[0][1] * r], [-m[1][0] * r, m[0][0] * r]], det)
}

/// Factor of the leading `n` rows of a symmetric positive definite matrix in place: `L D L^T`
/// without pivoting, from and to the lower triangle, with the inverse of `D` on the diagonal.
/// Pivots smaller than `least` are lifted to it.
#[inline(always)]
pub fn ldlt<T: Real, const D: usize>(m: &mut Mat<T, D>, n: usize, least: &[T; D]) {
    for j in 0..n {
        for k in 0..j {
            // The column still carries its factor D.
            let w = m[j][k] * m[k][k];
            for i in j..n {
                m[i][j] = (-m[i][k]).fma(w, m[i][j]);
            }
        }
        m[j][j] = T::select(m[j][j].abs().lt(least[j]), least[j], m[j][j]).recip();
    }
    for j in 0..n {
        for i in j + 1..n {
            m[i][j] = m[i][j] * m[j][j];
        }
    }
}

/// `L^-1 x` with the factor of [`ldlt`].
#[inline(always)]
pub fn ldlt_forward<T: Real, const D: usize>(f: &Mat<T, D>, n: usize, x: &mut [T; D]) {
    for i in 0..n {
        for k in 0..i {
            x[i] = (-f[i][k]).fma(x[k], x[i]);
        }
    }
}

/// Solve with the factor of [`ldlt`].
#[inline(always)]
pub fn ldlt_solve<T: Real, const D: usize>(f: &Mat<T, D>, n: usize, x: &mut [T; D]) {
    ldlt_forward(f, n, x);
    for i in (0..n).rev() {
        x[i] = x[i] * f[i][i];
        for k in i + 1..n {
            x[i] = (-f[k][i]).fma(x[k], x[i]);
        }
    }
}
