//! Pressure as a function of the overclosure, whatever the function.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, NormalLaw, maximum, minimum};

/// Relative changes of overclosure below which a mean is a quadrature.
const NEAR: f64 = 1e-4;

/// Pressure against overclosure.
pub trait Curve: Send + Sync {
    /// Overclosure at which the pressure begins [length]; negative before contact.
    fn start(&self) -> f64;

    /// Pressure, slope and energy per area at an overclosure above the start.
    fn at(&self, overclosure: f64) -> [f64; 3];
}

/// Conditions of a pressure law: the pressure is that of the gap.
///
/// In the scheme of rate conditions it is the mean over the increment whose product with the
/// change of the gap is the change of energy.
pub struct Overclosure<C>(pub C);

impl<C: Curve> Overclosure<C> {
    /// Pressure of the increment that ends with a gap, and its slope by overclosure.
    fn now(&self, at: &Constraint, gap: f64) -> [f64; 2] {
        if let Some(begin) = at.begin {
            return self.mean(begin / at.fixed, gap);
        }
        let [p, slope, _] = self.pressure(gap);
        [p, slope]
    }
}

impl<C: Curve> NormalLaw for Overclosure<C> {
    /// The areas of the law are those of the increment's start: its tangent is exact.
    fn trial(&self, at: &Constraint) -> (f64, f64) {
        if !at.seen() {
            return (f64::INFINITY, f64::NEG_INFINITY);
        }
        let gap = at.gap / at.fixed;
        // A mean over the increment acts if either end does.
        let least = at.begin.map_or(gap, |begin| minimum(gap, begin / at.fixed));
        (gap, -least - self.0.start())
    }

    fn rounding(&self, at: &Constraint) -> f64 {
        at.noise
    }

    fn closes(&self) -> bool {
        false
    }

    fn bounding(&self, p: f64, _: f64) -> f64 {
        p
    }

    fn error(&self, at: &Constraint) -> f64 {
        (at.p - self.now(at, at.gap / at.fixed)[0]).abs()
    }

    fn row(&self, at: &Constraint) -> [f64; 2] {
        let [value, slope] = if at.begin.is_none() {
            let [p, slope, _] = self.0.at(maximum(-at.gap / at.fixed, self.0.start()));
            [p, slope]
        } else {
            self.now(at, at.gap / at.fixed)
        };
        let weight = at.fixed / if slope > 0.0 { slope } else { at.stiffness };
        [-weight, weight * (at.p - value)]
    }

    fn curve(&self) -> Option<&dyn Curve> {
        Some(&self.0)
    }

    fn mean(&self, begin: f64, end: f64) -> [f64; 2] {
        let [p0, _, w0] = self.pressure(begin);
        let [p1, slope1, w1] = self.pressure(end);
        let way = begin - end;
        if way.abs() <= NEAR * maximum(begin.abs(), end.abs()) {
            let [p, slope, _] = self.pressure(0.5 * (begin + end));
            return [(p0 + 4.0 * p + p1) / 6.0, (slope1 + 2.0 * slope) / 6.0];
        }
        let mean = (w1 - w0) / way;
        [mean, (p1 - mean) / way]
    }

    fn energy(&self, at: &Constraint) -> f64 {
        if at.seen() { self.pressure(at.gap / at.fixed)[2] * at.fixed } else { 0.0 }
    }
}
