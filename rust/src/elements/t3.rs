//! Three-node triangle, constant strain (Turner et al. 1956).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::Revolved;
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;

#[derive(Clone, Copy)]
pub struct T3;

impl Element<3, 2, 0> for T3 {
    const NAME: &'static str = "T3";
    const CELL: &'static str = "tri3";
    const BENDING_CELLS: usize = 16;
    type Code = Self;
    type Op<T: Real> = Grad<T, 3>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        shapes::triangle_1()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::triangle_3()
    }
    fn shape(xi: [f64; 2]) -> ([f64; 3], [[f64; 2]; 3]) {
        shapes::triangle_linear(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 3, 2>, _: f64, _: &[T; 3]) {}
    #[inline(always)]
    fn sample<T: Real>(x: &Nodal<T, 3, 2>, (): &(), point: &Point<3>) -> Sample<T, Grad<T, 3>, 0> {
        let (g, weight) = shapes::gradients(x, point);
        Sample { op: Grad(g), modes: [], weight }
    }
}

impl Revolved<3, 0> for T3 {}
