// SPDX-License-Identifier: BSD-3-Clause
//! Fill-reducing elimination order: METIS nested dissection of the node graph.

use super::error::LinearError;
use super::metis::dissect;
use super::pattern::NodeGraph;

/// Most neighbours of a multiplier that are tied together before the dissection.
const CLIQUE_LIMIT: usize = 48;

/// Order of elimination: entry `k` is the node eliminated as number `k`.
///
/// Multipliers are taken out of the graph (what they connect is tied together
/// instead, as their elimination will do) and follow the last node they connect.
pub fn elimination_order(graph: &NodeGraph) -> Result<Vec<u32>, LinearError> {
    let nodes = graph.len();
    if !graph.after.contains(&true) {
        let weights: Vec<i32> = (0..nodes).map(|v| graph.weight(v) as i32).collect();
        return dissect(&graph.xadj, &graph.adjncy, &weights);
    }

    let kept: Vec<u32> = (0..nodes as u32).filter(|&v| !graph.after[v as usize]).collect();
    let mut place = vec![u32::MAX; nodes];
    for (k, &v) in kept.iter().enumerate() {
        place[v as usize] = k as u32;
    }
    let mut ties: Vec<Vec<u32>> = vec![Vec::new(); kept.len()];
    for m in (0..nodes).filter(|&v| graph.after[v]) {
        let tied: Vec<u32> = graph.neighbours(m).iter().map(|&u| place[u as usize]).collect();
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
        let own = graph.neighbours(v as usize).iter().map(|&u| place[u as usize]);
        let mut list: Vec<u32> =
            own.filter(|&u| u != u32::MAX).chain(ties[k].iter().copied()).collect();
        list.sort_unstable();
        list.dedup();
        adjncy.extend_from_slice(&list);
        xadj.push(adjncy.len() as u32);
    }
    let weights: Vec<i32> = kept.iter().map(|&v| graph.weight(v as usize) as i32).collect();
    let order = dissect(&xadj, &adjncy, &weights)?;

    let mut rank = vec![0_u32; nodes];
    for (k, &v) in order.iter().enumerate() {
        rank[kept[v as usize] as usize] = k as u32;
    }
    let mut keyed: Vec<(u32, bool, u32)> = (0..nodes as u32)
        .map(|v| {
            let is_after = graph.after[v as usize];
            let key = if is_after {
                let primal = graph.neighbours(v as usize).iter();
                let primal = primal.filter(|&&u| !graph.after[u as usize]);
                primal.map(|&u| rank[u as usize]).max().unwrap_or(u32::MAX)
            } else {
                rank[v as usize]
            };
            (key, is_after, v)
        })
        .collect();
    keyed.sort_unstable();
    Ok(keyed.into_iter().map(|(_, _, v)| v).collect())
}
