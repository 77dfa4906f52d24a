//! A tie: gap and slip are zero wherever the other side is seen.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, State};

pub struct Joined;

impl Joined {
    pub fn trial(&self, at: &Constraint) -> (f64, f64) {
        if !at.seen() {
            return (f64::INFINITY, f64::NEG_INFINITY);
        }
        let gap = at.gap / at.area;
        (gap, at.p - at.stiffness * gap)
    }

    pub fn state(&self, at: &Constraint) -> State {
        if at.seen() { State::Closed } else { State::Open }
    }

    pub fn residual(&self, at: &Constraint) -> f64 {
        let [gap, slip] = at.distances();
        if at.seen() {
            at.area * at.stiffness * gap.hypot(slip)
        } else {
            at.full * at.p.hypot(at.q)
        }
    }

    pub fn row(&self, at: &Constraint) -> [f64; 2] {
        [0.0, at.gap]
    }
}
