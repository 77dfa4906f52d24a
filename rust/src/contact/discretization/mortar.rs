//! Mortar integrals of gap and slip over the covered part of a slave edge.
//!
//! From each slave point a ray along the slave normal meets the master at distance g. Weighted with
//! functions phi of the slave nodes and integrated with the reference area, G = int phi g dA; the
//! limits are the feet of the master's ends on the slave edge and are differentiated with everything
//! else. Slips are weighted in the same way; their tractions act along the relative tangential
//! velocity, with weights and limits held.
//!
//! The functions sum to one, so that a uniform pressure passes the patch test. docs/theory.md says
//! which are where. Those that are biorthogonal to the shape functions give G = A g at each node of a
//! gap of their order. A linear edge has them only if it is round, at an end of the slave or against a
//! curved master, whose height over its chord is taken out of the gap; all quadratic edges have them.
//! Elsewhere functions are positive.
//!
//! Where the master ends within an edge with biorthogonal functions, xi runs over the covered part, as
//! if the edge ended there: else the area of a node would be negative. It ends at vertices of the
//! master, too: of the gap beside a vertex, which opens to both sides, the functions would see a
//! negative value at a node that is apart. Fillets smaller than two edges are corners, under which
//! functions are positive. An end that a support guides is none.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::corners::{self, DENT, STEEP, across, at_corners, open_ends, round};
use super::super::curve::{Curve, GAUSS, dot, lift, middle_of, outward, times, unit};
use super::super::master::{Master, Surface};
use super::super::search::each;
use super::super::sides::Sides;
use super::super::slave::Depth;
use super::super::slip::{Along, Point, direction, first, firsts};
use super::super::terms::{Function, PAIR, Share, Terms, WIDTH, distinct, join, lifted};
use super::super::travel::{Start, Station, ray};
use super::{Discretization, Entry};
use crate::base::{Dual, Hyper, Smooth};

pub const ENTRY: Entry = Entry {
    name: "mortar",
    joins: false,
    integrates: true,
    new: |sides, x| Box::new(Mortar::new(sides, x)),
};

/// Least cosine between the slave normal and the opposite of the master's: the side of a block
/// that stands on the slave is no part of its foot, though the slave's dent tilts towards it.
const FACING: f64 = 0.3;
/// The same for arcs, which are left behind gradually.
const FACING_ARC: f64 = 0.05;
/// Turn of a curved master over the longest slave edge [rad] from which it counts.
const FLAT: f64 = 1e-3;
/// Common length of two overlaps, in the slave parameter, that is no more than rounding.
const TOUCH: f64 = 1e-9;

/// What ends an overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The slave edge's end, or the place where a closer master begins.
    Fixed(f64),
    /// The foot of the master's first or second end.
    Foot(usize),
}

/// Part of a slave edge that sees a master.
#[derive(Clone, Copy, Debug)]
pub struct Overlap {
    /// Number of the candidate.
    pub pair: usize,
    pub limits: [Limit; 2],
    pub values: [f64; 2],
    /// Gap at the middle.
    pub gap: f64,
}

/// Part of the slave edge opposite to a master, if they face each other within the bounds:
/// nowhere deeper than `depth` and somewhere closer than `reach`.
pub fn overlap(
    pair: usize,
    slave: &Curve<f64>,
    master: &Master<f64>,
    reach: f64,
    depth: f64,
) -> Option<Overlap> {
    let mut limits = [Limit::Fixed(-1.0), Limit::Fixed(1.0)];
    let mut values = [-1.0, 1.0];
    // Facing edges run against each other.
    let (low, high) = (slave.foot(master.end(1)), slave.foot(master.end(0)));
    if low.is_nan() || high.is_nan() {
        return None;
    }
    if low > -1.0 {
        (limits[0], values[0]) = (Limit::Foot(1), low);
    }
    if high < 1.0 {
        (limits[1], values[1]) = (Limit::Foot(0), high);
    }
    if values[1] - values[0] <= TOUCH {
        return None;
    }
    let steep = match master {
        Master::Curve(_) => FACING,
        Master::Arc(_) => FACING_ARC,
    };
    let [mut least, mut most, mut gap] = [f64::INFINITY, f64::NEG_INFINITY, 0.0];
    for (i, (r, _)) in GAUSS.iter().enumerate() {
        let xi = 0.5 * (values[0] + values[1]) + 0.5 * r * (values[1] - values[0]);
        let t = slave.slope(xi);
        let n = unit(outward(t));
        let hit = master.ray(slave.at(xi), t, n);
        let facing = dot(master.normal(&hit), n);
        if hit.gap.is_nan() || facing.is_nan() || facing > -steep || hit.r.abs() > 1.5 {
            return None;
        }
        least = least.min(hit.gap);
        most = most.max(-hit.gap);
        if i == 1 {
            gap = hit.gap;
        }
    }
    (least <= reach && most <= depth).then_some(Overlap { pair, limits, values, gap })
}

/// Where a slave edge sees several masters one behind the other, leaves it the closest.
pub fn clip_occluded(overlaps: &mut Vec<Overlap>) {
    let mut order: Vec<usize> = (0..overlaps.len()).collect();
    order.sort_by(|&a, &b| overlaps[a].gap.abs().total_cmp(&overlaps[b].gap.abs()));
    let mut seen: Vec<Overlap> = Vec::with_capacity(order.len());
    for i in order {
        let mut o = overlaps[i];
        for s in &seen {
            let low = o.values[0].max(s.values[0]);
            let high = o.values[1].min(s.values[1]);
            if high - low <= TOUCH {
                continue;
            }
            // The larger visible side stays.
            let side = usize::from(s.values[0] - o.values[0] < o.values[1] - s.values[1]);
            let cut = if side == 0 { s.values[0] } else { s.values[1] };
            o.values[1 - side] = cut;
            o.limits[1 - side] = Limit::Fixed(cut);
        }
        if o.values[1] - o.values[0] > TOUCH {
            seen.push(o);
        }
    }
    seen.sort_by_key(|o| o.pair);
    *overlaps = seen;
}

/// Part of a slave edge that masters without a corner between them cover, by the overlaps that begin and
/// end it.
#[derive(Clone, Copy, Debug)]
struct Covered {
    ends: [Overlap; 2],
}

impl Covered {
    /// Whether this is the whole edge.
    fn is_whole(&self) -> bool {
        (0..2).all(|end| self.limit(end).0 == Limit::Fixed(2.0 * end as f64 - 1.0))
    }

    /// Whether one overlap covers it.
    fn is(&self, overlap: &Overlap) -> bool {
        self.ends.iter().all(|end| end.pair == overlap.pair)
    }

    /// Limit at an end, and the overlap that it belongs to.
    fn limit(&self, end: usize) -> (Limit, usize) {
        (self.ends[end].limits[end], self.ends[end].pair)
    }
}

/// Part of a slave edge that its functions run over.
enum Run<const D: usize> {
    Edge,
    /// What the master covers.
    Overlap,
    /// Up to these ends.
    Between([Hyper<D>; 2]),
}

/// Functions of the nodes of an edge: coefficients of the powers of the place from -1 to 1.
type Functions = [[f64; 3]; 3];

/// Positive functions with the integrals of the shape functions, on a linear edge these.
fn positive(n: usize) -> Functions {
    if n == 2 {
        [[0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [0.0; 3]]
    } else {
        // (1 / sqrt 3 -+ xi)^2 / 4 of the corners.
        let (value, slope) = (1.0 / 12.0, 0.5 / 3f64.sqrt());
        [[value, -slope, 0.25], [value, slope, 0.25], [1.0 - 2.0 * value, 0.0, -0.5]]
    }
}

/// Functions that are biorthogonal to the shape functions of an edge.
///
/// The area of a linear edge, for a length, is in proportion to 1 + `growth` xi: with those of a
/// uniform area the gap of its other node would count at the node of a ring. Those of quadratic edges
/// are exact for linear gaps on rings as they are.
fn biorthogonal(n: usize, growth: f64) -> Functions {
    if n == 2 {
        let q = growth;
        let scale = 0.5 / (3.0 - q * q);
        let slope = scale * (9.0 - q * q);
        let at = |q: f64| scale * (3.0 - q) * (1.0 + q);
        [[at(q), -slope, 0.0], [at(-q), slope, 0.0], [0.0; 3]]
    } else {
        [[-0.25, -0.5, 1.25], [-0.25, 0.5, 1.25], [1.5, 0.0, -2.5]]
    }
}

/// A slave edge and a master that it sees.
struct Facing<'a, const D: usize> {
    slave: Curve<Hyper<D>>,
    master: Master<Hyper<D>>,
    /// Their numbers.
    members: [usize; 2],
    run: Run<D>,
    /// The undeformed slave edge, and its thickness.
    reference: &'a Curve<f64>,
    thickness: Depth,
    /// Coefficients of the functions of its nodes.
    functions: &'a [[f64; 3]],
    /// Clearance taken off the gap at the nodes of the edge.
    offset: [f64; 3],
    /// Height of the master over the chord of the edge.
    height: f64,
}

/// Integrals for the nodes of a slave edge.
struct Integrals<const D: usize> {
    gap: [Hyper<D>; 3],
    slip: [f64; 3],
    /// Along which the shear tractions act.
    direction: [[Dual<D>; D]; 3],
    area: [f64; 3],
}

/// Gaps, slips and areas of an overlap.
fn integrals<const D: usize>(
    overlap: &Overlap,
    now: &Facing<'_, D>,
    start: Option<&Start>,
) -> Integrals<D> {
    let Facing { slave, master, members, run, reference, thickness, functions, .. } = now;
    let limits = overlap.limits.map(|limit| match limit {
        Limit::Fixed(r) => Hyper::real(r),
        Limit::Foot(end) => slave.foot(master.end(end)),
    });
    let centered = |[low, high]: [Hyper<D>; 2]| ((high + low).scale(0.5), (high - low).scale(0.5));
    let (middle, half) = centered(limits);
    let between = if let Run::Between(ends) = run { Some(centered(*ends)) } else { None };
    // Integrals with powers of the place in the part that the functions run over, from -1 to 1.
    let n = functions.len();
    let [mut gap, mut area] = [[Hyper::real(0.0); 3]; 2];
    let mut slip = [0.0; 3];
    let mut along = [[Dual::real(0.0); D]; 3];
    let clear = now.offset.iter().all(|o| *o == 0.0);
    let straight = slave.straight.then(|| (slave.d, unit(outward(slave.d))));
    for (r, w) in GAUSS {
        let xi = middle + half.scale(r);
        let place = match (&between, run) {
            (Some((middle, half)), _) => (xi - *middle) / *half,
            (None, Run::Overlap) => Hyper::real(r),
            (None, _) => xi,
        };
        let (t, normal) = straight.unwrap_or_else(|| {
            let t = slave.slope(xi);
            (t, unit(outward(t)))
        });
        let hit = master.ray(slave.at(xi), t, normal);
        let da =
            thickness.area(half * length(reference, xi).scale(w), || lift(reference).at(xi)[0]);
        let mut gap_there = hit.gap;
        if now.height != 0.0 {
            gap_there += (Hyper::real(1.0) - xi * xi).scale(now.height);
        }
        let (mut part, mut da_part) = (da * gap_there, da);
        for m in 0..n {
            if m > 0 {
                part = part * place;
                if clear { da_part.v *= place.v } else { da_part = da_part * place }
            }
            gap[m] += part;
            if clear { area[m].v += da_part.v } else { area[m] += da_part }
        }
        let Some(start) = start else { continue };
        let (da, at, to) = (first(&da), first(&xi), first(&place));
        let apart = times(firsts(&normal), first(&hit.gap));
        let points = (Point::Curve(slave, at), Point::of(master, &hit));
        let rate = direction(&points.0, &points.1, Along::Slave, apart);
        for (v, rate) in rate.into_iter().enumerate() {
            let mut part = da * rate;
            for along in &mut along[..n] {
                along[v] += part;
                part = part * to;
            }
        }
        let (r, across) = (hit.r.v, master.normal_at(hit.r.v));
        let path = start.slip((members[0], xi.v), (members[1], r), across, None);
        // Along the slave, and as long as it is now.
        let facing = -(across[0] * normal[0].v + across[1] * normal[1].v);
        let stretch = start.stretch(true, members[1], r, master.speed_at(r)) * facing;
        let part = da.v * stretch * path;
        for (m, slip) in slip[..n].iter_mut().enumerate() {
            *slip += part * place.v.powi(m as i32);
        }
    }
    let mut sums = Integrals {
        gap: [Hyper::real(0.0); 3],
        slip: [0.0; 3],
        direction: [[Dual::real(0.0); D]; 3],
        area: [0.0; 3],
    };
    for (a, coefficients) in functions.iter().enumerate() {
        for (m, &c) in coefficients[..n].iter().enumerate() {
            sums.gap[a] += gap[m].scale(c);
            if !clear {
                sums.gap[a] += area[m].scale(-c * now.offset[a]);
            }
            sums.slip[a] += c * slip[m];
            sums.area[a] += c * area[m].v;
            for (sum, along) in sums.direction[a].iter_mut().zip(&along[m]) {
                *sum += along.scale(c);
            }
        }
    }
    sums
}

/// Length of a curve for a unit of the parameter.
fn length<T: Smooth>(c: &Curve<f64>, r: T) -> T {
    // A middle node at the middle of a straight edge leaves rounding in `b`.
    if c.straight || dot(c.b, c.b) < 1e-24 * dot(c.d, c.d) {
        return T::real(dot(c.d, c.d).sqrt());
    }
    let t = lift::<T>(c).slope(r);
    dot(t, t).sqrt()
}

/// Weighted gaps and slips at the nodes of slave edges.
pub struct Mortar {
    /// Whether the functions of each edge are the biorthogonal ones.
    dual: Vec<bool>,
    /// Those where no end of the slave is, and those where none of its ends is guided by a support:
    /// about one that is guided nothing tips.
    inner: Vec<bool>,
    free: Vec<bool>,
    /// Curvature of each master in the reference configuration.
    curvature: Vec<f64>,
    /// Which masters are pieces of a fillet, and which of their ends are corners.
    fillet: Vec<bool>,
    corner: Vec<[bool; 2]>,
    /// The masters beyond the convex vertices at both ends of each master.
    across: Vec<[Option<usize>; 2]>,
}

impl Discretization for Mortar {
    fn hold(&mut self, sides: &Sides, held: &[bool], rough: bool) {
        for (i, &free) in self.free.iter().enumerate() {
            let guided = sides.slave.constraints[i][..2].iter().any(|&c| held[c]);
            // With the slip of the end node alone a traction along the support would not move the
            // slave, so that it could take any size.
            let inside = !rough && self.inner[i];
            self.dual[i] = if guided { inside } else { free };
        }
    }

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], start: Option<&Start>) -> Vec<Terms> {
        each(sides.n_items(), |i| self.edge(sides, i, x, start)).into_iter().flatten().collect()
    }

    fn stations(
        &self,
        sides: &Sides,
        x: &[[f64; 3]],
        closed: &dyn Fn(usize) -> bool,
    ) -> Vec<Station> {
        let of_edge = |i: usize| {
            let overlaps = self.seen(sides, i, x);
            let slave = Master::Curve(sides.slave.edges[i].place(x));
            let closed = sides.slave.constraints[i][..sides.slave.edges[i].n_nodes]
                .iter()
                .any(|&k| closed(k));
            let station = move |o: Overlap| {
                let j = sides.candidates()[o.pair].1;
                let master = sides.master.place(j, x);
                // At a foot the ray may only graze a round, and miss it by rounding.
                let opposite = |limit: Limit| match limit {
                    Limit::Fixed(xi) => ray(&slave, xi, &master),
                    Limit::Foot(end) => 2.0 * end as f64 - 1.0,
                };
                Station {
                    point: None,
                    corner: false,
                    edge: i,
                    span: o.values,
                    master: j,
                    opposite: o.limits.map(opposite),
                    gap: o.gap,
                    closed,
                }
            };
            overlaps.into_iter().map(station)
        };
        (0..sides.n_items()).flat_map(of_edge).collect()
    }
}

impl Mortar {
    fn new(sides: &Sides, x: &[[f64; 3]]) -> Self {
        let slave = Surface::Edges(sides.slave.edges.clone());
        let ends = open_ends(&slave, x);
        let round = round(&slave, x);
        let longest = sides.slave.edges.iter().map(|e| e.length).fold(0.0, f64::max);
        let curvature = |j: usize| {
            let found = sides.master.curvature(j, x);
            if (FLAT..STEEP).contains(&(found.abs() * longest)) { found } else { 0.0 }
        };
        let curvature: Vec<f64> = (0..sides.master.len()).map(curvature).collect();
        let curved = curvature.iter().any(|k| *k != 0.0);
        let dual = |i: usize, end: bool| {
            let linear = sides.slave.edges[i].n_nodes == 2;
            !sides.itself && (!linear || end || curved || round[i])
        };
        let all = 0..sides.slave.edges.len();
        let inner = all.clone().map(|i| dual(i, false)).collect();
        let free: Vec<bool> = all.map(|i| dual(i, ends[i].contains(&true))).collect();
        let (fillet, corner) = at_corners(&sides.master, x, longest);
        let across = across(&sides.master, x, corners::ROUND);
        Self { dual: free.clone(), inner, free, curvature, fillet, corner, across }
    }

    /// What a slave edge sees of its candidates, one behind the other the closest.
    fn seen(&self, sides: &Sides, i: usize, x: &[[f64; 3]]) -> Vec<Overlap> {
        let mut overlaps = overlaps(sides, i, x);
        overlaps.retain(|o| !self.has_passed(sides, o, x));
        clip_occluded(&mut overlaps);
        overlaps
    }

    /// Whether a slave edge has passed a master over a convex vertex: it sees the master behind it,
    /// inclined, but the face beyond the vertex is what it is outside of, or less deep in.
    fn has_passed(&self, sides: &Sides, o: &Overlap, x: &[[f64; 3]]) -> bool {
        if o.gap >= 0.0 {
            return false;
        }
        let (i, j) = sides.candidates()[o.pair];
        let (edge, master) = (sides.slave.edges[i].place(x), sides.master.place(j, x));
        let xi = 0.5 * (o.values[0] + o.values[1]);
        let (p, n) = (edge.at(xi), unit(outward(edge.slope(xi))));
        let hit = master.closest(p);
        let inclined = dot(master.normal(&hit), n) > -DENT.cos();
        let other = self.across[j][usize::from(hit.r > 0.0)];
        let beyond = |k: usize| sides.master.place(k, x).closest(p).gap > hit.gap;
        inclined && hit.r.abs() > 1.0 && other.is_some_and(beyond)
    }

    /// Height of a master over the chord of a slave edge, whose functions take a gap for linear.
    fn height(&self, sides: &Sides, i: usize, j: usize) -> f64 {
        let edge = &sides.slave.edges[i];
        let linear = edge.n_nodes == 2 && self.dual[i];
        if linear { 0.125 * self.curvature[j] * edge.length * edge.length } else { 0.0 }
    }

    fn edge(&self, sides: &Sides, i: usize, x: &[[f64; 3]], start: Option<&Start>) -> Vec<Terms> {
        let overlaps = self.seen(sides, i, x);
        let terms = |o: &Overlap| {
            let part = if self.dual[i] { self.part(sides, &overlaps, o) } else { None };
            let covered = part.as_ref().filter(|c| !c.is_whole());
            let variables = distinct(&variables_of(sides, o, covered));
            match variables.0.len() {
                0..=8 => self.overlapped::<8>(sides, (o, covered), &variables, x, start),
                9..=PAIR => self.overlapped::<PAIR>(sides, (o, covered), &variables, x, start),
                _ => self.overlapped::<WIDTH>(sides, (o, covered), &variables, x, start),
            }
        };
        overlaps.iter().map(terms).collect()
    }

    /// Part of an edge between corners of the master that an overlap belongs to; none of a fillet.
    fn part(&self, sides: &Sides, overlaps: &[Overlap], o: &Overlap) -> Option<Covered> {
        let master = |o: &Overlap| sides.candidates()[o.pair].1;
        if self.fillet[master(o)] {
            return None;
        }
        let mut order = overlaps.to_vec();
        order.sort_by(|a, b| a.values[0].total_cmp(&b.values[0]));
        // Facing sides run against each other.
        let joined =
            |a: &Overlap, b: &Overlap| !self.corner[master(a)][0] && !self.corner[master(b)][1];
        let own = order.chunk_by(joined).find(|part| part.iter().any(|p| p.pair == o.pair))?;
        Some(Covered { ends: [*own.first()?, *own.last()?] })
    }

    fn overlapped<const D: usize>(
        &self,
        sides: &Sides,
        (overlap, covered): (&Overlap, Option<&Covered>),
        (variables, places): &(Vec<i64>, Vec<usize>),
        x: &[[f64; 3]],
        start: Option<&Start>,
    ) -> Terms {
        let (i, j) = sides.candidates()[overlap.pair];
        let edge = &sides.slave.edges[i];
        let variables = join(variables, &[]);
        let once = lifted::<D>(&variables, x);
        let v: Vec<Hyper<D>> = places.iter().map(|&p| once[p]).collect();
        let (width, of_master) = (edge.variables().len(), sides.master.variables(j).len());
        let slave = edge.curve(&v[..width]);
        let master = sides.master.shape(j, &v[width..width + of_master]);
        let mut used = width + of_master;
        let mut end = |covered: &Covered, end: usize| match covered.limit(end) {
            (Limit::Fixed(r), _) => Hyper::real(r),
            (Limit::Foot(which), pair) if pair == overlap.pair => slave.foot(master.end(which)),
            (Limit::Foot(which), pair) => {
                let other = sides.candidates()[pair].1;
                let point = if let Some(edge) = sides.master.edge(other) {
                    let first = used;
                    used += edge.variables_of_end(which).len();
                    middle_of(&v[first..used])
                } else {
                    sides.master.shape(other, &v[width..width + of_master]).end(which)
                };
                slave.foot(point)
            }
        };
        let run = match covered {
            None => Run::Edge,
            Some(covered) if covered.is(overlap) => Run::Overlap,
            Some(covered) => Run::Between([end(covered, 0), end(covered, 1)]),
        };
        // A notch is closed at its tip anyway: the part there belongs to the next node.
        let constraints = sides.slave.constraints[i];
        let tip = [0, 1].map(|a| sides.notches.contains(&edge.nodes[a]));
        let owner = |a: usize| match (edge.n_nodes, a) {
            (3, 0 | 1) if tip[a] => constraints[2],
            (2, _) if tip[a] && !tip[1 - a] => constraints[1 - a],
            _ => constraints[a],
        };
        let dual = self.dual[i] && !self.fillet[j];
        let growth = sides.slave.thickness[i].growth(&sides.reference[i]);
        let functions =
            if dual { biorthogonal(edge.n_nodes, growth) } else { positive(edge.n_nodes) };
        let facing = Facing {
            slave,
            master,
            members: [i, j],
            run,
            reference: &sides.reference[i],
            thickness: sides.slave.thickness[i],
            functions: &functions[..edge.n_nodes],
            offset: constraints.map(|k| sides.offset.get(k).copied().unwrap_or(0.0)),
            height: self.height(sides, i, j),
        };
        let sums = integrals(overlap, &facing, start);
        let slip = |a: usize| Function::along(sums.slip[a], &sums.direction[a]);
        let share = |a: usize| Share {
            constraint: owner(a),
            gap: (&sums.gap[a]).into(),
            slip: start.map_or_else(Function::none, |_| slip(a)),
            area: sums.area[a],
        };
        Terms { pair: overlap.pair, variables, shares: (0..edge.n_nodes).map(share).collect() }
    }
}

/// Variables of an overlap: those of its edge and master, and of the ends of other masters that set
/// the ends of the covered part.
fn variables_of(sides: &Sides, overlap: &Overlap, covered: Option<&Covered>) -> Vec<i64> {
    let (i, j) = sides.candidates()[overlap.pair];
    let mut variables = sides.slave.edges[i].variables();
    variables.extend(sides.master.variables(j));
    for end in 0..2 {
        if let Some((Limit::Foot(which), pair)) = covered.map(|c| c.limit(end))
            && pair != overlap.pair
            && let Some(edge) = sides.master.edge(sides.candidates()[pair].1)
        {
            variables.extend(edge.variables_of_end(which));
        }
    }
    variables
}

/// What a slave edge sees of its candidates.
pub fn overlaps(sides: &Sides, i: usize, x: &[[f64; 3]]) -> Vec<Overlap> {
    let edge = sides.slave.edges[i].place(x);
    let seen = |pair: usize| {
        let master = sides.master.place(sides.candidates()[pair].1, x);
        overlap(pair, &edge, &master, sides.distances.reach, sides.depth[i])
    };
    sides.of_item(i).filter_map(seen).collect()
}
