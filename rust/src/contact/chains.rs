//! Faces one behind the other: neighbors, free ends, and the way along them.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{GAUSS, dot};
use super::master::{Master, Surface};
use super::travel::way_round;
use std::f64::consts::PI;

/// Distance of two ends that are one point, in lengths of the faces that meet there.
const SAME: f64 = 1e-6;

/// Neighbors of the faces of both sides.
pub struct Chains {
    next: Vec<Option<usize>>,
    previous: Vec<Option<usize>>,
    /// Number of the chain of each face, first of those that end.
    chain: Vec<usize>,
    ending: usize,
    /// Whether no other face of the same side is at the first and the second end.
    free: Vec<[bool; 2]>,
}

impl Chains {
    /// Of the faces before `split` and of those from there, each for themselves.
    pub fn new(faces: &Surface, split: usize, x: &[[f64; 3]]) -> Self {
        let n = faces.len();
        let ends: Vec<[[f64; 2]; 2]> = (0..n)
            .map(|j| {
                let face = faces.place(j, x);
                [face.end(0), face.end(1)]
            })
            .collect();
        let size = |j: usize| {
            let [a, b] = ends[j];
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        let touch = |(j, a): (usize, usize), (k, b): (usize, usize)| {
            if let (Some(e), Some(f)) = (faces.edge(j), faces.edge(k)) {
                return e.nodes[a] == f.nodes[b];
            }
            let (p, q) = (ends[j][a], ends[k][b]);
            (p[0] - q[0]).hypot(p[1] - q[1]) <= SAME * size(j)
        };
        let (mut next, mut previous) = (vec![None; n], vec![None; n]);
        let mut free = vec![[true; 2]; n];
        let order = sorted_ends(&ends);
        let near = close_ends(&ends, &order, SAME * (0..n).map(size).fold(0.0, f64::max));
        for (j, a) in (0..n).flat_map(|j| [(j, 0), (j, 1)]) {
            let met: Vec<(usize, usize)> = near[2 * j + a]
                .iter()
                .map(|&e| (e / 2, e % 2))
                .filter(|&(k, b)| {
                    (k, b) != (j, a) && (j < split) == (k < split) && touch((j, a), (k, b))
                })
                .collect();
            free[j][a] = met.is_empty();
            if let [(k, b)] = met[..]
                && a == 1
                && b == 0
            {
                (next[j], previous[k]) = (Some(k), Some(j));
            }
        }
        let mut chain = vec![usize::MAX; n];
        let ending = previous.iter().filter(|p| p.is_none()).count();
        let starts = (0..n).filter(|&j| previous[j].is_none()).chain(0..n);
        for (number, first) in starts.enumerate() {
            let mut at = Some(first);
            while let Some(j) = at.filter(|&j| chain[j] == usize::MAX) {
                chain[j] = number;
                at = next[j];
            }
        }
        Self { next, previous, chain, ending, free }
    }

    pub fn next(&self, j: usize) -> Option<usize> {
        self.next[j]
    }

    pub fn previous(&self, j: usize) -> Option<usize> {
        self.previous[j]
    }

    /// Whether two faces are of one chain.
    pub fn same(&self, j: usize, k: usize) -> bool {
        self.chain[j] == self.chain[k]
    }

    /// Whether the chain of a face closes.
    pub fn closed(&self, j: usize) -> bool {
        self.chain[j] >= self.ending
    }

    /// Whether nothing continues a face at its first or second end.
    pub fn free(&self, j: usize, which: usize) -> bool {
        self.free[j][which]
    }

    /// Way along a chain from a place on a face to one on another; backwards it is negative. Of a
    /// closed chain the shorter one, unless the place turned about the body by more than half a turn.
    pub fn between(
        &self,
        faces: &Surface,
        from: (usize, f64),
        to: (usize, f64),
        x: &[[f64; 3]],
        turn: f64,
    ) -> f64 {
        let way = self.shorter(faces, from, to, x);
        if turn.abs() <= PI || !self.closed(from.0) {
            return way;
        }
        let (mut round, mut twice, mut at) = (0.0, 0.0, from.0);
        loop {
            let face = faces.place(at, x);
            let (p, q) = (face.end(0), face.end(1));
            round += arc_length(&face, -1.0, 1.0);
            twice += p[0] * q[1] - p[1] * q[0];
            at = self.next[at].expect("a closed chain");
            if at == from.0 {
                return way_round(way, round, f64::signum(twice), turn);
            }
        }
    }

    fn shorter(
        &self,
        faces: &Surface,
        (j, from): (usize, f64),
        (k, to): (usize, f64),
        x: &[[f64; 3]],
    ) -> f64 {
        let (from, to) = (from.clamp(-1.0, 1.0), to.clamp(-1.0, 1.0));
        if j == k {
            return arc_length(&faces.place(j, x), from, to);
        }
        let walk = |(a, start): (usize, f64), (b, end): (usize, f64)| {
            let mut way = arc_length(&faces.place(a, x), start, 1.0);
            let mut at = self.next[a];
            while let Some(m) = at {
                if m == b {
                    return way + arc_length(&faces.place(b, x), -1.0, end);
                }
                if m == a {
                    break;
                }
                way += arc_length(&faces.place(m, x), -1.0, 1.0);
                at = self.next[m];
            }
            f64::INFINITY
        };
        let (ahead, back) = (walk((j, from), (k, to)), walk((k, to), (j, from)));
        if ahead <= back { ahead } else { -back }
    }
}

/// Length of a face between two values of its parameter, negative backwards.
pub fn arc_length(face: &Master<f64>, from: f64, to: f64) -> f64 {
    match face {
        Master::Arc(a) => 0.5 * (to - from) * (a.sweep() * a.signed_radius()).abs(),
        Master::Curve(c) => {
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            let speed = |r: f64| {
                let t = c.slope(middle + half * r);
                dot(t, t).sqrt()
            };
            GAUSS.iter().map(|(r, w)| w * half * speed(*r)).sum()
        }
    }
}

/// Ends by their x, each `2 face + end`.
fn sorted_ends(ends: &[[[f64; 2]; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..2 * ends.len()).collect();
    order.sort_by(|&a, &b| ends[a / 2][a % 2][0].total_cmp(&ends[b / 2][b % 2][0]));
    order
}

/// Ends no farther from each end than `same`.
fn close_ends(ends: &[[[f64; 2]; 2]], order: &[usize], same: f64) -> Vec<Vec<usize>> {
    let at = |e: usize| ends[e / 2][e % 2];
    let mut near = vec![Vec::new(); order.len()];
    for (i, &e) in order.iter().enumerate() {
        for &f in &order[i + 1..] {
            let (p, q) = (at(e), at(f));
            if q[0] - p[0] > same {
                break;
            }
            if (q[1] - p[1]).abs() <= same {
                near[e].push(f);
                near[f].push(e);
            }
        }
    }
    near
}
