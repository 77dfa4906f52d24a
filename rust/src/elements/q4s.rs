//! [`Q4i`] with strains that are linear about the mean gradient.
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::q4i::{Center, Q4i, ring_sample};
use super::ring::{Hoop, Revolved};
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;

#[derive(Clone, Copy)]
pub struct Q4s;

impl Element<4, 2, 2> for Q4s {
    const NAME: &'static str = "Q4S";
    const CELL: &'static str = "quad4";
    const FREE_VOLUME: bool = true;
    const ABOUT_MEAN: bool = true;
    type Code = Self;
    type Op<T: Real> = Grad<T, 4>;
    type Prepared<T: Real> = Center<T>;

    fn rule() -> Vec<[f64; 3]> {
        Q4i::rule()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        Q4i::mass_rule()
    }
    fn shape(xi: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
        Q4i::shape(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, 4, 2>, parameter: f64, sides: &[T; 4]) -> Center<T> {
        Q4i::prepare(x, parameter, sides)
    }
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, 4, 2>,
        center: &Center<T>,
        point: &Point<4>,
    ) -> Sample<T, Grad<T, 4>, 2> {
        Q4i::sample(x, center, point)
    }
    #[inline(always)]
    fn mean<T: Real>(_: &Nodal<T, 4, 2>, center: &Center<T>) -> Grad<T, 4> {
        Grad(shapes::push(&center.inverse, &shapes::square_linear([0.0, 0.0]).1))
    }
}

impl Revolved<4, 2> for Q4s {
    #[inline(always)]
    fn ring<T: Real>(
        x: &Nodal<T, 4, 2>,
        center: &Center<T>,
        point: &Point<4>,
    ) -> Sample<T, Hoop<T, 4>, 2> {
        ring_sample(x, center, point)
    }
}
