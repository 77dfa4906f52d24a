// SPDX-License-Identifier: BSD-3-Clause
//! Nested dissection of the graph of a mesh.
//!
//! A part of the mesh is cut by straight lines in a few directions. Nodes are counted by their
//! distance along a direction, which gives the separators of all its cuts in one pass over the
//! edges; the best one of all directions is moved to the smallest one near it. Parts without
//! coordinates, or with edges that do not follow them (couplings across the model, layers), take
//! directions from the edges alone ([`super::layout`]). Parts that are small
//! enough are ordered by minimum degree. Halves of a part have no edge in common, so threads take
//! them in any order with the same result.
//!
//! Source: George & Liu, *Computer Solution of Large Sparse Positive Definite Systems* (1981),
//! ch. 8; Heath & Raghavan, *SIAM J. Matrix Anal. Appl.* 16 (1995) 235-253, for cuts by coordinates.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::layout::{Layout, PAIRS};
use super::minimum_degree;
use super::separator::Band;

/// Nodes of a part that is not cut further.
const LEAF: usize = 96;
/// Nodes of a part whose halves are given to different threads.
const SHARED: usize = 4096;
/// Directions of cuts in steps of 22.5 degrees.
const DIRECTIONS: usize = 8;
/// A direction is tried if the part is at least this long there, relative to its greatest length.
const LONG: f64 = 0.6;
/// Smallest share of a part on one side of a cut.
const SMALLEST: f64 = 0.25;
/// Weight of the imbalance of a cut beside the size of its separator.
const BALANCE: f64 = 4.0;
/// Share of a part on each side of a separator in which it may move at a time, and how often.
const BAND: f64 = 0.03;
const MOVES: usize = 4;

/// Nodes of a part without a cut that are ordered by minimum degree, at most. In larger ones, where
/// nearly all nodes are neighbors, the degrees of the whole graph serve.
const CLUSTER: usize = 1024;
/// Parts of more nodes are judged: with more than so many times the square root of their number in
/// the separator, their edges do not follow the coordinates.
const JUDGED: usize = 2048;
const POOR: usize = 4;

/// A vertex with so many times the mean number of neighbors (the reference node of a coupling) is
/// a separator by itself, unless there are many of them.
const HUB: usize = 8;

/// Number of vertices in separators of parts cut before, and of hubs.
const DONE: u32 = u32::MAX;

/// Side of a cut.
const BEFORE: u8 = 0;
const BEHIND: u8 = 1;
const SEPARATOR: u8 = 2;

/// A graph with weighted vertices and their coordinates; `points` are empty if there are none.
#[derive(Clone, Copy)]
pub struct Graph<'a> {
    pub xadj: &'a [u32],
    pub adjncy: &'a [u32],
    pub weights: &'a [i32],
    pub points: &'a [[f64; 2]],
}

impl Graph<'_> {
    pub(super) fn neighbors(&self, v: u32) -> &[u32] {
        &self.adjncy[self.xadj[v as usize] as usize..self.xadj[v as usize + 1] as usize]
    }

    fn weight(&self, v: u32) -> i64 {
        i64::from(self.weights[v as usize])
    }
}

/// Work arrays of a thread.
#[derive(Default)]
struct Scratch {
    points: Vec<[f64; 2]>,
    layout: Layout,
    steps: Vec<[i64; 2]>,
    sides: Vec<u8>,
    in_band: Vec<u32>,
    members: Vec<u32>,
    band: Band,
    moved: [Vec<u8>; 2],
    rest: [Vec<u32>; 2],
    leaf: minimum_degree::Scratch,
}

struct Dissection<'a> {
    graph: Graph<'a>,
    /// A number of each vertex in its part, `DONE` in separators. Those of a part are read and
    /// written by its thread alone: other parts are separated from it.
    number: &'a [AtomicU32],
    /// Whether halves are given to the threads of rayon's current pool.
    shared: bool,
}

/// Order of elimination of a graph, always the same.
pub fn dissect(graph: Graph<'_>, shared: bool) -> Vec<u32> {
    let n = graph.weights.len() as u32;
    let is_hub =
        |&v: &u32| graph.neighbors(v).len() * graph.weights.len() > HUB * graph.adjncy.len();
    let (mut hubs, mut order): (Vec<u32>, Vec<u32>) = (0..n).partition(is_hub);
    if hubs.len() > graph.weights.len().isqrt() {
        (hubs, order) = (Vec::new(), (0..n).collect());
    }
    let number: Vec<AtomicU32> = (0..n).map(AtomicU32::new).collect();
    for &v in &hubs {
        number[v as usize].store(DONE, Relaxed);
    }
    let dissection = Dissection { graph, number: &number, shared };
    dissection.order(&mut order, !graph.points.is_empty(), &mut Scratch::default());
    order.extend(hubs);
    order
}

impl Dissection<'_> {
    /// Puts the vertices of a part into the order of their elimination; by coordinates, if `placed`.
    fn order(&self, part: &mut [u32], placed: bool, scratch: &mut Scratch) {
        if part.len() <= LEAF {
            minimum_degree::order(&self.graph, part, &mut scratch.leaf);
            return;
        }
        let Some((low, high, placed)) = self.cut(part, placed, scratch) else {
            if part.len() <= CLUSTER {
                minimum_degree::order(&self.graph, part, &mut scratch.leaf);
            } else {
                part.sort_by_key(|&v| self.graph.neighbors(v).len());
            }
            return;
        };
        let (first, rest) = part.split_at_mut(low);
        let second = &mut rest[..high - low];
        if self.shared && first.len() + second.len() > SHARED {
            rayon::join(
                || self.order(first, placed, scratch),
                || self.order(second, placed, &mut Scratch::default()),
            );
        } else {
            self.order(first, placed, scratch);
            self.order(second, placed, scratch);
        }
    }

    /// Cuts a part: both halves, then the separator. Returns the ends of the halves, and whether the
    /// edges follow the coordinates.
    fn cut(
        &self,
        part: &mut [u32],
        mut placed: bool,
        scratch: &mut Scratch,
    ) -> Option<(usize, usize, bool)> {
        placed = placed && self.by_coordinates(part, scratch);
        if !placed && !self.by_edges(part, scratch) {
            return None;
        }
        let Scratch { sides, rest: [behind, separator], .. } = scratch;
        behind.clear();
        separator.clear();
        let mut end = 0;
        for k in 0..part.len() {
            let v = part[k];
            match sides[k] {
                BEFORE => {
                    part[end] = v;
                    end += 1;
                }
                BEHIND => behind.push(v),
                _ => {
                    separator.push(v);
                    self.number[v as usize].store(DONE, Relaxed);
                }
            }
        }
        let last = end + behind.len();
        part[end..last].copy_from_slice(behind);
        part[last..].copy_from_slice(separator);
        Some((end, last, placed))
    }

    /// The best cut along straight lines; whether there is a good one.
    fn by_coordinates(&self, part: &[u32], scratch: &mut Scratch) -> bool {
        let mut points = std::mem::take(&mut scratch.points);
        points.clear();
        points.extend(part.iter().map(|&v| self.graph.points[v as usize]));
        let along = |d: [f64; 2], k: usize| d[0] * points[k][0] + d[1] * points[k][1];
        let directions: [[f64; 2]; DIRECTIONS] = std::array::from_fn(|k| {
            let (sin, cos) = (std::f64::consts::PI * k as f64 / DIRECTIONS as f64).sin_cos();
            [cos, sin]
        });
        let good = self.straight(part, scratch, &directions, along) && {
            self.refine(part, scratch);
            let separator: usize =
                scratch.sides.iter().map(|&side| usize::from(side == SEPARATOR)).sum();
            part.len() <= JUDGED || separator <= POOR * part.len().isqrt()
        };
        scratch.points = points;
        good
    }

    /// The best cut along directions that the edges give; whether there is one.
    fn by_edges(&self, part: &[u32], scratch: &mut Scratch) -> bool {
        let mut layout = std::mem::take(&mut scratch.layout);
        for (k, &v) in part.iter().enumerate() {
            self.number[v as usize].store(k as u32, Relaxed);
        }
        layout.clear();
        for &v in part {
            let near = self.graph.neighbors(v).iter();
            let near = near.map(|&u| self.number[u as usize].load(Relaxed));
            layout.list.extend(near.filter(|&k| k != DONE));
            layout.start.push(layout.list.len() as u32);
        }
        let found = if let Some(inside) = layout.place() {
            scratch.sides.clear();
            scratch.sides.extend(inside.iter().map(|&yes| if yes { BEFORE } else { BEHIND }));
            true
        } else {
            let places = &layout.places;
            let along = |[i, j]: [usize; 2], k: usize| places[k][i] - places[k][j];
            let cut = self.straight(part, scratch, &PAIRS, along);
            if cut {
                self.refine(part, scratch);
            }
            cut
        };
        scratch.layout = layout;
        found
    }

    /// Moves the separator as long as it becomes better.
    fn refine(&self, part: &[u32], scratch: &mut Scratch) {
        for _ in 0..MOVES {
            if !self.moves(part, scratch) {
                break;
            }
        }
    }

    /// The best straight cut in the given directions, side of each vertex of the part; whether
    /// there is one. `along` is the distance of a vertex, by its place in the part, in a direction.
    fn straight<D: Copy, const COUNT: usize>(
        &self,
        part: &[u32],
        scratch: &mut Scratch,
        directions: &[D; COUNT],
        along: impl Fn(D, usize) -> f64,
    ) -> bool {
        let Scratch { steps, sides, .. } = scratch;
        let total: i64 = part.iter().map(|&v| self.graph.weight(v)).sum();
        let spans = directions.map(|d| {
            (0..part.len()).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], k| {
                let s = along(d, k);
                [low.min(s), high.max(s)]
            })
        });
        let longest = spans.iter().fold(0.0_f64, |a, s| a.max(s[1] - s[0]));
        let slots = 16 * part.len().isqrt() + 64;
        let number = |d: D, [low, high]: [f64; 2]| {
            let scale = (slots - 1) as f64 / (high - low);
            for (k, &v) in part.iter().enumerate() {
                let slot = ((along(d, k) - low) * scale) as u32;
                self.number[v as usize].store(slot, Relaxed);
            }
        };
        let mut best: Option<(f64, usize, u32)> = None;
        let mut last = 0;
        for (k, (&d, &span)) in directions.iter().zip(&spans).enumerate() {
            let length = span[1] - span[0];
            if length <= 0.0 || length < LONG * longest {
                continue;
            }
            last = k;
            number(d, span);
            // What a cut before each slot adds to the separator: vertices from there on with a
            // neighbor before it; and the weights in the slots.
            steps.clear();
            steps.resize(slots + 1, [0, 0]);
            for &v in part {
                let own = self.number[v as usize].load(Relaxed);
                let first = self.first_neighbor(v, own);
                let weight = self.graph.weight(v);
                steps[own as usize][1] += weight;
                steps[first as usize + 1][0] += weight;
                steps[own as usize + 1][0] -= weight;
            }
            let (mut separator, mut before) = (0, 0);
            for slot in 1..slots {
                before += steps[slot - 1][1];
                separator += steps[slot][0];
                let cost = cost(before, total - before - separator, separator);
                if let Some(cost) = cost
                    && best.is_none_or(|(c, ..)| cost < c)
                {
                    best = Some((cost, k, slot as u32));
                }
            }
        }
        let Some((_, k, slot)) = best else { return false };
        if k != last {
            number(directions[k], spans[k]);
        }
        sides.clear();
        sides.extend(part.iter().map(|&v| {
            let own = self.number[v as usize].load(Relaxed);
            match own < slot {
                true => BEFORE,
                false if self.first_neighbor(v, own) < slot => SEPARATOR,
                false => BEHIND,
            }
        }));
        true
    }

    /// Least number of a vertex and its neighbors.
    fn first_neighbor(&self, v: u32, own: u32) -> u32 {
        let numbers = self.graph.neighbors(v).iter();
        numbers.fold(own, |a, &u| a.min(self.number[u as usize].load(Relaxed)))
    }

    /// Moves the separator to the best one near it; whether it became better.
    fn moves(&self, part: &[u32], scratch: &mut Scratch) -> bool {
        let Scratch { sides, in_band, members, band, moved, .. } = scratch;
        for (k, &v) in part.iter().enumerate() {
            self.number[v as usize].store(k as u32, Relaxed);
        }
        in_band.clear();
        in_band.resize(part.len(), DONE);
        members.clear();
        members.extend((0..part.len() as u32).filter(|&k| sides[k as usize] == SEPARATOR));
        let size = members.len();
        for (j, &k) in members.iter().enumerate() {
            in_band[k as usize] = j as u32;
        }
        // Layers around the separator on both sides.
        let most = size + (BAND * part.len() as f64) as usize;
        let mut held = [0, 0];
        let mut at = 0;
        while at < members.len() {
            let v = part[members[at] as usize];
            at += 1;
            for &u in self.graph.neighbors(v) {
                let k = self.number[u as usize].load(Relaxed);
                if k == DONE || in_band[k as usize] != DONE {
                    continue;
                }
                let side = sides[k as usize] as usize;
                if held[side] < most {
                    held[side] += 1;
                    in_band[k as usize] = members.len() as u32;
                    members.push(k);
                }
            }
        }
        band.clear();
        for &k in members.iter() {
            let mut touches = [false; 2];
            for &u in self.graph.neighbors(part[k as usize]) {
                let j = self.number[u as usize].load(Relaxed);
                if j == DONE {
                    continue;
                }
                match (in_band[j as usize], sides[j as usize]) {
                    (DONE, BEFORE) => touches[0] = true,
                    (DONE, _) => touches[1] = true,
                    (other, _) => band.list.push(other),
                }
            }
            band.start.push(band.list.len() as u32);
            band.touches.push(touches);
        }
        if band.saturate(size) == size {
            return false;
        }
        let mut sums = [0_i64; 3];
        for (&side, &v) in sides.iter().zip(part) {
            sums[side as usize] += self.graph.weight(v);
        }
        let now = cost(sums[0], sums[1], sums[2]);
        let mut best = (now, None);
        for end in 0..2 {
            band.sides(end == 1, &mut moved[end]);
            let mut sums = sums;
            for (&side, &k) in moved[end].iter().zip(members.iter()) {
                let weight = self.graph.weight(part[k as usize]);
                sums[sides[k as usize] as usize] -= weight;
                sums[side as usize] += weight;
            }
            let then = cost(sums[0], sums[1], sums[2]);
            if then.is_some() && (best.0.is_none() || then < best.0) {
                best = (then, Some(end));
            }
        }
        let Some(end) = best.1 else { return false };
        for (&side, &k) in moved[end].iter().zip(members.iter()) {
            sides[k as usize] = side;
        }
        true
    }
}

/// Cost of a cut by the weights before it, behind it and in it; none if one side is too small.
fn cost(before: i64, behind: i64, separator: i64) -> Option<f64> {
    let total = (before + behind + separator) as f64;
    let tilt = (before - behind) as f64 / total;
    let small = (before.min(behind) as f64) < SMALLEST * total;
    (!small).then(|| (separator + 1) as f64 * (1.0 + BALANCE * tilt * tilt))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Graph of a grid of quadrilaterals: neighbors share an element. `bend` turns it to a ring.
    fn grid(nx: i64, ny: i64, bend: f64) -> (Vec<u32>, Vec<u32>, Vec<[f64; 2]>) {
        let (mut xadj, mut adjncy, mut points) = (vec![0], Vec::new(), Vec::new());
        for i in 0..nx {
            for j in 0..ny {
                for (a, b) in (-1..2).flat_map(|a| (-1..2).map(move |b| (i + a, j + b))) {
                    if (a, b) != (i, j) && (0..nx).contains(&a) && (0..ny).contains(&b) {
                        adjncy.push((a * ny + b) as u32);
                    }
                }
                xadj.push(adjncy.len() as u32);
                let (sin, cos) = (bend * i as f64 / nx as f64).sin_cos();
                let radius = ny as f64 + j as f64;
                let straight = [i as f64, j as f64];
                points.push(if bend > 0.0 { [radius * cos, radius * sin] } else { straight });
            }
        }
        (xadj, adjncy, points)
    }

    /// Entries of the factor, by elimination with the tree of the order.
    fn fill(xadj: &[u32], adjncy: &[u32], order: &[u32]) -> usize {
        let n = order.len();
        let mut rank = vec![0; n];
        for (k, &v) in order.iter().enumerate() {
            rank[v as usize] = k;
        }
        let (mut parent, mut seen, mut count) = (vec![n; n], vec![n; n], 0);
        for (k, &v) in order.iter().enumerate() {
            seen[k] = k;
            for &u in &adjncy[xadj[v as usize] as usize..xadj[v as usize + 1] as usize] {
                let mut i = rank[u as usize];
                while i < k && seen[i] != k {
                    if parent[i] == n {
                        parent[i] = k;
                    }
                    seen[i] = k;
                    count += 1;
                    i = parent[i];
                }
            }
        }
        count + n
    }

    fn is_complete(order: &[u32], n: usize) -> bool {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        sorted.into_iter().eq(0..n as u32)
    }

    /// Fill of METIS 5.1 (`METIS_NodeND`, seed 1) for the same graphs.
    const METIS: [(i64, i64, f64, usize); 4] = [
        (200, 30, 0.0, 147_697),
        (75, 80, 0.0, 168_015),
        (150, 40, 3.0, 156_771),
        (60, 100, 1.5, 168_911),
    ];

    #[test]
    fn orders_are_complete_and_fill_no_more_than_those_of_metis() {
        for (nx, ny, bend, theirs) in METIS {
            let (xadj, adjncy, points) = grid(nx, ny, bend);
            let n = points.len();
            let weights = vec![2; n];
            let mixed: Vec<_> = (0..n).map(|k| points[k * 1009 % n]).collect();
            for points in [points, Vec::new(), mixed, vec![[1.0, 2.0]; n]] {
                let graph =
                    Graph { xadj: &xadj, adjncy: &adjncy, weights: &weights, points: &points };
                let order = dissect(graph, false);
                assert!(is_complete(&order, n));
                let own = fill(&xadj, &adjncy, &order);
                assert!(100 * own <= 103 * theirs, "{nx} x {ny}, {bend}: {own} entries, {theirs}");
            }
        }
    }

    /// Graph of a list of edges.
    fn graph_of(n: usize, edges: &[(usize, usize)]) -> (Vec<u32>, Vec<u32>) {
        let mut near = vec![Vec::new(); n];
        for &(a, b) in edges {
            near[a].push(b as u32);
            near[b].push(a as u32);
        }
        for list in &mut near {
            list.sort_unstable();
        }
        let mut xadj = vec![0];
        for list in &near {
            xadj.push(xadj[xadj.len() - 1] + list.len() as u32);
        }
        (xadj, near.concat())
    }

    #[test]
    fn graphs_that_are_no_mesh_have_little_fill() {
        let n = 3000;
        let star: Vec<_> = (1..n).map(|k| (0, k)).collect();
        let path: Vec<_> = (1..n).map(|k| (k - 1, k)).collect();
        let pairs: Vec<_> = (0..n / 2).map(|k| (2 * k, 2 * k + 1)).collect();
        let two_paths: Vec<_> = path.iter().copied().filter(|&(a, _)| a != n / 2).collect();
        let whole: Vec<_> = (0..n).flat_map(|a| (0..a.min(60)).map(move |b| (a, b))).collect();
        for (edges, most) in [
            (star, 2 * n),
            (path, 4 * n),
            (pairs, 2 * n),
            (two_paths, 4 * n),
            (whole, 62 * n),
            (vec![], n),
        ] {
            let (xadj, adjncy) = graph_of(n, &edges);
            let graph = Graph { xadj: &xadj, adjncy: &adjncy, weights: &vec![1; n], points: &[] };
            let order = dissect(graph, false);
            assert!(is_complete(&order, n));
            let own = fill(&xadj, &adjncy, &order);
            assert!(own <= most, "{} edges: {own} entries, more than {most}", edges.len());
        }
    }

    #[test]
    fn threads_do_not_change_the_order() {
        let (xadj, adjncy, points) = grid(120, 90, 1.0);
        let weights = vec![2; points.len()];
        for points in [points, Vec::new()] {
            let graph = Graph { xadj: &xadj, adjncy: &adjncy, weights: &weights, points: &points };
            let alone = dissect(graph, false);
            let shared = crate::base::pool::run(3, |_| dissect(graph, true));
            assert_eq!(alone, shared);
        }
    }
}
