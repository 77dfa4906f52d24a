//! Both sides of a pair, where its constraints begin, and which parts of them may meet.
// SPDX-License-Identifier: BSD-3-Clause

use super::boundary::{Boundary, followers};
use super::curve::{Curve, dot, outward, sub, unit};
use super::master::Surface;
use super::search::{self, Candidate, Search, TURNED};
use super::slave::{OPPOSITE, Slave};
use std::collections::HashSet;
use std::ops::Range;

/// Distances of the search.
#[derive(Clone, Copy, Debug)]
pub struct Distances {
    /// Farther apart than this nothing is evaluated.
    pub reach: f64,
    /// Added for candidates, so that they last.
    pub margin: f64,
    /// Deeper than this is no contact.
    pub depth: f64,
}

/// What all discretizations of a pair see of it.
pub struct Sides {
    pub slave: Slave,
    pub master: Surface,
    /// Whether the master is the slave.
    pub itself: bool,
    /// Whether sharp corners have constraints of their own.
    pub corners: bool,
    /// Nodes at the tips of notches of a boundary that meets itself.
    pub notches: HashSet<u32>,
    pub distances: Distances,
    /// Undeformed slave edges.
    pub reference: Vec<Curve<f64>>,
    /// Deepest penetration of each item of the search.
    pub depth: Vec<f64>,
    /// Clearance taken off the gap of each constraint.
    pub offset: Vec<f64>,
    /// Undeformed boundary that meets itself, and how far around a corner an edge of it meets none.
    boundary: Option<Boundary>,
    around: Vec<f64>,
    pub(super) search: Search,
    /// First candidate of each item.
    first: Vec<usize>,
}

impl Sides {
    /// Both sides of a pair; without a master the slave meets itself. `x` is the reference
    /// configuration.
    pub fn new(
        x: &[[f64; 3]],
        slave: Slave,
        master: Option<Surface>,
        distances: Distances,
        corners: bool,
    ) -> Self {
        let itself = master.is_none();
        let boundary = itself.then(|| {
            let edges = Surface::Edges(slave.edges.clone());
            Boundary::new(&edges, x, &followers(&edges, x))
        });
        Self {
            boundary,
            around: Vec::new(),
            notches: if itself { slave.notches(x) } else { HashSet::new() },
            master: master.unwrap_or_else(|| Surface::Edges(slave.edges.clone())),
            itself,
            corners,
            distances,
            reference: slave.edges.iter().map(|e| e.place(x)).collect(),
            depth: Vec::new(),
            offset: Vec::new(),
            search: Search::default(),
            first: Vec::new(),
            slave,
        }
    }

    /// Sets how deep each item may lie in the master: what lies deeper is behind the body, and of
    /// a boundary with itself beyond its middle. Surfaces that are joined may be anywhere.
    pub(super) fn set_depth(&mut self, x: &[[f64; 3]], joins: bool, owners: &[Vec<usize>]) {
        let unbounded = joins || owners.iter().all(Vec::is_empty);
        let of_edges: Vec<f64> = if unbounded {
            vec![f64::INFINITY; self.slave.edges.len()]
        } else {
            let part = if self.itself { 1.0 } else { 2.0 };
            search::half_thickness(&self.slave, x).into_iter().map(|h| part * h).collect()
        };
        let least =
            |own: &Vec<usize>| own.iter().map(|&i| of_edges[i]).fold(f64::INFINITY, f64::min);
        // Where no other face is known nothing is met that is farther than the search.
        let reach = self.distances.reach + self.distances.margin;
        let whole = |h: &f64| if h.is_finite() { 2.0 * h } else { reach };
        self.around = of_edges.iter().map(whole).collect();
        self.depth = owners.iter().map(|own| least(own).min(self.distances.depth)).collect();
    }

    /// Whether edge `j` of a boundary with itself comes before all of `mine`, so that each pair is
    /// taken once, shares no node with them but the tip of a notch, and is not around a corner.
    pub fn apart(&self, mine: &[usize], j: usize) -> bool {
        let edges = &self.slave.edges;
        let other = edges[j].nodes();
        let joined = |n: &u32| other.contains(n) && !self.notches.contains(n);
        mine.iter()
            .all(|&i| j < i && !edges[i].nodes().iter().any(joined) && !self.is_around_corner(i, j))
    }

    /// Whether two edges of a boundary with itself lie on the sides of a convex corner, not farther
    /// from each other than the body is thick: each is behind the other, and to meet it from outside
    /// the boundary would have to bend back within that length.
    pub fn is_around_corner(&self, i: usize, j: usize) -> bool {
        let Some(boundary) = &self.boundary else { return false };
        let [a, b] = [&self.reference[i], &self.reference[j]];
        let (n, m, way) = (unit(outward(a.d)), unit(outward(b.d)), sub(b.at(0.0), a.at(0.0)));
        dot(n, m) > OPPOSITE
            && dot(n, m) < TURNED
            && dot(way, n) < 0.0
            && dot(way, m) > 0.0
            && boundary.between(i, j) <= self.around[i].min(self.around[j])
    }

    pub fn candidates(&self) -> &[Candidate] {
        &self.search.candidates
    }

    /// Numbers of the candidates of an item.
    pub fn of_item(&self, i: usize) -> Range<usize> {
        self.first[i]..self.first[i + 1]
    }

    /// Items whose candidates are known.
    pub fn n_items(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// Takes candidates, sorted, of so many items.
    pub(super) fn index(&mut self, items: usize) {
        let candidates = &self.search.candidates;
        self.first = (0..=items).map(|i| candidates.partition_point(|c| c.0 < i)).collect();
    }

    /// Leaves these candidates for good.
    pub fn keep(&mut self, candidates: Vec<Candidate>) {
        self.search.candidates = candidates;
    }
}
