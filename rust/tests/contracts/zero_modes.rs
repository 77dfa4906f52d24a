//! Three rigid modes without energy and no others, except declared hourglass modes that a
//! second element removes; all other eigenvalues positive.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{Random, cell, dense, eigenvalues, evaluate, natural, section, strains};
use corota::elements::Element;
use corota::for_each_planar_element;
use corota::kinematics::local_strain::LocalStrain;
use corota::materials::Plane;

/// Eigenvalues below this share of the largest are zero, those above ten times it are not.
const ZERO: f64 = 1e-12;

fn zeros(matrix: Vec<Vec<f64>>, name: &str) -> usize {
    let values = eigenvalues(matrix);
    let top = values[values.len() - 1];
    assert!(values[0] > -ZERO * top, "{name}: negative eigenvalue {:e}", values[0]);
    let count = values.iter().filter(|v| v.abs() < ZERO * top).count();
    assert!(values[count] > 1e-7 * top, "{name}: nearly free mode {:e}", values[count] / top);
    count
}

fn check<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let name = E::NAME;
    let mut random = Random::new(3);
    for strain in strains() {
        for plane in [Plane::Stress, Plane::Strain] {
            let section = section::<E, N, M, A>(plane, strain);
            for nlgeom in [false, true] {
                for _ in 0..5 {
                    // With straight sides: a curved cell has other modes under a reduced rule.
                    let x = cell::<N>(E::CELL, &mut random, 0.0);
                    let rest = [[0.0; M]; N];
                    let k = evaluate::<E, f64, N, M, A>(&x, &rest, &section, nlgeom).stiffness;
                    assert_eq!(zeros(dense(&k), name), 3 + E::HOURGLASS, "{name}");
                }
            }
        }
    }
    if E::HOURGLASS > 0 {
        assert_eq!(zeros(patch::<E, N, M, A>(), name), 3, "{name}: on a patch of two");
    }
}

/// Stiffness of two cells side by side.
fn patch<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() -> Vec<Vec<f64>> {
    let section = section::<E, N, M, A>(Plane::Stress, LocalStrain::Linear);
    let reference = natural(E::CELL);
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut parts = Vec::new();
    for shift in [0.0, 2.0] {
        let mut x = [[0.0; 2]; N];
        let mut numbers = [0; N];
        for a in 0..N {
            x[a] = [reference[a][0] + shift, reference[a][1]];
            let known = points.iter().position(|p| (p[0] - x[a][0]).hypot(p[1] - x[a][1]) < 1e-9);
            numbers[a] = known.unwrap_or_else(|| {
                points.push(x[a]);
                points.len() - 1
            });
        }
        let k = evaluate::<E, f64, N, M, A>(&x, &[[0.0; M]; N], &section, true).stiffness;
        parts.push((numbers, dense(&k)));
    }
    let n = points.len() * M;
    let mut total = vec![vec![0.0; n]; n];
    for (numbers, k) in parts {
        for r in 0..N * M {
            for c in 0..N * M {
                total[numbers[r / M] * M + r % M][numbers[c / M] * M + c % M] += k[r][c];
            }
        }
    }
    total
}

#[test]
fn only_rigid_motions_are_free() {
    macro_rules! each {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            check::<$e, $n, $m, $a>();
        };
    }
    for_each_planar_element!(each);
}
