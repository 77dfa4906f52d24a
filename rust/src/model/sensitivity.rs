//! Exact derivatives of the forces and of the new state of elements, contracted with weights.
//!
//! The kernels run in numbers that carry derivatives, history, thickness and initial strain
//! included: no element, strain or law has a derivative written for it. Each element gives the
//! gradient of one number, the sum of its forces and of its new state by their weights: what the
//! adjoint of an increment needs (Michaleris, Tortorelli & Vidal 1994).
// SPDX-License-Identifier: BSD-3-Clause

use super::build::Block;
use super::chunk::{Chunk, Context};
use super::chunk_of::ChunkOf;
use super::dofs::Dofs;
use crate::base::small::Nodal;
use crate::base::{Dual, Real};
use crate::elements::Element;
use crate::elements::element;
use crate::kinematics::integrate::{History, Local};
use crate::kinematics::per_point::PerPoint;

/// Derivatives that one evaluation of an element carries.
const WIDTH: usize = 2;
/// Places of a number in a history.
const STRIDE: usize = 1 + WIDTH;

type Number = Dual<WIDTH, true>;

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
struct Stored(Vec<f64>);

impl Stored {
    fn new(n: usize) -> Self {
        Self(vec![0.0; n * STRIDE])
    }
    /// Take values without derivatives.
    fn set(&mut self, value: impl Fn(usize) -> f64) {
        for (k, number) in self.0.chunks_exact_mut(STRIDE).enumerate() {
            number.fill(0.0);
            number[0] = value(k);
        }
    }
    fn seed(&mut self, k: usize, variable: usize) {
        self.0[k * STRIDE + 1 + variable] = 1.0;
    }
}

impl<E, const N: usize, const M: usize, const A: usize> ChunkOf<E, N, M, A>
where
    E: Element<N, M, A>,
{
    /// Members of the state of an element.
    pub(super) fn n_state(&self) -> usize {
        self.old.len() / self.stride.max(1)
    }

    fn inputs(&self, wanted: Wanted) -> Vec<Input> {
        let n_points = self.shared.section.points.len();
        let mut all = Vec::new();
        let mut add = |some: bool, n: usize, make: fn(usize) -> Input| {
            if some {
                all.extend((0..n).map(make));
            }
        };
        add(wanted.positions, 2 * N, Input::Position);
        add(wanted.displacements, M * N, Input::Displacement);
        add(wanted.state, self.n_state(), Input::State);
        add(wanted.thickness, n_points, Input::Thickness);
        add(wanted.initial, 4 * n_points, Input::Initial);
        all
    }

    /// Gradients of all elements of the chunk.
    pub(super) fn differentiate(&self, context: &Context<'_>, weights: &Weights<'_>) -> Gradients {
        let section = self.shared.section(context.nlgeom);
        let (n_points, n_state) = (section.points.len(), self.n_state());
        let inputs = self.inputs(weights.wanted);
        let n = self.nodes.len();
        let mut out = Gradients::default();
        let state = weights.state.get(self.shared.block).map_or(&[][..], Vec::as_slice);
        let sized = |some: bool, count: usize| vec![0.0; if some { count } else { 0 }];
        out.positions = sized(weights.wanted.positions, 2 * N * n);
        out.displacements = sized(weights.wanted.displacements, M * N * n);
        out.state = sized(weights.wanted.state, n_state * n);
        out.thickness = sized(weights.wanted.thickness, n_points * n);
        out.initial = sized(weights.wanted.initial, 4 * n_points * n);
        let (mut old, mut new) = (Stored::new(n_state), Stored::new(n_state));
        let mut alpha = Stored::new(2 * A);
        let mut thickness = Stored::new(n_points);
        let mut sides = Stored::new(if self.sides.is_empty() { 0 } else { N });
        let strained = weights.wanted.initial || !self.initial.is_empty();
        let mut initial = Stored::new(if strained { 4 * n_points } else { 0 });
        let forces = element::Wanted { nlgeom: context.nlgeom, stressed: false, tangent: false };
        for e in 0..n {
            let (x0, u0) = self.gather::<f64>(e, context);
            for group in inputs.chunks(WIDTH) {
                let mut x = x0.map(|p| p.map(Number::real));
                let mut u = u0.map(|p| p.map(Number::real));
                old.set(|k| self.old[k * self.stride + e]);
                new.set(|_| 0.0);
                alpha.set(|k| self.alpha_old()[k * self.stride + e]);
                sides.set(|k| self.sides[k * self.stride + e]);
                thickness.set(|p| {
                    let own = self.thickness.get(p * self.stride + e);
                    own.copied().unwrap_or(section.thickness)
                });
                initial.set(|k| self.initial.get(k * self.stride + e).copied().unwrap_or(0.0));
                for (variable, &input) in group.iter().enumerate() {
                    match input {
                        Input::Position(k) => x[k / 2][k % 2].d[variable] = 1.0,
                        Input::Displacement(k) => u[k / M][k % M].d[variable] = 1.0,
                        Input::State(k) => old.seed(k, variable),
                        Input::Thickness(p) => thickness.seed(p, variable),
                        Input::Initial(k) => initial.seed(k, variable),
                    }
                }
                let mut history = History {
                    old: &old.0,
                    new: &mut new.0,
                    alpha: &mut alpha.0,
                    initial: &initial.0,
                    stride: STRIDE,
                    clock: context.clock,
                    per_point: PerPoint {
                        thickness: &thickness.0,
                        sides: &sides.0,
                        stride: STRIDE,
                        laws: self.laws.as_ref().map(|laws| laws.of(e)),
                    },
                };
                let mut answer = Local::zero();
                E::respond::<Number>(&x, &u, section, &mut history, forces, &mut answer);
                if answer.failed && out.failed.last() != Some(&(self.elements[e] as usize)) {
                    out.failed.push(self.elements[e] as usize);
                }
                let sum = self.weighted(e, context, weights, state, &answer.force, &new.0);
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
        new: &[f64],
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
        if !state.is_empty() {
            let n_state = self.n_state();
            let own = &state[self.elements[e] as usize * n_state..][..n_state];
            for (weight, number) in own.iter().zip(new.chunks_exact(STRIDE)) {
                for (s, d) in sum.iter_mut().zip(&number[1..]) {
                    *s += weight * d;
                }
            }
        }
        sum
    }
}
