//! Shape functions: one at their node and zero at the others, sum one, linear completeness,
//! derivatives; weights of the rules.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{Random, natural};
use corota::elements::Element;
use corota::for_each_planar_element;

const ROUNDOFF: f64 = 1e-14;
/// Central difference with step 1e-5 of a polynomial of degree 4.
const DIFFERENCE: f64 = 1e-9;

fn check<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>() {
    let name = E::NAME;
    let nodes = natural(E::CELL);
    let triangle = E::CELL.starts_with("tri");
    assert_eq!(nodes.len(), N, "{name}: a {} has another number of nodes", E::CELL);
    for (b, &xi) in nodes.iter().enumerate() {
        let (n, _) = E::shape(xi);
        for a in 0..N {
            let expected = f64::from(u8::from(a == b));
            assert!((n[a] - expected).abs() < ROUNDOFF, "{name}: N_{a} at node {b} is {}", n[a]);
        }
    }
    let mut random = Random::new(1);
    for _ in 0..20 {
        let xi = if triangle {
            let r = random.between(0.0, 1.0);
            [r, random.between(0.0, 1.0 - r)]
        } else {
            [random.signed(), random.signed()]
        };
        let (n, dn) = E::shape(xi);
        assert!((n.iter().sum::<f64>() - 1.0).abs() < ROUNDOFF, "{name}: sum of N");
        for i in 0..2 {
            let position: f64 = (0..N).map(|a| n[a] * nodes[a][i]).sum();
            assert!((position - xi[i]).abs() < ROUNDOFF, "{name}: position {position}");
            for j in 0..2 {
                let slope: f64 = (0..N).map(|a| dn[a][j] * nodes[a][i]).sum();
                let expected = f64::from(u8::from(i == j));
                assert!((slope - expected).abs() < 10.0 * ROUNDOFF, "{name}: slope {slope}");
            }
        }
        for j in 0..2 {
            let h = 1e-5;
            let (mut low, mut high) = (xi, xi);
            low[j] -= h;
            high[j] += h;
            let (below, above) = (E::shape(low).0, E::shape(high).0);
            for a in 0..N {
                let slope = (above[a] - below[a]) / (2.0 * h);
                assert!((slope - dn[a][j]).abs() < DIFFERENCE, "{name}: dN_{a} / dxi_{j}");
            }
        }
    }
    if M == 3 {
        // Each mid-side function: one at its own middle, zero at corners and other middles.
        let corners = nodes.len();
        for a in 0..corners {
            let b = (a + 1) % corners;
            let middle = [0.5 * (nodes[a][0] + nodes[b][0]), 0.5 * (nodes[a][1] + nodes[b][1])];
            let values = E::sides(middle);
            for c in 0..N {
                let expected = f64::from(u8::from(a == c));
                assert!((values[c] - expected).abs() < ROUNDOFF, "{name}: side {c} at {a}");
            }
            assert!(E::sides(nodes[a]).iter().all(|v| v.abs() < ROUNDOFF), "{name}: corner {a}");
        }
    }
    let area = if triangle { 0.5 } else { 4.0 };
    for rule in [E::rule(), E::mass_rule()] {
        let weight: f64 = rule.iter().map(|p| p[2]).sum();
        assert!((weight - area).abs() < 1e-13, "{name}: weights sum to {weight}, not {area}");
        for moment in 0..2 {
            // First moment of the reference cell: 1/6 or 0.
            let first: f64 = rule.iter().map(|p| p[2] * p[moment]).sum();
            let expected = if triangle { 1.0 / 6.0 } else { 0.0 };
            assert!((first - expected).abs() < 1e-13, "{name}: first moment {first}");
        }
    }
}

#[test]
fn shape_functions_interpolate_and_sum_to_one() {
    macro_rules! each {
        ($e:ty, $n:literal, $m:literal, $a:literal) => {
            check::<$e, $n, $m, $a>();
        };
    }
    for_each_planar_element!(each);
}
