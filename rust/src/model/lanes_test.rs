//! Every lane of a pack gives what plain numbers give, for everything that is registered.
// SPDX-License-Identifier: BSD-3-Clause

use super::build::{BlockInput, Options};
use super::chunk::Kinematics;
use super::problem::Problem;
use super::registry::{self, Facts};
use crate::base::Lanes;
use crate::kinematics::local_strain::LocalStrain;
use crate::materials::{Law, Plane, State};
use std::slice::from_ref;

/// No multiple of any width, so that the last batch has idle lanes.
const ELEMENTS: usize = 13;

/// A nonlinear spring: pairs of elongation and force.
const TABLE: [[f64; 2]; 3] = [[-0.2, -0.1], [0.0, 0.05], [0.3, 0.4]];

/// What is given for each point: the moduli, a little different each time.
fn given(points: usize) -> Vec<f64> {
    let mut random = Random(3);
    let mut values = Vec::new();
    for _ in 0..points {
        let factor = 1.0 + 0.2 * random.next();
        let mut state = [0.0; crate::materials::tabulated::MEMBERS];
        let &[a, b, c, _, d, e, _, _, f] = Law::examples("given")[0] else { unreachable!() };
        state[6..12].copy_from_slice(&[a, b, c, d, e, f].map(|m| m * factor));
        values.extend(state);
    }
    values
}

/// Numbers in (-1, 1) that are the same each time (a linear congruence).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Reference positions of the nodes of one cell.
fn cell(kind: &str) -> Vec<[f64; 2]> {
    let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    let square = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [1.0, 0.5],
        [0.5, 1.0],
        [0.0, 0.5],
        [0.5, 0.5],
    ];
    match kind {
        "tri3" => triangle[..3].to_vec(),
        "tri6" => triangle.to_vec(),
        "quad4" => square[..4].to_vec(),
        "quad8" => square[..8].to_vec(),
        "quad9" => square.to_vec(),
        "line2" => square[..2].to_vec(),
        "point1" => square[..1].to_vec(),
        _ => panic!("no cell {kind}"),
    }
}

struct Case {
    x: Vec<[f64; 2]>,
    input: BlockInput,
    /// Displacements of two increments.
    u: [Vec<f64>; 2],
    dofs_per_element: usize,
}

/// Separate elements, each with a shape, a rotation and a deformation of its own; the rotation
/// is small where the frames do not turn.
fn case(facts: &Facts, law: &str, strain: &str, nlgeom: bool) -> Case {
    let mut random = Random(7);
    let (mut x, mut small, mut large) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ELEMENTS {
        let angle = if nlgeom { 1.5 } else { 0.03 } * random.next();
        let (c, s) = (angle.cos(), angle.sin());
        // A stretch much larger than rounding errors of the displacements, then a little noise.
        let g = [0.0; 4].map(|_: f64| 0.2 * random.next());
        for p in cell(facts.cell) {
            let p = p.map(|v| v + 0.08 * random.next());
            x.push(p);
            for (u, size) in [(&mut small, 0.5), (&mut large, 1.0)] {
                let q = [
                    p[0] + size * (g[0] * p[0] + g[1] * p[1] + 0.03 * random.next()),
                    p[1] + size * (g[2] * p[0] + g[3] * p[1] + 0.03 * random.next()),
                ];
                u.push(c * q[0] - s * q[1] - p[0]);
                u.push(s * q[0] + c * q[1] - p[1]);
                if facts.dofs_per_node == 3 {
                    u.push(angle + 0.1 * size * random.next());
                }
            }
        }
    }
    let input = BlockInput {
        element: facts.name.into(),
        law: law.into(),
        parameters: Law::examples(law)[0].to_vec(),
        plane: Plane::Stress,
        ring: false,
        local_strain: strain.into(),
        thickness: 0.7,
        nodal_thickness: if strain == "logarithmic" {
            x.iter().map(|p| 0.7 + 0.2 * p[0]).collect()
        } else {
            Vec::new()
        },
        sides: if strain == "logarithmic" {
            x.iter().map(|p| 0.5 + 0.4 * p[1].sin()).collect()
        } else {
            Vec::new()
        },
        profile: [0.7, 0.1, 0.4],
        table: if strain == "logarithmic" { TABLE.to_vec() } else { Vec::new() },
        fibers: vec![],
        rho: 1.0,
        nodal_density: Vec::new(),
        by_temperature: Vec::new(),
        options: Options::default(),
        nodes: (0..x.len() as u32).collect(),
    };
    let dofs_per_element = facts.n_nodes * facts.dofs_per_node;
    Case { x, input, u: [small, large], dofs_per_element }
}

/// Laws that an element takes: along a line some have no answer, and those with a history need the
/// fibers of a profile in beams (`elements::fibers`).
fn laws_of(facts: &Facts) -> Vec<&'static str> {
    let fits = |law: &str| match Law::new(law, Law::examples(law)[0], State::Line) {
        Ok(found) => !facts.line || facts.dofs_per_node == 2 || found.n_state() == 0,
        Err(_) => !facts.line,
    };
    Law::NAMES.iter().copied().filter(|law| fits(law)).collect()
}

impl Case {
    /// Force, scale and stiffness after each increment, and the elements that failed in any.
    fn run(&self, lanes: Lanes, kinematics: Kinematics) -> (Vec<[Vec<f64>; 3]>, Vec<usize>) {
        let mut problem = Problem::new(self.x.clone(), from_ref(&self.input), &[]).unwrap();
        problem.set_lanes(lanes);
        if self.input.law == "given" {
            problem.give(0, &given(ELEMENTS * problem.blocks[0].facts.n_points)).unwrap();
        }
        if !self.input.by_temperature.is_empty() {
            let points = ELEMENTS * problem.blocks[0].facts.n_points;
            problem.set_temperatures(0, &vec![150.0; points]).unwrap();
        }
        let values = 4 * ELEMENTS * problem.blocks[0].facts.n_points;
        // As large as the strain of first yield; more is too much for the histories that follow.
        let initial: Vec<f64> = (0..values).map(|i| 0.001 * (i as f64).sin()).collect();
        problem.set_initial(0, &initial).unwrap();
        let (n, nnz) = (problem.dofs.n_dofs(), problem.dofs.indices.len());
        let mut failed = Vec::new();
        let mut answers = Vec::new();
        for u in &self.u {
            let mut out = [vec![0.0; n], vec![0.0; n], vec![0.0; nnz]];
            let [force, scale, values] = &mut out;
            if let Err(which) = problem.assemble(u, kinematics, force, scale, values) {
                failed.extend(which.0.iter().map(|f| f.1));
            }
            problem.commit();
            answers.push(out);
        }
        (answers, failed)
    }
}

fn agree(got: &[f64], want: &[f64], per_element: usize, failed: &[usize], what: &str) {
    for (e, (g, w)) in got.chunks(per_element).zip(want.chunks(per_element)).enumerate() {
        if failed.contains(&e) {
            continue;
        }
        let size = w.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (g, w) in g.iter().zip(w) {
            assert!((g - w).abs() <= 1e-13 * size, "{what}: element {e}: {g} and {w}");
        }
    }
}

/// Packs of each width that this build has on this processor.
fn widths() -> Vec<Lanes> {
    let mut all = vec![Lanes::Best, Lanes::Four];
    all.dedup_by_key(|lanes| lanes.width());
    all
}

const KINEMATICS: [Kinematics; 3] = [Kinematics::Linear, Kinematics::Stressed, Kinematics::Finite];

/// Whether a case is one of those in which every element meets every law, and every element and
/// every law meet every strain in every kinematics: one case of nine.
fn covers(element: usize, law: usize, strain: usize, kinematics: usize) -> bool {
    (element + law) % 3 == strain && (element / 3 + law / 3) % 3 == kinematics
}

/// Compare each width of packs with plain numbers in the cases that are `taken`, given the places
/// of element, law, strain and kinematics in their lists.
fn compare(taken: impl Fn(usize, usize, usize, usize) -> bool) {
    for (e, facts) in registry::facts().iter().enumerate() {
        for (l, law) in laws_of(facts).into_iter().enumerate() {
            for (s, strain) in LocalStrain::NAMES.iter().enumerate() {
                for (k, kinematics) in KINEMATICS.into_iter().enumerate() {
                    if taken(e, l, s, k) {
                        packs_agree(facts, law, strain, kinematics);
                    }
                }
            }
        }
    }
}

fn packs_agree(facts: &Facts, law: &str, strain: &str, kinematics: Kinematics) {
    let case = case(facts, law, strain, kinematics == Kinematics::Finite);
    let d = case.dofs_per_element;
    // A history may be too much for an element; then it is for every lane.
    let (plain, failed) = case.run(Lanes::Scalar, kinematics);
    let count = failed.len();
    assert!(count <= ELEMENTS / 4, "{} {law} {strain}: {count} fail", facts.name);
    for lanes in widths() {
        let what = format!("{} {law} {strain} {kinematics:?} {} lanes", facts.name, lanes.width());
        let (packs, out) = case.run(lanes, kinematics);
        assert_eq!(out, failed, "{what}");
        for (pack, plain) in packs.iter().zip(&plain) {
            agree(&pack[0], &plain[0], d, &failed, &what);
            agree(&pack[1], &plain[1], d, &failed, &what);
            agree(&pack[2], &plain[2], d * (d + 1) / 2, &failed, &what);
        }
    }
}

#[test]
fn packs_give_what_plain_numbers_give() {
    compare(covers);
}

#[test]
#[ignore = "slow: the full product of cases"]
fn packs_give_what_plain_numbers_give_in_every_case() {
    compare(|e, l, s, k| !covers(e, l, s, k));
}

#[test]
fn every_failed_lane_is_named() {
    // Line elements cannot turn inside out.
    for facts in registry::facts().into_iter().filter(|f| !f.line) {
        let mut case = case(&facts, "elastic", "green_lagrange", true);
        let turned_inside_out = [0, 3, 6, 12];
        // The mirror image of the cell: no rotation brings it back.
        for e in turned_inside_out {
            for a in 0..facts.n_nodes {
                let node = e * facts.n_nodes + a;
                let at = node * facts.dofs_per_node;
                case.u[0][at] = -2.5 * case.x[node][0];
                case.u[0][at + 1] = 0.0;
            }
        }
        for lanes in std::iter::once(Lanes::Scalar).chain(widths()) {
            let mut problem = Problem::new(case.x.clone(), from_ref(&case.input), &[]).unwrap();
            problem.set_lanes(lanes);
            let n = problem.dofs.n_dofs();
            let (mut force, mut scale) = (vec![0.0; n], vec![0.0; n]);
            let failed = problem
                .assemble(&case.u[0], Kinematics::Finite, &mut force, &mut scale, &mut [])
                .expect_err("mirrored elements fail");
            let named: Vec<usize> = failed.0.iter().map(|f| f.1).collect();
            assert_eq!(named, turned_inside_out, "{} {lanes:?}", facts.name);
        }
    }
}

/// Half of Young's modulus, or of the first of the moduli.
fn softened(law: &str) -> Vec<f64> {
    let mut numbers = Law::examples(law)[0].to_vec();
    numbers[0] *= 0.5;
    numbers
}

#[test]
fn a_law_between_two_temperatures_is_the_law_with_the_parameters_between() {
    for (e, facts) in registry::facts().iter().enumerate() {
        for (l, law) in laws_of(facts).into_iter().enumerate() {
            // Every element and every law meet every strain.
            let strain = LocalStrain::NAMES[(e + l) % LocalStrain::NAMES.len()];
            let mut wanted = case(facts, law, strain, true);
            let mut found = case(facts, law, strain, true);
            let (cold, hot) = (found.input.parameters.clone(), softened(law));
            let at = |a: &f64, b: &f64| a + 0.25 * (b - a);
            wanted.input.parameters = cold.iter().zip(&hot).map(|(a, b)| at(a, b)).collect();
            // What the block has without temperatures does not matter.
            found.input.by_temperature = vec![(100.0, cold), (300.0, hot)];
            let (wanted, failed) = wanted.run(Lanes::Scalar, Kinematics::Finite);
            let (found, also) = found.run(Lanes::Best, Kinematics::Finite);
            assert_eq!(failed, also, "{} {law} {strain}", facts.name);
            assert!(found == wanted, "{} {law} {strain}", facts.name);
        }
    }
}
