//! Arc length along the boundary of a side: over its edges, round corners, from end to end.
// SPDX-License-Identifier: BSD-3-Clause

use super::corners::{LEAST_TURN, turn};
use super::curve::{Curve, Edge, Shape, Vec2, dot, sub};
use super::master::{Master, Surface};
use super::travel::{near, way_round};
use std::collections::HashMap;

/// Distance of two ends that are one point, in lengths of the pieces that meet there.
const SAME: f64 = 1e-6;
/// Gauss rule on [-1, 1], exact to degree 9.
const GAUSS5: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// The member that begins where each one ends.
pub fn followers(surface: &Surface, x: &[[f64; 3]]) -> Vec<Option<usize>> {
    if let Surface::Edges(edges) = surface {
        let begins: HashMap<[u32; 2], usize> =
            edges.iter().enumerate().map(|(j, e)| (ends(e)[0], j)).collect();
        return edges.iter().map(|e| begins.get(&ends(e)[1]).copied()).collect();
    }
    let members: Vec<Master<f64>> = (0..surface.len()).map(|j| surface.place(j, x)).collect();
    let distance = |p: Vec2<f64>, q: Vec2<f64>| {
        let d = sub(p, q);
        dot(d, d).sqrt()
    };
    let behind = |m: &Master<f64>| {
        let end = m.end(1);
        let size = distance(m.end(0), end);
        members.iter().position(|other| distance(other.end(0), end) <= SAME * size)
    };
    members.iter().map(behind).collect()
}

/// Names of both ends of an edge: a node twice, or two nodes for the middle between them.
fn ends(edge: &Edge) -> [[u32; 2]; 2] {
    let [p, q, vertex] = edge.nodes;
    let middle = |a: u32, b: u32| [a.min(b), a.max(b)];
    match edge.shape {
        Shape::Element => [[p, p], [q, q]],
        Shape::FirstHalf => [[p, p], middle(p, q)],
        Shape::SecondHalf => [middle(p, q), [q, q]],
        Shape::Spline => [middle(p, vertex), middle(vertex, q)],
    }
}

/// A side in one configuration, with the arc length of its points.
pub struct Boundary {
    pub members: Vec<Master<f64>>,
    /// Connected part that each member belongs to.
    pub part: Vec<usize>,
    /// Arc length at which each member begins.
    start: Vec<f64>,
    /// Length of each part that closes, infinite for others.
    round: Vec<f64>,
    /// Sense of the way round each part: 1 to the left.
    sense: Vec<f64>,
    /// How far each member may lie beside the round that it is a piece of: h^2 / 8 R.
    pub sagitta: Vec<f64>,
    longest: f64,
}

impl Boundary {
    pub fn new(surface: &Surface, x: &[[f64; 3]], next: &[Option<usize>]) -> Self {
        let n = surface.len();
        let members: Vec<Master<f64>> = (0..n).map(|j| surface.place(j, x)).collect();
        let length: Vec<f64> = members.iter().map(|m| m.length(1.0)).collect();
        let mut first = vec![true; n];
        next.iter().flatten().for_each(|&j| first[j] = false);
        let (mut part, mut start, mut round) = (vec![usize::MAX; n], vec![0.0; n], Vec::new());
        // What remains after all that have a beginning is closed.
        for j in (0..n).filter(|&j| first[j]).chain(0..n) {
            let (mut at, mut here) = (0.0, Some(j));
            while let Some(k) = here.filter(|&k| part[k] == usize::MAX) {
                (part[k], start[k]) = (round.len(), at);
                at += length[k];
                here = next[k];
            }
            if at > 0.0 {
                round.push(if here == Some(j) { at } else { f64::INFINITY });
            }
        }
        let mut twice = vec![0.0; round.len()];
        for (member, &part) in members.iter().zip(&part) {
            let (p, q) = (member.end(0), member.end(1));
            twice[part] += p[0] * q[1] - p[1] * q[0];
        }
        let sense = twice.into_iter().map(f64::signum).collect();
        let longest = length.iter().copied().fold(0.0, f64::max);
        let mut sagitta = vec![0.0_f64; n];
        for (j, k) in next.iter().enumerate().filter_map(|(j, k)| k.map(|k| (j, k))) {
            let angle = turn([members[j].normal_at(1.0), members[k].normal_at(-1.0)]).abs();
            for m in [j, k].into_iter().filter(|_| angle < LEAST_TURN) {
                sagitta[m] = sagitta[m].max(0.125 * angle * length[m]);
            }
        }
        Self { members, part, start, round, sense, sagitta, longest }
    }

    /// Arc length at a point of a member, or of its continuation.
    pub fn at(&self, member: usize, r: f64) -> f64 {
        self.start[member] + self.members[member].length(r)
    }

    /// The way from one arc length of a part to another: round a closed part the shorter one, unless
    /// its place turned about the body by more than half a turn.
    pub fn way(&self, part: usize, from: f64, to: f64, turn: f64) -> f64 {
        let (way, round) = (to - from, self.round[part]);
        if !round.is_finite() {
            return way;
        }
        way_round(near(way, 0.0, round), round, self.sense[part], turn)
    }

    /// Length of the boundary between two members, infinite if they are of different parts.
    pub fn between(&self, i: usize, j: usize) -> f64 {
        if self.part[i] != self.part[j] {
            return f64::INFINITY;
        }
        let way = |i, j| self.way(self.part[i], self.at(i, 1.0), self.at(j, -1.0), 0.0).abs();
        way(i, j).min(way(j, i))
    }

    pub fn round(&self, part: usize) -> f64 {
        self.round[part]
    }

    /// Length of the longest member.
    pub fn longest(&self) -> f64 {
        self.longest
    }
}

impl Master<f64> {
    /// Arc length from the first end to a parameter, also beyond the ends.
    fn length(&self, r: f64) -> f64 {
        match self {
            Self::Curve(c) if !c.straight => {
                let inside = r.clamp(-1.0, 1.0);
                let beyond = (r - inside) * speed(c, inside);
                let half = 0.5 * (inside + 1.0);
                let part = |(g, w): &(f64, f64)| w * half * speed(c, half * (g + 1.0) - 1.0);
                GAUSS5.iter().map(part).sum::<f64>() + beyond
            }
            Self::Curve(c) => speed(c, 0.0) * (r + 1.0),
            Self::Arc(_) => self.speed_at(r) * (r + 1.0),
        }
    }
}

fn speed(c: &Curve<f64>, r: f64) -> f64 {
    let t = c.slope(r);
    dot(t, t).sqrt()
}
