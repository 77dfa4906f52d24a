//! Contact and ties between boundaries: gap and slip as functions of the nodal positions.
//!
//! Everything that Newton's method needs follows from these functions: forces are their
//! gradients and tangents their Hessians, so force and counterforce, moment balance and the
//! symmetry of the frictionless tangent hold by construction.
// SPDX-License-Identifier: BSD-3-Clause

pub mod curve;
pub mod master;
pub mod mortar;
pub mod node;
pub mod pair;
pub mod search;
pub mod slave;
pub mod terms;
pub mod tie;
pub mod tree;

pub use curve::{Edge, Shape};
pub use master::{Rigid, Surface};
pub use pair::{Contact, Kind, Method};
pub use slave::Slave;
pub use terms::Terms;
