//! Ties: the jump between two edges, weighted and integrated over their reference pairing.
//!
//! The offset that the meshes have at the start turns and stretches with the slave edge's chord,
//! so it costs no strain and a common rigid motion changes nothing.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Curve, GAUSS, Vec2, add, dot, outward, sub, times, unit};
use super::master::Master;
use super::mortar::Overlap;
use super::slave::weights;
use crate::base::Smooth;

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
    thickness: f64,
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
                area: half * w * thickness * dot(t, t).sqrt(),
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

/// Reference area of each constraint over the points.
pub fn areas(points: &[Point], n: usize) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for point in points {
        for (sum, psi) in sums.iter_mut().zip(weights(n, point.slave)) {
            *sum += psi * point.area;
        }
    }
    sums
}
