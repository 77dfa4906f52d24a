//! Properties of all laws in the lists.
// SPDX-License-Identifier: BSD-3-Clause

use super::{Constraint, ContactLaw, NORMAL, State, TANGENTIAL};

const CONSTANTS: (&[f64], &[f64]) = (&[0.0, 40.0, 120.0], &[0.01, 0.02, 0.03]);

fn law(normal: &str, tangential: &str) -> ContactLaw {
    let (pressures, overclosures) = match normal {
        "tabular" => CONSTANTS,
        _ => (&CONSTANTS.0[1..2], &CONSTANTS.1[..1]),
    };
    ContactLaw::new(normal, pressures, overclosures, tangential, &[]).unwrap()
}

fn constraint(gap: f64, p: f64, q: f64) -> Constraint {
    Constraint {
        gap: 0.5 * gap,
        slip: 0.0,
        area: 0.5,
        full: 0.5,
        fixed: 0.5,
        stiffness: 1e3,
        begin: None,
        p,
        q,
        noise: 1e-14,
        adheres: false,
        friction: 0.3,
    }
}

#[test]
fn an_open_gap_without_tractions_fulfills_all_conditions() {
    for (normal, _) in NORMAL {
        for (tangential, _) in TANGENTIAL {
            let (law, at) = (law(normal, tangential), constraint(1.0, 0.0, 0.0));
            assert_eq!(law.state(&at, None), State::Open, "{normal} {tangential}");
            assert!(law.residual(&at).abs() < 1e-300, "{normal} {tangential}");
        }
    }
}

#[test]
fn a_newton_correction_meets_the_condition_across() {
    // The row of a closed constraint, `-dG + d dp = rhs`, solved for dp at a fixed gap.
    for (normal, _) in NORMAL.iter().filter(|e| e.0 != "hard") {
        for gap in [-0.015, -0.025, -0.05] {
            let (law, mut at) = (law(normal, "frictionless"), constraint(gap, 7.0, 0.0));
            let [diagonal, rhs] = law.rows(&at, State::Closed, 1.0).p;
            at.p += rhs / diagonal;
            let size = at.area * at.p;
            assert!(law.residual(&at) <= 1e-12 * size, "{normal} at {gap}: {}", law.residual(&at));
        }
    }
}

#[test]
fn pressure_is_the_derivative_of_energy_and_slope_that_of_pressure() {
    for (normal, _) in NORMAL {
        let law = law(normal, "frictionless");
        let h = 1e-6;
        for gap in [-0.015, -0.025, -0.0401] {
            let ([a, pa, ea], [b, pb, eb]) = (
                {
                    let [p, _, e] = law.pressure(gap + h);
                    [gap + h, p, e]
                },
                {
                    let [p, _, e] = law.pressure(gap - h);
                    [gap - h, p, e]
                },
            );
            let [p, slope, _] = law.pressure(gap);
            let near = |x: f64, y: f64| (x - y).abs() <= 1e-5 * (x.abs() + y.abs() + 1e-9);
            assert!(near((ea - eb) / (b - a), p), "{normal} at {gap}: energy");
            assert!(near((pa - pb) / (b - a), slope), "{normal} at {gap}: slope");
        }
    }
}

#[test]
fn the_mean_pressure_of_an_increment_does_the_work_of_the_law() {
    for (normal, _) in NORMAL.iter().filter(|e| e.0 != "hard") {
        let law = law(normal, "frictionless");
        for (begin, end) in [(-0.012, -0.026), (0.2, -0.03), (-0.02, -0.020_000_1)] {
            let mut at = constraint(end, 0.0, 0.0);
            at.begin = Some(0.5 * begin);
            let mean = law.residual(&at) / at.area;
            let work = mean * (begin - end);
            let stored = law.pressure(end)[2] - law.pressure(begin)[2];
            assert!((work - stored).abs() <= 1e-7 * stored.abs(), "{normal}: {work} {stored}");
        }
    }
}

#[test]
fn friction_slips_beyond_its_bound_and_goes_on_at_it() {
    let law = law("hard", "coulomb");
    let state = |q, last| law.state(&constraint(0.0, 10.0, q), last);
    assert_eq!(state(2.9, None), State::Closed);
    assert_eq!(state(3.1, None), State::Slipping);
    assert_eq!(state(3.0, Some(State::Slipping)), State::Slipping);
    assert!(law.residual(&constraint(0.0, 10.0, 3.0)).abs() < 1e-300);
    assert!((law.residual(&constraint(0.0, 10.0, 4.0)) - 0.5).abs() < 1e-12);
}

#[test]
fn what_touches_sticks_whatever_the_rounding_of_its_gap() {
    let law = law("hard", "coulomb");
    for gap in [-1e-15, 0.0, 1e-15] {
        assert_eq!(law.state(&constraint(gap, 0.0, 0.0), None), State::Closed);
    }
}

#[test]
fn constraints_without_the_other_side_ask_for_no_traction() {
    let laws = NORMAL.iter().map(|(normal, _)| law(normal, "coulomb"));
    for law in laws.chain([ContactLaw::Joined]) {
        let mut at = constraint(-1.0, 0.0, 0.0);
        at.area = 0.0;
        assert_eq!(law.state(&at, Some(State::Closed)), State::Open);
        assert!(law.residual(&at).abs() < 1e-300);
        at.p = 2.0;
        assert!(law.residual(&at) >= 1.0);
    }
}
