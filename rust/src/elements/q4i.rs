//! Four-node quadrilateral with incompatible modes `1 - r^2`, `1 - s^2` whose gradients are
//! taken with the center Jacobian, so that any shape passes the patch test (Wilson et al.
//! 1973; Taylor, Beresford & Wilson 1976; in a co-rotational frame: Battini 2008).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::{Hoop, Revolved, radius};
use super::shapes;
use crate::base::Real;
use crate::base::small::{Nodal, inverse2};
use std::f64::consts::TAU;

#[derive(Clone, Copy)]
pub struct Q4i;

/// Inverse Jacobian and determinant at the center.
#[derive(Clone, Copy)]
pub struct Center<T> {
    pub inverse: [[T; 2]; 2],
    det: T,
}

impl Element<4, 2, 2> for Q4i {
    const NAME: &'static str = "Q4I";
    const CELL: &'static str = "quad4";
    const FREE_VOLUME: bool = true;
    type Code = Self;
    type Op<T: Real> = Grad<T, 4>;
    type Prepared<T: Real> = Center<T>;

    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(2)
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(2)
    }
    fn shape(xi: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
        shapes::square_linear(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, 4, 2>, _: f64, _: &[T; 4]) -> Center<T> {
        let (_, dn) = shapes::square_linear([0.0, 0.0]);
        let (inverse, det) = inverse2(&shapes::jacobian(x, &dn));
        Center { inverse, det }
    }
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, 4, 2>,
        center: &Center<T>,
        point: &Point<4>,
    ) -> Sample<T, Grad<T, 4>, 2> {
        let (g, weight) = shapes::gradients(x, point);
        let [r, s] = point.xi;
        let mut modes = shapes::push(&center.inverse, &[[-2.0 * r, 0.0], [0.0, -2.0 * s]]);
        let ratio = center.det.scale(point.weight) / weight;
        for mode in &mut modes {
            for j in 0..2 {
                mode[j] = mode[j] * ratio;
            }
        }
        Sample { op: Grad(g), modes, weight }
    }
}

impl Revolved<4, 2> for Q4i {
    #[inline(always)]
    fn ring<T: Real>(
        x: &Nodal<T, 4, 2>,
        center: &Center<T>,
        point: &Point<4>,
    ) -> Sample<T, Hoop<T, 4>, 2> {
        ring_sample(x, center, point)
    }
}

/// Sample of the ring: the modes are `1 - (r - c)^2` about the center of the circumference, where
/// the mean of `r` weighted with the radius vanishes.
#[inline(always)]
pub fn ring_sample<T: Real>(
    x: &Nodal<T, 4, 2>,
    center: &Center<T>,
    point: &Point<4>,
) -> Sample<T, Hoop<T, 4>, 2> {
    let Sample { op: Grad(grad), mut modes, weight } = Q4i::sample(x, center, point);
    let (n, dn) = shapes::square_linear([0.0, 0.0]);
    let slope = shapes::jacobian(x, &dn)[0];
    let middle = radius(x, &n).scale(3.0).recip();
    let ratio = center.det.scale(point.weight) / weight;
    for m in 0..2 {
        let shift = (slope[m] * middle * ratio).scale(2.0);
        for i in 0..2 {
            modes[m][i] = center.inverse[m][i].fma(shift, modes[m][i]);
        }
    }
    let r = radius(x, &point.n);
    let inverse = r.recip();
    let row = point.n.map(
        #[inline(always)]
        |n| inverse.scale(n),
    );
    Sample { op: Hoop { grad, row }, modes, weight: (weight * r).scale(TAU) }
}
