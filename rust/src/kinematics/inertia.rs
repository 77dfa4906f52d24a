//! Inertia, written once for every element (consistent co-rotational dynamics: Le, Battini &
//! Hjiaj 2011; Cho et al. 2017).
//!
//! A point of an element is at `x = sum N_i x_i + sum M_k y_k`: the nodes, and for drilling
//! elements and beams the bulges of the edges `y_k = (phi_k - phi_k+1) R s_k` that ride with the element
//! frame. In the positions (x, y) the kinetic energy has a constant matrix; all that depends on
//! the configuration is the map from the dofs to y. With `eta_i = R X_i` (centroidal),
//! `D = sum eta . x` and `gamma = S eta / D` the frame turns with
//!
//! ```text
//! theta'  = gamma . u'          theta'' = gamma . u'' - 2 theta' D' / D,  D' = eta . u'
//! ```
//!
//! and every variation of these is a combination of the rows gamma and eta. Elements without
//! drilling rotations keep the constant matrix of the shape functions exactly.
// SPDX-License-Identifier: BSD-3-Clause

use super::kernels::Kernels;
use crate::base::Real;
use crate::base::small::{Blocks, Nodal, blocks, nodal};
use crate::elements::{Point, shapes};

/// How the mass is distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassKind {
    /// From the co-rotational kinematics, with gyroscopic and centrifugal terms.
    Consistent,
    /// The same matrix at rest without the coupling of translations and rotations, which is
    /// what makes it independent of the configuration.
    Constant,
    /// Diagonal: row sums for linear elements, scaled diagonals (Hinton, Rock & Zienkiewicz
    /// 1976) for quadratic ones and for rotations.
    Lumped,
}

impl MassKind {
    pub const NAMES: &'static [&'static str] = &["consistent", "constant", "lumped"];

    pub fn new(name: &str) -> Result<Self, String> {
        match name {
            "consistent" => Ok(Self::Consistent),
            "constant" => Ok(Self::Constant),
            "lumped" => Ok(Self::Lumped),
            _ => Err(format!("no mass {name:?}; there are {:?}", Self::NAMES)),
        }
    }
}

/// Matrix of the kinetic energy in nodes and edge bulges.
pub struct Mass<T, const N: usize> {
    /// Node with node, node with edge, edge with edge.
    pub nn: [[T; N]; N],
    pub ne: [[T; N]; N],
    pub ee: [[T; N]; N],
    /// Rotation with rotation, of line elements.
    pub rr: [[T; N]; N],
    /// Bulge of edge (k, k + 1) on the reference for a unit difference of its rotations.
    pub s: [[T; 2]; N],
}

impl<T: Real, const N: usize> Mass<T, N> {
    /// Give the nodes rotary inertia: a line's mass times the square of the cross-section's
    /// radius of gyration.
    pub fn turn_with(&mut self, gyration2: f64) {
        for a in 0..N {
            for b in 0..N {
                self.rr[a][b] = self.nn[a][b].scale(gyration2);
            }
        }
    }

    /// Diagonal translations: row sums while they are positive, else the scaled diagonal.
    #[inline(always)]
    fn lump(&mut self, _points: usize) {
        let (mut total, mut trace) = (T::zero(), T::zero());
        for a in 0..N {
            trace += self.nn[a][a];
            for b in 0..N {
                total += self.nn[a][b];
            }
        }
        let scale = total / trace;
        let mut diagonal = [T::zero(); N];
        for a in 0..N {
            if N <= 4 {
                for b in 0..N {
                    diagonal[a] += self.nn[a][b];
                }
            } else {
                diagonal[a] = self.nn[a][a] * scale;
            }
        }
        self.nn = [[T::zero(); N]; N];
        for a in 0..N {
            self.nn[a][a] = diagonal[a];
        }
    }

    /// Matrix of the rotations alone, which a turn of the frame does not change; lumped to its
    /// diagonal on request.
    #[inline(always)]
    pub fn rotations(&self, lumped: bool) -> [[T; N]; N] {
        let mut m = self.rr;
        for k in 0..N {
            for l in 0..N {
                let v = self.ee[k][l] * (self.s[k][0] * self.s[l][0] + self.s[k][1] * self.s[l][1]);
                // The bulge of edge k follows phi_k - phi_(k+1).
                let (k1, l1) = ((k + 1) % N, (l + 1) % N);
                m[k][l] += v;
                m[k1][l1] += v;
                m[k][l1] -= v;
                m[k1][l] -= v;
            }
        }
        if lumped {
            for k in 0..N {
                for l in 0..N {
                    if k != l {
                        m[k][l] = T::zero();
                    }
                }
            }
        }
        m
    }

    /// The constant matrix of `Constant` and `Lumped` (and of `Consistent` without drilling),
    /// blocks `a <= b`.
    #[inline(always)]
    pub fn matrix<const M: usize>(&self, lumped: bool) -> Blocks<T, N, M> {
        let mut k = blocks::<T, N, M>();
        let turn = if M == 3 { self.rotations(lumped) } else { [[T::zero(); N]; N] };
        for a in 0..N {
            for b in a..N {
                for i in 0..2 {
                    k[a][b][i][i] = self.nn[a][b];
                }
                if M == 3 {
                    k[a][b][M - 1][M - 1] = turn[a][b];
                }
            }
        }
        k
    }
}

/// How the other nodes carry the mass of an element's `light` nodes: row per node. The affine
/// extrapolation of least norm where the others allow one, so that total mass, momentum and,
/// as far as it goes, the motion of a rigid body stay; else their mean.
pub fn carriers<const N: usize>(x: &Nodal<f64, N, 2>, light: &[bool; N]) -> [[f64; N]; N] {
    let count = light.iter().filter(|&&l| !l).count() as f64;
    let mut rows = [[0.0; N]; N];
    let mut mean = [0.0; 2];
    for n in (0..N).filter(|&n| !light[n]) {
        mean = [mean[0] + x[n][0] / count, mean[1] + x[n][1] / count];
    }
    let from_mean = |n: usize| [x[n][0] - mean[0], x[n][1] - mean[1]];
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for n in (0..N).filter(|&n| !light[n]) {
        let r = from_mean(n);
        xx += r[0] * r[0];
        xy += r[0] * r[1];
        yy += r[1] * r[1];
    }
    // Principal directions of the carriers; one without extent extrapolates nothing.
    let (half, radius) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (sin, cos) = angle.sin_cos();
    let axes = [(half + radius, [cos, sin]), (half - radius, [-sin, cos])];
    for s in 0..N {
        if !light[s] {
            rows[s][s] = 1.0;
            continue;
        }
        let reach = from_mean(s);
        for n in (0..N).filter(|&n| !light[n]) {
            rows[s][n] = 1.0 / count;
            let r = from_mean(n);
            for (size, d) in axes {
                if size > 1e-2 * half {
                    let along = |v: [f64; 2]| v[0] * d[0] + v[1] * d[1];
                    rows[s][n] += along(reach) * along(r) / size;
                }
            }
        }
    }
    rows
}

impl<const N: usize> Mass<f64, N> {
    /// `rho_t` gives the mass per area (of line elements, per length) at a point.
    pub fn new<const M: usize>(
        x: &Nodal<f64, N, 2>,
        points: &[Point<N>],
        rho_t: impl Fn(&Point<N>) -> f64,
        kernels: &Kernels<N, M>,
        sides: &[f64; N],
        kind: MassKind,
    ) -> Self {
        let o = 0.0;
        let mut m = Self {
            nn: [[o; N]; N],
            ne: [[o; N]; N],
            ee: [[o; N]; N],
            rr: [[o; N]; N],
            s: [[o; 2]; N],
        };
        for p in points {
            let w = (kernels.measure)(x, p) * rho_t(p);
            let sides = if M == 3 { (kernels.sides)(p.xi) } else { [0.0; N] };
            for a in 0..N {
                for b in 0..N {
                    m.nn[a][b] = w.fma(p.n[a] * p.n[b], m.nn[a][b]);
                    if M == 3 {
                        m.ne[a][b] = w.fma(p.n[a] * sides[b], m.ne[a][b]);
                        m.ee[a][b] = w.fma(sides[a] * sides[b], m.ee[a][b]);
                    }
                }
            }
        }
        if M == 3 {
            for k in 0..N {
                // The displacement is quadratic on an edge even where the share exceeds one.
                m.s[k] = shapes::edge_bulge(x, k).map(|v| v * sides[k].min(1.0));
            }
        }
        if kind != MassKind::Consistent {
            m.ne = [[o; N]; N];
        }
        if kind == MassKind::Lumped {
            m.lump(points.len());
        }
        m
    }

    /// Multiply with a factor.
    pub fn scale(&mut self, factor: f64) {
        for part in [&mut self.nn, &mut self.ne, &mut self.ee, &mut self.rr] {
            for value in part.as_flattened_mut() {
                *value *= factor;
            }
        }
    }

    /// Take the mass of `light` nodes away and let the other nodes of the element carry it
    /// (mass redistribution: Khenous, Laborde & Renard 2008). An element of light nodes alone
    /// keeps its mass. It is a matrix of the kinetic energy as before, so every conservation
    /// law that held still does.
    pub fn carry(&mut self, x: &Nodal<f64, N, 2>, light: &[bool; N], lumped: bool) {
        if light.iter().all(|&l| l) || !light.iter().any(|&l| l) {
            return;
        }
        let p = carriers(x, light);
        if lumped {
            let count = light.iter().filter(|&&l| !l).count() as f64;
            for s in (0..N).filter(|&s| light[s]) {
                let share = self.nn[s][s] / count;
                self.nn[s][s] = 0.0;
                for n in (0..N).filter(|&n| !light[n]) {
                    self.nn[n][n] += share;
                }
            }
            return;
        }
        let (nn, ne) = (self.nn, self.ne);
        self.nn = [[0.0; N]; N];
        self.ne = [[0.0; N]; N];
        for a in 0..N {
            for b in 0..N {
                for s in 0..N {
                    self.ne[a][b] += p[s][a] * ne[s][b];
                    for t in 0..N {
                        self.nn[a][b] += p[s][a] * nn[s][t] * p[t][b];
                    }
                }
            }
        }
    }
}

/// Frame of an element as the inertia sees it.
pub struct Spin<T, const N: usize> {
    /// `S eta / D` and `eta`.
    pub gamma: [[T; 2]; N],
    pub eta: [[T; 2]; N],
    pub d: T,
    /// `R s_k` and `S R s_k`.
    pub w: [[T; 2]; N],
    pub sw: [[T; 2]; N],
}

impl<T: Real, const N: usize> Spin<T, N> {
    /// From the reference positions, the displacements and the bulges at rest.
    #[inline(always)]
    pub fn new<const M: usize>(x: &Nodal<T, N, 2>, u: &Nodal<T, N, M>, s: &[[T; 2]; N]) -> Self {
        let share = T::real(1.0 / N as f64);
        let mut mean = [T::zero(); 2];
        for n in 0..N {
            for i in 0..2 {
                mean[i] = x[n][i].fma(share, mean[i]);
            }
        }
        let (mut along, mut across) = (T::zero(), T::zero());
        for n in 0..N {
            let r = [x[n][0] - mean[0], x[n][1] - mean[1]];
            // sum X is zero, so the mean of u drops out.
            let c = [r[0] + u[n][0], r[1] + u[n][1]];
            along = r[0].fma(c[0], r[1].fma(c[1], along));
            across = r[0].fma(c[1], across) - r[1] * c[0];
        }
        let d = along.fma(along, across * across).sqrt();
        let (cos, sin) = (along / d, across / d);
        let turn = |v: [T; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let o = [T::zero(); 2];
        let (mut gamma, mut eta, mut w, mut sw) = ([o; N], [o; N], [o; N], [o; N]);
        for n in 0..N {
            eta[n] = turn([x[n][0] - mean[0], x[n][1] - mean[1]]);
            gamma[n] = [-eta[n][1] / d, eta[n][0] / d];
            w[n] = turn(s[n]);
            sw[n] = [-w[n][1], w[n][0]];
        }
        Self { gamma, eta, d, w, sw }
    }
}

/// `sum_n a_n . v_n` over translations.
#[inline(always)]
fn sum<T: Real, const N: usize, const M: usize>(a: &[[T; 2]; N], v: &Nodal<T, N, M>) -> T {
    let mut s = T::zero();
    for n in 0..N {
        s = a[n][0].fma(v[n][0], a[n][1].fma(v[n][1], s));
    }
    s
}

/// Velocities of the edge bulges.
#[inline(always)]
pub fn bulge_rates<T: Real, const N: usize, const M: usize>(
    spin: &Spin<T, N>,
    u: &Nodal<T, N, M>,
    v: &Nodal<T, N, M>,
) -> [[T; 2]; N] {
    let rate = sum(&spin.gamma, v);
    let mut y = [[T::zero(); 2]; N];
    for k in 0..N {
        let k1 = (k + 1) % N;
        let p = u[k][M - 1] - u[k1][M - 1];
        let dp = v[k][M - 1] - v[k1][M - 1];
        for i in 0..2 {
            y[k][i] = dp.fma(spin.w[k][i], p * rate * spin.sw[k][i]);
        }
    }
    y
}

/// Inertia force of the consistent mass, and the symmetric part of
/// `c_u df/du + c_v df/dv + c_a df/da` (blocks `a <= b`), which Newton's method uses.
#[inline(always)]
pub fn consistent<T: Real, const N: usize, const M: usize>(
    mass: &Mass<T, N>,
    x: &Nodal<T, N, 2>,
    u: &Nodal<T, N, M>,
    v: &Nodal<T, N, M>,
    a: &Nodal<T, N, M>,
    c: [f64; 3],
) -> (Nodal<T, N, M>, Blocks<T, N, M>) {
    let (f, k) = with_tangent(mass, x, u, v, a, c);
    let mut upper = blocks::<T, N, M>();
    for p in 0..N {
        for q in p..N {
            for i in 0..M {
                for j in 0..M {
                    upper[p][q][i][j] = (k[p][q][i][j] + k[q][p][j][i]).scale(0.5);
                }
            }
        }
    }
    (f, upper)
}

/// Inertia force of the consistent mass and its exact, unsymmetric derivative
/// `c_u df/du + c_v df/dv + c_a df/da` in all blocks.
#[inline(always)]
pub fn with_tangent<T: Real, const N: usize, const M: usize>(
    mass: &Mass<T, N>,
    x: &Nodal<T, N, 2>,
    u: &Nodal<T, N, M>,
    v: &Nodal<T, N, M>,
    a: &Nodal<T, N, M>,
    [cu, cv, ca]: [f64; 3],
) -> (Nodal<T, N, M>, Blocks<T, N, M>) {
    let o = T::zero();
    let mut f = nodal::<T, N, M>();
    let mut k = blocks::<T, N, M>();
    for p in 0..N {
        for q in 0..N {
            for i in 0..2 {
                f[p][i] = mass.nn[p][q].fma(a[q][i], f[p][i]);
                k[p][q][i][i] = mass.nn[p][q].scale(ca);
            }
        }
    }
    if M == 2 {
        return (f, k);
    }
    for p in 0..N {
        for q in 0..N {
            f[p][M - 1] = mass.rr[p][q].fma(a[q][M - 1], f[p][M - 1]);
            k[p][q][M - 1][M - 1] = mass.rr[p][q].scale(ca);
        }
    }
    let spin = Spin::new(x, u, &mass.s);
    let (gamma, eta) = (&spin.gamma, &spin.eta);
    let inv_d = spin.d.recip();
    let rate = sum(gamma, v); // theta'
    let stretch = sum(eta, v) * inv_d; // D' / D
    let two = T::real(2.0);
    let (gamma_a, eta_a) = (sum(gamma, a), sum(eta, a) * inv_d);
    let accel = gamma_a - two * rate * stretch; // theta''
    // Variations as combinations p gamma + q eta / D of the rows.
    // rate: c_v gamma - c_u (D'/D) gamma - c_u theta' eta / D
    let rate_g = T::real(cv) - stretch.scale(cu);
    let rate_e = rate.scale(-cu);
    // D'/D: (c_v eta + c_u D theta' gamma) / D - c_u (D'/D) eta / D
    let stretch_g = rate.scale(cu);
    let stretch_e = T::real(cv) - stretch.scale(cu);
    let accel_g = T::real(ca) - eta_a.scale(cu) - two * (stretch * rate_g + rate * stretch_g);
    let accel_e = gamma_a.scale(-cu) - two * (stretch * rate_e + rate * stretch_e);

    // Accelerations of the bulges and their variations: rows on gamma, eta / D and the
    // difference of the end rotations.
    let z = [[o; 2]; N];
    let (mut y, mut y_g, mut y_e, mut y_p) = (z, z, z, z);
    let mut differ = [o; N];
    for e in 0..N {
        let next = (e + 1) % N;
        let p = u[e][M - 1] - u[next][M - 1];
        let dp = v[e][M - 1] - v[next][M - 1];
        let ddp = a[e][M - 1] - a[next][M - 1];
        differ[e] = p;
        let (w, sw) = (&spin.w[e], &spin.sw[e]);
        // y'' = A w + B S w
        let big_a = ddp - p * rate * rate;
        let big_b = two * dp * rate + p * accel;
        for i in 0..2 {
            y[e][i] = big_a.fma(w[i], big_b * sw[i]);
        }
        let a_p = T::real(ca) - (rate * rate).scale(cu);
        let b_p = rate.scale(2.0 * cv) + accel.scale(cu);
        let a_rate = -two * p * rate;
        let b_rate = two * dp;
        for i in 0..2 {
            y_p[e][i] = a_p.fma(w[i], b_p * sw[i]);
            // Turning of w and S w: A S w - B w, on c_u gamma.
            let turned = big_a.fma(sw[i], -(big_b * w[i])).scale(cu);
            y_g[e][i] = turned + (a_rate * rate_g) * w[i] + (b_rate * rate_g + p * accel_g) * sw[i];
            y_e[e][i] = (a_rate * rate_e) * w[i] + (b_rate * rate_e + p * accel_e) * sw[i];
        }
    }
    // Forces on nodes and on bulges.
    let mut on_edge = z;
    for e in 0..N {
        for n in 0..N {
            for i in 0..2 {
                f[n][i] = mass.ne[n][e].fma(y[e][i], f[n][i]);
                on_edge[e][i] = mass.ne[n][e].fma(a[n][i], on_edge[e][i]);
                on_edge[e][i] = mass.ee[e][n].fma(y[n][i], on_edge[e][i]);
            }
        }
    }
    // What turns the frame: Q = sum p (S w . G), along gamma.
    let mut couple = o;
    let mut couple_w = o;
    for e in 0..N {
        let sw_g = spin.sw[e][0] * on_edge[e][0] + spin.sw[e][1] * on_edge[e][1];
        let w_g = spin.w[e][0] * on_edge[e][0] + spin.w[e][1] * on_edge[e][1];
        couple = differ[e].fma(sw_g, couple);
        couple_w = differ[e].fma(w_g, couple_w);
        let next = (e + 1) % N;
        f[e][M - 1] += w_g;
        f[next][M - 1] -= w_g;
    }
    for n in 0..N {
        for i in 0..2 {
            f[n][i] = gamma[n][i].fma(couple, f[n][i]);
        }
    }

    // Columns of the tangent.
    for q in 0..N {
        for j in 0..M {
            let (g, h, p_of) = if j < 2 {
                (gamma[q][j], eta[q][j] * inv_d, [o; N])
            } else {
                let mut p_of = [o; N];
                p_of[q] += T::one();
                p_of[(q + N - 1) % N] -= T::one();
                (o, o, p_of)
            };
            let mut dy = z;
            let mut d_edge = z;
            for e in 0..N {
                for i in 0..2 {
                    dy[e][i] = y_g[e][i] * g + y_e[e][i] * h + y_p[e][i] * p_of[e];
                }
            }
            for e in 0..N {
                for i in 0..2 {
                    for n in 0..N {
                        k[n][q][i][j] = mass.ne[n][e].fma(dy[e][i], k[n][q][i][j]);
                        d_edge[e][i] = mass.ee[e][n].fma(dy[n][i], d_edge[e][i]);
                    }
                    if i == j {
                        d_edge[e][i] += mass.ne[q][e].scale(ca);
                    }
                }
            }
            let mut d_couple = (couple_w * g).scale(-cu);
            for e in 0..N {
                let (w, sw) = (&spin.w[e], &spin.sw[e]);
                let sw_g = sw[0] * on_edge[e][0] + sw[1] * on_edge[e][1];
                let sw_dg = sw[0] * d_edge[e][0] + sw[1] * d_edge[e][1];
                d_couple += (sw_g * p_of[e]).scale(cu) + differ[e] * sw_dg;
                let dw_g = w[0] * d_edge[e][0] + w[1] * d_edge[e][1] + (sw_g * g).scale(cu);
                let next = (e + 1) % N;
                k[e][q][M - 1][j] += dw_g;
                k[next][q][M - 1][j] -= dw_g;
            }
            for n in 0..N {
                for i in 0..2 {
                    // d gamma = -(eta / D) gamma_q - gamma (eta_q / D)
                    let eta_n = eta[n][i] * inv_d;
                    let turned = (eta_n * g + gamma[n][i] * h) * couple;
                    k[n][q][i][j] += gamma[n][i] * d_couple - turned.scale(cu);
                }
            }
        }
    }
    (f, k)
}
