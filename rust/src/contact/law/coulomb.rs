//! Coulomb's friction: what sticks has no slip, what slips has the traction of the bound against
//! it.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, State, TangentialEntry, TangentialLaw, maximum, minimum};

pub const ENTRY: TangentialEntry = ("coulomb", |coefficients| match coefficients {
    [mu] => Ok(Box::new(Coulomb(*mu))),
    _ => Err("friction has one coefficient".into()),
});

/// What slips goes on above this share of the bound: at the bound rounding would decide.
const GOES_ON: f64 = 1.0 - 1e-6;

/// Coefficient of friction.
pub struct Coulomb(f64);

impl TangentialLaw for Coulomb {
    fn slips(&self, at: &Constraint, shear: f64, pressure: f64, last: Option<State>) -> bool {
        let slipped = last == Some(State::Slipping);
        let bound = self.0 * pressure;
        let bound = if slipped { GOES_ON * bound } else { bound };
        // What turns round sticks first.
        shear.abs() > bound && (!slipped || shear * at.q >= 0.0)
    }

    fn error(&self, at: &Constraint) -> f64 {
        let bound = self.0 * maximum(at.p, 0.0);
        let trial = at.q - at.stiffness * at.distances()[1];
        let projected = minimum(maximum(trial, -bound), bound);
        (at.q - if at.seen() { projected } else { 0.0 }).abs()
    }

    fn follow(&self, direction: f64) -> f64 {
        self.0 * direction
    }
}
