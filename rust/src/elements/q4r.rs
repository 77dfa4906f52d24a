//! Four-node quadrilateral with one point and physical stabilization of the hourglass: bending
//! along each of its two axes with the uniaxial stiffness of the material, so that it neither
//! locks nor needs a number from the user (Belytschko & Bindeman 1991; with flow as Reese 2003).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;
use crate::kinematics::hourglass;
use crate::kinematics::integrate::{History, Local, Section};
use crate::kinematics::per_point::PerPoint;

#[derive(Clone, Copy)]
pub struct Q4r;

impl Element<4, 2, 0> for Q4r {
    const NAME: &'static str = "Q4R";
    const CELL: &'static str = "quad4";
    const FREE_VOLUME: bool = true;
    const MEMORY: usize = hourglass::MEMORY;
    const DISSIPATED: Option<usize> = Some(hourglass::DISSIPATED);
    type Op<T: Real> = Grad<T, 4>;
    type Prepared<T: Real> = ();

    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(1)
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
    #[inline(always)]
    fn law_into<T: Real>(
        x: &Nodal<T, 4, 2>,
        q: &Nodal<T, 4, 2>,
        section: &Section<4>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, 4, 2>,
    ) {
        hourglass::local_into::<Self, T>(x, q, section, history, tangent, out);
    }
    #[inline(always)]
    fn stabilization<T: Real>(
        x: &Nodal<T, 4, 2>,
        q: &Nodal<T, 4, 2>,
        section: &Section<4>,
        own: &PerPoint<'_>,
        memory: &[f64],
    ) -> [[T; 2]; 2] {
        hourglass::energy(x, q, section, own, memory)
    }
}
