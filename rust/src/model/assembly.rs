//! Assembly of chunks: internal forces and tangents of their elements, batch by batch.
// SPDX-License-Identifier: BSD-3-Clause

use super::chunk::Context;
use super::chunk_of::ChunkOf;
use super::dofs::Dofs;
use super::scatter::Sink;
use crate::base::small::{Blocks, Nodal};
use crate::base::{Kernel, Lanes, Real, dispatch};
use crate::elements::Element;
use crate::elements::element::Wanted;
use crate::kinematics::integrate::{History, Local, Section};
use crate::kinematics::per_point::PerPoint;
use std::marker::PhantomData;

/// The assembly of a chunk, to be run with the processor's widest numbers.
struct Assemble<'a, E, const N: usize, const M: usize, const A: usize> {
    chunk: &'a mut ChunkOf<N, M>,
    context: &'a Context<'a>,
    sink: &'a Sink<'a>,
    element: PhantomData<E>,
}

impl<E, const N: usize, const M: usize, const A: usize> Kernel for Assemble<'_, E, N, M, A>
where
    E: Element<N, M, A>,
{
    type Output = Vec<usize>;
    #[inline(always)]
    fn run<T: Real>(self) -> Vec<usize> {
        // Plain numbers share one instance for all element types of these sizes.
        if const { T::LANES == 1 } {
            return self.chunk.one_by_one(self.context, self.sink);
        }
        self.chunk.run::<T>(
            self.context,
            self.sink,
            #[inline(always)]
            |x, u, section, history, wanted, out| E::respond(x, u, section, history, wanted, out),
        )
    }
}

impl<const N: usize, const M: usize> ChunkOf<N, M> {
    /// Assemble elements of type `E` with such numbers; those that failed.
    pub(super) fn batches<E, const A: usize>(
        &mut self,
        lanes: Lanes,
        context: &Context<'_>,
        sink: &Sink<'_>,
    ) -> Vec<usize>
    where
        E: Element<N, M, A>,
    {
        dispatch(lanes, Assemble { chunk: self, context, sink, element: PhantomData::<E> })
    }

    /// Assemble with plain numbers.
    #[inline(never)]
    fn one_by_one(&mut self, context: &Context<'_>, sink: &Sink<'_>) -> Vec<usize> {
        let respond = self.kernels.respond;
        self.run::<f64>(context, sink, respond)
    }

    #[inline(always)]
    fn run<T: Real>(
        &mut self,
        context: &Context<'_>,
        sink: &Sink<'_>,
        respond: impl Fn(
            &Nodal<T, N, 2>,
            &Nodal<T, N, M>,
            &Section<N>,
            &mut History<'_>,
            Wanted,
            &mut Local<T, N, M>,
        ),
    ) -> Vec<usize> {
        let mut failed = Vec::new();
        let n = self.nodes.len();
        let shared = self.shared.clone();
        let members = usize::from(shared.section.law.n_state() > 0);
        let modes = 2 * self.kernels.modes;
        let section =
            if context.stressed { &shared.stressed } else { shared.section(context.nlgeom) };
        let wanted =
            Wanted { nlgeom: context.nlgeom, stressed: context.stressed, tangent: context.tangent };
        for e in (0..n).step_by(T::LANES) {
            let (x, u) = self.gather::<T>(e, context);
            let mut history = History {
                old: &self.old[e * members..],
                new: &mut self.new[e * members..],
                alpha: &mut self.alpha[e.min(modes * self.stride)..],
                initial: if self.initial.is_empty() { &[] } else { &self.initial[e..] },
                stride: self.stride,
                clock: context.clock,
                per_point: PerPoint::of(
                    &self.thickness,
                    &self.sides,
                    self.laws.as_ref(),
                    e,
                    self.stride,
                ),
                tape: None,
            };
            let mut answer = Local::zero();
            respond(&x, &u, section, &mut history, wanted, &mut answer);
            let count = T::LANES.min(n - e);
            if T::any(answer.failed) {
                for l in 0..count {
                    if T::mask_lane(answer.failed, l) {
                        failed.push(self.elements[e + l] as usize);
                    }
                }
            }
            self.scatter_force(e, count, &answer.force, context.dofs, sink);
            if context.tangent {
                self.scatter_stiffness(e, count, &answer.stiffness, context.dofs, sink);
            }
        }
        failed
    }

    /// Add the forces of a batch. Not inlined, so that the packs lie in memory and each lane
    /// is one load.
    #[inline(never)]
    pub(super) fn scatter_force<T: Real>(
        &self,
        first: usize,
        count: usize,
        f: &Nodal<T, N, M>,
        dofs: &Dofs,
        sink: &Sink<'_>,
    ) {
        for l in 0..count {
            let nodes = &self.nodes[first + l];
            for a in 0..N {
                let start = dofs.start[nodes[a] as usize] as usize;
                let mut run = [0.0; M];
                for i in 0..M {
                    run[i] = f[a][i].lanes()[l];
                }
                sink.force.add_run(start, &run);
                for v in &mut run {
                    *v = v.abs();
                }
                sink.scale.add_run(start, &run);
            }
        }
    }

    /// Add the stiffnesses of a batch; not inlined for the same reason.
    #[inline(never)]
    pub(super) fn scatter_stiffness<T: Real>(
        &self,
        first: usize,
        count: usize,
        k: &Blocks<T, N, M>,
        dofs: &Dofs,
        sink: &Sink<'_>,
    ) {
        let pairs = N * (N + 1) / 2;
        for l in 0..count {
            let e = first + l;
            let slots = &self.slots[e * pairs..(e + 1) * pairs];
            let nodes = &self.nodes[e];
            let mut lead = [0; N];
            for a in 0..N {
                lead[a] = dofs.lead[nodes[a] as usize] as usize;
            }
            let mut pair = 0;
            for a in 0..N {
                for b in a..N {
                    let slot = slots[pair] as usize;
                    pair += 1;
                    let m = &k[a][b];
                    // Columns belong to the node with the larger index.
                    let straight = nodes[a] <= nodes[b];
                    let lead = if straight { lead[b] } else { lead[a] };
                    for j in 0..M {
                        let at = slot + j * lead + j * (j + 1) / 2;
                        if a == b {
                            for i in 0..=j {
                                sink.values.add(at + i, m[i][j].lanes()[l]);
                            }
                        } else {
                            let mut run = [0.0; M];
                            for i in 0..M {
                                let v = if straight { &m[i][j] } else { &m[j][i] };
                                run[i] = v.lanes()[l];
                            }
                            sink.values.add_run(at, &run);
                        }
                    }
                }
            }
        }
    }
}
