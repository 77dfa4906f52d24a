//! The gradient operator gives a linear field exactly on cells of any shape, with the drilling
//! rotations that belong to it, and the internal modes do not see a constant stress.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{Random, cell, largest, natural};
use corota::elements::{Element, Operator};
use corota::for_each_planar_element;

const ROUNDOFF: f64 = 2e-13;

fn check<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let name = E::NAME;
    let mut random = Random::new(2);
    for curve in [0.0, 0.05].repeat(25) {
        let x = cell::<N>(E::CELL, &mut random, curve);
        let h = [random.signed(), random.signed(), random.signed(), random.signed()];
        let mut q = [[0.0; M]; N];
        for a in 0..N {
            q[a][0] = 0.7 + h[0] * x[a][0] + h[1] * x[a][1];
            q[a][1] = -0.4 + h[2] * x[a][0] + h[3] * x[a][1];
            if M == 3 {
                // OPT takes the skew part from the translations, whatever the rotations.
                q[a][M - 1] = 0.5 * (h[2] - h[1]);
            }
        }
        let prepared = E::prepare(&x, 0.9, &[E::ALPHA_B; N]);
        let mut area = 0.0;
        let mut mean = [[0.0; 2]; A];
        for point in E::points(&E::rule()) {
            let s = E::sample(&x, &prepared, &point);
            let found = s.op.gradient(&q);
            for r in 0..4 {
                assert!((found[r] - h[r]).abs() < ROUNDOFF, "{name}: {found:?} for {h:?}");
            }
            assert!(s.op.drill(&q).abs() < ROUNDOFF, "{name}: drilling row {}", s.op.drill(&q));
            // Columns, force and gradient are one operator.
            for a in 0..N {
                for i in 0..M {
                    let mut unit = [[0.0; M]; N];
                    unit[a][i] = 1.0;
                    let (rows, drill) = s.op.column(a, i);
                    let expected = s.op.gradient(&unit);
                    let error = (0..4).map(|r| (rows[r] - expected[r]).abs()).sum::<f64>();
                    assert!(error == 0.0, "{name}: column {a} {i}");
                    assert!((drill - s.op.drill(&unit)).abs() == 0.0, "{name}: drill {a} {i}");
                    let mut f = [[0.0; M]; N];
                    s.op.add_force(&[0.3, -0.2, 0.5, 0.9], -0.7, &mut f);
                    let work =
                        0.3 * rows[0] - 0.2 * rows[1] + 0.5 * rows[2] + 0.9 * rows[3] - 0.7 * drill;
                    assert!((f[a][i] - work).abs() < ROUNDOFF, "{name}: force {a} {i}");
                }
            }
            area += s.weight;
            for m in 0..A {
                for j in 0..2 {
                    mean[m][j] += s.weight * s.modes[m][j];
                }
            }
        }
        if curve == 0.0 {
            let expected = shoelace(&x, E::CELL);
            assert!((area - expected).abs() < ROUNDOFF, "{name}: area {area}, not {expected}");
        }
        assert!(largest(mean.as_flattened()) < ROUNDOFF, "{name}: modes see constants {mean:?}");
    }
}

/// Area by the boundary polygon, corners and mid-sides in turn; exact for straight sides.
fn shoelace<const N: usize>(x: &[[f64; 2]; N], kind: &str) -> f64 {
    let corners = if kind.starts_with("tri") { 3 } else { 4 };
    let mut ring = Vec::new();
    for a in 0..corners {
        ring.push(x[a]);
        if natural(kind).len() > corners {
            ring.push(x[corners + a]);
        }
    }
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(p, q)| 0.5 * (p[0] * q[1] - q[0] * p[1])).sum()
}

#[test]
fn linear_fields_are_reproduced() {
    macro_rules! each {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            check::<$e, $n, $m, $a>();
        };
    }
    for_each_planar_element!(each);
}
