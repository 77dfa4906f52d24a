//! Four-node bilinear quadrilateral, 2 x 2; locks in bending (Taig 1961).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::Revolved;
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;

#[derive(Clone, Copy)]
pub struct Q4;

impl Element<4, 2, 0> for Q4 {
    const NAME: &'static str = "Q4";
    const CELL: &'static str = "quad4";
    const BENDING_CELLS: usize = 8;
    type Code = Self;
    type Op<T: Real> = Grad<T, 4>;
    type Prepared<T: Real> = ();

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
    fn prepare<T: Real>(_: &Nodal<T, 4, 2>, _: f64, _: &[T; 4]) {}
    #[inline(always)]
    fn sample<T: Real>(x: &Nodal<T, 4, 2>, (): &(), point: &Point<4>) -> Sample<T, Grad<T, 4>, 0> {
        let (g, weight) = shapes::gradients(x, point);
        Sample { op: Grad(g), modes: [], weight }
    }
}

impl Revolved<4, 0> for Q4 {}
