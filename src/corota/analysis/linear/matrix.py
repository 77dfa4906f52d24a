"""Sparse symmetric matrices: one pattern, and arrays of values.

Tangents, masses and dampings share the pattern of the elements. Their values are plain arrays of
shape (nnz,); the pattern provides all operations that depend on positions.

On several processes each has a pattern and values of its own elements, and the matrix is their sum.
What all processes compute, such as point masses, is added by one of them.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.analysis.parallel.communicator import ALONE, Communicator

if TYPE_CHECKING:
    from corota._core import Problem
    from corota.analysis.linear.solvers import LinearSolver
    from corota.analysis.linear.types import Index, Sparse
    from corota.arrays import Bools, Floats, Ints


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
    communicator : Communicator, optional
        Processes whose values add up to the matrix.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"whole"})

    #: One process has the whole matrix.
    communicator: Communicator = ALONE

    def __init__(
        self,
        indptr: Index,
        indices: Index,
        node: Ints,
        after: Ints | None = None,
        communicator: Communicator = ALONE,
    ) -> None:
        if communicator is not ALONE:
            self.communicator = communicator
        self.indptr, self.indices, self.node, self.after = indptr, indices, node, after
        self.n, self.nnz = len(indptr) - 1, len(indices)
        self._constrained: Bools | None = None
        self._masked = np.zeros(0, np.int64)

    # -- places ------------------------------------------------------------------------

    @cached_property
    def diagonal(self) -> Ints:
        """Places of the diagonal, shape (n,)."""
        return self.indptr[1:].astype(np.int64) - 1

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

    def places(self, rows: Ints, columns: Ints) -> tuple[Ints, Bools]:
        """Places of entries (row <= column), and whether the pattern has them."""
        wanted = np.asarray(columns, np.int64) * self.n + np.asarray(rows, np.int64)
        found = np.searchsorted(self.keys, wanted)
        return found, np.take(self.keys, found, mode="clip") == wanted

    def owned_places(self, rows: Ints, columns: Ints) -> tuple[Ints, Bools, Bools]:
        """Places of entries (row <= column) that all processes want to add.

        Returns
        -------
        places : ndarray of int
        known : ndarray of bool
            Whether the pattern of any process has the entry.
        mine : ndarray of bool
            Whether this process adds it.
        """
        places, known = self.places(rows, columns)
        size, rank = self.communicator.size, self.communicator.rank
        if size == 1:
            return places, known, known
        code = self.communicator.largest(np.where(known, size - rank, 0))
        return places, code > 0, code == size - rank

    @cached_property
    def whole(self) -> SymmetricPattern:
        """The pattern of the sum, on every process."""
        if self.communicator.size == 1:
            return self
        keys = self.communicator.concatenate(self.keys)
        keys = np.unique(keys)
        counts = np.bincount(keys // self.n, minlength=self.n)
        start = np.concatenate([[0], np.cumsum(counts)])
        return SymmetricPattern(start, keys % self.n, self.node, self.after)

    # -- values ------------------------------------------------------------------------

    def gathered(self, values: Floats) -> Floats:
        """Values of the sum for the pattern :attr:`whole`, on every process."""
        if self.communicator.size == 1:
            return values
        out = self.whole.zeros()
        out[np.searchsorted(self.whole.keys, self.keys)] = values
        return self.communicator.sum(out)

    def diagonal_of(self, values: Floats) -> Floats:
        """The diagonal of the sum, shape (n,)."""
        return self.communicator.sum(values[self.diagonal])

    def add_diagonal(self, values: Floats, more: Floats) -> None:
        """Add to the diagonal, in place, what all processes have computed."""
        if self.communicator.first:
            values[self.diagonal] += more

    def zeros(self) -> Floats:
        """Values of a matrix of zeros."""
        return np.zeros(self.nnz)

    def largest_by_row(self, values: Floats) -> Floats:
        """Largest absolute entry of each row, shape (n,)."""
        found = np.zeros(self.n)
        np.maximum.at(found, self.rows, np.abs(values))
        np.maximum.at(found, self.columns, np.abs(values))
        return self.communicator.largest(found)

    def _upper(self, values: Floats) -> Sparse:
        import scipy.sparse as sp

        entries = (values, self.indices.astype(np.int32), self.indptr.astype(np.int32))
        return sp.csc_array(entries, shape=(self.n, self.n))

    def full(self, values: Floats) -> Sparse:
        """Both triangles of the sum, scipy sparse, on every process."""
        import scipy.sparse as sp

        upper = self.whole._upper(self.gathered(values))
        both: Sparse = upper + sp.triu(upper, 1).T
        return both

    def multiply(self, values: Floats, x: Floats) -> Floats:
        """Product with a vector."""
        upper = self._upper(values)
        out: Floats = upper @ x + upper.T @ x - values[self.diagonal] * x
        return self.communicator.sum(out)

    def mask(self, values: Floats, constrained: Bools) -> None:
        """Replace rows and columns of constrained unknowns by a positive diagonal, in place."""
        if self._constrained is None or not np.array_equal(constrained, self._constrained):
            self._constrained = constrained.copy()
            off = (self.rows != self.columns) & (constrained[self.rows] | constrained[self.columns])
            self._masked = np.flatnonzero(off)
        values[self._masked] = 0.0
        diagonal = self.diagonal[constrained]
        size = np.abs(values[diagonal])
        values[diagonal] = np.where(size > 0.0, size, 1.0)

    def impose(self, values: Floats, rhs: Floats, moved: Floats, constrained: Bools) -> None:
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
    """The pattern of the elements, with products computed by the core."""

    def __init__(self, core: Problem, communicator: Communicator = ALONE) -> None:
        node = core.node_of_dof.astype(np.int64)
        super().__init__(core.indptr, core.indices, node, communicator=communicator)
        self._core = core

    def multiply(self, values: Floats, x: Floats) -> Floats:
        out: Floats = self._core.multiply(values, x)
        return self.communicator.sum(out)

    def impose(self, values: Floats, rhs: Floats, moved: Floats, constrained: Bools) -> None:
        if self.communicator.size > 1:
            super().impose(values, rhs, moved, constrained)
            return
        self._core.reduce(values, rhs, moved, constrained)

    def mask(self, values: Floats, constrained: Bools) -> None:
        self._core.mask(values, constrained)


def _columns(x: Floats) -> list[Floats]:
    return [x] if x.ndim == 1 else list(x.T)
