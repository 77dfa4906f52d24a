//! A pair of boundaries: its candidates, and its gaps and slips with derivatives.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Edge, Vec2};
use super::master::{Master, Surface};
use super::mortar::{self, Overlap, Placed};
use super::node::{self, Bounds};
use super::search::{self, Candidate, Search, each};
use super::slave::Slave;
use super::terms::{Function, Share, Terms, WIDTH, join, lifted};
use super::tie;
use crate::base::Hyper;

/// How the gap is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    Mortar,
    NodeToSegment,
}

/// Radius of a master, in facets of the slave, up to which its deepest point counts.
const ROUND: f64 = 4.0;
/// Part of a facet beside its ends that is left to its nodes: there both say the same.
const BESIDE: f64 = 0.01;

/// What the pair is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Two boundaries that may touch.
    FacingFacets,
    /// A boundary with itself.
    Itself,
    /// Two boundaries that stay together.
    Tied,
}

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

/// A pair of boundaries.
pub struct Contact {
    slave: Slave,
    master: Surface,
    method: Method,
    kind: Kind,
    distances: Distances,
    /// Undeformed slave edges.
    reference: Vec<super::curve::Curve<f64>>,
    /// Deepest penetration of each slave edge (or node).
    depth: Vec<f64>,
    /// Clearance taken off the gap of each constraint.
    pub offset: Vec<f64>,
    search: Search,
    /// First candidate of each slave edge (or node).
    first: Vec<usize>,
    ties: Vec<Vec<tie::Point>>,
    /// Node behind each slave node, -1 for none, if the facet between them may meet a round of
    /// the master; its length; and the radii of those.
    next: Vec<i64>,
    facet: Vec<f64>,
    radius: Vec<f64>,
    /// Constraint of the facet behind each slave node, after those of the nodes, where it has one.
    of_facet: Vec<Option<usize>>,
    /// Whether nobody has asked for the candidates of a tie.
    fresh: bool,
    /// Master of each node: of the last evaluation, and of the last commit.
    held: [Vec<Option<usize>>; 2],
}

impl Contact {
    /// A pair; `x` is the reference configuration.
    pub fn new(
        x: &[[f64; 3]],
        slave: (Vec<Edge>, Vec<f64>),
        master: Option<Surface>,
        method: Method,
        tied: bool,
        distances: Distances,
    ) -> Self {
        let kind = match (&master, tied) {
            (None, _) => Kind::Itself,
            (_, true) => Kind::Tied,
            _ => Kind::FacingFacets,
        };
        let master = master.unwrap_or_else(|| Surface::Edges(slave.0.clone()));
        let middles = tied || method == Method::NodeToSegment;
        let slave = Slave::new(x, slave.0, slave.1, middles);
        let mut depth = match kind {
            Kind::Itself => search::half_thickness(&slave, x),
            // What lies deeper is behind the body.
            Kind::FacingFacets => {
                search::half_thickness(&slave, x).into_iter().map(|h| 2.0 * h).collect()
            }
            Kind::Tied => vec![f64::INFINITY; slave.edges.len()],
        };
        if method == Method::NodeToSegment {
            let mut of_nodes = vec![f64::INFINITY; slave.nodes.len()];
            for (constraints, d) in slave.constraints.iter().zip(&depth) {
                for &k in constraints.iter().filter(|&&k| k != usize::MAX) {
                    of_nodes[k] = f64::min(of_nodes[k], *d);
                }
            }
            depth = of_nodes;
        }
        for d in &mut depth {
            *d = d.min(distances.depth);
        }
        let n = slave.nodes.len();
        let (mut next, mut facet, mut radius) = (vec![-1; n], vec![0.0; n], Vec::new());
        if kind == Kind::FacingFacets && method == Method::NodeToSegment {
            radius = (0..master.len()).map(|j| master.radius(j, x)).collect();
            for (edge, k) in slave.edges.iter().zip(&slave.constraints) {
                let sides: &[[usize; 2]] =
                    if edge.n_nodes == 3 { &[[0, 2], [2, 1]] } else { &[[0, 1]] };
                for &[a, b] in sides {
                    let ends = [a, b].map(|c| x[edge.nodes[c] as usize]);
                    next[k[a]] = i64::from(edge.nodes[b]);
                    facet[k[a]] = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
                }
            }
        }
        let smallest = radius.iter().copied().fold(f64::INFINITY, f64::min);
        let mut count = n;
        let of_facet = (0..n)
            .map(|k| {
                (next[k] >= 0 && smallest <= ROUND * facet[k]).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        let mut pair = Self {
            reference: slave.edges.iter().map(|e| e.place(x)).collect(),
            master,
            method,
            kind,
            distances,
            depth,
            offset: vec![0.0; count],
            search: Search::default(),
            first: Vec::new(),
            ties: Vec::new(),
            next,
            facet,
            radius,
            of_facet,
            fresh: true,
            held: [vec![None; n], vec![None; n]],
            slave,
        };
        if kind == Kind::Tied {
            pair.renew(x);
            pair.bind(x);
        }
        pair
    }

    pub fn slave(&self) -> &Slave {
        &self.slave
    }

    /// Slave node of each constraint, by its place in the slave: nodes, then facets by their first.
    pub fn places(&self) -> Vec<usize> {
        let n = self.slave.nodes.len();
        (0..n).chain((0..n).filter(|&k| self.of_facet[k].is_some())).collect()
    }

    pub fn candidates(&self) -> &[Candidate] {
        &self.search.candidates
    }

    /// Renews the candidates where needed; tells whether they changed.
    pub fn update(&mut self, x: &[[f64; 3]]) -> bool {
        if self.kind == Kind::Tied {
            // Bound at the start for good; asked for the first time they are new.
            return std::mem::take(&mut self.fresh);
        }
        self.renew(x)
    }

    fn renew(&mut self, x: &[[f64; 3]]) -> bool {
        let (slave, method, kind) = (&self.slave, self.method, self.kind);
        let items = match method {
            Method::Mortar => search::edges(slave, x),
            Method::NodeToSegment => search::nodes(slave, x),
        };
        let count = items.len();
        let owners = (kind == Kind::Itself).then(|| slave.owners(method == Method::NodeToSegment));
        let allowed = |i: usize, j: usize| owners.as_ref().is_none_or(|o| slave.apart(&o[i], j));
        let Distances { reach, margin, .. } = self.distances;
        let changed = self.search.update(items, &self.master, x, reach, margin, allowed);
        if changed {
            let candidates = &self.search.candidates;
            self.first = (0..=count).map(|i| candidates.partition_point(|c| c.0 < i)).collect();
        }
        changed
    }

    fn bind(&mut self, x: &[[f64; 3]]) {
        let mut kept = Vec::new();
        for i in 0..self.slave.edges.len() {
            let mut overlaps = self.overlaps(i, x);
            mortar::clip_occluded(&mut overlaps);
            for o in overlaps {
                let candidate = self.search.candidates[o.pair];
                let master = self.master.place(candidate.1, x);
                let thickness = self.slave.thickness[i];
                self.ties.push(tie::points(&o, &self.reference[i], &master, thickness));
                kept.push(candidate);
            }
        }
        self.search.candidates = kept;
    }

    fn overlaps(&self, i: usize, x: &[[f64; 3]]) -> Vec<Overlap> {
        let edge = self.slave.edges[i].place(x);
        let candidates = self.first[i]..self.first[i + 1];
        candidates
            .filter_map(|pair| {
                let master = self.master.place(self.search.candidates[pair].1, x);
                mortar::overlap(pair, &edge, &master, self.distances.reach, self.depth[i])
            })
            .collect()
    }

    /// Variables of a candidate pair.
    pub fn variables(&self, pair: usize) -> [i64; WIDTH] {
        let (i, j) = self.search.candidates[pair];
        let master = self.master.variables(j);
        match self.method {
            Method::Mortar => join(&self.slave.edges[i].variables(), &master),
            Method::NodeToSegment => {
                let node = 3 * i64::from(self.slave.nodes[i]);
                if self.is_round(i, j) {
                    let next = 3 * self.next[i];
                    join(&[node, node + 1, next, next + 1], &master)
                } else {
                    join(&[node, node + 1], &master)
                }
            }
        }
    }

    /// Whether the facet behind a slave node meets a master as a round.
    fn is_round(&self, k: usize, j: usize) -> bool {
        self.next[k] >= 0 && self.radius[j] <= ROUND * self.facet[k]
    }

    /// Constraints of a candidate pair.
    pub fn constraints(&self, pair: usize) -> [usize; 3] {
        let i = self.search.candidates[pair].0;
        match self.method {
            Method::Mortar => self.slave.constraints[i],
            Method::NodeToSegment => {
                let round = self.is_round(i, self.search.candidates[pair].1);
                let facet = self.of_facet[i].filter(|_| round);
                [i, facet.unwrap_or(usize::MAX), usize::MAX]
            }
        }
    }

    /// Terms of all pairs that meet at `x`, in the order of the pairs; slip since `old`.
    pub fn evaluate(&mut self, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Vec<Terms> {
        if self.kind == Kind::Tied {
            let all = 0..self.search.candidates.len();
            return each(all.len(), |pair| self.tied(pair, x));
        }
        let n = self.first.len().saturating_sub(1);
        match self.method {
            Method::Mortar => each(n, |i| self.edge(i, x, old)).into_iter().flatten().collect(),
            Method::NodeToSegment => {
                let normals = search::nodes(&self.slave, x);
                let chosen = each(n, |k| self.choose(k, normals[k].1, x));
                for (held, pair) in self.held[0].iter_mut().zip(&chosen) {
                    *held = pair.0.map(|(p, _)| self.search.candidates[p].1);
                }
                let nodes = chosen.iter().filter_map(|c| c.0.map(|p| (p, false)));
                let facets = chosen.iter().filter_map(|c| c.1.map(|p| ((p, true), true)));
                let pairs: Vec<((usize, bool), bool)> = nodes.chain(facets).collect();
                each(pairs.len(), |i| {
                    let ((pair, round), besides) = pairs[i];
                    if round { self.facet(pair, besides, x, old) } else { self.node(pair, x, old) }
                })
            }
        }
    }

    /// Keeps the masters of the nodes as those to return to.
    pub fn commit(&mut self) {
        let [now, kept] = &mut self.held;
        kept.clone_from(now);
    }

    /// Returns to the masters of the last commit.
    pub fn restore(&mut self) {
        let [now, kept] = &mut self.held;
        now.clone_from(kept);
    }

    /// What later evaluations depend on besides the offsets: places of the search, and whole
    /// numbers (see [`Contact::resume`]).
    pub fn state(&self) -> (Vec<f64>, Vec<i64>) {
        let index = |n: &Option<usize>| n.map_or(-1, |n| n as i64);
        let mut whole = vec![i64::from(self.fresh)];
        for held in &self.held {
            whole.extend(held.iter().map(index));
        }
        if self.kind != Kind::Tied {
            whole.extend(self.search.candidates.iter().flat_map(|&(i, j)| [i as i64, j as i64]));
        }
        (if self.kind == Kind::Tied { Vec::new() } else { self.search.places() }, whole)
    }

    /// Take the state of the same pair: `places` of the search; `whole` has a flag of ties, the
    /// masters of the nodes, those of the last commit, and the candidates. `false` if it does not
    /// fit.
    pub fn resume(&mut self, places: &[f64], whole: &[i64]) -> bool {
        let n = self.slave.nodes.len();
        if whole.len() < 1 + 2 * n {
            return false;
        }
        let (head, candidates) = whole.split_at(1 + 2 * n);
        let slaves = match self.method {
            Method::Mortar => self.slave.edges.len(),
            Method::NodeToSegment => n,
        };
        let masters = self.master.len();
        let fits = |m: &i64| *m >= -1 && *m < masters as i64;
        if !head[1..].iter().all(fits) {
            return false;
        }
        if self.kind == Kind::Tied {
            if !candidates.is_empty() || !places.is_empty() {
                return false;
            }
        } else {
            let (pairs, rest) = candidates.as_chunks::<2>();
            let inside = |p: &[i64; 2]| {
                (0..slaves as i64).contains(&p[0]) && (0..masters as i64).contains(&p[1])
            };
            let sorted = pairs.is_sorted();
            let found =
                places.len() == 6 * (slaves + masters) || (places.is_empty() && pairs.is_empty());
            if !rest.is_empty() || !found || !sorted || !pairs.iter().all(inside) {
                return false;
            }
            let list: Vec<Candidate> =
                pairs.iter().map(|p| (p[0] as usize, p[1] as usize)).collect();
            let count = if places.is_empty() { 0 } else { slaves };
            self.first = (0..=count).map(|i| list.partition_point(|c| c.0 < i)).collect();
            if !self.search.restore(count, places, list) {
                return false;
            }
        }
        self.fresh = head[0] != 0;
        let master = |m: &i64| usize::try_from(*m).ok();
        self.held =
            [head[1..=n].iter().map(master).collect(), head[1 + n..].iter().map(master).collect()];
        true
    }

    fn edge(&self, i: usize, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Vec<Terms> {
        let mut overlaps = self.overlaps(i, x);
        mortar::clip_occluded(&mut overlaps);
        let width = self.slave.edges[i].variables().len();
        let small = |o: &Overlap| {
            width + self.master.variables(self.search.candidates[o.pair].1).len() <= 8
        };
        let terms = |o: &Overlap| {
            if small(o) {
                self.overlapped::<8>(o, x, old)
            } else {
                self.overlapped::<12>(o, x, old)
            }
        };
        overlaps.iter().map(terms).collect()
    }

    fn overlapped<const D: usize>(
        &self,
        overlap: &Overlap,
        x: &[[f64; 3]],
        old: Option<&[[f64; 3]]>,
    ) -> Terms {
        let (i, j) = self.search.candidates[overlap.pair];
        let edge = &self.slave.edges[i];
        let variables = self.variables(overlap.pair);
        let v = lifted::<D>(&variables, x);
        let (width, master) = (edge.variables().len(), self.master.variables(j).len());
        let slave = edge.curve(&v[..width]);
        let master = self.master.shape(j, &v[width..width + master]);
        let now = Placed { slave: &slave, master: &master };
        let before = old.map(|o| (edge.place(o), self.master.place(j, o)));
        let before = before.as_ref().map(|(slave, master)| Placed { slave, master });
        let constraints = self.slave.constraints[i];
        let offset = [self.offset[constraints[0]], self.offset[constraints[1]]];
        let sums = mortar::integrals(
            overlap,
            &now,
            before.as_ref(),
            &self.reference[i],
            self.slave.thickness[i],
            offset,
        );
        let share = |a: usize| Share {
            constraint: constraints[a],
            gap: (&sums.gap[a]).into(),
            slip: sums.slip.as_ref().map_or_else(Function::none, |s| (&s[a]).into()),
            area: sums.area[a],
        };
        Terms { pair: overlap.pair, variables, shares: vec![share(0), share(1)] }
    }

    /// The pair of a node and whether it is met by the facet behind the node, and the pair of a
    /// round that meets this facet besides.
    fn choose(
        &self,
        k: usize,
        normal: Vec2<f64>,
        x: &[[f64; 3]],
    ) -> (Option<(usize, bool)>, Option<usize>) {
        let p = x[self.slave.nodes[k] as usize];
        let pairs = self.first[k]..self.first[k + 1];
        let shapes: Vec<(usize, Master<f64>)> = pairs
            .map(|pair| (pair, self.master.place(self.search.candidates[pair].1, x)))
            .collect();
        let last = self.held[0][k].and_then(|j| {
            let same = |s: &&(usize, Master<f64>)| self.search.candidates[s.0].1 == j;
            shapes.iter().find(same).map(|s| s.0)
        });
        let bounds = Bounds { reach: self.distances.reach, depth: self.depth[k] };
        let found = node::choose([p[0], p[1]], normal, &shapes, last, bounds);
        let gap_of = |pair: usize| {
            let shape = &shapes.iter().find(|s| s.0 == pair).expect("a candidate").1;
            shape.closest([p[0], p[1]]).gap
        };
        let mut deepest: Option<(usize, f64, f64)> = None;
        for (pair, shape) in &shapes {
            if !self.is_round(k, self.search.candidates[*pair].1) {
                continue;
            }
            let q = x[self.next[k] as usize];
            let (gap, t, hit) = node::round_gap([p[0], p[1]], [q[0], q[1]], shape);
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
            Some(own) if !self.is_round(k, self.search.candidates[own].1) => {
                let beside = (BESIDE..1.0 - BESIDE).contains(&t);
                (Some((own, false)), beside.then_some(round))
            }
            Some(own) if gap_of(own) < gap => (Some((own, false)), None),
            // What meets the round says the same of node and facet.
            _ => (Some((round, true)), None),
        }
    }

    /// A facet that meets a round, by the constraint of its first node or its own (`besides`).
    fn facet(&self, pair: usize, besides: bool, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Terms {
        let (k, j) = self.search.candidates[pair];
        let variables = self.variables(pair);
        let v = lifted::<WIDTH>(&variables, x);
        let width = self.master.variables(j).len();
        let master = self.master.shape(j, &v[4..4 + width]);
        let ends = |x: &[[f64; 3]]| {
            [i64::from(self.slave.nodes[k]), self.next[k]].map(|n| {
                let p = x[n as usize];
                [p[0], p[1]]
            })
        };
        let before = old.map(|o| (ends(o), self.master.place(j, o)));
        let before = before.as_ref().map(|(ends, m)| (*ends, m));
        let (gap, slip) = node::round_gap_and_slip([[v[0], v[1]], [v[2], v[3]]], &master, before);
        let own = if besides { self.of_facet[k].expect("a facet of a round") } else { k };
        self.share(pair, own, variables, &gap, slip.as_ref())
    }

    fn share<const D: usize>(
        &self,
        pair: usize,
        constraint: usize,
        variables: [i64; WIDTH],
        gap: &Hyper<D>,
        slip: Option<&Hyper<D>>,
    ) -> Terms {
        let area = self.slave.area[self.search.candidates[pair].0];
        let share = Share {
            constraint,
            gap: (&node::open(*gap, self.offset[constraint], area)).into(),
            slip: slip.map_or_else(Function::none, |s| (&node::open(*s, 0.0, area)).into()),
            area,
        };
        Terms { pair, variables, shares: vec![share] }
    }

    fn node(&self, pair: usize, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Terms {
        let (k, j) = self.search.candidates[pair];
        let variables = self.variables(pair);
        // A pair that may meet as a round has the facet's other end among its variables.
        let (v, first) = (lifted::<10>(&variables, x), if self.is_round(k, j) { 4 } else { 2 });
        let width = self.master.variables(j).len();
        let master = self.master.shape(j, &v[first..first + width]);
        let before = old.map(|o| {
            let p = o[self.slave.nodes[k] as usize];
            ([p[0], p[1]], self.master.place(j, o))
        });
        let before = before.as_ref().map(|(p, m)| (*p, m));
        let (gap, slip) = node::gap_and_slip([v[0], v[1]], &master, before);
        self.share(pair, k, variables, &gap, slip.as_ref())
    }

    fn tied(&self, pair: usize, x: &[[f64; 3]]) -> Terms {
        let (i, j) = self.search.candidates[pair];
        let edge = &self.slave.edges[i];
        let variables = self.variables(pair);
        let v = lifted::<WIDTH>(&variables, x);
        let slave = edge.curve(&v[..edge.variables().len()]);
        let Surface::Edges(masters) = &self.master else { unreachable!("ties join edges") };
        let master = masters[j].curve(&v[edge.variables().len()..]);
        let points = &self.ties[pair];
        let n = edge.n_nodes;
        let (jumps, areas) = (tie::jumps(points, &slave, &master, n), tie::areas(points, n));
        let share = |a: usize| Share {
            constraint: self.slave.constraints[i][a],
            gap: (&jumps[a][0]).into(),
            slip: (&jumps[a][1]).into(),
            area: areas[a],
        };
        Terms { pair, variables, shares: (0..n).map(share).collect() }
    }
}
