// SPDX-License-Identifier: BSD-3-Clause
//! Places of the vertices of a part of a graph that has no coordinates, by its edges alone.
//!
//! A few vertices are chosen as far apart as possible. The difference of the distances from two of
//! them, counted in edges, rises from the one to the other and stands for the distance along a
//! direction. Averages over the neighbors make its steps fine. Source: Harel & Koren, *Graph
//! Drawing by High-Dimensional Embedding*, J. Graph Algorithms Appl. 8 (2004) 195-214.

use std::array;

/// Vertices that distances are counted from.
const FAR: usize = 4;
/// Pairs of them.
pub const PAIRS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
/// Averages over neighbors.
const AVERAGES: usize = 8;
/// No vertex, and a distance that is not known yet.
const NONE: u32 = u32::MAX;

/// A part of a graph with local numbers, and the distances of its vertices.
#[derive(Default)]
pub struct Layout {
    /// Start of each vertex's list of neighbors in the part, and the lists.
    pub start: Vec<u32>,
    pub list: Vec<u32>,
    /// Distances of each vertex from the far ones, averaged.
    pub places: Vec<[f64; FAR]>,
    queue: Vec<u32>,
    distance: [Vec<u32>; FAR],
    averaged: Vec<[f64; FAR]>,
}

impl Layout {
    /// Removes all vertices.
    pub fn clear(&mut self) {
        self.start.clear();
        self.start.push(0);
        self.list.clear();
    }

    /// Finds the places of all vertices of a connected part; of others, which vertices lie in some
    /// of its components, about half of all.
    pub fn place(&mut self) -> Option<Vec<bool>> {
        let n = self.start.len() - 1;
        for of in &mut self.distance {
            of.clear();
            of.resize(n, NONE);
        }
        // The far end from anywhere is an end.
        let mut last = self.distances(0, 0);
        if self.queue.len() < n {
            return Some(self.components(n));
        }
        for k in 0..FAR {
            self.distance[k].fill(NONE);
            let end = self.distances(k, last);
            let nearest = |v: u32| (0..=k).map(|j| self.distance[j][v as usize]).min();
            let farthest = || self.queue.iter().copied().max_by_key(|&v| nearest(v));
            last = if k == 0 { end } else { farthest().unwrap_or(end) };
        }
        self.places.clear();
        self.places.extend(
            (0..n).map(|v| array::from_fn::<f64, FAR, _>(|k| f64::from(self.distance[k][v]))),
        );
        for _ in 0..AVERAGES {
            self.average();
        }
        None
    }

    /// Vertices of the components that make up half of all, or of one that has more.
    fn components(&mut self, n: usize) -> Vec<bool> {
        let mut inside = vec![false; n];
        let (mut count, mut root) = (0, 0);
        while 2 * count < n {
            // The first one is in the queue.
            if count > 0 {
                while self.distance[0][root] != NONE {
                    root += 1;
                }
                self.distances(0, root as u32);
            }
            if 2 * self.queue.len() >= n {
                inside.fill(false);
            }
            self.queue.iter().for_each(|&v| inside[v as usize] = true);
            count += self.queue.len();
        }
        inside
    }

    /// Distances from a vertex in its component; returns the last one that was reached.
    fn distances(&mut self, k: usize, from: u32) -> u32 {
        let of = &mut self.distance[k];
        self.queue.clear();
        self.queue.push(from);
        of[from as usize] = 0;
        let mut at = 0;
        while at < self.queue.len() {
            let v = self.queue[at] as usize;
            at += 1;
            let next = of[v] + 1;
            for &u in &self.list[self.start[v] as usize..self.start[v + 1] as usize] {
                if of[u as usize] == NONE {
                    of[u as usize] = next;
                    self.queue.push(u);
                }
            }
        }
        self.queue[self.queue.len() - 1]
    }

    fn average(&mut self) {
        let Self { start, list, places, averaged, .. } = self;
        averaged.clear();
        averaged.extend(places.iter().enumerate().map(|(v, own)| {
            let near = &list[start[v] as usize..start[v + 1] as usize];
            if near.is_empty() {
                return *own;
            }
            let mut sum = [0.0; FAR];
            for &u in near {
                for k in 0..FAR {
                    sum[k] += places[u as usize][k];
                }
            }
            array::from_fn(|k| 0.5 * (own[k] + sum[k] / near.len() as f64))
        }));
        std::mem::swap(places, averaged);
    }
}
