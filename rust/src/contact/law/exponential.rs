//! An exponential law that begins before contact.
//!
//! With the clearance c and the pressure p0 at zero overclosure, `p = p0 / (e - 1) s (exp(s) - 1)`
//! with `s = w / c + 1` (Abaqus manual, *SURFACE BEHAVIOR).
// SPDX-License-Identifier: BSD-3-Clause

use super::NormalEntry;
use super::pressure::{Curve, Overclosure};
use std::f64::consts::E;

pub const ENTRY: NormalEntry =
    ("exponential", |pressure, overclosure| match (pressure, overclosure) {
        ([p0, ..], [c, ..]) => Ok(Box::new(Overclosure(Exponential { c: *c, p0: p0 / (E - 1.0) }))),
        _ => Err("an exponential law needs a pressure and a clearance".into()),
    });

/// Beyond this argument it goes straight on: the exponential of a bad iterate must not overflow.
const STRAIGHT: f64 = 30.0;

pub struct Exponential {
    c: f64,
    p0: f64,
}

impl Curve for Exponential {
    fn start(&self) -> f64 {
        -self.c
    }

    fn at(&self, w: f64) -> [f64; 3] {
        let Self { c, p0 } = *self;
        let s = w / c + 1.0;
        let near = s.min(STRAIGHT);
        let (e, over) = (near.exp(), s - near);
        let slope = p0 / c * (e - 1.0 + near * e);
        let at = p0 * near * (e - 1.0);
        let energy = p0 * c * (near * e - e + 1.0 - 0.5 * near * near);
        let beyond = c * over;
        [at + slope * c * over, slope, energy + at * c * over + 0.5 * slope * (beyond * beyond)]
    }
}
