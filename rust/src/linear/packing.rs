// SPDX-License-Identifier: BSD-3-Clause
//! Memory that products of dense matrices set aside on each thread.
//!
//! The kernels behind faer pack their operands into buffers of twice the last-level cache, taken at
//! the first product of a thread: half a gigabyte on large machines. An allocation that fails there
//! ends the process, so it is judged and made here, before the factorization begins.

use std::cell::Cell;
use std::fs;
use std::process;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use crate::base::memory::{self, Shortage};

/// Side of a product that is large enough to be packed.
const SIDE: usize = 64;

thread_local! {
    static RESERVED: Cell<bool> = const { Cell::new(false) };
}

/// Takes the buffers of this thread, once, if there is room for them.
pub fn reserve() -> Result<(), Shortage> {
    if RESERVED.get() {
        return Ok(());
    }
    let _turn = Turn::take();
    memory::require(2 * last_level_cache(), || "the buffers of matrix products".into())?;
    let a = Mat::<f64>::zeros(SIDE, SIDE);
    let mut product = Mat::<f64>::zeros(SIDE, SIDE);
    matmul(product.as_mut(), Accum::Replace, a.as_ref(), a.as_ref(), 1.0, Par::Seq);
    std::hint::black_box(&product);
    RESERVED.set(true);
    Ok(())
}

/// The right to take buffers: one thread after the other, each must see what those before have
/// taken. A process that was forked meanwhile does not wait for a thread of its parent.
struct Turn;

static HOLDER: AtomicU32 = AtomicU32::new(0);

impl Turn {
    fn take() -> Self {
        let me = process::id();
        let mut holder = 0;
        while let Err(other) =
            HOLDER.compare_exchange(holder, me, Ordering::Acquire, Ordering::Relaxed)
        {
            holder = if other == me { 0 } else { other };
            std::thread::yield_now();
        }
        Self
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        HOLDER.store(0, Ordering::Release);
    }
}

/// Bytes of the largest cache of the first processor; 0 where the system does not say.
fn last_level_cache() -> usize {
    static SIZE: OnceLock<usize> = OnceLock::new();
    *SIZE.get_or_init(|| {
        let folder = "/sys/devices/system/cpu/cpu0/cache";
        let size = |level: usize| {
            fs::read_to_string(format!("{folder}/index{level}/size")).ok().and_then(|s| bytes(&s))
        };
        (0..8).filter_map(size).max().unwrap_or(0)
    })
}

/// Number of bytes of a size as the system writes it (`32768K`).
fn bytes(text: &str) -> Option<usize> {
    let text = text.trim();
    let (number, unit) = match text.chars().last()? {
        'K' => (&text[..text.len() - 1], 1 << 10),
        'M' => (&text[..text.len() - 1], 1 << 20),
        _ => (text, 1),
    };
    number.parse::<usize>().ok().map(|n| n * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_with_their_unit() {
        assert_eq!(bytes("32768K\n"), Some(32 << 20));
        assert_eq!(bytes("260M"), Some(260 << 20));
        assert_eq!(bytes("512"), Some(512));
        assert_eq!(bytes(""), None);
    }
}
