// SPDX-License-Identifier: BSD-3-Clause
//! Thread pools, one for each size and process, made when first needed and kept.
//!
//! A process that was forked has none of its parent's threads: a job given to a pool of the parent
//! would wait for ever.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::memory;

static POOLS: Mutex<BTreeMap<(u32, usize), Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// Runs `work` on a pool of `threads` and passes it their number; for one thread, or if the system
/// gives no threads, right here with 1. Outside of a pool rayon would start one of its own.
pub fn run<R: Send>(threads: usize, work: impl FnOnce(usize) -> R + Send) -> R {
    if threads <= 1 {
        return work(1);
    }
    match get(threads) {
        Some(pool) => pool.install(|| work(threads)),
        None => work(1),
    }
}

/// The pool of `threads` of this process; none if the system gives no threads or no room for them.
pub fn get(threads: usize) -> Option<Arc<ThreadPool>> {
    let key = (std::process::id(), threads);
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get(&key) {
        return Some(Arc::clone(pool));
    }
    // A thread that finds no addresses when it begins ends the process.
    if !memory::has_room_for(threads) {
        return None;
    }
    let pool = Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().ok()?);
    pools.insert(key, Arc::clone(&pool));
    Some(pool)
}

/// Number of threads the machine offers.
pub fn available() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}
