// SPDX-License-Identifier: BSD-3-Clause
//! The default solver: symmetric LDLᵀ behind guards.

use super::backsolve::Backsolve;
use super::error::{LinearError, Singular};
use super::lu::Lu;
use super::multifrontal::Numeric;
use super::nullspace;
use super::packing;
use super::pattern::Pattern;
use super::scaling::{
    BALANCED, apply_scale, balance, largest_at, max_abs, scale_of, subtract_product,
};
use super::symbolic::Symbolic;
use super::{Inertia, LinearSolver, check_rhs};
use crate::base::memory;
use crate::base::pool;
use crate::base::thread_autotuner::ThreadAutotuner;

/// Backward error above which one step of refinement is made.
const REFINE_ABOVE: f64 = 1e-14;
/// Backward error above which a solution is refused.
const REFUSE_ABOVE: f64 = 1e-9;
/// Growth `|K| |x| / |b|` above which no digit of the solution is left.
const GROWTH_LIMIT: f64 = 1e15;

/// Energy over squared length, relative to `|K|`, that is no more than rounding.
const SINGULAR: f64 = 4e-16;

/// Bytes that finding the order of elimination takes for each entry of the matrix (measured).
const ORDERING: usize = 24;

/// Multiplications from which a factorization may be, and from which it is always shared.
const SHARED_FACTOR: [f64; 2] = [3e7, 2e9];
/// Values of the factor from which a solve may be, and from which it is always shared.
const SHARED_SOLVE: [f64; 2] = [5e5, 1e7];

/// Guarded symmetric solver.
#[derive(Default)]
pub struct Ldlt {
    threads: usize,
    points: Vec<[f64; 2]>,
    col_ptr: Vec<usize>,
    row_idx: Vec<u32>,
    scale: Vec<f64>,
    values: Vec<f64>,
    norm: f64,
    symbolic: Symbolic,
    numeric: Numeric,
    ready: bool,
    work: Vec<f64>,
    permuted: Vec<f64>,
    factor_tuner: ThreadAutotuner,
    solve_tuner: ThreadAutotuner,
    /// Pivoting LU of the same matrix, made when a residual asks for it.
    fallback: Option<Box<Lu>>,
}

impl Ldlt {
    /// Sets the coordinates of the nodes, by the numbers that patterns give them. The order of
    /// elimination is found from them; without them from the edges, which takes longer.
    pub fn set_points(&mut self, points: Vec<[f64; 2]>) {
        self.points = points;
    }

    /// Values of the factor and multiplications of a factorization.
    pub fn size(&self) -> (usize, f64) {
        (self.symbolic.factor_len, self.symbolic.work)
    }

    fn back_substitute(&mut self, x: &mut [f64]) {
        let (size, threads) = (self.symbolic.factor_len as f64, self.threads);
        let Self { symbolic, numeric, permuted, solve_tuner, .. } = self;
        for (p, &d) in permuted.iter_mut().zip(&symbolic.order) {
            *p = x[d as usize];
        }
        team(solve_tuner, threads, size, SHARED_SOLVE, |threads| {
            pool::run(threads, |threads| Backsolve { symbolic, numeric, threads }.solve(permuted));
        });
        for (p, &d) in permuted.iter().zip(&symbolic.order) {
            x[d as usize] = *p;
        }
    }

    /// Judges a solution by its residual and size, with one step of refinement if needed.
    fn refine(&mut self, b: &[f64], x: &mut [f64]) -> Result<(), LinearError> {
        let norm_b = max_abs(b);
        let mut error = f64::NAN;
        for step in 0..2 {
            if let Some(equation) = x.iter().position(|v| !v.is_finite()) {
                return Err(singular(equation, 0.0));
            }
            self.work.copy_from_slice(b);
            subtract_product(&self.col_ptr, &self.row_idx, &self.values, x, &mut self.work);
            let size = self.norm * max_abs(x) + norm_b;
            error = if size > 0.0 { max_abs(&self.work) / size } else { 0.0 };
            if error <= REFINE_ABOVE || step == 1 {
                break;
            }
            let mut correction = std::mem::take(&mut self.work);
            self.back_substitute(&mut correction);
            for (x, c) in x.iter_mut().zip(&correction) {
                *x += c;
            }
            self.work = correction;
        }
        let growth = if norm_b > 0.0 { self.norm * max_abs(x) / norm_b } else { 0.0 };
        if growth > GROWTH_LIMIT {
            return Err(singular(largest_at(x), 1.0 / growth));
        }
        if error.is_nan() || error > REFUSE_ABOVE {
            return Err(LinearError::Inaccurate { backward_error: error, growth });
        }
        Ok(())
    }

    /// Solves the scaled system with a pivoting LU, made once per factorization.
    fn solve_by_lu(&mut self, b: &[f64], x: &mut [f64]) -> Result<(), LinearError> {
        if self.fallback.is_none() {
            let (col_ptr, row_idx, values) = full(&self.col_ptr, &self.row_idx, &self.values);
            let nodes: Vec<u32> = (0..b.len() as u32).collect();
            let pattern =
                Pattern { col_ptr: &col_ptr, row_idx: &row_idx, node_of_dof: &nodes, after: &[] };
            let mut lu = Box::<Lu>::default();
            lu.analyze(&pattern)?;
            lu.factorize(&values)?;
            self.fallback = Some(lu);
        }
        x.copy_from_slice(b);
        match &mut self.fallback {
            Some(lu) => lu.solve(x),
            None => Err(LinearError::Order("call factorize before solve")),
        }
    }

    /// Solution for one right-hand side by the pivoting LU alone.
    ///
    /// What `solve` turns to by itself when a residual stays large.
    pub fn solve_without_ldlt(&mut self, b: &[f64]) -> Result<Vec<f64>, LinearError> {
        if !self.ready {
            return Err(LinearError::Order("call factorize before solve"));
        }
        let scaled: Vec<f64> = b.iter().zip(&self.scale).map(|(b, s)| b * s).collect();
        let mut x = vec![0.0; b.len()];
        self.solve_by_lu(&scaled, &mut x)?;
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        Ok(x)
    }

    /// Number of pieces of the elimination tree that threads can take.
    pub fn pieces(&self) -> usize {
        let fronts = &self.symbolic.fronts;
        let above = |parent: u32| fronts.get(parent as usize).is_none_or(|p| p.top);
        fronts.iter().filter(|f| !f.top && above(f.parent)).count()
    }

    /// Refuses a matrix that lets a motion go at no cost beyond rounding.
    fn refuse_singular(&self) -> Result<(), LinearError> {
        let solve = Backsolve { symbolic: &self.symbolic, numeric: &self.numeric, threads: 1 };
        let motions = nullspace::motions(&solve, SINGULAR * self.norm);
        let Some(first) = motions.first() else { return Ok(()) };
        let n = self.scale.len();
        let pivot = first.stiffness;
        let mut modes = Vec::with_capacity(n * motions.len());
        for motion in &motions {
            let mut mode = vec![0.0; n];
            for (v, &d) in motion.vector.iter().zip(&self.symbolic.order) {
                mode[d as usize] = v * self.scale[d as usize];
            }
            let largest = max_abs(&mode);
            modes.extend(mode.iter().map(|v| v / largest));
        }
        let equation = largest_at(&modes[..n]);
        Err(LinearError::Singular(Singular { equation, pivot, nullity: motions.len(), modes }))
    }

    /// Counts the signs of the pivots.
    fn inertia(&self) -> Inertia {
        let mut inertia = Inertia::default();
        let mut count = |d: f64| {
            inertia.positive += usize::from(d > 0.0);
            inertia.negative += usize::from(d < 0.0);
        };
        let mut zero = 0;
        for (s, f) in self.symbolic.fronts.iter().enumerate() {
            let Some(special) = &self.numeric.special[s] else {
                self.numeric.d[f.first..f.first + f.width].iter().for_each(|&d| count(d));
                continue;
            };
            zero += special.null;
            let mut k = 0;
            while k < special.pivots {
                if special.e[k] == 0.0 {
                    count(special.d[k]);
                    k += 1;
                    continue;
                }
                // A 2x2 pivot: the signs follow from determinant and trace.
                let (a, b, c) = (special.d[k], special.e[k], special.d[k + 1]);
                if (a / b) * (c / b) < 1.0 {
                    count(1.0);
                    count(-1.0);
                } else {
                    count(a);
                    count(c);
                }
                k += 2;
            }
        }
        inertia.zero = zero;
        inertia
    }
}

impl LinearSolver for Ldlt {
    fn threads(&self) -> usize {
        self.threads
    }

    fn set_threads(&mut self, threads: usize) {
        self.threads = threads;
        (self.factor_tuner, self.solve_tuner) = Default::default();
    }

    fn analyze(&mut self, pattern: &Pattern<'_>) -> Result<(), LinearError> {
        self.ready = false;
        (self.factor_tuner, self.solve_tuner) = Default::default();
        pattern.check(true)?;
        // What an earlier pattern took goes first.
        (self.symbolic, self.numeric) = Default::default();
        let n = pattern.n();
        let job = || format!("the order of elimination of {n} equations");
        memory::require(ORDERING * pattern.row_idx.len() + 200 * n, job)?;
        let threads = if self.threads == 0 { pool::available() } else { self.threads };
        self.symbolic = Symbolic::new(pattern, &self.points, threads)?;
        if threads > 1 && self.symbolic.work > SHARED_FACTOR[0] {
            // Each thread sets addresses aside when it begins: that must show in what is free.
            pool::run(threads, |threads| match threads {
                1 => packing::reserve(),
                _ => rayon::broadcast(|_| packing::reserve()).into_iter().collect(),
            })?;
        }
        let values = self.symbolic.values(threads) + pattern.row_idx.len();
        memory::require(8 * values, || format!("the factorization of {n} equations"))?;
        self.numeric = Numeric::new(&self.symbolic);
        self.col_ptr = pattern.col_ptr.to_vec();
        self.row_idx = pattern.row_idx.to_vec();
        self.scale = vec![1.0; pattern.n()];
        self.work = vec![0.0; pattern.n()];
        self.permuted = vec![0.0; pattern.n()];
        self.values = vec![0.0; pattern.row_idx.len()];
        Ok(())
    }

    fn factorize(&mut self, values: &[f64]) -> Result<Option<Inertia>, LinearError> {
        if values.len() != self.values.len() {
            return Err(LinearError::Pattern(format!(
                "{} values for {} entries",
                values.len(),
                self.values.len()
            )));
        }
        self.ready = false;
        self.fallback = None;
        packing::reserve()?;
        scale_of(&self.col_ptr, &self.row_idx, values, &mut self.scale);
        let threads = self.threads;
        let Self {
            col_ptr, row_idx, scale, values: scaled, symbolic, numeric, factor_tuner, ..
        } = self;
        let size = team(factor_tuner, threads, symbolic.work, SHARED_FACTOR, |threads| {
            pool::run(threads, |threads| {
                let share = threads > 1;
                let mut size = apply_scale(col_ptr, row_idx, values, scale, scaled, share)?;
                if size.entry > BALANCED {
                    balance(col_ptr, row_idx, values, scale);
                    size = apply_scale(col_ptr, row_idx, values, scale, scaled, share)?;
                }
                numeric.factorize(symbolic, scaled, threads);
                Ok::<_, LinearError>(size)
            })
        })?;
        self.norm = size.norm;
        self.refuse_singular()?;
        self.ready = true;
        Ok(Some(self.inertia()))
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        if !self.ready {
            return Err(LinearError::Order("call factorize before solve"));
        }
        let n = self.scale.len();
        check_rhs(rhs, n)?;
        let mut b = vec![0.0; n];
        for x in rhs.chunks_exact_mut(n.max(1)) {
            if let Some(equation) = x.iter().position(|v| !v.is_finite()) {
                return Err(LinearError::RhsNotFinite { equation });
            }
            for i in 0..n {
                b[i] = x[i] * self.scale[i];
            }
            x.copy_from_slice(&b);
            self.back_substitute(x);
            match self.refine(&b, x) {
                Err(LinearError::Inaccurate { .. }) => self.solve_by_lu(&b, x)?,
                other => other?,
            }
            for i in 0..n {
                x[i] *= self.scale[i];
            }
        }
        Ok(())
    }
}

/// Does a job of some size with the threads it is worth: waking others costs more than a small
/// one takes, and between the limits the faster way is found out.
fn team<R>(
    tuner: &mut ThreadAutotuner,
    threads: usize,
    size: f64,
    [least, most]: [f64; 2],
    job: impl FnOnce(usize) -> R,
) -> R {
    let threads = if threads == 0 { pool::available() } else { threads };
    if threads == 1 || size <= least {
        job(1)
    } else if size > most {
        job(threads)
    } else {
        tuner.run(|shared| job(if shared { threads } else { 1 }))
    }
}

/// Both triangles of a symmetric matrix given by its upper one.
fn full(col_ptr: &[usize], row_idx: &[u32], values: &[f64]) -> (Vec<usize>, Vec<u32>, Vec<f64>) {
    let n = col_ptr.len() - 1;
    let mut at = vec![0_usize; n + 1];
    let each = |visit: &mut dyn FnMut(usize, usize, f64)| {
        for c in 0..n {
            for k in col_ptr[c]..col_ptr[c + 1] {
                visit(row_idx[k] as usize, c, values[k]);
            }
        }
    };
    each(&mut |r, c, _| {
        at[c + 1] += 1;
        if r != c {
            at[r + 1] += 1;
        }
    });
    for c in 0..n {
        at[c + 1] += at[c];
    }
    let mut next = at.clone();
    let mut entries = vec![(0_u32, 0.0); at[n]];
    each(&mut |r, c, v| {
        entries[next[c]] = (r as u32, v);
        next[c] += 1;
        if r != c {
            entries[next[r]] = (c as u32, v);
            next[r] += 1;
        }
    });
    for c in 0..n {
        entries[at[c]..at[c + 1]].sort_unstable_by_key(|e| e.0);
    }
    let (rows, values) = entries.into_iter().unzip();
    (at, rows, values)
}

fn singular(equation: usize, pivot: f64) -> LinearError {
    LinearError::Singular(Singular { equation, pivot, nullity: 0, modes: Vec::new() })
}
