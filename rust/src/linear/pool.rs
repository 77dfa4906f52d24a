// SPDX-License-Identifier: BSD-3-Clause
//! Thread pools, one for each size asked for, made when first needed and kept.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

static POOLS: Mutex<BTreeMap<usize, Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// Runs `work` on a pool of `threads`, or right here for one thread.
///
/// If the system gives no threads the work is done on the calling one.
pub fn run<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    if threads <= 1 {
        return work();
    }
    let pool = {
        let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
        match pools.get(&threads) {
            Some(pool) => Some(Arc::clone(pool)),
            None => ThreadPoolBuilder::new().num_threads(threads).build().ok().map(|pool| {
                let pool = Arc::new(pool);
                pools.insert(threads, Arc::clone(&pool));
                pool
            }),
        }
    };
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Number of threads the machine offers.
pub fn available() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}
