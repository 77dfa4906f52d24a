//! Abaqus user subroutines UMAT, point by point: `NDI` 2 in plane stress and 3 else, `NSHR` 1.
//!
//! `STRESS` is Cauchy stress and `STRAN` logarithmic strain, in the frame of the element, which turns
//! with the body: `DROT` is the unit matrix, and `DFGRD0` and `DFGRD1` are stretches without
//! rotation. Volume times `STRESS` is taken as the stress that works with the logarithmic strain,
//! exact where both have the same axes. In plane stress the strain through the thickness follows
//! from a Poisson's ratio, as that of Abaqus's sections does.
//!
//! `DDSDDE` (by columns) is the derivative of `STRESS` by the strain increment of subroutines in
//! terms of the strain; the growth of the volume, whose part in the tangent is not symmetric, is left
//! out there. Of those in terms of the deformation gradient `DDSDDE` is that of the Kirchhoff
//! stress in the rate of Jaumann over the volume.
//!
//! Parameters: handle of the function, members of `STATEV`, 1 for subroutines in terms of the
//! gradient or 0, Poisson's ratio, characters of `CMNAME` and their codes, `PROPS`.
// SPDX-License-Identifier: BSD-3-Clause
#![allow(unsafe_code)]

use super::external::{Answer, Convention, External, Points, address};
use super::material::Plane;
use crate::base::small::Mat;
use std::ffi::c_int;

/// Length of `CMNAME`.
const NAME_LENGTH: usize = 80;
/// `PNEWDT` at the start; below 1 the subroutine requests a shorter increment.
const NEW_TIME: f64 = 1e36;

#[rustfmt::skip]
type Function = unsafe extern "C" fn(
    *mut f64, *mut f64, *mut f64, *mut f64, *mut f64, *mut f64, *mut f64, *mut f64, *mut f64, *mut f64,
    *const f64, *const f64, *const f64, *const f64, *const f64, *const f64, *const f64, *const f64,
    *const u8, *const c_int, *const c_int, *const c_int, *const c_int, *const f64, *const c_int,
    *const f64, *const f64, *mut f64, *const f64, *const f64, *const f64,
    *const c_int, *const c_int, *const c_int, *const c_int, *const c_int, *const c_int, usize,
);

pub type Umat = External<Subroutine>;

#[derive(Clone, Debug)]
pub struct Subroutine {
    function: Function,
    plane: Plane,
    members: usize,
    by_gradient: bool,
    /// Thickness strain over the sum of the strains in the plane.
    contraction: f64,
    finite: bool,
    name: [u8; NAME_LENGTH],
    properties: Vec<f64>,
}

/// The stretch of a logarithmic strain xx, yy, xy, zz; symmetric.
fn stretch([x, y, xy, z]: [f64; 4], finite: bool) -> [f64; 9] {
    let (m, d, s) = (0.5 * (x + y), 0.5 * (x - y), 0.5 * xy);
    if !finite {
        return [1.0 + x, s, 0.0, s, 1.0 + y, 0.0, 0.0, 0.0, 1.0 + z];
    }
    let r = d.hypot(s);
    let (c, k) = (r.cosh() * m.exp(), if r > 1e-8 { r.sinh() / r } else { 1.0 } * m.exp());
    [c + k * d, k * s, 0.0, k * s, c - k * d, 0.0, 0.0, 0.0, z.exp()]
}

/// Derivative of the Kirchhoff stress by the logarithmic strain, from that in the rate of Jaumann,
/// where stress and strain have the same axes; rows xx, yy, xy, zz.
///
/// In these axes, with `x` the difference of the logarithmic strains, the rate of deformation has
/// `sinh x / x` and the spin `(cosh x - 1) / x` of the rate of the shear strain.
fn logarithmic(c: &Mat<f64, 4>, strain: &[f64; 4], stress: &[f64; 4]) -> Mat<f64, 4> {
    let (d, s) = (0.5 * (strain[0] - strain[1]), 0.5 * strain[2]);
    let x = 2.0 * d.hypot(s);
    if x < 1e-8 {
        return *c;
    }
    let (cos, sin) = (2.0 * d / x, 2.0 * s / x);
    // Rows: the shear strain in the axes of the strain, its rate; engineering shear.
    let shear = [-sin, sin, cos, 0.0];
    let more = x.sinh() / x - 1.0;
    let difference = (stress[0] - stress[1]) * cos + 2.0 * stress[2] * sin;
    let spin = -0.5 * difference * (x.cosh() - 1.0) / x;
    // Strains of a unit shear in these axes, and stresses of one.
    let unit = [-0.5 * sin, 0.5 * sin, cos, 0.0];
    let turned = [-sin, sin, cos, 0.0];
    let mut out = *c;
    for i in 0..4 {
        let along: f64 = (0..4).map(|k| c[i][k] * unit[k]).sum();
        for j in 0..4 {
            out[i][j] += (more * along + spin * turned[i]) * shear[j];
        }
    }
    out
}

impl Subroutine {
    fn one(&self, points: &mut Points<'_>, l: usize) -> Answer {
        let flat = self.plane == Plane::Stress && !points.solid;
        // Places of the components in our rows xx, yy, xy, zz.
        let rows: &[usize] = if flat { &[0, 1, 2] } else { &[0, 1, 3, 2] };
        let n = rows.len();
        let whole = |mut e: [f64; 4]| {
            if flat {
                e[3] = self.contraction * (e[0] + e[1]);
            }
            e
        };
        let (before, after) = (whole(points.old_strain[l]), whole(points.strain[l]));
        let volume = |e: &[f64; 4]| if self.finite { (e[0] + e[1] + e[3]).exp() } else { 1.0 };
        let (v0, v1) = (volume(&before), volume(&after));
        let (mut stress, mut strain, mut added) = ([0.0; 4], [0.0; 4], [0.0; 4]);
        for (k, &row) in rows.iter().enumerate() {
            stress[k] = points.old_stress[l][row] / v0;
            strain[k] = before[row];
            added[k] = after[row] - before[row];
        }
        let own = l * self.members..(l + 1) * self.members;
        let history = &mut points.new[own];
        let mut moduli = [0.0; 16];
        let [energy, dissipated] = points.old_energies[l].map(|e| e / v0);
        let (mut energies, mut heat) = ([energy, dissipated, 0.0], [0.0; 10]);
        let clock = points.clock;
        let begin = clock.end - clock.increment;
        let times = [begin, begin];
        let (gradient0, gradient1) = (stretch(before, self.finite), stretch(after, self.finite));
        let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let zeros = [0.0; 3];
        let mut new_time = NEW_TIME;
        let whole_number = |v: usize| c_int::try_from(v).unwrap_or(c_int::MAX);
        let (normal, shear) = (whole_number(n - 1), 1);
        let (components, members) = (whole_number(n), whole_number(self.members));
        let properties = whole_number(self.properties.len());
        let (none, one, step) = (0, 1, [1; 4]);
        let [sse, spd, scd] = &mut energies;
        let [rpl, drpldt, vectors @ ..] = &mut heat;
        let (ddsddt, drplde) = vectors.split_at_mut(4);
        // SAFETY: the arrays have the lengths that the interface names; who registered the address
        // says that a UMAT lies there.
        unsafe {
            (self.function)(
                stress.as_mut_ptr(),
                history.as_mut_ptr(),
                moduli.as_mut_ptr(),
                sse,
                spd,
                scd,
                rpl,
                ddsddt.as_mut_ptr(),
                drplde.as_mut_ptr(),
                drpldt,
                strain.as_ptr(),
                added.as_ptr(),
                times.as_ptr(),
                &raw const clock.increment,
                zeros.as_ptr(),
                zeros.as_ptr(),
                zeros.as_ptr(),
                zeros.as_ptr(),
                self.name.as_ptr(),
                &raw const normal,
                &raw const shear,
                &raw const components,
                &raw const members,
                self.properties.as_ptr(),
                &raw const properties,
                zeros.as_ptr(),
                unit.as_ptr(),
                &raw mut new_time,
                zeros.as_ptr(),
                gradient0.as_ptr(),
                gradient1.as_ptr(),
                &raw const one,
                &raw const one,
                &raw const none,
                &raw const none,
                step.as_ptr(),
                &raw const one,
                NAME_LENGTH,
            );
        }
        let mut answer = points.answers[l];
        answer.energies = [energies[0] * v1, (energies[1] + energies[2]) * v1];
        answer.normal = after[3];
        answer.failed = new_time < 1.0;
        for (i, &row) in rows.iter().enumerate() {
            answer.stress[row] = v1 * stress[i];
            for (j, &column) in rows.iter().enumerate() {
                answer.tangent[row][column] = v1 * moduli[i + n * j];
            }
        }
        if self.finite && self.by_gradient {
            answer.tangent = logarithmic(&answer.tangent, &after, &answer.stress);
        }
        answer
    }
}

impl Convention for Subroutine {
    const NAME: &'static str = "umat";
    const EXAMPLES: &'static [&'static [f64]] = &[
        &[0.0, 1.0, 0.0, 0.3, 2.0, 65.0, 66.0, 1000.0, 0.3],
        &[0.0, 1.0, 0.0, 0.3, 0.0, 7.0, 0.3],
    ];
    const GIVES_PLASTIC: bool = false;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[handle, members, gradient, poisson, length, ref rest @ ..] = parameters else {
            return Err("umat takes a handle, members, a flag, Poisson's ratio and a name".into());
        };
        let length = length as usize;
        if length > NAME_LENGTH || rest.len() < length || !(poisson > -1.0 && poisson <= 0.5) {
            return Err(format!("umat: a name of {length} characters or the ratio {poisson}"));
        }
        let function: Function = if handle == 0.0 {
            sample
        } else {
            // SAFETY: who registered the address says that a UMAT lies there.
            unsafe { std::mem::transmute::<usize, Function>(address(Self::NAME, handle)?) }
        };
        let (letters, properties) = rest.split_at(length);
        let mut name = [b' '; NAME_LENGTH];
        for (to, from) in name.iter_mut().zip(letters) {
            *to = *from as u8;
        }
        Ok(Self {
            function,
            plane,
            members: members as usize,
            by_gradient: gradient != 0.0,
            contraction: -poisson / (1.0 - poisson),
            // That of the tests is linear at any strain.
            finite: handle != 0.0,
            name,
            properties: properties.to_vec(),
        })
    }
    fn members(&self) -> usize {
        self.members
    }
    fn linearized(self) -> Self {
        Self { finite: false, ..self }
    }
    fn call(&self, points: &mut Points<'_>) {
        for l in 0..points.count {
            points.answers[l] = self.one(points, l);
        }
    }
}

/// The subroutine of the handle 0, for tests: linear elasticity of E and nu that counts its calls.
#[rustfmt::skip]
#[allow(clippy::too_many_arguments)]
unsafe extern "C" fn sample(
    stress: *mut f64, statev: *mut f64, ddsdde: *mut f64, sse: *mut f64, _: *mut f64, _: *mut f64,
    _: *mut f64, _: *mut f64, _: *mut f64, _: *mut f64, stran: *const f64, dstran: *const f64,
    _: *const f64, _: *const f64, _: *const f64, _: *const f64, _: *const f64, _: *const f64,
    _: *const u8, _: *const c_int, _: *const c_int, ntens: *const c_int, nstatv: *const c_int,
    props: *const f64, _: *const c_int, _: *const f64, _: *const f64, _: *mut f64, _: *const f64,
    _: *const f64, _: *const f64, _: *const c_int, _: *const c_int, _: *const c_int,
    _: *const c_int, _: *const c_int, _: *const c_int, _: usize,
) {
    // SAFETY: the caller keeps to the interface.
    let (n, members, [e, nu]) = unsafe { (*ntens as usize, *nstatv as usize, [*props, *props.add(1)]) };
    let (stress, ddsdde, stran, dstran, sse) = unsafe {
        (
            std::slice::from_raw_parts_mut(stress, n),
            std::slice::from_raw_parts_mut(ddsdde, n * n),
            std::slice::from_raw_parts(stran, n),
            std::slice::from_raw_parts(dstran, n),
            &mut *sse,
        )
    };
    if members > 0 {
        // SAFETY: there is one.
        unsafe { *statev += 1.0 };
    }
    let shear = e / (2.0 * (1.0 + nu));
    let lame = if n == 3 { e * nu / (1.0 - nu * nu) } else { e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) };
    *sse = 0.0;
    for i in 0..n {
        for j in 0..n {
            let both = i < n - 1 && j < n - 1;
            let own = if i != j { 0.0 } else if i < n - 1 { 2.0 * shear } else { shear };
            ddsdde[i + n * j] = own + if both { lame } else { 0.0 };
        }
    }
    for i in 0..n {
        stress[i] = (0..n).map(|j| ddsdde[i + n * j] * (stran[j] + dstran[j])).sum();
        *sse += 0.5 * stress[i] * (stran[i] + dstran[i]);
    }
}
