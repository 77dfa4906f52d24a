//! What the contracts share: random numbers, random elements and states, one evaluation of an
//! element from scratch, dense algebra that does not come from the crate.
// SPDX-License-Identifier: BSD-3-Clause

use corota::base::small::{Blocks, Nodal};
use corota::base::{Dual, Real};
use corota::elements::Element;
use corota::kinematics::corotation::Frame;
use corota::kinematics::integrate::{History, Local, Section, single_into};
use corota::kinematics::local_strain::LocalStrain;
use corota::kinematics::per_point::PerPoint;
use corota::materials::{Law, Plane, State};

/// Small random generator (`SplitMix64`), so that failures repeat.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }
    /// Uniform in (-1, 1).
    pub fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + 0.5 * (self.signed() + 1.0) * (high - low)
    }
}

/// Natural coordinates of the nodes of a cell.
pub fn natural(cell: &str) -> Vec<[f64; 2]> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let sides = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
    let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    match cell {
        "tri3" => triangle.to_vec(),
        "tri6" => [&triangle[..], &[[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]].concat(),
        "quad4" => corners.to_vec(),
        "quad8" => [corners, sides].concat(),
        "quad9" => [&corners[..], &sides, &[[0.0, 0.0]]].concat(),
        other => panic!("say where the nodes of a {other} lie"),
    }
}

/// A random cell: corners moved by up to a quarter of the size, other nodes placed by the map
/// of the corners and then moved by `curve`; turned and shifted.
pub fn cell<const N: usize>(kind: &str, random: &mut Random, curve: f64) -> Nodal<f64, N, 2> {
    let nodes = natural(kind);
    let n_corners = if kind.starts_with("tri") { 3 } else { 4 };
    let mut corners: Vec<[f64; 2]> = nodes[..n_corners].to_vec();
    for c in &mut corners {
        *c = [c[0] + 0.25 * random.signed(), c[1] + 0.25 * random.signed()];
    }
    let (angle, shift) = (3.0 * random.signed(), [2.0 * random.signed(), 2.0 * random.signed()]);
    let mut x = [[0.0; 2]; N];
    for (a, &[r, s]) in nodes.iter().enumerate() {
        let weights = if n_corners == 3 {
            vec![1.0 - r - s, r, s]
        } else {
            let product = |&[p, q]: &[f64; 2]| 0.25 * (1.0 + p * r) * (1.0 + q * s);
            nodes[..4].iter().map(product).collect()
        };
        let mut p = [0.0; 2];
        for (w, c) in weights.iter().zip(&corners) {
            p = [p[0] + w * c[0], p[1] + w * c[1]];
        }
        if a >= n_corners {
            p = [p[0] + curve * random.signed(), p[1] + curve * random.signed()];
        }
        let p = turn(p, angle);
        x[a] = [p[0] + shift[0], p[1] + shift[1]];
    }
    x
}

pub fn turn(p: [f64; 2], angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * p[0] - s * p[1], s * p[0] + c * p[1]]
}

/// Displacements and rotations of a rigid motion: turn about the origin, then shift.
pub fn rigid<const N: usize, const M: usize>(
    x: &Nodal<f64, N, 2>,
    angle: f64,
    shift: [f64; 2],
) -> Nodal<f64, N, M> {
    let mut u = [[0.0; M]; N];
    for a in 0..N {
        let p = turn(x[a], angle);
        u[a][0] = p[0] - x[a][0] + shift[0];
        u[a][1] = p[1] - x[a][1] + shift[1];
        if M == 3 {
            u[a][M - 1] = angle;
        }
    }
    u
}

/// A rigid motion after a random deformation of the size `strain`.
pub fn state<const N: usize, const M: usize>(
    x: &Nodal<f64, N, 2>,
    random: &mut Random,
    angle: f64,
    strain: f64,
) -> Nodal<f64, N, M> {
    let mut h = [0.0; 4];
    for v in &mut h {
        *v = strain * random.signed();
    }
    let shift = [3.0 * random.signed(), 3.0 * random.signed()];
    let mut u = [[0.0; M]; N];
    for a in 0..N {
        let [p, q] = x[a];
        let moved = [
            p + h[0] * p + h[1] * q + 0.3 * strain * random.signed(),
            q + h[2] * p + h[3] * q + 0.3 * strain * random.signed(),
        ];
        let turned = turn(moved, angle);
        u[a][0] = turned[0] + shift[0] - p;
        u[a][1] = turned[1] + shift[1] - q;
        if M == 3 {
            u[a][M - 1] = angle + 0.5 * (h[2] - h[1]) + strain * random.signed();
        }
    }
    u
}

/// Every registered local strain.
pub fn strains() -> Vec<LocalStrain> {
    LocalStrain::NAMES.iter().map(|n| LocalStrain::new(n).expect("registered")).collect()
}

/// An elastic section.
pub fn section<E, const N: usize, const M: usize, const A: usize>(
    plane: Plane,
    strain: LocalStrain,
) -> Section<N>
where
    E: Element<N, M, A>,
{
    let law = Law::new("elastic", &[7.0, 0.3], State::Plane(plane)).expect("valid constants");
    Section {
        points: E::points(&E::rule()),
        plane,
        ring: false,
        strain,
        thickness: 1.3,
        profile: [0.0; 3],
        table: Vec::new(),
        fibers: Vec::new(),
        parameter: E::parameter(&law.moduli()),
        law,
        finite: true,
        mean_dilatation: false,
    }
}

pub struct Answer<T: Real, const N: usize, const M: usize> {
    pub force: Nodal<T, N, M>,
    pub stiffness: Blocks<T, N, M>,
    pub failed: T::Mask,
    /// Internal modes that belong to the state.
    pub alpha: Vec<f64>,
    pub frame: Frame<T, N, M>,
}

/// Force and tangent of one element without history, in global axes.
pub fn evaluate<E, T: Real, const N: usize, const M: usize, const A: usize>(
    x: &Nodal<f64, N, 2>,
    u: &Nodal<T, N, M>,
    section: &Section<N>,
    nlgeom: bool,
) -> Answer<T, N, M>
where
    E: Element<N, M, A>,
{
    let x = x.map(|p| p.map(T::real));
    let frame = Frame::new(&x, u, nlgeom);
    let state = section.points.len() * section.law.n_state() + E::MEMORY;
    let (old, mut new, mut alpha) = (vec![0.0; state], vec![0.0; state], vec![0.0; 2 * A]);
    let mut history = History {
        old: &old,
        new: &mut new,
        alpha: &mut alpha,
        initial: &[],
        stride: 1,
        clock: corota::materials::Clock { increment: 0.5, end: 2.0, lasting: true },
        per_point: PerPoint::default(),
        tape: None,
    };
    let mut answer = Local::zero();
    single_into::<E, T, N, M, A>(&x, &frame.q, section, &mut history, true, &mut answer);
    let mut stiffness = answer.stiffness;
    let force = frame.force(&answer.force);
    frame.stiffness(&answer.force, &mut stiffness);
    Answer { force, stiffness, failed: answer.failed, alpha, frame }
}

/// Dofs as independent variables.
pub fn variables<const N: usize, const M: usize, const D: usize>(
    u: &Nodal<f64, N, M>,
) -> Nodal<Dual<D>, N, M> {
    let mut v = [[Dual::real(0.0); M]; N];
    for a in 0..N {
        for i in 0..M {
            v[a][i] = Dual::variable(u[a][i], a * M + i);
        }
    }
    v
}

/// The whole matrix from the blocks `a <= b`.
pub fn dense<const N: usize, const M: usize>(k: &Blocks<f64, N, M>) -> Vec<Vec<f64>> {
    let mut m = vec![vec![0.0; N * M]; N * M];
    for a in 0..N {
        for b in a..N {
            for i in 0..M {
                for j in 0..M {
                    m[a * M + i][b * M + j] = k[a][b][i][j];
                    if a != b {
                        m[b * M + j][a * M + i] = k[a][b][i][j];
                    }
                }
            }
        }
    }
    m
}

pub fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |m, v| if v.is_nan() { f64::NAN } else { v.abs().max(m) })
}

pub fn norm(m: &[Vec<f64>]) -> f64 {
    largest(m.iter().flatten())
}

/// Eigenvalues of a symmetric matrix by Jacobi rotations, ascending.
pub fn eigenvalues(mut m: Vec<Vec<f64>>) -> Vec<f64> {
    let n = m.len();
    for _ in 0..60 {
        for p in 0..n {
            for q in p + 1..n {
                let angle = 0.5 * (2.0 * m[p][q]).atan2(m[q][q] - m[p][p]);
                let (s, c) = angle.sin_cos();
                for row in &mut m {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..n {
                    (m[p][k], m[q][k]) = (c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]);
                }
            }
        }
    }
    let mut values: Vec<f64> = (0..n).map(|i| m[i][i]).collect();
    values.sort_by(f64::total_cmp);
    values
}
