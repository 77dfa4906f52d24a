//! Functions with the C interface of this program, such as those that `numba` compiles: some points
//! at a time.
//!
//! `int f(int64_t n, int64_t plane, const double *properties, const double *time, const double
//! *strain, const double *old, double *new, double *stress, double *tangent, double *extra)` with
//! plane 0 (stress) or 1 (strain), time (increment, total at its end), strain `[n, 3]` (xx, yy,
//! xy, engineering shear), histories `[n, members]`, stress `[n, 3]`, tangent `[n, 3, 3]`, extra `[n,
//! 5]`: strain and stress through the thickness, energy, dissipated work, equivalent plastic strain;
//! all zero at the start. It returns 0, or another number where it has no answer.
//!
//! Parameters: handle of the function, members of the history, properties.
// SPDX-License-Identifier: BSD-3-Clause
#![allow(unsafe_code)]

use super::external::{Convention, External, Points, address};
use super::material::Plane;
use crate::base::MAX_LANES;

/// Numbers of a point in `extra`.
const EXTRA: usize = 5;

type Function = unsafe extern "C" fn(
    i64,
    i64,
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    *mut f64,
    *mut f64,
    *mut f64,
    *mut f64,
) -> i32;

pub type CFunction = External<Call>;

#[derive(Clone, Debug)]
pub struct Call {
    function: Function,
    plane: Plane,
    members: usize,
    properties: Vec<f64>,
}

impl Convention for Call {
    const NAME: &'static str = "c_function";
    const EXAMPLES: &'static [&'static [f64]] =
        &[&[0.0, 1.0, 1000.0, 300.0], &[0.0, 1.0, 9.0, 2.0]];
    const GIVES_PLASTIC: bool = true;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[handle, members, ref properties @ ..] = parameters else {
            return Err("c_function takes a handle and a number of members".into());
        };
        let function: Function = if handle == 0.0 {
            sample
        } else {
            // SAFETY: who registered the address says that a function with this interface lies there.
            unsafe { std::mem::transmute::<usize, Function>(address(Self::NAME, handle)?) }
        };
        Ok(Self { function, plane, members: members as usize, properties: properties.to_vec() })
    }
    fn members(&self) -> usize {
        self.members
    }
    fn call(&self, points: &mut Points<'_>) {
        let n = points.count;
        let mut strain = [[0.0; 3]; MAX_LANES];
        for (to, [x, y, xy, _]) in strain.iter_mut().zip(points.strain) {
            *to = [x, y, xy];
        }
        let mut stress = [[0.0; 3]; MAX_LANES];
        let mut tangent = [[[0.0; 3]; 3]; MAX_LANES];
        let mut extra = [[0.0; EXTRA]; MAX_LANES];
        let time = [points.clock.increment, points.clock.end];
        // SAFETY: the arrays have the lengths that the interface names.
        let code = unsafe {
            (self.function)(
                n as i64,
                i64::from(self.plane == Plane::Strain),
                self.properties.as_ptr(),
                time.as_ptr(),
                strain.as_ptr().cast(),
                points.old.as_ptr(),
                points.new.as_mut_ptr(),
                stress.as_mut_ptr().cast(),
                tangent.as_mut_ptr().cast(),
                extra.as_mut_ptr().cast(),
            )
        };
        for l in 0..n {
            let answer = &mut points.answers[l];
            let [normal, zz, energy, dissipated, plastic] = extra[l];
            let [x, y, xy] = stress[l];
            answer.stress = [x, y, xy, zz];
            for i in 0..3 {
                answer.tangent[i][..3].copy_from_slice(&tangent[l][i]);
            }
            (answer.normal, answer.plastic) = (normal, plastic);
            answer.energies = [energy, dissipated];
            // A ring needs a strain through the thickness.
            answer.failed = code != 0 || points.solid;
        }
    }
}

/// The function of the handle 0, for tests: linear elasticity of two moduli that counts its calls in
/// the first member.
#[allow(clippy::too_many_arguments)]
unsafe extern "C" fn sample(
    n: i64,
    _plane: i64,
    properties: *const f64,
    _time: *const f64,
    strain: *const f64,
    old: *const f64,
    new: *mut f64,
    stress: *mut f64,
    tangent: *mut f64,
    extra: *mut f64,
) -> i32 {
    let n = n as usize;
    // SAFETY: the caller keeps to the interface.
    let (properties, strain, old, new, stress, tangent, extra) = unsafe {
        (
            std::slice::from_raw_parts(properties, 2),
            std::slice::from_raw_parts(strain, 3 * n),
            std::slice::from_raw_parts(old, n),
            std::slice::from_raw_parts_mut(new, n),
            std::slice::from_raw_parts_mut(stress, 3 * n),
            std::slice::from_raw_parts_mut(tangent, 9 * n),
            std::slice::from_raw_parts_mut(extra, EXTRA * n),
        )
    };
    let [a, b] = [properties[0], properties[1]];
    let d = [[a, b, 0.0], [b, a, 0.0], [0.0, 0.0, 0.5 * (a - b)]];
    for p in 0..n {
        for i in 0..3 {
            stress[3 * p + i] = (0..3).map(|j| d[i][j] * strain[3 * p + j]).sum();
            extra[EXTRA * p + 2] += 0.5 * stress[3 * p + i] * strain[3 * p + i];
            tangent[9 * p + 3 * i..9 * p + 3 * i + 3].copy_from_slice(&d[i]);
        }
        new[p] = old[p] + 1.0;
    }
    0
}
