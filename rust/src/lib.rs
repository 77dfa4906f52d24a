//! Compute core of Corota: co-rotational planar finite elements.
//!
//! Modules go one way: base, elements and materials, kinematics, loads,
//! model, contact; `linear` stands beside them and `python` on top.
// SPDX-License-Identifier: BSD-3-Clause

pub mod base;
pub mod contact;
pub mod elements;
pub mod io;
pub mod kinematics;
pub mod linear;
pub mod loads;
pub mod materials;
pub mod model;
#[cfg(feature = "python")]
mod python;

// The contract tests are part of the unit tests: the core is compiled once for all of them.
#[cfg(test)]
extern crate self as corota;
#[cfg(test)]
#[path = "../tests/contracts/main.rs"]
mod contracts;
