//! Ties of single nodes: each is joined to the point of the master that is closest at the start.
//!
//! Its offset from there turns and stretches with the chord of the master's edge, so it costs no
//! strain and a common rigid motion changes nothing.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::curve::{Vec2, add, dot, outward, sub, times};
use super::super::master::Master;
use super::super::search::{Candidate, Item, each};
use super::super::sides::Sides;
use super::super::slave::Slave;
use super::super::terms::{Share, Terms, WIDTH, join, lifted};
use super::super::travel::Start;
use super::node_to_segment::open;
use super::{Discretization, Entry};
use crate::base::Smooth;

pub const ENTRY: Entry = Entry {
    name: "point_tie",
    joins: true,
    integrates: false,
    new: |sides, _| Box::new(PointTie { n: sides.slave.nodes.len(), joints: Vec::new() }),
};

/// Parameter on the master, and offset along and across half its chord.
type Joint = (f64, Vec2<f64>);

/// Nodes joined to the places of the reference configuration.
pub struct PointTie {
    n: usize,
    /// Of each candidate.
    joints: Vec<Joint>,
}

/// Jump between a node and the place it is joined to.
fn jump<T: Smooth>(p: Vec2<T>, master: &Master<T>, (r, offset): Joint) -> Vec2<T> {
    let Master::Curve(c) = master else { unreachable!("ties join edges") };
    let [along, across] = offset.map(T::real);
    let place = add(c.at(T::real(r)), add(times(c.d, along), times(outward(c.d), across)));
    sub(p, place)
}

impl Discretization for PointTie {
    fn items(&self, slave: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
        let item = |n: &u32| {
            let p = x[*n as usize];
            ([p[0], p[1], p[0], p[1]], [0.0, 0.0])
        };
        slave.nodes.iter().map(item).collect()
    }

    fn owners(&self, _: &Slave) -> Vec<Vec<usize>> {
        vec![Vec::new(); self.n]
    }

    fn variables(&self, sides: &Sides, (k, j): Candidate) -> [i64; WIDTH] {
        let node = 3 * i64::from(sides.slave.nodes[k]);
        join(&[node, node + 1], &sides.master.variables(j))
    }

    fn constraints(&self, _: &Sides, (k, _): Candidate) -> [usize; 3] {
        [k, usize::MAX, usize::MAX]
    }

    fn bind(&mut self, sides: &mut Sides, x: &[[f64; 3]]) {
        let mut kept = Vec::new();
        for k in 0..sides.n_items() {
            let p = x[sides.slave.nodes[k] as usize];
            let p = [p[0], p[1]];
            let place = |pair: usize| {
                let j = sides.candidates()[pair].1;
                let Master::Curve(c) = sides.master.place(j, x) else { return None };
                let r = c.foot(p).clamp(-1.0, 1.0);
                let apart = sub(p, c.at(r));
                let chord = dot(c.d, c.d);
                let offset = [dot(apart, c.d) / chord, dot(apart, outward(c.d)) / chord];
                Some((dot(apart, apart).sqrt(), (k, j), (r, offset)))
            };
            let closest = sides
                .of_item(k)
                .filter_map(place)
                .filter(|found| found.0 <= sides.distances.reach)
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, candidate, joint)) = closest {
                kept.push(candidate);
                self.joints.push(joint);
            }
        }
        sides.keep(kept);
    }

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], _: Option<&Start>) -> Vec<Terms> {
        each(sides.candidates().len(), |pair| {
            let (k, j) = sides.candidates()[pair];
            let variables = self.variables(sides, (k, j));
            let v = lifted::<8>(&variables, x);
            let width = sides.master.variables(j).len();
            let master = sides.master.shape(j, &v[2..2 + width]);
            let area = sides.slave.area[k];
            let [gap, slip] = jump([v[0], v[1]], &master, self.joints[pair]);
            let share = Share {
                constraint: k,
                gap: (&open(gap, 0.0, area)).into(),
                slip: (&open(slip, 0.0, area)).into(),
                area,
            };
            Terms { pair, variables, shares: vec![share] }
        })
    }
}
