//! Gap and slip of a slave node against the closest point of the master.
//!
//! Beyond an end an edge is continued along its tangent. At a vertex, where a node lies off the
//! ends of both edges, the one with the larger distance decides: outside a convex vertex that
//! is the face the node has passed, inside a concave one the face it violates most. Distances to
//! a point, whose curvature is unbounded, never occur.
//!
//! A round of the master that is no larger than some facets of the slave would sink between two
//! nodes and be lifted by each in turn. Its deepest point is therefore measured against the facet
//! that it faces, too, by a constraint of the facet: a round that ends in a flat may press on a
//! facet while both of its nodes lie on the flat.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Vec2, add, dot, fixed, outward, sub, times, unit};
use super::master::{Hit, Master};
use crate::base::Smooth;

/// Part of half an edge by which a node may pass its end before another edge takes over; not at a
/// concave corner, where it would go into the other edge meanwhile.
const HOLD: f64 = 0.05;
/// Overclosure with another edge that is none, part of half an edge.
const CLEAR: f64 = 1e-9;
/// Largest cosine between the normals of a slave node and of a master it may touch.
const FACING: f64 = 0.2;

/// Bounds within which a node meets a master.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub reach: f64,
    pub depth: f64,
}

/// Chooses among `(pair, shape)` for a node at `p` with normal `n`; `last` is the pair of the
/// evaluation before.
pub fn choose(
    p: Vec2<f64>,
    n: Vec2<f64>,
    shapes: &[(usize, Master<f64>)],
    last: Option<usize>,
    bounds: Bounds,
) -> Option<usize> {
    struct Found {
        pair: usize,
        gap: f64,
        beyond: f64,
        distance: f64,
        size: f64,
    }
    let found: Vec<Found> = shapes
        .iter()
        .filter_map(|(pair, shape)| {
            let hit = shape.closest(p);
            let size = shape.speed(&hit);
            let beyond = hit.r.abs() - 1.0;
            let faces = dot(shape.normal(&hit), n) < FACING;
            (faces && hit.gap <= bounds.reach && -hit.gap <= bounds.depth).then(|| Found {
                pair: *pair,
                gap: hit.gap,
                beyond,
                distance: hit.gap.hypot(beyond.max(0.0) * size),
                size,
            })
        })
        .collect();
    let best = found.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))?;
    if let Some(held) = found.iter().find(|f| Some(f.pair) == last)
        && held.beyond <= HOLD
        && held.distance <= best.distance + HOLD * held.size
        && (held.beyond <= 0.0 || best.gap >= -CLEAR * best.size)
    {
        return last;
    }
    if best.beyond <= 0.0 {
        return Some(best.pair);
    }
    let near = |f: &&Found| {
        f.beyond > 0.0 && f.distance - best.distance <= 1e-6 * (best.distance + best.size)
    };
    let mut vertex: Vec<&Found> = found.iter().filter(near).collect();
    if vertex.len() < 2 {
        return (best.beyond <= HOLD).then_some(best.pair);
    }
    vertex.sort_by(|a, b| b.gap.abs().total_cmp(&a.gap.abs()).then(a.pair.cmp(&b.pair)));
    Some(vertex[0].pair)
}

/// Gap of a node, and its slip since an old configuration of node and master.
pub fn gap_and_slip<T: Smooth>(
    p: Vec2<T>,
    master: &Master<T>,
    old: Option<(Vec2<f64>, &Master<f64>)>,
) -> (T, Option<T>) {
    let hit = master.closest(p);
    let slip = old.map(|(before, plain)| {
        let other = Master::lift(plain);
        let there = master.carry(&hit, &other);
        // Master and slave run against each other.
        let tangent = outward(other.normal(&there));
        dot(sub(there.point, fixed(before)), tangent)
    });
    (hit.gap, slip)
}

/// Gap between the straight facet from `p` to `q` and a round master, at the point of the master
/// that lies deepest, its place on the facet (0 to 1), and that point.
pub fn round_gap<T: Smooth>(p: Vec2<T>, q: Vec2<T>, master: &Master<T>) -> (T, T, Hit<T>) {
    let along = sub(q, p);
    let n = unit(outward(along));
    let hit = master.foremost(n);
    let away = sub(hit.point, p);
    (dot(away, n), dot(away, along) / dot(along, along), hit)
}

/// The same with the slip since an old configuration of facet and master.
pub fn round_gap_and_slip<T: Smooth>(
    [p, q]: [Vec2<T>; 2],
    master: &Master<T>,
    old: Option<([Vec2<f64>; 2], &Master<f64>)>,
) -> (T, Option<T>) {
    let (gap, t, hit) = round_gap(p, q, master);
    let slip = old.map(|([p, q], plain)| {
        let other = Master::lift(plain);
        let there = master.carry(&hit, &other);
        let before = add(fixed(p), times(fixed(sub(q, p)), t));
        dot(sub(there.point, before), outward(other.normal(&there)))
    });
    (gap, slip)
}

/// Area times a distance less an offset.
pub fn open<T: Smooth>(distance: T, offset: f64, area: f64) -> T {
    (distance - T::real(offset)).scale(area)
}
