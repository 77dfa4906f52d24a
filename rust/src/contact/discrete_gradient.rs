//! Discrete gradients of gaps over an increment.
//!
//! In the energy-momentum scheme a traction does exactly the work of its gap, `p (G1 - G0)`, if it
//! acts along a discrete gradient of the gap. It is the gradient at the middle of the increment,
//! which keeps the momenta because the gap does not depend on the frame, with a correction that is
//! orthogonal to all rigid motions of the nodes of a constraint (O. Gonzalez, *Time integration and
//! discrete Hamiltonian systems*, J. Nonlinear Sci. 6, 1996).
// SPDX-License-Identifier: BSD-3-Clause

use super::active_set::Gradients;
use super::curve::{Vec2, add, dot, outward, sub, times};
use super::master::{Rigid, Surface};
use super::terms::WIDTH;

/// Gradients of gaps whose products with an increment from `old` to `x` are the changes `rise` of
/// the gaps, one for each row of `middle`; and the slips, the products of the gradients of these.
///
/// `middle` are gradients by the variables at the middle of the increment; a deformation up to
/// `rounding` corrects nothing.
pub fn discrete_gradient(
    master: &Surface,
    middle: &Gradients,
    rise: &[f64],
    [old, x]: [&[[f64; 3]]; 2],
    rounding: f64,
) -> (Vec<[f64; WIDTH]>, Vec<f64>) {
    let moved = |v: usize| {
        let way = x[v / 3][v % 3] - old[v / 3][v % 3];
        if v % 3 == 2 { 2.0 * (0.5 * way).tan() } else { way }
    };
    let place = |v: usize| 0.5 * (x[v / 3][v % 3] + old[v / 3][v % 3]);
    let still = master.rigid().filter(|rigid| rigid.node.is_none());
    let away: Vec<[f64; WIDTH]> =
        middle.dofs.iter().map(|variables| deformation(still, variables, moved, place)).collect();
    let (mut missing, mut slip) = (rise.to_vec(), vec![0.0; rise.len()]);
    let mut size = slip.clone();
    for (t, &k) in middle.constraint.iter().enumerate() {
        let by = |gradient: &[f64; WIDTH]| -> f64 {
            let used = middle.dofs[t].iter().zip(gradient).filter(|(v, _)| **v >= 0);
            used.map(|(&v, g)| g * moved(v as usize)).sum()
        };
        missing[k as usize] -= by(&middle.gap[t]);
        slip[k as usize] += by(&middle.slip[t]);
        size[k as usize] += away[t].iter().map(|d| d * d).sum::<f64>();
    }
    let corrected = |(t, &k): (usize, &i64)| {
        let size = size[k as usize];
        let factor = if size > rounding * rounding { missing[k as usize] / size } else { 0.0 };
        std::array::from_fn(|i| middle.gap[t][i] + factor * away[t][i])
    };
    (middle.constraint.iter().enumerate().map(corrected).collect(), slip)
}

/// Displacements by variable less the motions that do not change the gap; no rotations.
///
/// With a curve that stands `still` these are motions along its only line or arc, else all rigid
/// motions of the nodes.
fn deformation(
    still: Option<&Rigid>,
    variables: &[i64; WIDTH],
    moved: impl Fn(usize) -> f64,
    place: impl Fn(usize) -> f64,
) -> [f64; WIDTH] {
    let mut out = [0.0; WIDTH];
    // The y of a node is the variable behind its x.
    let nodes: Vec<usize> =
        (0..WIDTH).filter(|&i| variables[i] >= 0 && variables[i] % 3 == 0).collect();
    let pair = |i: usize, of: &dyn Fn(usize) -> f64| {
        let v = variables[i] as usize;
        [of(v), of(v + 1)]
    };
    let mut put = |i: usize, d: Vec2<f64>| out[i..i + 2].copy_from_slice(&d);
    if let Some(rigid) = still {
        for i in nodes {
            let d = pair(i, &moved);
            let across = |n| times(n, dot(d, n));
            put(i, rigid.only_normal(pair(i, &place)).map_or(d, across));
        }
        return out;
    }
    let centered = |of: &dyn Fn(usize) -> f64| -> Vec<Vec2<f64>> {
        let sum = nodes.iter().fold([0.0; 2], |sum, &i| add(sum, pair(i, of)));
        let mean = sum.map(|s| s / nodes.len() as f64);
        nodes.iter().map(|&i| sub(pair(i, of), mean)).collect()
    };
    let (arms, ways) = (centered(&place), centered(&moved));
    let inertia: f64 = arms.iter().map(|&r| dot(r, r)).sum();
    // The normal points to the right of the arm: against the spin.
    let against: f64 = arms.iter().zip(&ways).map(|(&r, &d)| dot(outward(r), d)).sum();
    let spin = if inertia > 0.0 { against / inertia } else { 0.0 };
    for ((&i, &r), &d) in nodes.iter().zip(&arms).zip(&ways) {
        put(i, sub(d, times(outward(r), spin)));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two nodes, of which the second lies above the first; a gap that is their distance.
    const VARIABLES: [[i64; WIDTH]; 1] = {
        let mut v = [-1; WIDTH];
        (v[0], v[1], v[2], v[3]) = (0, 1, 3, 4);
        [v]
    };

    fn corrected(x: &[[f64; 3]], rise: f64) -> [f64; WIDTH] {
        let old = [[0.0; 3], [0.0, 1.0, 0.0]];
        let across = [x[1][0] - x[0][0], 1.0 + x[1][1] - x[0][1]];
        let [a, b] = times(across, dot(across, across).sqrt().recip());
        let mut gap = [[0.0; WIDTH]; 1];
        gap[0][..4].copy_from_slice(&[-a, -b, a, b]);
        let slip = [[0.0; WIDTH]; 1];
        let middle = Gradients { constraint: &[0], dofs: &VARIABLES, gap: &gap, slip: &slip };
        let master = Surface::Edges(Vec::new());
        discrete_gradient(&master, &middle, &[rise], [&old, x], 1e-9).0[0]
    }

    #[test]
    fn the_product_is_the_change_of_the_gap_and_no_momentum_changes() {
        let x = [[0.1, 0.0, 0.0], [0.4, 1.5, 0.0]];
        let rise = 0.3_f64.hypot(1.5) - 1.0;
        let g = corrected(&x, rise);
        let product = g[0] * 0.1 + g[2] * 0.4 + g[3] * 0.5;
        assert!((product - rise).abs() < 1e-15);
        assert!((g[0] + g[2]).abs() < 1e-15 && (g[1] + g[3]).abs() < 1e-15);
        // About the places at the middle.
        assert!((0.05 * g[1] + 0.2 * g[3] - 1.25 * g[2]).abs() < 1e-15);
    }

    #[test]
    fn a_translation_corrects_nothing() {
        let g = corrected(&[[0.3, 0.2, 0.0], [0.3, 1.2, 0.0]], 1e-17);
        assert_eq!((g[0], g[1], g[2], g[3]), (0.0, -1.0, 0.0, 1.0));
    }
}
