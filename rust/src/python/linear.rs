// SPDX-License-Identifier: BSD-3-Clause
//! Python classes of the sparse direct solvers.

use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::linear::{LinearError, LinearSolver, Pattern};

/// Translates an error of the solvers into the exception of `corota.errors`.
fn to_python(py: Python<'_>, error: LinearError) -> PyErr {
    let build = || -> PyResult<PyErr> {
        let errors = py.import("corota.errors")?;
        let text = error.to_string();
        let value = match &error {
            LinearError::Singular(s) => {
                let keywords = PyDict::new(py);
                keywords.set_item("equation", s.equation)?;
                if let Some(n) = s.modes.len().checked_div(s.nullity) {
                    keywords.set_item("mode", PyArray1::from_slice(py, &s.modes[..n]))?;
                }
                errors.getattr("SingularError")?.call((text,), Some(&keywords))?
            }
            LinearError::Inaccurate { .. } => errors.getattr("SingularError")?.call1((text,))?,
            LinearError::Memory(shortage) => return Ok(super::memory::to_python(py, shortage)),
            LinearError::NotFinite { .. }
            | LinearError::RhsNotFinite { .. }
            | LinearError::Pattern(_)
            | LinearError::Order(_) => errors.getattr("InputError")?.call1((text,))?,
        };
        Ok(PyErr::from_value(value))
    };
    build().unwrap_or_else(|e| e)
}

macro_rules! solver_class {
    ($(#[$doc:meta])* $name:ident, $inner:ty) => {
        $(#[$doc])*
        #[pyclass(module = "corota._core")]
        pub struct $name {
            inner: $inner,
        }

        #[pymethods]
        impl $name {
            #[new]
            fn new() -> Self {
                Self { inner: <$inner>::default() }
            }

            /// Threads to use, 0 for all the machine has; results do not depend on it.
            #[getter]
            fn threads(&self) -> usize {
                self.inner.threads()
            }

            #[setter]
            fn set_threads(&mut self, threads: usize) {
                self.inner.set_threads(threads);
            }

            /// Order and prepare for a pattern.
            ///
            /// Parameters
            /// ----------
            /// indptr : ndarray of uintp, shape (n + 1,)
            /// indices : ndarray of uint32, shape (nnz,)
            ///     Rows of each column, rising.
            /// node_of_dof : ndarray of uint32, shape (n,)
            /// after : ndarray of uint32, optional
            ///     Equations of multipliers.
            #[pyo3(signature = (indptr, indices, node_of_dof, after=None))]
            fn analyze(
                &mut self,
                py: Python<'_>,
                indptr: PyReadonlyArray1<'_, usize>,
                indices: PyReadonlyArray1<'_, u32>,
                node_of_dof: PyReadonlyArray1<'_, u32>,
                after: Option<PyReadonlyArray1<'_, u32>>,
            ) -> PyResult<()> {
                let pattern = Pattern {
                    col_ptr: indptr.as_slice()?,
                    row_idx: indices.as_slice()?,
                    node_of_dof: node_of_dof.as_slice()?,
                    after: match &after {
                        Some(a) => a.as_slice()?,
                        None => &[],
                    },
                };
                let inner = &mut self.inner;
                py.detach(|| inner.analyze(&pattern)).map_err(|e| to_python(py, e))
            }

            /// Factorize the values; returns (positive, negative, zero) pivots or None.
            fn factorize(
                &mut self,
                py: Python<'_>,
                data: PyReadonlyArray1<'_, f64>,
            ) -> PyResult<Option<(usize, usize, usize)>> {
                let values = data.as_slice()?;
                let inner = &mut self.inner;
                let inertia =
                    py.detach(|| inner.factorize(values)).map_err(|e| to_python(py, e))?;
                Ok(inertia.map(|i| (i.positive, i.negative, i.zero)))
            }

            /// Replace right-hand sides by solutions; columns stand one after the other.
            fn solve_in_place(
                &mut self,
                py: Python<'_>,
                mut rhs: PyReadwriteArrayDyn<'_, f64>,
            ) -> PyResult<()> {
                let mut array = rhs.as_array_mut();
                let Some(values) = array.as_slice_memory_order_mut() else {
                    let text = "right-hand sides must be contiguous".to_owned();
                    return Err(to_python(py, LinearError::Pattern(text)));
                };
                let inner = &mut self.inner;
                py.detach(|| inner.solve(values)).map_err(|e| to_python(py, e))
            }
        }
    };
}

solver_class!(
    /// Symmetric LDLᵀ of an upper triangle, with inertia and guards.
    Ldlt,
    crate::linear::Ldlt
);
solver_class!(
    /// Unsymmetric LU of a full matrix, with guards.
    Lu,
    crate::linear::Lu
);

/// Number of orders of elimination that this process has computed; the last ones are used again.
#[pyfunction]
fn computed_orders() -> usize {
    crate::linear::ordering::computed()
}

/// Sets the coordinates of the nodes of a solver, shape (n_nodes, 2), for the order of elimination.
#[pyfunction]
fn place_nodes(mut solver: PyRefMut<'_, Ldlt>, points: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
    let (points, _) = points.as_slice()?.as_chunks::<2>();
    solver.inner.set_points(points.to_vec());
    Ok(())
}

/// Values of the factor and multiplications of a factorization, of an analyzed pattern.
#[pyfunction]
fn factor_size(solver: PyRef<'_, Ldlt>) -> (usize, f64) {
    solver.inner.size()
}

/// Adds the classes of this file to the module.
pub fn register(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<Ldlt>()?;
    m.add_class::<Lu>()?;
    m.add_function(wrap_pyfunction!(computed_orders, m)?)?;
    m.add_function(wrap_pyfunction!(place_nodes, m)?)?;
    m.add_function(wrap_pyfunction!(factor_size, m)?)
}
