//! Contact and ties between boundaries: gap and slip as functions of the nodal positions.
//!
//! Pressures act along the gradients of gaps, and tangents are their Hessians, so force and
//! counterforce, moment balance and the symmetry of the frictionless tangent hold by construction.
//! Shear tractions act along the relative tangential velocity (`slip`), with its exact derivative;
//! the slip of an increment is a path along both surfaces (`travel`).
// SPDX-License-Identifier: BSD-3-Clause

pub mod active_set;
pub mod boundary;
pub mod chains;
pub mod complementarity;
pub mod corners;
pub mod crossing;
pub mod curve;
pub mod discrete_gradient;
pub mod discretization;
pub mod law;
pub mod master;
pub mod pair;
pub mod rounds;
pub mod search;
pub mod sides;
pub mod slave;
pub mod slip;
pub mod terms;
pub mod travel;
pub mod tree;
pub mod unilateral;

pub use curve::{Edge, Shape};
pub use law::ContactLaw;
pub use master::{Rigid, Surface};
pub use pair::Contact;
pub use sides::Distances;
pub use slave::Slave;
pub use terms::Terms;
