//! Elements at rest and in large rotation beside values computed by an independent
//! implementation (`tests/data/element_vectors.json`): what symmetries cannot see.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::{dense, evaluate, largest, norm};
use corota::elements::Element;
use corota::for_each_planar_element;
use corota::kinematics::integrate::Section;
use corota::kinematics::local_strain::LocalStrain;
use corota::materials::{Law, Plane, State};
use serde_json::Value;

const AGREE: f64 = 1e-10;

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(rows) => rows.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

fn check<E: Element<N, M, A>, const N: usize, const M: usize, const A: usize>(case: &Value) {
    let number = |key: &str| case[key].as_f64().expect("a number");
    assert_eq!(case["plane"], "stress");
    let law = Law::new("elastic", &[number("E"), number("nu")], State::Plane(Plane::Stress))
        .expect("valid");
    let section = Section {
        points: E::points(&E::rule()),
        strain: local_strain(&case["local_strain"]),
        plane: Plane::Stress,
        thickness: number("thickness"),
        profile: [0.0; 3],
        table: Vec::new(),
        fibers: Vec::new(),
        parameter: E::parameter(&law.moduli()),
        law,
        mean_dilatation: false,
        ring: false,
        finite: true,
    };
    let (mut x, mut u) = ([[0.0; 2]; N], [[0.0; M]; N]);
    x.as_flattened_mut().copy_from_slice(&numbers(&case["X"]));
    u.as_flattened_mut().copy_from_slice(&numbers(&case["u"]));
    let rest = evaluate::<E, f64, N, M, A>(&x, &[[0.0; M]; N], &section, true);
    let at = evaluate::<E, f64, N, M, A>(&x, &u, &section, true);
    let matrices = [("stiffness_at_rest", rest.stiffness), ("tangent", at.stiffness)];
    for (key, found) in matrices {
        let (found, expected) = (dense(&found), numbers(&case[key]));
        let error =
            largest(&found.iter().flatten().zip(&expected).map(|(a, b)| a - b).collect::<Vec<_>>());
        assert!(error <= AGREE * norm(&found), "{}: {key} off by {error:e}", E::NAME);
    }
    let expected = numbers(&case["force"]);
    let pairs = at.force.as_flattened().iter().zip(&expected);
    let error = largest(&pairs.map(|(a, b)| a - b).collect::<Vec<_>>());
    assert!(error <= AGREE * largest(&expected), "{}: force off by {error:e}", E::NAME);
}

#[test]
fn elements_agree_with_an_independent_implementation() {
    let text = include_str!("../../../tests/data/element_vectors.json");
    let data: Value = serde_json::from_str(text).expect("valid JSON");
    let mut checked = 0;
    for case in data["elastic"].as_array().expect("a list") {
        macro_rules! pick {
            ($e:ty, $n:literal, $m:literal, $a:literal) => {
                if case["element"] == <$e as Element<$n, $m, $a>>::NAME {
                    check::<$e, $n, $m, $a>(case);
                    checked += 1;
                }
            };
        }
        for_each_planar_element!(pick);
    }
    assert_eq!(checked, 14);
}

/// The vectors name the strain as the paper does.
fn local_strain(name: &serde_json::Value) -> LocalStrain {
    assert_eq!(name.as_str(), Some("simplified"));
    LocalStrain::Linear
}
