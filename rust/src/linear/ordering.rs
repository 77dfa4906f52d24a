// SPDX-License-Identifier: BSD-3-Clause
//! Fill-reducing elimination order: nested dissection of the node graph.
//!
//! The last orders are kept: runs of one process often have the same mesh.

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

use super::dissection::{self, Graph};
use super::pattern::NodeGraph;
use crate::base::pool;

/// Most neighbors of a multiplier that are tied together before the dissection.
const CLIQUE_LIMIT: usize = 48;

/// Nodes in the orders that are kept, all together.
const KEPT: usize = 1 << 22;
/// The last orders by the digest of their graph, newest last.
static ORDERS: Mutex<VecDeque<(u64, Vec<u32>)>> = Mutex::new(VecDeque::new());
/// Orders that were computed, and not found again.
static COMPUTED: AtomicUsize = AtomicUsize::new(0);

/// Number of orders that this process has computed.
pub fn computed() -> usize {
    COMPUTED.load(Relaxed)
}

/// Order of elimination: entry `k` is the node eliminated as number `k`.
///
/// Multipliers are taken out of the graph (what they connect is tied together
/// instead, as their elimination will do) and follow the last node they connect.
/// `points` are the coordinates of the nodes, empty if unknown; those of multipliers are not used.
pub fn elimination_order(graph: &NodeGraph, points: &[[f64; 2]], threads: usize) -> Vec<u32> {
    let digest = digest(graph, points);
    let kept = || ORDERS.lock().unwrap_or_else(PoisonError::into_inner);
    let found = kept().iter().find(|(d, o)| *d == digest && o.len() == graph.len()).cloned();
    if let Some((_, order)) = found {
        return order;
    }
    let order = compute(graph, points, threads);
    COMPUTED.fetch_add(1, Relaxed);
    if order.len() <= KEPT {
        let mut orders = kept();
        orders.push_back((digest, order.clone()));
        while orders.iter().map(|(_, o)| o.len()).sum::<usize>() > KEPT {
            orders.pop_front();
        }
    }
    order
}

/// A number that two different graphs hardly have in common. If they did, the order would still be
/// an order, with more fill.
fn digest(graph: &NodeGraph, points: &[[f64; 2]]) -> u64 {
    let mut found = DefaultHasher::new();
    (&graph.first_dof, &graph.xadj, &graph.adjncy, &graph.after).hash(&mut found);
    let mut sum = 0_u64;
    for (x, multiplier) in points.iter().zip(&graph.after) {
        for bits in x.map(f64::to_bits) {
            let bits = if *multiplier { 0 } else { bits };
            sum = (sum.rotate_left(5) ^ bits).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        }
    }
    (points.len(), sum).hash(&mut found);
    found.finish()
}

/// Nested dissection of a graph without multipliers.
fn dissect(
    xadj: &[u32],
    adjncy: &[u32],
    weights: &[i32],
    points: &[[f64; 2]],
    threads: usize,
) -> Vec<u32> {
    let known = points.len() == weights.len() && points.iter().flatten().all(|x| x.is_finite());
    let points = if known { points } else { &[] };
    let graph = Graph { xadj, adjncy, weights, points };
    pool::run(threads, |threads| dissection::dissect(graph, threads > 1))
}

fn compute(graph: &NodeGraph, points: &[[f64; 2]], threads: usize) -> Vec<u32> {
    let nodes = graph.len();
    if !graph.after.contains(&true) {
        let weights: Vec<i32> = (0..nodes).map(|v| graph.weight(v) as i32).collect();
        return dissect(&graph.xadj, &graph.adjncy, &weights, points, threads);
    }

    let kept: Vec<u32> = (0..nodes as u32).filter(|&v| !graph.after[v as usize]).collect();
    let mut place = vec![u32::MAX; nodes];
    for (k, &v) in kept.iter().enumerate() {
        place[v as usize] = k as u32;
    }
    let mut ties: Vec<Vec<u32>> = vec![Vec::new(); kept.len()];
    for m in (0..nodes).filter(|&v| graph.after[v]) {
        let tied: Vec<u32> = graph.neighbors(m).iter().map(|&u| place[u as usize]).collect();
        let tied: Vec<u32> = tied.into_iter().filter(|&u| u != u32::MAX).collect();
        if tied.len() <= CLIQUE_LIMIT {
            for &u in &tied {
                ties[u as usize].extend(tied.iter().filter(|&&w| w != u));
            }
        }
    }
    let mut xadj = vec![0_u32];
    let mut adjncy = Vec::with_capacity(graph.adjncy.len());
    for (k, &v) in kept.iter().enumerate() {
        let own = graph.neighbors(v as usize).iter().map(|&u| place[u as usize]);
        let mut list: Vec<u32> =
            own.filter(|&u| u != u32::MAX).chain(ties[k].iter().copied()).collect();
        list.sort_unstable();
        list.dedup();
        adjncy.extend_from_slice(&list);
        xadj.push(adjncy.len() as u32);
    }
    let weights: Vec<i32> = kept.iter().map(|&v| graph.weight(v as usize) as i32).collect();
    let places: Vec<[f64; 2]> =
        kept.iter().filter_map(|&v| points.get(v as usize).copied()).collect();
    let order = dissect(&xadj, &adjncy, &weights, &places, threads);

    let mut rank = vec![0_u32; nodes];
    for (k, &v) in order.iter().enumerate() {
        rank[kept[v as usize] as usize] = k as u32;
    }
    let mut keyed: Vec<(u32, bool, u32)> = (0..nodes as u32)
        .map(|v| {
            let is_after = graph.after[v as usize];
            let key = if is_after {
                let primal = graph.neighbors(v as usize).iter();
                let primal = primal.filter(|&&u| !graph.after[u as usize]);
                primal.map(|&u| rank[u as usize]).max().unwrap_or(u32::MAX)
            } else {
                rank[v as usize]
            };
            (key, is_after, v)
        })
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, _, v)| v).collect()
}
