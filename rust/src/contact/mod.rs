//! Contact and ties between boundaries: gap and slip as functions of the nodal positions.
//!
//! Everything that Newton's method needs follows from these functions: forces are their
//! gradients and tangents their Hessians, so force and counterforce, moment balance and the
//! symmetry of the frictionless tangent hold by construction.
// SPDX-License-Identifier: BSD-3-Clause

pub mod active_set;
pub mod chains;
pub mod corners;
pub mod curve;
pub mod discretization;
pub mod law;
pub mod master;
pub mod pair;
pub mod search;
pub mod sides;
pub mod slave;
pub mod terms;
pub mod tree;

pub use curve::{Edge, Shape};
pub use law::ContactLaw;
pub use master::{Rigid, Surface};
pub use pair::Contact;
pub use sides::Distances;
pub use slave::Slave;
pub use terms::Terms;
