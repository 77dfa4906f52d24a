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
//!
//! A sharp corner of the master that lies in a slave edge has a constraint of its own. Of the nodes
//! of this edge none meets a side of the corner before the edge does, unless the edge is about
//! parallel to that side: the corner is left to its constraint. Otherwise a node that the corner is
//! about to pass would be caught at its side.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::corners::{DENT, KEPT, LEAST_TURN, across};
use super::super::curve::{Curve, Vec2, dot, outward, sub, unit};
use super::super::master::{Hit, Master};
use super::super::search::{self, Candidate, Item, each};
use super::super::sides::Sides;
use super::super::slave::Slave;
use super::super::slip::{Along, Point, direction, first, firsts};
use super::super::terms::{Function, PAIR, Share, Terms, WIDTH, join, lifted};
use super::super::travel::{Start, Station};
use super::{Discretization, Entry};
use crate::base::{Dual, Hyper, Smooth};

pub const ENTRY: Entry = Entry {
    name: "node_to_segment",
    joins: false,
    integrates: false,
    new: |sides, x| Box::new(NodeToSegment::new(sides, x)),
};

/// Radius of a master, in facets of the slave, up to which its deepest point counts.
const ROUND: f64 = 4.0;
/// Part of a facet beside its ends that is left to its nodes: there both say the same.
const BESIDE: f64 = 0.01;

/// Part of half an edge, of the shorter of both, by which a node may pass its end before another edge
/// takes over; not at a concave corner, where it would go into the other edge meanwhile.
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
        end: Vec2<f64>,
    }
    let found: Vec<Found> = shapes
        .iter()
        .filter_map(|(pair, shape)| {
            let hit = shape.closest(p);
            let size = shape.speed_at(hit.r);
            let beyond = hit.r.abs() - 1.0;
            let faces = dot(shape.normal(&hit), n) < FACING;
            (faces && hit.gap <= bounds.reach && -hit.gap <= bounds.depth).then(|| Found {
                pair: *pair,
                gap: hit.gap,
                beyond,
                distance: hit.gap.hypot(beyond.max(0.0) * size),
                size,
                end: shape.end(usize::from(hit.r > 0.0)),
            })
        })
        .collect();
    let best = found.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))?;
    if let Some(held) = found.iter().find(|f| Some(f.pair) == last) {
        let least = HOLD * held.size.min(best.size);
        if held.beyond * held.size <= least
            && held.distance <= best.distance + least
            && (held.beyond <= 0.0 || best.gap >= -CLEAR * best.size)
        {
            return last;
        }
    }
    if best.beyond <= 0.0 {
        return Some(best.pair);
    }
    // Edges as far away that do not meet there, as on both sides of a hole, are no vertex.
    let near = |f: &&Found| {
        let (close, apart) = (1e-6 * (best.distance + best.size), sub(f.end, best.end));
        f.beyond > 0.0 && f.distance - best.distance <= close && apart[0].hypot(apart[1]) <= close
    };
    let mut vertex: Vec<&Found> = found.iter().filter(near).collect();
    if vertex.len() < 2 {
        return (best.beyond <= HOLD).then_some(best.pair);
    }
    vertex.sort_by(|a, b| b.gap.abs().total_cmp(&a.gap.abs()).then(a.pair.cmp(&b.pair)));
    Some(vertex[0].pair)
}

/// Where a node meets a master, and along which its shear traction acts if it is the slave's.
pub fn met<const D: usize>(
    p: Vec2<Hyper<D>>,
    master: &Master<Hyper<D>>,
) -> (Hit<Hyper<D>>, [Dual<D>; D]) {
    let hit = master.closest(p);
    let apart = firsts(&sub(hit.point, p));
    let along = direction(&Point::Node(p), &Point::of(master, &hit), Along::Master, apart);
    (hit, along)
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
    /// Slave edge of each node with its parameter there, and that of the node behind.
    from: Vec<(usize, f64)>,
    to: Vec<f64>,
    /// Slave edge that ends at each node, or goes on behind it, with the parameter of the node.
    until: Vec<(usize, f64)>,
    /// The masters beyond the sharp corners at both ends of each master, if they have constraints.
    across: Vec<[Option<usize>; 2]>,
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

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], start: Option<&Start>) -> Vec<Terms> {
        let normals = search::nodes(&sides.slave, x);
        let chosen =
            each(sides.n_items(), |k| self.choose(sides, k, normals[k].1, x, self.held[0][k]));
        for (held, pair) in self.held[0].iter_mut().zip(&chosen) {
            *held = pair.0.map(|(p, _)| sides.candidates()[p].1);
        }
        let nodes = chosen.iter().filter_map(|c| c.0.map(|p| (p, false)));
        let facets = chosen.iter().filter_map(|c| c.1.map(|p| ((p, true), true)));
        let pairs: Vec<((usize, bool), bool)> = nodes.chain(facets).collect();
        each(pairs.len(), |i| {
            let ((pair, round), besides) = pairs[i];
            if round {
                self.facet(sides, pair, besides, x, start)
            } else {
                self.node(sides, pair, x, start)
            }
        })
    }

    fn stations(
        &self,
        sides: &Sides,
        x: &[[f64; 3]],
        closed: &dyn Fn(usize) -> bool,
    ) -> Vec<Station> {
        let normals = search::nodes(&sides.slave, x);
        let at = |k: usize| x[sides.slave.nodes[k] as usize];
        let mut found = Vec::new();
        for k in 0..sides.n_items() {
            let (node, facet) = self.choose(sides, k, normals[k].1, x, self.held[1][k]);
            let node = node.map(|(pair, round)| (pair, round, Some(k)));
            let facet = facet.map(|pair| (pair, true, self.of_facet[k]));
            for (pair, round, own) in [node, facet].into_iter().flatten() {
                let j = sides.candidates()[pair].1;
                let (p, master) = (at(k), sides.master.place(j, x));
                let (edge, mut place) = self.from[k];
                let (gap, r) = if round {
                    let q = x[self.next[k] as usize];
                    let (gap, t, hit) = round_gap([p[0], p[1]], [q[0], q[1]], &master);
                    place += (self.to[k] - place) * t;
                    (gap, hit.r)
                } else {
                    let hit = master.closest([p[0], p[1]]);
                    (hit.gap, hit.r)
                };
                let closed = own.is_some_and(closed);
                let (span, opposite) = ([place; 2], [r; 2]);
                let corner = false;
                found.push(Station {
                    point: own,
                    corner,
                    edge,
                    span,
                    master: j,
                    opposite,
                    gap,
                    closed,
                });
            }
        }
        found
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
        let (mut from, mut to) = (vec![(0, 1.0); n], vec![1.0; n]);
        let mut until = vec![(0, -1.0); n];
        for (i, k) in slave.constraints.iter().enumerate() {
            // The edge that begins at a node, rather than the one that ends there.
            from[k[1]] = if from[k[1]].1 < 1.0 { from[k[1]] } else { (i, 1.0) };
            from[k[0]] = (i, -1.0);
            until[k[0]] = if until[k[0]].1 > -1.0 { until[k[0]] } else { (i, -1.0) };
            until[k[1]] = (i, 1.0);
            if k[2] != usize::MAX {
                (from[k[2]], until[k[2]], to[k[0]]) = ((i, 0.0), (i, 0.0), 0.0);
            }
        }
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
        let across = if sides.corners { across(&sides.master, x, LEAST_TURN) } else { Vec::new() };
        let held = [vec![None; n], vec![None; n]];
        Self { next, length, radius, from, to, until, across, of_facet, held }
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
        held: Option<usize>,
    ) -> (Option<(usize, bool)>, Option<usize>) {
        let p = x[sides.slave.nodes[k] as usize];
        let pairs = sides.of_item(k);
        let shapes: Vec<(usize, Master<f64>)> =
            pairs.map(|pair| (pair, sides.master.place(sides.candidates()[pair].1, x))).collect();
        let last = held.and_then(|j| {
            let same = |s: &&(usize, Master<f64>)| sides.candidates()[s.0].1 == j;
            shapes.iter().find(same).map(|s| s.0)
        });
        let bounds = Bounds { reach: sides.distances.reach, depth: sides.depth[k] };
        let found = choose([p[0], p[1]], normal, &shapes, last, bounds);
        let found = found.filter(|&pair| {
            let j = sides.candidates()[pair].1;
            !self.is_left_to_corner(sides, k, j, x, held == Some(j))
        });
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

    /// Whether the side `j` of a sharp corner that a node would meet is no matter of the node: the
    /// corner lies in an edge beside it, which is inclined to the side and would go through the
    /// corner before. A side that `held` the node does so at larger angles.
    fn is_left_to_corner(
        &self,
        sides: &Sides,
        k: usize,
        j: usize,
        x: &[[f64; 3]],
        held: bool,
    ) -> bool {
        let Some(ends) = self.across.get(j).filter(|ends| ends.iter().any(Option::is_some)) else {
            return false;
        };
        let (p, side) = (x[sides.slave.nodes[k] as usize], sides.master.place(j, x));
        let hit = side.closest([p[0], p[1]]);
        let which = usize::from(hit.r > 0.0);
        let Some(other) = ends[which] else { return false };
        let (corner, along) = (side.end(which), 2.0 * which as f64 - 1.0);
        let m = side.normal(&hit);
        // Angle of a normal from that of the side towards that of the side beyond the corner.
        let angle = |n: Vec2<f64>| (along * (m[0] * n[1] - m[1] * n[0])).atan2(dot(m, n));
        let beyond = angle(sides.master.place(other, x).normal_at(-along));
        let least = if held { DENT + KEPT } else { DENT };
        let edges = [self.until[k], self.from[k]].map(|(i, r)| (sides.slave.edges[i].place(x), r));
        let inclined = edges.iter().all(|(edge, r)| {
            let n = unit(outward(edge.slope(*r)));
            (least..beyond + DENT).contains(&angle([-n[0], -n[1]]))
        });
        let lies_in = |edge: &Curve<f64>| {
            let r = edge.foot(corner);
            let deep = -dot(sub(corner, edge.extended(r)), unit(outward(edge.slope(r))));
            r.abs() <= 1.0 && deep <= sides.depth[k]
        };
        inclined && edges.iter().any(|(edge, _)| lies_in(edge))
    }

    /// A facet that meets a round, by the constraint of its first node or its own (`besides`).
    fn facet(
        &self,
        sides: &Sides,
        pair: usize,
        besides: bool,
        x: &[[f64; 3]],
        start: Option<&Start>,
    ) -> Terms {
        let (k, j) = sides.candidates()[pair];
        let variables = self.variables(sides, (k, j));
        let v = lifted::<PAIR>(&variables, x);
        let width = sides.master.variables(j).len();
        let master = sides.master.shape(j, &v[4..4 + width]);
        let (p, q) = ([v[0], v[1]], [v[2], v[3]]);
        let (gap, t, hit) = round_gap(p, q, &master);
        let own = if besides { self.of_facet[k].expect("a facet of a round") } else { k };
        let slip = start.map(|start| {
            let (r, from) = (t.scale(2.0) - Hyper::real(1.0), self.from[k]);
            let place = from.1 + (self.to[k] - from.1) * t.v;
            let path =
                start.slip((from.0, place), (j, hit.r.v), master.normal_at(hit.r.v), Some(own));
            let facet = Curve::line(p, q);
            let points = (Point::Curve(&facet, first(&r)), Point::of(&master, &hit));
            let apart = firsts(&sub(hit.point, facet.at(r)));
            (path, direction(&points.0, &points.1, Along::Slave, apart))
        });
        Self::share(sides, pair, own, variables, &gap, slip)
    }

    fn share<const D: usize>(
        sides: &Sides,
        pair: usize,
        constraint: usize,
        variables: [i64; WIDTH],
        gap: &Hyper<D>,
        slip: Option<(f64, [Dual<D>; D])>,
    ) -> Terms {
        let area = sides.slave.area[sides.candidates()[pair].0];
        let share = Share {
            constraint,
            gap: (&open(*gap, sides.offset[constraint], area)).into(),
            slip: slip.map_or_else(Function::none, |(path, along)| {
                Function::along(path * area, &along.map(|a| a.scale(area)))
            }),
            area,
        };
        Terms { pair, variables, shares: vec![share] }
    }

    fn node(&self, sides: &Sides, pair: usize, x: &[[f64; 3]], start: Option<&Start>) -> Terms {
        let (k, j) = sides.candidates()[pair];
        let variables = self.variables(sides, (k, j));
        // A pair that may meet as a round has the facet's other end among its variables.
        let (v, first) = (lifted::<10>(&variables, x), if self.is_round(k, j) { 4 } else { 2 });
        let width = sides.master.variables(j).len();
        let master = sides.master.shape(j, &v[first..first + width]);
        let p = [v[0], v[1]];
        let Some(start) = start else {
            return Self::share(sides, pair, k, variables, &master.closest(p).gap, None);
        };
        let (hit, along) = met(p, &master);
        let r = hit.r.v;
        let path = start.slip(self.from[k], (j, r), master.normal_at(r), Some(k));
        let path = path * start.stretch(true, j, r, master.way_beside(r, hit.gap.v));
        Self::share(sides, pair, k, variables, &hit.gap, Some((path, along)))
    }
}
