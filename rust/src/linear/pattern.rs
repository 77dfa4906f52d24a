// SPDX-License-Identifier: BSD-3-Clause
//! The sparsity pattern as the solvers receive it, checked once, and its node graph.

use super::error::LinearError;

/// Pattern of a matrix in compressed columns, borrowed from the caller.
#[derive(Debug, Clone, Copy)]
pub struct Pattern<'a> {
    /// Start of each column, `n + 1` values.
    pub col_ptr: &'a [usize],
    /// Row of each entry, rising inside a column. Symmetric solvers take the
    /// upper triangle (`row <= column`) only.
    pub row_idx: &'a [u32],
    /// Node of each equation; the equations of one node stand together.
    pub node_of_dof: &'a [u32],
    /// Equations of multipliers, eliminated right after what they connect.
    pub after: &'a [u32],
}

impl Pattern<'_> {
    /// Number of equations.
    pub fn n(&self) -> usize {
        self.col_ptr.len().saturating_sub(1)
    }

    /// Refuses a pattern that breaks the contract; `upper` asks for `row <= column`.
    pub fn check(&self, upper: bool) -> Result<(), LinearError> {
        let bad = |text: String| Err(LinearError::Pattern(text));
        let n = self.n();
        if self.col_ptr.first() != Some(&0) || self.col_ptr.last() != Some(&self.row_idx.len()) {
            return bad("column pointers must start at 0 and end at the number of entries".into());
        }
        if n >= i32::MAX as usize || self.row_idx.len() >= u32::MAX as usize {
            return bad(format!("{n} equations are more than 32-bit indices can hold"));
        }
        if self.node_of_dof.len() != n {
            return bad(format!(
                "node_of_dof has {} values for {n} equations",
                self.node_of_dof.len()
            ));
        }
        if let Some(&m) = self.after.iter().find(|&&m| m as usize >= n) {
            return bad(format!("multiplier equation {m} is not below {n}"));
        }
        for (c, w) in self.col_ptr.windows(2).enumerate() {
            if w[0] > w[1] || w[1] > self.row_idx.len() {
                return bad(format!("column pointers fall at column {c}"));
            }
            let rows = &self.row_idx[w[0]..w[1]];
            if rows.windows(2).any(|p| p[0] >= p[1]) {
                return bad(format!("rows of column {c} are not strictly rising"));
            }
            let limit = if upper { c } else { n - 1 };
            if rows.last().is_some_and(|&r| r as usize > limit) {
                let what = if upper { "upper triangle" } else { "matrix" };
                return bad(format!("column {c} has a row outside the {what}"));
            }
        }
        Ok(())
    }
}

/// Graph of the nodes: two nodes are neighbors if any of their equations couple.
#[derive(Debug, Clone)]
pub struct NodeGraph {
    /// First equation of each node, `n_nodes + 1` values.
    pub first_dof: Vec<u32>,
    /// Start of each node's list of neighbors.
    pub xadj: Vec<u32>,
    /// Neighbors, rising inside a list, no self loops.
    pub adjncy: Vec<u32>,
    /// Whether the node carries a multiplier.
    pub after: Vec<bool>,
}

impl NodeGraph {
    /// Collapses an (upper or full) pattern to its nodes.
    pub fn new(pattern: &Pattern<'_>) -> Result<Self, LinearError> {
        let n = pattern.n();
        let mut first_dof = Vec::with_capacity(n / 2 + 2);
        let mut group = vec![0_u32; n];
        for d in 0..n {
            if d == 0 || pattern.node_of_dof[d] != pattern.node_of_dof[d - 1] {
                first_dof.push(d as u32);
            }
            group[d] = first_dof.len() as u32 - 1;
        }
        let nodes = first_dof.len();
        first_dof.push(n as u32);
        let mut after = vec![false; nodes];
        for &m in pattern.after {
            after[group[m as usize] as usize] = true;
        }

        // Distinct (node, other node) pairs, column by column, then both ways.
        let mut seen = vec![u32::MAX; nodes];
        let mut pairs_ptr = Vec::with_capacity(nodes + 1);
        let mut pairs: Vec<u32> = Vec::with_capacity(pattern.row_idx.len() / 3);
        let mut degree = vec![0_u32; nodes + 1];
        pairs_ptr.push(0);
        for v in 0..nodes {
            seen[v] = v as u32;
            let start = pattern.col_ptr[first_dof[v] as usize];
            let end = pattern.col_ptr[first_dof[v + 1] as usize];
            for &r in &pattern.row_idx[start..end] {
                let u = group[r as usize];
                if seen[u as usize] != v as u32 {
                    seen[u as usize] = v as u32;
                    pairs.push(u);
                    degree[u as usize + 1] += 1;
                    degree[v + 1] += 1;
                }
            }
            pairs_ptr.push(pairs.len());
        }
        for v in 0..nodes {
            degree[v + 1] += degree[v];
        }
        let mut next = degree.clone();
        let mut adjncy = vec![0_u32; 2 * pairs.len()];
        for v in 0..nodes {
            for &u in &pairs[pairs_ptr[v]..pairs_ptr[v + 1]] {
                for (a, b) in [(u as usize, v as u32), (v, u)] {
                    adjncy[next[a] as usize] = b;
                    next[a] += 1;
                }
            }
        }
        // A full pattern names each pair twice.
        let mut xadj = Vec::with_capacity(nodes + 1);
        xadj.push(0_u32);
        let mut kept = 0;
        for v in 0..nodes {
            let (a, b) = (degree[v] as usize, degree[v + 1] as usize);
            adjncy[a..b].sort_unstable();
            let first = kept;
            for k in a..b {
                if kept == first || adjncy[kept - 1] != adjncy[k] {
                    adjncy[kept] = adjncy[k];
                    kept += 1;
                }
            }
            xadj.push(kept as u32);
        }
        adjncy.truncate(kept);
        Ok(Self { first_dof, xadj, adjncy, after })
    }

    /// Coordinates of the nodes, given by their numbers in the pattern, those of multipliers not a
    /// number; empty if others have none.
    pub fn places(&self, pattern: &Pattern<'_>, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut found = Vec::with_capacity(if points.is_empty() { 0 } else { self.len() });
        for v in 0..self.len() {
            let node = pattern.node_of_dof[self.first_dof[v] as usize] as usize;
            match points.get(node) {
                Some(x) if !self.after[v] => found.push(*x),
                _ if self.after[v] => found.push([f64::NAN; 2]),
                _ => return Vec::new(),
            }
        }
        found
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.after.len()
    }

    /// Whether there is no node at all.
    pub fn is_empty(&self) -> bool {
        self.after.is_empty()
    }

    /// Neighbors of node `v`.
    pub fn neighbors(&self, v: usize) -> &[u32] {
        &self.adjncy[self.xadj[v] as usize..self.xadj[v + 1] as usize]
    }

    /// Number of equations of node `v`.
    pub fn weight(&self, v: usize) -> usize {
        (self.first_dof[v + 1] - self.first_dof[v]) as usize
    }
}
