//! Both sides of a pair, where its constraints begin, and which parts of them may meet.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::Curve;
use super::master::Surface;
use super::search::{self, Candidate, Search};
use super::slave::Slave;
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
    /// Nodes at the tips of notches of a boundary that meets itself.
    pub notches: HashSet<u32>,
    pub distances: Distances,
    /// Undeformed slave edges.
    pub reference: Vec<Curve<f64>>,
    /// Deepest penetration of each item of the search.
    pub depth: Vec<f64>,
    /// Clearance taken off the gap of each constraint.
    pub offset: Vec<f64>,
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
    ) -> Self {
        let itself = master.is_none();
        Self {
            notches: if itself { slave.notches(x) } else { HashSet::new() },
            master: master.unwrap_or_else(|| Surface::Edges(slave.edges.clone())),
            itself,
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
        self.depth = owners.iter().map(|own| least(own).min(self.distances.depth)).collect();
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
