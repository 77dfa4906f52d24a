//! Inertia of chunks: forces, effective tangents, constant matrices, momenta.
// SPDX-License-Identifier: BSD-3-Clause

use super::chunk::Context;
use super::chunk_of::ChunkOf;
use super::scatter::Sink;
use crate::base::small::{Nodal, symmetric_times};
use crate::elements::Point;
use crate::kinematics::conserving::{self, Step};
use crate::kinematics::inertia::{Mass, MassKind, Spin, bulge_rates, consistent};
use crate::kinematics::integrate::History;
use crate::kinematics::per_point::PerPoint;
use crate::loads::body::{self, Field};

/// State of motion, and what is wanted of the inertia.
#[derive(Clone, Copy)]
pub struct Motion<'a> {
    pub v: &'a [f64],
    pub a: &'a [f64],
    pub kind: MassKind,
    /// Weights of the derivatives with respect to displacement, velocity, acceleration.
    pub weights: [f64; 3],
}

/// A body force and what is wanted of it.
#[derive(Clone, Copy)]
pub struct BodyLoad<'a> {
    pub field: Field,
    /// Displacements at the start of a conserving step; empty for the force at the end of it.
    pub start: &'a [f64],
    /// The mass that it acts on; none where it is a force per length of lines.
    pub kind: Option<MassKind>,
    /// Factor of the derivative that is added to the tangent.
    pub share: f64,
}

/// The step of the conserving scheme.
#[derive(Clone, Copy)]
pub struct Between<'a> {
    pub u0: &'a [f64],
    pub v0: &'a [f64],
    pub dt: f64,
    pub kind: MassKind,
}

/// Sums over the body: kinetic energy, linear momentum, angular momentum about the origin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Momenta {
    pub kinetic: f64,
    pub linear: [f64; 2],
    pub angular: f64,
    pub mass: f64,
}

/// Value at a point of a field given at the nodes.
fn interpolate<const N: usize>(p: &Point<N>, nodal: &[f64; N]) -> f64 {
    p.n.iter().zip(nodal).map(|(n, v)| n * v).sum()
}

impl<const N: usize, const M: usize> ChunkOf<N, M> {
    fn of_dofs(&self, e: usize, values: &[f64], context: &Context<'_>) -> Nodal<f64, N, M> {
        let mut out = [[0.0; M]; N];
        for a in 0..N {
            let start = context.dofs.start[self.nodes[e][a] as usize] as usize;
            out[a].copy_from_slice(&values[start..start + M]);
        }
        out
    }

    /// Thickness of an element at a point; of lines, the area.
    fn thickness(&self, e: usize, p: &Point<N>) -> f64 {
        let nodal = self.nodal_thickness.get(e);
        nodal.map_or(self.shared.section.thickness, |nodal| interpolate(p, nodal))
    }

    /// Mass of an element. Where some nodes carry none, bulges of edges would ride with a frame
    /// that these nodes turn at any rate: there the consistent mass is the constant one.
    fn mass(&self, e: usize, x: &Nodal<f64, N, 2>, mut kind: MassKind) -> (Mass<f64, N>, MassKind) {
        let s = &self.shared;
        let light = self.massless.get(e).map_or(0, |of| of.iter().filter(|&&l| l).count());
        if kind == MassKind::Consistent && 0 < light && light < N {
            kind = MassKind::Constant;
        }
        let rho_t = |p: &Point<N>| {
            let rho = self.nodal_density.get(e).map_or(s.rho, |nodal| interpolate(p, nodal));
            rho * self.thickness(e, p)
        };
        let mut mass = Mass::new(x, &s.mass_points, rho_t, &self.kernels, &self.shares(e), kind);
        if self.kernels.line && M == 3 && s.section.thickness > 0.0 {
            mass.turn_with(s.section.profile[1] / s.section.thickness);
        }
        if let Some(massless) = self.massless.get(e) {
            mass.carry(x, massless, kind == MassKind::Lumped);
        }
        if let Some(factor) = self.mass_factors.get(e) {
            mass.scale(*factor);
        }
        (mass, kind)
    }

    /// Whether bulges of the edges couple with the nodes.
    fn coupled(&self, kind: MassKind) -> bool {
        kind == MassKind::Consistent && M == 3 && !self.kernels.spring
    }

    pub(super) fn add_inertia(&self, context: &Context<'_>, motion: &Motion<'_>, sink: &Sink<'_>) {
        for e in 0..self.nodes.len() {
            let (x, u) = self.gather::<f64>(e, context);
            let (mass, kind) = self.mass(e, &x, motion.kind);
            let a = self.of_dofs(e, motion.a, context);
            let (f, k) = if self.coupled(kind) {
                let v = self.of_dofs(e, motion.v, context);
                consistent(&mass, &x, &u, &v, &a, motion.weights)
            } else {
                let mut k = mass.matrix::<M>(kind == MassKind::Lumped);
                let f = symmetric_times(&k, &a);
                for v in k.as_flattened_mut().as_flattened_mut().as_flattened_mut() {
                    *v *= motion.weights[2];
                }
                (f, k)
            };
            self.scatter_force(e, 1, &f, context.dofs, sink);
            if context.tangent {
                self.scatter_stiffness(e, 1, &k, context.dofs, sink);
            }
        }
    }

    pub(super) fn add_body_force(
        &self,
        context: &Context<'_>,
        load: &BodyLoad<'_>,
        mask: &[bool],
        sink: &Sink<'_>,
    ) {
        for e in (0..self.nodes.len()).filter(|&e| mask[self.elements[e] as usize]) {
            let (x, mut u) = self.gather::<f64>(e, context);
            let (mass, coupled) = if let Some(kind) = load.kind {
                let (mass, kind) = self.mass(e, &x, kind);
                (mass, self.coupled(kind))
            } else {
                let (points, kind) = (&self.shared.mass_points, MassKind::Consistent);
                let sides = self.shares(e);
                let thickness = |p: &Point<N>| self.thickness(e, p);
                let volume = Mass::new(&x, points, thickness, &self.kernels, &sides, kind);
                (volume, self.coupled(kind))
            };
            let mut secant = None;
            if !load.start.is_empty() {
                let (u0, field) = (self.of_dofs(e, load.start, context), load.field);
                if coupled {
                    let ends = [&u0, &u];
                    let field = (field.at_origin, field.omega2);
                    secant = Some(conserving::body_force(&mass, &x, ends, field));
                }
                for (to, from) in u.as_flattened_mut().iter_mut().zip(u0.as_flattened()) {
                    *to = 0.5 * (*to + from);
                }
            }
            let field = if self.kernels.ring { load.field.about_axis() } else { load.field };
            let (middle, mut k) = body::force(&mass, coupled, &x, &u, field, context.tangent);
            let f = secant.unwrap_or(middle);
            self.scatter_force(e, 1, &f, context.dofs, sink);
            if context.tangent {
                for v in k.as_flattened_mut().as_flattened_mut().as_flattened_mut() {
                    *v *= load.share;
                }
                self.scatter_stiffness(e, 1, &k, context.dofs, sink);
            }
        }
    }

    /// Internal and inertia force of the conserving step to `context.u`; the internal one
    /// alone also goes to `internal`.
    pub(super) fn add_conserving(
        &mut self,
        context: &Context<'_>,
        between: &Between<'_>,
        sink: &Sink<'_>,
        internal: &Sink<'_>,
    ) -> Vec<usize> {
        self.begin_trial();
        let mut failed = Vec::new();
        let shared = self.shared.clone();
        let members = usize::from(shared.section.law.n_state() > 0);
        let modes = 2 * self.kernels.modes;
        for e in 0..self.nodes.len() {
            let (x, u1) = self.gather::<f64>(e, context);
            let (mass, kind) = self.mass(e, &x, between.kind);
            let (u0, v0) =
                (self.of_dofs(e, between.u0, context), self.of_dofs(e, between.v0, context));
            let mut rates = [[0.0; 2]; N];
            let mut rates_end = [[0.0; 2]; N];
            if M == 3 {
                rates
                    .as_flattened_mut()
                    .copy_from_slice(&self.rates_old[2 * N * e..2 * N * (e + 1)]);
            }
            let stride = self.stride;
            let mut history = History {
                old: &self.old[e * members..],
                new: &mut self.new[e * members..],
                alpha: &mut self.alpha[e.min(modes * stride)..],
                initial: if self.initial.is_empty() { &[] } else { &self.initial[e..] },
                stride,
                clock: context.clock,
                per_point: PerPoint::of(
                    &self.thickness,
                    &self.sides,
                    self.laws.as_ref(),
                    e,
                    stride,
                ),
                tape: None,
            };
            let step = Step {
                u0: &u0,
                v0: &v0,
                u1: &u1,
                dt: between.dt,
                nlgeom: context.nlgeom && self.kernels.turns,
                tangent: context.tangent,
            };
            let answer = conserving::element(
                &self.kernels,
                &x,
                &shared.section,
                &mut history,
                (&mass, kind),
                &step,
                (&rates, &mut rates_end),
            );
            if M == 3 {
                self.rates[2 * N * e..2 * N * (e + 1)].copy_from_slice(rates_end.as_flattened());
            }
            if answer.failed {
                failed.push(self.elements[e] as usize);
            }
            self.scatter_force(e, 1, &answer.internal, context.dofs, sink);
            self.scatter_force(e, 1, &answer.internal, context.dofs, internal);
            self.scatter_force(e, 1, &answer.inertia, context.dofs, sink);
            if context.tangent {
                self.scatter_stiffness(e, 1, &answer.tangent, context.dofs, sink);
            }
        }
        failed
    }

    /// Carry velocities of the edge bulges that belong to a motion.
    pub(super) fn start_rates(&mut self, context: &Context<'_>, v: &[f64]) {
        if M < 3 {
            return;
        }
        for e in 0..self.nodes.len() {
            let (x, u) = self.gather::<f64>(e, context);
            let (mass, _) = self.mass(e, &x, MassKind::Consistent);
            let v = self.of_dofs(e, v, context);
            let y = bulge_rates(&Spin::new(&x, &u, &mass.s), &u, &v);
            self.rates_old[2 * N * e..2 * N * (e + 1)].copy_from_slice(y.as_flattened());
        }
    }

    /// Add this chunk's share; with `carried` the bulges move with the carried velocities.
    pub(super) fn add_momenta(
        &self,
        context: &Context<'_>,
        v: &[f64],
        kind: MassKind,
        carried: bool,
        sums: &mut Momenta,
        each: &mut [f64],
    ) {
        for e in 0..self.nodes.len() {
            let before = std::mem::take(&mut sums.kinetic);
            let (x, u) = self.gather::<f64>(e, context);
            let (mass, kind) = self.mass(e, &x, kind);
            let v = self.of_dofs(e, v, context);
            let coupled = self.coupled(kind);
            let mut y = [[0.0; 2]; N];
            let mut rate = [[0.0; 2]; N];
            if coupled {
                let spin = Spin::new(&x, &u, &mass.s);
                rate = bulge_rates(&spin, &u, &v);
                if carried {
                    rate.as_flattened_mut()
                        .copy_from_slice(&self.rates_old[2 * N * e..2 * N * (e + 1)]);
                }
                for k in 0..N {
                    let p = u[k][M - 1] - u[(k + 1) % N][M - 1];
                    y[k] = [p * spin.w[k][0], p * spin.w[k][1]];
                }
            }
            for a in 0..N {
                let mut p_node = [0.0; 2];
                let mut p_edge = [0.0; 2];
                for b in 0..N {
                    sums.mass += mass.nn[a][b];
                    for i in 0..2 {
                        p_node[i] += mass.nn[a][b] * v[b][i];
                        if coupled {
                            p_node[i] += mass.ne[a][b] * rate[b][i];
                            p_edge[i] += mass.ne[b][a] * v[b][i] + mass.ee[a][b] * rate[b][i];
                        }
                    }
                }
                let position = [x[a][0] + u[a][0], x[a][1] + u[a][1]];
                sums.angular += position[0] * p_node[1] - position[1] * p_node[0];
                sums.angular += y[a][0] * p_edge[1] - y[a][1] * p_edge[0];
                for i in 0..2 {
                    sums.linear[i] += p_node[i];
                    sums.kinetic += 0.5 * (v[a][i] * p_node[i] + rate[a][i] * p_edge[i]);
                }
            }
            if M == 3 {
                let turn = if coupled { mass.rr } else { mass.rotations(kind == MassKind::Lumped) };
                for a in 0..N {
                    for b in 0..N {
                        let spin = turn[a][b] * v[b][M - 1];
                        sums.kinetic += 0.5 * v[a][M - 1] * spin;
                        sums.angular += spin;
                    }
                }
            }
            if let Some(own) = each.get_mut(self.elements[e] as usize) {
                *own = sums.kinetic;
            }
            sums.kinetic += before;
        }
    }
}
