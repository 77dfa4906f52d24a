//! A cell that is turned inside out is reported, whatever its rotation.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{evaluate, natural, section, strains, turn};
use corota::elements::Element;
use corota::for_each_planar_element;
use corota::materials::Plane;

fn check<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let mut x = [[0.0; 2]; N];
    x.copy_from_slice(&natural(E::CELL));
    for strain in strains() {
        let section = section::<E, N, M, A>(Plane::Stress, strain);
        for angle in [0.0, 1.0, 4.0] {
            let place = |stretch: f64| {
                let mut u = [[0.0; M]; N];
                for a in 0..N {
                    let p = turn([x[a][0], stretch * x[a][1]], angle);
                    u[a][0] = p[0] - x[a][0];
                    u[a][1] = p[1] - x[a][1];
                    if M == 3 {
                        u[a][M - 1] = angle;
                    }
                }
                evaluate::<E, f64, N, M, A>(&x, &u, &section, true).failed
            };
            assert!(place(-0.3), "{}: mirrored and not reported", E::NAME);
            assert!(!place(0.6), "{}: reported without need", E::NAME);
        }
    }
}

#[test]
fn inverted_cells_are_reported() {
    macro_rules! each {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            check::<$e, $n, $m, $a>();
        };
    }
    for_each_planar_element!(each);
}
