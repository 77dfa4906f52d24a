//! [`Q4d`](super::q4d::Q4d) with the incompatible modes of Q4I in place of its bubble: the
//! contraction across a bent element is free, so that bending stays right where the material
//! flows (Ibrahimbegovic, Taylor & Wilson 1990; modes: Taylor, Beresford & Wilson 1976).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Drilling, Element, Point, Sample};
use super::q4d::Q4d;
use super::q4i::{Center, Q4i};
use super::shapes;
use crate::base::Real;
use crate::base::small::{Mat, Nodal};

#[derive(Clone, Copy)]
pub struct Q4di;

impl Element<4, 3, 2> for Q4di {
    const NAME: &'static str = "Q4DI";
    const CELL: &'static str = "quad4";
    const ALPHA_B: f64 = Q4d::ALPHA_B;
    type Code = Self;
    type Op<T: Real> = Drilling<T, 4>;
    type Prepared<T: Real> = (Center<T>, [[T; 2]; 4]);

    fn rule() -> Vec<[f64; 3]> {
        Q4d::rule()
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        Q4d::mass_rule()
    }
    fn shape(xi: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
        Q4d::shape(xi)
    }
    fn sides(xi: [f64; 2]) -> [f64; 4] {
        Q4d::sides(xi)
    }
    fn parameter(moduli: &Mat<f64, 3>) -> f64 {
        Q4d::parameter(moduli)
    }
    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, 4, 2>, parameter: f64, sides: &[T; 4]) -> Self::Prepared<T> {
        (Q4i::prepare(x, parameter, sides), Q4d::prepare(x, parameter, sides))
    }
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, 4, 2>,
        (center, bulges): &Self::Prepared<T>,
        point: &Point<4>,
    ) -> Sample<T, Drilling<T, 4>, 2> {
        let Sample { op, modes, weight } = Q4i::sample(x, center, point);
        let (inverse, _) = crate::base::small::inverse2(&shapes::jacobian(x, &point.dn));
        let dm = shapes::push(&inverse, &shapes::square_sides(point.xi).1);
        let op = Drilling { grad: op.0, turn: shapes::turning_rows(bulges, &dm), n: point.n };
        Sample { op, modes, weight }
    }
}
