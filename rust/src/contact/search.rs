//! Which slave edges may meet which masters, kept while nothing has moved far.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Curve, Vec2, add, dot, outward, sub, unit};
use super::master::{Master, Surface, curve_box, master_box};
use super::slave::Slave;
use super::tree::{Box2, Tree, grown};
use rayon::prelude::*;

/// Box and outward normal of a slave edge or node; zero if it may meet masters in any direction.
pub type Item = (Box2, Vec2<f64>);

/// A slave edge (or slave node) and a master that may meet.
pub type Candidate = (usize, usize);

/// Most of the cosine between the outward normals of two chords that may meet.
pub(super) const TURNED: f64 = 0.7;

/// Least cosine of a turn since the search that still cannot make an unturned pair face.
const STEADY: f64 = 0.92;

/// Candidates with the places they were found for.
#[derive(Default)]
pub struct Search {
    slave: Vec<Item>,
    master: Vec<Item>,
    pub candidates: Vec<Candidate>,
}

impl Search {
    /// Renews the candidates if something has moved by more than half the margin or turned far;
    /// tells whether they changed.
    pub fn update(
        &mut self,
        slaves: Vec<Item>,
        master: &Surface,
        x: &[[f64; 3]],
        reach: f64,
        margin: f64,
        allowed: impl Fn(usize, usize) -> bool + Sync,
    ) -> bool {
        let place = |j: usize| {
            let shape = master.place(j, x);
            (master_box(&shape), chord_normal(&shape))
        };
        let masters: Vec<Item> = (0..master.len()).map(place).collect();
        let first = self.slave.is_empty() && self.master.is_empty();
        let near = 0.5 * margin;
        if !first && still(&self.slave, &slaves, near) && still(&self.master, &masters, near) {
            return false;
        }
        let boxes: Vec<Box2> = masters.iter().map(|m| m.0).collect();
        let tree = Tree::new(&boxes);
        let found = each(slaves.len(), |i| {
            let (around, n) = slaves[i];
            let mut list: Vec<Candidate> = Vec::new();
            tree.query(&grown(around, reach + margin), &mut |j| {
                let j = j as usize;
                if allowed(i, j) && dot(n, masters[j].1) < TURNED {
                    list.push((i, j));
                }
            });
            list.sort_unstable();
            list
        });
        let candidates = found.concat();
        (self.slave, self.master) = (slaves, masters);
        let changed = first || candidates != self.candidates;
        self.candidates = candidates;
        changed
    }
}

/// Numbers of an item: its box and its normal.
const ITEM: usize = 6;

impl Search {
    /// The places that the candidates were found for, one after the other.
    pub fn places(&self) -> Vec<f64> {
        let flat = |(b, n): &Item| [b[0], b[1], b[2], b[3], n[0], n[1]];
        self.slave.iter().chain(&self.master).flat_map(flat).collect()
    }

    /// Take candidates and their places; `slaves` of these belong to the slave side.
    pub fn restore(&mut self, slaves: usize, places: &[f64], candidates: Vec<Candidate>) -> bool {
        let (items, rest) = places.as_chunks::<ITEM>();
        if !rest.is_empty() || slaves > items.len() {
            return false;
        }
        let item = |i: &[f64; ITEM]| -> Item { ([i[0], i[1], i[2], i[3]], [i[4], i[5]]) };
        self.slave = items[..slaves].iter().map(item).collect();
        self.master = items[slaves..].iter().map(item).collect();
        self.candidates = candidates;
        true
    }
}

/// Whether no side of a box has moved farther than `near` and no normal turned far.
fn still(old: &[Item], new: &[Item], near: f64) -> bool {
    old.iter().zip(new).all(|(a, b)| {
        let mut sides = a.0.iter().zip(&b.0);
        sides.all(|(p, q)| (p - q).abs() <= near) && dot(a.1, b.1) >= STEADY * dot(a.1, a.1)
    })
}

/// The body of a hollow arc is on the left as well, so the chord serves all kinds.
fn chord_normal(shape: &Master<f64>) -> Vec2<f64> {
    unit(outward(sub(shape.end(1), shape.end(0))))
}

/// Slave edges as the search sees them.
pub fn edges(slave: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
    let item = |c: Curve<f64>| (curve_box(&c), unit(outward(c.d)));
    slave.edges.iter().map(|e| item(e.place(x))).collect()
}

/// Slave nodes as the search sees them, with the mean normal of their edges.
pub fn nodes(slave: &Slave, x: &[[f64; 3]]) -> Vec<Item> {
    let mut normals = vec![[0.0; 2]; slave.nodes.len()];
    for (edge, constraints) in slave.edges.iter().zip(&slave.constraints) {
        let n = outward(edge.place(x).d);
        for &k in constraints.iter().filter(|&&k| k != usize::MAX) {
            normals[k] = add(normals[k], n);
        }
    }
    let place = |(n, normal): (&u32, Vec2<f64>)| {
        let p = x[*n as usize];
        ([p[0], p[1], p[0], p[1]], unit(normal))
    };
    slave.nodes.iter().zip(normals).map(place).collect()
}

/// Half the distance from each edge inwards to the body's other face, within 60 degrees of the
/// normal.
pub fn half_thickness(slave: &Slave, reference: &[[f64; 3]]) -> Vec<f64> {
    let curves: Vec<_> = slave.edges.iter().map(|e| e.place(reference)).collect();
    let boxes: Vec<_> = curves.iter().map(curve_box).collect();
    let tree = Tree::new(&boxes);
    let whole = boxes
        .iter()
        .fold(boxes[0], |a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]);
    let far = (whole[2] - whole[0]).hypot(whole[3] - whole[1]);
    each(curves.len(), |i| {
        let (p, d) = (curves[i].at(0.0), curves[i].d);
        let n = unit(outward(d));
        let mut size = 4.0 * dot(d, d).sqrt();
        // Growing boxes, so that few edges are met.
        loop {
            let mut least = f64::INFINITY;
            tree.query(&grown([p[0], p[1], p[0], p[1]], size), &mut |j| {
                let other = &curves[j as usize];
                let chord = Curve::line(other.at(-1.0), other.at(1.0));
                let apart = sub(chord.at(chord.foot(p).clamp(-1.0, 1.0)), p);
                let distance = dot(apart, apart).sqrt();
                let inwards = -dot(apart, n) > 0.5 * distance;
                if inwards && dot(outward(chord.d), n) < 0.0 {
                    least = least.min(distance);
                }
            });
            if least <= size || size > far {
                return 0.5 * least;
            }
            size *= 2.0;
        }
    })
}

/// `f` of 0 to `n` in order, shared out if this runs in a pool of threads.
pub fn each<R: Send>(n: usize, f: impl Fn(usize) -> R + Sync + Send) -> Vec<R> {
    if rayon::current_thread_index().is_some() {
        (0..n).into_par_iter().map(f).collect()
    } else {
        (0..n).map(f).collect()
    }
}
