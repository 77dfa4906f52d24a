//! Materials: the tangent is the derivative of the stress, symmetric, and at small strain the
//! moduli; energy and thickness values belong to the stress.
// SPDX-License-Identifier: BSD-3-Clause

use super::common::Random;
use corota::base::{Dual, Real};
use corota::materials::{Clock, Law, Plane, PointState, State};

const EXACT: f64 = 1e-10;
/// An increment for laws that depend on time.
const CLOCK: Clock = Clock { increment: 0.5, end: 2.0, lasting: true };

/// History of a point at rest.
fn rest(name: &str, law: &Law) -> Vec<f64> {
    let mut state = vec![0.0; law.n_state()];
    if name == "given" {
        let c = law.moduli();
        state[6..12].copy_from_slice(&[c[0][0], c[0][1], c[0][2], c[1][1], c[1][2], c[2][2]]);
    }
    state
}

fn stress<T: Real>(law: &Law, strain: [T; 3], old: &[f64]) -> ([T; 3], [[T; 3]; 3], Vec<f64>) {
    stress_over(law, strain, old, CLOCK)
}

fn stress_over<T: Real>(
    law: &Law,
    strain: [T; 3],
    old: &[f64],
    clock: Clock,
) -> ([T; 3], [[T; 3]; 3], Vec<f64>) {
    let mut new = old.to_vec();
    let mut state = PointState { old, new: &mut new, stride: 1, clock };
    let answer = law.update(strain, &mut state);
    assert!(!T::any(answer.failed));
    (answer.stress, answer.tangent, new)
}

#[test]
fn tangent_is_the_derivative_of_the_stress() {
    for name in Law::NAMES {
        for state in [State::Plane(Plane::Stress), State::Plane(Plane::Strain), State::Line] {
            for numbers in &Law::examples(name)[1..] {
                match Law::new(name, numbers, state) {
                    Ok(law) => paths(name, &law, state, &format!("{name} {state:?} {numbers:?}")),
                    // Not every law is one of bars.
                    Err(why) => assert!(state == State::Line, "{why}"),
                }
            }
        }
    }
}

/// Random strain paths; the first stays so small that every law is linear to round-off, also one
/// whose moduli change with the strain, and takes no time.
fn paths(name: &str, law: &Law, state: State, what: &str) {
    let rows = if state == State::Line { 1 } else { 3 };
    let mut random = Random::new(8);
    let moduli = law.moduli();
    let top = moduli[0][0].max(moduli[1][1]);
    for path in 0..40 {
        let size = if path == 0 { 1e-15 } else { 0.02 };
        let mut old = rest(name, law);
        let mut strain = [0.0; 3];
        for step in 0..6 {
            for e in &mut strain[..rows] {
                *e += size * random.signed();
            }
            let mut variable = [Dual::<3>::real(0.0); 3];
            for i in 0..3 {
                variable[i] = Dual::variable(strain[i], i);
            }
            let clock = if path == 0 { Clock::default() } else { CLOCK };
            let (s, t, new) = stress_over(law, strain, &old, clock);
            let (dual, _, _) = stress_over(law, variable, &old, clock);
            for i in 0..rows {
                assert!((dual[i].v - s[i]).abs() <= 1e-13 * top, "{what}: number types");
                for j in 0..rows {
                    let error = (t[i][j] - dual[i].d[j]).abs() / top;
                    assert!(error <= EXACT, "{what}: step {step}: off by {error:e}");
                    let skew = (t[i][j] - t[j][i]).abs() / top;
                    assert!(skew <= 1e-13, "{what}: not symmetric {skew:e}");
                    if path == 0 {
                        let error = (t[i][j] - moduli[i][j]).abs() / top;
                        assert!(error <= 1e-13, "{what}: moduli {error:e}");
                    }
                }
            }
            old = new;
        }
    }
}

/// Laws that answer strains in the plane alone.
const IN_PLANE: [&str; 2] = ["given", "c_function"];

/// With a strain through the thickness: the tangent is the derivative, and without that strain the
/// answer is the one of plane strain.
#[test]
fn a_strain_through_the_thickness_has_its_tangent() {
    let mut random = Random::new(10);
    for name in Law::NAMES.iter().filter(|name| !IN_PLANE.contains(name)) {
        for numbers in &Law::examples(name)[1..] {
            let law =
                Law::new(name, numbers, State::Plane(Plane::Strain)).expect("valid constants");
            let moduli = law.moduli();
            let top = moduli[0][0].max(moduli[1][1]);
            let old = rest(name, &law);
            for flat in [true, false] {
                let e: [f64; 4] =
                    std::array::from_fn(
                        |i| {
                            if flat && i == 3 { 0.0 } else { 0.02 * random.signed() }
                        },
                    );
                let mut new = old.clone();
                let mut state = PointState { old: &old, new: &mut new, stride: 1, clock: CLOCK };
                let found = law.update_solid(e, &mut state);
                assert!(!found.failed, "{name}");
                let dual = std::array::from_fn(|i| Dual::<4>::variable(e[i], i));
                let exact = law.update_solid(dual, &mut state);
                for i in 0..4 {
                    for j in 0..4 {
                        let error = (found.tangent[i][j] - exact.stress[i].d[j]).abs() / top;
                        assert!(error <= EXACT, "{name} {numbers:?}: {i} {j} off by {error:e}");
                    }
                }
                if flat {
                    let plane = [e[0], e[1], e[2]];
                    let (s, _, state) = stress(&law, plane, &old);
                    let zz = law.out_of_plane(plane, s, &state).1;
                    for (a, b) in found.stress.into_iter().zip([s[0], s[1], s[2], zz]) {
                        assert!((a - b).abs() <= 1e-13 * top, "{name}: {a} {b}");
                    }
                }
            }
        }
    }
}

/// Compliance of an isotropic and an orthotropic solid in its own axes, by rows 11, 22, 33.
fn compliance(name: &str) -> ([[f64; 3]; 3], f64, f64) {
    match *Law::examples(name)[1] {
        [e, nu] => {
            let (d, o) = (1.0 / e, -nu / e);
            ([[d, o, o], [o, d, o], [o, o, d]], 2.0 * (1.0 + nu) / e, 0.0)
        }
        [e1, e2, e3, nu12, nu13, nu23, g12, angle] => {
            let (a, b, c) = (-nu12 / e1, -nu13 / e1, -nu23 / e2);
            ([[1.0 / e1, a, b], [a, 1.0 / e2, c], [b, c, 1.0 / e3]], 1.0 / g12, angle)
        }
        _ => unreachable!("two laws are elastic"),
    }
}

/// Hooke's law in three dimensions, from the stress back to the strain, in material axes.
#[test]
fn elastic_laws_obey_hooke_in_three_dimensions() {
    let mut random = Random::new(9);
    for name in ["elastic", "orthotropic"] {
        let (s, shear, angle) = compliance(name);
        for plane in [Plane::Stress, Plane::Strain] {
            let law = Law::new(name, Law::examples(name)[1], State::Plane(plane))
                .expect("valid constants");
            for _ in 0..20 {
                let e = [random.signed(), random.signed(), random.signed()];
                let (t, _, state) = stress(&law, e, &[]);
                let (strain_zz, stress_zz) = law.out_of_plane(e, t, &state);
                let to_material = |v: [f64; 3]| {
                    let (s, c) = f64::sin_cos(angle);
                    [
                        c * c * v[0] + s * s * v[1] + 2.0 * c * s * v[2],
                        s * s * v[0] + c * c * v[1] - 2.0 * c * s * v[2],
                        c * s * (v[1] - v[0]) + (c * c - s * s) * v[2],
                    ]
                };
                let tensor = to_material([e[0], e[1], 0.5 * e[2]]);
                let t_material = to_material(t);
                let normal = [t_material[0], t_material[1], stress_zz];
                for (i, expected) in [tensor[0], tensor[1], strain_zz].into_iter().enumerate() {
                    let found: f64 = (0..3).map(|j| s[i][j] * normal[j]).sum();
                    assert!((found - expected).abs() < 1e-13, "{name} {plane:?}: strain {i}");
                }
                assert!((shear * t_material[2] - 2.0 * tensor[2]).abs() < 1e-13, "{name}: shear");
                match plane {
                    Plane::Stress => assert!(stress_zz == 0.0),
                    Plane::Strain => assert!(strain_zz == 0.0),
                }
                let work = 0.5 * (e[0] * t[0] + e[1] * t[1] + e[2] * t[2]);
                assert!((law.energy(e, t, &state) - work).abs() < 1e-13, "{name}: energy");
            }
        }
    }
}
