//! What gaps, slips and tractions of a constraint owe each other: laws across and along surfaces.
//!
//! A law says which state a constraint asks for, how far it is from its conditions, and its row of
//! the linearized equations. Conditions across (none penetrates, or a pressure law) and along the
//! surfaces (free of friction, or Coulomb's) are chosen apart; a tie is a law of its own.
// SPDX-License-Identifier: BSD-3-Clause

pub mod coulomb;
pub mod exponential;
pub mod frictionless;
pub mod hard;
pub mod joined;
pub mod linear;
pub mod pressure;
pub mod tabular;

use joined::Joined;
use pressure::Curve;

/// Laws across the surfaces.
pub const NORMAL: &[NormalEntry] =
    &[hard::ENTRY, linear::ENTRY, exponential::ENTRY, tabular::ENTRY];
/// Laws along the surfaces.
pub const TANGENTIAL: &[TangentialEntry] = &[frictionless::ENTRY, coulomb::ENTRY];

/// Name of a law across the surfaces, and how it is made from pressures and overclosures.
pub type NormalEntry = (&'static str, fn(&[f64], &[f64]) -> Result<Box<dyn NormalLaw>, String>);
/// Name of a law along the surfaces, and how it is made from its coefficients.
pub type TangentialEntry = (&'static str, fn(&[f64]) -> Result<Box<dyn TangentialLaw>, String>);

/// Share of its full area below which a constraint sees nothing of the other side.
pub const COVERED: f64 = 1e-9;

/// State of a constraint: open, closed (and sticking), closed and slipping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    Open = 0,
    Closed = 1,
    Slipping = 2,
}

impl State {
    /// The state of that number.
    pub fn of(number: i8) -> Self {
        [Self::Open, Self::Closed, Self::Slipping][usize::from(number as u8).min(2)]
    }
}

/// A constraint at a state of the analysis.
#[derive(Clone, Copy, Debug)]
pub struct Constraint {
    /// Weighted gap and slip [length^3], and the area that is covered now [length^2].
    pub gap: f64,
    pub slip: f64,
    pub area: f64,
    /// Its whole area, and that of pressure laws, which stays the same within an increment.
    pub full: f64,
    pub fixed: f64,
    /// Pressure per gap by which gaps and pressures are compared [force/length^3].
    pub stiffness: f64,
    /// Weighted gap that the increment began with, where the pressure is a mean over it.
    pub begin: Option<f64>,
    /// Pressure and shear traction [force/length^2].
    pub p: f64,
    pub q: f64,
    /// Gaps and slips that are rounding [length].
    pub noise: f64,
    /// Whether it does not open: it was closed, and its surfaces do not separate.
    pub adheres: bool,
    /// Coefficient of friction.
    pub friction: f64,
}

impl Constraint {
    /// Whether anything of the other side is seen.
    pub fn seen(&self) -> bool {
        self.area > COVERED * self.full
    }

    /// Trial shear traction.
    pub fn shear(&self) -> f64 {
        let slip = if self.seen() { self.slip / self.area } else { 0.0 };
        self.q - self.stiffness * slip
    }

    /// A length without what of it is rounding.
    fn beyond(&self, length: f64) -> f64 {
        length.signum() * maximum(length.abs() - self.noise, 0.0)
    }

    /// Gap and slip [length] without what is rounding.
    pub fn distances(&self) -> [f64; 2] {
        let area = if self.seen() { self.area } else { self.full };
        [self.beyond(self.gap / area), self.beyond(self.slip / area)]
    }

    /// Diagonal of a row that leaves its traction alone, of the size of other rows.
    fn idle(&self) -> f64 {
        self.full / self.stiffness
    }
}

/// Two equations of a constraint, linearized; a closed one reads `-dG du + d dp = rhs`, an open
/// one `d dp = rhs` alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rows {
    /// Diagonal and right-hand side across.
    pub p: [f64; 2],
    /// The same along.
    pub q: [f64; 2],
    /// Shear traction where it slips: its change with the pressure, and that at no pressure.
    pub follow: f64,
    pub level: f64,
}

/// Conditions across the surfaces.
pub trait NormalLaw: Send + Sync {
    /// Gap [length] and trial pressure; without the other side infinitely open.
    fn trial(&self, at: &Constraint) -> (f64, f64);

    /// Trial pressure that is rounding.
    fn rounding(&self, at: &Constraint) -> f64;

    /// Whether the gap of a closed constraint is zero, so that its pressure alone says if it opens.
    fn closes(&self) -> bool;

    /// Pressure that bounds friction: the one that acts, or the trial one.
    fn bounding(&self, p: f64, push: f64) -> f64;

    /// Error of the condition as a pressure, where the other side is seen.
    fn error(&self, at: &Constraint) -> f64;

    /// Diagonal and right-hand side of a closed row.
    fn row(&self, at: &Constraint) -> [f64; 2];

    /// Pressure against overclosure, if that is what the law is.
    fn curve(&self) -> Option<&dyn Curve> {
        None
    }

    /// Pressure, slope and energy per area at a gap [length]; none where the law has not begun.
    fn pressure(&self, gap: f64) -> [f64; 3] {
        self.curve().filter(|c| -gap > c.start()).map_or([0.0; 3], |c| c.at(-gap))
    }

    /// Mean pressure between two gaps, whose work is the change of energy, and its slope by the
    /// last overclosure.
    fn mean(&self, _begin: f64, _end: f64) -> [f64; 2] {
        [0.0; 2]
    }

    /// Energy stored [force*length].
    fn energy(&self, _at: &Constraint) -> f64 {
        0.0
    }
}

/// Conditions along the surfaces.
pub trait TangentialLaw: Send + Sync {
    /// Whether a closed constraint slips under the trial shear traction `shear` and the pressure
    /// that bounds it; `last` is its state in the last correction.
    fn slips(&self, at: &Constraint, shear: f64, pressure: f64, last: Option<State>) -> bool;

    /// Error of the condition as a traction.
    fn error(&self, at: &Constraint) -> f64;

    /// Size of the shear traction of a slipping constraint, as a line: its slope by the pressure, and
    /// its value where that is zero.
    fn slipping(&self, at: &Constraint) -> [f64; 2];
}

/// The whole law of a constraint.
pub enum ContactLaw {
    /// Surfaces that may part and slide.
    Unilateral(Box<dyn NormalLaw>, Box<dyn TangentialLaw>),
    /// Surfaces that stay together.
    Joined,
}

impl ContactLaw {
    /// The law of those names.
    pub fn new(
        normal: &str,
        pressures: &[f64],
        overclosures: &[f64],
        tangential: &str,
        coefficients: &[f64],
    ) -> Result<Self, String> {
        let across = NORMAL.iter().find(|e| e.0 == normal);
        let along = TANGENTIAL.iter().find(|e| e.0 == tangential);
        match (across, along) {
            (Some(across), Some(along)) => {
                Ok(Self::Unilateral((across.1)(pressures, overclosures)?, (along.1)(coefficients)?))
            }
            _ => Err(format!("no contact law {normal:?} with {tangential:?}")),
        }
    }

    /// Gap [length] and trial pressure.
    pub fn trial(&self, at: &Constraint) -> (f64, f64) {
        match self {
            Self::Unilateral(normal, _) => normal.trial(at),
            Self::Joined => Joined.trial(at),
        }
    }

    /// State that gap, slip and tractions ask for.
    ///
    /// What was closed in the last correction has no linearized gap left: its pressure alone
    /// decides. The gap that is there is a rest of the nonlinearity, which in a slender body is
    /// worth many times the pressure.
    pub fn state(&self, at: &Constraint, last: Option<State>) -> State {
        let Self::Unilateral(normal, tangential) = self else { return Joined.state(at) };
        let (_, mut push) = normal.trial(at);
        let mut shear = at.shear();
        if normal.closes() && last.is_some_and(|s| s != State::Open) {
            if at.seen() {
                push = maximum(at.p, push);
            }
            if last == Some(State::Closed) {
                shear = at.q;
            }
        }
        if at.adheres && at.seen() {
            let slips = tangential.slips(at, shear, maximum(at.p, 0.0), last);
            return if slips { State::Slipping } else { State::Closed };
        }
        // What touches without pressure holds, or nothing would hold a body that just rests.
        if push.is_nan() || push <= -normal.rounding(at) {
            return State::Open;
        }
        let slips = tangential.slips(at, shear, normal.bounding(at.p, push), last);
        if slips { State::Slipping } else { State::Closed }
    }

    /// Error of the conditions as a force.
    pub fn residual(&self, at: &Constraint) -> f64 {
        let Self::Unilateral(normal, tangential) = self else { return Joined.residual(at) };
        let area = if at.seen() { at.area } else { at.full };
        let mut error = match at.seen() {
            true if at.adheres => (at.stiffness * at.distances()[0]).abs(),
            true => normal.error(at),
            false => at.p.abs(),
        };
        error += tangential.error(at);
        area * error
    }

    /// The equations of the constraint in a state; `direction` is the sign of the shear traction
    /// where it slips.
    pub fn rows(&self, at: &Constraint, state: State, direction: f64) -> Rows {
        let idle = at.idle();
        let across = if state == State::Open {
            [idle, -idle * at.p]
        } else {
            match self {
                Self::Unilateral(normal, _) => normal.row(at),
                Self::Joined => Joined.row(at),
            }
        };
        let along = if state == State::Closed { [0.0, at.slip] } else { [idle, 0.0] };
        let [follow, level] = match self {
            Self::Unilateral(_, law) if state == State::Slipping => {
                law.slipping(at).map(|part| direction * part)
            }
            _ => [0.0; 2],
        };
        Rows { p: across, q: along, follow, level }
    }

    /// Pressure, slope and energy per area of the law across at a gap [length].
    pub fn pressure(&self, gap: f64) -> [f64; 3] {
        match self {
            Self::Unilateral(normal, _) => normal.pressure(gap),
            Self::Joined => [0.0; 3],
        }
    }

    /// Mean pressure of the law across between two gaps [length], and its slope.
    pub fn mean(&self, begin: f64, end: f64) -> [f64; 2] {
        match self {
            Self::Unilateral(normal, _) => normal.mean(begin, end),
            Self::Joined => [0.0; 2],
        }
    }

    /// Pressure against overclosure, if the law across is one.
    pub fn curve(&self) -> Option<&dyn Curve> {
        match self {
            Self::Unilateral(normal, _) => normal.curve(),
            Self::Joined => None,
        }
    }

    /// Energy stored [force*length].
    pub fn energy(&self, at: &Constraint) -> f64 {
        match self {
            Self::Unilateral(normal, _) => normal.energy(at),
            Self::Joined => 0.0,
        }
    }
}

/// The larger of two, not a number if either is none.
pub fn maximum(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// The smaller of two, not a number if either is none.
pub fn minimum(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests;
