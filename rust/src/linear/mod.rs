// SPDX-License-Identifier: BSD-3-Clause
//! Sparse direct solvers behind one interface.
//!
//! [`Ldlt`] is a multifrontal LDLᵀ of our own on faer's dense kernels. The graph of
//! the nodes is dissected once per pattern, by the coordinates of the nodes where they
//! are known, otherwise by its edges alone; the elimination tree that follows is cut into pieces that threads take as they come free, and the fronts
//! above them share their tiles. Every front adds its children in a fixed order and
//! works in tiles of fixed size, so one thread and many give the same bits.
//! Columns without an acceptable pivot wait for the parent front, so indefinite
//! matrices keep an exact inertia, and the columns left at a root count the
//! rank deficiency of the matrix.
//!
//! What was tried, Q4 plane stress, numeric refactorization on two cores of an AMD
//! EPYC with AVX-512 (this module: `python -m benchmarks linear_solver`):
//!
//! | seconds | 250 thousand dofs | 1 million |
//! | --- | --- | --- |
//! | faer's supernodal LDLᵀ, one thread, same ordering | 0.36 | 2.20 |
//! | this module, one thread | 0.29 | 1.95 |
//! | this module, two threads | 0.16 | 1.03 |
//!
//! faer's own threads had been slower than one, so trees of fronts were preferred
//! to subtrees of faer factors with a dense Schur complement: the fronts balance by
//! themselves and delay pivots. Copying children into the parent's square after the
//! update instead of clearing it first saves one pass over memory. Squares live on
//! two stacks, one for each parity of the depth, so that none is ever moved, and
//! all memory is kept for the next factorization: at a million equations the first
//! one takes twice as long for the pages alone. Substitution is bound by memory;
//! vector instructions made it 5 % faster, two threads 1.6 times. Threads are not
//! woken for small matrices.
//!
//! A single small pivot does not tell a free body from a slender one: see
//! [`nullspace`] for the measure that does. It gave at most 2e-16 on free bodies and
//! mechanisms of 12 to 250 thousand equations and 5e-14 on a cantilever of
//! slenderness 1000; the line is drawn at 4e-16 of the norm, near 2e-15.

pub mod backsolve;
pub mod delayed_pivots;
pub mod dense;
pub mod dissection;
pub mod error;
pub mod etree;
pub mod layout;
pub mod ldlt;
pub mod lu;
pub mod minimum_degree;
pub mod multifrontal;
pub mod nullspace;
pub mod ordering;
pub mod packing;
pub mod pattern;
pub mod scaling;
pub mod separator;
pub mod symbolic;

#[cfg(test)]
mod tests;

pub use error::{LinearError, Singular};
pub use ldlt::Ldlt;
pub use lu::Lu;
pub use pattern::Pattern;

/// Signs of the pivots: with symmetric matrices, those of the eigenvalues.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Inertia {
    pub positive: usize,
    pub negative: usize,
    pub zero: usize,
}

/// Three steps every direct solver has; values may change as long as the pattern stays.
pub trait LinearSolver: Send {
    /// Number of threads, 0 for all the machine has.
    fn threads(&self) -> usize {
        1
    }

    /// Sets the threads; a method that has none ignores it.
    fn set_threads(&mut self, _threads: usize) {}

    /// Orders and prepares for a pattern; done once.
    fn analyze(&mut self, pattern: &Pattern<'_>) -> Result<(), LinearError>;

    /// Factorizes the values, given in the order of the pattern.
    ///
    /// The inertia is `None` where the method does not tell it.
    fn factorize(&mut self, values: &[f64]) -> Result<Option<Inertia>, LinearError>;

    /// Replaces right-hand sides, one after the other in `rhs`, by the solutions.
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError>;
}

/// Refuses right-hand sides that are not whole columns of `n` values.
fn check_rhs(rhs: &[f64], n: usize) -> Result<(), LinearError> {
    if rhs.len().is_multiple_of(n) {
        return Ok(());
    }
    Err(LinearError::Pattern(format!("right-hand side of {} values for {n} equations", rhs.len())))
}
