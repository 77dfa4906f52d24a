// SPDX-License-Identifier: BSD-3-Clause
//! Everything about a factorization that depends on the pattern alone.

use std::ops::Range;

use super::error::LinearError;
use super::etree::{NONE, supernode_tree};
use super::ordering::elimination_order;
use super::pattern::{NodeGraph, Pattern};

/// Work (multiplications) below which the whole tree is done in one piece.
const SMALL_WORK: f64 = 4e6;
/// The tree is cut into pieces of at most this share of the work.
const PIECE_SHARE: f64 = 1.0 / 24.0;

/// One front: `width` columns eliminated together, `below` rows they touch further on.
#[derive(Debug, Clone, Default)]
pub struct Front {
    /// First column, in elimination order.
    pub first: usize,
    pub width: usize,
    pub below: usize,
    /// Start of the front's rows (and relative places) in `Symbolic::rows`.
    pub rows_at: usize,
    /// Start of the front's panel in the factor.
    pub panel_at: usize,
    /// Parent or `NONE`.
    pub parent: u32,
    /// First front of the subtree that ends in this one.
    pub subtree: u32,
    /// Start of its entries in `Symbolic::entries`.
    pub entries_at: usize,
    /// Distance from the root, modulo two.
    pub odd: bool,
    /// Whether the front belongs to the top of the tree, above all pieces.
    pub top: bool,
    /// How many of its rows below are columns of the parent.
    pub into_columns: usize,
}

impl Front {
    /// Rows of the front.
    pub fn height(&self) -> usize {
        self.width + self.below
    }
}

/// Symbolic factorization.
#[derive(Debug, Default)]
pub struct Symbolic {
    pub n: usize,
    /// Equation eliminated as number `k`.
    pub order: Vec<u32>,
    pub fronts: Vec<Front>,
    /// Rows below of all fronts (elimination numbers, rising in a front).
    pub rows: Vec<u32>,
    /// Place of each such row in the parent's front.
    pub relative: Vec<u32>,
    /// (index in the caller's values, place in the panel) of all entries.
    pub entries: Vec<(u32, u32)>,
    /// Children of each front, rising, and where each list starts.
    pub child_list: Vec<u32>,
    pub child_at: Vec<usize>,
    pub roots: Vec<u32>,
    /// Length of the factor.
    pub factor_len: usize,
    /// Longest even and odd stacks that a piece of the tree needs.
    pub stack_len: [usize; 2],
    /// Multiplications of a factorization.
    pub work: f64,
    /// Largest front and largest `width * below`.
    pub max_height: usize,
}

impl Symbolic {
    /// Orders the pattern and lays out the fronts.
    ///
    /// `points` are coordinates by the numbers of `node_of_dof`; empty if they are not known.
    pub fn new(
        pattern: &Pattern<'_>,
        points: &[[f64; 2]],
        threads: usize,
    ) -> Result<Self, LinearError> {
        let graph = NodeGraph::new(pattern)?;
        let node_order = elimination_order(&graph, &graph.places(pattern, points), threads);
        let tree = supernode_tree(&graph, &node_order);
        drop(node_order);
        let count = tree.columns.len();

        let mut this = Self { n: pattern.n(), ..Self::default() };
        let mut first_of = vec![0_u32; graph.len()]; // node -> first elimination number
        let mut front_of = vec![0_u32; graph.len()];
        this.order.reserve(this.n);
        for (s, columns) in tree.columns.iter().enumerate() {
            let first = this.order.len();
            for &v in columns {
                first_of[v as usize] = this.order.len() as u32;
                front_of[v as usize] = s as u32;
                let dofs = graph.first_dof[v as usize]..graph.first_dof[v as usize + 1];
                this.order.extend(dofs);
            }
            let width = this.order.len() - first;
            this.fronts.push(Front {
                first,
                width,
                parent: tree.parent[s],
                subtree: s as u32,
                ..Front::default()
            });
        }
        this.link_children(&tree.parent);
        this.find_rows(&graph, &tree.columns, &first_of, &front_of, count);
        this.place_relative();
        this.cut();
        this.map_entries(pattern);
        Ok(this)
    }

    /// Values that a factorization holds at once: factor, a stack for each thread, and the
    /// squares that the fronts above them hand up, at most as many as the largest pairs of them.
    pub fn values(&self, threads: usize) -> usize {
        let stacks = threads * self.stack_len.iter().sum::<usize>();
        let shared = self.fronts.iter().filter(|f| f.top).map(|f| f.below * f.below);
        let handed: usize = if threads > 1 { shared.sum() } else { 0 };
        self.factor_len + stacks + handed + self.max_height * self.max_height
    }

    /// Children of front `s`.
    pub fn children(&self, s: usize) -> &[u32] {
        &self.child_list[self.child_at[s]..self.child_at[s + 1]]
    }

    /// Rows below of front `s`.
    pub fn rows_of(&self, s: usize) -> &[u32] {
        let f = &self.fronts[s];
        &self.rows[f.rows_at..f.rows_at + f.below]
    }

    /// Places of the rows below of front `s` in its parent.
    pub fn relative_of(&self, s: usize) -> &[u32] {
        let f = &self.fronts[s];
        &self.relative[f.rows_at..f.rows_at + f.below]
    }

    /// Where the panel of front `s` stands in the factor.
    pub fn panel_range(&self, s: usize) -> Range<usize> {
        let f = &self.fronts[s];
        f.panel_at..f.panel_at + f.height() * f.width
    }

    /// Entries of the matrix that belong to front `s`.
    pub fn entries_of(&self, s: usize) -> &[(u32, u32)] {
        let end = self.fronts.get(s + 1).map_or(self.entries.len(), |f| f.entries_at);
        &self.entries[self.fronts[s].entries_at..end]
    }

    fn link_children(&mut self, parent: &[u32]) {
        let count = parent.len();
        let mut at = vec![0_usize; count + 1];
        for &p in parent.iter().filter(|&&p| p != NONE) {
            at[p as usize + 1] += 1;
        }
        for s in 0..count {
            at[s + 1] += at[s];
        }
        let mut next = at.clone();
        let mut list = vec![0_u32; at[count]];
        for s in 0..count {
            let p = parent[s];
            if p == NONE {
                self.roots.push(s as u32);
            } else {
                let begin = self.fronts[s].subtree.min(self.fronts[p as usize].subtree);
                self.fronts[p as usize].subtree = begin;
                list[next[p as usize]] = s as u32;
                next[p as usize] += 1;
            }
        }
        self.child_at = at;
        self.child_list = list;
    }

    fn find_rows(
        &mut self,
        graph: &NodeGraph,
        columns: &[Vec<u32>],
        first_of: &[u32],
        front_of: &[u32],
        count: usize,
    ) {
        let mut node_rows: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut seen = vec![NONE; graph.len()];
        for s in 0..count {
            let mut rows = Vec::new();
            for &v in &columns[s] {
                seen[v as usize] = s as u32;
            }
            for &v in &columns[s] {
                for &u in graph.neighbors(v as usize) {
                    if front_of[u as usize] > s as u32 && seen[u as usize] != s as u32 {
                        seen[u as usize] = s as u32;
                        rows.push(u);
                    }
                }
            }
            for &c in &self.child_list[self.child_at[s]..self.child_at[s + 1]] {
                for &u in &node_rows[c as usize] {
                    if seen[u as usize] != s as u32 {
                        seen[u as usize] = s as u32;
                        rows.push(u);
                    }
                }
                node_rows[c as usize] = Vec::new();
            }
            rows.sort_unstable_by_key(|&u| first_of[u as usize]);
            let front = &mut self.fronts[s];
            front.rows_at = self.rows.len();
            for &u in &rows {
                let first = first_of[u as usize];
                self.rows.extend(first..first + graph.weight(u as usize) as u32);
            }
            front.below = self.rows.len() - front.rows_at;
            front.panel_at = self.factor_len;
            self.factor_len += front.height() * front.width;
            self.max_height = self.max_height.max(front.height());
            node_rows[s] = rows;
        }
    }

    fn place_relative(&mut self) {
        self.relative = vec![0; self.rows.len()];
        let mut place = vec![0_u32; self.n];
        for p in 0..self.fronts.len() {
            let parent = &self.fronts[p];
            let (first, width) = (parent.first, parent.width);
            for k in 0..width {
                place[first + k] = k as u32;
            }
            for (k, &r) in self.rows[parent.rows_at..][..parent.below].iter().enumerate() {
                place[r as usize] = (width + k) as u32;
            }
            for c in self.child_at[p]..self.child_at[p + 1] {
                let child = self.child_list[c] as usize;
                let range = self.fronts[child].rows_at..;
                let below = self.fronts[child].below;
                let range = range.start..range.start + below;
                for k in range.clone() {
                    self.relative[k] = place[self.rows[k] as usize];
                }
                let inside = self.relative[range].iter().filter(|&&k| (k as usize) < width);
                self.fronts[child].into_columns = inside.count();
            }
        }
    }

    /// Cuts the tree into pieces done by one thread each and the top above them.
    fn cut(&mut self) {
        let count = self.fronts.len();
        let mut below = vec![0.0_f64; count];
        for s in 0..count {
            let (w, b) = (self.fronts[s].width as f64, self.fronts[s].below as f64);
            // A front also costs its handling, felt where it is small.
            let own = w * w * w / 6.0 + w * w * b / 2.0 + w * b * b / 2.0 + b * b + 500.0;
            below[s] += own;
            let p = self.fronts[s].parent;
            if p != NONE {
                let sum = below[s];
                below[p as usize] += sum;
            }
            self.work += own;
        }
        let limit = if self.work < SMALL_WORK { f64::INFINITY } else { self.work * PIECE_SHARE };
        for s in (0..count).rev() {
            let p = self.fronts[s].parent;
            let odd = p != NONE && !self.fronts[p as usize].odd;
            self.fronts[s].odd = odd;
            self.fronts[s].top = below[s] > limit;
        }
        let mut used = [0_usize; 2];
        for s in 0..count {
            let f = &self.fronts[s];
            if f.top {
                used = [0; 2];
                continue;
            }
            let ends = f.parent == NONE || self.fronts[f.parent as usize].top;
            let (own, other) = (usize::from(f.odd), usize::from(!f.odd));
            if !ends {
                used[own] += f.below * f.below;
                self.stack_len[own] = self.stack_len[own].max(used[own]);
            }
            for &c in &self.child_list[self.child_at[s]..self.child_at[s + 1]] {
                used[other] -= self.fronts[c as usize].below.pow(2);
            }
        }
    }

    fn map_entries(&mut self, pattern: &Pattern<'_>) {
        let mut rank = vec![0_u32; self.n];
        for (k, &d) in self.order.iter().enumerate() {
            rank[d as usize] = k as u32;
        }
        let mut front_of = vec![0_u32; self.n];
        for (s, f) in self.fronts.iter().enumerate() {
            front_of[f.first..f.first + f.width].fill(s as u32);
        }
        let mut at = vec![0_usize; self.fronts.len() + 1];
        let each = |visit: &mut dyn FnMut(usize, u32, u32)| {
            for c in 0..self.n {
                let pc = rank[c];
                for k in pattern.col_ptr[c]..pattern.col_ptr[c + 1] {
                    let pr = rank[pattern.row_idx[k] as usize];
                    visit(k, pr.max(pc), pr.min(pc));
                }
            }
        };
        each(&mut |_, _, column| at[front_of[column as usize] as usize + 1] += 1);
        for s in 0..self.fronts.len() {
            at[s + 1] += at[s];
        }
        let mut next = at.clone();
        // First the row's number and the column in the front, then the place in the panel.
        let mut entries = vec![(0_u32, 0_u32); pattern.row_idx.len()];
        let mut columns = vec![0_u32; pattern.row_idx.len()];
        each(&mut |k, row, column| {
            let s = front_of[column as usize] as usize;
            entries[next[s]] = (k as u32, row);
            columns[next[s]] = column - self.fronts[s].first as u32;
            next[s] += 1;
        });
        let mut place = vec![0_u32; self.n];
        for s in 0..self.fronts.len() {
            let f = &mut self.fronts[s];
            f.entries_at = at[s];
            for k in 0..f.width {
                place[f.first + k] = k as u32;
            }
            for (k, &r) in self.rows[f.rows_at..][..f.below].iter().enumerate() {
                place[r as usize] = (f.width + k) as u32;
            }
            let height = f.height() as u32;
            for k in at[s]..at[s + 1] {
                entries[k].1 = place[entries[k].1 as usize] + columns[k] * height;
            }
        }
        self.entries = entries;
    }
}
