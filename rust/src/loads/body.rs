//! Body forces of one element at its current positions: gravity and centrifugal load.
//!
//! Both are gradients of a potential of the positions in the inertia: those of the
//! nodes and of the edge bulges of drilling elements, `y_k = (phi_k - phi_k+1) R s_k`, with the
//! element's own mass matrix `M`. For the acceleration `b + omega^2 x` that is
//!
//! ```text
//! V = - (sum M) b . x - omega^2 / 2  x . M x,   x = (x_1 .. x_N, y_1 .. y_N)
//! ```
//!
//! so whatever mass moves is also what is heavy: free fall leaves every element without stress.
//! The force on the bulges gives moments along the current normals of the edges and, since the
//! bulges ride with the frame, a couple of forces on the nodes. The stiffness is exact and
//! symmetric.
// SPDX-License-Identifier: BSD-3-Clause

use crate::base::small::{Blocks, Nodal, blocks, nodal};
use crate::kinematics::inertia::{Mass, Spin};

/// Acceleration field `b + omega^2 x` of the current position x.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Acceleration at the origin [length/time^2].
    pub at_origin: [f64; 2],
    /// Square of the angular velocity [1/time^2].
    pub omega2: f64,
    /// Whether the axis is y, in the plane: the acceleration has no component along it.
    pub ring: bool,
}

impl Field {
    /// The same acceleration everywhere.
    pub fn uniform(b: [f64; 2]) -> Self {
        Self { at_origin: b, omega2: 0.0, ring: false }
    }

    /// Centrifugal acceleration about a point.
    pub fn centrifugal(omega2: f64, center: [f64; 2]) -> Self {
        Self { at_origin: [-omega2 * center[0], -omega2 * center[1]], omega2, ring: false }
    }

    /// The field about the axis y.
    pub fn about_axis(self) -> Self {
        let along = if self.omega2 == 0.0 { self.at_origin[1] } else { 0.0 };
        Self { at_origin: [self.at_origin[0], along], ring: true, ..self }
    }

    /// Square of the angular velocity for each direction.
    fn growth(&self) -> [f64; 2] {
        [self.omega2, if self.ring { 0.0 } else { self.omega2 }]
    }

    /// The field times a factor.
    pub fn times(self, factor: f64) -> Self {
        let omega2 = factor * self.omega2;
        Self { at_origin: self.at_origin.map(|b| factor * b), omega2, ring: self.ring }
    }
}

/// Nodal force of a field on an element with nodes at `x + u`, and its derivative, blocks
/// `a <= b`, zero without `tangent`. Without `coupled` the mass has no part that belongs to
/// rotations.
pub fn force<const N: usize, const M: usize>(
    mass: &Mass<f64, N>,
    coupled: bool,
    x: &Nodal<f64, N, 2>,
    u: &Nodal<f64, N, M>,
    field: Field,
    tangent: bool,
) -> (Nodal<f64, N, M>, Blocks<f64, N, M>) {
    let (mut f, mut k) = (nodal::<f64, N, M>(), blocks::<f64, N, M>());
    let mut pull = [[0.0; 2]; N];
    let growth = field.growth();
    for a in 0..N {
        for i in 0..2 {
            pull[a][i] = field.at_origin[i] + growth[i] * (x[a][i] + u[a][i]);
        }
    }
    for a in 0..N {
        for b in 0..N {
            for i in 0..2 {
                f[a][i] += mass.nn[a][b] * pull[b][i];
                k[a][b][i][i] = growth[i] * mass.nn[a][b];
            }
        }
    }
    if coupled && M == 3 {
        bulges(mass, x, u, field, &pull, &mut f, tangent.then_some(&mut k));
    }
    (f, k)
}

/// Add what the edge bulges give.
fn bulges<const N: usize, const M: usize>(
    mass: &Mass<f64, N>,
    x: &Nodal<f64, N, 2>,
    u: &Nodal<f64, N, M>,
    field: Field,
    pull: &[[f64; 2]; N],
    f: &mut Nodal<f64, N, M>,
    k: Option<&mut Blocks<f64, N, M>>,
) {
    let spin = Spin::new(x, u, &mass.s);
    let next = |e: usize| (e + 1) % N;
    let differ: [f64; N] = std::array::from_fn(|e| u[e][M - 1] - u[next(e)][M - 1]);
    let (mut y, mut on_edge) = ([[0.0; 2]; N], [[0.0; 2]; N]);
    for e in 0..N {
        y[e] = spin.w[e].map(|w| differ[e] * w);
    }
    for e in 0..N {
        for b in 0..N {
            for i in 0..2 {
                f[b][i] += field.omega2 * mass.ne[b][e] * y[e][i];
                on_edge[e][i] += mass.ne[b][e] * pull[b][i];
                on_edge[e][i] += field.omega2 * mass.ee[e][b] * y[b][i];
            }
        }
    }
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    // What turns the frame, and its derivative by the turn.
    let (mut couple, mut couple_w) = (0.0, 0.0);
    for e in 0..N {
        couple += differ[e] * dot(spin.sw[e], on_edge[e]);
        couple_w += differ[e] * dot(spin.w[e], on_edge[e]);
        let moment = dot(spin.w[e], on_edge[e]);
        f[e][M - 1] += moment;
        f[next(e)][M - 1] -= moment;
    }
    for n in 0..N {
        for i in 0..2 {
            f[n][i] += spin.gamma[n][i] * couple;
        }
    }
    let Some(k) = k else { return };
    let varies = field.omega2 != 0.0;
    for q in 0..N {
        for j in 0..M {
            // Turn of the frame, relative growth of D, differences of rotations.
            let (mut turn, mut growth, mut differs) = (0.0, 0.0, [0.0; N]);
            if j < 2 {
                (turn, growth) = (spin.gamma[q][j], spin.eta[q][j] / spin.d);
            } else {
                differs[q] += 1.0;
                differs[(q + N - 1) % N] -= 1.0;
            }
            // How the pull on the edges changes, which is the same everywhere without a spin.
            let mut d_edge = [[0.0; 2]; N];
            if varies {
                let mut dy = [[0.0; 2]; N];
                for e in 0..N {
                    for i in 0..2 {
                        dy[e][i] = differs[e] * spin.w[e][i] + differ[e] * turn * spin.sw[e][i];
                    }
                }
                for e in 0..N {
                    for i in 0..2 {
                        for b in 0..N {
                            d_edge[e][i] += field.omega2 * mass.ee[e][b] * dy[b][i];
                            k[b][q][i][j] += field.omega2 * mass.ne[b][e] * dy[e][i];
                        }
                        if i == j {
                            d_edge[e][i] += field.omega2 * mass.ne[q][e];
                        }
                    }
                }
            }
            let mut d_couple = -couple_w * turn;
            for e in 0..N {
                d_couple += differs[e] * dot(spin.sw[e], on_edge[e]);
                d_couple += differ[e] * dot(spin.sw[e], d_edge[e]);
                let moment = turn * dot(spin.sw[e], on_edge[e]) + dot(spin.w[e], d_edge[e]);
                k[e][q][M - 1][j] += moment;
                k[next(e)][q][M - 1][j] -= moment;
            }
            for n in 0..N {
                for i in 0..2 {
                    let turned = spin.eta[n][i] / spin.d * turn + spin.gamma[n][i] * growth;
                    k[n][q][i][j] += spin.gamma[n][i] * d_couple - turned * couple;
                }
            }
        }
    }
}
