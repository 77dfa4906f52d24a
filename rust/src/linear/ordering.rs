// SPDX-License-Identifier: BSD-3-Clause
//! Fill-reducing elimination order: METIS nested dissection of the node graph.

use std::sync::Mutex;

use super::error::LinearError;
use super::pattern::NodeGraph;

/// METIS draws from one random stream for the whole process, so runs take turns.
static METIS_TURN: Mutex<()> = Mutex::new(());

/// Below this number of nodes the graph is handed over whole even if it has no edge.
const TINY: usize = 3;

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

/// Nested dissection of a graph with weighted vertices; always the same result.
#[allow(unsafe_code)] // METIS is a C library; its arguments are built and checked here.
fn dissect(xadj: &[u32], adjncy: &[u32], weights: &[i32]) -> Result<Vec<u32>, LinearError> {
    let nodes = weights.len();
    if nodes < TINY || adjncy.is_empty() {
        return Ok((0..nodes as u32).collect());
    }
    let mut nvtxs = nodes as i32;
    let mut xadj: Vec<i32> = xadj.iter().map(|&v| v as i32).collect();
    let mut adjncy: Vec<i32> = adjncy.iter().map(|&v| v as i32).collect();
    let mut weights = weights.to_vec();
    let mut order = vec![0_i32; nodes];
    let mut rank = vec![0_i32; nodes];
    let mut options = [-1_i32; metis_sys::METIS_NOPTIONS as usize];
    let turn = METIS_TURN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    // SAFETY: the pointers are to live vectors of the lengths METIS documents
    // (nvtxs, nvtxs + 1, xadj[nvtxs]); every neighbour is below nvtxs.
    let status = unsafe {
        metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr());
        options[metis_sys::moptions_et_METIS_OPTION_SEED as usize] = 1;
        options[metis_sys::moptions_et_METIS_OPTION_NUMBERING as usize] = 0;
        metis_sys::METIS_NodeND(
            &raw mut nvtxs,
            xadj.as_mut_ptr(),
            adjncy.as_mut_ptr(),
            weights.as_mut_ptr(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            rank.as_mut_ptr(),
        )
    };
    drop(turn);
    if status != metis_sys::rstatus_et_METIS_OK {
        return Err(LinearError::Pattern(format!("METIS refused the node graph ({status})")));
    }
    Ok(order.into_iter().map(|v| v as u32).collect())
}
