//! The chunk of an element type: nodes, history and state, evaluated in batches. All but the batches
//! goes through the functions of [`Kernels`], and is compiled once for each number of nodes and dofs.
// SPDX-License-Identifier: BSD-3-Clause

use super::chunk::{Chunk, Context, PARTS, Shared};
use super::dofs::Dofs;
use super::dynamics::{Between, BodyLoad, Momenta, Motion};
use super::scatter::Sink;
use super::sensitivity::{Gradients, Weights};
use crate::base::small::Nodal;
use crate::base::{Lanes, MAX_LANES, Real};
use crate::elements::Element;
use crate::kinematics::inertia::MassKind;
use crate::kinematics::kernels::Kernels;
use crate::kinematics::per_point::{PerPoint, PointLaws};
use std::sync::Arc;

/// Histories are padded so that every batch can load whole lanes.
const PAD: usize = MAX_LANES;

pub struct ChunkOf<const N: usize, const M: usize> {
    pub(super) kernels: Kernels<N, M>,
    /// [`ChunkOf::batches`] of the element type.
    batches: Batches<N, M>,
    pub(super) shared: Arc<Shared<N>>,
    /// Index of each element in the block.
    pub(super) elements: Vec<u32>,
    pub(super) nodes: Vec<[u32; N]>,
    /// Slot of each node pair of each element, `N (N + 1) / 2` each.
    pub(super) slots: Vec<u32>,
    pub(super) stride: usize,
    pub(super) old: Vec<f64>,
    pub(super) new: Vec<f64>,
    alpha_old: Vec<f64>,
    pub(super) alpha: Vec<f64>,
    /// Whether the trial history belongs to an evaluation since the last commit.
    evaluated: bool,
    /// Carried velocities of the edge bulges (conserving scheme), committed and trial.
    pub(super) rates_old: Vec<f64>,
    pub(super) rates: Vec<f64>,
    /// Initial strain, `[p, 4]` strided; empty for none.
    pub(super) initial: Vec<f64>,
    /// Displacements at which the elements have no strain, `[n, N, M]`; empty for none.
    origin: Vec<f64>,
    /// Nodes of each element that carry no mass; empty for none.
    pub(super) massless: Vec<[bool; N]>,
    /// Factor on the mass of each element; empty for one.
    pub(super) mass_factors: Vec<f64>,
    /// Thickness by point, `[p]` strided; empty where that of the section holds.
    pub(super) thickness: Vec<f64>,
    /// [`Element::edge`] of each edge, `[N]` strided; empty where that of the element holds.
    pub(super) sides: Vec<f64>,
    /// Thickness and density of the nodes of each element; empty likewise.
    pub(super) nodal_thickness: Vec<[f64; N]>,
    pub(super) nodal_density: Vec<[f64; N]>,
    /// Temperatures by element and point, and the laws there; none where the law has no table.
    temperatures: Vec<f64>,
    pub(super) laws: Option<PointLaws>,
}

impl<const N: usize, const M: usize> ChunkOf<N, M> {
    /// Chunk of the `elements` of a block, of type `E`, with the given nodes.
    pub fn new<E, const A: usize>(
        shared: &Arc<Shared<N>>,
        elements: &[u32],
        all_nodes: &[[u32; N]],
        dofs: &Dofs,
    ) -> Self
    where
        E: Element<N, M, A>,
    {
        let kernels = Kernels::of::<E, A>();
        Self::with(kernels, Self::batches::<E, A>, shared, elements, all_nodes, dofs)
    }

    fn with(
        kernels: Kernels<N, M>,
        batches: Batches<N, M>,
        shared: &Arc<Shared<N>>,
        elements: &[u32],
        all_nodes: &[[u32; N]],
        dofs: &Dofs,
    ) -> Self {
        let nodes: Vec<[u32; N]> = elements.iter().map(|&e| all_nodes[e as usize]).collect();
        let (stride, modes) = (nodes.len().div_ceil(PAD) * PAD, kernels.modes);
        let section = &shared.section;
        let members = section.law.n_state();
        let memory = if members > 0 { kernels.memory } else { 0 };
        let state = (section.n_histories() * members + memory) * stride;
        let rates = if M == 3 { 2 * N * nodes.len() } else { 0 };
        let mut slots = Vec::with_capacity(nodes.len() * N * (N + 1) / 2);
        for element in &nodes {
            for a in 0..N {
                for b in a..N {
                    let (low, high) = (element[a].min(element[b]), element[a].max(element[b]));
                    slots.push(dofs.slot(low, high));
                }
            }
        }
        let of_nodes = |all: &[f64]| -> Vec<[f64; N]> {
            let rows = all.as_chunks::<N>().0;
            if rows.is_empty() {
                return Vec::new();
            }
            elements.iter().map(|&e| rows[e as usize]).collect()
        };
        let nodal_thickness = of_nodes(&shared.nodal_thickness);
        let mut thickness = Vec::new();
        if !nodal_thickness.is_empty() {
            // Lanes past the end have one too.
            thickness.resize(section.points.len() * stride, section.thickness);
            for (e, nodal) in nodal_thickness.iter().enumerate() {
                for (p, point) in section.points.iter().enumerate() {
                    let here = point.n.iter().zip(nodal).map(|(n, t)| n * t);
                    thickness[p * stride + e] = here.sum();
                }
            }
        }
        let mut sides = Vec::new();
        if !shared.sides.is_empty() || (!nodal_thickness.is_empty() && kernels.edge != 0.0) {
            sides.resize(N * stride, kernels.edge);
            let shares = of_nodes(&shared.sides);
            for e in 0..nodes.len() {
                let share = shares.get(e).copied().unwrap_or([kernels.alpha_b; N]);
                let thick = nodal_thickness.get(e).unwrap_or(&[1.0; N]);
                let mean = thick.iter().sum::<f64>() / N as f64;
                for (a, &share) in share.iter().enumerate() {
                    let here = 0.5 * (thick[a] + thick[(a + 1) % N]);
                    sides[a * stride + e] = (kernels.edge_of)(share, here / mean);
                }
            }
        }
        Self {
            shared: shared.clone(),
            elements: elements.to_vec(),
            nodes,
            slots,
            stride,
            old: vec![0.0; state],
            new: vec![0.0; state],
            alpha_old: vec![0.0; 2 * modes * stride],
            alpha: vec![0.0; 2 * modes * stride],
            evaluated: false,
            rates_old: vec![0.0; rates],
            rates: vec![0.0; rates],
            initial: Vec::new(),
            origin: Vec::new(),
            massless: Vec::new(),
            mass_factors: Vec::new(),
            thickness,
            sides,
            nodal_thickness,
            nodal_density: of_nodes(&shared.nodal_density),
            temperatures: Vec::new(),
            laws: None,
            kernels,
            batches,
        }
    }

    /// Initial strain from the element `e` of the chunk on.
    pub(super) fn initial_from(&self, e: usize) -> &[f64] {
        if self.initial.is_empty() { &[] } else { &self.initial[e..] }
    }

    /// Share [`Element::ALPHA_B`] of each edge of the element `e` of the chunk.
    pub(super) fn shares(&self, e: usize) -> [f64; N] {
        let rows = self.shared.sides.as_chunks::<N>().0;
        rows.get(self.elements[e] as usize).copied().unwrap_or([self.kernels.alpha_b; N])
    }

    /// What the element `e` of the chunk has of its own.
    pub(super) fn per_point(&self, e: usize) -> PerPoint<'_> {
        PerPoint::of(&self.thickness, &self.sides, self.laws.as_ref(), e, self.stride)
    }

    /// Laws at the temperatures that are stored.
    fn temper(&mut self) -> Result<(), String> {
        let shared = self.shared.clone();
        let Some(table) = &shared.table else { return Ok(()) };
        let parameter = self.kernels.parameter;
        let of = |moduli: &crate::base::small::Mat<f64, 3>| {
            if shared.weighted { shared.section.parameter } else { parameter(moduli) }
        };
        let n_points = shared.section.points.len();
        self.laws = Some(PointLaws::new(table, &self.temperatures, n_points, of)?);
        Ok(())
    }

    /// Reference positions and displacements of the batch that starts at `first`; lanes past
    /// the end repeat the last element.
    #[inline(always)]
    pub(super) fn gather<T: Real>(
        &self,
        first: usize,
        context: &Context<'_>,
    ) -> (Nodal<T, N, 2>, Nodal<T, N, M>) {
        let last = self.nodes.len() - 1;
        let mut x = [[T::zero(); 2]; N];
        let mut u = [[T::zero(); M]; N];
        for a in 0..N {
            let mut node = [0; MAX_LANES];
            let mut dof = [0; MAX_LANES];
            for l in 0..T::LANES {
                node[l] = self.nodes[(first + l).min(last)][a] as usize;
                dof[l] = context.dofs.start[node[l]] as usize;
            }
            for i in 0..2 {
                x[a][i] = T::from_lanes(
                    #[inline(always)]
                    |l| context.x[node[l]][i],
                );
            }
            for i in 0..M {
                u[a][i] = T::from_lanes(
                    #[inline(always)]
                    |l| context.u[dof[l] + i],
                );
            }
        }
        if !self.origin.is_empty() {
            for a in 0..N {
                for i in 0..M {
                    let start = T::from_lanes(
                        #[inline(always)]
                        |l| self.origin[((first + l).min(last) * N + a) * M + i],
                    );
                    u[a][i] -= start;
                    if i < 2 && context.nlgeom {
                        x[a][i] += start;
                    }
                }
            }
        }
        (x, u)
    }

    /// Each evaluation starts from the committed modes, so that trials leave no trace.
    pub(super) fn begin_trial(&mut self) {
        self.alpha.copy_from_slice(&self.alpha_old);
        self.evaluated = true;
    }
}

/// Assembly in batches.
type Batches<const N: usize, const M: usize> =
    fn(&mut ChunkOf<N, M>, Lanes, &Context<'_>, &Sink<'_>) -> Vec<usize>;

impl<const N: usize, const M: usize> Chunk for ChunkOf<N, M> {
    fn assemble(&mut self, context: &Context<'_>, sink: &Sink<'_>) -> Vec<usize> {
        self.begin_trial();
        // Elements with laws of their own are evaluated one by one.
        let lanes = if self.laws.is_some() { Lanes::Scalar } else { context.lanes };
        (self.batches)(self, lanes, context, sink)
    }
    fn differentiate(&self, context: &Context<'_>, weights: &Weights<'_>) -> Gradients {
        ChunkOf::differentiate(self, context, weights)
    }
    fn recover(&self, context: &Context<'_>, out: &mut super::recover::Fields) {
        super::recover::chunk(self, context, out);
    }
    fn body_force(
        &self,
        context: &Context<'_>,
        load: &BodyLoad<'_>,
        mask: &[bool],
        sink: &Sink<'_>,
    ) {
        self.add_body_force(context, load, mask, sink);
    }
    fn inertia(&self, context: &Context<'_>, motion: &Motion<'_>, sink: &Sink<'_>) {
        self.add_inertia(context, motion, sink);
    }
    fn conserving(
        &mut self,
        context: &Context<'_>,
        between: &Between<'_>,
        sink: &Sink<'_>,
        internal: &Sink<'_>,
    ) -> Vec<usize> {
        self.add_conserving(context, between, sink, internal)
    }
    fn start(&mut self, context: &Context<'_>, v: &[f64]) {
        self.start_rates(context, v);
    }
    fn momenta(
        &self,
        context: &Context<'_>,
        v: &[f64],
        kind: MassKind,
        carried: bool,
        sums: &mut Momenta,
        each: &mut [f64],
    ) {
        self.add_momenta(context, v, kind, carried, sums, each);
    }
    fn set_massless(&mut self, massless: &[bool]) {
        let of = |nodes: &[u32; N]| nodes.map(|n| massless[n as usize]);
        self.massless =
            if massless.is_empty() { Vec::new() } else { self.nodes.iter().map(of).collect() };
    }

    fn set_mass_factors(&mut self, factors: &[f64]) {
        self.mass_factors = if factors.is_empty() {
            Vec::new()
        } else {
            self.elements.iter().map(|&e| factors[e as usize]).collect()
        };
    }

    fn set_initial(&mut self, values: &[f64]) {
        let rows = 4 * self.shared.section.points.len();
        self.initial.clear();
        if values.is_empty() {
            return;
        }
        self.initial.resize(rows * self.stride, 0.0);
        for (e, &element) in self.elements.iter().enumerate() {
            for row in 0..rows {
                self.initial[row * self.stride + e] = values[element as usize * rows + row];
            }
        }
    }
    fn renew(&mut self, context: &Context<'_>) {
        self.origin.clear();
        for nodes in &self.nodes {
            for &node in nodes {
                let start = context.dofs.start[node as usize] as usize;
                self.origin.extend_from_slice(&context.u[start..start + M]);
            }
        }
        for part in [&mut self.old, &mut self.new, &mut self.alpha_old, &mut self.alpha] {
            part.fill(0.0);
        }
        self.initial.clear();
        self.evaluated = false;
    }
    fn set_temperatures(&mut self, values: &[f64]) -> Result<(), String> {
        let n_points = self.shared.section.points.len();
        self.temperatures.clear();
        for &e in &self.elements {
            self.temperatures.extend_from_slice(&values[e as usize * n_points..][..n_points]);
        }
        self.temper()
    }
    fn commit(&mut self) {
        if !self.evaluated {
            return;
        }
        self.evaluated = false;
        std::mem::swap(&mut self.old, &mut self.new);
        self.alpha_old.copy_from_slice(&self.alpha);
        self.rates_old.copy_from_slice(&self.rates);
    }
    fn strains(&self, context: &Context<'_>, committed: bool, out: &mut [f64]) {
        let alpha = if committed { &self.alpha_old } else { &self.alpha };
        super::recover::strains(self, context, alpha, out);
    }
    fn give(&mut self, values: &[f64]) {
        let per_element = self.shared.section.n_histories() * self.shared.section.law.n_state();
        for e in 0..self.nodes.len() {
            let start = self.elements[e] as usize * per_element;
            for m in 0..per_element {
                self.old[m * self.stride + e] = values[start + m];
            }
        }
    }
    fn plastic_increment(&self) -> f64 {
        let law = &self.shared.section.law;
        let Some(member) = law.plastic_member() else { return 0.0 };
        if !self.evaluated {
            return 0.0;
        }
        let mut largest = 0.0f64;
        for p in 0..self.shared.section.n_histories() {
            let start = (p * law.n_state() + member) * self.stride;
            for e in start..start + self.nodes.len() {
                largest = largest.max(self.new[e] - self.old[e]);
            }
        }
        largest
    }
    fn creep_error(&self) -> f64 {
        let law = &self.shared.section.law;
        let Some(member) = law.creep_error_member() else { return 0.0 };
        if !self.evaluated {
            return 0.0;
        }
        let mut largest = 0.0f64;
        for p in 0..self.shared.section.n_histories() {
            let start = (p * law.n_state() + member) * self.stride;
            for v in &self.new[start..start + self.nodes.len()] {
                largest = largest.max(*v);
            }
        }
        largest
    }
    fn block(&self) -> usize {
        self.shared.block
    }
    fn elements(&self) -> &[u32] {
        &self.elements
    }
    fn nodes(&self) -> Vec<u32> {
        self.nodes.as_flattened().to_vec()
    }
    fn state(&self) -> [&[f64]; PARTS] {
        let [old, alpha, rates] = [&self.old, &self.alpha_old, &self.rates_old];
        [old, alpha, rates, &self.initial, &self.temperatures, &self.origin]
    }
    fn members(&self) -> usize {
        self.n_state()
    }
    fn histories(&self, trial: bool, out: &mut [f64]) {
        let from = if trial { &self.new } else { &self.old };
        let members = self.n_state();
        for (e, &element) in self.elements.iter().enumerate() {
            for m in 0..members {
                out[element as usize * members + m] = from[m * self.stride + e];
            }
        }
    }
    fn set_histories(&mut self, values: &[f64]) {
        let members = self.n_state();
        for (e, &element) in self.elements.iter().enumerate() {
            for m in 0..members {
                self.old[m * self.stride + e] = values[element as usize * members + m];
            }
        }
        self.new.copy_from_slice(&self.old);
        self.evaluated = false;
    }
    fn restore(&mut self, [old, alpha, rates, initial, heat, origin]: [&[f64]; PARTS]) -> bool {
        let n_points = self.shared.section.points.len();
        let most = 4 * n_points * self.stride;
        let wanted = if self.shared.table.is_some() { n_points * self.nodes.len() } else { 0 };
        let fits = old.len() == self.old.len()
            && alpha.len() == self.alpha_old.len()
            && rates.len() == self.rates_old.len()
            && (initial.is_empty() || initial.len() == most)
            && heat.len() == wanted
            && (origin.is_empty() || origin.len() == N * M * self.nodes.len());
        if !fits {
            return false;
        }
        for kept in [&mut self.old, &mut self.new] {
            kept.copy_from_slice(old);
        }
        for kept in [&mut self.alpha_old, &mut self.alpha] {
            kept.copy_from_slice(alpha);
        }
        for kept in [&mut self.rates_old, &mut self.rates] {
            kept.copy_from_slice(rates);
        }
        self.initial = initial.to_vec();
        self.temperatures = heat.to_vec();
        self.origin = origin.to_vec();
        self.evaluated = false;
        self.temper().is_ok()
    }
}
