//! Body forces of one element on its reference: gravity and centrifugal load, with the
//! moments that the quadratic edges of drilling elements take.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::small::{Nodal, nodal};
use crate::elements::{Element, Point, shapes};

/// Acceleration field on the reference.
#[derive(Clone, Copy, Debug)]
pub enum Field {
    /// The same everywhere [length/time^2].
    Uniform([f64; 2]),
    /// `omega^2 (X - centre)`: omega squared and the centre.
    Centrifugal(f64, [f64; 2]),
}

impl Field {
    fn at(self, x: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Uniform(b) => b,
            Self::Centrifugal(w2, c) => [w2 * (x[0] - c[0]), w2 * (x[1] - c[1])],
        }
    }
}

/// Nodal force of a field on an element of mass per area `rho_t`.
pub fn force<E, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<f64, N, 2>,
    points: &[Point<N>],
    rho_t: f64,
    field: Field,
) -> Nodal<f64, N, M>
where
    E: Element<N, M, A>,
{
    let mut f = nodal::<f64, N, M>();
    for p in points {
        let weight = E::measure(x, p);
        let mut position = [0.0; 2];
        for a in 0..N {
            for i in 0..2 {
                position[i] += p.n[a] * x[a][i];
            }
        }
        let b = field.at(position);
        let m = weight * rho_t;
        for a in 0..N {
            for i in 0..2 {
                f[a][i] += m * p.n[a] * b[i];
            }
        }
        if M == 3 {
            let sides = E::sides(p.xi);
            for a in 0..N {
                let bulge = shapes::edge_bulge(x, a);
                let moment = m * sides[a] * (bulge[0] * b[0] + bulge[1] * b[1]);
                f[a][M - 1] += moment;
                f[(a + 1) % N][M - 1] -= moment;
            }
        }
    }
    f
}
