//! A pair of boundaries: its candidates, and its gaps and slips with derivatives.
// SPDX-License-Identifier: BSD-3-Clause

use super::corners::{Corners, LEAST_TURN, LEAST_TURN_AT_CORNERS};
use super::curve::Edge;
use super::discretization::{Discretization, Entry};
use super::master::Surface;
use super::rounds::bulge;
use super::search::Candidate;
use super::sides::{Distances, Sides};
use super::slave::{Depth, Slave};
use super::terms::{Terms, WIDTH};
use super::travel::Start;
use std::collections::HashSet;

/// A pair of boundaries.
pub struct Contact {
    sides: Sides,
    method: Box<dyn Discretization>,
    /// Corners of both sides with constraints behind those of the discretization.
    corners: Vec<Corners>,
    joins: bool,
    /// What slips are measured from.
    start: Start,
    /// Whether the candidates of joined surfaces were never requested.
    fresh: bool,
}

impl Contact {
    /// A pair; `x` is the reference configuration. With `corners`, sharp corners have constraints
    /// of their own: those of the master, and those of the slave where its nodes have means.
    pub fn new(
        x: &[[f64; 3]],
        (edges, thickness): (Vec<Edge>, Vec<Depth>),
        mut master: Option<Surface>,
        entry: &Entry,
        distances: Distances,
        corners: bool,
    ) -> Self {
        // A node that slides over the joint of two arcs meets a kink of some thousandths of a radian,
        // at which its direction alternates; integrals have none.
        if let Some(Surface::Edges(faces)) = &mut master
            && entry.integrates
            && !entry.joins
        {
            bulge(faces, x);
        }
        let slave = Slave::new(x, edges, thickness);
        Self::with(x, slave, master, entry, distances, corners)
    }

    /// The same with constraints at given nodes.
    pub fn with(
        x: &[[f64; 3]],
        slave: Slave,
        master: Option<Surface>,
        entry: &Entry,
        distances: Distances,
        corners: bool,
    ) -> Self {
        let mut sides = Sides::new(x, slave, master, distances, corners && !entry.joins);
        let method = (entry.new)(&sides, x);
        sides.set_depth(x, entry.joins, &method.owners(&sides.slave));
        let n = method.places(&sides.slave).len();
        let mut first = n;
        let sides_with_corners: &[bool] = match sides.corners {
            false => &[],
            true if entry.integrates && !sides.itself => &[false, true],
            true => &[false],
        };
        let mut found: Vec<Corners> = Vec::new();
        for &of_slave in sides_with_corners {
            let least = if of_slave && found.iter().any(Corners::turns) {
                LEAST_TURN_AT_CORNERS
            } else {
                LEAST_TURN
            };
            let own = Corners::new(&sides, x, first, !entry.integrates, (of_slave, least));
            first += own.len();
            if !own.is_empty() {
                found.push(own);
            }
        }
        sides.offset = vec![0.0; first];
        let mut pair = Self {
            sides,
            method,
            corners: found,
            joins: entry.joins,
            start: Start::default(),
            fresh: true,
        };
        if pair.joins {
            pair.renew(x);
            pair.method.bind(&mut pair.sides, x);
        }
        pair
    }

    pub fn slave(&self) -> &Slave {
        &self.sides.slave
    }

    pub fn master(&self) -> &Surface {
        &self.sides.master
    }

    /// Slave node of each constraint, by its place in the slave's nodes; of a corner of the master
    /// the nearest.
    pub fn places(&self) -> Vec<usize> {
        let mut places = self.method.places(&self.sides.slave);
        places.extend(self.corners.iter().flat_map(Corners::nearest));
        places
    }

    /// Reference area of each constraint.
    pub fn full_area(&self) -> Vec<f64> {
        let places = self.method.places(&self.sides.slave);
        let mut area: Vec<f64> = places.iter().map(|&k| self.sides.slave.area[k]).collect();
        area.extend(self.corners.iter().flat_map(|c| vec![c.area(); c.len()]));
        area
    }

    /// Mesh nodes of the corners that have constraints, -1 for those of a rigid body.
    pub fn corner_nodes(&self) -> Vec<i64> {
        self.method
            .corners()
            .into_iter()
            .chain(self.corners.iter().flat_map(Corners::nodes))
            .collect()
    }

    /// Candidates: items of the slave with members of the master, then corners, which are numbered
    /// behind these items, with members of the other side.
    pub fn candidates(&self) -> Vec<Candidate> {
        let mut all = self.sides.candidates().to_vec();
        let mut items = self.sides.depth.len();
        for corners in &self.corners {
            all.extend(corners.candidates().iter().map(|&(c, i)| (items + c, i)));
            items += corners.len();
        }
        all
    }

    /// Numbers of the candidates of an item whose members are those of given ones, or the next two.
    pub fn near(&self, given: impl Iterator<Item = usize>) -> Vec<usize> {
        let all = self.candidates();
        let given: HashSet<Candidate> = given.map(|p| all[p]).collect();
        let near = |&p: &usize| {
            let (item, member) = all[p];
            (member.saturating_sub(2)..=member + 2).any(|m| given.contains(&(item, m)))
        };
        (0..all.len()).filter(near).collect()
    }

    /// Clearance taken off the gap of each constraint.
    pub fn offset(&self) -> &[f64] {
        &self.sides.offset
    }

    pub fn offset_mut(&mut self) -> &mut [f64] {
        &mut self.sides.offset
    }

    /// Renews the candidates where needed; tells whether they changed.
    pub fn update(&mut self, x: &[[f64; 3]]) -> bool {
        if self.joins {
            // Bound once, at the start; at the first request they are new.
            return std::mem::take(&mut self.fresh);
        }
        self.renew(x)
    }

    fn renew(&mut self, x: &[[f64; 3]]) -> bool {
        let changed = self.look(x);
        let sides = &self.sides;
        self.corners.iter_mut().fold(changed, |any, c| c.renew(sides, x) || any)
    }

    /// Renews the candidates of the surfaces where needed; tells whether they changed.
    fn look(&mut self, x: &[[f64; 3]]) -> bool {
        let mut search = std::mem::take(&mut self.sides.search);
        let sides = &self.sides;
        let items = self.method.items(&sides.slave, x);
        let count = items.len();
        let owners = sides.itself.then(|| self.method.owners(&sides.slave));
        let method = &self.method;
        let allowed = |i: usize, j: usize| {
            method.allows(i, j) && owners.as_ref().is_none_or(|o| sides.apart(&o[i], j))
        };
        let Distances { reach, margin, .. } = sides.distances;
        let changed = search.update(items, &sides.master, x, reach, margin, allowed);
        self.sides.search = search;
        if changed {
            self.sides.index(count);
        }
        changed
    }

    /// A candidate of the surfaces, or one of a corner.
    fn candidate(&self, pair: usize) -> Result<Candidate, (&Corners, Candidate)> {
        let own = self.sides.candidates();
        if let Some(found) = own.get(pair) {
            return Ok(*found);
        }
        let mut left = pair - own.len();
        for corners in &self.corners {
            if let Some(found) = corners.candidates().get(left) {
                return Err((corners, *found));
            }
            left -= corners.candidates().len();
        }
        unreachable!("a candidate has a number")
    }

    /// Variables of a candidate.
    pub fn variables(&self, pair: usize) -> [i64; WIDTH] {
        match self.candidate(pair) {
            Ok(own) => self.method.variables(&self.sides, own),
            Err((corners, own)) => corners.variables(own),
        }
    }

    /// Constraints of a candidate.
    pub fn constraints(&self, pair: usize) -> [usize; 3] {
        match self.candidate(pair) {
            Ok(own) => self.method.constraints(&self.sides, own),
            Err((corners, own)) => [corners.constraint(own.0), usize::MAX, usize::MAX],
        }
    }

    /// Terms of all candidates that meet at `x`, in their order; slips since `old`, where some
    /// constraints were `closed`.
    pub fn evaluate(
        &mut self,
        x: &[[f64; 3]],
        old: Option<&[[f64; 3]]>,
        closed: &[bool],
    ) -> Vec<Terms> {
        if let Some(old) = old.filter(|_| !self.joins) {
            if self.method.has_stations() {
                self.begin(old, closed, x);
            } else {
                self.start.hold(&self.sides, old, x);
            }
        }
        let start = old.map(|_| &self.start);
        let mut terms = self.method.evaluate(&self.sides, x, start);
        let mut from = self.sides.candidates().len();
        for corners in &mut self.corners {
            terms.extend(corners.evaluate(&self.sides, x, start, from));
            from += corners.candidates().len();
        }
        terms
    }

    /// Finds where the sides faced each other at `old`, with candidates that belong to it.
    fn begin(&mut self, old: &[[f64; 3]], closed: &[bool], x: &[[f64; 3]]) {
        if !self.start.begin(&self.sides, old, closed, x) {
            return;
        }
        std::mem::swap(&mut self.sides.search, &mut self.start.search);
        self.look(old);
        let items = self.sides.depth.len();
        self.sides.index(items);
        let flag = |k: usize| self.start.closed(k);
        let mut found = self.method.stations(&self.sides, old, &flag);
        let sides = &self.sides;
        found.extend(self.corners.iter_mut().flat_map(|c| c.stations(sides, old, &flag)));
        std::mem::swap(&mut self.sides.search, &mut self.start.search);
        self.sides.index(items);
        self.start.take(found);
    }

    /// Take which constraints belong to ends of the slave that supports hold from now on.
    pub fn hold(&mut self, held: &[bool], rough: bool) {
        self.method.hold(&self.sides, held, rough);
    }

    /// Take the nodes whose rotations are those of the bodies of slave and master, of which positions
    /// show no whole turns.
    pub fn carry(&mut self, nodes: [Option<u32>; 2]) {
        self.start.carriers = nodes;
    }

    /// Keeps the masters of the constraints as those to return to.
    pub fn commit(&mut self) {
        self.method.commit();
        self.corners.iter_mut().for_each(Corners::commit);
    }

    /// Returns to the masters of the last commit.
    pub fn restore(&mut self) {
        self.method.restore();
        self.corners.iter_mut().for_each(Corners::restore);
    }

    /// Forgets which masters the constraints had.
    pub fn forget(&mut self) {
        self.method.forget();
        self.corners.iter_mut().for_each(Corners::forget);
    }

    /// What later evaluations depend on besides the offsets: places of the search, and whole
    /// numbers (see [`Contact::resume`]).
    pub fn state(&self) -> (Vec<f64>, Vec<i64>) {
        let mut whole = vec![i64::from(self.fresh)];
        whole.extend(self.method.memory());
        if self.joins {
            return (Vec::new(), whole);
        }
        let mut places = self.sides.search.places();
        let flat = |list: &[Candidate]| -> Vec<i64> {
            list.iter().flat_map(|&(i, j)| [i as i64, j as i64]).collect()
        };
        // Places are cut off from the end.
        let mut of_corners = Vec::new();
        for corners in self.corners.iter().rev() {
            whole.extend(corners.memory());
            whole.push(corners.candidates().len() as i64);
            whole.extend(flat(corners.candidates()));
            of_corners.splice(0..0, corners.places());
        }
        places.extend(of_corners);
        whole.extend(flat(self.sides.candidates()));
        (places, whole)
    }

    /// Take the state of the same pair: `places` of the search; `whole` has a flag of surfaces that
    /// are joined, the memory of the discretization, that of corners with their candidates, and the
    /// candidates. `false` if it does not fit.
    pub fn resume(&mut self, places: &[f64], whole: &[i64]) -> bool {
        let n = self.method.memory().len();
        if whole.len() < 1 + n {
            return false;
        }
        let (head, mut candidates) = whole.split_at(1 + n);
        let mut places = places;
        let slaves = self.sides.depth.len();
        let masters = self.sides.master.len();
        let fits = |m: &i64| *m >= -1 && *m < masters as i64;
        if !head[1..].iter().all(fits) {
            return false;
        }
        if self.joins {
            if !candidates.is_empty() || !places.is_empty() {
                return false;
            }
        } else {
            for corners in self.corners.iter_mut().rev() {
                let Some(rest) = resumed(corners, candidates, &mut places) else {
                    return false;
                };
                candidates = rest;
            }
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
            if !self.sides.search.restore(count, places, list) {
                return false;
            }
            self.sides.index(count);
        }
        self.fresh = head[0] != 0;
        self.method.remember(&head[1..]);
        true
    }
}

/// Gives corners their part of a state, cut off the end of `places`; the rest of `whole`, or none
/// if it does not fit.
fn resumed<'a>(corners: &mut Corners, whole: &'a [i64], places: &mut &[f64]) -> Option<&'a [i64]> {
    let (memory, rest) = whole.split_at_checked(corners.memory().len())?;
    let (&count, rest) = rest.split_first()?;
    let (found, rest) = rest.split_at_checked(usize::try_from(count).ok()?.checked_mul(2)?)?;
    let (pairs, _) = found.as_chunks::<2>();
    let number = |k: i64| usize::try_from(k).ok();
    let list = pairs.iter().map(|p| Some((number(p[0])?, number(p[1])?)));
    let list: Vec<Candidate> = list.collect::<Option<_>>()?;
    let (surfaces, own) = places.split_at(places.len().saturating_sub(corners.n_places()));
    *places = surfaces;
    corners.resume(memory, own, list).then_some(rest)
}
