//! Unilateral constraints with Coulomb friction, linearized: all conditions as one linear
//! complementarity problem.
//!
//! The equations are solved about given states of the constraints. What breaks a state is an input
//! of that solution, two of each constraint:
//!
//! - open: its pressure; closed: its gap,
//! - sticking: its slip; open: its traction; slipping: its traction less `mu d p`, with the
//!   direction `d` of the traction.
//!
//! What is zero or positive goes with what it is complementary to: the gap, the pressure; the two
//! sides of the bound with the slip forward and backward; the slack `mu p - d q` with the slip
//! against the traction, and the other side of the bound with the slip along it. A. Klarbring, *A
//! mathematical programming approach to three-dimensional contact problems with friction*, Comput.
//! Methods Appl. Mech. Engrg. 58 (1986).
//!
//! From states that are nearly right, all that break their condition change at once (block principal
//! pivots: J. J. Judice, F. M. Pires, *A block principal pivoting algorithm for large-scale strictly
//! monotone linear complementarity problems*, Comput. Oper. Res. 21 (1994)); where they do not
//! become fewer, and without such states, Lemke's method solves the whole problem.
// SPDX-License-Identifier: BSD-3-Clause

use super::complementarity::{TIE, largest, lemke};
use super::law::State;

/// Changes of the set without fewer conditions that break, as proposed by Judice and Pires.
const PATIENCE: usize = 10;

/// Constraints linearized about states.
///
/// Rows of `normal` and `tangent` begin with the value at no inputs; its changes by the inputs, two
/// of each constraint, follow. All are forces, gaps and slips by a stiffness.
pub struct Linearized<'a> {
    pub states: &'a [State],
    /// Sign of the traction of each that slips.
    pub directions: &'a [f64],
    /// Coefficients of friction; none without shear tractions.
    pub friction: &'a [Option<f64>],
    /// Pressure of what is closed, gap of what is open.
    pub normal: &'a [f64],
    /// Traction of what sticks, slip of what does not: rows of those with friction alone.
    pub tangent: &'a [f64],
}

/// A solution: inputs, and the constraints with them.
pub struct Solved {
    pub inputs: Vec<f64>,
    pub states: Vec<i8>,
    pub directions: Vec<f64>,
    pub pressures: Vec<f64>,
    pub tractions: Vec<f64>,
}

/// What the unknowns of a constraint are, each with what is zero or positive beside it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Unknown {
    /// Pressure beside the gap of what is open, gap beside the pressure of what is closed.
    Normal,
    /// Slip of what sticks, beside the slack of the bound that it goes to.
    Forward,
    Backward,
    /// Slack of the bound, beside the slip against the traction.
    Slack,
    /// Slip along the traction, beside the slack of the other bound.
    Along,
}

struct Problem {
    unknowns: Vec<(usize, Unknown)>,
    c: Vec<f64>,
    m: Vec<f64>,
}

impl Linearized<'_> {
    /// Inputs with which all conditions hold, from `start` if there are states; None if none are
    /// found. If all `slides`, they are sought from there as well.
    pub fn solve(&self, start: Option<&[State]>, slides: bool) -> Option<Solved> {
        let problem = self.problem();
        let near = start.and_then(|start| problem.by_sets(self, &problem.basis(self, start)));
        let found = near.or_else(|| lemke(&problem.c, &problem.m, None)).or_else(|| {
            let basis = slides.then(|| problem.sliding())??;
            lemke(&problem.c, &problem.m, Some(&basis))
        });
        found.map(|(x, basic)| self.read(&problem, &x, &basic))
    }

    fn width(&self) -> usize {
        1 + 2 * self.states.len()
    }

    fn row<'b>(&self, of: &'b [f64], i: usize) -> &'b [f64] {
        &of[i * self.width()..][..self.width()]
    }

    /// The row that is an input alone.
    fn input(&self, number: usize) -> Vec<f64> {
        let mut row = vec![0.0; self.width()];
        row[1 + number] = 1.0;
        row
    }

    /// Slip or traction of a constraint, as `tangent` has it.
    fn tangent(&self, i: usize) -> &[f64] {
        self.row(self.tangent, self.friction[..i].iter().flatten().count())
    }

    fn pressure(&self, i: usize) -> Vec<f64> {
        if self.states[i] == State::Open {
            return self.input(2 * i);
        }
        self.row(self.normal, i).to_vec()
    }

    /// Side of the bound of the traction of a constraint, `mu p + sign q`.
    fn bound(&self, i: usize, mu: f64, sign: f64) -> Vec<f64> {
        let (traction, share) = match self.states[i] {
            State::Closed => (self.tangent(i).to_vec(), 0.0),
            State::Open => (self.input(2 * i + 1), 0.0),
            State::Slipping => (self.input(2 * i + 1), self.directions[i]),
        };
        let sum = |(p, q): (f64, f64)| mu * (1.0 + sign * share) * p + sign * q;
        self.pressure(i).into_iter().zip(traction).map(sum).collect()
    }

    /// What is zero or positive beside an unknown, by the inputs.
    fn beside(&self, i: usize, unknown: Unknown) -> Vec<f64> {
        let (mu, direction) = (self.friction[i].unwrap_or(0.0), self.directions[i]);
        match unknown {
            Unknown::Normal => self.row(self.normal, i).to_vec(),
            Unknown::Forward => self.bound(i, mu, 1.0),
            Unknown::Backward => self.bound(i, mu, -1.0),
            Unknown::Slack => self.tangent(i).iter().map(|slip| -direction * slip).collect(),
            Unknown::Along => self.bound(i, mu, direction),
        }
    }

    /// The inputs that an unknown is, two at most: their columns and factors.
    fn inputs(&self, i: usize, unknown: Unknown) -> [(usize, f64); 2] {
        let (normal, tangent, direction) = (1 + 2 * i, 2 + 2 * i, self.directions[i]);
        match (unknown, self.friction[i]) {
            // Its traction is at the bound without the slack.
            (Unknown::Normal, Some(mu)) if self.states[i] == State::Open => {
                [(normal, 1.0), (tangent, mu * direction)]
            }
            (Unknown::Normal, _) => [(normal, 1.0), (0, 0.0)],
            (Unknown::Forward, _) => [(tangent, 1.0), (0, 0.0)],
            (Unknown::Backward, _) => [(tangent, -1.0), (0, 0.0)],
            (Unknown::Slack, _) => [(tangent, -direction), (0, 0.0)],
            (Unknown::Along, _) => [(0, 0.0); 2],
        }
    }

    fn problem(&self) -> Problem {
        let of = |i: usize| -> &[Unknown] {
            match (self.friction[i], self.states[i]) {
                (None, _) => &[Unknown::Normal],
                (_, State::Closed) => &[Unknown::Normal, Unknown::Forward, Unknown::Backward],
                _ => &[Unknown::Normal, Unknown::Slack, Unknown::Along],
            }
        };
        let unknowns: Vec<_> =
            (0..self.states.len()).flat_map(|i| of(i).iter().map(move |&u| (i, u))).collect();
        let inputs: Vec<_> = unknowns.iter().map(|&(i, unknown)| self.inputs(i, unknown)).collect();
        let n = unknowns.len();
        let (mut c, mut m) = (Vec::with_capacity(n), Vec::with_capacity(n * n));
        for (a, &(i, unknown)) in unknowns.iter().enumerate() {
            let row = self.beside(i, unknown);
            c.push(row[0]);
            m.extend(inputs.iter().map(|[(j, s), (k, t)]| s * row[*j] + t * row[*k]));
            if unknown == Unknown::Slack {
                // The slip against the traction is one of two that differ.
                m[a * n + a + 1] += 1.0;
            }
        }
        Problem { unknowns, c, m }
    }

    fn read(&self, problem: &Problem, x: &[f64], basic: &[bool]) -> Solved {
        let n = self.states.len();
        let mut inputs = vec![0.0; 2 * n];
        let mut states = self.states.to_vec();
        let mut directions = self.directions.to_vec();
        for (a, &(i, unknown)) in problem.unknowns.iter().enumerate() {
            for (column, factor) in self.inputs(i, unknown) {
                if column > 0 {
                    inputs[column - 1] += factor * x[a];
                }
            }
            let pressed = |state| if state == State::Open { State::Closed } else { state };
            match unknown {
                Unknown::Normal if basic[a] != (self.states[i] == State::Open) => {
                    states[i] = State::Open;
                }
                Unknown::Normal => states[i] = pressed(states[i]),
                _ if states[i] == State::Open => {}
                Unknown::Forward | Unknown::Backward if basic[a] => {
                    states[i] = State::Slipping;
                    directions[i] = if unknown == Unknown::Forward { -1.0 } else { 1.0 };
                }
                Unknown::Slack => {
                    states[i] = if basic[a] { State::Closed } else { State::Slipping };
                }
                Unknown::Along if basic[a] => {
                    states[i] = State::Slipping;
                    directions[i] = -self.directions[i];
                }
                _ => {}
            }
        }
        let at =
            |row: &[f64]| row[0] + row[1..].iter().zip(&inputs).map(|(r, x)| r * x).sum::<f64>();
        let closed = |i: usize| states[i] != State::Open;
        let pressure = |i| if closed(i) { at(&self.pressure(i)).max(0.0) } else { 0.0 };
        let pressures: Vec<f64> = (0..n).map(pressure).collect();
        let traction = |i: usize| {
            let Some(mu) = self.friction[i].filter(|_| closed(i)) else { return 0.0 };
            match (states[i], self.states[i]) {
                (State::Slipping, _) => mu * directions[i] * pressures[i],
                (_, State::Closed) => at(self.tangent(i)),
                (_, State::Open) => inputs[2 * i + 1],
                (_, State::Slipping) => mu * self.directions[i] * pressures[i] + inputs[2 * i + 1],
            }
        };
        let tractions = (0..n).map(traction).collect();
        let states = states.iter().map(|&state| state as i8).collect();
        Solved { inputs, states, directions, pressures, tractions }
    }
}

impl Problem {
    /// Unknowns that are not zero in given states; what slips does so in the given directions.
    fn basis(&self, of: &Linearized, states: &[State]) -> Vec<bool> {
        let basic = |&(i, unknown): &(usize, Unknown)| match unknown {
            Unknown::Normal => (states[i] == State::Open) != (of.states[i] == State::Open),
            Unknown::Forward => states[i] == State::Slipping && of.directions[i] < 0.0,
            Unknown::Backward => states[i] == State::Slipping && of.directions[i] > 0.0,
            Unknown::Slack => states[i] == State::Closed,
            Unknown::Along => false,
        };
        self.unknowns.iter().map(basic).collect()
    }

    /// Solution by changes of the set of unknowns that are not zero; None where the
    /// conditions that break do not become fewer.
    fn by_sets(&self, of: &Linearized, start: &[bool]) -> Option<(Vec<f64>, Vec<bool>)> {
        let n = self.c.len();
        if !self.c.iter().chain(&self.m).all(|v| v.is_finite()) {
            return None;
        }
        let (mut basic, mut fewest, mut waited) = (start.to_vec(), n + 1, 0);
        while waited < PATIENCE {
            let x = self.solution(&basic)?;
            let rounding = TIE * largest(x.iter().copied());
            let mut wrong = vec![false; n];
            for (a, row) in self.m.chunks_exact(n.max(1)).enumerate() {
                wrong[a] = if basic[a] {
                    x[a] < -rounding
                } else {
                    let parts = || row.iter().zip(&x).map(|(m, x)| m * x);
                    let size = self.c[a].abs() + parts().map(f64::abs).sum::<f64>();
                    self.c[a] + parts().sum::<f64>() < -TIE * size
                };
            }
            let count = wrong.iter().filter(|&&wrong| wrong).count();
            if count == 0 {
                return Some((x.iter().map(|x| x.max(0.0)).collect(), basic));
            }
            waited = if count < fewest { 0 } else { waited + 1 };
            fewest = fewest.min(count);
            let mut pressed = None;
            for (a, &(i, unknown)) in self.unknowns.iter().enumerate() {
                // What closes sticks first, and has no tractions once it opens.
                let first = of.states[i] == State::Open && unknown == Unknown::Normal && wrong[a];
                if wrong[a] {
                    basic[a] = !basic[a];
                }
                if first {
                    pressed = Some((i, basic[a]));
                } else if let Some((_, on)) = pressed.filter(|&(of, _)| of == i) {
                    basic[a] = on && unknown == Unknown::Slack;
                }
            }
        }
        None
    }

    /// The unknowns with those of a set not zero; None if that is singular.
    fn solution(&self, basic: &[bool]) -> Option<Vec<f64>> {
        let n = self.c.len();
        let own: Vec<usize> = (0..n).filter(|&a| basic[a]).collect();
        let row = |&a: &usize| own.iter().map(|&b| self.m[a * n + b]).chain([-self.c[a]]).collect();
        let some = eliminate(own.iter().map(row).collect())?;
        let mut x = vec![0.0; n];
        own.iter().zip(some).for_each(|(&a, value)| x[a] = value);
        Some(x)
    }

    /// The basis in which what sticks slips the way it would without shear tractions.
    fn sliding(&self) -> Option<Vec<bool>> {
        let n = self.c.len();
        let sticks = |&a: &usize| self.unknowns[a].1 == Unknown::Forward;
        let own: Vec<usize> = (0..n).filter(sticks).collect();
        let shear = |a: usize, b: usize| 0.5 * (self.m[a * n + b] - self.m[(a + 1) * n + b]);
        // A body that nothing else holds moves with the resultant.
        let soft = TIE * largest(own.iter().map(|&a| shear(a, a)));
        let row = |&a: &usize| {
            let stiffness = own.iter().map(|&b| shear(a, b) + soft * f64::from(a == b));
            stiffness.chain([0.5 * (self.c[a + 1] - self.c[a])]).collect()
        };
        let slips = eliminate(own.iter().map(row).collect())?;
        let mut out = vec![false; n];
        for (&a, slip) in own.iter().zip(slips) {
            (out[a], out[a + 1]) = (slip > 0.0, slip < 0.0);
        }
        Some(out)
    }
}

/// Solution of linear equations, the right-hand side last in each row; None if they are singular.
///
/// Constraints act on their neighbors: rows without an entry in the column of a pivot stay.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let best = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        rows.swap(k, best);
        let (done, below) = rows.split_at_mut(k + 1);
        let pivot = &done[k];
        if pivot[k] == 0.0 || !pivot[k].is_finite() {
            return None;
        }
        for row in below.iter_mut().filter(|row| row[k] != 0.0) {
            let factor = row[k] / pivot[k];
            row[k..].iter_mut().zip(&pivot[k..]).for_each(|(v, p)| *v -= factor * p);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let rest: f64 = rows[k][k + 1..n].iter().zip(&x[k + 1..]).map(|(m, x)| m * x).sum();
        x[k] = (rows[k][n] - rest) / rows[k][k];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::{Linearized, Solved, State};

    /// Gaps and slips of a body in one point: of a stiffness, with a coupling.
    fn point(gap: f64, slip: f64, start: Option<State>) -> Solved {
        let (stiff, coupled) = (1.0, 0.2);
        let constraints = Linearized {
            states: &[State::Open],
            directions: &[1.0],
            friction: &[Some(0.5)],
            normal: &[gap, stiff, coupled],
            tangent: &[slip, coupled, stiff],
        };
        constraints.solve(start.as_ref().map(std::slice::from_ref), false).expect("a solution")
    }

    #[test]
    fn a_point_is_open_sticks_or_slips_from_every_state() {
        let starts = [None, Some(State::Open), Some(State::Closed), Some(State::Slipping)];
        for (gap, slip, state, direction) in [
            (0.1, 1.0, State::Open, 0.0),
            (-1.0, 0.1, State::Closed, 0.0),
            (-1.0, 2.0, State::Slipping, -1.0),
            (-1.0, -2.0, State::Slipping, 1.0),
        ] {
            for start in starts {
                let found = point(gap, slip, start);
                assert_eq!(found.states, [state as i8]);
                let (p, q) = (found.pressures[0], found.tractions[0]);
                let (gap, slip) = (gap + p + 0.2 * q, slip + 0.2 * p + q);
                assert!((p * gap).abs() < 1e-12 && gap > -1e-12 && p >= 0.0);
                match state {
                    State::Open => assert!(p == 0.0 && q == 0.0),
                    State::Closed => assert!(slip.abs() < 1e-12 && q.abs() < 0.5 * p),
                    State::Slipping => {
                        assert!((q - 0.5 * direction * p).abs() < 1e-12 && slip * direction < 0.0);
                        assert_eq!(found.directions, [direction]);
                    }
                }
            }
        }
    }

    #[test]
    fn what_sticks_in_the_linearized_solution_slips_or_opens() {
        // About the sticking state: pressure 1 + gap, traction q + slip.
        for (traction, pressure, state) in [
            (0.3, 1.0, State::Closed),
            (0.8, 1.0, State::Slipping),
            (-0.8, 1.0, State::Slipping),
            (0.3, -1.0, State::Open),
        ] {
            let constraints = Linearized {
                states: &[State::Closed],
                directions: &[1.0],
                friction: &[Some(0.5)],
                normal: &[pressure, 1.0, 0.0],
                tangent: &[traction, 0.0, 1.0],
            };
            let found = constraints.solve(None, true).expect("a solution");
            assert_eq!(found.states, [state as i8]);
            let expected = if state == State::Open { 0.0 } else { traction.clamp(-0.5, 0.5) };
            assert!((found.tractions[0] - expected).abs() < 1e-12);
            assert!((found.pressures[0] - pressure.max(0.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn without_a_solution_or_with_numbers_that_are_none_nothing_is_found() {
        for (gap, stiffness) in [(-1.0, -1.0), (f64::NAN, 1.0)] {
            let constraints = Linearized {
                states: &[State::Open],
                directions: &[1.0],
                friction: &[None],
                normal: &[gap, stiffness, 0.0],
                tangent: &[],
            };
            assert!(constraints.solve(None, true).is_none());
            assert!(constraints.solve(Some(&[State::Closed]), false).is_none());
        }
    }
}
