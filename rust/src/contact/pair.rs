//! A pair of boundaries: its candidates, and its gaps and slips with derivatives.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::Edge;
use super::discretization::{Discretization, Entry};
use super::master::Surface;
use super::search::Candidate;
use super::sides::{Distances, Sides};
use super::slave::Slave;
use super::terms::{Terms, WIDTH};

/// A pair of boundaries.
pub struct Contact {
    sides: Sides,
    method: Box<dyn Discretization>,
    joins: bool,
    /// Whether the candidates of joined surfaces were never requested.
    fresh: bool,
}

impl Contact {
    /// A pair; `x` is the reference configuration.
    pub fn new(
        x: &[[f64; 3]],
        slave: (Vec<Edge>, Vec<f64>),
        master: Option<Surface>,
        entry: &Entry,
        distances: Distances,
    ) -> Self {
        let slave = Slave::new(x, slave.0, slave.1, entry.middles);
        let mut sides = Sides::new(x, slave, master, distances);
        let method = (entry.new)(&sides, x);
        sides.set_depth(x, entry.joins, &method.owners(&sides.slave));
        sides.offset = vec![0.0; method.places(&sides.slave).len()];
        let mut pair = Self { sides, method, joins: entry.joins, fresh: true };
        if pair.joins {
            pair.renew(x);
            pair.method.bind(&mut pair.sides, x);
        }
        pair
    }

    pub fn slave(&self) -> &Slave {
        &self.sides.slave
    }

    /// Slave node of each constraint, by its place in the slave's nodes.
    pub fn places(&self) -> Vec<usize> {
        self.method.places(&self.sides.slave)
    }

    pub fn candidates(&self) -> &[Candidate] {
        self.sides.candidates()
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
        let Sides { slave, master, search, distances, itself, .. } = &mut self.sides;
        let items = self.method.items(slave, x);
        let count = items.len();
        let owners = itself.then(|| self.method.owners(slave));
        let allowed = |i: usize, j: usize| owners.as_ref().is_none_or(|o| slave.apart(&o[i], j));
        let changed = search.update(items, master, x, distances.reach, distances.margin, allowed);
        if changed {
            self.sides.index(count);
        }
        changed
    }

    /// Variables of a candidate.
    pub fn variables(&self, pair: usize) -> [i64; WIDTH] {
        self.method.variables(&self.sides, self.candidates()[pair])
    }

    /// Constraints of a candidate.
    pub fn constraints(&self, pair: usize) -> [usize; 3] {
        self.method.constraints(&self.sides, self.candidates()[pair])
    }

    /// Terms of all candidates that meet at `x`, in their order; slip since `old`.
    pub fn evaluate(&mut self, x: &[[f64; 3]], old: Option<&[[f64; 3]]>) -> Vec<Terms> {
        self.method.evaluate(&self.sides, x, old)
    }

    /// Keeps the masters of the constraints as those to return to.
    pub fn commit(&mut self) {
        self.method.commit();
    }

    /// Returns to the masters of the last commit.
    pub fn restore(&mut self) {
        self.method.restore();
    }

    /// Forgets which masters the constraints had.
    pub fn forget(&mut self) {
        self.method.forget();
    }

    /// What later evaluations depend on besides the offsets: places of the search, and whole
    /// numbers (see [`Contact::resume`]).
    pub fn state(&self) -> (Vec<f64>, Vec<i64>) {
        let mut whole = vec![i64::from(self.fresh)];
        whole.extend(self.method.memory());
        if self.joins {
            return (Vec::new(), whole);
        }
        whole.extend(self.candidates().iter().flat_map(|&(i, j)| [i as i64, j as i64]));
        (self.sides.search.places(), whole)
    }

    /// Take the state of the same pair: `places` of the search; `whole` has a flag of surfaces that
    /// are joined, the memory of the discretization, and the candidates. `false` if it does not
    /// fit.
    pub fn resume(&mut self, places: &[f64], whole: &[i64]) -> bool {
        let n = self.method.memory().len();
        if whole.len() < 1 + n {
            return false;
        }
        let (head, candidates) = whole.split_at(1 + n);
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
