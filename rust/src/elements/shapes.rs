//! Shape functions, quadrature rules and the isoparametric map: shared by all elements.
// SPDX-License-Identifier: BSD-3-Clause

use super::element::Point;
use crate::base::small::{Nodal, inverse2};
use crate::base::{Real, shared_dual};

/// Gauss rule with `n` points a direction on the square `[-1, 1]^2`.
pub fn gauss_square(n: usize) -> Vec<[f64; 3]> {
    let line: Vec<(f64, f64)> = match n {
        1 => vec![(0.0, 2.0)],
        2 => {
            let a = 1.0 / 3.0_f64.sqrt();
            vec![(-a, 1.0), (a, 1.0)]
        }
        3 => {
            let a = 0.6_f64.sqrt();
            vec![(-a, 5.0 / 9.0), (0.0, 8.0 / 9.0), (a, 5.0 / 9.0)]
        }
        _ => {
            let (p, q) = (3.0 / 7.0, 2.0 / 7.0 * 1.2_f64.sqrt());
            let (a, b) = ((p - q).sqrt(), (p + q).sqrt());
            let w = 30.0_f64.sqrt();
            let (wa, wb) = ((18.0 + w) / 36.0, (18.0 - w) / 36.0);
            vec![(-b, wb), (-a, wa), (a, wa), (b, wb)]
        }
    };
    let mut points = Vec::with_capacity(n * n);
    for &(s, ws) in &line {
        for &(r, wr) in &line {
            points.push([r, s, wr * ws]);
        }
    }
    points
}

/// Centroid rule of the triangle (degree 1); weights sum to 1/2.
pub fn triangle_1() -> Vec<[f64; 3]> {
    vec![[1.0 / 3.0, 1.0 / 3.0, 0.5]]
}

/// Interior three-point rule of the triangle (degree 2).
pub fn triangle_3() -> Vec<[f64; 3]> {
    let (a, b) = (1.0 / 6.0, 2.0 / 3.0);
    vec![[a, a, a], [b, a, a], [a, b, a]]
}

/// Mid-side rule of the triangle (degree 2).
pub fn triangle_sides() -> Vec<[f64; 3]> {
    let w = 1.0 / 6.0;
    vec![[0.5, 0.0, w], [0.5, 0.5, w], [0.0, 0.5, w]]
}

/// Six-point rule of the triangle (degree 4; Strang and Fix, Dunavant).
pub fn triangle_6() -> Vec<[f64; 3]> {
    let (a, b) = (0.091_576_213_509_770_74, 0.445_948_490_915_964_9);
    let (wa, wb) = (0.054_975_871_827_660_93, 0.111_690_794_839_005_73);
    let ring = |t: f64, w: f64| [[t, t, w], [1.0 - 2.0 * t, t, w], [t, 1.0 - 2.0 * t, w]];
    [ring(a, wa), ring(b, wb)].concat()
}

pub fn triangle_linear([r, s]: [f64; 2]) -> ([f64; 3], [[f64; 2]; 3]) {
    ([1.0 - r - s, r, s], [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
}

pub fn triangle_quadratic(xi: [f64; 2]) -> ([f64; 6], [[f64; 2]; 6]) {
    let (l, dl) = triangle_linear(xi);
    let (mut n, mut dn) = ([0.0; 6], [[0.0; 2]; 6]);
    for a in 0..3 {
        let b = (a + 1) % 3;
        n[a] = l[a] * (2.0 * l[a] - 1.0);
        n[a + 3] = 4.0 * l[a] * l[b];
        for j in 0..2 {
            dn[a][j] = (4.0 * l[a] - 1.0) * dl[a][j];
            dn[a + 3][j] = 4.0 * (l[a] * dl[b][j] + l[b] * dl[a][j]);
        }
    }
    (n, dn)
}

/// Corners of the reference square, then mid-sides.
const SQUARE: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

pub fn square_linear([r, s]: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
    let (mut n, mut dn) = ([0.0; 4], [[0.0; 2]; 4]);
    for a in 0..4 {
        let [ra, sa] = SQUARE[a];
        n[a] = 0.25 * (1.0 + ra * r) * (1.0 + sa * s);
        dn[a] = [0.25 * ra * (1.0 + sa * s), 0.25 * sa * (1.0 + ra * r)];
    }
    (n, dn)
}

/// Mid-side functions of the square, one for each edge, and their derivatives.
pub fn square_sides([r, s]: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
    let (mut m, mut dm) = ([0.0; 4], [[0.0; 2]; 4]);
    for k in 0..4 {
        let [rk, sk] = SQUARE[4 + k];
        if rk == 0.0 {
            m[k] = 0.5 * (1.0 - r * r) * (1.0 + sk * s);
            dm[k] = [-r * (1.0 + sk * s), 0.5 * sk * (1.0 - r * r)];
        } else {
            m[k] = 0.5 * (1.0 - s * s) * (1.0 + rk * r);
            dm[k] = [0.5 * rk * (1.0 - s * s), -s * (1.0 + rk * r)];
        }
    }
    (m, dm)
}

pub fn square_serendipity(xi: [f64; 2]) -> ([f64; 8], [[f64; 2]; 8]) {
    let (corner, d_corner) = square_linear(xi);
    let (side, d_side) = square_sides(xi);
    let (mut n, mut dn) = ([0.0; 8], [[0.0; 2]; 8]);
    for a in 0..4 {
        let before = (a + 3) % 4;
        n[a] = corner[a] - 0.5 * (side[a] + side[before]);
        n[a + 4] = side[a];
        for j in 0..2 {
            dn[a][j] = d_corner[a][j] - 0.5 * (d_side[a][j] + d_side[before][j]);
            dn[a + 4][j] = d_side[a][j];
        }
    }
    (n, dn)
}

/// Bubble of the square, `(1 - r^2)(1 - s^2)`, and its derivatives.
pub fn square_bubble([r, s]: [f64; 2]) -> (f64, [f64; 2]) {
    let (a, b) = (1.0 - r * r, 1.0 - s * s);
    (a * b, [-2.0 * r * b, -2.0 * s * a])
}

pub fn square_lagrange(xi: [f64; 2]) -> ([f64; 9], [[f64; 2]; 9]) {
    let (s8, d8) = square_serendipity(xi);
    let (bubble, d_bubble) = square_bubble(xi);
    let (mut n, mut dn) = ([0.0; 9], [[0.0; 2]; 9]);
    n[8] = bubble;
    dn[8] = d_bubble;
    for a in 0..8 {
        let share = if a < 4 { 0.25 } else { -0.5 };
        n[a] = s8[a] + share * bubble;
        for j in 0..2 {
            dn[a][j] = d8[a][j] + share * d_bubble[j];
        }
    }
    (n, dn)
}

/// Jacobian `J[i][j] = d x_i / d xi_j`.
#[inline(always)]
pub fn jacobian<T: Real, const N: usize>(x: &Nodal<T, N, 2>, dn: &[[f64; 2]; N]) -> [[T; 2]; 2] {
    let mut m = [[T::zero(); 2]; 2];
    for a in 0..N {
        for i in 0..2 {
            for j in 0..2 {
                m[i][j] = x[a][i].fma(T::real(dn[a][j]), m[i][j]);
            }
        }
    }
    m
}

/// Derivatives with respect to the position: `d_x = J^-T d_xi`.
#[inline(always)]
pub fn push<T: Real, const K: usize>(inverse: &[[T; 2]; 2], d: &[[f64; 2]; K]) -> [[T; 2]; K] {
    let mut g = [[T::zero(); 2]; K];
    for a in 0..K {
        for i in 0..2 {
            let first = inverse[0][i].scale(d[a][0]);
            g[a][i] = inverse[1][i].fma(T::real(d[a][1]), first);
        }
    }
    g
}

/// Gradients of the shape functions at a point, and determinant times weight.
#[inline(always)]
pub fn gradients<T: Real, const N: usize>(
    x: &Nodal<T, N, 2>,
    point: &Point<N>,
) -> ([[T; 2]; N], T) {
    shared_dual::<T, _>(
        #[inline(always)]
        || {
            let (inverse, det) = inverse2(&jacobian(x, &point.dn));
            (push(&inverse, &point.dn), det.scale(point.weight))
        },
    )
}

/// Half of `S e`, the edge vector turned by a right angle: with the mid-side function, the
/// displacement of an edge by the difference of its end rotations is
/// `M (phi_a - phi_b) (S e) / 8` (quadratic edge; Allman 1984).
#[inline(always)]
pub fn edge_bulge<T: Real, const N: usize>(x: &Nodal<T, N, 2>, a: usize) -> [T; 2] {
    let b = (a + 1) % N;
    let e = [x[b][0] - x[a][0], x[b][1] - x[a][1]];
    [e[1].scale(-0.125), e[0].scale(0.125)]
}

/// The [`edge_bulge`] of each edge times its share.
#[inline(always)]
pub fn bulges<T: Real, const N: usize>(x: &Nodal<T, N, 2>, sides: &[T; N]) -> [[T; 2]; N] {
    std::array::from_fn(|a| edge_bulge(x, a).map(|v| v * sides[a]))
}

/// Gradient rows of the drilling rotations from the gradients of the mid-side functions.
#[inline(always)]
pub fn turning_rows<T: Real, const N: usize>(
    bulges: &[[T; 2]; N],
    dm: &[[T; 2]; N],
) -> [[T; 4]; N] {
    let mut h = [[T::zero(); 4]; N];
    for a in 0..N {
        let b = (a + 1) % N;
        for i in 0..2 {
            for j in 0..2 {
                let v = bulges[a][i] * dm[a][j];
                h[a][2 * i + j] += v;
                h[b][2 * i + j] -= v;
            }
        }
    }
    h
}
