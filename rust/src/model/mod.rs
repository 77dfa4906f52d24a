//! The discrete model: dofs, sparsity pattern, chunks of elements, assembly and recovery.
// SPDX-License-Identifier: BSD-3-Clause

pub mod assembly;
pub mod build;
pub mod chunk;
pub mod chunk_of;
pub mod dofs;
pub mod dynamics;
pub mod fixed_dofs;
pub mod locality;
pub mod problem;
pub mod recover;
pub mod registry;
pub mod scatter;
pub mod sensitivity;
pub mod sizes;

pub use build::BlockInput;
pub use problem::Problem;

#[cfg(test)]
mod lanes_test;
#[cfg(test)]
mod threads_test;
