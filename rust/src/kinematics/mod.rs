//! Kinematics, written once for every element: the co-rotational frame, the local strain, the
//! integration over the points with the condensation of internal modes.
// SPDX-License-Identifier: BSD-3-Clause

pub mod about_mean;
pub mod conserving;
pub mod corotation;
pub mod dilatation;
pub mod hencky;
pub mod hourglass;
pub mod inertia;
pub mod integrate;
pub mod kernels;
pub mod law_tape;
pub mod local_strain;
mod modes;
pub mod per_point;
