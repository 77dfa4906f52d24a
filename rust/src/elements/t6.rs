//! Six-node triangle, quadratic, three-point rule (Fraeijs de Veubeke 1965).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::Revolved;
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;

#[derive(Clone, Copy)]
pub struct T6;

impl Element<6, 2, 0> for T6 {
    const NAME: &'static str = "T6";
    const CELL: &'static str = "tri6";
    type Code = Self;
    type Op<T: Real> = Grad<T, 6>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        shapes::triangle_3()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::triangle_6()
    }
    fn shape(xi: [f64; 2]) -> ([f64; 6], [[f64; 2]; 6]) {
        shapes::triangle_quadratic(xi)
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 6, 2>, _: f64, _: &[T; 6]) {}
    #[inline(always)]
    fn sample<T: Real>(x: &Nodal<T, 6, 2>, (): &(), point: &Point<6>) -> Sample<T, Grad<T, 6>, 0> {
        let (g, weight) = shapes::gradients(x, point);
        Sample { op: Grad(g), modes: [], weight }
    }
}

impl Revolved<6, 0> for T6 {}
