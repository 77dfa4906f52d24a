//! Loads on edges and volumes.
// SPDX-License-Identifier: BSD-3-Clause

pub mod body;
pub mod edge;
