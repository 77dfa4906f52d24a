//! A material whose answer comes from outside: stress and tangent at given strains, linear
//! between. Parameters: the elastic moduli, 9 numbers by rows.
//!
//! The state holds what was given: strain (3), stress (3), tangent 11, 12, 13, 22, 23, 33,
//! thickness strain and stress, energy density, equivalent plastic strain.
// SPDX-License-Identifier: BSD-3-Clause

use super::material::{Material, Plane, PointState, Response};
use crate::base::Real;
use crate::base::small::Mat;

#[derive(Clone, Debug)]
pub struct Tabulated {
    moduli: Mat<f64, 3>,
}

/// Members of the state.
pub const MEMBERS: usize = 16;
const STRESS: usize = 3;
const TANGENT: usize = 6;
const NORMAL: usize = 12;
const ENERGY: usize = 14;
const PLASTIC: usize = 15;

impl Material for Tabulated {
    const NAME: &'static str = "given";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[1100.0, 330.0, 0.0, 330.0, 1100.0, 0.0, 0.0, 0.0, 385.0],
        &[9.0, 2.0, 0.5, 2.0, 6.0, -0.4, 0.5, -0.4, 3.0],
    ];

    fn new(parameters: &[f64], _: Plane) -> Result<Self, String> {
        let &[a, b, c, d, e, f, g, h, i] = parameters else {
            return Err(format!("given takes 9 moduli, not {} numbers", parameters.len()));
        };
        Ok(Self { moduli: [[a, b, c], [d, e, f], [g, h, i]] })
    }
    fn n_state(&self) -> usize {
        MEMBERS
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T> {
        for m in 0..MEMBERS {
            let v: T = state.get(m);
            state.set(m, v);
        }
        let mut tangent = [[T::zero(); 3]; 3];
        let mut member = TANGENT;
        for i in 0..3 {
            for j in i..3 {
                tangent[i][j] = state.get(member);
                tangent[j][i] = tangent[i][j];
                member += 1;
            }
        }
        let mut stress = [T::zero(); 3];
        for i in 0..3 {
            stress[i] = state.get(STRESS + i);
            for j in 0..3 {
                let at: T = state.get(j);
                stress[i] = tangent[i][j].fma(strain[j] - at, stress[i]);
            }
        }
        Response { stress, tangent, failed: T::none() }
    }
    fn out_of_plane(&self, _: [f64; 3], _: [f64; 3], state: &[f64]) -> (f64, f64) {
        (state[NORMAL], state[NORMAL + 1])
    }
    fn energy(&self, _: [f64; 3], _: [f64; 3], state: &[f64]) -> f64 {
        state[ENERGY]
    }
    fn outputs(&self) -> &'static [&'static str] {
        &["PEEQ"]
    }
    fn output(&self, _: usize, _: [f64; 3], state: &[f64]) -> f64 {
        state[PLASTIC]
    }
}
