//! Strain of the local displacement gradient: `linear`, `green_lagrange`
//! (Green-Lagrange), `logarithmic` (Hencky), with first and second derivatives, in gradient
//! components `u,x  u,y  v,x  v,y`.
// SPDX-License-Identifier: BSD-3-Clause

use super::hencky;
use crate::base::Real;
use crate::base::small::Mat;

/// Which strain of the local gradient the material sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalStrain {
    Linear,
    GreenLagrange,
    Logarithmic,
    /// Linear strain, whose tangent has the stress stiffness of another one at the reference.
    Stressed(Finite),
}

/// A strain with a second derivative at the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finite {
    GreenLagrange,
    Logarithmic,
}

impl LocalStrain {
    pub const NAMES: &'static [&'static str] = &["linear", "green_lagrange", "logarithmic"];

    pub fn new(name: &str) -> Result<Self, String> {
        match name {
            "linear" => Ok(Self::Linear),
            "green_lagrange" => Ok(Self::GreenLagrange),
            "logarithmic" => Ok(Self::Logarithmic),
            _ => Err(format!("no local strain named {name:?}; there are {:?}", Self::NAMES)),
        }
    }

    pub fn is_linear(self) -> bool {
        self == Self::Linear
    }

    /// The strain of a linear state that small motions or bifurcations are looked for about.
    pub fn stressed(self) -> Self {
        match self {
            Self::GreenLagrange => Self::Stressed(Finite::GreenLagrange),
            Self::Logarithmic => Self::Stressed(Finite::Logarithmic),
            other => other,
        }
    }

    /// Whether gradients count to first order only.
    pub fn is_stressed(self) -> bool {
        matches!(self, Self::Stressed(_))
    }

    /// The strain that gives the stress its stiffness.
    pub fn finite(self) -> Self {
        match self {
            Self::Stressed(Finite::GreenLagrange) => Self::GreenLagrange,
            Self::Stressed(Finite::Logarithmic) => Self::Logarithmic,
            other => other,
        }
    }

    /// Strain xx, yy, xy (engineering shear).
    #[inline(always)]
    pub fn strain<T: Real>(self, h: &[T; 4]) -> [T; 3] {
        let linear = [h[0], h[3], h[1] + h[2]];
        match self {
            Self::Linear | Self::Stressed(_) => linear,
            Self::GreenLagrange => [
                (h[0] * h[0] + h[2] * h[2]).fma(T::real(0.5), linear[0]),
                (h[1] * h[1] + h[3] * h[3]).fma(T::real(0.5), linear[1]),
                h[0].fma(h[1], h[2].fma(h[3], linear[2])),
            ],
            Self::Logarithmic => hencky::strain(h),
        }
    }

    /// Stress conjugate to the gradient, `P = (dE/dH)^T S`.
    #[inline(always)]
    pub fn pull<T: Real>(self, h: &[T; 4], s: &[T; 3]) -> [T; 4] {
        let linear = [s[0], s[2], s[2], s[1]];
        match self {
            Self::Linear | Self::Stressed(_) => linear,
            Self::GreenLagrange => [
                h[0].fma(s[0], h[1].fma(s[2], linear[0])),
                h[0].fma(s[2], h[1].fma(s[1], linear[1])),
                h[2].fma(s[0], h[3].fma(s[2], linear[2])),
                h[2].fma(s[2], h[3].fma(s[1], linear[3])),
            ],
            Self::Logarithmic => hencky::pull(h, s),
        }
    }

    /// Tangent `dP/dH = (dE/dH)^T D (dE/dH) + S : d2E/dH2`, symmetric.
    #[inline(always)]
    pub fn tangent<T: Real>(self, h: &[T; 4], s: &[T; 3], d: &Mat<T, 3>) -> Mat<T, 4> {
        let rest = [T::zero(); 4];
        let h = if self.is_stressed() { &rest } else { h };
        match self.finite() {
            Self::Linear | Self::Stressed(_) => {
                // Row of the strain that each gradient component feeds.
                const ROW: [usize; 4] = [0, 2, 2, 1];
                let mut a = [[T::zero(); 4]; 4];
                for i in 0..4 {
                    for j in 0..4 {
                        a[i][j] = d[ROW[i]][ROW[j]];
                    }
                }
                a
            }
            Self::GreenLagrange => {
                let (f0, f3) = (h[0] + T::one(), h[3] + T::one());
                let o = T::zero();
                let de = [[f0, o, h[2], o], [o, h[1], o, f3], [h[1], f0, f3, h[2]]];
                let geometric = [[s[0], s[2], o, o], [s[2], s[1], o, o]];
                let mut a = [[o; 4]; 4];
                for j in 0..4 {
                    let mut t = [o; 3];
                    for r in 0..3 {
                        for q in 0..3 {
                            t[r] = d[r][q].fma(de[q][j], t[r]);
                        }
                    }
                    for i in 0..=j {
                        for r in 0..3 {
                            a[i][j] = de[r][i].fma(t[r], a[i][j]);
                        }
                        a[j][i] = a[i][j];
                    }
                }
                for i in 0..2 {
                    for j in 0..2 {
                        a[i][j] += geometric[i][j];
                        a[i + 2][j + 2] += geometric[i][j];
                    }
                }
                a
            }
            Self::Logarithmic => hencky::tangent(h, s, d),
        }
    }

    /// Volume strain (the trace in the plane) with its derivative by the gradient; of the
    /// logarithmic strain `ln det F`.
    #[inline(always)]
    pub fn volume<T: Real>(self, h: &[T; 4]) -> (T, [T; 4]) {
        let (o, one) = (T::zero(), T::one());
        let e = self.strain(h);
        let slope = match self {
            Self::Linear | Self::Stressed(_) => [one, o, o, one],
            Self::GreenLagrange => [h[0] + one, h[1], h[2], h[3] + one],
            Self::Logarithmic => {
                let r = det(h).recip();
                [(h[3] + one) * r, -h[2] * r, -h[1] * r, (h[0] + one) * r]
            }
        };
        (e[0] + e[1], slope)
    }

    /// Second derivative of the volume strain.
    #[inline(always)]
    pub fn volume_curvature<T: Real>(self, h: &[T; 4]) -> Mat<T, 4> {
        let rest = [T::zero(); 4];
        let h = if self.is_stressed() { &rest } else { h };
        let mut a = [[T::zero(); 4]; 4];
        match self.finite() {
            Self::Linear | Self::Stressed(_) => {}
            Self::GreenLagrange => {
                for i in 0..4 {
                    a[i][i] = T::one();
                }
            }
            Self::Logarithmic => {
                let (slope, r) = (Self::Logarithmic.volume(h).1, det(h).recip());
                for i in 0..4 {
                    for j in 0..4 {
                        a[i][j] = -(slope[i] * slope[j]);
                    }
                    a[i][3 - i] += if i % 3 == 0 { r } else { -r };
                }
            }
        }
        a
    }

    /// Hoop strain of the stretch less one, `w`, with its first and second derivatives.
    #[inline(always)]
    pub fn hoop<T: Real>(self, w: T) -> [T; 3] {
        let (o, one) = (T::zero(), T::one());
        match self {
            Self::Linear => [w, one, o],
            Self::Stressed(Finite::GreenLagrange) => [w, one, one],
            Self::Stressed(Finite::Logarithmic) => [w, one, -one],
            Self::GreenLagrange => [(w * w).fma(T::real(0.5), w), one + w, one],
            Self::Logarithmic => {
                let slope = (one + w).recip();
                [hencky::log1p(w), slope, -(slope * slope)]
            }
        }
    }

    /// Stretch of the thickness that belongs to its strain.
    pub fn stretch(self, strain_zz: f64) -> f64 {
        match self {
            Self::Linear | Self::Stressed(_) => 1.0 + strain_zz,
            Self::GreenLagrange => (1.0 + 2.0 * strain_zz).max(0.0).sqrt(),
            Self::Logarithmic => strain_zz.exp(),
        }
    }

    /// Cosine and sine of the rotation in the local gradient (polar decomposition) that takes this
    /// strain to the axes of the local frame; the linear strain has those axes already.
    pub fn rotation(self, h: &[f64; 4]) -> [f64; 2] {
        match self {
            Self::Linear | Self::Stressed(_) => [1.0, 0.0],
            Self::GreenLagrange | Self::Logarithmic => {
                let (c, s) = (2.0 + h[0] + h[3], h[2] - h[1]);
                let size = c.hypot(s);
                [c / size, s / size]
            }
        }
    }

    /// Cauchy stress xx, yy, zz, xy in the axes of the local frame, from the stress conjugate
    /// to this strain, the stress through the thickness and the thickness stretch.
    pub fn cauchy(self, h: &[f64; 4], s: [f64; 3], zz: f64, stretch: f64) -> [f64; 4] {
        let (second, zz) = match self {
            Self::Linear | Self::Stressed(_) => return [s[0], s[1], zz, s[2]],
            Self::GreenLagrange => (s, zz * stretch * stretch),
            Self::Logarithmic => (hencky::second_piola(h, &s), zz),
        };
        let f = [[1.0 + h[0], h[1]], [h[2], 1.0 + h[3]]];
        let det = det(h) * stretch;
        let m = [[second[0], second[2]], [second[2], second[1]]];
        let mut c = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                for p in 0..2 {
                    for q in 0..2 {
                        c[i][j] += f[i][p] * m[p][q] * f[j][q] / det;
                    }
                }
            }
        }
        [c[0][0], c[1][1], zz / det, c[0][1]]
    }
}

/// Determinant of the deformation gradient.
#[inline(always)]
pub fn det<T: Real>(h: &[T; 4]) -> T {
    (h[0] + T::one()) * (h[3] + T::one()) - h[1] * h[2]
}
