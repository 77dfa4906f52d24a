//! Where chunks of elements add their forces and stiffnesses.
//!
//! One of the places with `unsafe` code: several threads add to the same arrays. It is
//! sound because chunks that run at the same time share no node (they have the same color),
//! so they never touch the same entry; the order of the colors is fixed, so sums do not
//! depend on the number of threads.
// SPDX-License-Identifier: BSD-3-Clause
#![allow(unsafe_code)]

use std::marker::PhantomData;

/// A shared array to which threads add at places that no other thread touches meanwhile.
#[derive(Clone, Copy)]
pub struct Shared<'a> {
    data: *mut f64,
    len: usize,
    owner: PhantomData<&'a mut [f64]>,
}

// SAFETY: see the head of this file; the coloring keeps concurrent writes apart.
unsafe impl Send for Shared<'_> {}
// SAFETY: as above.
unsafe impl Sync for Shared<'_> {}

impl<'a> Shared<'a> {
    pub fn new(slice: &'a mut [f64]) -> Self {
        Self { data: slice.as_mut_ptr(), len: slice.len(), owner: PhantomData }
    }

    #[inline(always)]
    pub fn add(&self, i: usize, value: f64) {
        assert!(i < self.len);
        // SAFETY: in bounds by the assertion; not aliased by the coloring.
        unsafe { *self.data.add(i) += value }
    }

    /// Add a run of values.
    #[inline(always)]
    pub fn add_run<const K: usize>(&self, i: usize, values: &[f64; K]) {
        assert!(i + K <= self.len);
        for (k, v) in values.iter().enumerate() {
            // SAFETY: in bounds by the assertion; not aliased by the coloring.
            unsafe { *self.data.add(i + k) += v }
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// The arrays of one assembly; `values` is empty when no stiffness is wanted.
#[derive(Clone, Copy)]
pub struct Sink<'a> {
    pub force: Shared<'a>,
    /// Sum of the absolute element forces, the scale of the residual.
    pub scale: Shared<'a>,
    pub values: Shared<'a>,
}

impl<'a> Sink<'a> {
    pub fn new(force: &'a mut [f64], scale: &'a mut [f64], values: &'a mut [f64]) -> Self {
        Self { force: Shared::new(force), scale: Shared::new(scale), values: Shared::new(values) }
    }
}
