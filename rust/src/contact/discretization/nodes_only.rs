//! Gaps at the slave nodes alone: the smallest discretization, compiled for tests as an example.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::search::{self, Candidate, Item, each};
use super::super::sides::Sides;
use super::super::slave::Slave;
use super::super::terms::{Function, Share, Terms, WIDTH, join, lifted};
use super::super::travel::Start;
use super::node_to_segment::{Bounds, choose, open};
use super::{Discretization, Entry};

pub const ENTRY: Entry =
    Entry { name: "nodes_only", joins: false, integrates: false, new: |_, _| Box::new(NodesOnly) };

/// Each slave node against the closest master, chosen anew at every evaluation, without friction.
pub struct NodesOnly;

impl Discretization for NodesOnly {
    fn items(&self, slave: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
        search::nodes(slave, x)
    }

    fn owners(&self, slave: &Slave) -> Vec<Vec<usize>> {
        slave.owners(true)
    }

    fn variables(&self, sides: &Sides, (k, j): Candidate) -> [i64; WIDTH] {
        let node = 3 * i64::from(sides.slave.nodes[k]);
        join(&[node, node + 1], &sides.master.variables(j))
    }

    fn constraints(&self, _: &Sides, (k, _): Candidate) -> [usize; 3] {
        [k, usize::MAX, usize::MAX]
    }

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], _: Option<&Start>) -> Vec<Terms> {
        let normals = search::nodes(&sides.slave, x);
        let found = each(sides.n_items(), |k| {
            let p = x[sides.slave.nodes[k] as usize];
            let place = |pair: usize| (pair, sides.master.place(sides.candidates()[pair].1, x));
            let shapes: Vec<_> = sides.of_item(k).map(place).collect();
            let bounds = Bounds { reach: sides.distances.reach, depth: sides.depth[k] };
            let pair = choose([p[0], p[1]], normals[k].1, &shapes, None, bounds)?;
            Some(self.at(sides, pair, x))
        });
        found.into_iter().flatten().collect()
    }
}

impl NodesOnly {
    /// Gap of a candidate pair as a function of the variables of its node and its master.
    fn at(&self, sides: &Sides, pair: usize, x: &[[f64; 3]]) -> Terms {
        let (k, j) = sides.candidates()[pair];
        let variables = self.variables(sides, (k, j));
        let v = lifted::<8>(&variables, x);
        let width = sides.master.variables(j).len();
        let master = sides.master.shape(j, &v[2..2 + width]);
        let hit = master.closest([v[0], v[1]]);
        let area = sides.slave.area[k];
        let gap = (&open(hit.gap, sides.offset[k], area)).into();
        let share = Share { constraint: k, gap, slip: Function::none(), area };
        Terms { pair, variables, shares: vec![share] }
    }
}
