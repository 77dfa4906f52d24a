//! No penetration: gap and pressure are not negative, and one of them is zero.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, NormalEntry, NormalLaw, minimum};

pub const ENTRY: NormalEntry = ("hard", |_, _| Ok(Box::new(Hard)));

/// Karush, Kuhn and Tucker's conditions, as the semismooth equation `min(c gap, p) = 0`.
pub struct Hard;

impl NormalLaw for Hard {
    fn trial(&self, at: &Constraint) -> (f64, f64) {
        if !at.seen() {
            return (f64::INFINITY, f64::NEG_INFINITY);
        }
        let gap = at.gap / at.area;
        (gap, at.p - at.stiffness * gap)
    }

    fn rounding(&self, at: &Constraint) -> f64 {
        at.stiffness * at.noise
    }

    fn closes(&self) -> bool {
        true
    }

    fn bounding(&self, _: f64, push: f64) -> f64 {
        push
    }

    fn error(&self, at: &Constraint) -> f64 {
        minimum(at.stiffness * at.distances()[0], at.p).abs()
    }

    fn row(&self, at: &Constraint) -> [f64; 2] {
        [0.0, at.gap]
    }
}
