//! Lines as surfaces: circles about nodes against curves with a constant distance to their surface.
//!
//! The surface of a truss or beam is everything at the distance `half` from its line, so its ends
//! are round. Each constraint is a circle (a slave node with half the height of its line, or none;
//! a corner, an end or a round of the master) against the faces of the other side (edges, pieces of
//! a rigid curve, lines with both of their sides): the gap is the distance of the center from the
//! face less both radii. Outside of a joint between two faces it is the distance from the joint,
//! without a kink.
//!
//! The side of a line that a circle is on is the one it had at the start of the increment. It
//! changes round a free end only, never through the line.
//!
//! With the arc length s on the face, the angle a of the normal and the rotations b and c of face
//! and circle, the slip grows by `ds + half (da - db) + radius (da - dc)`: the relative velocity of
//! the two points of the surfaces that are in contact. Rolling is no slip, and friction has a moment
//! about the line.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::chains::Chains;
use super::super::curve::{Edge, Vec2, dot, fixed, sub, times, unit, values};
use super::super::master::{Hit, Master, Surface};
use super::super::search::{Candidate, Item, each};
use super::super::sides::Sides;
use super::super::slave::Slave;
use super::super::terms::{Function, Share, Terms, WIDTH, join, lifted};
use super::super::travel::{Start, followed, near};
use super::node_to_segment::open;
use super::{Discretization, Entry};
use crate::base::Smooth;
use std::f64::consts::{PI, TAU};

pub const ENTRY: Entry = Entry {
    name: "line",
    joins: false,
    integrates: false,
    new: |sides, x| Box::new(Lines::new(sides, x)),
};

/// Most variables of a circle and a face.
const OWN: usize = 9;
/// Least turn of a boundary at a corner [rad]: 20 degrees. Blunter ones come in little between two
/// nodes.
const LEAST_TURN: f64 = 0.349_065_850_398_865_9;
/// Tilt of a face out of the cone of a corner with which the corner still meets it, and a further
/// one up to which it meets the face that it met before [rad].
const TILT: f64 = 0.35;
const KEPT: f64 = 0.175;
/// Largest radius of a round of the master, in edges of the slave, that is measured against them.
const ROUND: f64 = 3.0;
/// Part of the sagitta by which a round is deeper between the nodes of an edge than at them.
const BETWEEN: f64 = 0.01;
/// Part of the sagitta by which both nodes of a chord of a round may be off it: halfway to a tangent.
const DRAWN: f64 = 0.5;
/// Part of half a face by which a point without radius may pass its free end: rounding.
const HOLD: f64 = 1e-6;

/// What a circle is about.
#[derive(Clone, Copy, Debug)]
enum Center {
    Node(u32),
    /// End of a piece of a rigid curve.
    End(usize, usize),
    /// Center of an arc of a rigid curve.
    Arc(usize),
}

/// Directions in which a circle may meet faces.
#[derive(Clone, Copy, Debug)]
enum Cone {
    All,
    /// Counter-clockwise between the normals of the members that end and begin at a corner; where
    /// one is absent, up to the tangent at the other, or to its other side if it is a line.
    Corner(Option<usize>, Option<usize>, bool),
    /// From the first to the last of the pieces of an arc.
    Round(usize, usize),
}

#[derive(Clone, Copy, Debug)]
struct Circle {
    center: Center,
    radius: f64,
    cone: Cone,
}

/// A face that a circle meets: its number, and whether the circle is on its right.
type Met = (usize, bool);

/// How a circle meets a face.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    pair: usize,
    face: usize,
    right: bool,
    /// End of the face that is closest, or none if a point of the face or of its continuation is.
    end: Option<usize>,
    /// The side that it is on, for the next increment.
    next: bool,
    gap: f64,
    distance: f64,
    r: f64,
}

/// Circles of both sides against the faces of the other one.
pub struct Lines {
    /// Slave nodes, then corners and rounds of the master.
    circles: Vec<Circle>,
    n_nodes: usize,
    /// Slave node next to each circle at the start, by its place in the slave's nodes.
    nearest: Vec<usize>,
    /// A face of the side of each circle that it belongs to.
    beside: Vec<Option<usize>>,
    /// Faces: members of the master, then edges of the slave.
    faces: Surface,
    n_master: usize,
    half: Vec<f64>,
    both: Vec<bool>,
    chains: Chains,
    /// Rounds of the master and slave edges whose nodes both lie on them in the reference
    /// configuration: a rope drawn around a drum, whose chords are inside of it.
    chords: Vec<(usize, usize)>,
    /// Of each circle: the last evaluation, the side at the start of the increment, the last commit.
    seen: Vec<Option<Met>>,
    base: Vec<Option<Met>>,
    kept: Vec<Option<Met>>,
}

impl Lines {
    fn new(sides: &Sides, x: &[[f64; 3]]) -> Self {
        let (slave, faces) = (&sides.slave, &sides.master);
        let n_master = faces.len() - slave.edges.len();
        let of_face = |j: usize| faces.edge(j).and_then(|e| e.half);
        let half: Vec<f64> = (0..faces.len()).map(|j| of_face(j).unwrap_or(0.0)).collect();
        let both: Vec<bool> = (0..faces.len()).map(|j| of_face(j).is_some()).collect();
        let chains = Chains::new(faces, n_master, x);
        let mut circles: Vec<Circle> = slave
            .nodes
            .iter()
            .map(|&node| Circle {
                center: Center::Node(node),
                radius: radius(&slave.edges, node),
                cone: Cone::All,
            })
            .collect();
        let n_nodes = circles.len();
        if !slave.edges.is_empty() {
            circles.extend(features(faces, n_master, &chains, x, longest(&slave.edges, x)));
        }
        let nearest = circles
            .iter()
            .enumerate()
            .map(|(i, circle)| {
                if i < n_nodes {
                    return i;
                }
                let p = place(circle.center, faces, x);
                let square = |k: &usize| {
                    let q = x[slave.nodes[*k] as usize];
                    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)
                };
                (0..n_nodes)
                    .min_by(|a, b| square(a).total_cmp(&square(b)))
                    .expect("a slave has nodes")
            })
            .collect();
        let beside = circles
            .iter()
            .map(|circle| match circle.center {
                Center::Node(n) => {
                    let of_node = |e: &Edge| e.nodes().contains(&n);
                    slave.edges.iter().position(of_node).map(|i| n_master + i)
                }
                Center::End(j, _) | Center::Arc(j) => Some(j),
            })
            .collect();
        let n = circles.len();
        let chord = |i: usize, j: usize| {
            let (circle, edge) = (circles[i], faces.edge(j).expect("an edge of the slave"));
            let (p, width) = (place(circle.center, faces, x), circle.radius + half[j]);
            edge.nodes().iter().all(|&n| {
                let off = (x[n as usize][0] - p[0]).hypot(x[n as usize][1] - p[1]) - width;
                off.abs() < DRAWN * edge.length * edge.length / (8.0 * width)
            })
        };
        let chords = (n_nodes..n)
            .filter(|&i| matches!(circles[i].center, Center::Arc(_)))
            .flat_map(|i| (n_master..faces.len()).map(move |j| (i, j)))
            .filter(|&(i, j)| chord(i, j))
            .collect();
        Self {
            chords,
            circles,
            n_nodes,
            nearest,
            beside,
            faces: faces.clone(),
            n_master,
            half,
            both,
            chains,
            seen: vec![None; n],
            base: vec![None; n],
            kept: vec![None; n],
        }
    }

    fn center_variables(&self, faces: &Surface, i: usize) -> Vec<i64> {
        let circle = self.circles[i];
        match circle.center {
            Center::Node(n) => {
                let n = 3 * i64::from(n);
                if circle.radius > 0.0 { vec![n, n + 1, n + 2] } else { vec![n, n + 1] }
            }
            Center::End(j, _) | Center::Arc(j) => faces.variables(j),
        }
    }

    /// The side of a face that a circle had at the start of the increment, if it is known.
    fn side(&self, i: usize, face: usize) -> Option<bool> {
        let (j, right) = self.base[i]?;
        self.chains.same(j, face).then_some(right)
    }

    /// How a circle about `p` meets a face, if it is near.
    fn meet(
        &self,
        sides: &Sides,
        i: usize,
        face: usize,
        (p, shape): (Vec2<f64>, &Master<f64>),
        x: &[[f64; 3]],
    ) -> Option<Meeting> {
        let hit = shape.closest(p);
        if hit.gap.is_nan() {
            return None;
        }
        let both = self.both[face];
        let there = hit.gap >= 0.0;
        let right = if both { self.side(i, face).unwrap_or(there) } else { true };
        let away = if right { hit.gap } else { -hit.gap };
        let width = self.circles[i].radius + self.half[face];
        let size = shape.speed_at(hit.r);
        let beyond = (hit.r.abs() - 1.0) * size;
        let which = usize::from(hit.r > 0.0);
        let free = self.chains.free(face, which);
        let mut found = Meeting {
            pair: usize::MAX,
            face,
            right,
            end: None,
            next: right,
            gap: away - width,
            distance: away.abs(),
            r: hit.r,
        };
        if beyond > 0.0 {
            found.distance = away.hypot(beyond);
            if width > 0.0 && away > 0.0 {
                found.end = Some(which);
                found.gap = found.distance - width;
            }
            if free && beyond > (HOLD * size).max(if both { width } else { 0.0 }) {
                // It is beyond the end, on its way to the other side perhaps.
                found.next = there;
                found.end?;
            }
            // Over a joint the face goes on where its neighbor does not reach either.
            if !free && found.end.is_none() && self.covered(sides, (face, which), (p, x)) {
                return None;
            }
        }
        let near = found.gap <= sides.distances.reach && -away <= sides.distances.depth;
        near.then_some(found)
    }

    /// Whether the foot of a point beyond an end of a face is on the side of the joint where the
    /// neighbor is.
    fn covered(
        &self,
        sides: &Sides,
        (face, which): (usize, usize),
        (p, x): (Vec2<f64>, &[[f64; 3]]),
    ) -> bool {
        let (neighbor, sign) = match which {
            0 => (self.chains.previous(face), 1.0),
            _ => (self.chains.next(face), -1.0),
        };
        neighbor.is_some_and(|k| sign * sides.master.place(k, x).closest(p).r < 1.0)
    }

    /// The face that a circle meets: the closest one.
    fn choose(&self, sides: &Sides, i: usize, x: &[[f64; 3]]) -> Option<Meeting> {
        let p = place(self.circles[i].center, &sides.master, x);
        let mut best: Option<Meeting> = None;
        for pair in sides.of_item(i) {
            let face = sides.candidates()[pair].1;
            let shape = sides.master.place(face, x);
            let Some(found) = self.meet(sides, i, face, (p, &shape), x) else { continue };
            let closer = best.is_none_or(|b| {
                let same = 1e-9 * (b.distance + found.distance);
                found.distance < b.distance - same
                    // Of the two faces of a corner without radius, the one that has been passed.
                    || (found.distance <= b.distance + same && found.gap > b.gap)
            });
            if closer {
                best = Some(Meeting { pair, ..found });
            }
        }
        let best = best.filter(|b| b.gap <= sides.distances.reach)?;
        self.faces_it(sides, i, &best, p, x).then_some(best)
    }

    /// Whether a corner or a round of the master faces what it meets.
    fn faces_it(
        &self,
        sides: &Sides,
        i: usize,
        met: &Meeting,
        p: Vec2<f64>,
        x: &[[f64; 3]],
    ) -> bool {
        let cone = self.circles[i].cone;
        if matches!(cone, Cone::All) && i < self.n_nodes {
            return true;
        }
        let shape = sides.master.place(met.face, x);
        let towards = times(Self::normal(&shape, met, p), -1.0);
        let tilt = match cone {
            Cone::Corner(..) if self.seen[i].is_some_and(|s| s.0 == met.face) => TILT + KEPT,
            Cone::Corner(..) => TILT,
            _ => 0.0,
        };
        let inside = match Self::bounds(&sides.master, cone, x) {
            None => true,
            Some((middle, half)) => dot(towards, middle).clamp(-1.0, 1.0).acos() <= half + tilt,
        };
        inside
            && (!matches!(self.circles[i].center, Center::Arc(_))
                || self.between(sides, i, met, p, x))
    }

    /// Whether a round lies clearly deeper between the nodes of an edge than at them.
    fn between(
        &self,
        sides: &Sides,
        i: usize,
        met: &Meeting,
        p: Vec2<f64>,
        x: &[[f64; 3]],
    ) -> bool {
        let edge = sides.master.edge(met.face);
        let Some(edge) = edge.filter(|e| self.circles[i].radius <= ROUND * e.length) else {
            return false;
        };
        if self.chords.contains(&(i, met.face)) {
            return false;
        }
        let ends = edge.nodes().iter().map(|&n| x[n as usize]).map(|q| [q[0], q[1]]);
        let width = self.circles[i].radius + self.half[met.face];
        let closest = ends
            .map(|q| {
                let away = sub(q, p);
                dot(away, away).sqrt() - width
            })
            .fold(f64::INFINITY, f64::min);
        met.end.is_none()
            && met.r.abs() < 1.0
            && met.gap < closest - BETWEEN * edge.length * edge.length / (8.0 * width)
    }

    /// Middle and half angle of a cone, or none if it is all round.
    fn bounds(faces: &Surface, cone: Cone, x: &[[f64; 3]]) -> Option<(Vec2<f64>, f64)> {
        let normal = |j: usize, which: usize| end_normal(&faces.place(j, x), which);
        let (from, to) = match cone {
            Cone::All | Cone::Corner(None, None, _) => return None,
            Cone::Round(first, last) => (normal(first, 0), normal(last, 1)),
            Cone::Corner(Some(before), Some(behind), left) => {
                let (a, b) = (normal(before, 1), normal(behind, 0));
                if left { (times(b, -1.0), times(a, -1.0)) } else { (a, b) }
            }
            Cone::Corner(Some(before), None, line) => {
                let a = normal(before, 1);
                (a, if line { times(a, -1.0) } else { [-a[1], a[0]] })
            }
            Cone::Corner(None, Some(behind), line) => {
                let b = normal(behind, 0);
                (if line { times(b, -1.0) } else { [b[1], -b[0]] }, b)
            }
        };
        let turn = (from[0] * to[1] - from[1] * to[0]).atan2(dot(from, to));
        // A half turn has no sign of its own.
        let turn = if turn < -1e-9 { turn + 2.0 * PI } else { turn.abs() };
        let (s, c) = (0.5 * turn).sin_cos();
        Some(([from[0] * c - from[1] * s, from[0] * s + from[1] * c], 0.5 * turn))
    }

    /// Unit normal from a face to a circle.
    fn normal<T: Smooth>(shape: &Master<T>, met: &Meeting, p: Vec2<T>) -> Vec2<T> {
        if let Some(end) = met.end {
            return unit(sub(p, shape.end(end)));
        }
        let n = shape.normal(&shape.closest(p));
        if met.right { n } else { n.map(|c| c.scale(-1.0)) }
    }

    /// Old place of a circle on the faces of a chain: face, parameter and normal.
    fn before(&self, sides: &Sides, i: usize, face: usize, old: &[[f64; 3]]) -> Option<Meeting> {
        let p = place(self.circles[i].center, &sides.master, old);
        let closest = |faces: &mut dyn Iterator<Item = usize>| {
            faces
                .filter(|&j| self.chains.same(j, face))
                .filter_map(|j| {
                    let shape = sides.master.place(j, old);
                    let hit = shape.closest(p);
                    let beyond = (hit.r.abs() - 1.0).max(0.0) * shape.speed_at(hit.r);
                    let right = !self.both[j] || self.side(i, j).unwrap_or(hit.gap >= 0.0);
                    let width = self.circles[i].radius + self.half[j];
                    let away = if right { hit.gap } else { -hit.gap };
                    let capped = beyond > 0.0 && width > 0.0 && away > 0.0;
                    (!hit.gap.is_nan()).then(|| Meeting {
                        pair: usize::MAX,
                        face: j,
                        right,
                        end: capped.then_some(usize::from(hit.r > 0.0)),
                        next: right,
                        gap: away - width,
                        distance: hit.gap.hypot(beyond),
                        r: hit.r,
                    })
                })
                .min_by(|a, b| a.distance.total_cmp(&b.distance))
        };
        let near = &mut sides.of_item(i).map(|pair| sides.candidates()[pair].1);
        let found = closest(near);
        if found.is_some_and(|f| f.distance <= sides.distances.reach) {
            return found;
        }
        closest(&mut (0..sides.master.len()))
    }

    fn terms(
        &self,
        sides: &Sides,
        i: usize,
        met: &Meeting,
        x: &[[f64; 3]],
        start: Option<&Start>,
    ) -> Terms {
        let variables = self.variables(sides, (i, met.face));
        let v = lifted::<OWN>(&variables, x);
        let [own, other] =
            [self.center_variables(&sides.master, i).len(), sides.master.variables(met.face).len()];
        let [at, from] = if i < self.n_nodes { [0, own] } else { [other, 0] };
        let circle = self.circles[i];
        let (p, turned) = match circle.center {
            Center::Node(_) => {
                let turned = if own == 3 { v[at + 2] } else { Smooth::real(0.0) };
                ([v[at], v[at + 1]], turned)
            }
            Center::End(j, which) => {
                (sides.master.shape(j, &v[at..at + own]).end(which), Smooth::real(0.0))
            }
            Center::Arc(j) => {
                let turned = if own == 3 { v[at + 2] } else { Smooth::real(0.0) };
                (sides.master.shape(j, &v[at..at + own]).center(), turned)
            }
        };
        let shape = sides.master.shape(met.face, &v[from..from + other]);
        let width = Smooth::real(circle.radius + self.half[met.face]);
        let gap = if let Some(end) = met.end {
            let away = sub(p, shape.end(end));
            dot(away, away).sqrt() - width
        } else {
            let gap = shape.closest(p).gap;
            (if met.right { gap } else { -gap }) - width
        };
        let area = sides.slave.area[self.nearest[i]];
        let slip = start.and_then(|start| {
            let old = start.old();
            let before = self.before(sides, i, met.face, old)?;
            let spun = match circle.center {
                Center::Node(n) => old[n as usize][2],
                Center::Arc(_) if own == 3 => old[variables[at] as usize / 3][2],
                _ => 0.0,
            };
            let turn = turned - Smooth::real(spun);
            let base = if other == 3 { old[variables[from] as usize / 3][2] } else { 0.0 };
            let rigid = (other == 3).then(|| v[from + 2] - Smooth::real(base));
            Some(self.slip(sides, (i, met, &before), (p, turn), (&shape, rigid), (x, start)))
        });
        let share = Share {
            constraint: i,
            gap: (&open(gap, sides.offset[i], area)).into(),
            slip: slip.map_or_else(Function::none, |s| (&open(s, 0.0, area)).into()),
            area,
        };
        Terms { pair: met.pair, variables, shares: vec![share] }
    }

    /// Slip since the old configuration. Lengths are those at `x`: they are held in the force.
    fn slip<T: Smooth>(
        &self,
        sides: &Sides,
        (i, met, before): (usize, &Meeting, &Meeting),
        (p, turn): (Vec2<T>, T),
        (shape, rigid): (&Master<T>, Option<T>),
        (x, start): (&[[f64; 3]], &Start),
    ) -> T {
        let (faces, old) = (&sides.master, start.old());
        let then = faces.place(before.face, old);
        let q = place(self.circles[i].center, faces, old);
        let normal = Self::normal(shape, met, p);
        let first = Self::normal(&then, before, q);
        let tilt = angle(normal, first);
        // Rotation of the face where the circle meets it.
        let now_there = faces.place(met.face, old);
        let rotation = match (rigid, shape, &now_there) {
            (Some(rotation), ..) => rotation,
            (None, Master::Curve(c), Master::Curve(o)) => {
                let r = met.r.clamp(-1.0, 1.0);
                angle(c.slope(T::real(r)), o.slope(r))
            }
            _ => T::real(0.0),
        };
        // Angles are known up to whole turns.
        let whole = |a: T, other: f64| a + T::real(near(a.value(), other, TAU) - a.value());
        let [slave, master] = start.turned();
        let (own, other) = if i < self.n_nodes { (slave, master) } else { (master, slave) };
        let spins =
            [own.unwrap_or(turn.value()), other.unwrap_or_else(|| spin(faces, met.face, [x, old]))];
        let closed =
            [self.beside[i], Some(met.face)].map(|j| j.is_some_and(|j| self.chains.closed(j)));
        let tilt = whole(tilt, followed(spins, closed));
        let rotation = match rigid {
            Some(rotation) => rotation,
            None => whole(rotation, other.unwrap_or(tilt.value())),
        };
        let around = tilt.value() - rotation.value();
        let sign = if met.right { 1.0 } else { -1.0 };
        let (radius, half) = (self.circles[i].radius, self.half[met.face]);
        let along = match (shape, met.end) {
            (Master::Arc(a), None) => {
                (tilt - rotation).scale(a.signed_radius())
                    + T::real(self.jump(faces, (before, met), x, around))
            }
            (_, None) => {
                let hit = shape.closest(p);
                let speed = shape.speed_at(hit.r.value());
                (hit.r - T::real(hit.r.value())).scale(speed)
                    + T::real(self.chains.between(
                        faces,
                        (before.face, before.r),
                        (met.face, met.r),
                        x,
                        around,
                    ))
            }
            (_, Some(end)) => {
                let r = if end == 0 { -1.0 } else { 1.0 };
                let from = (before.face, before.r);
                T::real(self.chains.between(faces, from, (met.face, r), x, around))
            }
        };
        -along.scale(sign) - (tilt - rotation).scale(half) - (tilt - turn).scale(radius)
    }

    /// Way along the chain that the turn of the normal about an arc does not count.
    fn jump(
        &self,
        faces: &Surface,
        (before, met): (&Meeting, &Meeting),
        x: &[[f64; 3]],
        turn: f64,
    ) -> f64 {
        let Master::Arc(a) = faces.place(met.face, x) else { return 0.0 };
        match faces.place(before.face, x) {
            Master::Arc(b) if b.same_circle(&a) && turn.abs() <= PI => 0.0,
            _ => {
                let from = (before.face, before.r);
                self.chains.between(faces, from, (met.face, met.r), x, turn)
                    - turn * a.signed_radius()
            }
        }
    }
}

/// Angle from a constant direction to one with derivatives.
fn angle<T: Smooth>(a: Vec2<T>, from: Vec2<f64>) -> T {
    let plain = values(a);
    let value = (from[0] * plain[1] - from[1] * plain[0]).atan2(dot(from, plain));
    // About its own value the angle is the quotient, to second order.
    let along: Vec2<T> = fixed(unit(plain));
    T::real(value) + dot(a, [-along[1], along[0]]) / dot(a, along)
}

/// Rotation since of the nodes of a face.
fn spin(faces: &Surface, face: usize, [x, old]: [&[[f64; 3]]; 2]) -> f64 {
    let Some(edge) = faces.edge(face) else { return 0.0 };
    let turn = |&n: &u32| x[n as usize][2] - old[n as usize][2];
    0.5 * edge.nodes[..2].iter().map(turn).sum::<f64>()
}

fn place(center: Center, faces: &Surface, x: &[[f64; 3]]) -> Vec2<f64> {
    match center {
        Center::Node(n) => [x[n as usize][0], x[n as usize][1]],
        Center::End(j, which) => faces.place(j, x).end(which),
        Center::Arc(j) => faces.place(j, x).center(),
    }
}

/// Outward normal of a member at one of its ends.
fn end_normal(member: &Master<f64>, which: usize) -> Vec2<f64> {
    let r = if which == 0 { -1.0 } else { 1.0 };
    member.normal(&Hit { gap: 0.0, r, point: member.end(which) })
}

/// Half the height of the lines at a node.
fn radius(edges: &[Edge], node: u32) -> f64 {
    edges.iter().filter(|e| e.nodes().contains(&node)).filter_map(|e| e.half).fold(0.0, f64::max)
}

fn longest(edges: &[Edge], x: &[[f64; 3]]) -> f64 {
    let length = |e: &Edge| {
        let d = e.place(x).d;
        2.0 * d[0].hypot(d[1])
    };
    edges.iter().map(length).fold(0.0, f64::max)
}

/// Corners, ends and rounds of the master.
fn features(
    faces: &Surface,
    n_master: usize,
    chains: &Chains,
    x: &[[f64; 3]],
    longest: f64,
) -> Vec<Circle> {
    let mut out = Vec::new();
    for j in 0..n_master {
        let half = faces.edge(j).and_then(|e| e.half);
        let center = |which: usize| match faces.edge(j) {
            Some(e) => Center::Node(e.nodes[which]),
            None => Center::End(j, which),
        };
        let mut put = |center: Center, cone: Cone| {
            out.push(Circle { center, radius: half.unwrap_or(0.0), cone });
        };
        let round = matches!(faces.place(j, x), Master::Arc(_));
        if chains.free(j, 0) && !round {
            put(center(0), Cone::Corner(None, Some(j), half.is_some()));
        }
        if chains.free(j, 1) && !round {
            put(center(1), Cone::Corner(Some(j), None, half.is_some()));
        }
        if let Some(behind) = chains.next(j) {
            let (a, b) =
                (end_normal(&faces.place(j, x), 1), end_normal(&faces.place(behind, x), 0));
            let turn = (a[0] * b[1] - a[1] * b[0]).atan2(dot(a, b));
            if turn > LEAST_TURN || (half.is_some() && turn < -LEAST_TURN) {
                put(center(1), Cone::Corner(Some(j), Some(behind), turn < 0.0));
            }
        }
        if let Master::Arc(a) = faces.place(j, x)
            && a.signed_radius() > 0.0
            && a.signed_radius() <= ROUND * longest
        {
            // The pieces of an arc are one round.
            let follows =
                |k: usize| matches!(faces.place(k, x), Master::Arc(b) if b.same_circle(&a));
            let first = chains.previous(j).is_none_or(|k| !follows(k) || k >= j);
            if first {
                let (mut last, mut turn) = (j, a.sweep());
                while let Some(k) = chains.next(last).filter(|&k| k > last && follows(k)) {
                    (last, turn) = (k, turn + a.sweep());
                }
                let cone = if turn > 2.0 * PI - 1e-6 { Cone::All } else { Cone::Round(j, last) };
                out.push(Circle { center: Center::Arc(j), radius: a.signed_radius(), cone });
            }
        }
    }
    out
}

impl Discretization for Lines {
    fn items(&self, _: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
        let item = |circle: &Circle| {
            let p = place(circle.center, &self.faces, x);
            ([p[0], p[1], p[0], p[1]], [0.0, 0.0])
        };
        self.circles.iter().map(item).collect()
    }

    fn owners(&self, _: &Slave) -> Vec<Vec<usize>> {
        vec![Vec::new(); self.circles.len()]
    }

    fn places(&self, _: &Slave) -> Vec<usize> {
        self.nearest.clone()
    }

    fn corners(&self) -> Vec<i64> {
        let node = |c: &Circle| match c.center {
            Center::Node(n) => i64::from(n),
            _ => -1,
        };
        self.circles[self.n_nodes..].iter().map(node).collect()
    }

    fn allows(&self, i: usize, j: usize) -> bool {
        let own = match self.circles[i].center {
            Center::Node(n) => self.faces.edge(j).is_some_and(|e| e.nodes().contains(&n)),
            _ => false,
        };
        (i < self.n_nodes) == (j < self.n_master) && !own
    }

    fn variables(&self, sides: &Sides, (i, j): Candidate) -> [i64; WIDTH] {
        let (own, other) = (self.center_variables(&sides.master, i), sides.master.variables(j));
        if i < self.n_nodes { join(&own, &other) } else { join(&other, &own) }
    }

    fn constraints(&self, _: &Sides, (i, _): Candidate) -> [usize; 3] {
        [i, usize::MAX, usize::MAX]
    }

    fn has_stations(&self) -> bool {
        false
    }

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], start: Option<&Start>) -> Vec<Terms> {
        let found = each(sides.n_items(), |i| self.choose(sides, i, x));
        for (i, met) in found.iter().enumerate() {
            self.seen[i] = met.map(|m| (m.face, m.next));
            self.base[i] = self.base[i].or(self.seen[i]);
        }
        let met: Vec<(usize, Meeting)> =
            found.iter().enumerate().filter_map(|(i, m)| m.map(|m| (i, m))).collect();
        each(met.len(), |k| self.terms(sides, met[k].0, &met[k].1, x, start))
    }

    fn commit(&mut self) {
        self.kept.clone_from(&self.seen);
        self.base.clone_from(&self.seen);
    }

    fn restore(&mut self) {
        self.seen.clone_from(&self.kept);
        self.base.clone_from(&self.kept);
    }

    fn memory(&self) -> Vec<i64> {
        let numbers = |met: &Option<Met>| match met {
            Some((j, right)) => [*j as i64, if *right { 0 } else { -1 }],
            None => [-1, -1],
        };
        [&self.seen, &self.base, &self.kept].into_iter().flatten().flat_map(numbers).collect()
    }

    fn remember(&mut self, memory: &[i64]) {
        let (pairs, _) = memory.as_chunks::<2>();
        let n = self.circles.len();
        let met = |p: &[i64; 2]| usize::try_from(p[0]).ok().map(|j| (j, p[1] == 0));
        let list = |from: usize| pairs[from * n..(from + 1) * n].iter().map(met).collect();
        (self.seen, self.base, self.kept) = (list(0), list(1), list(2));
    }
}
