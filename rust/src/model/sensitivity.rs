//! Exact derivatives of the forces and of the new state of elements, contracted with weights.
//!
//! The kernels run in numbers that carry derivatives, thickness and initial strain included: no
//! element, strain or law has a derivative written for it. Each element gives the gradient of one
//! number, the sum of its forces and of its new state by their weights: what the adjoint of an
//! increment needs (Michaleris, Tortorelli & Vidal 1994). Laws are differentiated once at each point;
//! by displacements and history one way backwards through them gives all (see
//! [`crate::kinematics::law_tape`]).
// SPDX-License-Identifier: BSD-3-Clause

use super::build::Block;
use super::chunk::{Chunk, Context};
use super::chunk_of::ChunkOf;
use super::dofs::Dofs;
use crate::base::Real;
use crate::base::small::Nodal;
use crate::elements::element;
use crate::kinematics::integrate::{History, Local};
use crate::kinematics::kernels::Respond;
use crate::kinematics::law_tape::{Along, LawTape, Number, WIDTH, Way};
use crate::kinematics::per_point::PerPoint;

/// Weights of what is differentiated, and which derivatives are wanted.
#[derive(Clone, Copy)]
pub struct Weights<'a> {
    /// Of the internal forces, by dof.
    pub force: &'a [f64],
    /// Of the new histories by block, `[n, members of an element]`; empty for none.
    pub state: &'a [Vec<f64>],
    pub wanted: Wanted,
}

/// Inputs that derivatives are wanted by.
// Independent of each other.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    pub positions: bool,
    pub displacements: bool,
    pub state: bool,
    pub thickness: bool,
    pub initial: bool,
}

impl Wanted {
    /// Of the inputs with these names.
    pub fn new(names: &[&str]) -> Result<Self, String> {
        let mut wanted = Self::default();
        for &name in names {
            match name {
                "positions" => wanted.positions = true,
                "displacements" => wanted.displacements = true,
                "state" => wanted.state = true,
                "thickness" => wanted.thickness = true,
                "initial" => wanted.initial = true,
                _ => return Err(format!("elements have no derivative by {name:?}")),
            }
        }
        Ok(wanted)
    }
}

/// Gradients of some elements, each input element by element.
#[derive(Clone, Debug, Default)]
pub struct Gradients {
    /// By node of the element, `[n, N, 2]`.
    pub positions: Vec<f64>,
    /// By node of the element, `[n, N, M]`.
    pub displacements: Vec<f64>,
    /// By member of the history, `[n, members of an element]`.
    pub state: Vec<f64>,
    /// By point, `[n, p]`.
    pub thickness: Vec<f64>,
    /// By point and row of the initial strain, `[n, p, 4]`.
    pub initial: Vec<f64>,
    /// Elements that could not be evaluated.
    pub failed: Vec<usize>,
    /// Whether a law was met whose tangent may differ from the derivative of its stress.
    pub inexact: bool,
}

/// Gradients of all elements: by node, by dof, and by block.
#[derive(Clone, Debug)]
pub struct Sums {
    pub positions: Vec<f64>,
    pub displacements: Vec<f64>,
    pub state: Vec<Vec<f64>>,
    pub thickness: Vec<Vec<f64>>,
    pub initial: Vec<Vec<f64>>,
    /// Block and index of elements that could not be evaluated.
    pub failed: Vec<(usize, usize)>,
    /// Whether the tangents of all laws are the derivatives of their stress.
    pub exact: bool,
    elements: Vec<usize>,
}

impl Sums {
    pub fn new(n_nodes: usize, dofs: &Dofs, blocks: &[Block]) -> Self {
        let points = |b: &Block| b.n_elements * b.facts.n_points;
        Self {
            positions: vec![0.0; 2 * n_nodes],
            displacements: vec![0.0; dofs.n_dofs()],
            state: vec![Vec::new(); blocks.len()],
            thickness: blocks.iter().map(|b| vec![0.0; points(b)]).collect(),
            initial: blocks.iter().map(|b| vec![0.0; 4 * points(b)]).collect(),
            failed: Vec::new(),
            exact: true,
            elements: blocks.iter().map(|b| b.n_elements).collect(),
        }
    }

    /// Add the part of a chunk, of which there is one after the other.
    pub fn add(&mut self, chunk: &dyn Chunk, part: &Gradients, dofs: &Dofs) {
        let (block, elements, nodes) = (chunk.block(), chunk.elements(), chunk.nodes());
        let n = elements.len();
        let width = part.displacements.len() / nodes.len().max(1);
        for (k, &node) in nodes.iter().enumerate() {
            let node = node as usize;
            for (i, d) in part.positions.iter().skip(2 * k).take(2).enumerate() {
                self.positions[2 * node + i] += d;
            }
            for (i, d) in part.displacements.iter().skip(width * k).take(width).enumerate() {
                self.displacements[dofs.start[node] as usize + i] += d;
            }
        }
        let members = chunk.members();
        let total = members * self.elements[block];
        self.state[block].resize(total, 0.0);
        for (all, own) in [
            (&mut self.state[block], &part.state),
            (&mut self.thickness[block], &part.thickness),
            (&mut self.initial[block], &part.initial),
        ] {
            let width = own.len() / n;
            for (row, &e) in own.chunks_exact(width.max(1)).zip(elements) {
                all[e as usize * width..][..width].copy_from_slice(row);
            }
        }
        self.exact &= !part.inexact;
        self.failed.extend(part.failed.iter().map(|&e| (block, e)));
    }
}

/// An input of an element, with its index among those of its kind.
#[derive(Clone, Copy)]
enum Input {
    Position(usize),
    Displacement(usize),
    State(usize),
    Thickness(usize),
    Initial(usize),
}

/// Numbers with their derivatives, one after the other.
struct Stored {
    places: Vec<f64>,
    stride: usize,
}

impl Stored {
    fn new<T: Real>(n: usize) -> Self {
        let stride = 1 + T::DERIVATIVES;
        Self { places: vec![0.0; n * stride], stride }
    }
    /// Take values without derivatives.
    fn set(&mut self, value: impl Fn(usize) -> f64) {
        for (k, number) in self.places.chunks_exact_mut(self.stride).enumerate() {
            number.fill(0.0);
            number[0] = value(k);
        }
    }
    fn seed(&mut self, k: usize, variable: usize) {
        self.places[k * self.stride + 1 + variable] = 1.0;
    }
    /// First derivatives.
    fn along(&self) -> impl Iterator<Item = f64> {
        self.places.chunks_exact(self.stride).map(|number| number[1])
    }
}

/// What an element of its own numbers is evaluated from.
struct Inputs {
    old: Stored,
    new: Stored,
    alpha: Stored,
    thickness: Stored,
    sides: Stored,
    initial: Stored,
}

impl<const N: usize, const M: usize> ChunkOf<N, M> {
    /// Whether the laws of the points say all of the history of an element: what an element of a
    /// plane remembers itself follows the tangents.
    fn taped(&self) -> bool {
        self.kernels.memory == 0 || self.kernels.line
    }

    /// Members of the state of an element.
    pub(super) fn n_state(&self) -> usize {
        self.old.len() / self.stride.max(1)
    }

    /// Inputs whose derivatives go forwards.
    fn inputs(&self, wanted: Wanted) -> Vec<Input> {
        let n_points = self.shared.section.points.len();
        let taped = self.taped();
        let mut all = Vec::new();
        let mut add = |some: bool, n: usize, make: fn(usize) -> Input| {
            if some {
                all.extend((0..n).map(make));
            }
        };
        add(wanted.positions, 2 * N, Input::Position);
        add(wanted.displacements && !taped, M * N, Input::Displacement);
        add(wanted.state && !taped, self.n_state(), Input::State);
        add(wanted.thickness, n_points, Input::Thickness);
        add(wanted.initial, 4 * n_points, Input::Initial);
        all
    }

    fn numbers<T: Real>(&self, strained: bool) -> Inputs {
        let (n_points, n_state) = (self.shared.section.points.len(), self.n_state());
        Inputs {
            old: Stored::new::<T>(n_state),
            new: Stored::new::<T>(n_state),
            alpha: Stored::new::<T>(2 * self.kernels.modes),
            thickness: Stored::new::<T>(n_points),
            sides: Stored::new::<T>(if self.sides.is_empty() { 0 } else { N }),
            initial: Stored::new::<T>(if strained { 4 * n_points } else { 0 }),
        }
    }

    /// Values of an element, about the modes and the own memory of the last evaluation.
    fn set(&self, inputs: &mut Inputs, e: usize) {
        let at = |values: &[f64], k: usize| values[k * self.stride + e];
        let (own, n_state) = (self.kernels.memory, self.n_state());
        let memory = if self.kernels.line { n_state - own.min(n_state) } else { usize::MAX };
        inputs.old.set(|k| at(if k < memory { &self.old } else { &self.new }, k));
        inputs.new.set(|_| 0.0);
        inputs.alpha.set(|k| at(&self.alpha, k));
        inputs.sides.set(|k| at(&self.sides, k));
        let uniform = self.shared.section.thickness;
        inputs
            .thickness
            .set(|p| if self.thickness.is_empty() { uniform } else { at(&self.thickness, p) });
        inputs.initial.set(|k| if self.initial.is_empty() { 0.0 } else { at(&self.initial, k) });
    }

    /// Answer of an element.
    fn respond<T: Real>(
        &self,
        respond: Respond<T, N, M>,
        e: usize,
        context: &Context<'_>,
        (x, u): (&Nodal<T, N, 2>, &Nodal<T, N, M>),
        inputs: &mut Inputs,
        tape: Option<&mut LawTape>,
    ) -> Local<T, N, M> {
        let forces = element::Wanted { nlgeom: context.nlgeom, stressed: false, tangent: false };
        let mut history = History {
            old: &inputs.old.places,
            new: &mut inputs.new.places,
            alpha: &mut inputs.alpha.places,
            initial: &inputs.initial.places,
            stride: 1 + T::DERIVATIVES,
            clock: context.clock,
            per_point: PerPoint {
                thickness: &inputs.thickness.places,
                sides: &inputs.sides.places,
                stride: 1 + T::DERIVATIVES,
                laws: self.laws.as_ref().map(|laws| laws.of(e)),
            },
            tape,
        };
        let mut answer = Local::zero();
        let section = self.shared.section(context.nlgeom);
        respond(x, u, section, &mut history, forces, &mut answer);
        answer
    }

    /// Gradients of all elements of the chunk about their last evaluation.
    pub(super) fn differentiate(&self, context: &Context<'_>, weights: &Weights<'_>) -> Gradients {
        let (section, kernels, taped) = (&self.shared.section, &self.kernels, self.taped());
        let (n_points, n_state) = (section.points.len(), self.n_state());
        let wanted = weights.wanted;
        let forward = self.inputs(wanted);
        // The way forwards weighs the forces of internal modes by what comes backwards.
        let backward = taped
            && (wanted.displacements || wanted.state || (kernels.modes > 0 && !forward.is_empty()));
        let n = self.nodes.len();
        let mut out = Gradients::default();
        let state = weights.state.get(self.shared.block).map_or(&[][..], Vec::as_slice);
        let sized = |some: bool, count: usize| vec![0.0; if some { count } else { 0 }];
        out.positions = sized(wanted.positions, 2 * N * n);
        out.displacements = sized(wanted.displacements, M * N * n);
        out.state = sized(wanted.state, n_state * n);
        out.thickness = sized(wanted.thickness, n_points * n);
        out.initial = sized(wanted.initial, 4 * n_points * n);
        let strained = !self.initial.is_empty();
        let mut along = self.numbers::<Along>(strained);
        let mut inputs = self.numbers::<Number>(strained || wanted.initial);
        let mut tape = LawTape::new(section.n_histories(), section.law.n_state(), n_state);
        for e in 0..n {
            let (x0, u0) = self.gather::<f64>(e, context);
            let mut failed = false;
            let own = state.get(self.elements[e] as usize * n_state..).unwrap_or(&[]);
            let own = &own[..n_state.min(own.len())];
            tape.clear();
            if backward {
                tape.way = Way::Backwards;
                tape.weights.clear();
                tape.weights.extend_from_slice(own);
                let x = x0.map(|p| p.map(Along::real));
                let mut u = u0.map(|p| p.map(Along::real));
                for (a, &node) in self.nodes[e].iter().enumerate() {
                    let start = context.dofs.start[node as usize] as usize;
                    for i in 0..M {
                        u[a][i].d[0] = weights.force[start + i];
                    }
                }
                self.set(&mut along, e);
                let answer = self.respond(
                    kernels.respond_along,
                    e,
                    context,
                    (&x, &u),
                    &mut along,
                    Some(&mut tape),
                );
                failed |= answer.failed;
                if wanted.displacements {
                    let to = &mut out.displacements[M * N * e..][..M * N];
                    for (to, force) in to.iter_mut().zip(answer.force.as_flattened()) {
                        *to = force.d[0];
                    }
                }
                if wanted.state {
                    out.state[n_state * e..][..n_state].copy_from_slice(&tape.gradient);
                }
                tape.modes.clear();
                tape.modes.extend(along.alpha.along());
                tape.way = Way::Forwards;
            }
            for group in forward.chunks(WIDTH) {
                let mut x = x0.map(|p| p.map(Number::real));
                let mut u = u0.map(|p| p.map(Number::real));
                self.set(&mut inputs, e);
                for (variable, &input) in group.iter().enumerate() {
                    match input {
                        Input::Position(k) => x[k / 2][k % 2].d[variable] = 1.0,
                        Input::Displacement(k) => u[k / M][k % M].d[variable] = 1.0,
                        Input::State(k) => inputs.old.seed(k, variable),
                        Input::Thickness(p) => inputs.thickness.seed(p, variable),
                        Input::Initial(k) => inputs.initial.seed(k, variable),
                    }
                }
                let on = taped.then_some(&mut tape);
                let respond = kernels.respond_number;
                let answer = self.respond(respond, e, context, (&x, &u), &mut inputs, on);
                failed |= answer.failed;
                let mut sum = self.weighted(e, context, weights, own, &answer.force, &inputs.new);
                for (s, d) in sum.iter_mut().zip(std::mem::take(&mut tape.sum)) {
                    *s += d;
                }
                for (&input, &d) in group.iter().zip(&sum) {
                    match input {
                        Input::Position(k) => out.positions[2 * N * e + k] = d,
                        Input::Displacement(k) => out.displacements[M * N * e + k] = d,
                        Input::State(k) => out.state[n_state * e + k] = d,
                        Input::Thickness(p) => out.thickness[n_points * e + p] = d,
                        Input::Initial(k) => out.initial[4 * n_points * e + k] = d,
                    }
                }
            }
            out.inexact |= !(taped && tape.exact) || section.law.ideal();
            if failed {
                out.failed.push(self.elements[e] as usize);
            }
        }
        out
    }

    /// Derivatives of the weighted sum of forces and new state of an element.
    fn weighted(
        &self,
        e: usize,
        context: &Context<'_>,
        weights: &Weights<'_>,
        state: &[f64],
        force: &Nodal<Number, N, M>,
        new: &Stored,
    ) -> [f64; WIDTH] {
        let mut sum = [0.0; WIDTH];
        for (a, &node) in self.nodes[e].iter().enumerate() {
            let start = context.dofs.start[node as usize] as usize;
            for i in 0..M {
                for (s, d) in sum.iter_mut().zip(force[a][i].d) {
                    *s += weights.force[start + i] * d;
                }
            }
        }
        for (weight, number) in state.iter().zip(new.places.chunks_exact(new.stride)) {
            for (s, d) in sum.iter_mut().zip(&number[1..]) {
                *s += weight * d;
            }
        }
        sum
    }
}
