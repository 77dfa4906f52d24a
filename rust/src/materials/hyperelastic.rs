//! Hyperelastic laws: a law gives its energy density, and has stress and tangent from there.
//!
//! With mean `m`, half difference `d` and half shear `s` of the logarithmic strain in the plane and
//! `z` through the thickness, the energy of an isotropic body is a function of
//! `mu = (m - z) / 3`, `rho = d^2 + s^2` and `theta = 2 m + z = ln J`: the principal stretches
//! without their volume part are `exp(mu +- sqrt rho)` and `exp(-2 mu)`. Symmetric functions of the
//! first two are analytic in `rho`, so that coincident stretches are no case of their own.
// SPDX-License-Identifier: BSD-3-Clause

use super::material::{Material, Plane, PointState, Response, SolidResponse};
use crate::base::jet::{Jet, PAIRS};
use crate::base::small::Mat;
use crate::base::{Real, shared};
use std::fmt::Debug;

/// Iterations for the thickness strain in plane stress.
const MAX_ITERATIONS: usize = 50;
/// Longest step of that strain: a factor of 1.65 of the thickness.
const LONGEST_STEP: f64 = 0.5;
/// Step after which one linear correction is exact to round-off.
const TOLERANCE: f64 = 1e-9;

/// Local deformation that an energy is a function of.
pub struct Stretches<T> {
    mu: Jet<T>,
    rho: Jet<T>,
    /// Logarithm of the volume ratio.
    pub theta: Jet<T>,
}

impl<T: Real> Stretches<T> {
    /// Sum of the powers of the principal stretches, from which the volume part is taken out, less
    /// 3: to all digits of a small one, of second order in the strain.
    #[inline(always)]
    pub fn powers(&self, alpha: f64) -> Jet<T> {
        shared::<T, _>(
            #[inline(always)]
            || {
                let root = self.mu.v.scale(alpha).exp();
                let (p, q) = (root.scale(2.0), (root * root).recip());
                let (a2, two, three) = (alpha * alpha, T::real(2.0), T::real(3.0));
                let [c_m1, c1, c2] = cosh_root_m1(self.rho.v.scale(a2));
                let c = c_m1 + T::one();
                let (plane, slope) = (p * c, p * c1.scale(a2));
                // 2 (g + 1) + (g + 1)^-2 - 3 = g^2 (3 + 2 g) / (g + 1)^2
                let grown = self.mu.v.scale(alpha).exp_m1();
                let stretched = grown * grown * q * grown.fma(two, three);
                let mut y = Jet::constant(p.fma(c_m1, stretched));
                y.d[0] = (plane - q.scale(2.0)).scale(alpha);
                y.d[1] = slope;
                y.h[0] = (plane + q.scale(4.0)).scale(a2);
                y.h[1] = slope.scale(alpha);
                y.h[3] = p * c2.scale(a2 * a2);
                y
            },
        )
    }

    /// The first invariant of the isochoric `C`, less 3.
    #[inline(always)]
    pub fn first(&self) -> Jet<T> {
        self.powers(2.0)
    }

    /// The second invariant of the isochoric `C`, less 3.
    #[inline(always)]
    pub fn second(&self) -> Jet<T> {
        self.powers(-2.0)
    }

    /// `sum (J - 1)^(2 i) / D_i`; a zero adds nothing.
    #[inline(always)]
    pub fn volume(&self, d: &[f64]) -> Jet<T> {
        shared::<T, _>(
            #[inline(always)]
            || {
                let mut w = Jet::zero();
                if d.iter().all(|&d| d == 0.0) {
                    return w;
                }
                let grown = self.theta.exp(1.0).plus(-1.0);
                let square = grown * grown;
                let mut power = square;
                for (i, &d) in d.iter().enumerate() {
                    if i > 0 {
                        power = power * square;
                    }
                    if d != 0.0 {
                        w += power.scale(1.0 / d);
                    }
                }
                w
            },
        )
    }
}

/// `cosh(sqrt z) - 1` with its first and second derivatives.
#[inline(always)]
fn cosh_root_m1<T: Real>(z: T) -> [T; 3] {
    // Terms that reach round-off at one.
    const TERMS: usize = 11;
    let mut factors = [1.0; TERMS];
    for k in 1..TERMS {
        factors[k] = factors[k - 1] / ((2 * k) * (2 * k - 1)) as f64;
    }
    let mut p = [T::zero(); 3];
    let near = z.min(T::one());
    for k in (0..TERMS).rev() {
        p[2] = p[2].fma(near, p[1].scale(2.0));
        p[1] = p[1].fma(near, p[0]);
        let factor = if k == 0 { 0.0 } else { factors[k] };
        p[0] = p[0].fma(near, T::real(factor));
    }
    let far = T::one().lt(z);
    if T::any(far) {
        let z = z.max(T::one());
        let root = z.sqrt();
        let e = root.exp();
        let i = e.recip();
        let value = (e + i).scale(0.5);
        let first = (e - i).scale(0.25) / root;
        let second = (value - first.scale(2.0)).scale(0.25) / z;
        p = [
            T::select(far, value - T::one(), p[0]),
            T::select(far, first, p[1]),
            T::select(far, second, p[2]),
        ];
    }
    p
}

/// Energy density of an isotropic law.
pub trait Energy: Clone + Debug + Sized {
    const NAME: &'static str;
    /// See [`Material::EXAMPLES`].
    const EXAMPLES: &'static [&'static [f64]];
    fn new(parameters: &[f64]) -> Result<Self, String>;
    /// Whether the volume is constant.
    fn is_incompressible(&self) -> bool {
        false
    }
    /// Energy per reference volume that the change of shape stores: all but [`Energy::volume`].
    fn shape<T: Real>(&self, s: &Stretches<T>) -> Jet<T>;
    /// Energy per reference volume that follows from the volume alone.
    #[inline(always)]
    fn volume<T: Real>(&self, _: &Stretches<T>) -> Jet<T> {
        Jet::zero()
    }

    /// Whether the law remembers the largest energy of the shape, its only member of the history.
    const REMEMBERS: bool = false;
    /// Energy per reference volume after that largest energy, from which the stress follows.
    #[inline(always)]
    fn density<T: Real>(&self, s: &Stretches<T>, _largest: T) -> Jet<T> {
        self.shape(s) + self.volume(s)
    }
    /// Part of that energy which is lost.
    fn lost(&self, _largest: f64) -> f64 {
        0.0
    }
}

/// The law of an energy.
#[derive(Clone, Debug)]
pub struct Hyperelastic<W> {
    energy: W,
    plane: Plane,
    moduli: Mat<f64, 3>,
    /// Thickness strain over the sum of the strains in the plane, at small strain.
    contraction: f64,
}

/// The energy that a hyperelastic law consists of.
pub trait OfEnergy {
    type Energy: Energy;
}

impl<W: Energy> OfEnergy for Hyperelastic<W> {
    type Energy = W;
}

/// In-plane strain by mean, half difference and half shear.
#[inline(always)]
fn parts<T: Real>(e: &[T; 3]) -> [T; 3] {
    [(e[0] + e[1]).scale(0.5), (e[0] - e[1]).scale(0.5), e[2].scale(0.5)]
}

/// The variables of an energy by [`parts`] and the strain through the thickness.
#[inline(always)]
fn stretches<T: Real>([m, d, s]: [T; 3], z: T) -> Stretches<T> {
    Stretches {
        mu: Jet::variable((m - z).scale(1.0 / 3.0), 0),
        rho: Jet::variable(d.fma(d, s * s), 1),
        theta: Jet::variable(m.scale(2.0) + z, 2),
    }
}

/// The largest energy of the shape of a state that was written.
fn after<W: Energy>(state: &[f64]) -> f64 {
    if W::REMEMBERS { state[0] } else { 0.0 }
}

/// Rows xx, yy, xy of a matrix.
#[inline(always)]
fn in_plane<T: Real>(m: &Mat<T, 4>) -> Mat<T, 3> {
    let mut d = [[T::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            d[i][j] = m[i][j];
        }
    }
    d
}

/// Stress and tangent, rows xx, yy, xy, zz, where the first variable has the slopes `mu`
/// and the third the slopes `theta`.
#[inline(always)]
fn derivatives<T: Real>(
    w: &Jet<T>,
    [_, d, s]: [T; 3],
    mu: [f64; 4],
    theta: [f64; 4],
) -> SolidResponse<T> {
    shared::<T, _>(
        #[inline(always)]
        || {
            let mut slopes = [[T::zero(); 4], [d, -d, s, T::zero()], [T::zero(); 4]];
            for i in 0..4 {
                slopes[0][i] = T::real(mu[i]);
                slopes[2][i] = T::real(theta[i]);
            }
            let mut stress = [T::zero(); 4];
            let mut tangent = [[T::zero(); 4]; 4];
            for i in 0..4 {
                for (slope, by) in slopes.iter().zip(w.d) {
                    stress[i] = slope[i].fma(by, stress[i]);
                }
            }
            for ((a, b), h) in PAIRS.into_iter().zip(w.h) {
                for i in 0..4 {
                    for j in 0..4 {
                        let mut both = slopes[a][i] * slopes[b][j];
                        if a != b {
                            both = slopes[b][i].fma(slopes[a][j], both);
                        }
                        tangent[i][j] = h.fma(both, tangent[i][j]);
                    }
                }
            }
            // Second derivatives of the squared radius.
            let half = w.d[1].scale(0.5);
            tangent[0][0] += half;
            tangent[1][1] += half;
            tangent[2][2] += half;
            tangent[0][1] -= half;
            tangent[1][0] -= half;
            SolidResponse { stress, tangent, failed: T::none() }
        },
    )
}

impl<W: Energy> Hyperelastic<W> {
    #[inline(always)]
    fn density<T: Real>(&self, parts: [T; 3], z: T, largest: T) -> Jet<T> {
        shared::<T, _>(
            #[inline(always)]
            || self.energy.density(&stretches(parts, z), largest),
        )
    }

    /// The largest energy of the shape so far.
    #[inline(always)]
    fn largest<T: Real>(state: &PointState<'_>) -> T {
        if W::REMEMBERS { state.get(0) } else { T::zero() }
    }

    /// Write the history of a state with strain `z` through the thickness.
    #[inline(always)]
    fn keep<T: Real>(&self, e: &[T; 3], z: T, largest: T, state: &mut PointState<'_>) {
        if W::REMEMBERS {
            state.set(0, largest.max(self.energy.shape(&stretches(parts(e), z)).v));
        }
    }

    #[inline(always)]
    fn solid<T: Real>(&self, e: &[T; 4], largest: T) -> SolidResponse<T> {
        const SIXTH: f64 = 1.0 / 6.0;
        let parts = parts(&[e[0], e[1], e[2]]);
        let w = self.density(parts, e[3], largest);
        derivatives(&w, parts, [SIXTH, SIXTH, 0.0, -2.0 * SIXTH], [1.0, 1.0, 0.0, 1.0])
    }

    /// Plane stress at constant volume.
    #[inline(always)]
    fn flat<T: Real>(&self, e: &[T; 3], largest: T) -> SolidResponse<T> {
        let parts = parts(e);
        let w = self.density(parts, parts[0].scale(-2.0), largest);
        derivatives(&w, parts, [0.5, 0.5, 0.0, 0.0], [0.0; 4])
    }

    /// Strain through the thickness that leaves no stress there, and the lanes without one.
    #[inline(always)]
    fn thickness<T: Real>(&self, e: &[T; 3], largest: T) -> (T, T::Mask) {
        let parts = parts(e);
        if self.energy.is_incompressible() {
            return (parts[0].scale(-2.0), T::none());
        }
        let mut z = (e[0] + e[1]).scale(self.contraction);
        let mut open = T::one();
        for _ in 0..MAX_ITERATIONS {
            let w = self.density(parts, z, largest);
            let stress = w.d[2] - w.d[0].scale(1.0 / 3.0);
            let slope = w.h[5] - w.h[2].scale(2.0 / 3.0) + w.h[0].scale(1.0 / 9.0);
            // Against the stress even where the slope is negative.
            let step = (stress / slope.abs()).min(T::real(LONGEST_STEP));
            let step = step.max(T::real(-LONGEST_STEP));
            z -= step;
            open = T::select(step.abs().lt(T::real(TOLERANCE)), T::zero(), T::one());
            if !T::any(T::real(0.5).lt(open)) {
                break;
            }
        }
        (z, T::real(0.5).lt(open))
    }

    /// Answer in the plane, and the strain through the thickness.
    #[inline(always)]
    fn answer<T: Real>(&self, e: &[T; 3], largest: T) -> (Response<T>, T) {
        let incompressible = self.energy.is_incompressible();
        if self.plane == Plane::Strain || incompressible {
            let z = if incompressible { -(e[0] + e[1]) } else { T::zero() };
            let SolidResponse { stress: [x, y, xy, _], tangent, failed } = if incompressible {
                self.flat(e, largest)
            } else {
                self.solid(&[e[0], e[1], e[2], z], largest)
            };
            return (Response { stress: [x, y, xy], tangent: in_plane(&tangent), failed }, z);
        }
        let (z, failed) = self.thickness(e, largest);
        let all = self.solid(&[e[0], e[1], e[2], z], largest);
        // What is left of the stress through the thickness is removed by its linear part.
        let softness = all.tangent[3][3].recip();
        let mut stress = [all.stress[0], all.stress[1], all.stress[2]];
        let mut tangent = in_plane(&all.tangent);
        for i in 0..3 {
            let share = all.tangent[i][3] * softness;
            stress[i] -= share * all.stress[3];
            for j in 0..3 {
                tangent[i][j] -= share * all.tangent[3][j];
            }
        }
        (Response { stress, tangent, failed }, z)
    }

    /// Strain through the thickness of a state.
    fn normal(&self, e: [f64; 3], state: &[f64]) -> f64 {
        match self.plane {
            Plane::Stress => self.thickness(&e, after::<W>(state)).0,
            Plane::Strain => 0.0,
        }
    }
}

impl<W: Energy> Material for Hyperelastic<W> {
    const NAME: &'static str = W::NAME;
    const EXAMPLES: &'static [&'static [f64]] = W::EXAMPLES;

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let energy = W::new(parameters)?;
        let incompressible = energy.is_incompressible();
        if incompressible && plane == Plane::Strain {
            return Err(format!(
                "{}: a constant volume (D = 0) is for plane stress; in plane strain give D1 = 2 / K, \
                 with a bulk modulus K of 1000 times the shear modulus or what was measured",
                W::NAME
            ));
        }
        let mut law = Self { energy, plane, moduli: [[0.0; 3]; 3], contraction: -1.0 };
        let shear = if incompressible {
            law.flat(&[0.0; 3], 0.0).tangent[2][2]
        } else {
            let m = law.solid(&[0.0; 4], 0.0).tangent;
            law.contraction = -m[3][0] / m[3][3];
            let bulk = (m[3][3] + 2.0 * m[3][0]) / 3.0;
            if !(bulk > 0.0 && bulk.is_finite()) {
                return Err(format!("{}: the bulk modulus {bulk} must be > 0", W::NAME));
            }
            m[2][2]
        };
        if !(shear > 0.0 && shear.is_finite()) {
            return Err(format!("{}: the initial shear modulus {shear} must be > 0", W::NAME));
        }
        law.moduli = law.answer(&[0.0; 3], 0.0).0.tangent;
        Ok(law)
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    fn n_state(&self) -> usize {
        usize::from(W::REMEMBERS)
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T> {
        let largest = Self::largest(state);
        let (response, z) = self.answer(&strain, largest);
        self.keep(&strain, z, largest, state);
        response
    }
    #[inline(always)]
    fn update_solid<T: Real>(
        &self,
        strain: [T; 4],
        state: &mut PointState<'_>,
    ) -> SolidResponse<T> {
        let largest = Self::largest(state);
        let [x, y, xy, z] = strain;
        self.keep(&[x, y, xy], z, largest, state);
        self.solid(&strain, largest)
    }
    fn out_of_plane(&self, e: [f64; 3], _: [f64; 3], state: &[f64]) -> (f64, f64) {
        match self.plane {
            Plane::Stress => (self.normal(e, state), 0.0),
            Plane::Strain => {
                (0.0, self.solid(&[e[0], e[1], e[2], 0.0], after::<W>(state)).stress[3])
            }
        }
    }
    fn energy(&self, e: [f64; 3], _: [f64; 3], state: &[f64]) -> f64 {
        let z = self.normal(e, state);
        self.energy_solid([e[0], e[1], e[2], z], [0.0; 4], state)
    }
    fn energy_solid(&self, e: [f64; 4], _: [f64; 4], state: &[f64]) -> f64 {
        let largest = after::<W>(state);
        self.density(parts(&[e[0], e[1], e[2]]), e[3], largest).v - self.energy.lost(largest)
    }
    fn outputs(&self) -> &'static [&'static str] {
        if W::REMEMBERS { &["DMENER"] } else { &[] }
    }
    fn output(&self, _: usize, _: [f64; 3], state: &[f64]) -> f64 {
        self.energy.lost(after::<W>(state))
    }
}
