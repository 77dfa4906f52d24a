//! The slave side of a pair: its edges, and the nodes that carry constraints.
// SPDX-License-Identifier: BSD-3-Clause

use super::curve::{Curve, Edge, GAUSS, dot, outward, unit};
use crate::base::Smooth;
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Largest cosine between the normals of the faces of a notch that may meet: 60 degrees of opening.
pub(super) const OPPOSITE: f64 = -0.5;
/// Integral of weights over that of their sizes below which it is as good as none.
const VANISHING: f64 = 0.1;
/// Sine between two normals that is rounding.
const PARALLEL: f64 = 1e-6;

/// What a length of an edge is multiplied with to give its area.
#[derive(Clone, Copy, Debug)]
pub enum Depth {
    Thickness(f64),
    /// That of a ring, `2 pi` times the radius x.
    Circumference,
}

impl Depth {
    /// Area of a length at the radius `x` on the reference.
    #[inline]
    pub fn area<T: Smooth>(self, length: T, x: impl FnOnce() -> T) -> T {
        match self {
            Self::Thickness(t) => length.scale(t),
            Self::Circumference => (length * x()).scale(TAU),
        }
    }

    /// Slope of the area along a straight edge from -1 to 1, over its mean.
    pub fn growth(self, edge: &Curve<f64>) -> f64 {
        match self {
            Self::Thickness(_) => 0.0,
            Self::Circumference => {
                let [first, last] = [-1.0, 1.0].map(|r| edge.at(r)[0]);
                (last - first) / (last + first)
            }
        }
    }
}

/// Edges of the slave side with what follows from the reference configuration.
#[derive(Clone, Debug)]
pub struct Slave {
    pub edges: Vec<Edge>,
    pub thickness: Vec<Depth>,
    /// Mesh node of each constraint.
    pub nodes: Vec<u32>,
    /// Constraints of each edge's nodes.
    pub constraints: Vec<[usize; 3]>,
    /// Reference area of each constraint over all its edges, the integral of its weights; that of
    /// their sizes for the corner of a quadratic edge at the axis, whose integral vanishes.
    pub area: Vec<f64>,
}

impl Slave {
    /// Constraints at all nodes.
    pub fn new(reference: &[[f64; 3]], edges: Vec<Edge>, thickness: Vec<Depth>) -> Self {
        let (mut nodes, mut area, mut size) = (Vec::new(), Vec::new(), Vec::new());
        let mut number = HashMap::new();
        let mut constraints = Vec::with_capacity(edges.len());
        for (edge, thickness) in edges.iter().zip(&thickness) {
            let n = edge.n_nodes;
            let curve = edge.place(reference);
            let mut mine = [usize::MAX; 3];
            for a in 0..n {
                mine[a] = *number.entry(edge.nodes[a]).or_insert_with(|| {
                    nodes.push(edge.nodes[a]);
                    area.push(0.0);
                    size.push(0.0);
                    nodes.len() - 1
                });
            }
            for (r, w) in GAUSS {
                let t = curve.slope(r);
                let da = thickness.area(w * dot(t, t).sqrt(), || curve.at(r)[0]);
                let psi = weights(n, r);
                for a in 0..n {
                    area[mine[a]] += psi[a] * da;
                    size[mine[a]] += psi[a].abs() * da;
                }
            }
            constraints.push(mine);
        }
        for (area, size) in area.iter_mut().zip(size) {
            if *area < VANISHING * size {
                *area = size;
            }
        }
        Self { edges, thickness, nodes, constraints, area }
    }

    /// Single nodes, of the area 1.
    pub fn of_nodes(nodes: Vec<u32>) -> Self {
        let area = vec![1.0; nodes.len()];
        Self { edges: Vec::new(), thickness: Vec::new(), nodes, constraints: Vec::new(), area }
    }

    /// Edges of each constraint, or each edge alone.
    pub fn owners(&self, of_nodes: bool) -> Vec<Vec<usize>> {
        if !of_nodes {
            return (0..self.edges.len()).map(|i| vec![i]).collect();
        }
        let mut owners = vec![Vec::new(); self.nodes.len()];
        for (i, constraints) in self.constraints.iter().enumerate() {
            for &k in constraints.iter().filter(|&&k| k != usize::MAX) {
                owners[k].push(i);
            }
        }
        owners
    }

    /// Nodes at the tips of notches whose faces are opposite, as those of a slit are.
    pub fn notches(&self, reference: &[[f64; 3]]) -> HashSet<u32> {
        let normal = |e: &Edge| unit(outward(e.place(reference).d));
        let begins: HashMap<u32, &Edge> = self.edges.iter().map(|e| (e.nodes[0], e)).collect();
        let tip = |e: &Edge| {
            let (a, b) = (normal(e), normal(begins.get(&e.nodes[1]).copied()?));
            // The sides of a slit are parallel up to rounding.
            let inwards = a[0] * b[1] - a[1] * b[0] < PARALLEL;
            (dot(a, b) < OPPOSITE && inwards).then_some(e.nodes[1])
        };
        self.edges.iter().filter_map(tip).collect()
    }
}

/// Shape functions of the constraints on an edge with two or three of them.
pub fn weights(n: usize, r: f64) -> [f64; 3] {
    if n == 2 {
        [0.5 - 0.5 * r, 0.5 + 0.5 * r, 0.0]
    } else {
        [0.5 * r * (r - 1.0), 0.5 * r * (r + 1.0), 1.0 - r * r]
    }
}
