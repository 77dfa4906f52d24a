//! Slip over an increment: how far the place of contact went along both surfaces.
//!
//! With arc lengths a along the slave and m along the master, which run against each other, two
//! surfaces that stick or roll keep a + m. The slip of two points that are opposite now is therefore
//! the change of a + m since the place where their surfaces touched when the increment began: the
//! same slave point if it was closed or overlapped, or that towards which the gap falls along the slave,
//! from which contact has rolled or slid: surfaces that were apart touched there first. Where the gap
//! falls by no more than the height of a chord, the place that was opposite. Lengths are those at the
//! beginning, with which surfaces are laid on each other. The motion enters through the pairing alone,
//! so that no rotation gives slip, and a path round a drum or a corner counts in full. Positions show no
//! whole turns: those of a body round which a path closes are those of a node that turns with it, if
//! there is one.
// SPDX-License-Identifier: BSD-3-Clause

use super::boundary::{Boundary, followers};
use super::curve::{Vec2, outward, unit};
use super::master::{Master, Surface};
use super::search::Search;
use super::sides::Sides;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Difference of two gaps, in edges, that is rounding.
const EQUAL: f64 = 1e-9;
/// Distance of two stations, in slave edges, between which the gap is known.
const NEXT: f64 = 1.01;

/// Where slave points faced a master when the increment began.
#[derive(Clone, Debug)]
pub struct Station {
    /// Constraint that measures there, if it is that of one point.
    pub point: Option<usize>,
    /// Whether the point is a corner.
    pub corner: bool,
    /// Slave edge, and its parameters between which the master is opposite.
    pub edge: usize,
    pub span: [f64; 2],
    pub master: usize,
    /// Parameters of the master opposite to both.
    pub opposite: [f64; 2],
    pub gap: f64,
    pub closed: bool,
}

/// A place of contact: arc lengths on both sides, and direction of the master there.
#[derive(Clone, Copy, Debug)]
struct Place {
    a: f64,
    m: f64,
    heading: f64,
}

/// Both sides when the increment began.
#[derive(Default)]
pub struct Start {
    x: Vec<[f64; 3]>,
    /// Where the sides were, for discretizations without stations.
    old: Vec<[f64; 3]>,
    closed: Vec<bool>,
    /// Whether nothing has moved since.
    still: bool,
    /// Nodes whose rotations are those of the slave's and the master's body.
    pub(super) carriers: [Option<u32>; 2],
    /// Rotations since of both bodies, where they are known.
    turned: [Option<f64>; 2],
    next: Option<[Vec<Option<usize>>; 2]>,
    sides: Option<[Boundary; 2]>,
    /// By connected parts of both sides, in the order of the slave's arc length.
    stations: HashMap<(usize, usize), Vec<Station>>,
    /// Those of corners and of closed nodes, by their constraints.
    points: HashMap<usize, Station>,
    pub(super) search: Search,
}

impl Start {
    /// Whether the sides have to be looked at again for a beginning; takes where they are.
    pub fn begin(
        &mut self,
        sides: &Sides,
        old: &[[f64; 3]],
        closed: &[bool],
        x: &[[f64; 3]],
    ) -> bool {
        self.still = x == old;
        self.turn(sides, old, x);
        if self.still || (self.sides.is_some() && self.x == old && self.closed == closed) {
            return false;
        }
        self.x = old.to_vec();
        self.closed = closed.to_vec();
        let slave = Surface::Edges(sides.slave.edges.clone());
        let next = self
            .next
            .get_or_insert_with(|| [followers(&slave, old), followers(&sides.master, old)]);
        self.sides = Some([
            Boundary::new(&slave, old, &next[0]),
            Boundary::new(&sides.master, old, &next[1]),
        ]);
        true
    }

    /// Takes how far the bodies of both sides have turned.
    fn turn(&mut self, sides: &Sides, old: &[[f64; 3]], x: &[[f64; 3]]) {
        let rotation = |node: u32| x[node as usize][2] - old[node as usize][2];
        self.turned = self.carriers.map(|node| node.map(rotation));
        if let Some(rigid) = sides.master.rigid() {
            self.turned[1] = Some(rigid.node.filter(|_| rigid.turns).map_or(0.0, rotation));
        }
    }

    /// Rotations of the bodies of slave and master, where they are known.
    pub fn turned(&self) -> [Option<f64>; 2] {
        self.turned
    }

    /// Takes where the sides were, where no station is needed.
    pub fn hold(&mut self, sides: &Sides, old: &[[f64; 3]], x: &[[f64; 3]]) {
        self.turn(sides, old, x);
        self.old.clear();
        self.old.extend_from_slice(old);
    }

    /// Where the sides were: see [`Start::hold`].
    pub fn old(&self) -> &[[f64; 3]] {
        &self.old
    }

    /// Takes the stations of all constraints.
    pub fn take(&mut self, found: Vec<Station>) {
        let [slave, master] = self.sides.as_ref().expect("sides of the beginning");
        self.stations.clear();
        self.points.clear();
        for s in found {
            if let Some(own) = s.point.filter(|_| s.corner || s.closed) {
                self.points.insert(own, s.clone());
            }
            if s.corner && !s.closed {
                continue;
            }
            let key = (slave.part[s.edge], master.part[s.master]);
            self.stations.entry(key).or_default().push(s);
        }
        let at = |s: &Station| slave.at(s.edge, 0.5 * (s.span[0] + s.span[1]));
        for list in self.stations.values_mut() {
            list.sort_by(|p, q| at(p).total_cmp(&at(q)));
        }
    }

    pub fn closed(&self, constraint: usize) -> bool {
        self.closed.get(constraint).copied().unwrap_or(false)
    }

    /// Length of a side for a unit of its parameter when the increment began: that of the slave, or
    /// of the master.
    fn speed(&self, side: usize, member: usize, r: f64) -> f64 {
        self.sides.as_ref().map_or(1.0, |s| s[side].members[member].speed_at(r))
    }

    /// Stretch since of a member of the slave, or of the master, at a parameter.
    pub fn stretch(&self, of_master: bool, member: usize, r: f64, speed: f64) -> f64 {
        if self.still { 1.0 } else { speed / self.speed(usize::from(of_master), member, r) }
    }

    /// Slip of a place of a slave edge and a place of a master with a normal, that are opposite now;
    /// `point` is the constraint, if it is that of one point.
    pub fn slip(
        &self,
        (edge, xi): (usize, f64),
        (member, r): (usize, f64),
        normal: Vec2<f64>,
        point: Option<usize>,
    ) -> f64 {
        if self.still {
            return 0.0;
        }
        let [slave, master] = self.sides.as_ref().expect("sides of the beginning");
        let parts = (slave.part[edge], master.part[member]);
        let now = Place { a: slave.at(edge, xi), m: master.at(member, r), heading: angle(normal) };
        let own = point.and_then(|k| self.points.get(&k));
        let own = own.filter(|s| (slave.part[s.edge], master.part[s.master]) == parts);
        let then = match (own, self.stations.get(&parts)) {
            (Some(s), _) => self.place(s, s.span[0]),
            (None, Some(list)) => self.origin(list, parts.0, (edge, xi, now.a)),
            (None, None) => return 0.0,
        };
        let closed = [slave.round(parts.0), master.round(parts.1)].map(f64::is_finite);
        let followed = followed(self.turned.map(|turn| turn.unwrap_or(0.0)), closed);
        let heading = near(now.heading - then.heading, followed, TAU);
        let turn = |side: usize| self.turned[side].map_or(0.0, |turn| heading - turn);
        -(slave.way(parts.0, then.a, now.a, turn(0)) + master.way(parts.1, then.m, now.m, turn(1)))
    }

    /// Where the surfaces touched from which a slave point came.
    fn origin(&self, list: &[Station], part: usize, (edge, xi, a): (usize, f64, f64)) -> Place {
        let [slave, master] = self.sides.as_ref().expect("sides of the beginning");
        let n = list.len();
        let ends = |s: &Station| s.span.map(|r| slave.at(s.edge, r));
        let outside = |s: &Station| {
            let [low, high] = ends(s).map(|e| slave.way(part, e, a, 0.0));
            if low >= 0.0 && high <= 0.0 { 0.0 } else { low.abs().min(high.abs()) }
        };
        let after = list.partition_point(|s| ends(s)[0] <= a);
        let near = [n - 1, 0, after.wrapping_sub(2), after.wrapping_sub(1), after, after + 1];
        let mut at = near
            .into_iter()
            .filter(|&i| i < n)
            .min_by(|&i, &j| {
                let key = |i: usize| (outside(&list[i]), list[i].gap);
                let (p, q) = (key(i), key(j));
                p.0.total_cmp(&q.0).then(p.1.total_cmp(&q.1))
            })
            .expect("a list of stations");
        let begun = at;
        let step = slave.longest();
        let rank = |i: usize| if list[i].closed { f64::NEG_INFINITY } else { list[i].gap.max(0.0) };
        let mut last = at;
        for _ in 0..n {
            let round = slave.round(part).is_finite();
            let beside = |up: bool| {
                let i = match (up, round) {
                    (true, true) => (at + 1) % n,
                    (false, true) => (at + n - 1) % n,
                    (true, false) => at + 1,
                    (false, false) => at.wrapping_sub(1),
                };
                (i < n && i != at).then_some(i).filter(|&i| {
                    let (p, q) = if up { (at, i) } else { (i, at) };
                    slave.way(part, ends(&list[p])[1], ends(&list[q])[0], 0.0).abs() <= NEXT * step
                })
            };
            let lower = [beside(false), beside(true)]
                .into_iter()
                .flatten()
                .min_by(|&i, &j| rank(i).total_cmp(&rank(j)));
            match lower {
                Some(i) if rank(i) < rank(at) - EQUAL * step => (last, at) = (at, i),
                _ => break,
            }
        }
        // Rounds that fit close all over, each point where it was: what else their gaps differ by
        // are the heights of chords.
        let s = &list[begun];
        let beside = slave.sagitta[s.edge] + master.sagitta[s.master];
        if rank(begun) - rank(at) <= beside {
            at = begun;
        }
        let found = &list[at];
        let r = if at == begun && found.edge == edge {
            xi.clamp(found.span[0], found.span[1])
        } else {
            let from = if at == begun { a } else { ends(&list[last])[0] };
            let [low, high] = ends(found).map(|e| slave.way(part, from, e, 0.0).abs());
            if low <= high { found.span[0] } else { found.span[1] }
        };
        self.place(found, r)
    }

    /// A station at a parameter of its slave edge.
    fn place(&self, s: &Station, xi: f64) -> Place {
        let [slave, master] = self.sides.as_ref().expect("sides of the beginning");
        let other = &master.members[s.master];
        let end = s.span.iter().position(|r| r.total_cmp(&xi).is_eq());
        let r = end.map_or_else(|| ray(&slave.members[s.edge], xi, other), |end| s.opposite[end]);
        let normal = other.normal_at(r);
        Place { a: slave.at(s.edge, xi), m: master.at(s.master, r), heading: angle(normal) }
    }
}

/// Parameter of a master where the normal of a slave edge meets it.
pub fn ray(slave: &Master<f64>, xi: f64, master: &Master<f64>) -> f64 {
    let Master::Curve(edge) = slave else { unreachable!("a slave has edges") };
    let t = edge.slope(xi);
    master.ray(edge.at(xi), t, unit(outward(t))).r
}

/// The rotation that the direction of the place of contact follows: it stays with the side that does
/// not close round its body, else with the one that turns less; of two that end, with the one that
/// is known to turn.
pub fn followed([slave, master]: [f64; 2], closed: [bool; 2]) -> f64 {
    match closed {
        [false, true] => slave,
        [true, true] => slave.min(master).max(0.0) + slave.max(master).min(0.0),
        [false, false] if slave.abs() > master.abs() => slave,
        _ => master,
    }
}

/// A value that is known up to multiples of a period, near another one.
pub fn near(value: f64, other: f64, period: f64) -> f64 {
    value + period * ((other - value) / period).round()
}

/// The way along a boundary of a length, of which the shorter one is known, of a place whose
/// direction turned about the body by an angle: by a whole turn to the left on a solid round.
pub fn way_round(way: f64, round: f64, sense: f64, turn: f64) -> f64 {
    if turn.abs() > PI { near(way, sense * turn / TAU * round, round) } else { way }
}

fn angle(n: Vec2<f64>) -> f64 {
    n[1].atan2(n[0])
}
