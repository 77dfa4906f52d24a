// SPDX-License-Identifier: BSD-3-Clause
//! The allocator of the core: a reserve is given back where the system refuses memory.
//!
//! Rust ends a process with `SIGABRT` at the first allocation that fails, however small. Large
//! ones are judged before (`memory.rs`), but threads, heaps and libraries take what is left at any
//! time. So some addresses are kept aside, without memory behind them. The first allocation that
//! fails gives them back and succeeds; the next assembly or factorization sees that they are gone
//! and ends the run in order. Where even they do not suffice the process ends with exit code 5
//! and a message instead of a signal.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::ffi::c_int;
use std::io::Write;
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

/// Bytes kept aside.
const SIZE: usize = 16 << 20;
/// A larger request may fail: its caller has looked for the memory before, and handles the failure.
const LARGEST: usize = SIZE / 2;
/// Exit code of a shortage.
const CODE: c_int = 5;

static RESERVE: AtomicPtr<u8> = AtomicPtr::new(ptr::null_mut());

#[global_allocator]
static ALLOCATOR: WithReserve = WithReserve;

struct WithReserve;

unsafe extern "C" {
    fn _exit(code: c_int) -> !;
}

const fn layout() -> Layout {
    match Layout::from_size_align(SIZE, 16) {
        Ok(layout) => layout,
        Err(_) => panic!("the reserve has no layout"),
    }
}

/// Whether the reserve is there, or could be taken again.
pub fn keep_reserve() -> bool {
    if !RESERVE.load(Ordering::Relaxed).is_null() {
        return true;
    }
    // SAFETY: the layout has a size.
    let block = unsafe { System.alloc(layout()) };
    if block.is_null() {
        return false;
    }
    let none = ptr::null_mut();
    if RESERVE.compare_exchange(none, block, Ordering::AcqRel, Ordering::Relaxed).is_err() {
        // SAFETY: another thread was first; nobody has seen this block.
        unsafe { System.dealloc(block, layout()) };
    }
    true
}

/// Tries once more without the reserve.
#[cold]
fn again(size: usize, take: impl Fn() -> *mut u8) -> *mut u8 {
    if size > LARGEST {
        return ptr::null_mut();
    }
    let reserve = RESERVE.swap(ptr::null_mut(), Ordering::AcqRel);
    if !reserve.is_null() {
        // SAFETY: taken from `System` with this layout, and by the swap only this thread has it.
        unsafe { System.dealloc(reserve, layout()) };
    }
    // Another thread may have given the reserve back meanwhile.
    let block = take();
    if block.is_null() {
        let text = b"corota: error: not enough memory, not even to end in order; what was written \
            so far is kept\n";
        let _ = std::io::stderr().write_all(text);
        // SAFETY: ends the process.
        unsafe { _exit(CODE) }
    }
    block
}

// SAFETY: all blocks are those of `System`.
unsafe impl GlobalAlloc for WithReserve {
    #[inline]
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as required of the caller, here and below.
        let block = unsafe { System.alloc(layout) };
        if block.is_null() {
            return again(layout.size(), || unsafe { System.alloc(layout) });
        }
        block
    }

    #[inline]
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        let block = unsafe { System.alloc_zeroed(layout) };
        if block.is_null() {
            return again(layout.size(), || unsafe { System.alloc_zeroed(layout) });
        }
        block
    }

    #[inline]
    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let block = unsafe { System.realloc(old, layout, size) };
        if block.is_null() {
            return again(size, || unsafe { System.realloc(old, layout, size) });
        }
        block
    }

    #[inline]
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn the_reserve_is_given_back_and_taken_again() {
        assert!(keep_reserve());
        let tries = Cell::new(0);
        let block = again(8, || {
            tries.set(tries.get() + 1);
            ptr::dangling_mut()
        });
        assert_eq!((block.is_null(), tries.get()), (false, 1));
        assert!(again(SIZE, ptr::null_mut).is_null());
        assert!(keep_reserve());
    }
}
