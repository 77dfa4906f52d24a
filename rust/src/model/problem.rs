//! The whole discrete model: blocks of elements, their chunks by color, assembly.
// SPDX-License-Identifier: BSD-3-Clause

use super::build::{Block, BlockInput, build, color};
use super::chunk::{Chunk, Context, Kinematics, PARTS};
use super::dofs::Dofs;
use super::dynamics::{Between, BodyLoad, Momenta, Motion};
use super::fixed_dofs::FixedDofs;
use super::recover::Fields;
use super::registry;
use super::scatter::Sink;
use super::sensitivity::{Gradients, Sums, Weights};
use crate::base::thread_autotuner::ThreadAutotuner;
use crate::base::{Lanes, pool};
use crate::kinematics::inertia::MassKind;
use crate::materials::Clock;
use std::sync::Arc;

use rayon::prelude::*;

/// Elements that could not be evaluated: pairs of block and index in it.
#[derive(Clone, Debug, Default)]
pub struct Failed(pub Vec<(usize, usize)>);

/// Elements from which threads always share the work; below, the faster way is found out.
const SHARED: usize = 100_000;
/// Chunks that threads recover before their values are gathered.
const RECOVERED: usize = 64;

pub struct Problem {
    pub x: Vec<[f64; 2]>,
    pub dofs: Dofs,
    pub blocks: Vec<Block>,
    /// Chunks of one color share no node.
    colors: Vec<Vec<Box<dyn Chunk>>>,
    threads: usize,
    lanes: Lanes,
    clock: Clock,
    fixed: FixedDofs,
    assemble_tuner: ThreadAutotuner,
    recover_tuner: ThreadAutotuner,
    inertia_tuner: ThreadAutotuner,
    conserving_tuner: ThreadAutotuner,
    body_tuner: ThreadAutotuner,
    active: Vec<bool>,
    /// Blocks that are no part of the structure for the time being; empty for none.
    removed: Vec<bool>,
}

impl Problem {
    /// Number the dofs and lay out the chunks. Nodes without elements carry no dofs, unless
    /// `extra_dofs` gives them some.
    pub fn new(x: Vec<[f64; 2]>, inputs: &[BlockInput], extra_dofs: &[u8]) -> Result<Self, String> {
        let mut per_node = vec![0u8; x.len()];
        per_node[..extra_dofs.len()].copy_from_slice(extra_dofs);
        let mut cells = Vec::new();
        for input in inputs {
            let facts = registry::find(&input.element)?;
            if input.nodes.iter().any(|&n| n as usize >= x.len()) {
                return Err(format!("{}: a node index is outside the mesh", input.element));
            }
            for &n in &input.nodes {
                let m = &mut per_node[n as usize];
                *m = (*m).max(facts.dofs_per_node as u8);
            }
            cells.push((input.nodes.as_slice(), facts.n_nodes));
        }
        let dofs = Dofs::new(&per_node, &cells);
        let mut blocks = Vec::new();
        let mut chunks: Vec<Box<dyn Chunk>> = Vec::new();
        for (b, input) in inputs.iter().enumerate() {
            let (block, own) = build(b, input, &x, &dofs)?;
            blocks.push(block);
            chunks.extend(own);
        }
        let colors = color(chunks, x.len());
        Ok(Self {
            x,
            dofs,
            blocks,
            colors,
            threads: 1,
            lanes: Lanes::Best,
            clock: Clock::default(),
            fixed: FixedDofs::default(),
            assemble_tuner: ThreadAutotuner::default(),
            recover_tuner: ThreadAutotuner::default(),
            inertia_tuner: ThreadAutotuner::default(),
            conserving_tuner: ThreadAutotuner::default(),
            body_tuner: ThreadAutotuner::default(),
            active: Vec::new(),
            removed: Vec::new(),
        })
    }

    /// Use so many threads from now on; results do not depend on it.
    pub fn set_threads(&mut self, n: usize) {
        (self.assemble_tuner, self.recover_tuner) = Default::default();
        (self.inertia_tuner, self.conserving_tuner, self.body_tuner) = Default::default();
        self.threads = n;
    }

    /// The threads of this process; none for one.
    fn pool(&self) -> Option<Arc<rayon::ThreadPool>> {
        if self.threads > 1 { pool::get(self.threads) } else { None }
    }

    /// The threads, where two chunks can run side by side; else a pool costs more than it brings.
    fn pool_if_apart(&self) -> Option<Arc<rayon::ThreadPool>> {
        if self.colors.iter().any(|c| c.len() > 1) { self.pool() } else { None }
    }

    /// Use these instructions from now on; results differ by rounding.
    pub fn set_lanes(&mut self, lanes: Lanes) {
        self.lanes = lanes;
    }

    /// The time that assemblies span from now on.
    pub fn set_clock(&mut self, clock: Clock) {
        self.clock = clock;
    }

    /// Let only these blocks take part in assembly and inertia; empty for all.
    pub fn set_active(&mut self, active: Vec<bool>) {
        self.active = active;
    }

    /// Take these blocks out of the structure: they have no force, no mass and no values; empty for
    /// none.
    pub fn set_removed(&mut self, removed: Vec<bool>) {
        self.removed = removed;
    }

    /// Let the elements of a block have no strain at displacements `u`, and no history.
    pub fn renew(&mut self, block: usize, u: &[f64]) {
        let context = Context::new(&self.x, &self.dofs, self.lanes, u);
        for chunk in self.colors.iter_mut().flatten().filter(|c| c.block() == block) {
            chunk.renew(&context);
        }
    }

    /// Internal force, its scale, and with a non-empty `values` the tangent's upper triangle.
    /// The arrays are overwritten.
    pub fn assemble(
        &mut self,
        u: &[f64],
        kinematics: Kinematics,
        force: &mut [f64],
        scale: &mut [f64],
        values: &mut [f64],
    ) -> Result<(), Failed> {
        let context = Context {
            nlgeom: kinematics == Kinematics::Finite,
            stressed: kinematics == Kinematics::Stressed,
            tangent: !values.is_empty(),
            clock: self.clock,
            ..Context::new(&self.x, &self.dofs, self.lanes, u)
        };
        let pool = self.pool_if_apart();
        let (colors, active, removed) = (&mut self.colors, &self.active, &self.removed);
        let work = |pool: bool| {
            for array in [&mut *force, &mut *scale, &mut *values] {
                zero(array, pool);
            }
            let sink = Sink::new(force, scale, values);
            failures(colors, pool, &|c| {
                if is_idle(c.block(), active, removed) {
                    Vec::new()
                } else {
                    c.assemble(&context, &sink)
                }
            })
        };
        let mut failed = share(&mut self.assemble_tuner, pool.as_deref(), &self.blocks, work);
        failed.sort_unstable();
        if failed.is_empty() { Ok(()) } else { Err(Failed(failed)) }
    }

    /// Add inertia forces to `force` and `scale`, and effective tangents to `values`.
    pub fn inertia(
        &mut self,
        u: &[f64],
        motion: &Motion<'_>,
        force: &mut [f64],
        scale: &mut [f64],
        values: &mut [f64],
    ) {
        let tangent = !values.is_empty();
        let context = Context { tangent, ..Context::new(&self.x, &self.dofs, self.lanes, u) };
        let sink = Sink::new(force, scale, values);
        let (colors, active, removed) = (&self.colors, &self.active, &self.removed);
        let evaluate = |c: &dyn Chunk| {
            if !is_idle(c.block(), active, removed) {
                c.inertia(&context, motion, &sink);
            }
        };
        let pool = self.pool_if_apart();
        let work = |pool: bool| each_chunk(colors, pool, &evaluate);
        share(&mut self.inertia_tuner, pool.as_deref(), &self.blocks, work);
    }

    /// Forces of a conserving step to `u`: internal and inertia in `force`, internal alone in
    /// `internal`. The arrays are overwritten.
    pub fn conserving(
        &mut self,
        u: &[f64],
        between: &Between<'_>,
        nlgeom: bool,
        [force, internal, scale, values]: [&mut [f64]; 4],
    ) -> Result<(), Failed> {
        let mut unused = vec![0.0; scale.len()];
        for array in [&mut *force, &mut *internal, &mut *scale, &mut *values] {
            array.fill(0.0);
        }
        let tangent = !values.is_empty();
        let context = Context {
            nlgeom,
            tangent,
            clock: self.clock,
            ..Context::new(&self.x, &self.dofs, self.lanes, u)
        };
        let sink = Sink::new(force, scale, values);
        let alone = Sink::new(internal, &mut unused, &mut []);
        let pool = self.pool_if_apart();
        let (colors, removed) = (&mut self.colors, &self.removed);
        let evaluate = |c: &mut dyn Chunk| {
            if is_idle(c.block(), &[], removed) {
                Vec::new()
            } else {
                c.conserving(&context, between, &sink, &alone)
            }
        };
        let work = |pool: bool| failures(colors, pool, &evaluate);
        let failed = share(&mut self.conserving_tuner, pool.as_deref(), &self.blocks, work);
        if failed.is_empty() { Ok(()) } else { Err(Failed(failed)) }
    }

    /// Begin a motion of the conserving scheme.
    pub fn start_motion(&mut self, u: &[f64], v: &[f64]) {
        let context = Context::new(&self.x, &self.dofs, self.lanes, u);
        for chunk in self.colors.iter_mut().flatten() {
            chunk.start(&context, v);
        }
    }

    /// Kinetic energy of each element of a block.
    pub fn kinetic(
        &self,
        block: usize,
        u: &[f64],
        v: &[f64],
        kind: MassKind,
        carried: bool,
    ) -> Result<Vec<f64>, String> {
        let own = self.blocks.get(block).ok_or_else(|| format!("no block {block}"))?;
        let mut each = vec![0.0; own.n_elements];
        if is_idle(block, &[], &self.removed) {
            return Ok(each);
        }
        let context = Context::new(&self.x, &self.dofs, self.lanes, u);
        let mut sums = Momenta::default();
        for chunk in self.colors.iter().flatten().filter(|c| c.block() == block) {
            chunk.momenta(&context, v, kind, carried, &mut sums, &mut each);
        }
        Ok(each)
    }

    /// Kinetic energy and momenta of a motion.
    pub fn momenta(&self, u: &[f64], v: &[f64], kind: MassKind, carried: bool) -> Momenta {
        let context = Context::new(&self.x, &self.dofs, self.lanes, u);
        let mut sums = Momenta::default();
        let chunks = self.colors.iter().flatten();
        for chunk in chunks.filter(|c| !is_idle(c.block(), &[], &self.removed)) {
            chunk.momenta(&context, v, kind, carried, &mut sums, &mut []);
        }
        sums
    }

    /// Set the initial strain of a block, `[n, p, 4]`; empty for none.
    pub fn set_initial(&mut self, block: usize, values: &[f64]) -> Result<(), String> {
        let Some(b) = self.blocks.get(block) else {
            return Err(format!("no block {block}"));
        };
        if !values.is_empty() && values.len() != 4 * b.facts.n_points * b.n_elements {
            return Err("initial strains do not fit the block".into());
        }
        for chunk in self.colors.iter_mut().flatten().filter(|c| c.block() == block) {
            chunk.set_initial(values);
        }
        Ok(())
    }

    /// Let the law of a block follow temperatures, `[n, p]`.
    pub fn set_temperatures(&mut self, block: usize, values: &[f64]) -> Result<(), String> {
        let b = self.blocks.get(block).ok_or_else(|| format!("no block {block}"))?;
        if values.len() != b.facts.n_points * b.n_elements {
            return Err("temperatures do not fit the block".into());
        }
        for chunk in self.colors.iter_mut().flatten().filter(|c| c.block() == block) {
            chunk.set_temperatures(values)?;
        }
        Ok(())
    }

    /// Let other nodes of their elements carry the mass of these, given by node; empty for none.
    pub fn set_massless(&mut self, massless: &[bool]) -> Result<(), String> {
        if !massless.is_empty() && massless.len() != self.x.len() {
            return Err("flags do not fit the nodes".into());
        }
        for chunk in self.colors.iter_mut().flatten() {
            chunk.set_massless(massless);
        }
        Ok(())
    }

    /// Set factors on the masses of the elements of a block; empty for one.
    pub fn set_mass_factors(&mut self, block: usize, factors: &[f64]) -> Result<(), String> {
        let own = self.blocks.get(block).ok_or_else(|| format!("no block {block}"))?;
        if !factors.is_empty() && factors.len() != own.n_elements {
            return Err("factors do not fit the elements".into());
        }
        for chunk in self.colors.iter_mut().flatten().filter(|c| c.block() == block) {
            chunk.set_mass_factors(factors);
        }
        Ok(())
    }

    /// Make the trial histories of the last evaluation the committed ones.
    pub fn commit(&mut self) {
        for chunk in self.colors.iter_mut().flatten() {
            chunk.commit();
        }
    }

    /// Committed states of all chunks, one after the other, and the lengths of their parts.
    pub fn state(&self) -> (Vec<f64>, Vec<u64>) {
        let (mut values, mut lengths) = (Vec::new(), Vec::new());
        for chunk in self.colors.iter().flatten() {
            for part in chunk.state() {
                values.extend_from_slice(part);
                lengths.push(part.len() as u64);
            }
        }
        (values, lengths)
    }

    /// Take the states that [`Problem::state`] gave of the same model.
    pub fn restore(&mut self, values: &[f64], lengths: &[u64]) -> Result<(), String> {
        let wrong = || "the state does not fit the problem".to_string();
        let chunks: Vec<_> = self.colors.iter_mut().flatten().collect();
        if lengths.len() != PARTS * chunks.len() {
            return Err(wrong());
        }
        let mut rest = values;
        for (chunk, own) in chunks.into_iter().zip(lengths.as_chunks::<PARTS>().0) {
            let mut parts: [&[f64]; PARTS] = [&[]; PARTS];
            for (part, &length) in parts.iter_mut().zip(own) {
                let length = usize::try_from(length).map_err(|_| wrong())?;
                (*part, rest) = rest.split_at_checked(length).ok_or_else(wrong)?;
            }
            if !chunk.restore(parts) {
                return Err(wrong());
            }
        }
        if rest.is_empty() { Ok(()) } else { Err(wrong()) }
    }

    /// Largest growth of the equivalent plastic strain since the last commit.
    pub fn plastic_increment(&self) -> f64 {
        let chunks = self.colors.iter().flatten();
        chunks.map(|c| c.plastic_increment()).fold(0.0, f64::max)
    }

    /// Largest error of the creep strain of the last evaluation.
    pub fn creep_error(&self) -> f64 {
        let chunks = self.colors.iter().flatten();
        chunks.map(|c| c.creep_error()).fold(0.0, f64::max)
    }

    /// Add the nodal force of a body force at displacements `u`, or its mean over the conserving
    /// step that ends there, and, unless `values` is empty, `load.share` times its derivative;
    /// element masks by block.
    pub fn body_force(
        &mut self,
        u: &[f64],
        load: &BodyLoad<'_>,
        masks: &[Vec<bool>],
        force: &mut [f64],
        values: &mut [f64],
    ) {
        let mut scale = vec![0.0; force.len()];
        let tangent = !values.is_empty();
        let context = Context { tangent, ..Context::new(&self.x, &self.dofs, self.lanes, u) };
        let sink = Sink::new(force, &mut scale, values);
        let removed = &self.removed;
        let evaluate = |c: &dyn Chunk| {
            if !is_idle(c.block(), &[], removed) {
                c.body_force(&context, load, &masks[c.block()], &sink);
            }
        };
        let pool = self.pool_if_apart();
        let colors = &self.colors;
        let work = |pool: bool| each_chunk(colors, pool, &evaluate);
        share(&mut self.body_tuner, pool.as_deref(), &self.blocks, work);
    }

    /// Strains that the materials of a block meet, `[n, p, 3]`, with the committed internal
    /// modes or those of the last evaluation.
    pub fn strains(&self, block: usize, u: &[f64], nlgeom: bool, committed: bool) -> Vec<f64> {
        let b = &self.blocks[block];
        let mut out = vec![0.0; b.n_elements * b.facts.n_points * 3];
        let context = Context { nlgeom, ..Context::new(&self.x, &self.dofs, self.lanes, u) };
        for chunk in self.colors.iter().flatten().filter(|c| c.block() == block) {
            chunk.strains(&context, committed, &mut out);
        }
        out
    }

    /// Write the committed history of a block, `[n, p, members]`.
    pub fn give(&mut self, block: usize, values: &[f64]) -> Result<(), String> {
        let b = &self.blocks[block];
        let wanted = b.n_elements * b.facts.n_points * b.law.n_state();
        if values.len() != wanted {
            return Err(format!("the history has {} numbers, {wanted} are needed", values.len()));
        }
        for chunk in self.colors.iter_mut().flatten().filter(|c| c.block() == block) {
            chunk.give(values);
        }
        Ok(())
    }

    /// Gradients of the weighted forces and new state of the elements at displacements `u` from
    /// the committed state, which stays. The elements are evaluated there first.
    pub fn gradients(
        &mut self,
        u: &[f64],
        nlgeom: bool,
        weights: &Weights<'_>,
    ) -> Result<Sums, Failed> {
        let kinematics = if nlgeom { Kinematics::Finite } else { Kinematics::Linear };
        let [mut force, mut scale] = [0, 1].map(|_| vec![0.0; u.len()]);
        self.assemble(u, kinematics, &mut force, &mut scale, &mut [])?;
        let clock = self.clock;
        let context = Context { nlgeom, clock, ..Context::new(&self.x, &self.dofs, self.lanes, u) };
        let chunks: Vec<&dyn Chunk> = self.colors.iter().flatten().map(AsRef::as_ref).collect();
        let evaluate = |chunk: &&dyn Chunk| chunk.differentiate(&context, weights);
        let parts: Vec<Gradients> = match self.pool() {
            Some(pool) => pool.install(|| chunks.par_iter().map(evaluate).collect()),
            None => chunks.iter().map(evaluate).collect(),
        };
        let mut sums = Sums::new(self.x.len(), &self.dofs, &self.blocks);
        for (chunk, part) in chunks.iter().zip(&parts) {
            sums.add(*chunk, part, &self.dofs);
        }
        sums.failed.sort_unstable();
        if sums.failed.is_empty() { Ok(sums) } else { Err(Failed(sums.failed)) }
    }

    /// Histories of the elements by block, `[n, members]`, committed or of the last evaluation.
    pub fn histories(&self, trial: bool) -> Vec<Vec<f64>> {
        let mut all = vec![Vec::new(); self.blocks.len()];
        for chunk in self.colors.iter().flatten() {
            let own: &mut Vec<f64> = &mut all[chunk.block()];
            own.resize(chunk.members() * self.blocks[chunk.block()].n_elements, 0.0);
            chunk.histories(trial, own);
        }
        all
    }

    /// Make such histories the committed ones.
    pub fn set_histories(&mut self, values: &[Vec<f64>]) -> Result<(), String> {
        for chunk in self.colors.iter_mut().flatten() {
            let wanted = chunk.members() * self.blocks[chunk.block()].n_elements;
            match values.get(chunk.block()) {
                Some(own) if own.len() == wanted => chunk.set_histories(own),
                _ => return Err("the histories do not fit the problem".into()),
            }
        }
        Ok(())
    }

    /// Values at the points of every block, after the time of the clock since the committed state.
    pub fn recover(&mut self, u: &[f64], nlgeom: bool) -> Vec<Fields> {
        let (blocks, removed, pool) = (&self.blocks, &self.removed, self.pool());
        let empty = |block: usize, n: usize| {
            let b = &blocks[block];
            let n_dofs = b.facts.n_nodes * b.facts.dofs_per_node;
            Fields::new(n, b.facts.n_points, n_dofs, &b.law, b.outputs().len())
        };
        let clock = self.clock;
        let context = Context { nlgeom, clock, ..Context::new(&self.x, &self.dofs, self.lanes, u) };
        let evaluate = |chunk: &&dyn Chunk| {
            let mut part = empty(chunk.block(), chunk.elements().len());
            chunk.recover(&context, &mut part);
            if is_idle(chunk.block(), &[], removed) {
                let points = std::mem::take(&mut part.points);
                part = Fields { points, ..empty(chunk.block(), chunk.elements().len()) };
            }
            part
        };
        let chunks: Vec<&dyn Chunk> = self.colors.iter().flatten().map(AsRef::as_ref).collect();
        let work = |pool: bool| {
            let mut fields: Vec<_> =
                blocks.iter().enumerate().map(|(k, b)| empty(k, b.n_elements)).collect();
            // Threads compute some chunks at a time, so that little is held twice.
            for chunks in chunks.chunks(if pool { RECOVERED } else { 1 }) {
                let parts: Vec<Fields> = if pool {
                    chunks.par_iter().map(evaluate).collect()
                } else {
                    chunks.iter().map(evaluate).collect()
                };
                for (chunk, part) in chunks.iter().zip(&parts) {
                    fields[chunk.block()].place(part, chunk.elements());
                }
            }
            fields
        };
        let pool = pool.as_deref().filter(|_| chunks.len() > 1);
        share(&mut self.recover_tuner, pool, blocks, work)
    }

    /// Replace the rows and columns of fixed dofs (see [`FixedDofs::mask`]).
    pub fn mask(&mut self, values: &mut [f64], fixed: &[bool]) {
        self.fixed.set(&self.dofs, fixed);
        self.fixed.mask(values);
    }

    /// Make a linear system of a tangent and one or more right-hand sides for the free dofs: the
    /// fixed ones move by `moved`, and what that takes is subtracted from `rhs`.
    pub fn reduce(&mut self, values: &mut [f64], rhs: &mut [f64], moved: &[f64], fixed: &[bool]) {
        self.fixed.set(&self.dofs, fixed);
        let n = self.dofs.n_dofs().max(1);
        for (b, move_) in rhs.chunks_exact_mut(n).zip(moved.chunks_exact(n)) {
            if move_.iter().any(|&v| v != 0.0) {
                let force = self.dofs.multiply(values, move_);
                b.iter_mut().zip(force).for_each(|(b, f)| *b -= f);
            }
            for &d in &self.fixed.dofs {
                b[d as usize] = 0.0;
            }
        }
        self.fixed.mask(values);
    }
}

/// Whether a block takes no part: it is not `active`, or `removed`; both are empty for all and none.
fn is_idle(block: usize, active: &[bool], removed: &[bool]) -> bool {
    active.get(block) == Some(&false) || removed.get(block) == Some(&true)
}

/// Evaluate all chunks, those of one color side by side if `parallel`.
fn each_chunk(
    colors: &[Vec<Box<dyn Chunk>>],
    parallel: bool,
    evaluate: &(dyn Fn(&dyn Chunk) + Sync),
) {
    for color in colors {
        if parallel && color.len() > 1 {
            color.par_iter().for_each(|c| evaluate(c.as_ref()));
        } else {
            for c in color {
                evaluate(c.as_ref());
            }
        }
    }
}

/// Evaluate all chunks likewise; the elements that failed, by block and index in it.
fn failures(
    colors: &mut [Vec<Box<dyn Chunk>>],
    parallel: bool,
    evaluate: &(dyn Fn(&mut dyn Chunk) -> Vec<usize> + Sync),
) -> Vec<(usize, usize)> {
    let of_block = |chunk: &mut Box<dyn Chunk>| {
        let block = chunk.block();
        let bad = evaluate(chunk.as_mut());
        bad.into_iter().map(|e| (block, e)).collect::<Vec<_>>()
    };
    let mut failed = Vec::new();
    for color in colors {
        if parallel && color.len() > 1 {
            let bad: Vec<_> = color.par_iter_mut().map(of_block).collect();
            failed.extend(bad.into_iter().flatten());
        } else {
            failed.extend(color.iter_mut().flat_map(of_block));
        }
    }
    failed
}

/// Do work on the pool's threads, if there is one and they help; its argument says whether they do.
fn share<R: Send>(
    tuner: &mut ThreadAutotuner,
    pool: Option<&rayon::ThreadPool>,
    blocks: &[Block],
    work: impl FnOnce(bool) -> R + Send,
) -> R {
    let Some(pool) = pool else { return work(false) };
    let elements: usize = blocks.iter().map(|b| b.n_elements).sum();
    if elements > SHARED {
        return pool.install(|| work(true));
    }
    tuner.run(|shared| if shared { pool.install(|| work(true)) } else { work(false) })
}

/// Fill with zeros, by several threads if that is wanted.
fn zero(values: &mut [f64], parallel: bool) {
    if parallel {
        values.par_chunks_mut(1 << 16).for_each(|part| part.fill(0.0));
    } else {
        values.fill(0.0);
    }
}
