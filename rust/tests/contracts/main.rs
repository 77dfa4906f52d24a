//! Contracts that every registered element, material and edge load keeps.
// SPDX-License-Identifier: BSD-3-Clause

mod common;
mod edges;
mod inverted;
mod laws;
mod linear_field;
mod motion;
mod shape;
mod tangent;
mod vectors;
mod zero_modes;
