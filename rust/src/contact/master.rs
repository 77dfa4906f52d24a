//! What a slave point is measured against: element edges, and lines and arcs of a rigid body.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Curve, Edge, Shape, Vec2, add, dot, fixed, outward, sub, times, unit, values};
use crate::base::Smooth;
use std::f64::consts::PI;

/// Turn beyond an end [rad] up to which the end is the foremost point of a round: beside a flat
/// that it touches rounding must not choose.
const BEYOND: f64 = 0.17;

/// Place and turn of a rigid body.
#[derive(Clone, Copy, Debug)]
pub struct Frame<T> {
    pub(super) origin: Vec2<T>,
    pub(super) cos: T,
    pub(super) sin: T,
}

impl<T: Smooth> Frame<T> {
    fn new(x: T, y: T, angle: T) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { origin: [x, y], cos, sin }
    }

    fn out(&self, p: Vec2<T>) -> Vec2<T> {
        let (c, s) = (self.cos, self.sin);
        add(self.origin, [p[0] * c - p[1] * s, p[0] * s + p[1] * c])
    }

    pub(super) fn back(&self, p: Vec2<T>) -> Vec2<T> {
        let (c, s, q) = (self.cos, self.sin, sub(p, self.origin));
        [q[0] * c + q[1] * s, q[1] * c - q[0] * s]
    }

    fn lift(frame: Frame<f64>) -> Self {
        let (cos, sin) = (T::real(frame.cos), T::real(frame.sin));
        Self { origin: fixed(frame.origin), cos, sin }
    }
}

/// A line or an arc of at most a sixth of a turn, in the frame of its body.
#[derive(Clone, Debug)]
pub enum Piece {
    Line(Vec2<f64>, Vec2<f64>),
    /// Center, radius, first angle, sweep: counter-clockwise for solid, clockwise for hollow.
    Arc(Vec2<f64>, f64, f64, f64),
}

/// A chain of lines and arcs that moves with a node or stands still; body on the left.
#[derive(Clone, Debug)]
pub struct Rigid {
    pieces: Vec<Piece>,
    pub(super) node: Option<u32>,
    /// Whether the rotation of the node turns it; else it moves along only.
    pub(super) turns: bool,
    point: Vec2<f64>,
    /// Whether it is one line or one arc.
    single: bool,
}

impl Rigid {
    /// From rows `x0 y0 x1 y1 cx cy sweep` in the reference configuration; arcs are cut into
    /// pieces of at most 30 degrees.
    pub fn new(
        rows: &[[f64; 7]],
        (node, turns): (Option<u32>, bool),
        point: Vec2<f64>,
    ) -> Result<Self, String> {
        let mut pieces = Vec::new();
        for (i, &[x0, y0, x1, y1, cx, cy, sweep]) in rows.iter().enumerate() {
            let first = sub([x0, y0], point);
            if sweep == 0.0 {
                let last = sub([x1, y1], point);
                let way = sub(last, first);
                if dot(way, way) <= 0.0 {
                    return Err(format!("segment {i} of the rigid curve has no length"));
                }
                pieces.push(Piece::Line(first, last));
                continue;
            }
            let center = sub([cx, cy], point);
            let arm = sub(first, center);
            let radius = dot(arm, arm).sqrt();
            if radius.is_nan() || radius <= 0.0 || sweep.abs() > 2.0 * PI + 1e-9 {
                return Err(format!(
                    "segment {i} of the rigid curve: an arc needs a radius and at most one turn"
                ));
            }
            let n = (sweep.abs() / (PI / 6.0) - 1e-9).ceil().max(1.0);
            let (start, part) = (arm[1].atan2(arm[0]), sweep / n);
            for k in 0..n as usize {
                pieces.push(Piece::Arc(center, radius, start + part * k as f64, part));
            }
        }
        Ok(Self { pieces, node, turns, point, single: rows.len() == 1 })
    }

    /// Normal through a point of one line or arc, which motions across this normal leave as it is.
    pub(super) fn only_normal(&self, p: Vec2<f64>) -> Option<Vec2<f64>> {
        let across = match self.pieces[0] {
            Piece::Line(a, b) => outward(sub(b, a)),
            Piece::Arc(center, ..) => sub(sub(p, self.point), center),
        };
        self.single.then(|| times(across, across[0].hypot(across[1]).max(1e-300).recip()))
    }

    fn frame<T: Smooth>(&self, v: &[T]) -> Frame<T> {
        match v {
            [x, y, angle] => Frame::new(*x, *y, *angle),
            [x, y] => Frame { origin: [*x, *y], cos: T::real(1.0), sin: T::real(0.0) },
            _ => Frame::lift(Frame { origin: self.point, cos: 1.0, sin: 0.0 }),
        }
    }
}

/// An arc in space.
#[derive(Clone, Copy, Debug)]
pub struct Arc<T> {
    pub(super) center: Vec2<T>,
    radius: f64,
    ends: [Vec2<T>; 2],
    pub(super) half: f64,
    pub(super) frame: Frame<T>,
}

impl<T: Smooth> Arc<T> {
    /// Negative for a hollow arc, whose body is outside.
    pub fn signed_radius(&self) -> f64 {
        self.radius * self.half.signum()
    }

    /// Angle between the ends, counter-clockwise positive.
    pub fn sweep(&self) -> f64 {
        2.0 * self.half
    }

    /// Whether another arc is of the same circle, on the same side.
    pub fn same_circle(&self, other: &Self) -> bool {
        let d = sub(values(self.center), values(other.center));
        let same = 1e-9 * self.radius;
        dot(d, d).sqrt() <= same && (self.signed_radius() - other.signed_radius()).abs() <= same
    }
}

/// A master edge or piece in space.
#[derive(Clone, Copy, Debug)]
pub enum Master<T> {
    Curve(Curve<T>),
    Arc(Arc<T>),
}

/// Where a slave point meets the master.
#[derive(Clone, Copy, Debug)]
pub struct Hit<T> {
    /// Distance, positive if open.
    pub gap: T,
    /// Parameter on the master, -1 to 1 between its ends.
    pub r: T,
    pub point: Vec2<T>,
}

impl<T: Smooth> Master<T> {
    /// First or second end.
    pub fn end(&self, which: usize) -> Vec2<T> {
        match self {
            Self::Curve(c) => c.at(T::real(if which == 0 { -1.0 } else { 1.0 })),
            Self::Arc(a) => a.ends[which],
        }
    }

    /// Center of an arc; the middle of a curve.
    pub fn center(&self) -> Vec2<T> {
        match self {
            Self::Curve(c) => c.m,
            Self::Arc(a) => a.center,
        }
    }

    /// Where the ray from `p` along the unit normal `n`, across `t`, meets the master.
    pub fn ray(&self, p: Vec2<T>, t: Vec2<T>, n: Vec2<T>) -> Hit<T> {
        match self {
            Self::Curve(c) => {
                let r = c.crossing(p, t);
                let point = c.at(r);
                Hit { gap: dot(sub(point, p), n), r, point }
            }
            Self::Arc(a) => {
                let arm = sub(p, a.center);
                let along = dot(arm, n);
                let square = along * along - dot(arm, arm) + T::real(a.radius * a.radius);
                let gap = -along - square.sqrt().scale(a.half.signum());
                let point = add(p, times(n, gap));
                Hit { gap, r: a.parameter(point), point }
            }
        }
    }

    /// Point of the master, or of its continuation along the end tangents, closest to `p`.
    pub fn closest(&self, p: Vec2<T>) -> Hit<T> {
        match self {
            Self::Curve(c) => {
                let r = c.foot(p);
                let point = c.extended(r);
                let hit = Hit { gap: T::real(0.0), r, point };
                Hit { gap: dot(sub(p, point), self.normal(&hit)), ..hit }
            }
            Self::Arc(a) => {
                let arm = sub(p, a.center);
                let length = dot(arm, arm).sqrt();
                let gap = (length - T::real(a.radius)).scale(a.half.signum());
                let point = add(a.center, times(arm, T::real(a.radius) / length));
                Hit { gap, r: a.parameter(point), point }
            }
        }
    }

    /// Point of a convex master farthest against a unit normal: an end if the farthest point of
    /// its continuation is a little beyond, else on the continuation.
    pub fn foremost(&self, n: Vec2<T>) -> Hit<T> {
        let gap = T::real(0.0);
        let (r, point, over) = match self {
            Self::Curve(c) => {
                let r = dot(c.d, n) / dot(c.b, n).scale(2.0);
                (r, c.at(r), (r.value().abs() - 1.0) * PI)
            }
            Self::Arc(a) => {
                let point = sub(a.center, n.map(|c| c.scale(a.radius)));
                let r = a.parameter(point);
                (r, point, (r.value().abs() - 1.0) * a.half.abs())
            }
        };
        if over > 0.0 && over < BEYOND {
            let last = r.value() > 0.0;
            return Hit {
                gap,
                r: T::real(if last { 1.0 } else { -1.0 }),
                point: self.end(usize::from(last)),
            };
        }
        Hit { gap, r, point }
    }

    /// Outward unit normal at a point found before.
    pub fn normal(&self, hit: &Hit<T>) -> Vec2<T> {
        match self {
            Self::Curve(c) => {
                let r = hit.r.value();
                unit(outward(c.slope(if r.abs() > 1.0 { T::real(r.signum()) } else { hit.r })))
            }
            Self::Arc(a) => unit(sub(hit.point, a.center)).map(|c| c.scale(a.half.signum())),
        }
    }

    /// Length of the master for a unit of its parameter, near one.
    pub fn speed_at(&self, r: f64) -> f64 {
        match self {
            Self::Curve(c) => {
                let t = values(c.slope(T::real(r.clamp(-1.0, 1.0))));
                dot(t, t).sqrt()
            }
            Self::Arc(a) => a.radius * a.half.abs(),
        }
    }

    /// Way of a point at a distance for a unit of the parameter of its foot.
    pub fn way_beside(&self, r: f64, gap: f64) -> f64 {
        let speed = self.speed_at(r);
        match self {
            Self::Curve(c) if !c.straight && r.abs() <= 1.0 => {
                speed + 2.0 * gap * dot(self.normal_at(r), values(c.b)) / speed
            }
            Self::Curve(_) => speed,
            Self::Arc(a) => speed + gap * a.half,
        }
    }

    /// Outward unit normal at a parameter.
    pub fn normal_at(&self, r: f64) -> Vec2<f64> {
        match self {
            Self::Curve(c) => unit(outward(values(c.slope(T::real(r.clamp(-1.0, 1.0)))))),
            Self::Arc(a) => {
                let [p, q] = a.ends.map(|e| sub(values(e), values(a.center)));
                let ([c, s], (sin, cos)) = (unit(add(p, q)), (r * a.half).sin_cos());
                [c * cos - s * sin, s * cos + c * sin].map(|v| v * a.half.signum())
            }
        }
    }
}

impl<T: Smooth> Arc<T> {
    /// Angle from the middle over half the sweep; used for limits, so without derivatives.
    fn parameter(&self, point: Vec2<T>) -> T {
        let arm = sub(values(point), values(self.center));
        let [p, q] = self.ends.map(|e| sub(values(e), values(self.center)));
        let middle = [p[0] + q[0], p[1] + q[1]];
        let angle = (middle[0] * arm[1] - middle[1] * arm[0]).atan2(dot(middle, arm));
        T::real(angle / self.half)
    }
}

/// The master side of a pair.
#[derive(Clone, Debug)]
pub enum Surface {
    Edges(Vec<Edge>),
    Rigid(Rigid),
    /// A surface, then more edges.
    Both(Box<Surface>, Vec<Edge>),
}

impl Surface {
    pub fn len(&self) -> usize {
        match self {
            Self::Edges(edges) => edges.len(),
            Self::Rigid(rigid) => rigid.pieces.len(),
            Self::Both(first, edges) => first.len() + edges.len(),
        }
    }

    /// Member `j`, if it is an edge of the mesh.
    pub fn edge(&self, j: usize) -> Option<&Edge> {
        match self {
            Self::Edges(edges) => edges.get(j),
            Self::Rigid(_) => None,
            Self::Both(first, _) if j < first.len() => first.edge(j),
            Self::Both(first, edges) => edges.get(j - first.len()),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The rigid body, if the members of the master are its.
    pub fn rigid(&self) -> Option<&Rigid> {
        match self {
            Self::Edges(_) => None,
            Self::Rigid(rigid) => Some(rigid),
            Self::Both(first, _) => first.rigid(),
        }
    }

    pub fn variables(&self, j: usize) -> Vec<i64> {
        match self {
            Self::Edges(edges) => edges[j].variables(),
            Self::Both(first, _) if j < first.len() => first.variables(j),
            Self::Both(first, edges) => edges[j - first.len()].variables(),
            Self::Rigid(Rigid { node: Some(n), turns, .. }) => {
                (0..2 + i64::from(*turns)).map(|c| 3 * i64::from(*n) + c).collect()
            }
            Self::Rigid(_) => Vec::new(),
        }
    }

    /// Member `j` at given values of its variables.
    pub fn shape<T: Smooth>(&self, j: usize, v: &[T]) -> Master<T> {
        match self {
            Self::Edges(edges) => Master::Curve(edges[j].curve(v)),
            Self::Both(first, _) if j < first.len() => first.shape(j, v),
            Self::Both(first, edges) => Master::Curve(edges[j - first.len()].curve(v)),
            Self::Rigid(rigid) => {
                let frame = rigid.frame(v);
                match rigid.pieces[j] {
                    Piece::Line(p, q) => {
                        Master::Curve(Curve::line(frame.out(fixed(p)), frame.out(fixed(q))))
                    }
                    Piece::Arc(center, radius, start, sweep) => {
                        let end = |angle: f64| {
                            let (s, c) = angle.sin_cos();
                            frame.out(fixed([center[0] + radius * c, center[1] + radius * s]))
                        };
                        Master::Arc(Arc {
                            center: frame.out(fixed(center)),
                            radius,
                            ends: [end(start), end(start + sweep)],
                            half: 0.5 * sweep,
                            frame,
                        })
                    }
                }
            }
        }
    }

    /// Curvature of a member, positive if it is convex.
    pub fn curvature(&self, j: usize, x: &[[f64; 3]]) -> f64 {
        match self.place(j, x) {
            Master::Arc(a) => a.signed_radius().recip(),
            Master::Curve(c) => 2.0 * dot(c.b, unit(outward(c.d))) / dot(c.d, c.d),
        }
    }

    /// Radius of a convex round member; infinite for others.
    pub fn radius(&self, j: usize, x: &[[f64; 3]]) -> f64 {
        match (self, self.place(j, x)) {
            (Self::Rigid(_), Master::Arc(a)) if a.half > 0.0 => a.radius,
            (Self::Edges(edges), Master::Curve(c)) if edges[j].shape == Shape::Spline => {
                let height = dot(c.b, unit(outward(c.d)));
                if height > 0.0 { 0.5 * dot(c.d, c.d) / height } else { f64::INFINITY }
            }
            _ => f64::INFINITY,
        }
    }

    /// Member `j` at positions and rotations of all nodes.
    pub fn place(&self, j: usize, x: &[[f64; 3]]) -> Master<f64> {
        match self {
            Self::Edges(edges) => Master::Curve(edges[j].place(x)),
            Self::Both(first, _) if j < first.len() => first.place(j, x),
            Self::Both(first, edges) => Master::Curve(edges[j - first.len()].place(x)),
            Self::Rigid(rigid) => match rigid.node {
                Some(n) => self.shape(j, &x[n as usize][..2 + usize::from(rigid.turns)]),
                None => self.shape(j, &[]),
            },
        }
    }
}

/// Smallest box around a curve: its corners and the point where the end tangents meet.
pub fn curve_box(c: &Curve<f64>) -> [f64; 4] {
    let tip = add(c.m, c.b.map(|b| 2.0 * b));
    hull(&[c.at(-1.0), c.at(1.0), tip])
}

/// Box around a member of the master.
pub fn master_box(master: &Master<f64>) -> [f64; 4] {
    match master {
        Master::Curve(c) => curve_box(c),
        Master::Arc(a) => {
            let middle = unit(sub(add(a.ends[0], a.ends[1]), a.center.map(|c| 2.0 * c)));
            let tip = add(a.center, times(middle, a.radius / a.half.cos()));
            hull(&[a.ends[0], a.ends[1], tip])
        }
    }
}

/// Box around points.
pub(super) fn hull(points: &[Vec2<f64>]) -> [f64; 4] {
    let mut b = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for p in points {
        for i in 0..2 {
            b[i] = b[i].min(p[i]);
            b[i + 2] = b[i + 2].max(p[i]);
        }
    }
    b
}
