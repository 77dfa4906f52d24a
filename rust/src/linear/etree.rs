// SPDX-License-Identifier: BSD-3-Clause
//! Elimination tree of the node graph, its supernodes and their amalgamation.

use super::pattern::NodeGraph;

/// No parent.
pub const NONE: u32 = u32::MAX;

/// Width (in equations) up to which a supernode joins its parent whatever the zeros.
const ALWAYS_WIDTH: usize = 8;
/// Share of explicit zeros allowed up to a width of the merged supernode.
const ZERO_SHARE: [(usize, f64); 3] = [(32, 0.8), (96, 0.12), (usize::MAX, 0.05)];

/// A tree of supernodes: columns that are eliminated together.
#[derive(Debug, Default)]
pub struct SupernodeTree {
    /// Nodes of each supernode in order of elimination; supernodes in postorder.
    pub columns: Vec<Vec<u32>>,
    /// Parent of each supernode or `NONE`.
    pub parent: Vec<u32>,
}

/// Tree over nodes in elimination order: parent and height (in equations) of each column.
fn column_tree(graph: &NodeGraph, order: &[u32], rank: &[u32]) -> (Vec<u32>, Vec<usize>) {
    let n = order.len();
    let mut parent = vec![NONE; n];
    let mut height = vec![0_usize; n];
    let mut seen = vec![NONE; n];
    for j in 0..n {
        let v = order[j] as usize;
        let weight = graph.weight(v);
        seen[j] = j as u32;
        height[j] += weight;
        for &u in graph.neighbors(v) {
            let mut i = rank[u as usize] as usize;
            if i >= j {
                continue;
            }
            while seen[i] != j as u32 {
                if parent[i] == NONE {
                    parent[i] = j as u32;
                }
                height[i] += weight;
                seen[i] = j as u32;
                i = parent[i] as usize;
            }
        }
    }
    (parent, height)
}

/// Children first, in rising order of `key` among siblings; the roots last.
fn postorder(parent: &[u32], key: &[u64]) -> Vec<u32> {
    let n = parent.len();
    let mut by_key: Vec<u32> = (0..n as u32).collect();
    by_key.sort_by_key(|&v| key[v as usize]);
    let (mut head, mut next) = (vec![NONE; n + 1], vec![NONE; n]);
    for &v in by_key.iter().rev() {
        let p = if parent[v as usize] == NONE { n } else { parent[v as usize] as usize };
        next[v as usize] = head[p];
        head[p] = v;
    }
    let mut order = Vec::with_capacity(n);
    let mut stack = Vec::new();
    let mut root = head[n];
    while root != NONE {
        stack.push(root);
        while let Some(&v) = stack.last() {
            let child = head[v as usize];
            if child == NONE {
                order.push(v);
                stack.pop();
            } else {
                head[v as usize] = next[child as usize];
                stack.push(child);
            }
        }
        root = next[root as usize];
    }
    order
}

/// Supernodes of the graph eliminated in `order`, small ones merged into their parents.
pub fn supernode_tree(graph: &NodeGraph, order: &[u32]) -> SupernodeTree {
    let n = order.len();
    let mut rank = vec![0_u32; n];
    for (k, &v) in order.iter().enumerate() {
        rank[v as usize] = k as u32;
    }
    let (parent, height) = column_tree(graph, order, &rank);
    let sequence = postorder(&parent, &(0..n as u64).collect::<Vec<_>>());

    // Chains of columns with nested structure are one supernode.
    let mut columns: Vec<Vec<u32>> = Vec::new();
    let mut of_column = vec![0_u32; n];
    let mut tall: Vec<usize> = Vec::new();
    for (k, &j) in sequence.iter().enumerate() {
        let j = j as usize;
        let v = order[j];
        let joins = k > 0 && {
            let i = sequence[k - 1] as usize;
            parent[i] == j as u32 && height[i] == height[j] + graph.weight(order[i] as usize)
        };
        if !joins {
            columns.push(Vec::new());
            tall.push(height[j]);
        }
        let s = columns.len() - 1;
        columns[s].push(v);
        of_column[j] = s as u32;
    }
    let count = columns.len();
    let mut up = vec![NONE; count];
    for s in 0..count {
        let last = rank[columns[s][columns[s].len() - 1] as usize] as usize;
        if parent[last] != NONE {
            up[s] = of_column[parent[last] as usize];
        }
    }
    let wide: Vec<usize> =
        columns.iter().map(|c| c.iter().map(|&v| graph.weight(v as usize)).sum()).collect();
    merge(columns, up, wide, tall, &rank)
}

/// Merges supernodes into their parents where the zeros this stores are few.
fn merge(
    mut columns: Vec<Vec<u32>>,
    mut up: Vec<u32>,
    mut wide: Vec<usize>,
    mut tall: Vec<usize>,
    rank: &[u32],
) -> SupernodeTree {
    let count = columns.len();
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
    for s in 0..count {
        if up[s] != NONE {
            children[up[s] as usize].push(s as u32);
        }
    }
    let mut zeros = vec![0_usize; count];
    let mut alive = vec![true; count];
    for t in 0..count {
        let mut list = std::mem::take(&mut children[t]);
        // The best fitting child first: the fewest rows that it does not have.
        list.sort_by_key(|&s| (tall[t] + wide[s as usize] - tall[s as usize], s));
        let mut kept = Vec::with_capacity(list.len());
        for &s in &list {
            let s = s as usize;
            let width = wide[s] + wide[t];
            let new_zeros = zeros[s] + zeros[t] + wide[s] * (wide[s] + tall[t] - tall[s]);
            let total = width * (width + 1) / 2 + width * (wide[s] + tall[t] - width);
            let share = new_zeros as f64 / total as f64;
            let allowed = ZERO_SHARE.iter().find(|&&(w, _)| width <= w).map_or(0.0, |&(_, z)| z);
            if width <= ALWAYS_WIDTH || share <= allowed {
                alive[s] = false;
                let mut moved = std::mem::take(&mut columns[s]);
                moved.append(&mut columns[t]);
                columns[t] = moved;
                kept.append(&mut children[s]);
                tall[t] += wide[s];
                wide[t] = width;
                zeros[t] = new_zeros;
            } else {
                kept.push(s as u32);
            }
        }
        for &s in &kept {
            up[s as usize] = t as u32;
        }
        children[t] = kept;
    }

    // Children with a large working set first, so that the stack stays low.
    let square = |v: usize| (v as u64) * (v as u64);
    let mut peak = vec![0_u64; count];
    let mut key = vec![0_u64; count];
    for t in (0..count).filter(|&t| alive[t]) {
        let below = |s: usize| square(tall[s] - wide[s]);
        children[t].sort_by_key(|&s| (std::cmp::Reverse(peak[s as usize] - below(s as usize)), s));
        let mut held = 0;
        let mut most = 0;
        for (k, &s) in children[t].iter().enumerate() {
            key[s as usize] = k as u64;
            most = most.max(held + peak[s as usize]);
            held += below(s as usize);
        }
        peak[t] = most.max(held + below(t));
    }
    let place: Vec<u32> = {
        let mut place = vec![NONE; count];
        let mut next = 0;
        for s in 0..count {
            if alive[s] {
                place[s] = next;
                next += 1;
            }
        }
        place
    };
    let living: Vec<usize> = (0..count).filter(|&s| alive[s]).collect();
    let parent: Vec<u32> =
        living.iter().map(|&s| if up[s] == NONE { NONE } else { place[up[s] as usize] }).collect();
    let key: Vec<u64> = living.iter().map(|&s| key[s]).collect();
    let sequence = postorder(&parent, &key);
    let mut position = vec![0_u32; living.len()];
    for (k, &s) in sequence.iter().enumerate() {
        position[s as usize] = k as u32;
    }
    let mut tree = SupernodeTree::default();
    for &s in &sequence {
        let mut list = std::mem::take(&mut columns[living[s as usize]]);
        list.sort_unstable_by_key(|&v| rank[v as usize]);
        tree.columns.push(list);
        let p = parent[s as usize];
        tree.parent.push(if p == NONE { NONE } else { position[p as usize] });
    }
    tree
}
