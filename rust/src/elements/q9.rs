//! Nine-node Lagrange quadrilateral, 3 x 3 (Bathe 1996, section 5.3).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::Revolved;
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;

#[derive(Clone, Copy)]
pub struct Q9;

impl Element<9, 2, 0> for Q9 {
    const NAME: &'static str = "Q9";
    const CELL: &'static str = "quad9";
    type Code = Self;
    type Op<T: Real> = Grad<T, 9>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(3)
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(3)
    }
    fn shape(xi: [f64; 2]) -> ([f64; 9], [[f64; 2]; 9]) {
        shapes::square_lagrange(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 9, 2>, _: f64, _: &[T; 9]) {}
    #[inline(always)]
    fn sample<T: Real>(x: &Nodal<T, 9, 2>, (): &(), point: &Point<9>) -> Sample<T, Grad<T, 9>, 0> {
        let (g, weight) = shapes::gradients(x, point);
        Sample { op: Grad(g), modes: [], weight }
    }
}

impl Revolved<9, 0> for Q9 {}
