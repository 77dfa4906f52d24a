//! The law over the constraints of a pair, as arrays; and the forces that tractions give.
// SPDX-License-Identifier: BSD-3-Clause

use super::law::{Constraint, ContactLaw, Rows, State};
use super::terms::WIDTH;

/// The constraints of a pair at a state, a number each: see [`Constraint`].
pub struct Constraints<'a> {
    pub gap: &'a [f64],
    pub slip: &'a [f64],
    pub area: &'a [f64],
    pub full: &'a [f64],
    pub fixed: &'a [f64],
    pub stiffness: &'a [f64],
    pub begin: Option<&'a [f64]>,
    pub adheres: Option<&'a [bool]>,
    pub friction: Option<&'a [f64]>,
    pub noise: f64,
}

impl Constraints<'_> {
    pub fn len(&self) -> usize {
        self.gap.len()
    }

    pub fn is_empty(&self) -> bool {
        self.gap.is_empty()
    }

    /// One of them under its tractions.
    pub fn at(&self, i: usize, p: f64, q: f64) -> Constraint {
        Constraint {
            gap: self.gap[i],
            slip: self.slip[i],
            area: self.area[i],
            full: self.full[i],
            fixed: self.fixed[i],
            stiffness: self.stiffness[i],
            begin: self.begin.map(|b| b[i]),
            p,
            q,
            noise: self.noise,
            adheres: self.adheres.is_some_and(|a| a[i]),
            friction: self.friction.map_or(0.0, |f| f[i]),
        }
    }

    fn each<'b>(
        &'b self,
        p: &'b [f64],
        q: &'b [f64],
    ) -> impl Iterator<Item = (usize, Constraint)> + 'b {
        (0..self.len()).map(move |i| (i, self.at(i, p[i], q[i])))
    }

    /// State that each asks for.
    pub fn states(&self, law: &ContactLaw, p: &[f64], q: &[f64], last: Option<&[i8]>) -> Vec<i8> {
        let state = |(i, at): (usize, Constraint)| {
            law.state(&at, last.map(|states| State::of(states[i]))) as i8
        };
        self.each(p, q).map(state).collect()
    }

    /// Error of the conditions of each, as a force.
    pub fn residual(&self, law: &ContactLaw, p: &[f64], q: &[f64]) -> Vec<f64> {
        self.each(p, q).map(|(_, at)| law.residual(&at)).collect()
    }

    /// The equations of each in its state.
    pub fn rows(
        &self,
        law: &ContactLaw,
        p: &[f64],
        q: &[f64],
        states: &[i8],
        directions: &[f64],
    ) -> Vec<Rows> {
        let rows =
            |(i, at): (usize, Constraint)| law.rows(&at, State::of(states[i]), directions[i]);
        self.each(p, q).map(rows).collect()
    }
}

/// Gradients of gaps and slips by the dofs of the equations: rows of [`WIDTH`], -1 for no dof.
pub struct Gradients<'a> {
    pub constraint: &'a [i64],
    pub dofs: &'a [[i64; WIDTH]],
    pub gap: &'a [[f64; WIDTH]],
    pub slip: &'a [[f64; WIDTH]],
}

impl Gradients<'_> {
    /// Adds the forces of pressures and, where there are any, shear tractions by constraint, and
    /// the sizes of their parts.
    pub fn add_forces(
        &self,
        p: &[f64],
        q: Option<&[f64]>,
        force: &mut [f64],
        mut size: Option<&mut [f64]>,
    ) {
        for (t, &k) in self.constraint.iter().enumerate() {
            let k = k as usize;
            for (c, &dof) in self.dofs[t].iter().enumerate() {
                let Ok(dof) = usize::try_from(dof) else { continue };
                let mut part = p[k] * self.gap[t][c];
                if let Some(q) = q {
                    part += q[k] * self.slip[t][c];
                }
                force[dof] += part;
                if let Some(size) = &mut size {
                    size[dof] += part.abs();
                }
            }
        }
    }
}
