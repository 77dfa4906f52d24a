// SPDX-License-Identifier: BSD-3-Clause
//! faer's own supernodal LDLᵀ with our ordering, one thread: the reference of the tests.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::error::LinearError;
use super::ordering::elimination_order;
use super::pattern::{NodeGraph, Pattern};
use super::{Inertia, LinearSolver};

/// Plain faer: no scaling, no guard.
#[derive(Default)]
pub struct FaerLdlt {
    col_ptr: Vec<u32>,
    row_idx: Vec<u32>,
    symbolic: Option<SymbolicCholesky<u32>>,
    factor: Vec<f64>,
    memory: Option<MemBuffer>,
}

const UNPREPARED: LinearError = LinearError::Order("call analyze and factorize first");

impl LinearSolver for FaerLdlt {
    fn analyze(&mut self, pattern: &Pattern<'_>) -> Result<(), LinearError> {
        pattern.check(true)?;
        let graph = NodeGraph::new(pattern)?;
        let n = pattern.n();
        let mut fwd = Vec::with_capacity(n);
        for v in elimination_order(&graph, &[], 1)? {
            fwd.extend(graph.first_dof[v as usize]..graph.first_dof[v as usize + 1]);
        }
        let mut inv = vec![0_u32; n];
        for (k, &d) in fwd.iter().enumerate() {
            inv[d as usize] = k as u32;
        }
        self.col_ptr = pattern.col_ptr.iter().map(|&p| p as u32).collect();
        self.row_idx = pattern.row_idx.to_vec();
        let a = SymbolicSparseColMatRef::new_checked(n, n, &self.col_ptr, None, &self.row_idx);
        let symbolic = factorize_symbolic_cholesky(
            a,
            Side::Upper,
            SymmetricOrdering::Custom(PermRef::new_checked(&fwd, &inv, n)),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|e| LinearError::Pattern(format!("{e:?}")))?;
        let scratch = symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        self.memory = Some(MemBuffer::new(scratch));
        self.factor = vec![0.0; symbolic.len_val()];
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn factorize(&mut self, values: &[f64]) -> Result<Option<Inertia>, LinearError> {
        let (Some(symbolic), Some(memory)) = (&self.symbolic, &mut self.memory) else {
            return Err(UNPREPARED);
        };
        let n = symbolic.nrows();
        let a = SymbolicSparseColMatRef::new_checked(n, n, &self.col_ptr, None, &self.row_idx);
        symbolic
            .factorize_numeric_ldlt(
                &mut self.factor,
                SparseColMatRef::new(a, values),
                Side::Upper,
                LdltRegularization::default(),
                Par::Seq,
                MemStack::new(memory),
                Spec::default(),
            )
            .map_err(|e| LinearError::Pattern(format!("{e:?}")))?;
        let mut inertia = Inertia::default();
        if let SymbolicCholeskyRaw::Supernodal(s) = symbolic.raw() {
            for k in 0..s.n_supernodes() {
                let width = (s.supernode_end()[k] - s.supernode_begin()[k]) as usize;
                let start = s.col_ptr_for_val()[k] as usize;
                let height = s.supernode(k).pattern().len() + width;
                for j in 0..width {
                    let d = self.factor[start + j * height + j];
                    inertia.positive += usize::from(d > 0.0);
                    inertia.negative += usize::from(d < 0.0);
                    inertia.zero += usize::from(d == 0.0);
                }
            }
        }
        Ok(Some(inertia))
    }

    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        let (Some(symbolic), Some(memory)) = (&self.symbolic, &mut self.memory) else {
            return Err(UNPREPARED);
        };
        let factor = LdltRef::new(symbolic, &self.factor);
        for x in rhs.chunks_exact_mut(symbolic.nrows().max(1)) {
            let n = x.len();
            factor.solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(x, n, 1),
                Par::Seq,
                MemStack::new(memory),
            );
        }
        Ok(())
    }
}
