//! The energy-momentum step: internal and inertia forces between two configurations that
//! conserve linear and angular momentum exactly and, in the elastic range, energy.
//!
//! All maps of the co-rotational kinematics have exact discrete derivatives at the mid-point.
//! With `R = (R0 + R1) / 2`, `eta = R X`, `x = (x0 + x1) / 2` (centroidal),
//! `Gamma = S eta / sum(eta . x)` and `tau = Gamma . du = 2 tan(dtheta / 2)`:
//!
//! - local displacements: `dd = R^T (dx - tau S x)`;
//! - local rotations: `dtheta_L = kappa (psi - tau)` with `psi = 2 tan(dphi / 2)`, the
//!   increment that moments do work on, and kappa from the addition theorem of the tangent;
//! - edge bulges: `dy = (1 + tau^2 / 4) w d(phi_a - phi_b) + tau S y`, `w = R s`.
//!
//! Each sends a rigid turn about the mid-point configuration to a rigid turn, so forces built
//! with their transposes have no resultant and no moment, and their work is the difference of
//! the energies when the local force is the mean one (linear laws) or a discrete gradient
//! (Gonzalez 1996). In plastic flow the energy is the recoverable one and the plastic work of the
//! return map (Meng and Laursen 2002), and the mean force is taken along the increment: that of
//! both ends would miss half the work of an increment that begins elastic and ends in flow.
//! Velocities follow the mid-point rule; those of the bulges are carried.
// SPDX-License-Identifier: BSD-3-Clause

use super::corotation::Frame;
use super::inertia::{Mass, MassKind};
use super::integrate::{History, Local, Section, flowed};
use super::kernels::Kernels;
use crate::base::small::{Blocks, Nodal, blocks, nodal};
use crate::elements::element::Wanted;
use crate::materials::Clock;

/// Points of Gauss's rule on the increment and their weights.
const ALONG: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Where the step starts and what it is.
pub struct Step<'a, const N: usize, const M: usize> {
    pub u0: &'a Nodal<f64, N, M>,
    pub v0: &'a Nodal<f64, N, M>,
    pub u1: &'a Nodal<f64, N, M>,
    pub dt: f64,
    pub nlgeom: bool,
    pub tangent: bool,
}

/// Discrete kinematics between two configurations.
struct Between<const N: usize> {
    /// Mean rotation matrix, entries cos and sin (shorter than 1 by the turn).
    c: f64,
    s: f64,
    tau: f64,
    gamma: [[f64; 2]; N],
    /// `S x` of the centroidal mid-point positions.
    sx: [[f64; 2]; N],
    psi: [f64; N],
}

/// `atan(z) / z`.
fn atanc(z: f64) -> f64 {
    if z.abs() < 1e-4 { 1.0 - z * z / 3.0 + z * z * z * z / 5.0 } else { z.atan() / z }
}

/// Factor between a difference of angles and the difference of their doubled half tangents.
fn kappa(psi: f64, tau: f64) -> f64 {
    let d = 1.0 + 0.25 * psi * tau;
    atanc(0.5 * (psi - tau) / d) / d
}

impl<const N: usize> Between<N> {
    fn new<const M: usize>(
        x: &Nodal<f64, N, 2>,
        step: &Step<'_, N, M>,
        f0: &Frame<f64, N, M>,
        f1: &Frame<f64, N, M>,
    ) -> Self {
        let (c, s) = (0.5 * (f0.cos + f1.cos), 0.5 * (f0.sin + f1.sin));
        let mut b = Self { c, s, tau: 0.0, gamma: [[0.0; 2]; N], sx: [[0.0; 2]; N], psi: [0.0; N] };
        if M == 3 {
            for n in 0..N {
                let dphi = step.u1[n][M - 1] - step.u0[n][M - 1];
                b.psi[n] = if step.nlgeom { 2.0 * (0.5 * dphi).tan() } else { dphi };
            }
        }
        if !step.nlgeom {
            return b;
        }
        let (mut mean_x, mut mean_u) = ([0.0; 2], [0.0; 2]);
        for n in 0..N {
            for i in 0..2 {
                mean_x[i] += x[n][i] / N as f64;
                mean_u[i] += 0.5 * (step.u0[n][i] + step.u1[n][i]) / N as f64;
            }
        }
        let mut d = 0.0;
        let mut eta = [[0.0; 2]; N];
        for n in 0..N {
            let r = [x[n][0] - mean_x[0], x[n][1] - mean_x[1]];
            let mut m = r;
            for i in 0..2 {
                m[i] += 0.5 * (step.u0[n][i] + step.u1[n][i]) - mean_u[i];
            }
            eta[n] = [c * r[0] - s * r[1], s * r[0] + c * r[1]];
            d += eta[n][0] * m[0] + eta[n][1] * m[1];
            b.sx[n] = [-m[1], m[0]];
        }
        for n in 0..N {
            b.gamma[n] = [-eta[n][1] / d, eta[n][0] / d];
            for i in 0..2 {
                b.tau += b.gamma[n][i] * (step.u1[n][i] - step.u0[n][i]);
            }
        }
        b
    }

    fn turn(&self, v: [f64; 2]) -> [f64; 2] {
        [self.c * v[0] - self.s * v[1], self.s * v[0] + self.c * v[1]]
    }

    /// Global force from a mean local one.
    fn force<const M: usize>(&self, local: &Nodal<f64, N, M>) -> Nodal<f64, N, M> {
        let mut f = *local;
        let mut moment = 0.0;
        for n in 0..N {
            let v = self.turn([local[n][0], local[n][1]]);
            f[n][0] = v[0];
            f[n][1] = v[1];
            moment += self.sx[n][0] * v[0] + self.sx[n][1] * v[1];
            if M == 3 {
                f[n][M - 1] = kappa(self.psi[n], self.tau) * local[n][M - 1];
                moment += f[n][M - 1];
            }
        }
        for n in 0..N {
            for i in 0..2 {
                f[n][i] -= self.gamma[n][i] * moment;
            }
        }
        f
    }
}

/// Answer for one element.
pub struct Answer<const N: usize, const M: usize> {
    /// Internal force, conjugate to displacements and `psi`.
    pub internal: Nodal<f64, N, M>,
    pub inertia: Nodal<f64, N, M>,
    /// Symmetric approximation of the derivative of both, blocks `a <= b`.
    pub tangent: Blocks<f64, N, M>,
    pub failed: bool,
}

/// Internal and inertia force of an element between `u0` and `u1`. `rates` are the carried
/// velocities of the bulges: those at the start, and those at the end, which are written.
pub fn element<const N: usize, const M: usize>(
    kernels: &Kernels<N, M>,
    x: &Nodal<f64, N, 2>,
    section: &Section<N>,
    history: &mut History<'_>,
    mass: (&Mass<f64, N>, MassKind),
    step: &Step<'_, N, M>,
    rates: (&[[f64; 2]; N], &mut [[f64; 2]; N]),
) -> Answer<N, M> {
    let Some((local_into, absorbed_at)) = kernels.in_frame else {
        return ring(kernels, x, section, history, mass, step);
    };
    let local = |x: &_, q: &_, section: &_, history: &mut History<'_>, tangent| {
        let mut out = Local::zero();
        local_into(x, q, section, history, tangent, &mut out);
        out
    };
    let f0 = Frame::new(x, step.u0, step.nlgeom);
    let f1 = Frame::new(x, step.u1, step.nlgeom);
    // Linear in all: the energy is quadratic, and the mean force of both ends exact.
    let curved = !(section.law.is_linear() && section.strain.is_linear());
    // A law with a history and no account of its work has the mean force only.
    let accounts = section.law.n_state() == 0 || section.law.work_member().is_some();
    let clock = history.clock;
    history.clock = passed(clock, 0.0);
    let begin = local(x, &f0.q, section, history, false);
    let mut energy = [0.0; 2];
    if curved && accounts {
        energy[0] = absorbed_at(x, &f0.q, section, history);
    }
    history.clock = clock;
    let mut end = local(x, &f1.q, section, history, step.tangent);
    let mut failed = begin.failed | end.failed;
    let mut mean = nodal::<f64, N, M>();
    let flows = flowed(section, history);
    if flows && accounts {
        end.stiffness = blocks::<f64, N, M>();
        for (s, weight) in ALONG {
            let q = between_ends(&f0.q, &f1.q, s);
            history.clock = passed(clock, s);
            let at = local(x, &q, section, history, step.tangent);
            failed |= at.failed;
            for a in 0..N {
                for i in 0..M {
                    mean[a][i] += weight * at.force[a][i];
                }
                for b in a..N {
                    for i in 0..M {
                        for j in 0..M {
                            // Twice the derivative of the mean, as below.
                            end.stiffness[a][b][i][j] +=
                                2.0 * weight * s * at.stiffness[a][b][i][j];
                        }
                    }
                }
            }
        }
        // The history is that of the end again.
        history.clock = clock;
        local(x, &f1.q, section, history, false);
    } else {
        for n in 0..N {
            for i in 0..M {
                mean[n][i] = 0.5 * (begin.force[n][i] + end.force[n][i]);
            }
        }
    }
    let quadratic = section.law.n_state() > 0 && !flows && section.strain.is_linear();
    if curved && accounts && !quadratic {
        energy[1] = absorbed_at(x, &f1.q, section, history);
        discrete_gradient(x, [&f0.q, &f1.q], energy, &mut mean);
    }
    let between = Between::new(x, step, &f0, &f1);
    let internal = between.force(&mean);
    let mut tangent = blocks::<f64, N, M>();
    if step.tangent {
        let mut middle = *step.u0;
        for n in 0..N {
            for i in 0..M {
                middle[n][i] = 0.5 * (step.u0[n][i] + step.u1[n][i]);
            }
        }
        let frame = Frame::new(x, &middle, step.nlgeom);
        if step.nlgeom {
            frame.stiffness(&mean, &mut end.stiffness);
        }
        tangent = end.stiffness;
        for v in tangent.as_flattened_mut().as_flattened_mut().as_flattened_mut() {
            *v *= 0.5;
        }
    }
    let inertia = if mass.1 == MassKind::Consistent && M == 3 && !kernels.spring {
        coupled(mass.0, step, &between, [&f0, &f1], rates, &mut tangent)
    } else {
        plain(mass.0, mass.1 == MassKind::Lumped, step, &between, &mut tangent)
    };
    Answer { internal, inertia, tangent, failed }
}

/// [`element`] for a solid of revolution. Of the momenta only that along the axis is conserved,
/// so no turn has to be kept: the force is the mean over the straight line from `u0` to `u1`, and
/// what makes its work the difference of the energies has no resultant along the axis.
fn ring<const N: usize, const M: usize>(
    kernels: &Kernels<N, M>,
    x: &Nodal<f64, N, 2>,
    section: &Section<N>,
    history: &mut History<'_>,
    mass: (&Mass<f64, N>, MassKind),
    step: &Step<'_, N, M>,
) -> Answer<N, M> {
    let accounts = section.law.n_state() == 0 || section.law.work_member().is_some();
    let mut failed = false;
    let mut tangent = blocks::<f64, N, M>();
    let mut internal = nodal::<f64, N, M>();
    let mut energy = [0.0; 2];
    let mut respond = |u: &Nodal<f64, N, M>, history: &mut History<'_>, tangent: bool| {
        let wanted = Wanted { nlgeom: step.nlgeom, stressed: false, tangent };
        let mut answer = Local::zero();
        (kernels.respond)(x, u, section, history, wanted, &mut answer);
        failed |= answer.failed;
        answer
    };
    let clock = history.clock;
    history.clock = passed(clock, 0.0);
    respond(step.u0, history, false);
    if accounts {
        energy[0] = (kernels.absorbed)(x, step.u0, section, history, step.nlgeom);
    }
    for (s, weight) in ALONG {
        history.clock = passed(clock, s);
        let at = respond(&between_ends(step.u0, step.u1, s), history, step.tangent);
        for (to, from) in internal.as_flattened_mut().iter_mut().zip(at.force.as_flattened()) {
            *to += weight * from;
        }
        let all = tangent.as_flattened_mut().as_flattened_mut().as_flattened_mut();
        let part = at.stiffness.as_flattened().as_flattened().as_flattened();
        for (to, from) in all.iter_mut().zip(part) {
            *to += weight * s * from;
        }
    }
    // The history is that of the end again.
    history.clock = clock;
    respond(step.u1, history, false);
    if accounts {
        energy[1] = (kernels.absorbed)(x, step.u1, section, history, step.nlgeom);
        let (mut u0, mut u1) = (*step.u0, *step.u1);
        for u in [&mut u0, &mut u1] {
            let mean = u.iter().map(|v| v[1]).sum::<f64>() / N as f64;
            for v in u {
                v[1] -= mean;
            }
        }
        discrete_gradient(x, [&u0, &u1], energy, &mut internal);
    }
    let frame = Frame::new(x, step.u0, false);
    let between = Between::new(x, step, &frame, &frame);
    let inertia = plain(mass.0, mass.1 == MassKind::Lumped, step, &between, &mut tangent);
    Answer { internal, inertia, tangent, failed }
}

/// The clock at the fraction `s` of the increment.
fn passed(clock: Clock, s: f64) -> Clock {
    let increment = s * clock.increment;
    Clock { increment, end: clock.end - clock.increment + increment, ..clock }
}

/// Local dofs at the fraction `s` of the increment.
fn between_ends<const N: usize, const M: usize>(
    q0: &Nodal<f64, N, M>,
    q1: &Nodal<f64, N, M>,
    s: f64,
) -> Nodal<f64, N, M> {
    std::array::from_fn(|a| std::array::from_fn(|i| (1.0 - s) * q0[a][i] + s * q1[a][i]))
}

/// Add to the mean force what makes its work the difference of the energies.
fn discrete_gradient<const N: usize, const M: usize>(
    x: &Nodal<f64, N, 2>,
    [q0, q1]: [&Nodal<f64, N, M>; 2],
    [v0, v1]: [f64; 2],
    mean: &mut Nodal<f64, N, M>,
) {
    // Rotations count by the size of the element.
    let size2 = (0..N)
        .map(|n| (x[n][0] - x[0][0]).powi(2) + (x[n][1] - x[0][1]).powi(2))
        .fold(0.0, f64::max);
    let weight = |i: usize| if i == 2 { size2 } else { 1.0 };
    let (mut work, mut norm, mut size) = (0.0, 0.0, v0.abs() + v1.abs());
    for n in 0..N {
        for i in 0..M {
            let d = q1[n][i] - q0[n][i];
            work += mean[n][i] * d;
            size += (mean[n][i] * d).abs();
            norm += weight(i) * d * d;
        }
    }
    let defect = v1 - v0 - work;
    if defect.abs() <= 1e-14 * size || norm == 0.0 {
        return;
    }
    for n in 0..N {
        for i in 0..M {
            mean[n][i] += defect / norm * weight(i) * (q1[n][i] - q0[n][i]);
        }
    }
}

/// Inertia force of a constant mass.
fn plain<const N: usize, const M: usize>(
    mass: &Mass<f64, N>,
    lumped: bool,
    step: &Step<'_, N, M>,
    between: &Between<N>,
    tangent: &mut Blocks<f64, N, M>,
) -> Nodal<f64, N, M> {
    let matrix = mass.matrix::<M>(lumped);
    let mut a = nodal::<f64, N, M>();
    for n in 0..N {
        for i in 0..M {
            let d = if i == 2 { between.psi[n] } else { step.u1[n][i] - step.u0[n][i] };
            a[n][i] = 2.0 / step.dt * (d / step.dt - step.v0[n][i]);
        }
    }
    if step.tangent {
        for p in 0..N {
            for q in p..N {
                for i in 0..M {
                    tangent[p][q][i][i] += 2.0 / (step.dt * step.dt) * matrix[p][q][i][i];
                }
            }
        }
    }
    crate::base::small::symmetric_times(&matrix, &a)
}

/// Inertia force of the consistent mass of a drilling element or a beam.
fn coupled<const N: usize, const M: usize>(
    mass: &Mass<f64, N>,
    step: &Step<'_, N, M>,
    between: &Between<N>,
    frames: [&Frame<f64, N, M>; 2],
    (rates, rates_end): (&[[f64; 2]; N], &mut [[f64; 2]; N]),
    tangent: &mut Blocks<f64, N, M>,
) -> Nodal<f64, N, M> {
    let dt = step.dt;
    let bulges = Bulges::new(mass, step, between, frames);
    let mut f = nodal::<f64, N, M>();
    let mut on_edge = [[0.0; 2]; N];
    let acc = |d: f64, v: f64| 2.0 / dt * (d / dt - v);
    for a in 0..N {
        for b in 0..N {
            for i in 0..2 {
                let node = acc(step.u1[b][i] - step.u0[b][i], step.v0[b][i]);
                let edge = acc(bulges.change(b)[i], rates[b][i]);
                f[a][i] += mass.nn[a][b] * node + mass.ne[a][b] * edge;
                on_edge[a][i] += mass.ne[b][a] * node + mass.ee[a][b] * edge;
            }
        }
        for i in 0..2 {
            rates_end[a][i] = 2.0 * bulges.change(a)[i] / dt - rates[a][i];
        }
        for b in 0..N {
            f[a][M - 1] += mass.rr[a][b] * acc(between.psi[b], step.v0[b][M - 1]);
            if step.tangent && b >= a {
                tangent[a][b][M - 1][M - 1] += 2.0 / (dt * dt) * mass.rr[a][b];
            }
        }
    }
    bulges.pass_on(between, &on_edge, &mut f);
    let (s_mean, column) = (bulges.s_mean(), bulges.column);
    if step.tangent {
        coupled_tangent(mass, 2.0 / (dt * dt), between, &s_mean, &column, tangent);
    }
    f
}

/// Mean force between two configurations of the field `at_origin + omega2 x` on the mass
/// (`loads::body`): its work is the exact difference of the field's potential.
pub fn body_force<const N: usize, const M: usize>(
    mass: &Mass<f64, N>,
    x: &Nodal<f64, N, 2>,
    [u0, u1]: [&Nodal<f64, N, M>; 2],
    (at_origin, omega2): ([f64; 2], f64),
) -> Nodal<f64, N, M> {
    let v0 = nodal::<f64, N, M>();
    let step = Step { u0, v0: &v0, u1, dt: 1.0, nlgeom: true, tangent: false };
    let (f0, f1) = (Frame::new(x, u0, true), Frame::new(x, u1, true));
    let between = Between::new(x, &step, &f0, &f1);
    let bulges = Bulges::new(mass, &step, &between, [&f0, &f1]);
    let mut f = nodal::<f64, N, M>();
    let mut on_edge = [[0.0; 2]; N];
    for a in 0..N {
        for b in 0..N {
            for i in 0..2 {
                let place = x[b][i] + 0.5 * (u0[b][i] + u1[b][i]);
                let pull = at_origin[i] + omega2 * place;
                let bulge = 0.5 * omega2 * (bulges.y[0][b][i] + bulges.y[1][b][i]);
                f[a][i] += mass.nn[a][b] * pull + mass.ne[a][b] * bulge;
                on_edge[a][i] += mass.ne[b][a] * pull + mass.ee[a][b] * bulge;
            }
        }
    }
    bulges.pass_on(&between, &on_edge, &mut f);
    f
}

/// Edge bulges at both ends of a step.
struct Bulges<const N: usize> {
    y: [[[f64; 2]; N]; 2],
    /// Column of the discrete derivative for a difference of rotations.
    column: [[f64; 2]; N],
}

impl<const N: usize> Bulges<N> {
    fn new<const M: usize>(
        mass: &Mass<f64, N>,
        step: &Step<'_, N, M>,
        between: &Between<N>,
        frames: [&Frame<f64, N, M>; 2],
    ) -> Self {
        let z = [[0.0; 2]; N];
        let mut own = Self { y: [z, z], column: z };
        for k in 0..N {
            let k1 = (k + 1) % N;
            for (end, (frame, u)) in [(frames[0], step.u0), (frames[1], step.u1)].iter().enumerate()
            {
                let p = u[k][M - 1] - u[k1][M - 1];
                own.y[end][k] = frame.to_global(mass.s[k]).map(|w| p * w);
            }
            let factor = (1.0 + 0.25 * between.tau * between.tau)
                * if step.nlgeom { kappa(between.psi[k], between.psi[k1]) } else { 1.0 };
            own.column[k] = between.turn(mass.s[k]).map(|w| factor * w);
        }
        own
    }

    fn change(&self, k: usize) -> [f64; 2] {
        [self.y[1][k][0] - self.y[0][k][0], self.y[1][k][1] - self.y[0][k][1]]
    }

    /// The mean bulges turned by a right angle.
    fn s_mean(&self) -> [[f64; 2]; N] {
        std::array::from_fn(|k| {
            let [y0, y1] = [self.y[0][k], self.y[1][k]];
            [-0.5 * (y0[1] + y1[1]), 0.5 * (y0[0] + y1[0])]
        })
    }

    /// Add what forces on the bulges give the nodes.
    fn pass_on<const M: usize>(
        &self,
        between: &Between<N>,
        on_edge: &[[f64; 2]; N],
        f: &mut Nodal<f64, N, M>,
    ) {
        let s_mean = self.s_mean();
        let mut couple = 0.0;
        for k in 0..N {
            let k1 = (k + 1) % N;
            couple += s_mean[k][0] * on_edge[k][0] + s_mean[k][1] * on_edge[k][1];
            let moment = self.column[k][0] * on_edge[k][0] + self.column[k][1] * on_edge[k][1];
            f[k][M - 1] += moment;
            f[k1][M - 1] -= moment;
        }
        for n in 0..N {
            for i in 0..2 {
                f[n][i] += between.gamma[n][i] * couple;
            }
        }
    }
}

/// `scale J^T mass J` with the discrete Jacobian J of (x, y).
fn coupled_tangent<const N: usize, const M: usize>(
    mass: &Mass<f64, N>,
    scale: f64,
    between: &Between<N>,
    s_mean: &[[f64; 2]; N],
    column: &[[f64; 2]; N],
    tangent: &mut Blocks<f64, N, M>,
) {
    // Bulges that each dof moves.
    let bulges = |q: usize, j: usize| {
        let mut y = [[0.0; 2]; N];
        if j < 2 {
            for k in 0..N {
                for i in 0..2 {
                    y[k][i] = s_mean[k][i] * between.gamma[q][j];
                }
            }
        } else {
            y[q] = column[q];
            let before = (q + N - 1) % N;
            y[before] = [-column[before][0], -column[before][1]];
        }
        y
    };
    for q in 0..N {
        for j in 0..M {
            let y = bulges(q, j);
            let mut on_node = [[0.0; 2]; N];
            let mut on_edge = [[0.0; 2]; N];
            for a in 0..N {
                for i in 0..2 {
                    if i == j {
                        on_node[a][i] += mass.nn[a][q];
                        on_edge[a][i] += mass.ne[q][a];
                    }
                    for b in 0..N {
                        on_node[a][i] += mass.ne[a][b] * y[b][i];
                        on_edge[a][i] += mass.ee[a][b] * y[b][i];
                    }
                }
            }
            for p in 0..=q {
                for i in 0..M {
                    let own = bulges(p, i);
                    let mut v = if i < 2 { on_node[p][i] } else { 0.0 };
                    for k in 0..N {
                        v += own[k][0] * on_edge[k][0] + own[k][1] * on_edge[k][1];
                    }
                    tangent[p][q][i][j] += scale * v;
                }
            }
        }
    }
}
