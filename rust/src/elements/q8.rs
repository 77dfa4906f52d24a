//! Eight-node serendipity quadrilateral, 3 x 3 (Bathe 1996, section 5.3); Q8r with 2 x 2.
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::Revolved;
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;

#[derive(Clone, Copy)]
pub struct Q8;

impl Element<8, 2, 0> for Q8 {
    const NAME: &'static str = "Q8";
    const CELL: &'static str = "quad8";
    type Code = Self;
    type Op<T: Real> = Grad<T, 8>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(3)
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(3)
    }
    fn shape(xi: [f64; 2]) -> ([f64; 8], [[f64; 2]; 8]) {
        shapes::square_serendipity(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 8, 2>, _: f64, _: &[T; 8]) {}
    #[inline(always)]
    fn sample<T: Real>(x: &Nodal<T, 8, 2>, (): &(), point: &Point<8>) -> Sample<T, Grad<T, 8>, 0> {
        let (g, weight) = shapes::gradients(x, point);
        Sample { op: Grad(g), modes: [], weight }
    }
}

/// [`Q8`] with the reduced rule: one hourglass mode that two elements do not share.
#[derive(Clone, Copy)]
pub struct Q8r;

impl Element<8, 2, 0> for Q8r {
    const NAME: &'static str = "Q8R";
    const CELL: &'static str = "quad8";
    const FREE_VOLUME: bool = true;
    const HOURGLASS: usize = 1;
    type Code = Q8;
    type Op<T: Real> = Grad<T, 8>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(2)
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        Q8::mass_rule()
    }
    fn shape(xi: [f64; 2]) -> ([f64; 8], [[f64; 2]; 8]) {
        Q8::shape(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 8, 2>, _: f64, _: &[T; 8]) {}
    #[inline(always)]
    fn sample<T: Real>(x: &Nodal<T, 8, 2>, (): &(), point: &Point<8>) -> Sample<T, Grad<T, 8>, 0> {
        Q8::sample(x, &(), point)
    }
}

impl Revolved<8, 0> for Q8 {}
impl Revolved<8, 0> for Q8r {}
