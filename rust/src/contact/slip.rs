//! The direction of slip: what a shear traction does its work on.
//!
//! At a pairing the two material points have the tangential distance `t . (x_m - x_s)`. Its
//! derivative at fixed places on both surfaces is the relative tangential velocity; the force of a
//! traction is its conjugate. Nothing else enters the force: places, limits and weights move in its
//! linearization alone. The tangent turns with the surface it belongs to, so that forces have no
//! moment across a gap.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Curve, Vec2, add, dot, outward, sub, times};
use super::master::{Arc, Hit, Master};
use crate::base::{Dual, Hyper, Smooth};

/// A number with its first derivatives.
pub fn first<const D: usize>(x: &Hyper<D>) -> Dual<D> {
    Dual { v: x.v, d: x.d }
}

/// The same of a vector.
pub fn firsts<const D: usize>(x: &Vec2<Hyper<D>>) -> Vec2<Dual<D>> {
    [first(&x[0]), first(&x[1])]
}

/// Derivative of a vector by a variable, with its first derivatives.
fn by<const D: usize>(x: &Vec2<Hyper<D>>, v: usize) -> Vec2<Dual<D>> {
    [Dual { v: x[0].d[v], d: x[0].h[v] }, Dual { v: x[1].d[v], d: x[1].h[v] }]
}

/// A point that stays with the material, at a place that moves.
pub enum Point<'a, const D: usize> {
    Node(Vec2<Hyper<D>>),
    /// At a parameter of a curve, or of its continuation.
    Curve(&'a Curve<Hyper<D>>, Dual<D>),
    /// Of an arc, in the frame of its body, with the tangent there.
    Arc(&'a Arc<Hyper<D>>, Vec2<Dual<D>>, Vec2<Dual<D>>),
}

impl<'a, const D: usize> Point<'a, D> {
    /// Where a master is met.
    pub fn of(master: &'a Master<Hyper<D>>, hit: &Hit<Hyper<D>>) -> Self {
        match master {
            Master::Curve(c) => Self::Curve(c, first(&hit.r)),
            Master::Arc(arc) => {
                let place = firsts(&arc.frame.back(hit.point));
                let arm = sub(place, firsts(&arc.frame.back(arc.center)));
                Self::Arc(arc, place, times(outward(arm), Dual::real(-arc.half.signum())))
            }
        }
    }

    /// Derivative with respect to the place along the surface.
    fn slope(&self) -> Vec2<Dual<D>> {
        match self {
            Self::Node(_) => unreachable!("a node has no tangent"),
            Self::Curve(c, _) if c.straight => firsts(&c.d),
            Self::Curve(c, r) => sub(firsts(&c.d), times(firsts(&c.b), inside(*r).scale(2.0))),
            Self::Arc(a, _, q) => {
                let (c, s) = (first(&a.frame.cos), first(&a.frame.sin));
                [q[0] * c - q[1] * s, q[0] * s + q[1] * c]
            }
        }
    }

    /// Derivatives of position and slope by a variable.
    fn by(&self, v: usize) -> [Vec2<Dual<D>>; 2] {
        match self {
            Self::Node(p) => [by(p, v), [Dual::real(0.0); 2]],
            Self::Curve(c, r) => {
                let (m, d) = (by(&c.m, v), by(&c.d, v));
                if c.straight {
                    return [add(m, times(d, *r)), d];
                }
                let (e, b) = (inside(*r), by(&c.b, v));
                let slope = sub(d, times(b, e.scale(2.0)));
                let at = add(add(m, times(d, e)), times(b, Dual::real(1.0) - e * e));
                [add(at, times(slope, *r - e)), slope]
            }
            Self::Arc(a, p, q) => {
                let turn = [a.frame.cos, a.frame.sin];
                let [c, s] = by(&turn, v);
                let out = |p: &Vec2<Dual<D>>| [p[0] * c - p[1] * s, p[0] * s + p[1] * c];
                [add(by(&a.frame.origin, v), out(p)), out(q)]
            }
        }
    }
}

/// A parameter, or that of the end beyond which it is.
fn inside<const D: usize>(r: Dual<D>) -> Dual<D> {
    if r.v.abs() <= 1.0 { r } else { Dual::real(r.v.signum()) }
}

/// The surface whose tangent counts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Along {
    Slave,
    Master,
}

/// Rate of slip by each variable: the slave against the master along the slave's way; `apart` is
/// from the slave's point to the master's.
pub fn direction<const D: usize>(
    slave: &Point<'_, D>,
    master: &Point<'_, D>,
    along: Along,
    apart: Vec2<Dual<D>>,
) -> [Dual<D>; D] {
    // Master and slave run against each other.
    let (side, sign) = if along == Along::Slave { (slave, 1.0) } else { (master, -1.0) };
    let slope = side.slope();
    let length = dot(slope, slope).sqrt();
    let t = slope.map(|c| c.scale(sign) / length);
    let n = outward(t);
    let lever = dot(apart, n).scale(sign) / length;
    std::array::from_fn(|v| {
        let (s, m) = (slave.by(v), master.by(v));
        let turned = if along == Along::Slave { s[1] } else { m[1] };
        dot(t, sub(s[0], m[0])) - lever * dot(n, turned)
    })
}
