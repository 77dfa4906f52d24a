//! Rigid motions of any size give no force, a superposed rigid motion turns the force with it,
//! and the numbering of the nodes does not matter.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{
    Random, cell, dense, evaluate, largest, natural, norm, rigid, section, state, strains, turn,
};
use corota::elements::Element;
use corota::for_each_planar_element;
use corota::kinematics::local_strain::LocalStrain;
use corota::materials::Plane;

/// Force over |K| max(|X|, |u|).
const NO_FORCE: f64 = 1e-12;
/// Relative to the force or the stiffness itself.
const SAME: f64 = 1e-11;

fn no_force<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let mut random = Random::new(4);
    for strain in strains() {
        for plane in [Plane::Stress, Plane::Strain] {
            let section = section::<E, N, M, A>(plane, strain);
            let x = cell::<N>(E::CELL, &mut random, 0.05);
            let rest = evaluate::<E, f64, N, M, A>(&x, &[[0.0; M]; N], &section, true);
            let k = norm(&dense(&rest.stiffness));
            for step in -150..=150 {
                // Up to four turns either way; the last tenth far away.
                let angle = f64::from(step) * std::f64::consts::PI * 8.0 / 150.0;
                let far = if step % 10 == 0 { 1e3 } else { 1.0 };
                let u = rigid::<N, M>(&x, angle, [far * random.signed(), far * random.signed()]);
                let at = evaluate::<E, f64, N, M, A>(&x, &u, &section, true);
                let moved = u.iter().flat_map(|v| &v[..2]);
                let size = largest(x.as_flattened()).max(largest(moved));
                let force = largest(at.force.as_flattened());
                assert!(force <= NO_FORCE * k * size, "{}: {force:e} at {angle}", E::NAME);
                assert!(!at.failed, "{}: failed at {angle}", E::NAME);
                // The tangent is that of the rest state, turned.
                let expected = turned_matrix(&dense(&rest.stiffness), M, angle);
                let error = difference(&dense(&at.stiffness), &expected);
                assert!(error <= 1e-12 * k * size, "{}: tangent {error:e}", E::NAME);
            }
        }
    }
}

fn objective<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let mut random = Random::new(5);
    for strain in strains() {
        let section = section::<E, N, M, A>(Plane::Stress, strain);
        for _ in 0..20 {
            let x = cell::<N>(E::CELL, &mut random, 0.05);
            let u = state::<N, M>(&x, &mut random, 0.4, 0.1);
            let one = evaluate::<E, f64, N, M, A>(&x, &u, &section, true);
            let (f, k) = (one.force, dense(&one.stiffness));
            // The same deformation seen after another rigid motion.
            let (angle, shift) = (20.0 * random.signed(), [random.signed(), random.signed()]);
            let mut v = u;
            for a in 0..N {
                let p = turn([x[a][0] + u[a][0], x[a][1] + u[a][1]], angle);
                v[a][0] = p[0] + shift[0] - x[a][0];
                v[a][1] = p[1] + shift[1] - x[a][1];
                if M == 3 {
                    v[a][M - 1] += angle;
                }
            }
            compare::<E, N, M, A>(&x, &v, strain, &f, &k, angle, "superposed motion");
            // The same problem in turned axes.
            let (mut y, mut w) = (x, u);
            for a in 0..N {
                y[a] = turn(x[a], angle);
                let d = turn([u[a][0], u[a][1]], angle);
                w[a][0] = d[0];
                w[a][1] = d[1];
            }
            compare::<E, N, M, A>(&y, &w, strain, &f, &k, angle, "turned axes");
        }
    }
}

fn compare<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>(
    x: &[[f64; 2]; N],
    u: &[[f64; M]; N],
    strain: LocalStrain,
    f: &[[f64; M]; N],
    k: &[Vec<f64>],
    angle: f64,
    what: &str,
) {
    let section = section::<E, N, M, A>(Plane::Stress, strain);
    let other = evaluate::<E, f64, N, M, A>(x, u, &section, true);
    let scale = largest(f.as_flattened());
    for a in 0..N {
        let t = turn([f[a][0], f[a][1]], angle);
        let mut error = (other.force[a][0] - t[0]).abs().max((other.force[a][1] - t[1]).abs());
        if M == 3 {
            error = error.max((other.force[a][M - 1] - f[a][M - 1]).abs());
        }
        assert!(error <= SAME * scale, "{}: {what}: force off by {error:e}", E::NAME);
    }
    let error = difference(&dense(&other.stiffness), &turned_matrix(k, M, angle));
    assert!(error <= SAME * norm(k), "{}: {what}: tangent off by {error:e}", E::NAME);
}

fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    largest(&pairs.map(|(p, q)| p - q).collect::<Vec<_>>())
}

/// `E K E^T` for node-wise rotations.
fn turned_matrix(k: &[Vec<f64>], m: usize, angle: f64) -> Vec<Vec<f64>> {
    let mut rows = k.to_vec();
    for row in &mut rows {
        for a in (0..row.len()).step_by(m) {
            [row[a], row[a + 1]] = turn([row[a], row[a + 1]], angle);
        }
    }
    for a in (0..rows.len()).step_by(m) {
        for c in 0..rows.len() {
            [rows[a][c], rows[a + 1][c]] = turn([rows[a][c], rows[a + 1][c]], angle);
        }
    }
    rows
}

/// Start the numbering at another corner.
fn renumbered<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let mut random = Random::new(6);
    let corners = if E::CELL.starts_with("tri") { 3 } else { 4 };
    assert_eq!(natural(E::CELL).len(), N);
    for strain in strains() {
        let section = section::<E, N, M, A>(Plane::Strain, strain);
        for shift in 1..corners {
            let order: Vec<usize> = (0..N)
                .map(|a| match a / corners {
                    0 => (a + shift) % corners,
                    1 if N > corners => corners + (a + shift) % corners,
                    _ => a,
                })
                .collect();
            let x = cell::<N>(E::CELL, &mut random, 0.05);
            let u = state::<N, M>(&x, &mut random, -2.0, 0.1);
            let (mut y, mut v) = (x, u);
            for a in 0..N {
                y[a] = x[order[a]];
                v[a] = u[order[a]];
            }
            let one = evaluate::<E, f64, N, M, A>(&x, &u, &section, true);
            let two = evaluate::<E, f64, N, M, A>(&y, &v, &section, true);
            let (k, l) = (dense(&one.stiffness), dense(&two.stiffness));
            let (size, stiff) = (largest(one.force.as_flattened()), norm(&k));
            for r in 0..N * M {
                let from = order[r / M] * M + r % M;
                let error = two.force[r / M][r % M] - one.force[order[r / M]][r % M];
                assert!(error.abs() <= SAME * size, "{}: force {error:e}", E::NAME);
                for c in 0..N * M {
                    let error = l[r][c] - k[from][order[c / M] * M + c % M];
                    assert!(error.abs() <= SAME * stiff, "{}: tangent {error:e}", E::NAME);
                }
            }
        }
    }
}

macro_rules! for_all {
    ($test:ident, $check:ident) => {
        #[test]
        fn $test() {
            macro_rules! each {
                ($e:ty, $n:literal, $m:literal, $a:literal) => {
                    $check::<$e, $n, $m, $a>();
                };
            }
            for_each_planar_element!(each);
        }
    };
}

for_all!(rigid_motions_of_any_size_give_no_force, no_force);
for_all!(force_and_tangent_turn_with_the_body, objective);
for_all!(numbering_does_not_matter, renumbered);
