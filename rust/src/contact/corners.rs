//! Sharp convex corners against the edges of the other side.
//!
//! Constraints of the slave's nodes and edges say nothing about a corner of the master between two
//! nodes: it would sink into the edge without force. Where gaps are means over edges, a corner of
//! the slave sinks in as well, and a body that rests on one would drop when the other has passed.
//! Such corners therefore have constraints of their own: the gap to the closest edge of the other
//! side, and the slip along it, by the kernels of a node against an edge. For corners of the master
//! their roles are exchanged; the signs are those of the slave's other constraints.
//!
//! Where the master is the surface of a body and ends, its last point is such a corner, too: the body
//! is taken to turn there by a right angle. So a block tips on a slave about its edge, though its sides
//! belong to no surface, and a slave that lies over the end of its master is supported there.
//!
//! A fillet of a rigid master that is not larger than some slave edges sinks in like a sharp corner where
//! gaps are means. It is the corner at its center, with its radius taken off the gap.
// SPDX-License-Identifier: BSD-3-Clause

use super::boundary::followers;
use super::curve::{Vec2, add, dot, sub, unit};
use super::discretization::node_to_segment::{Bounds, choose, met, open};
use super::master::{Hit, Master, Surface};
use super::search::{self, Candidate, Item, Search, each};
use super::sides::Sides;
use super::slip::{Along, Point, direction, firsts};
use super::terms::{Function, Share, Terms, WIDTH, join, lifted};
use super::travel::{Start, Station};
use crate::base::{Hyper, Smooth};
use std::ops::Range;

/// Least turn of the boundary at a corner [rad]: 50 degrees, since the constraints at both sides of
/// a blunter one keep it out.
pub const LEAST_TURN: f64 = 0.872_664_625_997_164_8;
/// The same on a slave that meets a master with corners: 20 degrees. Its gaps are means over edges,
/// and would let it drop into the master's corner when that has passed a node.
pub const LEAST_TURN_AT_CORNERS: f64 = 0.349_065_850_398_865_9;
/// Least turn at a vertex between flat members of a master, as no mesh of a round has [rad]: 3 degrees.
const BLUNT: f64 = 0.05;
/// Tilt of an edge out of the cone between the normals of a corner's sides, with which the corner
/// still meets it [rad]: edges dent. Beyond it a side of the corner meets the edge.
pub const DENT: f64 = 0.35;
/// And a further tilt up to which it still meets the edge that it met before [rad]. As the tilt of an
/// edge passes `DENT`, the corner may lie inside: in force on one side of this angle and absent on the
/// other, with no equilibrium on either.
pub const KEPT: f64 = 0.175;
/// Part of the last edge of a slave, from its end on, where the end of a master is no constraint of
/// its own: the slave's end is there, and both would be one constraint twice.
const SAME_END: f64 = 0.1;
/// Turn of a rigid round over the longest slave edge [rad] from which it is a fillet between two nodes.
pub const STEEP: f64 = 0.5;
/// Most turn of a fillet [rad]: somewhat less than half a turn.
const MOST_TURN: f64 = 3.1;
/// Turn of a surface from which it is round and not flat.
pub const ROUND: f64 = 1e-3;
/// Most variables of an edge and a corner.
const OWN: usize = 9;

/// A corner: the member of its side that ends there, and the one that begins; at an end of the side
/// one of them. That of a fillet has the fillet's first and last piece, and its radius.
#[derive(Clone, Copy, Debug)]
struct Corner {
    before: Option<usize>,
    behind: Option<usize>,
    radius: f64,
}

impl Corner {
    /// A member at the corner, and which of its ends that is.
    fn end(&self) -> (usize, usize) {
        let ends = [self.before.map(|j| (j, 1)), self.behind.map(|j| (j, 0))];
        ends.into_iter().flatten().next().expect("a corner has a member")
    }

    /// The same with the parameter there.
    fn place(&self) -> (usize, f64) {
        let (member, which) = self.end();
        (member, 2.0 * which as f64 - 1.0)
    }

    /// Pieces of a fillet.
    fn pieces(&self) -> Range<usize> {
        match (self.before, self.behind) {
            (Some(first), Some(last)) if self.radius > 0.0 => first..last + 1,
            _ => 0..0,
        }
    }

    fn members(&self) -> impl Iterator<Item = usize> {
        [self.before, self.behind].into_iter().flatten()
    }
}

/// Corners of a side, whose constraints follow those of the surfaces.
pub struct Corners {
    list: Vec<Corner>,
    /// Number of the first constraint.
    first: usize,
    /// Side of the corners, and what they are measured against.
    own: Surface,
    faces: Surface,
    of_slave: bool,
    /// Which ends of each member of the other side no member follows.
    open: Vec<[bool; 2]>,
    /// Penetration of each slave edge that counts.
    depth: Vec<f64>,
    /// Slave node next to each corner in the reference configuration, by its place.
    nearest: Vec<usize>,
    /// Reference area of every constraint: that of a slave edge, on average.
    area: f64,
    search: Search,
    /// The same where slips are measured from.
    search_of_start: Search,
    /// Number of each corner's first candidate.
    index: Vec<usize>,
    /// Member of the other side that each corner met: in the last evaluation, and in the last commit.
    held: [Vec<Option<usize>>; 2],
    /// Whether slave nodes have constraints against edges before theirs in a boundary that meets
    /// itself.
    nodal: bool,
}

impl Corners {
    /// Corners of the slave or of the master that turn by more than `least`, and ends of a master; `first`
    /// constraints come before, those of the surfaces at nodes if `nodal`.
    pub fn new(
        sides: &Sides,
        x: &[[f64; 3]],
        first: usize,
        nodal: bool,
        (of_slave, least): (bool, f64),
    ) -> Self {
        let slave = &sides.slave;
        let edges = Surface::Edges(slave.edges.clone());
        let (own, faces) =
            if of_slave { (edges, sides.master.clone()) } else { (sides.master.clone(), edges) };
        let deformable = matches!(own, Surface::Edges(_));
        let mut list = sharp(&own, x, least, !of_slave && deformable && !sides.itself);
        if !of_slave && !nodal {
            let longest = slave.edges.iter().map(|e| e.length).fold(0.0, f64::max);
            list.extend(fillets(&own, x, longest));
        }
        let open = open_ends(&faces, x);
        let part = if sides.itself { 1.0 } else { 2.0 };
        let depth = if list.is_empty() {
            Vec::new()
        } else {
            let half = search::half_thickness(slave, x);
            half.into_iter().map(|h| (part * h).min(sides.distances.depth)).collect()
        };
        let nearest = list.iter().map(|c| {
            let p = point(&own, *c, x);
            let square = |k: &usize| {
                let q = x[slave.nodes[*k] as usize];
                (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)
            };
            (0..slave.nodes.len())
                .min_by(|a, b| square(a).total_cmp(&square(b)))
                .expect("a slave has nodes")
        });
        let nearest = nearest.collect();
        Self {
            nearest,
            area: slave.area.iter().sum::<f64>() / slave.edges.len() as f64,
            own,
            faces,
            of_slave,
            open,
            depth,
            held: [vec![None; list.len()], vec![None; list.len()]],
            search: Search::default(),
            search_of_start: Search::default(),
            index: Vec::new(),
            list,
            first,
            nodal,
        }
    }

    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether any is a corner and no end.
    pub fn turns(&self) -> bool {
        self.list.iter().any(|c| c.before.is_some() && c.behind.is_some())
    }

    pub fn area(&self) -> f64 {
        self.area
    }

    /// Slave node next to each corner, by its place in the slave's nodes.
    pub fn nearest(&self) -> &[usize] {
        &self.nearest
    }

    /// Mesh node of each corner, -1 for those of a rigid body.
    pub fn nodes(&self) -> Vec<i64> {
        let node = |c: &Corner| match (&self.own, c.end()) {
            (Surface::Edges(edges), (j, which)) => edges[j].nodes[which].into(),
            _ => -1,
        };
        self.list.iter().map(node).collect()
    }

    /// Corners and members of the other side that may meet.
    pub fn candidates(&self) -> &[Candidate] {
        &self.search.candidates
    }

    /// Renews the candidates where needed; tells whether they changed.
    pub fn renew(&mut self, sides: &Sides, x: &[[f64; 3]]) -> bool {
        if self.list.is_empty() {
            return false;
        }
        let items: Vec<Item> = self.list.iter().map(|c| item(&self.own, *c, x)).collect();
        let (list, nodal) = (&self.list, self.nodal);
        let allowed = |c: usize, i: usize| !sides.itself || free(sides, list[c], i, nodal);
        let distances = sides.distances;
        let changed =
            self.search.update(items, &self.faces, x, distances.reach, distances.margin, allowed);
        if changed {
            self.number();
        }
        changed
    }

    fn number(&mut self) {
        let candidates = &self.search.candidates;
        self.index =
            (0..=self.list.len()).map(|c| candidates.partition_point(|own| own.0 < c)).collect();
    }

    /// Variables of a candidate: those of the slave's edge or corner, then of the other side.
    pub fn variables(&self, (c, i): Candidate) -> [i64; WIDTH] {
        let own = self.of_corner(c);
        let faces = self.faces.variables(i);
        if self.of_slave { join(&own, &faces) } else { join(&faces, &own) }
    }

    /// Variables of a corner.
    fn of_corner(&self, c: usize) -> Vec<i64> {
        let (member, which) = self.list[c].end();
        match &self.own {
            Surface::Edges(edges) => {
                let node = 3 * i64::from(edges[member].nodes[which]);
                vec![node, node + 1]
            }
            rigid => rigid.variables(member),
        }
    }

    /// Penetration up to which a corner may be inside a member of the other side.
    fn deepest(&self, c: usize, i: usize) -> f64 {
        if self.of_slave {
            self.list[c].members().map(|j| self.depth[j]).fold(f64::INFINITY, f64::min)
        } else {
            self.depth[i]
        }
    }

    /// Constraint of a corner.
    pub fn constraint(&self, c: usize) -> usize {
        self.first + c
    }

    /// Terms of all corners that meet an edge at `x`; slips since a start. Candidates are numbered
    /// from `from`.
    pub fn evaluate(
        &mut self,
        sides: &Sides,
        x: &[[f64; 3]],
        start: Option<&Start>,
        from: usize,
    ) -> Vec<Terms> {
        if self.index.is_empty() {
            return Vec::new();
        }
        let found = each(self.list.len(), |c| self.meets(sides, c, x, self.held[0][c]));
        for (held, pair) in self.held[0].iter_mut().zip(&found) {
            *held = pair.map(|p| self.search.candidates[p].1);
        }
        let terms = |pair: usize| self.terms(sides, pair, x, start, from);
        found.into_iter().flatten().map(terms).collect()
    }

    /// The candidate whose edge a corner meets.
    fn meets(
        &self,
        sides: &Sides,
        c: usize,
        x: &[[f64; 3]],
        before: Option<usize>,
    ) -> Option<usize> {
        let corner = self.list[c];
        let (p, [first, second]) = (point(&self.own, corner, x), normals(&self.own, corner, x));
        let normal = unit(add(first, second));
        // Half the angle of the cone of normals, and how far an edge may be out of it.
        let half = dot(normal, first).clamp(-1.0, 1.0).acos();
        let facing = |tilt: f64| (half + tilt).min(0.5 * std::f64::consts::PI).cos();
        let (facing, kept) = (facing(DENT), facing(DENT + KEPT));
        let shape = |pair: usize| {
            let i = self.search.candidates[pair].1;
            let edge = self.faces.place(i, x);
            let hit = edge.closest(p);
            let least = if before == Some(i) { kept } else { facing };
            let deep = corner.radius - hit.gap;
            let meets = dot(edge.normal(&hit), normal) <= -least && deep <= self.deepest(c, i);
            meets.then_some((pair, edge))
        };
        let shapes: Vec<(usize, Master<f64>)> =
            (self.index[c]..self.index[c + 1]).filter_map(shape).collect();
        let last = before.and_then(|i| {
            shapes.iter().map(|s| s.0).find(|&pair| self.search.candidates[pair].1 == i)
        });
        let bounds = Bounds { reach: sides.distances.reach, depth: f64::INFINITY };
        let chosen = |last: Option<usize>| choose(p, normal, &shapes, last, bounds);
        // Beyond a ridge an edge is continued outside of the body: the corner is not there yet.
        let gap = |pair: usize| {
            shapes.iter().find(|s| s.0 == pair).map_or(f64::NEG_INFINITY, |s| s.1.closest(p).gap)
        };
        let (kept, closest) = (chosen(last)?, chosen(None)?);
        let met = if gap(closest) > gap(kept) { closest } else { kept };
        let at_end = || {
            let i = self.search.candidates[met].1;
            let r = self.faces.place(i, x).closest(p).r;
            let from_end = 1.0 - r.abs();
            self.open[i][usize::from(r > 0.0)] && from_end < 2.0 * SAME_END
        };
        let is_end = corner.members().count() == 1;
        (!(is_end && at_end())).then_some(met)
    }

    fn terms(
        &self,
        sides: &Sides,
        pair: usize,
        x: &[[f64; 3]],
        start: Option<&Start>,
        from: usize,
    ) -> Terms {
        let (c, i) = self.search.candidates[pair];
        let corner = self.list[c];
        let variables = self.variables((c, i));
        let v = lifted::<OWN>(&variables, x);
        let [own, other] = [self.of_corner(c).len(), self.faces.variables(i).len()];
        let [at, from_other] = if self.of_slave { [0, own] } else { [other, 0] };
        let round = corner.radius > 0.0;
        let p = match &self.own {
            Surface::Edges(_) => [v[at], v[at + 1]],
            rigid => {
                let (member, which) = corner.end();
                let shape = rigid.shape(member, &v[at..at + own]);
                if round { shape.center() } else { shape.end(which) }
            }
        };
        let face = self.faces.shape(i, &v[from_other..from_other + other]);
        let (mut hit, mut along) = met(p, &face);
        let n = face.normal(&hit);
        let place = self.place(corner, n.map(|n| n.v), x);
        if round {
            let arc = self.own.shape(place.0, &v[at..at + own]);
            let own = arc.closest(sub(p, n.map(|n| n.scale(corner.radius))));
            let apart = firsts(&sub(hit.point, own.point));
            let points = (Point::of(&arc, &own), Point::of(&face, &hit));
            along = direction(&points.0, &points.1, Along::Master, apart);
            hit.gap = hit.gap - Hyper::real(corner.radius);
        }
        let (constraint, r) = (self.constraint(c), hit.r.v);
        let slip = start.map_or_else(Function::none, |start| {
            let ends = if self.of_slave { [place, (i, r)] } else { [(i, r), place] };
            let normal = face.normal_at(r);
            let normal = if self.of_slave { normal } else { normal.map(|c| -c) };
            let path = start.slip(ends[0], ends[1], normal, Some(constraint));
            let path = path * start.stretch(self.of_slave, i, r, face.way_beside(r, hit.gap.v));
            // The direction is that of a node of the slave; seen from the other side it is the same.
            Function::along(path * self.area, &along.map(|a| a.scale(self.area)))
        });
        let share = Share {
            constraint,
            gap: (&open(hit.gap, sides.offset[constraint], self.area)).into(),
            slip,
            area: self.area,
        };
        Terms { pair: from + pair, variables, shares: vec![share] }
    }

    /// Member and parameter at which a corner meets a face of a normal.
    fn place(&self, corner: Corner, normal: Vec2<f64>, x: &[[f64; 3]]) -> (usize, f64) {
        let deepest = |j: usize| {
            let arc = self.own.place(j, x);
            arc.closest(sub(arc.center(), normal)).r
        };
        let pieces = corner.pieces().map(|j| (j, deepest(j)));
        let found = pieces.min_by(|p, q| p.1.abs().total_cmp(&q.1.abs()));
        found.unwrap_or_else(|| corner.place())
    }

    /// Where corners meet the other side at `x`, with candidates that belong to it.
    pub fn stations(
        &mut self,
        sides: &Sides,
        x: &[[f64; 3]],
        closed: &dyn Fn(usize) -> bool,
    ) -> Vec<Station> {
        std::mem::swap(&mut self.search, &mut self.search_of_start);
        self.renew(sides, x);
        self.number();
        let station = |(c, &corner): (usize, &Corner)| {
            let own = self.constraint(c);
            let i = self.search.candidates[self.meets(sides, c, x, self.held[1][c])?].1;
            let face = self.faces.place(i, x);
            let hit = face.closest(point(&self.own, corner, x));
            let place = self.place(corner, face.normal(&hit), x);
            let [(edge, place), (master, r)] =
                if self.of_slave { [place, (i, hit.r)] } else { [(i, hit.r), place] };
            let (gap, closed) = (hit.gap - corner.radius, closed(own));
            let (span, opposite) = ([place; 2], [r; 2]);
            Some(Station {
                point: Some(own),
                corner: true,
                edge,
                span,
                master,
                opposite,
                gap,
                closed,
            })
        };
        let found = self.list.iter().enumerate().filter_map(station).collect();
        std::mem::swap(&mut self.search, &mut self.search_of_start);
        self.number();
        found
    }

    pub fn commit(&mut self) {
        let [now, kept] = &mut self.held;
        kept.clone_from(now);
    }

    pub fn restore(&mut self) {
        let [now, kept] = &mut self.held;
        now.clone_from(kept);
    }

    pub fn forget(&mut self) {
        self.held[0].fill(None);
    }

    /// Members that the corners met, or -1.
    pub fn memory(&self) -> Vec<i64> {
        self.held.iter().flatten().map(|held| held.map_or(-1, |i| i as i64)).collect()
    }

    /// Places that the candidates were found for.
    pub fn places(&self) -> Vec<f64> {
        self.search.places()
    }

    /// Number of these places once there are candidates.
    pub fn n_places(&self) -> usize {
        6 * (self.list.len() + self.faces.len())
    }

    /// Take `memory`, places and candidates of the same corners; `false` if they do not fit.
    pub fn resume(&mut self, memory: &[i64], places: &[f64], found: Vec<Candidate>) -> bool {
        let (n, faces) = (self.list.len(), self.faces.len());
        let inside = |p: &Candidate| p.0 < n && p.1 < faces;
        let known = places.len() == self.n_places() || (places.is_empty() && found.is_empty());
        let held = |i: &i64| *i >= -1 && *i < faces as i64;
        if !known
            || memory.len() != 2 * n
            || !memory.iter().all(held)
            || !found.is_sorted()
            || !found.iter().all(inside)
        {
            return false;
        }
        let (now, kept) = memory.split_at(n);
        let numbers = |part: &[i64]| part.iter().map(|&i| usize::try_from(i).ok()).collect();
        self.held = [numbers(now), numbers(kept)];
        if places.is_empty() {
            return true;
        }
        let fits = self.search.restore(n, places, found);
        if fits {
            self.number();
        }
        fits
    }
}

/// Whether a corner of a boundary that meets itself may meet an edge: one that it shares no node
/// with, that is not around a corner from it, and that its node has no constraint against.
fn free(sides: &Sides, corner: Corner, i: usize, nodal: bool) -> bool {
    let own: Vec<usize> = corner.members().collect();
    let edges = &sides.slave.edges;
    let apart = |&j: &usize| !edges[j].nodes().iter().any(|n| edges[i].nodes().contains(n));
    let around = own.iter().any(|&j| sides.is_around_corner(j, i));
    own.iter().all(apart) && !around && !(nodal && sides.apart(&own, i))
}

/// A corner, or the center of a fillet.
fn point(own: &Surface, corner: Corner, x: &[[f64; 3]]) -> Vec2<f64> {
    let (member, which) = corner.end();
    let shape = own.place(member, x);
    if corner.radius > 0.0 { shape.center() } else { shape.end(which) }
}

/// Outward normals of the member that ends at a corner and of that which begins. Where there is none,
/// the boundary turns left by a right angle.
fn normals(master: &Surface, corner: Corner, x: &[[f64; 3]]) -> [Vec2<f64>; 2] {
    let normal = |j: usize, which: usize| normal_at(&master.place(j, x), which);
    let round = usize::from(corner.radius > 0.0);
    let (before, behind) =
        (corner.before.map(|j| normal(j, 1 - round)), corner.behind.map(|j| normal(j, round)));
    match (before, behind) {
        (Some(a), Some(b)) => [a, b],
        (Some([a, b]), None) => [[a, b], [-b, a]],
        (None, Some([a, b])) => [[b, -a], [a, b]],
        (None, None) => unreachable!("a corner has a member"),
    }
}

/// Outward normal at the first or second end.
fn normal_at(member: &Master<f64>, which: usize) -> Vec2<f64> {
    member.normal(&Hit { gap: 0.0, r: 2.0 * which as f64 - 1.0, point: member.end(which) })
}

/// Angle from one normal to the next, counterclockwise.
pub fn turn([a, b]: [Vec2<f64>; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(dot(a, b))
}

fn item(master: &Surface, corner: Corner, x: &[[f64; 3]]) -> Item {
    let (p, [a, b]) = (point(master, corner, x), normals(master, corner, x));
    let r = corner.radius;
    ([p[0] - r, p[1] - r, p[0] + r, p[1] + r], unit(add(a, b)))
}

/// Which ends of the members of a surface no member follows.
pub fn open_ends(surface: &Surface, x: &[[f64; 3]]) -> Vec<[bool; 2]> {
    let next = followers(surface, x);
    let mut open: Vec<[bool; 2]> = next.iter().map(|j| [true, j.is_none()]).collect();
    next.iter().flatten().for_each(|&j| open[j][0] = false);
    open
}

/// Which edges of a surface are convex, or end at a convex vertex that is no sharp corner.
pub fn round(surface: &Surface, x: &[[f64; 3]]) -> Vec<bool> {
    let bulges = |j: usize| {
        let edge = surface.place(j, x);
        match &edge {
            Master::Arc(arc) => arc.half > 0.0,
            Master::Curve(_) => turn([0, 1].map(|which| normal_at(&edge, which))) > ROUND,
        }
    };
    let mut round: Vec<bool> = (0..surface.len()).map(bulges).collect();
    let vertices = sharp(surface, x, ROUND, false);
    for vertex in vertices.iter().filter(|v| turn(normals(surface, **v, x)) <= LEAST_TURN) {
        vertex.members().for_each(|j| round[j] = true);
    }
    round
}

/// The members beyond both ends of each member of a master where it turns left by more than `least`.
pub fn across(master: &Surface, x: &[[f64; 3]], least: f64) -> Vec<[Option<usize>; 2]> {
    let mut across = vec![[None; 2]; master.len()];
    for corner in sharp(master, x, least, false) {
        let (Some(i), Some(j)) = (corner.before, corner.behind) else { continue };
        (across[i][1], across[j][0]) = (Some(j), Some(i));
    }
    across
}

/// Corners at which the boundary, with the body on its left, turns left sharply, and its ends.
fn sharp(master: &Surface, x: &[[f64; 3]], least: f64, ends: bool) -> Vec<Corner> {
    let turns = |&corner: &Corner| turn(normals(master, corner, x)) > least;
    let next = followers(master, x);
    let mut first = vec![ends; next.len()];
    next.iter().flatten().for_each(|&j| first[j] = false);
    let met =
        |(j, &behind): (usize, &Option<usize>)| Corner { before: Some(j), behind, radius: 0.0 };
    let begin = |(j, _): (usize, &bool)| Corner { before: None, behind: Some(j), radius: 0.0 };
    next.iter()
        .enumerate()
        .map(met)
        .filter(|c| ends || c.behind.is_some())
        .chain(first.iter().enumerate().filter(|(_, first)| **first).map(begin))
        .filter(turns)
        .collect()
}

/// The convex fillets of a rigid master that turn sharply between two nodes of a slave with edges up
/// to `longest`.
fn fillets(master: &Surface, x: &[[f64; 3]], longest: f64) -> Vec<Corner> {
    let arc = |j: usize| match master.place(j, x) {
        Master::Arc(arc) => Some(arc),
        Master::Curve(_) => None,
    };
    let radius = |j: usize| arc(j).map_or(f64::INFINITY, |arc| arc.signed_radius());
    let same = |i: usize, j: usize| arc(i).zip(arc(j)).is_some_and(|(a, b)| a.same_circle(&b));
    let mut list: Vec<Corner> = Vec::new();
    for j in (0..master.len()).filter(|&j| (0.0..=longest / STEEP).contains(&radius(j))) {
        match list.last_mut() {
            Some(c) if c.behind == j.checked_sub(1) && same(j - 1, j) => c.behind = Some(j),
            _ => list.push(Corner { before: Some(j), behind: Some(j), radius: radius(j) }),
        }
    }
    let sweep = |j: usize| arc(j).map_or(0.0, |arc| arc.sweep());
    // A pin that the slave may meet on both sides is no corner.
    list.retain(|c| (LEAST_TURN..MOST_TURN).contains(&c.pieces().map(sweep).sum()));
    list
}

/// Which members of a master are pieces of a fillet, and which of their ends are at vertices or in a
/// fillet.
pub fn at_corners(master: &Surface, x: &[[f64; 3]], longest: f64) -> (Vec<bool>, Vec<[bool; 2]>) {
    let (mut fillet, mut ends) = (vec![false; master.len()], vec![[false; 2]; master.len()]);
    let normal = |j: usize, which: usize| normal_at(&master.place(j, x), which);
    let flat = |j: usize| turn([normal(j, 0), normal(j, 1)]).abs() <= ROUND;
    for (i, behind) in followers(master, x).iter().enumerate() {
        if let Some(j) = *behind
            && let turn = turn([normal(i, 1), normal(j, 0)])
            && (turn > LEAST_TURN || (turn.abs() > BLUNT && flat(i) && flat(j)))
        {
            (ends[i][1], ends[j][0]) = (true, true);
        }
    }
    for j in fillets(master, x, longest).iter().flat_map(Corner::pieces) {
        (fillet[j], ends[j]) = (true, [true; 2]);
    }
    (fillet, ends)
}
