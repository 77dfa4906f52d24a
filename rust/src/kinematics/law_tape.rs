//! Laws of an element, linear about its state: each is differentiated once at each point, by the
//! strain and the history there, and the kernels of elements then run on these derivatives alone.
//!
//! Forwards the derivatives of stress and new history follow those of the strain. Backwards, for
//! dofs that change by the weights of the forces, a kernel has the derivative of its strain along the
//! weights, which the law takes back to its inputs; the stress carries that by the strain. Forces
//! derive from the strain, so that theirs are then the gradient of the weighted sum of forces and new
//! histories by the dofs, and of internal modes the solution of their own adjoint equations. With these
//! as weights of the forces of the modes, the modes stay where they are on the way forwards.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::small::Mat;
use crate::base::{Dual, Real};
use crate::materials::PointState;

/// Derivatives that one evaluation of a law carries.
pub const WIDTH: usize = 4;
/// A number with them.
pub type Number = Dual<WIDTH, true>;
/// A number with its derivative along the weights of the forces.
pub type Along = Dual<1, true>;

/// Most components of a strain.
const STRAINS: usize = 4;
/// Difference of a tangent from the derivative, relative to the largest modulus, that is rounding.
const EXACT: f64 = 1e-12;

/// Which way derivatives go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Way {
    #[default]
    Forwards,
    Backwards,
}

/// What is known of the law at a point.
#[derive(Clone, Debug, Default)]
struct Linear {
    known: bool,
    stress: [f64; STRAINS],
    tangent: Mat<f64, STRAINS>,
    failed: bool,
    /// New history.
    new: Vec<f64>,
    /// Derivatives of stress and new history (rows) by strain and old history (columns).
    derivatives: Vec<f64>,
}

/// The laws at the points of an element.
#[derive(Clone, Debug, Default)]
pub struct LawTape {
    points: Vec<Linear>,
    members: usize,
    pub way: Way,
    /// Weights of the new history, point by point; empty for none.
    pub weights: Vec<f64>,
    /// Gradient by the old history, which the way backwards writes.
    pub gradient: Vec<f64>,
    /// Weights of the forces of the internal modes on the way forwards.
    pub modes: Vec<f64>,
    /// Derivatives of the sum of these forces by their weights.
    pub sum: [f64; WIDTH],
    /// Whether the tangents are the derivatives of the stress.
    pub exact: bool,
    old: Vec<f64>,
    new: Vec<f64>,
}

/// Largest derivative of a number that stores them.
pub fn largest_derivative<T: Real>(v: T) -> f64 {
    let mut places = [0.0; 1 + WIDTH];
    v.store(&mut places);
    places[1..=T::DERIVATIVES].iter().fold(0.0, |most, d| d.abs().max(most))
}

impl LawTape {
    /// For elements with laws at so many points, of so many members of history there.
    pub fn new(n_points: usize, members: usize, n_state: usize) -> Self {
        Self {
            points: vec![Linear::default(); n_points],
            members,
            gradient: vec![0.0; n_state],
            ..Self::default()
        }
    }

    /// Begin with another state.
    pub fn clear(&mut self) {
        self.points.iter_mut().for_each(|point| point.known = false);
        self.gradient.fill(0.0);
        self.exact = true;
    }

    /// Add forces of internal modes to their sum.
    pub fn take_forces<T: Real>(&mut self, forces: &[T]) {
        if self.way == Way::Backwards {
            return;
        }
        let mut places = [0.0; 1 + WIDTH];
        for (force, weight) in forces.iter().zip(&self.modes) {
            force.store(&mut places);
            for (sum, d) in self.sum.iter_mut().zip(&places[1..=T::DERIVATIVES]) {
                *sum += weight * d;
            }
        }
    }

    /// Differentiate the law of a point.
    fn record<const S: usize>(
        &mut self,
        p: usize,
        strain: [f64; S],
        state: &PointState<'_>,
        update: impl Fn([Number; S], &mut PointState<'_>) -> ([Number; S], Mat<Number, S>, bool),
    ) {
        const STRIDE: usize = 1 + WIDTH;
        let (members, all) = (self.members, S + self.members);
        let at = &mut self.points[p];
        at.derivatives.resize(all * all, 0.0);
        at.new.resize(members, 0.0);
        self.old.resize(members * STRIDE, 0.0);
        self.new.resize(members * STRIDE, 0.0);
        for first in (0..all).step_by(WIDTH) {
            let mut e = strain.map(Number::real);
            self.old.fill(0.0);
            for m in 0..members {
                self.old[m * STRIDE] = state.old[m * state.stride];
            }
            let count = WIDTH.min(all - first);
            for k in 0..count {
                let input = first + k;
                if input < S {
                    e[input].d[k] = 1.0;
                } else {
                    self.old[(input - S) * STRIDE + 1 + k] = 1.0;
                }
            }
            let mut state = PointState {
                old: &self.old,
                new: &mut self.new,
                stride: STRIDE,
                clock: state.clock,
            };
            let (stress, tangent, failed) = update(e, &mut state);
            for (row, s) in stress.iter().enumerate() {
                at.derivatives[row * all + first..][..count].copy_from_slice(&s.d[..count]);
            }
            for m in 0..members {
                let row = &self.new[m * STRIDE..][..STRIDE];
                let to = &mut at.derivatives[(S + m) * all + first..][..count];
                to.copy_from_slice(&row[1..=count]);
                at.new[m] = row[0];
            }
            for i in 0..S {
                at.stress[i] = stress[i].v;
                for j in 0..S {
                    at.tangent[i][j] = tangent[i][j].v;
                }
            }
            at.failed = failed;
        }
        let mut largest = 0.0f64;
        let mut off = 0.0f64;
        for i in 0..S {
            for j in 0..S {
                let d = at.derivatives[i * all + j];
                largest = largest.max(d.abs());
                off = off.max((d - at.tangent[i][j]).abs());
            }
        }
        self.exact &= off <= EXACT * largest;
        at.known = true;
    }

    /// Stress, tangent, and whether the law failed; its history goes to `state`. The stress acts on
    /// the volume `w`.
    pub fn answer<T: Real, const S: usize>(
        &mut self,
        p: usize,
        e: [T; S],
        w: T,
        state: &mut PointState<'_>,
        update: impl Fn([Number; S], &mut PointState<'_>) -> ([Number; S], Mat<Number, S>, bool),
    ) -> ([T; S], Mat<T, S>, T::Mask) {
        if !self.points[p].known {
            self.record(p, e.map(|v| v.lane(0)), state, update);
        }
        let (members, all, n) = (self.members, S + self.members, T::DERIVATIVES);
        let at = &self.points[p];
        let mut places = [0.0; 1 + WIDTH];
        let mut along = [[0.0; WIDTH]; S];
        for i in 0..S {
            e[i].store(&mut places);
            along[i][..n].copy_from_slice(&places[1..=n]);
        }
        let mut by = [[0.0; WIDTH]; S];
        if self.way == Way::Backwards {
            let own = self.weights.get(p * members..(p + 1) * members).unwrap_or(&[]);
            let volume = w.lane(0);
            for input in 0..all {
                let (mut stress, mut history) = (0.0, 0.0);
                for (row, d) in along.iter().enumerate() {
                    stress += at.derivatives[row * all + input] * d[0];
                }
                for (m, weight) in own.iter().enumerate() {
                    history += at.derivatives[(S + m) * all + input] * weight;
                }
                if input >= S {
                    self.gradient[p * members + input - S] = volume * stress + history;
                } else {
                    // What has no volume has no weight.
                    by[input][0] = stress + if volume > 0.0 { history / volume } else { 0.0 };
                }
            }
        } else {
            for (row, by) in by.iter_mut().enumerate() {
                for (input, d) in along.iter().enumerate() {
                    for k in 0..n {
                        by[k] += at.derivatives[row * all + input] * d[k];
                    }
                }
            }
        }
        for m in 0..members {
            let to = &mut state.new[m * state.stride..][..=n];
            to.fill(0.0);
            to[0] = at.new[m];
            if self.way == Way::Forwards {
                for (input, d) in along.iter().enumerate() {
                    for k in 0..n {
                        to[1 + k] += at.derivatives[(S + m) * all + input] * d[k];
                    }
                }
            }
        }
        let mut stress = [T::zero(); S];
        let mut tangent = [[T::zero(); S]; S];
        for i in 0..S {
            places[0] = at.stress[i];
            places[1..].copy_from_slice(&by[i]);
            stress[i] = T::load(&places);
            for j in 0..S {
                tangent[i][j] = T::real(at.tangent[i][j]);
            }
        }
        let failed = if at.failed { T::zero().lt(T::one()) } else { T::none() };
        (stress, tangent, failed)
    }
}
