//! Plasticity of rolled sheet: the yield function of Hill (1948) with isotropic and kinematic
//! hardening, isotropic elasticity and an implicit return map in the axes of the material, as one scalar equation.
//!
//! Parameters: E, nu, R11, R22, R33, R12 (yield stresses over that of the hardening; of shear over
//! the square root of a third of it), angle of axis 1, number of back-stresses n, n pairs (C, gamma),
//! then the numbers of [`Isotropic::new`].
//!
//! Back-stresses move along the relative stress (Ziegler 1959): `db = C dp (s - b) / sy - gamma b dp`.
//! With the step `dp` and the multiplier `g = dp / sy` the relative stress is `(1 + m + g A)^-1` times
//! its trial value, by a matrix of two normal components (in plane strain of the deviator) and the
//! shear; `m` is `g` times the moduli of the back-stresses.
// SPDX-License-Identifier: BSD-3-Clause

use super::hardening::{BackStress, Isotropic};
use super::material::{Material, Plane, PointState, Response, TensorOutput, broadcast};
use super::mises::{MAX_BACK, ROUNDING};
use crate::base::small::Mat;
use crate::base::{Real, shared_dual};

/// Iterations of the scalar equation, and relative error after which one more step is exact: as
/// in [`super::mises`].
const MAX_ITERATIONS: usize = 80;
const TOLERANCE: f64 = 1e-12;
/// Members of the state: plastic strain 11, 22, 12 (engineering), equivalent plastic strain, work,
/// back-stresses 11, 22, 12.
const EQUIVALENT: usize = 3;
const WORK: usize = 4;
const BACK: usize = 5;

#[derive(Clone, Debug)]
pub struct Hill {
    young: f64,
    nu: f64,
    shear: f64,
    plane: Plane,
    isotropic: Isotropic,
    back: Vec<BackStress>,
    /// Strain in the axes of the material by that of the plane.
    turn: Mat<f64, 3>,
    moduli: Mat<f64, 3>,
    /// Normal stress of a unit elastic strain, without the mean stress in plane strain; the rest.
    elastic: Mat<f64, 2>,
    volume: f64,
    /// Matrix of the return in the normal components, and number of the shear.
    a: Mat<f64, 2>,
    a_shear: f64,
    /// Squared norm: of normal components and of the shear.
    square: Mat<f64, 2>,
    square_shear: f64,
    /// Smallest rate at which a step lowers the equivalent stress.
    softest: f64,
}

/// The state at a trial step.
struct Trial<T: Real> {
    /// Multiplier.
    g: T,
    /// Divisor of the relative stress without the elastic part.
    divisor: T,
    /// Relative stress.
    normal: [T; 2],
    shear: T,
    /// `A` times the relative stress: itself, returned once more, and its multiplier's derivative.
    flow: [T; 3],
    along: [T; 3],
    removed: [T; 3],
    q: T,
    /// `sy' - q'`.
    slope: T,
    value: T,
    derivative: T,
}

#[inline(always)]
fn times<T: Real>(m: &Mat<f64, 2>, v: &[T; 2]) -> [T; 2] {
    [v[0].scale(m[0][0]) + v[1].scale(m[0][1]), v[0].scale(m[1][0]) + v[1].scale(m[1][1])]
}

impl Hill {
    /// `(divisor + g A)^-1`.
    #[inline(always)]
    fn inverse<T: Real>(&self, g: T, divisor: T) -> Mat<T, 2> {
        let a = |i: usize, j: usize| g.scale(self.a[i][j]);
        let (x, y) = (a(0, 0) + divisor, a(1, 1) + divisor);
        let det = (x * y - a(0, 1) * a(1, 0)).recip();
        [[y * det, -(a(0, 1) * det)], [-(a(1, 0) * det), x * det]]
    }

    #[inline(always)]
    fn equivalent<T: Real>(&self, n: &[T; 2], s: T) -> T {
        let p = times(&self.square, n);
        (p[0] * n[0] + p[1] * n[1] + (s * s).scale(self.square_shear)).sqrt()
    }

    #[inline(always)]
    fn trial<T: Real>(
        &self,
        normal: &[T; 2],
        shear: T,
        old: &[[T; 3]; MAX_BACK],
        p: T,
        dp: T,
    ) -> Trial<T> {
        shared_dual::<T, _>(
            #[inline(always)]
            || {
                let o = T::zero();
                let (sy, h) = self.isotropic.at(p + dp);
                let r = sy.recip();
                let g = dp * r;
                let dg = (T::one() - g * h) * r;
                let (mut modulus, mut d_modulus) = (o, o);
                let (mut shift, mut d_shift) = ([o; 3], [o; 3]);
                for (b, alpha) in self.back.iter().zip(old) {
                    let (kept, d_kept) = b.kept(dp);
                    modulus = kept.fma(T::real(b.modulus), modulus);
                    d_modulus = d_kept.fma(T::real(b.modulus), d_modulus);
                    for k in 0..3 {
                        shift[k] = kept.fma(alpha[k], shift[k]);
                        d_shift[k] = d_kept.fma(alpha[k], d_shift[k]);
                    }
                }
                let divisor = g.fma(modulus, T::one());
                let d_divisor = dg.fma(modulus, g * d_modulus);
                let b = self.inverse(g, divisor);
                let by =
                    |v: &[T; 2]| [b[0][0] * v[0] + b[0][1] * v[1], b[1][0] * v[0] + b[1][1] * v[1]];
                let by_shear = g.fma(T::real(self.a_shear), divisor).recip();
                let n = by(&[normal[0] - shift[0], normal[1] - shift[1]]);
                let s = (shear - shift[2]) * by_shear;
                let [fx, fy] = times(&self.a, &n);
                let flow = [fx, fy, s.scale(self.a_shear)];
                let [x, y] = by(&[fx, fy]);
                let along = [x, y, flow[2] * by_shear];
                // Loss of relative stress by the step.
                let loss = |k: usize, v: T| d_divisor.fma(v, d_shift[k]) + dg * flow[k];
                let lost = by(&[loss(0, n[0]), loss(1, n[1])]);
                let lost_shear = loss(2, s) * by_shear;
                let q = self.equivalent(&n, s).max(T::real(f64::MIN_POSITIVE));
                let inverse = q.recip();
                let w = times(&self.square, &n);
                let along_lost =
                    w[0] * lost[0] + w[1] * lost[1] + (s * lost_shear).scale(self.square_shear);
                let dq = -(along_lost * inverse);
                let [rx, ry] = times(&self.a, &[dg * n[0] - g * lost[0], dg * n[1] - g * lost[1]]);
                let removed = [rx, ry, (dg * s - g * lost_shear).scale(self.a_shear)];
                let value = (sy - q) * inverse;
                let derivative = (h - sy * dq * inverse) * inverse;
                let slope = h - dq;
                Trial {
                    g,
                    divisor,
                    normal: n,
                    shear: s,
                    flow,
                    along,
                    removed,
                    q,
                    slope,
                    value,
                    derivative,
                }
            },
        )
    }

    /// Step in the lanes that yield; also the lanes in which it did not settle.
    #[inline(always)]
    fn solve<T: Real>(
        &self,
        normal: &[T; 2],
        shear: T,
        old: &[[T; 3]; MAX_BACK],
        p: T,
        excess: T,
        yields: T::Mask,
    ) -> (T, T::Mask) {
        // Recall can only bring back what the old back-stresses hold.
        let mut most = excess;
        for (b, alpha) in self.back.iter().zip(old) {
            if b.recall > 0.0 {
                most += self.equivalent(&[alpha[0], alpha[1]], alpha[2]);
            }
        }
        let (mut low, mut high) = (T::zero(), most.scale((1.0 + 1e-9) / self.softest));
        let (mut dp, mut open) = (T::zero(), T::zero());
        for _ in 0..MAX_ITERATIONS {
            let at = self.trial(normal, shear, old, p, dp);
            let settled = at.value.abs().lt(T::real(TOLERANCE));
            let short = at.value.lt(T::zero());
            low = T::select(short, dp, low);
            high = T::select(short, high, dp);
            let next = dp - at.value / at.derivative;
            let inside = T::or(settled, T::and(low.lt(next), next.lt(high)));
            let next = T::select(inside, next, (low + high).scale(0.5));
            dp = T::select(yields, next, T::zero());
            open = T::select(yields, T::select(settled, T::zero(), T::one()), T::zero());
            if !T::any(T::real(0.5).lt(open)) {
                break;
            }
        }
        (dp, T::real(0.5).lt(open))
    }

    /// Energy density that the hardening stores.
    fn hardening_energy(&self, state: &[f64]) -> f64 {
        let of_back = |(i, b): (usize, &BackStress)| {
            let alpha = &state[BACK + 3 * i..];
            self.equivalent(&[alpha[0], alpha[1]], alpha[2]).powi(2) / (2.0 * b.modulus)
        };
        self.isotropic.stored(state[EQUIVALENT])
            + self.back.iter().enumerate().map(of_back).sum::<f64>()
    }

    /// Sum of the back-stresses in the axes of the material.
    fn back_stress(&self, state: &[f64]) -> [f64; 3] {
        std::array::from_fn(|k| (0..self.back.len()).map(|i| state[BACK + 3 * i + k]).sum())
    }

    /// Strain and stress in the axes of the material.
    fn in_axes(&self, e: [f64; 3], s: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let t = &self.turn;
        let strain = std::array::from_fn(|i| (0..3).map(|j| t[i][j] * e[j]).sum());
        // Stress turns like strain whose shear is not doubled.
        let half = |i: usize| if i == 2 { 0.5 } else { 1.0 };
        let stress =
            std::array::from_fn(|i| (0..3).map(|j| half(i) * t[i][j] / half(j) * s[j]).sum());
        (strain, stress)
    }

    /// Stress through the thickness.
    fn normal(&self, s: [f64; 3], state: &[f64]) -> f64 {
        match self.plane {
            Plane::Stress => 0.0,
            Plane::Strain => self.nu * (s[0] + s[1]) + self.young * (state[0] + state[1]),
        }
    }
}

impl Material for Hill {
    const NAME: &'static str = "hill";
    const EXAMPLES: &'static [&'static [f64]] = &[
        // Two back-stresses, one with recall, and hardening of Voce.
        &[
            1000.0, 0.3, 1.0, 1.1, 0.9, 1.05, 0.4, 2.0, 60.0, 0.0, 90.0, 30.0, 2.0, 80.0, 20.0,
            5.0, 400.0,
        ],
        &[7.0, 0.3, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.05, 0.0],
        &[7.0, 0.3, 1.0, 1.2, 0.9, 0.8, 0.5, 0.0, 0.0, 0.05, 0.4],
        &[7.0, 0.3, 1.0, 1.2, 0.9, 0.8, 0.5, 1.0, 0.7, 0.0, 0.0, 0.05, 0.4],
        &[7.0, 0.3, 0.9, 1.0, 1.2, 1.1, -1.0, 0.0, 1.0, 0.05, 0.0, 0.07, 0.01, 0.08, 0.2],
    ];

    fn new(parameters: &[f64], plane: Plane) -> Result<Self, String> {
        let &[young, nu, r11, r22, r33, r12, angle, count, ref rest @ ..] = parameters else {
            return Err(
                "hill takes E, nu, four ratios, an angle, back-stresses, a hardening".into()
            );
        };
        let count = count as usize;
        if count > MAX_BACK || rest.len() < 2 * count {
            return Err(format!("hill takes at most {MAX_BACK} back-stresses"));
        }
        let (pairs, numbers) = rest.split_at(2 * count);
        let back: Result<Vec<_>, _> =
            pairs.as_chunks::<2>().0.iter().map(|&[c, gamma]| BackStress::new(c, gamma)).collect();
        if !(young > 0.0 && young.is_finite() && nu > -1.0 && nu < 0.5 && angle.is_finite()) {
            return Err(format!("hill needs E > 0, -1 < nu < 0.5, not {young}, {nu}"));
        }
        if ![r11, r22, r33, r12].iter().all(|r| *r > 0.0 && r.is_finite()) {
            return Err("hill needs ratios > 0".into());
        }
        let inverse = [r11, r22, r33].map(|r: f64| 0.5 / (r * r));
        let f = inverse[1] + inverse[2] - inverse[0];
        let g = inverse[2] + inverse[0] - inverse[1];
        let h = inverse[0] + inverse[1] - inverse[2];
        if f * g + g * h + h * f <= 0.0 {
            return Err("the ratios of hill do not close a yield surface: bring them closer".into());
        }
        let (shear, bulk) = (young / (2.0 * (1.0 + nu)), young / (3.0 * (1.0 - 2.0 * nu)));
        let square_shear = 3.0 / (r12 * r12);
        let (elastic, volume, square, a, local);
        match plane {
            Plane::Stress => {
                let c = young / (1.0 - nu * nu);
                elastic = [[c, nu * c], [nu * c, c]];
                volume = 0.0;
                square = [[g + h, -h], [-h, f + h]];
                a = std::array::from_fn(|i| {
                    std::array::from_fn(|j| (0..2).map(|k| elastic[i][k] * square[k][j]).sum())
                });
                local = elastic;
            }
            Plane::Strain => {
                let d = 2.0 * shear / 3.0;
                elastic = [[2.0 * d, -d], [-d, 2.0 * d]];
                volume = bulk;
                square = [
                    [f + 4.0 * g + h, 2.0 * f + 2.0 * g - h],
                    [2.0 * f + 2.0 * g - h, 4.0 * f + g + h],
                ];
                let m = [[h + 2.0 * g, g - h], [f - h, h + 2.0 * f]];
                a = m.map(|row| row.map(|v| 2.0 * shear * v));
                local = elastic.map(|row| row.map(|v| v + bulk));
            }
        }
        // The matrix is symmetric in the product of the norm, so that its values are real.
        let half = 0.5 * (a[0][0] + a[1][1]);
        let det: f64 = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        let least = half - (half * half - det).max(0.0).sqrt();
        let a_shear = shear * square_shear;
        let (c, s) = (angle.cos(), angle.sin());
        let turn = [
            [c * c, s * s, c * s],
            [s * s, c * c, -c * s],
            [-2.0 * c * s, 2.0 * c * s, c * c - s * s],
        ];
        let whole =
            [[local[0][0], local[0][1], 0.0], [local[1][0], local[1][1], 0.0], [0.0, 0.0, shear]];
        Ok(Self {
            young,
            nu,
            shear,
            plane,
            isotropic: Isotropic::new(numbers)?,
            back: back?,
            turn,
            // Isotropic: the same in all axes.
            moduli: whole,
            elastic,
            volume,
            a,
            a_shear,
            square,
            square_shear,
            softest: least.min(a_shear) * (1.0 - 1e-9),
        })
    }
    fn n_state(&self) -> usize {
        BACK + 3 * self.back.len()
    }
    fn moduli(&self) -> Mat<f64, 3> {
        self.moduli
    }
    #[inline(always)]
    fn update<T: Real>(&self, strain: [T; 3], state: &mut PointState<'_>) -> Response<T> {
        let o = T::zero();
        let t = &self.turn;
        let mut e = [o; 3];
        for (row, e) in t.iter().zip(&mut e) {
            for (k, v) in row.iter().zip(strain) {
                *e = v.fma(T::real(*k), *e);
            }
        }
        let plastic: [T; 3] = std::array::from_fn(|i| state.get(i));
        let mut inside = [e[0] - plastic[0], e[1] - plastic[1]];
        if self.plane == Plane::Strain {
            // The strains whose deviator it is, with none through the thickness.
            let out = plastic[0] + plastic[1];
            inside = inside.map(|v| v - out);
        }
        let pressure = (e[0] + e[1]).scale(self.volume);
        let normal = times(&self.elastic, &inside);
        let shear = (e[2] - plastic[2]).scale(self.shear);
        let p: T = state.get(EQUIVALENT);
        let work: T = state.get(WORK);
        let limit = self.isotropic.at(p).0;
        let mut old = [[o; 3]; MAX_BACK];
        let mut relative = [normal[0], normal[1], shear];
        for i in 0..self.back.len() {
            for k in 0..3 {
                old[i][k] = state.get(BACK + 3 * i + k);
                relative[k] -= old[i][k];
            }
        }
        let excess = self.equivalent(&[relative[0], relative[1]], relative[2]) - limit;
        let yields = o.lt(excess);
        let (mut stress, mut tangent, mut failed) =
            ([normal[0], normal[1], shear], broadcast(&self.moduli), T::none());
        let (mut added, mut dp) = ([o; 3], o);
        let mut done = work;
        let mut alpha = old;
        if T::any(yields) {
            (dp, failed) = self.solve(&normal, shear, &old, p, excess, yields);
            let at = self.trial(&normal, shear, &old, p, dp);
            for k in 0..3 {
                stress[k] -= at.g * at.flow[k];
            }
            let w = match self.plane {
                Plane::Stress => times(&self.square, &at.normal),
                Plane::Strain => times(&self.a, &at.normal).map(|v| v.scale(0.5 / self.shear)),
            };
            added = [at.g * w[0], at.g * w[1], (at.g * at.shear).scale(self.square_shear)];
            let out = match self.plane {
                Plane::Stress => o,
                Plane::Strain => added[0] + added[1],
            };
            for (i, b) in self.back.iter().enumerate() {
                let (kept, _) = b.kept(dp);
                let relative = [at.normal[0], at.normal[1], at.shear];
                for k in 0..3 {
                    let gain = (at.g * relative[k]).scale(b.modulus);
                    alpha[i][k] = kept * (old[i][k] + gain);
                    // The mean of both ends does the work.
                    let strain = if k < 2 { added[k] + out } else { added[k] };
                    done = ((old[i][k] + alpha[i][k]) * strain).fma(T::real(0.5), done);
                }
            }
            let mut size = limit;
            for v in [normal[0].abs(), normal[1].abs(), shear.abs()] {
                size += v;
            }
            let flows = size.scale(ROUNDING).lt(excess);
            let b = self.inverse(at.g, at.divisor);
            let by_shear = at.g.fma(T::real(self.a_shear), at.divisor).recip();
            let factor = T::select(flows, (at.q * at.slope).recip(), o);
            // In the axes of the material, then in those of the plane. The stress loses `g A` times
            // the relative stress.
            let mut d = [[o; 3]; 3];
            for i in 0..2 {
                let lost =
                    |j: usize| at.g * (b[0][j].scale(self.a[i][0]) + b[1][j].scale(self.a[i][1]));
                let unit = |j: usize| if i == j { T::one() } else { o };
                let left = [unit(0) - lost(0), unit(1) - lost(1)];
                for j in 0..2 {
                    let c = left[0].scale(self.elastic[0][j]) + left[1].scale(self.elastic[1][j]);
                    d[i][j] = c + T::real(self.volume);
                }
            }
            d[2][2] = (T::one() - at.g * by_shear.scale(self.a_shear)).scale(self.shear);
            // Recall makes the tangent unsymmetric; its symmetric part is returned.
            for i in 0..3 {
                for j in 0..3 {
                    let both = at.removed[i] * at.along[j] + at.along[i] * at.removed[j];
                    d[i][j] -= factor * both.scale(0.5);
                }
            }
            for i in 0..3 {
                for j in 0..3 {
                    let mut sum = o;
                    for k in 0..3 {
                        for l in 0..3 {
                            sum = d[k][l].fma(T::real(t[k][i] * t[l][j]), sum);
                        }
                    }
                    tangent[i][j] = sum;
                }
            }
        }
        for (i, rows) in alpha.iter().enumerate().take(self.back.len()) {
            for (k, v) in rows.iter().enumerate() {
                state.set(BACK + 3 * i + k, *v);
            }
        }
        for i in 0..3 {
            state.set(i, plastic[i] + added[i]);
        }
        state.set(EQUIVALENT, p + dp);
        state.set(WORK, done + self.isotropic.work(p, dp));
        stress[0] += pressure;
        stress[1] += pressure;
        let mut out = [o; 3];
        for (k, row) in t.iter().enumerate() {
            for i in 0..3 {
                out[i] = stress[k].fma(T::real(row[i]), out[i]);
            }
        }
        Response { stress: out, tangent, failed }
    }
    fn bulk(&self) -> Option<f64> {
        Some(self.young / (3.0 * (1.0 - 2.0 * self.nu)))
    }
    fn out_of_plane(&self, _: [f64; 3], s: [f64; 3], state: &[f64]) -> (f64, f64) {
        match self.plane {
            Plane::Stress => (-self.nu / self.young * (s[0] + s[1]) - state[0] - state[1], 0.0),
            Plane::Strain => (0.0, self.normal(s, state)),
        }
    }
    fn energy(&self, e: [f64; 3], s: [f64; 3], state: &[f64]) -> f64 {
        let (strain, stress) = self.in_axes(e, s);
        let inside: f64 = (0..3).map(|i| stress[i] * (strain[i] - state[i])).sum();
        0.5 * (inside + self.normal(s, state) * (state[0] + state[1]))
    }
    fn spherical(&self) -> bool {
        self.plane == Plane::Strain
    }
    fn initial_energy(&self, s: [f64; 3], normal: f64, initial: f64) -> f64 {
        let thrice = 3.0 * (1.0 - 2.0 * self.nu) / self.young;
        initial * thrice * ((s[0] + s[1] + normal) / 3.0 + 0.5 * initial)
    }
    fn outputs(&self) -> &'static [&'static str] {
        &["PEEQ", "YRATIO", "PWORK", "PDISS"]
    }
    fn output(&self, i: usize, s: [f64; 3], state: &[f64]) -> f64 {
        match i {
            0 => state[EQUIVALENT],
            1 => {
                let (_, m) = self.in_axes([0.0; 3], s);
                let mean = match self.plane {
                    Plane::Stress => 0.0,
                    Plane::Strain => (s[0] + s[1] + self.normal(s, state)) / 3.0,
                };
                let b = self.back_stress(state);
                let q = self.equivalent(&[m[0] - mean - b[0], m[1] - mean - b[1]], m[2] - b[2]);
                q / self.isotropic.at(state[EQUIVALENT]).0
            }
            2 => state[WORK],
            _ => state[WORK] - self.hardening_energy(state),
        }
    }
    fn tensors(&self) -> &'static [TensorOutput] {
        const PLASTIC: TensorOutput = TensorOutput { name: "PE", engineering: true };
        const MOVED: TensorOutput = TensorOutput { name: "ALPHA", engineering: false };
        if self.back.is_empty() { &[PLASTIC] } else { &[PLASTIC, MOVED] }
    }
    fn tensor(&self, i: usize, state: &[f64]) -> [f64; 4] {
        // The transposed turn of stresses is the inverse one of strains, with half the shear.
        let t = &self.turn;
        if i == 1 {
            // The deviator; in plane stress the state holds the tensor with zero 33.
            let b = self.back_stress(state);
            let [xx, yy, xy] = std::array::from_fn(|i| (0..3).map(|k| t[k][i] * b[k]).sum::<f64>());
            let mean = if self.plane == Plane::Stress { (xx + yy) / 3.0 } else { 0.0 };
            let zz = if self.plane == Plane::Stress { -mean } else { -xx - yy };
            return [xx - mean, yy - mean, zz, xy];
        }
        let p = [state[0], state[1], 0.5 * state[2]];
        let [xx, yy, xy] = std::array::from_fn(|i| (0..3).map(|k| t[k][i] * p[k]).sum::<f64>());
        [xx, yy, -(state[0] + state[1]), 2.0 * xy]
    }
    fn ideal(&self) -> bool {
        self.isotropic.saturates() && self.back.iter().all(|b| b.recall > 0.0)
    }
    fn plastic_member(&self) -> Option<usize> {
        Some(EQUIVALENT)
    }
    fn work_member(&self) -> Option<usize> {
        Some(WORK)
    }
}
