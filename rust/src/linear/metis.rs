// SPDX-License-Identifier: BSD-3-Clause
//! Nested dissection by METIS, kept away from the signals of the process.
//!
//! METIS takes `SIGTERM` and `SIGABRT` for its own errors: on entry it replaces the handlers of
//! the whole process by one that jumps through a buffer of its thread. An application would lose
//! its own handlers, and a signal that another thread receives would jump to nowhere. Its sources
//! are therefore compiled with `signal` and `raise` renamed (`.cargo/config.toml`) to the two
//! functions here: no handler is ever installed, and an error jumps back to METIS's own entry
//! point on the same thread, which then returns its error code.
#![allow(unsafe_code)] // METIS is a C library; its arguments are built and checked here.

use std::ffi::{c_int, c_void};
use std::sync::{Mutex, PoisonError};

use super::error::LinearError;

/// METIS draws from one random stream for the whole process, so runs take turns.
static METIS_TURN: Mutex<()> = Mutex::new(());

/// Below this number of nodes the graph is handed over whole even if it has no edge.
const TINY: usize = 3;

unsafe extern "C" {
    /// Jumps to the entry point of METIS on this thread.
    fn gk_sigthrow(signum: c_int);
}

/// What METIS calls for `signal`: handlers stay as they are.
#[unsafe(no_mangle)]
extern "C" fn corota_metis_signal(_signum: c_int, _handler: *const c_void) -> *const c_void {
    std::ptr::null()
}

/// What METIS calls for `raise`, always between its entry and its return.
#[unsafe(no_mangle)]
extern "C" fn corota_metis_raise(signum: c_int) -> c_int {
    // SAFETY: METIS has filled its jump buffer on this thread; no value is dropped on the way.
    unsafe { gk_sigthrow(signum) };
    0
}

/// Nested dissection of a graph with weighted vertices; always the same result.
pub(super) fn dissect(
    xadj: &[u32],
    adjncy: &[u32],
    weights: &[i32],
) -> Result<Vec<u32>, LinearError> {
    let nodes = weights.len();
    if nodes < TINY || adjncy.is_empty() {
        return Ok((0..nodes as u32).collect());
    }
    let mut nvtxs = checked(nodes)?;
    checked(adjncy.len())?; // the last entry of `xadj`, which grows
    let mut xadj: Vec<i32> = xadj.iter().map(|&v| v as i32).collect();
    let mut adjncy: Vec<i32> = adjncy.iter().map(|&v| v as i32).collect();
    let mut weights = weights.to_vec();
    let mut order = vec![0_i32; nodes];
    let mut rank = vec![0_i32; nodes];
    let mut options = [-1_i32; metis_sys::METIS_NOPTIONS as usize];
    let turn = METIS_TURN.lock().unwrap_or_else(PoisonError::into_inner);
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

/// A count as METIS takes it, in 32 bits.
fn checked(count: usize) -> Result<i32, LinearError> {
    i32::try_from(count).map_err(|_| {
        LinearError::Pattern(format!("{count} entries of the node graph are too many for METIS"))
    })
}
