// SPDX-License-Identifier: BSD-3-Clause
//! Numeric multifrontal factorization over the tree of fronts.
//!
//! The pieces below the top of the tree go to whichever thread is free; the
//! fronts of the top share their tiles. Every front sums its children in a fixed
//! order, so the digits do not depend on the threads.

use std::sync::Mutex;

use rayon::prelude::*;

use super::delayed_pivots::{self, DelayedFront, Special};
use super::dense::{self, Scratch};
use super::symbolic::Symbolic;

/// Values of a factorization: `panels` as laid out by `Symbolic`, `d` the pivots.
#[derive(Default)]
pub struct Numeric {
    pub panels: Vec<f64>,
    pub d: Vec<f64>,
    /// Fronts that needed exchanges or hold columns their children could not eliminate.
    pub special: Vec<Option<Box<Special>>>,
    arenas: Mutex<Vec<Arena>>,
    buffers: Mutex<Vec<Vec<f64>>>,
}

/// Working memory of one thread, kept between factorizations.
#[derive(Default)]
struct Arena {
    stack: [Vec<f64>; 2],
    scratch: Scratch,
}

/// What a front hands to its parent.
pub enum Update {
    /// Nothing (a root).
    Empty,
    /// A square on the stack of this parity, at this place.
    Stacked(usize),
    /// A square of its own.
    Owned(Vec<f64>),
    /// A square with columns that could not be eliminated in front.
    DelayedFront(Box<DelayedFront>),
}

/// Slices of the factor that belong to one subtree.
struct Parts<'a> {
    panels: &'a mut [f64],
    d: &'a mut [f64],
    special: &'a mut [Option<Box<Special>>],
}

impl<'a> Parts<'a> {
    fn split(self, panels: usize, d: usize, fronts: usize) -> (Parts<'a>, Parts<'a>) {
        let (p0, p1) = self.panels.split_at_mut(panels);
        let (d0, d1) = self.d.split_at_mut(d);
        let (s0, s1) = self.special.split_at_mut(fronts);
        (Parts { panels: p0, d: d0, special: s0 }, Parts { panels: p1, d: d1, special: s1 })
    }
}

/// What all threads read.
struct Shared<'a> {
    symbolic: &'a Symbolic,
    values: &'a [f64],
    threads: usize,
    arenas: &'a Mutex<Vec<Arena>>,
    buffers: &'a Mutex<Vec<Vec<f64>>>,
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

impl Numeric {
    /// Memory for the factor of a pattern.
    pub fn new(symbolic: &Symbolic) -> Self {
        let mut special = Vec::new();
        special.resize_with(symbolic.fronts.len(), || None);
        Self {
            panels: vec![0.0; symbolic.factor_len],
            d: vec![0.0; symbolic.n],
            special,
            ..Self::default()
        }
    }

    /// Factorizes scaled values; rayon's current pool is used if `threads > 1`.
    pub fn factorize(&mut self, symbolic: &Symbolic, values: &[f64], threads: usize) {
        let shared =
            Shared { symbolic, values, threads, arenas: &self.arenas, buffers: &self.buffers };
        let parts = Parts { panels: &mut self.panels, d: &mut self.d, special: &mut self.special };
        let _ = shared.children(&symbolic.roots, 0, parts);
    }
}

impl Shared<'_> {
    /// Factorizes the subtrees of `list`, which fill `parts` from front `begin` on.
    fn children(&self, list: &[u32], begin: usize, mut parts: Parts<'_>) -> Vec<Update> {
        let fronts = &self.symbolic.fronts;
        let mut jobs = Vec::with_capacity(list.len());
        let mut at = begin;
        for &c in list {
            let c = c as usize;
            let start = &fronts[at];
            let end = &fronts[c];
            let panels = end.panel_at + end.height() * end.width - start.panel_at;
            let d = end.first + end.width - start.first;
            let (own, rest) = parts.split(panels, d, c + 1 - at);
            jobs.push((c, at, own));
            parts = rest;
            at = c + 1;
        }
        if self.threads > 1 && list.len() > 1 {
            jobs.into_par_iter().with_max_len(1).map(|(c, at, p)| self.subtree(c, at, p)).collect()
        } else {
            jobs.into_iter().map(|(c, at, p)| self.subtree(c, at, p)).collect()
        }
    }

    fn subtree(&self, s: usize, begin: usize, parts: Parts<'_>) -> Update {
        let mut arena = lock(self.arenas).pop().unwrap_or_default();
        if !self.symbolic.fronts[s].top {
            let update = self.piece(s, begin, parts, &mut arena);
            lock(self.arenas).push(arena);
            return update;
        }
        lock(self.arenas).push(arena);
        let front = &self.symbolic.fronts[s];
        let start = &self.symbolic.fronts[begin];
        let (below, own) =
            parts.split(front.panel_at - start.panel_at, front.first - start.first, s - begin);
        let updates = self.children(self.symbolic.children(s), begin, below);
        arena = lock(self.arenas).pop().unwrap_or_default();
        let update = self.front(s, own, &updates, &[], &mut arena.scratch);
        lock(self.arenas).push(arena);
        for used in updates {
            self.give_back(used);
        }
        update
    }

    /// A whole piece of the tree on one thread with its stack.
    fn piece(&self, root: usize, begin: usize, parts: Parts<'_>, arena: &mut Arena) -> Update {
        let sym = self.symbolic;
        for side in 0..2 {
            if arena.stack[side].len() < sym.stack_len[side] {
                arena.stack[side] = vec![0.0; sym.stack_len[side]];
            }
        }
        let (panel0, first0) = (sym.fronts[begin].panel_at, sym.fronts[begin].first);
        let mut top = [0_usize; 2];
        let mut pending: Vec<Update> = Vec::new();
        for s in begin..=root {
            let f = &sym.fronts[s];
            let mut front = Parts {
                panels: &mut parts.panels[f.panel_at - panel0..][..f.height() * f.width],
                d: &mut parts.d[f.first - first0..][..f.width],
                special: &mut parts.special[s - begin..=s - begin],
            };
            let count = sym.children(s).len();
            let updates = pending.split_off(pending.len() - count);
            let (own, other) = (usize::from(f.odd), usize::from(!f.odd));
            let (even_stack, odd_stack) = arena.stack.split_at_mut(1);
            let (mine, theirs) = if f.odd {
                (&mut odd_stack[0], &even_stack[0])
            } else {
                (&mut even_stack[0], &odd_stack[0])
            };
            let scratch = &mut arena.scratch;
            let update = if s == root {
                self.front(s, front, &updates, theirs, scratch)
            } else {
                // The square is worked on in place, at the top of this parity's stack.
                let place = top[own];
                let len = f.below * f.below;
                let out = &mut mine[place..place + len];
                let held = self.front_into(s, &mut front, &updates, theirs, scratch, out);
                held.map_or_else(
                    || {
                        top[own] += len;
                        Update::Stacked(place)
                    },
                    Update::DelayedFront,
                )
            };
            for (u, &c) in updates.into_iter().zip(sym.children(s)) {
                if let Update::Stacked(_) = u {
                    top[other] -= sym.fronts[c as usize].below.pow(2);
                }
            }
            pending.push(update);
        }
        pending.pop().unwrap_or(Update::Empty)
    }

    /// Factorizes one front whose square goes to a buffer of its own.
    fn front(
        &self,
        s: usize,
        mut own: Parts<'_>,
        updates: &[Update],
        stack: &[f64],
        scratch: &mut Scratch,
    ) -> Update {
        let len = self.symbolic.fronts[s].below.pow(2);
        let mut out = self.take(len);
        match self.front_into(s, &mut own, updates, stack, scratch, &mut out[..len]) {
            Some(held) => {
                self.give_back(Update::Owned(out));
                Update::DelayedFront(held)
            }
            None => Update::Owned(out),
        }
    }

    /// Factorizes one front; its square goes to `out` unless columns are held back.
    fn front_into(
        &self,
        s: usize,
        own: &mut Parts<'_>,
        updates: &[Update],
        stack: &[f64],
        scratch: &mut Scratch,
        out: &mut [f64],
    ) -> Option<Box<DelayedFront>> {
        let sym = self.symbolic;
        let f = &sym.fronts[s];
        let (panel, d) = (&mut *own.panels, &mut *own.d);
        own.special[0] = None;
        let share = f.top && self.threads > 1;
        let squares: Vec<delayed_pivots::Child<'_>> = updates
            .iter()
            .zip(sym.children(s))
            .map(|(u, &c)| {
                let c = c as usize;
                let below = sym.fronts[c].below;
                let (square, held): (&[f64], &[u32]) = match u {
                    Update::Empty => (&[], &[]),
                    Update::Stacked(at) => (&stack[*at..at + below * below], &[]),
                    Update::Owned(v) => (&v[..below * below], &[]),
                    Update::DelayedFront(h) => (&h.square, &h.equations),
                };
                delayed_pivots::Child {
                    square,
                    held,
                    relative: sym.relative_of(c),
                    into_columns: sym.fronts[c].into_columns,
                }
            })
            .collect();
        let plain = squares.iter().all(|c| c.held.is_empty());
        if plain {
            let height = f.height();
            panel.fill(0.0);
            for &(k, place) in sym.entries_of(s) {
                panel[place as usize] += self.values[k as usize];
            }
            for child in &squares {
                add_columns(child, panel, height);
            }
            if dense::eliminate(panel, height, f.width, d, scratch, share) {
                if f.below > 0 {
                    dense::contribution(panel, height, f.width, d, out, scratch, share);
                    for child in &squares {
                        add_rest(child, out, f.width, f.below);
                    }
                }
                return None;
            }
        }
        let (kept, held) = delayed_pivots::factorize(sym, s, self.values, &squares);
        own.special[0] = Some(Box::new(kept));
        if held.equations.is_empty() {
            out.copy_from_slice(&held.square);
            return None;
        }
        Some(Box::new(held))
    }

    fn take(&self, len: usize) -> Vec<f64> {
        let mut pool = lock(self.buffers);
        let fit = pool
            .iter()
            .enumerate()
            .filter(|(_, b)| b.len() >= len)
            .min_by_key(|(_, b)| b.len())
            .map(|(k, _)| k);
        match fit {
            Some(k) => pool.swap_remove(k),
            None => vec![0.0; len],
        }
    }

    fn give_back(&self, update: Update) {
        if let Update::Owned(buffer) = update
            && !buffer.is_empty()
        {
            lock(self.buffers).push(buffer);
        }
    }
}

/// Adds the columns of a child's square that fall into the parent's panel.
fn add_columns(child: &delayed_pivots::Child<'_>, panel: &mut [f64], height: usize) {
    let below = child.relative.len();
    for j in 0..child.into_columns {
        let column = &mut panel[child.relative[j] as usize * height..][..height];
        add_column(column, &child.square[j * below + j..(j + 1) * below], &child.relative[j..], 0);
    }
}

/// Adds the columns of a child's square that fall into the parent's square.
fn add_rest(child: &delayed_pivots::Child<'_>, out: &mut [f64], width: usize, side: usize) {
    let below = child.relative.len();
    for j in child.into_columns..below {
        let column = &mut out[(child.relative[j] as usize - width) * side..][..side];
        let source = &child.square[j * below + j..(j + 1) * below];
        add_column(column, source, &child.relative[j..], width);
    }
}

#[inline]
fn add_column(column: &mut [f64], source: &[f64], places: &[u32], shift: usize) {
    for (&v, &place) in source.iter().zip(places) {
        column[place as usize - shift] += v;
    }
}
