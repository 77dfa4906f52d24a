//! Values at the quadrature points for output.
// SPDX-License-Identifier: BSD-3-Clause

use super::chunk::Context;
use super::chunk_of::ChunkOf;
use crate::elements::element::Wanted;
use crate::kinematics::corotation::Frame;
use crate::kinematics::integrate::{History, Local};
use crate::materials::{Law, Plane, PointState};

/// Fields of one block, element by element, point by point.
#[derive(Clone, Debug, Default)]
pub struct Fields {
    pub n_points: usize,
    /// Current positions, `[n, p, 2]`.
    pub points: Vec<f64>,
    /// Cauchy stress in global axes, rows xx, yy, zz, xy, `[n, p, 4]`.
    pub stress: Vec<f64>,
    /// Strain in global axes, engineering shear, `[n, p, 4]`.
    pub strain: Vec<f64>,
    /// Equivalent stress of von Mises, `[n, p]`.
    pub mises: Vec<f64>,
    /// Recoverable energy density, `[n, p]`.
    pub energy: Vec<f64>,
    /// Reference volume, `[n, p]`.
    pub volume: Vec<f64>,
    /// Named scalars of the material, `[outputs][n, p]`.
    pub outputs: Vec<Vec<f64>>,
    /// Tensors of the material in global axes, rows xx, yy, zz, xy, `[tensors][n, p, 4]`.
    pub tensors: Vec<Vec<f64>>,
    /// Current thickness, `[n, p]`.
    pub thickness: Vec<f64>,
    /// Forces and moments of the nodes on the element in global axes, `[n, N, M]`.
    pub forces: Vec<f64>,
    /// Rotation of the element frame in (-pi, pi], `[n]`.
    pub rotation: Vec<f64>,
    /// Energy of the drilling penalty, `[n]`; of springs, which have no volume, all of it.
    pub penalty: Vec<f64>,
    /// Work dissipated beside the points, by the hourglass of an element that flows, `[n]`.
    pub dissipated: Vec<f64>,
    /// Energies beside the points of the drilling penalty and of two hourglass modes, each with the
    /// stiffness to which it is proportional, `[n, 3, 2]`; empty unless laws follow the
    /// temperature.
    pub stabilized: Vec<f64>,
    /// Energy that the initial strain takes: minus the derivative of the energy density by its
    /// rows, and the stress through the thickness of the law, `[n, p, 5]`; zero where there is none.
    pub heat: Vec<f64>,
    /// Stress, strain and equivalent plastic strain by station and fiber of beams that have some,
    /// `[n, stations, fibers, 3]`.
    pub fibers: Vec<f64>,
    /// Largest local strain component.
    pub largest_strain: f64,
}

impl Fields {
    /// Zero fields of `n` elements with some dofs each.
    pub fn new(n: usize, n_points: usize, n_dofs: usize, law: &Law, outputs: usize) -> Self {
        let p = n * n_points;
        Self {
            n_points,
            points: vec![0.0; 2 * p],
            stress: vec![0.0; 4 * p],
            strain: vec![0.0; 4 * p],
            mises: vec![0.0; p],
            energy: vec![0.0; p],
            volume: vec![0.0; p],
            outputs: vec![vec![0.0; p]; outputs],
            tensors: vec![vec![0.0; 4 * p]; law.tensors().len()],
            thickness: vec![0.0; p],
            forces: vec![0.0; n * n_dofs],
            rotation: vec![0.0; n],
            penalty: vec![0.0; n],
            dissipated: vec![0.0; n],
            stabilized: Vec::new(),
            heat: Vec::new(),
            fibers: Vec::new(),
            largest_strain: 0.0,
        }
    }

    /// Take over the fields of some elements, given their places here.
    pub fn place(&mut self, part: &Self, elements: &[u32]) {
        let copy = |to: &mut [f64], from: &[f64]| {
            let width = from.len() / elements.len().max(1);
            if width == 0 {
                return;
            }
            for (row, &e) in from.chunks_exact(width).zip(elements) {
                to[e as usize * width..][..width].copy_from_slice(row);
            }
        };
        copy(&mut self.points, &part.points);
        copy(&mut self.stress, &part.stress);
        copy(&mut self.strain, &part.strain);
        copy(&mut self.mises, &part.mises);
        copy(&mut self.energy, &part.energy);
        copy(&mut self.volume, &part.volume);
        copy(&mut self.thickness, &part.thickness);
        copy(&mut self.forces, &part.forces);
        copy(&mut self.rotation, &part.rotation);
        copy(&mut self.penalty, &part.penalty);
        copy(&mut self.dissipated, &part.dissipated);
        if !part.stabilized.is_empty() {
            self.stabilized.resize(6 * self.rotation.len(), 0.0);
            copy(&mut self.stabilized, &part.stabilized);
        }
        if !part.heat.is_empty() {
            self.heat.resize(5 * self.volume.len(), 0.0);
            copy(&mut self.heat, &part.heat);
        }
        if !part.fibers.is_empty() {
            let width = part.fibers.len() / elements.len();
            self.fibers.resize(width * self.rotation.len(), 0.0);
            copy(&mut self.fibers, &part.fibers);
        }
        for (to, from) in self.outputs.iter_mut().zip(&part.outputs) {
            copy(to, from);
        }
        for (to, from) in self.tensors.iter_mut().zip(&part.tensors) {
            copy(to, from);
        }
        self.largest_strain = self.largest_strain.max(part.largest_strain);
    }

    /// Strain energy of all elements.
    pub fn total_energy(&self) -> f64 {
        let stored: f64 = self.energy.iter().zip(&self.volume).map(|(e, v)| e * v).sum();
        stored + self.penalty.iter().sum::<f64>()
    }
}

/// Equivalent stress of von Mises, rows xx, yy, zz, xy.
fn mises([xx, yy, zz, xy]: [f64; 4]) -> f64 {
    let differences = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * differences + 3.0 * xy * xy).sqrt()
}

/// Turn a symmetric tensor (xx, yy, xy) by an angle given by its cosine and sine.
fn turn(t: [f64; 3], c: f64, s: f64) -> [f64; 3] {
    [
        c * c * t[0] + s * s * t[1] - 2.0 * c * s * t[2],
        s * s * t[0] + c * c * t[1] + 2.0 * c * s * t[2],
        c * s * (t[0] - t[1]) + (c * c - s * s) * t[2],
    ]
}

/// Fields of a chunk, in its own order of elements.
pub(super) fn chunk<const N: usize, const M: usize>(
    chunk: &ChunkOf<N, M>,
    context: &Context<'_>,
    out: &mut Fields,
) {
    let kernels = &chunk.kernels;
    let section = chunk.shared.section(context.nlgeom);
    let members = section.law.n_state();
    let n_points = section.points.len();
    let memory = members * section.n_histories();
    let kept = memory + if members > 0 { kernels.memory } else { 0 };
    let mut new = vec![0.0; kept];
    if !chunk.initial_from(0).is_empty() {
        out.heat = vec![0.0; 5 * out.volume.len()];
    }
    if chunk.per_point(0).laws.is_some() && !kernels.line {
        out.stabilized = vec![0.0; 6 * out.rotation.len()];
    }
    for e in 0..chunk.nodes.len() {
        let (x, u) = chunk.gather::<f64>(e, context);
        let frame = Frame::new(&x, &u, context.nlgeom && kernels.turns);
        let stride = chunk.stride;
        let own = chunk.per_point(e);
        let rows = 4 * n_points;
        let initial: Vec<f64> = match chunk.initial_from(e) {
            [] => Vec::new(),
            from => (0..rows).map(|m| from[m * stride]).collect(),
        };
        let old: Vec<f64> = (0..kept).map(|m| chunk.old[m * stride + e]).collect();
        let mut alpha: Vec<f64> =
            (0..2 * kernels.modes).map(|m| chunk.alpha[m * stride + e]).collect();
        // The internal modes and the force that belong to these nodal dofs.
        let mut history = History {
            old: &old,
            new: &mut new,
            alpha: &mut alpha,
            initial: &initial,
            stride: 1,
            clock: context.clock,
            per_point: own,
            tape: None,
        };
        let wanted = Wanted { nlgeom: context.nlgeom, stressed: false, tangent: false };
        let mut answer = Local::zero();
        (kernels.respond)(&x, &u, section, &mut history, wanted, &mut answer);
        let forces = answer.force;
        out.forces[e * N * M..(e + 1) * N * M].copy_from_slice(forces.as_flattened());
        if kernels.line {
            let found = (kernels.resultants)(&x, &frame.q, section, &mut history);
            out.fibers.extend_from_slice(found.fibers.as_flattened());
            if let Some(heat) = out.heat.get_mut(5 * e) {
                *heat = found.stress;
            }
            let volume = section.thickness * (kernels.measure)(&x, &section.points[0]);
            let mut position = [0.0; 2];
            for a in 0..N {
                for i in 0..2 {
                    position[i] += (x[a][i] + u[a][i]) / N as f64;
                }
            }
            out.points[2 * e..2 * e + 2].copy_from_slice(&position);
            let t = frame.to_global(found.axis);
            let tensor = [t[0] * t[0], t[1] * t[1], 0.0, t[0] * t[1]];
            let stress = tensor.map(|v| found.stress * v);
            out.stress[4 * e..4 * e + 4].copy_from_slice(&stress);
            out.strain[4 * e..4 * e + 4].copy_from_slice(&tensor.map(|v| found.strain * v));
            out.strain[4 * e + 3] *= 2.0;
            out.mises[e] = mises(stress);
            for (values, v) in out.outputs.iter_mut().zip(found.outputs) {
                values[e] = v;
            }
            out.volume[e] = volume;
            // Springs have no volume to spread their energy over.
            if volume > 0.0 {
                out.energy[e] = found.energy / volume;
            } else {
                out.penalty[e] = found.energy;
            }
            out.rotation[e] = frame.angle();
            continue;
        }
        let parameter = own.parameter::<f64, N>(section);
        let kinematics = (kernels.kinematics)(&x, &u, &alpha, section, &own, context.nlgeom);
        for (p, (point, at)) in section.points.iter().zip(&kinematics).enumerate() {
            let (law, thickness) =
                (own.law::<f64, N>(p, section), own.thickness::<f64, N>(p, section));
            let h = at.h;
            let total = [at.strain[0], at.strain[1], at.strain[3]];
            let offset = |row: usize| initial.get(4 * p + row).copied().unwrap_or(0.0);
            // What the law sees; output is the total strain.
            let strain = [total[0] - offset(0), total[1] - offset(1), total[2] - offset(2)];
            let range = p * members..(p + 1) * members;
            let mut state = PointState {
                old: &old[range.clone()],
                new: &mut new[range.clone()],
                stride: 1,
                clock: context.clock,
            };
            let (mut stress, mut strain_zz, mut stress_zz, mut energy);
            if kernels.ring {
                strain_zz = at.strain[2];
                let solid = [strain[0], strain[1], strain[2], strain_zz - offset(3)];
                let all = law.update_solid(solid, &mut state).stress;
                energy = law.energy_solid(solid, all, &new[range.clone()]);
                stress_zz = all[3];
                stress = [all[0], all[1], all[2]];
            } else {
                stress = law.update(strain, &mut state).stress;
                (strain_zz, stress_zz) = law.out_of_plane(strain, stress, &new[range.clone()]);
                energy = law.energy(strain, stress, &new[range.clone()]);
            }
            let state = &new[range];
            let normal = stress_zz;
            let in_strain = section.plane == Plane::Strain && !kernels.ring;
            if section.plane == Plane::Stress {
                strain_zz += offset(3);
            } else if in_strain {
                energy += law.initial_energy(stress, stress_zz, offset(3));
                stress_zz += offset(3);
            }
            let own_stress = if kernels.ring {
                law.without_normal_strain(stress, strain_zz - offset(3))
            } else {
                stress
            };
            if in_strain && section.law.spherical() {
                stress[0] += offset(3);
                stress[1] += offset(3);
            }
            if let Some(heat) = out.heat.get_mut(5 * (e * n_points + p)..) {
                for (row, v) in heat.iter_mut().zip(stress) {
                    *row = v;
                }
                if kernels.ring && !heat.is_empty() {
                    (heat[3], heat[4]) = (stress_zz, stress_zz);
                } else if in_strain && !heat.is_empty() {
                    // The energy is quadratic in the initial stress.
                    let [up, down] = [1.0, -1.0].map(|s| law.initial_energy(own_stress, normal, s));
                    heat[3] = 0.5 * (down - up) - (up + down) * offset(3);
                    heat[4] = stress_zz;
                }
            }
            let stretch =
                if kernels.ring { 1.0 + at.hoop } else { section.strain.stretch(strain_zz) };
            let [xx, yy, zz, xy] = section.strain.cauchy(&h, stress, stress_zz, stretch);
            let s_global = turn([xx, yy, xy], frame.cos, frame.sin);
            // Finite strains are functions of the stretch: the rest of the rotation takes them to
            // global axes, as it takes the stress.
            let [rest_cos, rest_sin] = section.strain.rotation(&h);
            let cos = frame.cos * rest_cos - frame.sin * rest_sin;
            let sin = frame.sin * rest_cos + frame.cos * rest_sin;
            let e_global = turn([total[0], total[1], 0.5 * total[2]], cos, sin);
            let at_strain = at.strain;
            let at = e * n_points + p;
            let mut position = [0.0; 2];
            for a in 0..N {
                for i in 0..2 {
                    position[i] += point.n[a] * (x[a][i] + u[a][i]);
                }
            }
            out.points[2 * at..2 * at + 2].copy_from_slice(&position);
            let row = [s_global[0], s_global[1], zz, s_global[2]];
            out.stress[4 * at..4 * at + 4].copy_from_slice(&row);
            out.mises[at] = mises(row);
            let row = [e_global[0], e_global[1], strain_zz, 2.0 * e_global[2]];
            out.strain[4 * at..4 * at + 4].copy_from_slice(&row);
            out.energy[at] = energy;
            out.volume[at] = kinematics[p].volume;
            for (i, values) in out.outputs.iter_mut().enumerate() {
                values[at] = law.output(i, own_stress, state);
            }
            out.thickness[at] = thickness * stretch;
            for (i, (kind, values)) in law.tensors().iter().zip(&mut out.tensors).enumerate() {
                let [xx, yy, zz, xy] = law.tensor(i, state);
                let shear = if kind.engineering { 0.5 } else { 1.0 };
                let t = turn([xx, yy, shear * xy], cos, sin);
                values[4 * at..4 * at + 4].copy_from_slice(&[t[0], t[1], zz, t[2] / shear]);
            }
            for v in at_strain {
                out.largest_strain = out.largest_strain.max(v.abs());
            }
            out.penalty[e] += kinematics[p].penalty;
        }
        let drilling = out.penalty[e];
        let [first, second] = (kernels.stabilization)(&x, &frame.q, section, &own, &new[memory..]);
        out.penalty[e] += first[0] + second[0];
        if let (Some(member), true) = (kernels.dissipated, members > 0) {
            out.dissipated[e] = new[memory + member];
        }
        if let Some(row) = out.stabilized.get_mut(6 * e..6 * e + 6) {
            let stiffness = if kernels.drill { parameter } else { 1.0 };
            row.copy_from_slice([[drilling, stiffness], first, second].as_flattened());
        }
        out.rotation[e] = frame.angle();
    }
}

/// Strains that the material meets at the points, `[n, p, 3]` of the whole block.
pub(super) fn strains<const N: usize, const M: usize>(
    chunk: &ChunkOf<N, M>,
    context: &Context<'_>,
    alpha: &[f64],
    out: &mut [f64],
) {
    let kernels = &chunk.kernels;
    let section = chunk.shared.section(context.nlgeom);
    let n_points = section.points.len();
    let stride = chunk.stride;
    for e in 0..chunk.nodes.len() {
        let (x, u) = chunk.gather::<f64>(e, context);
        let modes: Vec<f64> = (0..2 * kernels.modes).map(|m| alpha[m * stride + e]).collect();
        let kinematics =
            (kernels.kinematics)(&x, &u, &modes, section, &chunk.per_point(e), context.nlgeom);
        for (p, at) in kinematics.iter().enumerate() {
            let [xx, yy, _, xy] = at.strain;
            let at = 3 * (chunk.elements[e] as usize * n_points + p);
            out[at..at + 3].copy_from_slice(&[xx, yy, xy]);
        }
    }
}
