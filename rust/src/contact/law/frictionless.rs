//! No shear traction.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, State, TangentialEntry, TangentialLaw};

pub const ENTRY: TangentialEntry = ("frictionless", |_| Ok(Box::new(Frictionless)));

pub struct Frictionless;

impl TangentialLaw for Frictionless {
    fn slips(&self, _: &Constraint, _: f64, _: f64, _: Option<State>) -> bool {
        false
    }

    fn error(&self, _: &Constraint) -> f64 {
        0.0
    }

    fn slipping(&self, _: &Constraint) -> [f64; 2] {
        [0.0; 2]
    }
}
