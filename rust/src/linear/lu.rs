// SPDX-License-Identifier: BSD-3-Clause
//! Unsymmetric matrices: faer's sparse LU with partial pivoting, guarded.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::lu::{
    LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu,
};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Spec};

use super::error::{LinearError, Singular};
use super::packing;
use super::pattern::Pattern;
use super::scaling::{largest_at, max_abs};
use super::{Inertia, LinearSolver, check_rhs};
use crate::base::memory::Shortage;

/// Backward error above which one step of refinement is made.
const REFINE_ABOVE: f64 = 1e-14;
/// Backward error above which a solution is refused.
const REFUSE_ABOVE: f64 = 1e-9;
/// Growth `|A| |x| / |b|` above which no digit of the solution is left.
const GROWTH_LIMIT: f64 = 1e15;

/// Sparse LU of a full (both triangles) pattern.
#[derive(Default)]
pub struct Lu {
    col_ptr: Vec<u32>,
    row_idx: Vec<u32>,
    symbolic: Option<SymbolicLu<u32>>,
    numeric: NumericLu<u32, f64>,
    memory: Option<MemBuffer>,
    row_scale: Vec<f64>,
    col_scale: Vec<f64>,
    values: Vec<f64>,
    norm: f64,
    ready: bool,
}

impl Lu {
    /// Scales rows and then columns by powers of two so that the largest entry is near one.
    fn equilibrate(&mut self, values: &[f64]) -> Result<(), LinearError> {
        let n = self.row_scale.len();
        let pow2 = |a: f64| if a > 0.0 { 2.0_f64.powi(-(a.log2().round() as i32)) } else { 1.0 };
        let mut rows = vec![0.0_f64; n];
        for c in 0..n {
            for k in self.col_ptr[c] as usize..self.col_ptr[c + 1] as usize {
                let r = self.row_idx[k] as usize;
                if !values[k].is_finite() {
                    return Err(LinearError::NotFinite { row: r, column: c });
                }
                rows[r] = rows[r].max(values[k].abs());
            }
        }
        for r in 0..n {
            self.row_scale[r] = pow2(rows[r]);
        }
        rows.fill(0.0);
        self.values.resize(values.len(), 0.0);
        for c in 0..n {
            let range = self.col_ptr[c] as usize..self.col_ptr[c + 1] as usize;
            let mut largest = 0.0_f64;
            for k in range.clone() {
                let r = self.row_idx[k] as usize;
                self.values[k] = values[k] * self.row_scale[r];
                largest = largest.max(self.values[k].abs());
            }
            self.col_scale[c] = pow2(largest);
            for k in range {
                self.values[k] *= self.col_scale[c];
                rows[self.row_idx[k] as usize] += self.values[k].abs();
            }
        }
        self.norm = max_abs(&rows);
        Ok(())
    }

    fn residual(&self, b: &[f64], x: &[f64], r: &mut [f64]) {
        r.copy_from_slice(b);
        for c in 0..x.len() {
            for k in self.col_ptr[c] as usize..self.col_ptr[c + 1] as usize {
                r[self.row_idx[k] as usize] -= self.values[k] * x[c];
            }
        }
    }

    fn back_substitute(&mut self, x: &mut [f64]) {
        if let (Some(symbolic), Some(memory)) = (&self.symbolic, &mut self.memory) {
            let n = x.len();
            let lu = LuRef::new_unchecked(symbolic, &self.numeric);
            lu.solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(x, n, 1),
                Par::Seq,
                MemStack::new(memory),
            );
        }
    }
}

impl LinearSolver for Lu {
    fn analyze(&mut self, pattern: &Pattern<'_>) -> Result<(), LinearError> {
        pattern.check(false)?;
        let n = pattern.n();
        self.ready = false;
        self.col_ptr = pattern.col_ptr.iter().map(|&p| p as u32).collect();
        self.row_idx = pattern.row_idx.to_vec();
        self.row_scale = vec![1.0; n];
        self.col_scale = vec![1.0; n];
        let a = SymbolicSparseColMatRef::new_checked(n, n, &self.col_ptr, None, &self.row_idx);
        let symbolic =
            factorize_symbolic_lu(a, LuSymbolicParams::default()).map_err(|e| refused(e, n))?;
        let scratch = symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let memory = MemBuffer::try_new(scratch).map_err(|_| refused(FaerError::OutOfMemory, n))?;
        self.memory = Some(memory);
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn factorize(&mut self, values: &[f64]) -> Result<Option<Inertia>, LinearError> {
        if self.symbolic.is_none() {
            return Err(LinearError::Order("call analyze before factorize"));
        }
        if values.len() != self.row_idx.len() {
            return Err(LinearError::Pattern(format!(
                "{} values for {} entries",
                values.len(),
                self.row_idx.len()
            )));
        }
        self.ready = false;
        packing::reserve()?;
        self.equilibrate(values)?;
        let (Some(symbolic), Some(memory)) = (&self.symbolic, &mut self.memory) else {
            return Err(LinearError::Order("call analyze before factorize"));
        };
        let n = symbolic.nrows();
        let a = SymbolicSparseColMatRef::new_checked(n, n, &self.col_ptr, None, &self.row_idx);
        let done = symbolic.factorize_numeric_lu(
            &mut self.numeric,
            SparseColMatRef::new(a, &self.values),
            Par::Seq,
            MemStack::new(memory),
            Spec::default(),
        );
        if let Err(e) = done {
            use faer::sparse::linalg::LuError;
            let equation = match e {
                LuError::SymbolicSingular { index } => index,
                LuError::Generic(e) => return Err(refused(e, n)),
            };
            return Err(LinearError::Singular(Singular {
                equation,
                pivot: 0.0,
                nullity: 0,
                modes: Vec::new(),
            }));
        }
        self.ready = true;
        Ok(None)
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        if !self.ready {
            return Err(LinearError::Order("call factorize before solve"));
        }
        let n = self.row_scale.len();
        check_rhs(rhs, n)?;
        let (mut b, mut r) = (vec![0.0; n], vec![0.0; n]);
        for x in rhs.chunks_exact_mut(n.max(1)) {
            for i in 0..n {
                b[i] = x[i] * self.row_scale[i];
            }
            if let Some(equation) = x.iter().position(|v| !v.is_finite()) {
                return Err(LinearError::RhsNotFinite { equation });
            }
            x.copy_from_slice(&b);
            self.back_substitute(x);
            let norm_b = max_abs(&b);
            let mut error = f64::NAN;
            for step in 0..2 {
                if let Some(equation) = x.iter().position(|v| !v.is_finite()) {
                    return Err(singular(equation, 0.0));
                }
                self.residual(&b, x, &mut r);
                let size = self.norm * max_abs(x) + norm_b;
                error = if size > 0.0 { max_abs(&r) / size } else { 0.0 };
                if error <= REFINE_ABOVE || step == 1 {
                    break;
                }
                self.back_substitute(&mut r);
                for i in 0..n {
                    x[i] += r[i];
                }
            }
            let growth = if norm_b > 0.0 { self.norm * max_abs(x) / norm_b } else { 0.0 };
            if growth > GROWTH_LIMIT {
                return Err(singular(largest_at(x), 1.0 / growth));
            }
            if error.is_nan() || error > REFUSE_ABOVE {
                return Err(LinearError::Inaccurate { backward_error: error, growth });
            }
            for i in 0..n {
                x[i] *= self.col_scale[i];
            }
        }
        Ok(())
    }
}

/// What the library refuses, in our words.
fn refused(error: FaerError, n: usize) -> LinearError {
    match error {
        FaerError::IndexOverflow => {
            LinearError::Pattern(format!("LU of {n} equations has too many entries"))
        }
        _ => Shortage::met(format!("the LU of {n} equations")).into(),
    }
}

fn singular(equation: usize, pivot: f64) -> LinearError {
    LinearError::Singular(Singular { equation, pivot, nullity: 0, modes: Vec::new() })
}
