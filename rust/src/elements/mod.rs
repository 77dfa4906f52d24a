//! Elements: one file each, facts and one function.
// SPDX-License-Identifier: BSD-3-Clause

pub mod element;
pub mod fibers;
pub mod line;
pub mod opt;
pub mod q4;
pub mod q4d;
pub mod q4di;
pub mod q4i;
pub mod q4r;
pub mod q4s;
pub mod q8;
pub mod q9;
pub mod ring;
pub mod shapes;
pub mod t3;
pub mod t6;

pub use element::{Drilling, Element, Full, Grad, Operator, Point, Sample};
pub use ring::{LocalRing, Revolved, Ring};
