//! Gap and slip of a slave node against the closest point of the master.
//!
//! Beyond an end an edge is continued along its tangent. At a vertex, where a node lies off the
//! ends of both edges, the one with the larger distance decides: outside a convex vertex that
//! is the face the node has passed, inside a concave one the face it violates most. Distances to
//! a point, whose curvature is unbounded, never occur.
//!
//! A round of the master that is no larger than some facets of the slave would sink between two
//! nodes and be lifted by each in turn. Its deepest point is therefore measured against the facet
//! that it faces, too, by a constraint of the facet: a round that ends in a flat may press on a
//! facet while both of its nodes lie on the flat.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::curve::{Vec2, add, dot, fixed, outward, sub, times, unit};
use super::super::master::{Hit, Master};
use super::super::search::{self, Candidate, Item, each};
use super::super::sides::Sides;
use super::super::slave::Slave;
use super::super::terms::{Function, Share, Terms, WIDTH, join, lifted};
use super::{Discretization, Entry};
use crate::base::{Hyper, Smooth};

pub const ENTRY: Entry = Entry {
    name: "node_to_segment",
    joins: false,
    middles: true,
    integrates: false,
    new: |sides, x| Box::new(NodeToSegment::new(sides, x)),
};

/// Radius of a master, in facets of the slave, up to which its deepest point counts.
const ROUND: f64 = 4.0;
/// Part of a facet beside its ends that is left to its nodes: there both say the same.
const BESIDE: f64 = 0.01;

/// Part of half an edge by which a node may pass its end before another edge takes over; not at a
/// concave corner, where it would go into the other edge meanwhile.
const HOLD: f64 = 0.05;
/// Overclosure with another edge that is none, part of half an edge.
const CLEAR: f64 = 1e-9;
/// Largest cosine between the normals of a slave node and of a master it may touch.
const FACING: f64 = 0.2;

/// Bounds within which a node meets a master.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub reach: f64,
    pub depth: f64,
}

/// Chooses among `(pair, shape)` for a node at `p` with normal `n`; `last` is the pair of the
/// evaluation before.
pub fn choose(
    p: Vec2<f64>,
    n: Vec2<f64>,
    shapes: &[(usize, Master<f64>)],
    last: Option<usize>,
    bounds: Bounds,
) -> Option<usize> {
    struct Found {
        pair: usize,
        gap: f64,
        beyond: f64,
        distance: f64,
        size: f64,
    }
    let found: Vec<Found> = shapes
        .iter()
        .filter_map(|(pair, shape)| {
            let hit = shape.closest(p);
            let size = shape.speed(&hit);
            let beyond = hit.r.abs() - 1.0;
            let faces = dot(shape.normal(&hit), n) < FACING;
            (faces && hit.gap <= bounds.reach && -hit.gap <= bounds.depth).then(|| Found {
                pair: *pair,
                gap: hit.gap,
                beyond,
                distance: hit.gap.hypot(beyond.max(0.0) * size),
                size,
            })
        })
        .collect();
    let best = found.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))?;
    if let Some(held) = found.iter().find(|f| Some(f.pair) == last)
        && held.beyond <= HOLD
        && held.distance <= best.distance + HOLD * held.size
        && (held.beyond <= 0.0 || best.gap >= -CLEAR * best.size)
    {
        return last;
    }
    if best.beyond <= 0.0 {
        return Some(best.pair);
    }
    let near = |f: &&Found| {
        f.beyond > 0.0 && f.distance - best.distance <= 1e-6 * (best.distance + best.size)
    };
    let mut vertex: Vec<&Found> = found.iter().filter(near).collect();
    if vertex.len() < 2 {
        return (best.beyond <= HOLD).then_some(best.pair);
    }
    vertex.sort_by(|a, b| b.gap.abs().total_cmp(&a.gap.abs()).then(a.pair.cmp(&b.pair)));
    Some(vertex[0].pair)
}

/// Gap of a node, and its slip since an old configuration of node and master.
pub fn gap_and_slip<T: Smooth>(
    p: Vec2<T>,
    master: &Master<T>,
    old: Option<(Vec2<f64>, &Master<f64>)>,
) -> (T, Option<T>) {
    let hit = master.closest(p);
    let slip = old.map(|(before, plain)| {
        let other = Master::lift(plain);
        let there = master.carry(&hit, &other);
        // Master and slave run against each other.
        let tangent = outward(other.normal(&there));
        dot(sub(there.point, fixed(before)), tangent)
    });
    (hit.gap, slip)
}

/// Gap between the straight facet from `p` to `q` and a round master, at the point of the master
/// that lies deepest, its place on the facet (0 to 1), and that point.
pub fn round_gap<T: Smooth>(p: Vec2<T>, q: Vec2<T>, master: &Master<T>) -> (T, T, Hit<T>) {
    let along = sub(q, p);
    let n = unit(outward(along));
    let hit = master.foremost(n);
    let away = sub(hit.point, p);
    (dot(away, n), dot(away, along) / dot(along, along), hit)
}

/// The same with the slip since an old configuration of facet and master.
pub fn round_gap_and_slip<T: Smooth>(
    [p, q]: [Vec2<T>; 2],
    master: &Master<T>,
    old: Option<([Vec2<f64>; 2], &Master<f64>)>,
) -> (T, Option<T>) {
    let (gap, t, hit) = round_gap(p, q, master);
    let slip = old.map(|([p, q], plain)| {
        let other = Master::lift(plain);
        let there = master.carry(&hit, &other);
        let before = add(fixed(p), times(fixed(sub(q, p)), t));
        dot(sub(there.point, before), outward(other.normal(&there)))
    });
    (gap, slip)
}

/// Area times a distance less an offset.
pub fn open<T: Smooth>(distance: T, offset: f64, area: f64) -> T {
    (distance - T::real(offset)).scale(area)
}

/// Gaps at slave nodes, and of facets between them that meet a round.
pub struct NodeToSegment {
    /// Node behind each slave node, -1 for none, if the facet between them may meet a round of
    /// the master; its length; and the radii of those.
    next: Vec<i64>,
    length: Vec<f64>,
    radius: Vec<f64>,
    /// Constraint of the facet behind each slave node, after those of the nodes, where it has one.
    of_facet: Vec<Option<usize>>,
    /// Master of each node: of the last evaluation, and of the last commit.
    held: [Vec<Option<usize>>; 2],
}

impl Discretization for NodeToSegment {
    fn items(&self, slave: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
        search::nodes(slave, x)
    }

    fn owners(&self, slave: &Slave) -> Vec<Vec<usize>> {
        slave.owners(true)
    }

    /// Nodes, then facets by their first.
    fn places(&self, slave: &Slave) -> Vec<usize> {
        let n = slave.nodes.len();
        (0..n).chain((0..n).filter(|&k| self.of_facet[k].is_some())).collect()
    }

    fn variables(&self, sides: &Sides, (k, j): Candidate) -> [i64; WIDTH] {
        let master = sides.master.variables(j);
        let node = 3 * i64::from(sides.slave.nodes[k]);
        if self.is_round(k, j) {
            let next = 3 * self.next[k];
            join(&[node, node + 1, next, next + 1], &master)
        } else {
            join(&[node, node + 1], &master)
        }
    }

    fn constraints(&self, _: &Sides, (k, j): Candidate) -> [usize; 3] {
        let facet = self.of_facet[k].filter(|_| self.is_round(k, j));
        [k, facet.unwrap_or(usize::MAX), usize::MAX]
    }

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Vec<Terms> {
        let normals = search::nodes(&sides.slave, x);
        let chosen = each(sides.n_items(), |k| self.choose(sides, k, normals[k].1, x));
        for (held, pair) in self.held[0].iter_mut().zip(&chosen) {
            *held = pair.0.map(|(p, _)| sides.candidates()[p].1);
        }
        let nodes = chosen.iter().filter_map(|c| c.0.map(|p| (p, false)));
        let facets = chosen.iter().filter_map(|c| c.1.map(|p| ((p, true), true)));
        let pairs: Vec<((usize, bool), bool)> = nodes.chain(facets).collect();
        each(pairs.len(), |i| {
            let ((pair, round), besides) = pairs[i];
            if round {
                self.facet(sides, pair, besides, x, old)
            } else {
                self.node(sides, pair, x, old)
            }
        })
    }

    fn commit(&mut self) {
        let [now, kept] = &mut self.held;
        kept.clone_from(now);
    }

    fn restore(&mut self) {
        let [now, kept] = &mut self.held;
        now.clone_from(kept);
    }

    fn forget(&mut self) {
        self.held[0].fill(None);
    }

    fn memory(&self) -> Vec<i64> {
        let number = |master: &Option<usize>| master.map_or(-1, |j| j as i64);
        self.held.iter().flatten().map(number).collect()
    }

    fn remember(&mut self, memory: &[i64]) {
        let (now, kept) = memory.split_at(self.next.len());
        let masters = |part: &[i64]| part.iter().map(|&m| usize::try_from(m).ok()).collect();
        self.held = [masters(now), masters(kept)];
    }
}

impl NodeToSegment {
    fn new(sides: &Sides, x: &[[f64; 3]]) -> Self {
        let slave = &sides.slave;
        let n = slave.nodes.len();
        let (mut next, mut length, mut radius) = (vec![-1; n], vec![0.0; n], Vec::new());
        if !sides.itself {
            radius = (0..sides.master.len()).map(|j| sides.master.radius(j, x)).collect();
            for (edge, k) in slave.edges.iter().zip(&slave.constraints) {
                let facets: &[[usize; 2]] =
                    if edge.n_nodes == 3 { &[[0, 2], [2, 1]] } else { &[[0, 1]] };
                for &[a, b] in facets {
                    let ends = [a, b].map(|c| x[edge.nodes[c] as usize]);
                    next[k[a]] = i64::from(edge.nodes[b]);
                    length[k[a]] = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
                }
            }
        }
        let smallest = radius.iter().copied().fold(f64::INFINITY, f64::min);
        let mut count = n;
        let of_facet = (0..n)
            .map(|k| {
                (next[k] >= 0 && smallest <= ROUND * length[k]).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        Self { next, length, radius, of_facet, held: [vec![None; n], vec![None; n]] }
    }

    /// Whether the facet behind a slave node meets a master as a round.
    fn is_round(&self, k: usize, j: usize) -> bool {
        self.next[k] >= 0 && self.radius[j] <= ROUND * self.length[k]
    }

    /// The pair of a node and whether it is met by the facet behind the node, and the pair of a
    /// round that meets this facet besides.
    fn choose(
        &self,
        sides: &Sides,
        k: usize,
        normal: Vec2<f64>,
        x: &[[f64; 3]],
    ) -> (Option<(usize, bool)>, Option<usize>) {
        let p = x[sides.slave.nodes[k] as usize];
        let pairs = sides.of_item(k);
        let shapes: Vec<(usize, Master<f64>)> =
            pairs.map(|pair| (pair, sides.master.place(sides.candidates()[pair].1, x))).collect();
        let last = self.held[0][k].and_then(|j| {
            let same = |s: &&(usize, Master<f64>)| sides.candidates()[s.0].1 == j;
            shapes.iter().find(same).map(|s| s.0)
        });
        let bounds = Bounds { reach: sides.distances.reach, depth: sides.depth[k] };
        let found = choose([p[0], p[1]], normal, &shapes, last, bounds);
        let gap_of = |pair: usize| {
            let shape = &shapes.iter().find(|s| s.0 == pair).expect("a candidate").1;
            shape.closest([p[0], p[1]]).gap
        };
        let mut deepest: Option<(usize, f64, f64)> = None;
        for (pair, shape) in &shapes {
            if !self.is_round(k, sides.candidates()[*pair].1) {
                continue;
            }
            let q = x[self.next[k] as usize];
            let (gap, t, hit) = round_gap([p[0], p[1]], [q[0], q[1]], shape);
            let inside = (0.0..1.0).contains(&t) && hit.r.abs() <= 1.0;
            let near = gap <= bounds.reach && -gap <= bounds.depth;
            if inside && near && deepest.is_none_or(|b| gap <= b.1) {
                deepest = Some((*pair, gap, t));
            }
        }
        let Some((round, gap, t)) = deepest else {
            return (found.map(|pair| (pair, false)), None);
        };
        match found {
            // The node may lie on a flat beside the round: both hold.
            Some(own) if !self.is_round(k, sides.candidates()[own].1) => {
                let beside = (BESIDE..1.0 - BESIDE).contains(&t);
                (Some((own, false)), beside.then_some(round))
            }
            Some(own) if gap_of(own) < gap => (Some((own, false)), None),
            // What meets the round says the same of node and facet.
            _ => (Some((round, true)), None),
        }
    }

    /// A facet that meets a round, by the constraint of its first node or its own (`besides`).
    fn facet(
        &self,
        sides: &Sides,
        pair: usize,
        besides: bool,
        x: &[[f64; 3]],
        old: Option<&[[f64; 3]]>,
    ) -> Terms {
        let (k, j) = sides.candidates()[pair];
        let variables = self.variables(sides, (k, j));
        let v = lifted::<WIDTH>(&variables, x);
        let width = sides.master.variables(j).len();
        let master = sides.master.shape(j, &v[4..4 + width]);
        let ends = |x: &[[f64; 3]]| {
            [i64::from(sides.slave.nodes[k]), self.next[k]].map(|n| {
                let p = x[n as usize];
                [p[0], p[1]]
            })
        };
        let before = old.map(|o| (ends(o), sides.master.place(j, o)));
        let before = before.as_ref().map(|(ends, m)| (*ends, m));
        let (gap, slip) = round_gap_and_slip([[v[0], v[1]], [v[2], v[3]]], &master, before);
        let own = if besides { self.of_facet[k].expect("a facet of a round") } else { k };
        Self::share(sides, pair, own, variables, &gap, slip.as_ref())
    }

    fn share<const D: usize>(
        sides: &Sides,
        pair: usize,
        constraint: usize,
        variables: [i64; WIDTH],
        gap: &Hyper<D>,
        slip: Option<&Hyper<D>>,
    ) -> Terms {
        let area = sides.slave.area[sides.candidates()[pair].0];
        let share = Share {
            constraint,
            gap: (&open(*gap, sides.offset[constraint], area)).into(),
            slip: slip.map_or_else(Function::none, |s| (&open(*s, 0.0, area)).into()),
            area,
        };
        Terms { pair, variables, shares: vec![share] }
    }

    fn node(&self, sides: &Sides, pair: usize, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Terms {
        let (k, j) = sides.candidates()[pair];
        let variables = self.variables(sides, (k, j));
        // A pair that may meet as a round has the facet's other end among its variables.
        let (v, first) = (lifted::<10>(&variables, x), if self.is_round(k, j) { 4 } else { 2 });
        let width = sides.master.variables(j).len();
        let master = sides.master.shape(j, &v[first..first + width]);
        let before = old.map(|o| {
            let p = o[sides.slave.nodes[k] as usize];
            ([p[0], p[1]], sides.master.place(j, o))
        });
        let before = before.as_ref().map(|(p, m)| (*p, m));
        let (gap, slip) = gap_and_slip([v[0], v[1]], &master, before);
        Self::share(sides, pair, k, variables, &gap, slip.as_ref())
    }
}
