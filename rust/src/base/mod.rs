//! Number types and small array algebra: everything the kernels are written in.
// SPDX-License-Identifier: BSD-3-Clause

pub mod allocator;
pub mod dual;
pub mod hyper;
pub mod jet;
pub mod memory;
pub mod pack;
pub mod pool;
pub mod real;
pub mod small;
pub mod thread_autotuner;

pub use dual::Dual;
pub use hyper::{Hyper, Smooth};
pub use pack::{Kernel, Lanes, MAX_LANES, dispatch};
pub use real::{Job, Real, shared, shared_dual};
