//! How the gaps of two surfaces are measured: what a discretization says, and the list of them.
// SPDX-License-Identifier: BSD-3-Clause

pub mod line;
pub mod mortar;
pub mod node_to_segment;
#[cfg(test)]
pub mod nodes_only;
pub mod point_tie;
pub mod tie;

use super::search::{self, Candidate, Item};
use super::sides::Sides;
use super::slave::Slave;
use super::terms::{Terms, WIDTH, distinct, join};
use super::travel::{Start, Station};

/// All discretizations.
pub const DISCRETIZATIONS: &[Entry] = &[
    mortar::ENTRY,
    node_to_segment::ENTRY,
    tie::ENTRY,
    #[cfg(test)]
    nodes_only::ENTRY,
];

/// Those of pairs with a line or single nodes, which take no other.
pub const OF_LINES: &[Entry] = &[line::ENTRY, point_tie::ENTRY];

/// Facts of a discretization, and how one is made for a pair in its reference configuration.
pub struct Entry {
    pub name: &'static str,
    /// Joins the surfaces for good, on the pairing of the reference configuration.
    pub joins: bool,
    /// Gaps are integrals over slave edges: where the master ends, an edge is covered in part.
    pub integrates: bool,
    pub new: fn(&Sides, &[[f64; 3]]) -> Box<dyn Discretization>,
}

/// The discretization of that name, or that of lines.
pub fn find(name: &str) -> Result<&'static Entry, String> {
    DISCRETIZATIONS.iter().chain(OF_LINES).find(|entry| entry.name == name).ok_or_else(|| {
        let names: Vec<&str> = DISCRETIZATIONS.iter().map(|entry| entry.name).collect();
        format!("no contact discretization {name:?}; there are {names:?}")
    })
}

/// Gaps and slips of the constraints of a pair, with derivatives.
///
/// A constraint is numbered by its place in the slave's nodes. The search gives candidates: an
/// item of the slave, which is an edge unless a discretization says otherwise, and a master.
pub trait Discretization: Send + Sync {
    /// Items of the slave as the search sees them.
    fn items(&self, slave: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
        search::edges(slave, x)
    }

    /// Slave edges of each item.
    fn owners(&self, slave: &Slave) -> Vec<Vec<usize>> {
        slave.owners(false)
    }

    /// Slave node of each constraint, by its place in the slave's nodes.
    fn places(&self, slave: &Slave) -> Vec<usize> {
        (0..slave.nodes.len()).collect()
    }

    /// Mesh nodes of the corners that the last constraints belong to, -1 for those of a rigid body.
    fn corners(&self) -> Vec<i64> {
        Vec::new()
    }

    /// Whether an item of the slave may meet a master.
    fn allows(&self, _item: usize, _master: usize) -> bool {
        true
    }

    /// Variables of a candidate, -1 where unused.
    fn variables(&self, sides: &Sides, (i, j): Candidate) -> [i64; WIDTH] {
        // Beside the tip of a notch both have its node.
        let mut variables = sides.slave.edges[i].variables();
        variables.extend(sides.master.variables(j));
        join(&distinct(&variables).0, &[])
    }

    /// Constraints of a candidate, `usize::MAX` where unused.
    fn constraints(&self, sides: &Sides, (i, _): Candidate) -> [usize; 3] {
        sides.slave.constraints[i]
    }

    /// Take the candidates of the reference configuration, where surfaces are joined for good, and
    /// leave those that are.
    fn bind(&mut self, _sides: &mut Sides, _x: &[[f64; 3]]) {}

    /// Terms of all candidates that meet at `x`, in the order of the candidates; slips since a
    /// start.
    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], start: Option<&Start>) -> Vec<Terms>;

    /// Whether slips are measured from stations; else from where the sides were.
    fn has_stations(&self) -> bool {
        true
    }

    /// Where slave points face a master at `x`, with candidates that belong to it.
    fn stations(
        &self,
        _sides: &Sides,
        _x: &[[f64; 3]],
        _closed: &dyn Fn(usize) -> bool,
    ) -> Vec<Station> {
        Vec::new()
    }

    /// Take which constraints belong to ends of the slave that supports hold from now on.
    fn hold(&mut self, _sides: &Sides, _held: &[bool], _rough: bool) {}

    /// Keep what later evaluations depend on as what to return to.
    fn commit(&mut self) {}

    /// Return to what the last commit kept.
    fn restore(&mut self) {}

    /// Forget which masters the constraints had, to which they would keep for a while.
    fn forget(&mut self) {}

    /// What later evaluations depend on, as masters' numbers or -1, always as many.
    fn memory(&self) -> Vec<i64> {
        Vec::new()
    }

    /// Take what `memory` gave.
    fn remember(&mut self, _memory: &[i64]) {}
}
