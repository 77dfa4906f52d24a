//! Four-node quadrilateral with drilling rotations: quadratic edges from the rotations, a
//! bubble, and the rotation tied to the skew gradient by a penalty with the mean shear modulus
//! (Ibrahimbegovic, Taylor & Wilson 1990; functional of Hughes & Brezzi 1989).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Drilling, Element, Point, Sample};
use super::shapes;
use crate::base::Real;
use crate::base::small::{Mat, Nodal, inverse2};

#[derive(Clone, Copy)]
pub struct Q4d;

impl Element<4, 3, 1> for Q4d {
    const NAME: &'static str = "Q4D";
    const CELL: &'static str = "quad4";
    const ALPHA_B: f64 = 1.0;
    type Code = Self;
    type Op<T: Real> = Drilling<T, 4>;
    /// Bulges of the edges.
    type Prepared<T: Real> = [[T; 2]; 4];

    // The 2 x 2 rule leaves a zero-energy mode.
    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(3)
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(3)
    }
    fn shape(xi: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
        shapes::square_linear(xi)
    }
    fn sides(xi: [f64; 2]) -> [f64; 4] {
        shapes::square_sides(xi).0
    }
    /// Penalty of the drilling row: the mean over all directions of the shear modulus, which
    /// for isotropic material is that modulus itself.
    fn parameter(c: &Mat<f64, 3>) -> f64 {
        (c[0][0] + c[1][1] - 2.0 * c[0][1] + 4.0 * c[2][2]) / 8.0
    }
    #[inline(always)]
    fn prepare<T: Real>(x: &Nodal<T, 4, 2>, _: f64, sides: &[T; 4]) -> [[T; 2]; 4] {
        shapes::bulges(x, sides)
    }
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, 4, 2>,
        bulges: &[[T; 2]; 4],
        point: &Point<4>,
    ) -> Sample<T, Drilling<T, 4>, 1> {
        let (inverse, det) = inverse2(&shapes::jacobian(x, &point.dn));
        let dn = shapes::push(&inverse, &point.dn);
        let dm = shapes::push(&inverse, &shapes::square_sides(point.xi).1);
        let bubble = shapes::push(&inverse, &[shapes::square_bubble(point.xi).1]);
        let op = Drilling { grad: dn, turn: shapes::turning_rows(bulges, &dm), n: point.n };
        Sample { op, modes: bubble, weight: det.scale(point.weight) }
    }
}
