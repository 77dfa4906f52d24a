//! Ties: the jump between two edges, weighted and integrated over their reference pairing.
//!
//! The offset that the meshes have at the start turns and stretches with the slave edge's chord,
//! so it costs no strain and a common rigid motion changes nothing.
// SPDX-License-Identifier: BSD-3-Clause

use super::super::curve::{Curve, GAUSS, Vec2, add, dot, outward, sub, times, unit};
use super::super::master::{Master, Surface};
use super::super::search::each;
use super::super::sides::Sides;
use super::super::slave::{Depth, weights};
use super::super::terms::{PAIR, Share, Terms, lifted};
use super::super::travel::Start;
use super::mortar::{Overlap, clip_occluded, overlaps};
use super::{Discretization, Entry};
use crate::base::Smooth;

pub const ENTRY: Entry = Entry {
    name: "tie",
    joins: true,
    integrates: true,
    new: |_, _| Box::new(Tie { pieces: Vec::new() }),
};

/// A point of the slave edge tied to one of the master.
#[derive(Clone, Debug)]
pub struct Point {
    slave: f64,
    master: f64,
    area: f64,
    /// Offset along and across half the chord.
    offset: Vec2<f64>,
}

/// Tied points of an overlap in the reference configuration.
pub fn points(
    overlap: &Overlap,
    slave: &Curve<f64>,
    master: &Master<f64>,
    thickness: Depth,
) -> Vec<Point> {
    let [low, high] = overlap.values;
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let chord = dot(slave.d, slave.d);
    GAUSS
        .iter()
        .map(|(r, w)| {
            let xi = middle + half * r;
            let (p, t) = (slave.at(xi), slave.slope(xi));
            let hit = master.ray(p, t, unit(outward(t)));
            let apart = sub(hit.point, p);
            Point {
                slave: xi,
                master: hit.r,
                area: thickness.area(half * w * dot(t, t).sqrt(), || p[0]),
                offset: [dot(apart, slave.d) / chord, dot(apart, outward(slave.d)) / chord],
            }
        })
        .collect()
}

/// Integrals of the jump, x and y, for each of the `n` constraints of the slave edge.
pub fn jumps<T: Smooth>(
    points: &[Point],
    slave: &Curve<T>,
    master: &Curve<T>,
    n: usize,
) -> [[T; 2]; 3] {
    let mut sums = [[T::real(0.0); 2]; 3];
    let across = outward(slave.d);
    for point in points {
        let place = add(
            slave.at(T::real(point.slave)),
            add(times(slave.d, T::real(point.offset[0])), times(across, T::real(point.offset[1]))),
        );
        let jump = sub(place, master.at(T::real(point.master)));
        let psi = weights(n, point.slave);
        for (sum, psi) in sums.iter_mut().zip(psi) {
            for i in 0..2 {
                sum[i] += jump[i].scale(psi * point.area);
            }
        }
    }
    sums
}

/// Reference area of each constraint over the points, see [`Slave::area`].
///
/// [`Slave::area`]: super::super::slave::Slave::area
pub fn areas(points: &[Point], n: usize) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for point in points {
        for (sum, psi) in sums.iter_mut().zip(weights(n, point.slave)) {
            *sum += psi.abs() * point.area;
        }
    }
    sums
}

/// Edges joined on the pairing of the reference configuration.
pub struct Tie {
    /// Points of each candidate.
    pieces: Vec<Vec<Point>>,
}

impl Discretization for Tie {
    fn bind(&mut self, sides: &mut Sides, x: &[[f64; 3]]) {
        let mut kept = Vec::new();
        for i in 0..sides.slave.edges.len() {
            let mut overlaps = overlaps(sides, i, x);
            clip_occluded(&mut overlaps);
            for o in overlaps {
                let candidate = sides.candidates()[o.pair];
                let master = sides.master.place(candidate.1, x);
                let thickness = sides.slave.thickness[i];
                self.pieces.push(points(&o, &sides.reference[i], &master, thickness));
                kept.push(candidate);
            }
        }
        sides.keep(kept);
    }

    fn evaluate(&mut self, sides: &Sides, x: &[[f64; 3]], _: Option<&Start>) -> Vec<Terms> {
        each(sides.candidates().len(), |pair| self.joined(sides, pair, x))
    }
}

impl Tie {
    fn joined(&self, sides: &Sides, pair: usize, x: &[[f64; 3]]) -> Terms {
        let (i, j) = sides.candidates()[pair];
        let edge = &sides.slave.edges[i];
        let variables = self.variables(sides, (i, j));
        let v = lifted::<PAIR>(&variables, x);
        let slave = edge.curve(&v[..edge.variables().len()]);
        let Surface::Edges(masters) = &sides.master else { unreachable!("ties join edges") };
        let master = masters[j].curve(&v[edge.variables().len()..]);
        let points = &self.pieces[pair];
        let n = edge.n_nodes;
        let (jumps, areas) = (jumps(points, &slave, &master, n), areas(points, n));
        let share = |a: usize| Share {
            constraint: sides.slave.constraints[i][a],
            gap: (&jumps[a][0]).into(),
            slip: (&jumps[a][1]).into(),
            area: areas[a],
        };
        Terms { pair, variables, shares: (0..n).map(share).collect() }
    }
}
