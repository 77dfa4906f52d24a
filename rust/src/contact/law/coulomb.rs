//! Coulomb's friction: what sticks has no slip, what slips has the traction of the bound against
//! it. The bound is the coefficient times the pressure, up to a largest traction.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, State, TangentialEntry, TangentialLaw, maximum, minimum};

pub const ENTRY: TangentialEntry = ("coulomb", |coefficients| match coefficients {
    [] => Ok(Box::new(Coulomb { most: f64::INFINITY })),
    [most] => Ok(Box::new(Coulomb { most: *most })),
    _ => Err("friction has a largest traction; its coefficient is one of the constraints".into()),
});

/// What slips goes on above this share of the bound: at the bound rounding would decide.
const GOES_ON: f64 = 1.0 - 1e-6;

/// The largest shear traction; each constraint has its own coefficient.
pub struct Coulomb {
    most: f64,
}

impl Coulomb {
    fn bound(&self, at: &Constraint, pressure: f64) -> f64 {
        minimum(at.friction * pressure, self.most)
    }
}

impl TangentialLaw for Coulomb {
    fn slips(&self, at: &Constraint, shear: f64, pressure: f64, last: Option<State>) -> bool {
        let slipped = last == Some(State::Slipping);
        // What touches, with a gap that is rounding, has no pressure yet and sticks; what adheres
        // is pulled.
        let bound = self.bound(at, if at.adheres { pressure } else { maximum(pressure, 0.0) });
        let bound = if slipped { GOES_ON * bound } else { bound };
        // What turns round sticks first.
        shear.abs() > bound && (!slipped || shear * at.q >= 0.0)
    }

    fn error(&self, at: &Constraint) -> f64 {
        let bound = self.bound(at, maximum(at.p, 0.0));
        let trial = at.q - at.stiffness * at.distances()[1];
        let projected = minimum(maximum(trial, -bound), bound);
        (at.q - if at.seen() { projected } else { 0.0 }).abs()
    }

    fn slipping(&self, at: &Constraint) -> [f64; 2] {
        if at.adheres && at.p < 0.0 {
            [0.0; 2]
        } else if at.friction * at.p > self.most {
            [0.0, self.most]
        } else {
            [at.friction, 0.0]
        }
    }
}
