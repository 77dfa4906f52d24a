"""Sparse symmetric matrices: one pattern, and arrays of values.

Tangents, masses and dampings share the pattern of the elements. Their values are plain arrays of
shape (nnz,); the pattern provides all operations that depend on positions.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.linear.solvers import LinearSolver

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


class SymmetricPattern:
    """Pattern of a symmetric matrix: its upper triangle by columns.

    Parameters
    ----------
    indptr : ndarray of int, shape (n + 1,)
        Start of each column; the diagonal, which is always there, is its last entry.
    indices : ndarray of int, shape (nnz,)
        Row of each entry, increasing in each column.
    node : ndarray of int, shape (n,)
        Node of each equation; equations of one node are contiguous.
    after : ndarray of int, optional
        Equations of multipliers, to be eliminated after what they connect.
    """

    def __init__(
        self, indptr: NDArray[Any], indices: NDArray[Any], node: Ints, after: Ints | None = None
    ) -> None:
        self.indptr, self.indices, self.node, self.after = indptr, indices, node, after
        self.n, self.nnz = len(indptr) - 1, len(indices)
        self._constrained: NDArray[np.bool_] | None = None
        self._masked = np.zeros(0, np.int64)

    # -- places ------------------------------------------------------------------------

    @cached_property
    def diagonal(self) -> Ints:
        """Places of the diagonal, shape (n,)."""
        places: Ints = self.indptr[1:].astype(np.int64) - 1
        return places

    @cached_property
    def rows(self) -> Ints:
        """Row of each entry, shape (nnz,)."""
        return self.indices.astype(np.int64)

    @cached_property
    def columns(self) -> Ints:
        """Column of each entry, shape (nnz,)."""
        start: Ints = self.indptr.astype(np.int64)
        return np.repeat(np.arange(self.n, dtype=np.int64), start[1:] - start[:-1])

    @cached_property
    def keys(self) -> Ints:
        """Numbers that sort the entries by columns and rows, shape (nnz,)."""
        return self.columns * self.n + self.rows

    def places(self, rows: Ints, columns: Ints) -> tuple[Ints, NDArray[np.bool_]]:
        """Places of entries (row <= column), and whether the pattern has them."""
        wanted = np.asarray(columns, np.int64) * self.n + np.asarray(rows, np.int64)
        found = np.searchsorted(self.keys, wanted)
        return found, np.take(self.keys, found, mode="clip") == wanted

    # -- values ------------------------------------------------------------------------

    def zeros(self) -> Floats:
        """Values of a matrix of zeros."""
        return np.zeros(self.nnz)

    def largest_by_row(self, values: Floats) -> Floats:
        """Largest absolute entry of each row, shape (n,)."""
        found = np.zeros(self.n)
        np.maximum.at(found, self.rows, np.abs(values))
        np.maximum.at(found, self.columns, np.abs(values))
        return found

    def upper(self, values: Floats) -> Any:
        """The upper triangle, scipy CSC."""
        import scipy.sparse as sp

        entries = (values, self.indices.astype(np.int32), self.indptr.astype(np.int32))
        return sp.csc_array(entries, shape=(self.n, self.n))

    def full(self, values: Floats) -> Any:
        """The whole matrix, scipy sparse."""
        import scipy.sparse as sp

        upper = self.upper(values)
        return upper + sp.triu(upper, 1).T

    def multiply(self, values: Floats, x: Floats) -> Floats:
        """Product with a vector."""
        upper = self.upper(values)
        out: Floats = upper @ x + upper.T @ x - values[self.diagonal] * x
        return out

    def mask(self, values: Floats, constrained: NDArray[np.bool_]) -> None:
        """Replace rows and columns of constrained unknowns by a positive diagonal, in place."""
        if self._constrained is None or not np.array_equal(constrained, self._constrained):
            self._constrained = constrained.copy()
            off = (self.rows != self.columns) & (constrained[self.rows] | constrained[self.columns])
            self._masked = np.flatnonzero(off)
        values[self._masked] = 0.0
        diagonal = self.diagonal[constrained]
        size = np.abs(values[diagonal])
        values[diagonal] = np.where(size > 0.0, size, 1.0)

    def impose(
        self, values: Floats, rhs: Floats, moved: Floats, constrained: NDArray[np.bool_]
    ) -> None:
        """Move prescribed changes to the right-hand side and mask their equations, in place.

        Parameters
        ----------
        values : ndarray, shape (nnz,)
        rhs, moved : ndarray, shape (n,) or (n, k), columns one after the other
            Right-hand sides, and the prescribed changes, 0 elsewhere.
        constrained : ndarray of bool, shape (n,)
        """
        for column, move in zip(_columns(rhs), _columns(moved), strict=True):
            if np.any(move):
                column -= self.multiply(values, move)
        self.mask(values, constrained)
        rhs[constrained] = 0.0

    def analyze(self, solver: LinearSolver) -> None:
        """Let a linear solver order and prepare."""
        # Solvers get no multipliers where there are none.
        more = () if self.after is None else (self.after,)
        solver.analyze(self.indptr, self.indices, self.node, *more)


class AssembledPattern(SymmetricPattern):
    """The pattern of the elements, with products computed by the core.

    Parameters
    ----------
    core : corota._core.Problem
    """

    def __init__(self, core: Any) -> None:
        super().__init__(core.indptr, core.indices, core.node_of_dof.astype(np.int64))
        self._core = core

    def multiply(self, values: Floats, x: Floats) -> Floats:
        """Product with a vector."""
        out: Floats = self._core.multiply(values, x)
        return out

    def impose(
        self, values: Floats, rhs: Floats, moved: Floats, constrained: NDArray[np.bool_]
    ) -> None:
        """See :meth:`SymmetricPattern.impose`."""
        self._core.reduce(values, rhs, moved, constrained)

    def mask(self, values: Floats, constrained: NDArray[np.bool_]) -> None:
        """See :meth:`SymmetricPattern.mask`."""
        self._core.mask(values, constrained)


def _columns(x: Floats) -> list[Floats]:
    """Views of the columns of a vector or matrix."""
    return [x] if x.ndim == 1 else list(x.T)


__all__ = ["AssembledPattern", "SymmetricPattern"]
