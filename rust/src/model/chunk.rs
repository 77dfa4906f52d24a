//! A chunk as the model sees it: some hundred elements of one block, whatever their type.
// SPDX-License-Identifier: BSD-3-Clause

use super::dofs::Dofs;
use super::dynamics::{Between, BodyLoad, Momenta, Motion};
use super::scatter::Sink;
use super::sensitivity::{Gradients, Weights};
use crate::base::Lanes;
use crate::kinematics::inertia::MassKind;
use crate::kinematics::integrate::Section;
use crate::materials::Clock;
use crate::materials::by_temperature::LawTable;

/// Elements a chunk; large enough to hide a virtual call, small enough to color well.
pub const CHUNK: usize = 512;
/// Parts of the state of a chunk.
pub const PARTS: usize = 6;

/// How elements move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// Infinitesimally.
    Linear,
    /// Infinitesimally; the tangent is that about the state, with the stiffness of its stress on
    /// the reference shape.
    Stressed,
    /// By finite displacements.
    Finite,
}

/// What an evaluation needs besides the elements.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// Reference coordinates by node.
    pub x: &'a [[f64; 2]],
    /// Displacements by dof.
    pub u: &'a [f64],
    pub dofs: &'a Dofs,
    /// Whether frames turn (geometrically nonlinear).
    pub nlgeom: bool,
    /// Whether the tangent has the stiffness that the stress of a linear state has on the
    /// reference shape; only where frames stay.
    pub stressed: bool,
    pub tangent: bool,
    /// Instructions to use.
    pub lanes: Lanes,
    pub clock: Clock,
}

impl<'a> Context<'a> {
    /// By finite displacements, without a tangent, about the committed state.
    pub fn new(x: &'a [[f64; 2]], dofs: &'a Dofs, lanes: Lanes, u: &'a [f64]) -> Self {
        Self {
            x,
            u,
            dofs,
            nlgeom: true,
            stressed: false,
            tangent: false,
            lanes,
            clock: Clock::default(),
        }
    }
}

/// What all chunks of a block share.
pub struct Shared<const N: usize> {
    pub block: usize,
    pub section: Section<N>,
    /// The section where the frames stay, and there with the stiffness of the stress.
    pub linear: Section<N>,
    pub stressed: Section<N>,
    /// Mass per volume; 0 if none was given.
    pub rho: f64,
    /// The law by temperature, if it depends on it.
    pub table: Option<LawTable>,
    /// Whether the section's parameter is given and does not follow the law.
    pub weighted: bool,
    /// Thickness and density of the nodes of all elements of the block, `[n, N]`; empty where those
    /// of the section hold.
    pub nodal_thickness: Vec<f64>,
    pub sides: Vec<f64>,
    pub nodal_density: Vec<f64>,
    pub mass_points: Vec<crate::elements::Point<N>>,
}

impl<const N: usize> Shared<N> {
    /// Section for frames that turn, or stay.
    pub fn section(&self, nlgeom: bool) -> &Section<N> {
        if nlgeom { &self.section } else { &self.linear }
    }
}

/// A chunk seen without its element type.
pub trait Chunk: Send + Sync {
    /// Add forces and stiffnesses; returns the indices (in the block) of failed elements.
    fn assemble(&mut self, context: &Context<'_>, sink: &Sink<'_>) -> Vec<usize>;
    /// Gradients of the weighted forces and new state of the elements, in the order of
    /// [`Chunk::elements`].
    fn differentiate(&self, context: &Context<'_>, weights: &Weights<'_>) -> Gradients;
    /// Values at the points, in the order of [`Chunk::elements`].
    fn recover(&self, context: &Context<'_>, out: &mut super::recover::Fields);
    /// Add the nodal forces of a body force at the displacements of the context and, if it wants
    /// a tangent, `share` times their derivative; `mask` by element of the block.
    fn body_force(
        &self,
        context: &Context<'_>,
        load: &BodyLoad<'_>,
        mask: &[bool],
        sink: &Sink<'_>,
    );
    /// Add inertia forces and effective tangents.
    fn inertia(&self, context: &Context<'_>, motion: &Motion<'_>, sink: &Sink<'_>);
    /// Add the forces of a conserving step; returns failed elements.
    fn conserving(
        &mut self,
        context: &Context<'_>,
        between: &Between<'_>,
        sink: &Sink<'_>,
        internal: &Sink<'_>,
    ) -> Vec<usize>;
    /// Set the carried velocities of the conserving scheme.
    fn start(&mut self, context: &Context<'_>, v: &[f64]);
    /// Add kinetic energy and momenta; the energies of elements go to `each`, by their index
    /// in the block, unless it is empty.
    fn momenta(
        &self,
        context: &Context<'_>,
        v: &[f64],
        kind: MassKind,
        carried: bool,
        sums: &mut Momenta,
        each: &mut [f64],
    );
    /// Set the initial strains from those of the block, `[n, p, 4]`.
    fn set_initial(&mut self, values: &[f64]);
    /// Let the law follow temperatures of the block, `[n, p]`.
    fn set_temperatures(&mut self, values: &[f64]) -> Result<(), String>;
    /// Let other nodes of the elements carry the mass of these, given by node; empty for none.
    fn set_massless(&mut self, massless: &[bool]);
    /// Factors on the masses of the elements of the block; empty for one.
    fn set_mass_factors(&mut self, factors: &[f64]);
    /// Make the trial history of the last evaluation, if there was one, the committed one.
    fn commit(&mut self);
    /// Strains at the points with the committed or the trial internal modes, written to the
    /// block's array.
    fn strains(&self, context: &Context<'_>, committed: bool, out: &mut [f64]);
    /// Read the committed history from the block's array `[n, p, members]`.
    fn give(&mut self, values: &[f64]);
    /// Largest growth of the equivalent plastic strain from the committed to the trial state.
    fn plastic_increment(&self) -> f64;
    /// Largest error of the creep strain of the last evaluation.
    fn creep_error(&self) -> f64;
    fn block(&self) -> usize;
    /// Index of each element in the block.
    fn elements(&self) -> &[u32];
    /// Nodes of all elements.
    fn nodes(&self) -> Vec<u32>;
    /// Forget all strain: the elements are as new in the shape that these displacements give them.
    fn renew(&mut self, context: &Context<'_>);
    /// Committed history, internal modes, carried velocities, initial strains, temperatures and
    /// displacements without strain.
    fn state(&self) -> [&[f64]; PARTS];
    /// Members of the history of an element.
    fn members(&self) -> usize;
    /// Write the history of each element, committed or of the last evaluation, to the block's
    /// array `[n, members]`.
    fn histories(&self, trial: bool, out: &mut [f64]);
    /// Take the committed history from such an array.
    fn set_histories(&mut self, values: &[f64]);
    /// Take such a state; `false` if it does not fit.
    fn restore(&mut self, state: [&[f64]; PARTS]) -> bool;
}
