//! Four-node quadrilateral with one point and physical stabilization of the hourglass: bending
//! along each of its two axes with the uniaxial stiffness of the material, so that it neither
//! locks nor needs a number from the user (Belytschko & Bindeman 1991; with flow as Reese 2003).
// SPDX-License-Identifier: BSD-3-Clause

use super::element::{Element, Grad, Point, Sample};
use super::ring::{Hoop, LocalRing, Revolved, radius};
use super::shapes;
use crate::base::Real;
use crate::base::small::Nodal;
use crate::kinematics::hourglass;
use crate::kinematics::integrate::{History, Local, Section};
use crate::kinematics::per_point::PerPoint;
use std::f64::consts::TAU;

#[derive(Clone, Copy)]
pub struct Q4r;

impl Element<4, 2, 0> for Q4r {
    const NAME: &'static str = "Q4R";
    const CELL: &'static str = "quad4";
    const FREE_VOLUME: bool = true;
    const MEMORY: usize = hourglass::MEMORY;
    const DISSIPATED: Option<usize> = Some(hourglass::DISSIPATED);
    type Code = Self;
    type Op<T: Real> = Grad<T, 4>;
    const EDGE: f64 = 1.0;
    /// Slopes of the thickness in natural coordinates, over its mean.
    type Prepared<T: Real> = [T; 2];

    fn rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(1)
    }
    fn mass_rule() -> Vec<[f64; 3]> {
        shapes::gauss_square(2)
    }
    fn shape(xi: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4]) {
        shapes::square_linear(xi)
    }
    fn edge(_: f64, thickness: f64) -> f64 {
        thickness
    }
    #[inline(always)]
    fn prepare<T: Real>(_: &Nodal<T, 4, 2>, _: f64, edges: &[T; 4]) -> [T; 2] {
        [(edges[1] - edges[3]).scale(0.5), (edges[2] - edges[0]).scale(0.5)]
    }
    /// The gradient is the mean over the volume, so that with any bilinear thickness the forces of a
    /// constant stress are exact: the gradient of the hourglass is `x_s` times that of `x_r` and
    /// reversed, whose mean over the square is that of the slopes.
    #[inline(always)]
    fn sample<T: Real>(
        x: &Nodal<T, 4, 2>,
        slopes: &[T; 2],
        point: &Point<4>,
    ) -> Sample<T, Grad<T, 4>, 0> {
        let (mut g, area) = shapes::gradients(x, point);
        let gamma = hourglass::gamma(x, &g);
        // Gradients of the natural coordinates at the center, and the hourglass of the positions.
        let mut more = T::zero();
        let mut mean = [T::zero(); 2];
        for j in 0..2 {
            let [r, s] = [(g[1][j] + g[2][j]).scale(2.0), (g[2][j] + g[3][j]).scale(2.0)];
            let skew = (x[0][j] - x[1][j] + x[2][j] - x[3][j]).scale(0.25);
            more = slopes[0].fma(s, slopes[1] * r).fma(skew, more);
            mean[j] = slopes[1].fma(r, slopes[0] * s).scale(1.0 / 3.0);
        }
        let volume = more.scale(1.0 / 3.0) + T::one();
        let share = volume.recip();
        for a in 0..4 {
            for j in 0..2 {
                g[a][j] = (gamma[a] * share).fma(mean[j], g[a][j]);
            }
        }
        Sample { op: Grad(g), modes: [], weight: area * volume }
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
        hourglass::local_into::<Self, T, 2>(x, q, section, history, tangent, out);
    }
    #[inline(always)]
    fn stabilization<T: Real>(
        x: &Nodal<T, 4, 2>,
        q: &Nodal<T, 4, 2>,
        section: &Section<4>,
        own: &PerPoint<'_>,
        memory: &[f64],
    ) -> [[T; 2]; 2] {
        hourglass::energy::<Self, T, 2>(x, q, section, own, memory)
    }
}

impl Revolved<4, 0> for Q4r {
    /// Means over the ring of the gradient and of the hoop stretch: a uniform stress then has the
    /// exact nodal forces (Flanagan & Belytschko 1981).
    #[inline(always)]
    fn ring<T: Real>(x: &Nodal<T, 4, 2>, _: &[T; 2], _: &Point<4>) -> Sample<T, Hoop<T, 4>, 0> {
        let o = T::zero();
        let (mut grad, mut row, mut volume) = ([[o; 2]; 4], [o; 4], o);
        for [r, s, weight] in CORNERS {
            let (n, dn) = shapes::square_linear([r, s]);
            let (g, area) = shapes::gradients(x, &Point { xi: [r, s], weight, n, dn });
            let w = area * radius(x, &n);
            volume += w;
            for a in 0..4 {
                row[a] = area.fma(T::real(n[a]), row[a]);
                for j in 0..2 {
                    grad[a][j] = w.fma(g[a][j], grad[a][j]);
                }
            }
        }
        let inverse = volume.recip();
        for a in 0..4 {
            row[a] = row[a] * inverse;
            for j in 0..2 {
                grad[a][j] = grad[a][j] * inverse;
            }
        }
        Sample { op: Hoop { grad, row }, modes: [], weight: volume.scale(TAU) }
    }
    #[inline(always)]
    fn ring_into<T: Real>(
        x: &Nodal<T, 4, 2>,
        q: &Nodal<T, 4, 3>,
        section: &Section<4>,
        history: &mut History<'_>,
        tangent: bool,
        out: &mut Local<T, 4, 3>,
    ) {
        hourglass::local_into::<LocalRing<Self>, T, 3>(x, q, section, history, tangent, out);
    }
    #[inline(always)]
    fn ring_stabilization<T: Real>(
        x: &Nodal<T, 4, 2>,
        q: &Nodal<T, 4, 3>,
        section: &Section<4>,
        own: &PerPoint<'_>,
        memory: &[f64],
    ) -> [[T; 2]; 2] {
        hourglass::energy::<LocalRing<Self>, T, 3>(x, q, section, own, memory)
    }
}

/// Gauss's rule with two points a direction.
const GAUSS: f64 = 0.577_350_269_189_625_8;
const CORNERS: [[f64; 3]; 4] =
    [[-GAUSS, -GAUSS, 1.0], [GAUSS, -GAUSS, 1.0], [-GAUSS, GAUSS, 1.0], [GAUSS, GAUSS, 1.0]];
