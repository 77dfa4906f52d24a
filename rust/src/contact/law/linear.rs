//! A stiffness: the pressure grows with the overclosure from zero.
// SPDX-License-Identifier: BSD-3-Clause

use super::NormalEntry;
use super::pressure::{Curve, Overclosure};

pub const ENTRY: NormalEntry = ("linear", |pressure, _| match pressure {
    [k, ..] => Ok(Box::new(Overclosure(Linear(*k)))),
    [] => Err("a linear law needs its stiffness".into()),
});

/// Stiffness [force/length^3].
pub struct Linear(f64);

impl Curve for Linear {
    fn start(&self) -> f64 {
        0.0
    }

    fn at(&self, w: f64) -> [f64; 3] {
        let k = self.0;
        [k * w, k, 0.5 * k * w * w]
    }
}
