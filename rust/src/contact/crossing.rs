//! When nodes go through the other side in an increment over which all move evenly.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Vec2, add, dot, sub, times};
use super::master::hull;
use super::tree::{Box2, Tree, grown};

/// A straight piece of a side by its ends; the body is on the left.
pub type Piece = [Vec2<f64>; 2];

/// The way of a node.
pub struct Way {
    pub node: i64,
    pub from: Vec2<f64>,
    pub to: Vec2<f64>,
    /// Distance from a piece at which the outer side begins for it.
    pub outside: f64,
}

/// Share of each way after which the node goes through a piece from outside; infinite if it does
/// not.
///
/// The pieces are those at the `first` and at the `last` instant, between nodes `ends`, which do not
/// cross them. A distance of `depth` from a piece, at either instant, is none.
pub fn times_of_crossing(
    [first, last]: [&[Piece]; 2],
    ends: &[[i64; 2]],
    ways: &[Way],
    depth: f64,
) -> Vec<f64> {
    // What moves together has small boxes if they move with the mean of the pieces.
    let moves = || first.iter().zip(last).flat_map(|(p, q)| [sub(q[0], p[0]), sub(q[1], p[1])]);
    let drift = times(moves().fold([0.0; 2], add), 0.5 / first.len() as f64);
    let boxes = first
        .iter()
        .zip(last)
        .map(|(p, q)| hull(&[p[0], p[1], sub(q[0], drift), sub(q[1], drift)]));
    let tree = Tree::new(&boxes.collect::<Vec<Box2>>());
    let time = |way: &Way| {
        let mut least = f64::INFINITY;
        let own = grown(hull(&[way.from, sub(way.to, drift)]), (-way.outside).max(0.0));
        tree.query(&own, &mut |i| {
            let i = i as usize;
            if !ends[i].contains(&way.node) {
                least = least.min(crossing([&first[i], &last[i]], way, depth));
            }
        });
        least
    };
    ways.iter().map(time).collect()
}

fn crossing([first, last]: [&Piece; 2], way: &Way, depth: f64) -> f64 {
    let (a, b) = (side(first, way.from), side(last, way.to));
    if !(a > way.outside && b < -depth) {
        return f64::INFINITY;
    }
    let share = if a <= depth { 0.0 } else { first_root(first, last, way) };
    let at = |p, q| add(p, times(sub(q, p), share));
    let met = [at(first[0], last[0]), at(first[1], last[1])];
    // A node that starts on a piece may leave it around a corner.
    let hit = is_beside(&met, at(way.from, way.to)) && (share > 0.0 || is_beside(last, way.to));
    if hit { share } else { f64::INFINITY }
}

/// Share of its way after which a node that ends inside is on the line through a piece.
///
/// Where the piece turns, its distance is quadratic: a straight line between both ends would meet
/// it too early, and beside a corner that the node leaves it around.
fn first_root(first: &Piece, last: &Piece, way: &Way) -> f64 {
    let (p, q, x) = (sub(last[0], first[0]), sub(last[1], first[1]), sub(way.to, way.from));
    let (d, r) = (sub(first[1], first[0]), sub(way.from, first[0]));
    let (turns, moves) = (sub(q, p), sub(x, p));
    let cross = |a: Vec2<f64>, b: Vec2<f64>| b[1] * a[0] - b[0] * a[1];
    // Distance times length, negative outside: c + b t + a t^2, which has one root up to 1.
    let (a, b, c) = (cross(turns, moves), cross(d, moves) + cross(turns, r), cross(d, r));
    let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
    2.0 * -c / (b + root)
}

/// Distance of a point from the line through a piece, positive outside.
fn side(piece: &Piece, x: Vec2<f64>) -> f64 {
    let (d, r) = (sub(piece[1], piece[0]), sub(x, piece[0]));
    (d[1] * r[0] - d[0] * r[1]) / d[0].hypot(d[1])
}

/// Whether the foot of a point on the line through a piece lies on the piece.
fn is_beside(piece: &Piece, x: Vec2<f64>) -> bool {
    let d = sub(piece[1], piece[0]);
    (0.0..=1.0).contains(&(dot(sub(x, piece[0]), d) / dot(d, d)))
}
