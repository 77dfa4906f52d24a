"""Unsymmetric tangents: one pattern while loads stay, so that their LU is prepared once."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.solvers import Multifrontal
from corota.arrays import Bools, Floats, Ints, distinct

if TYPE_CHECKING:
    from corota.analysis.linear.matrix import SymmetricPattern
    from corota.analysis.linear.types import Index, Sparse


class FullMatrix:
    """Full matrices of a symmetric tangent and further, unsymmetric entries.

    Parameters
    ----------
    pattern : SymmetricPattern
        Of the tangent.
    """

    def __init__(self, pattern: SymmetricPattern) -> None:
        self.n = n = pattern.n
        rows, columns = pattern.rows, pattern.columns
        self._off = np.flatnonzero(rows != columns)
        self._upper = pattern.keys
        self._lower = rows[self._off] * n + columns[self._off]
        self._more = self._entries = np.zeros(0, np.int64)

    def _lay_out(self) -> None:
        n = self.n
        self._entries = distinct(np.concatenate([self._upper, self._lower, self._more]))
        self._places = [np.searchsorted(self._entries, k) for k in (self._upper, self._lower)]
        self.indptr = np.searchsorted(self._entries, n * np.arange(n + 1, dtype=np.int64))
        self.indices = self._entries % n

    def build(self, values: Floats, rows: Ints, columns: Ints, more: Floats) -> Sparse:
        """Add up entries `more` at (row, column) and a symmetric matrix; scipy CSC, sorted.

        Parameters
        ----------
        values : ndarray, shape (nnz,)
            Upper triangle.
        rows, columns : ndarray of int, shape (m,)
        more : ndarray, shape (m,)
        """
        import scipy.sparse as sp

        wanted = np.asarray(columns, np.int64) * self.n + np.asarray(rows, np.int64)
        found = np.searchsorted(self._entries, wanted)
        if not len(self._entries) or not np.array_equal(
            np.take(self._entries, found, mode="clip"), wanted
        ):
            # Entries are never removed: one may vanish in one state and return.
            self._more = np.union1d(self._more, wanted)
            self._lay_out()
            found = np.searchsorted(self._entries, wanted)
        upper, lower = self._places
        data = np.zeros(len(self._entries))
        data[upper] = values
        data[lower] = values[self._off]
        np.add.at(data, found, more)
        return sp.csc_array((data, self.indices, self.indptr), shape=(self.n, self.n))


class MaskedLu:
    """LU of unsymmetric matrices with prescribed dofs; ordered once per pattern."""

    def __init__(self) -> None:
        self._solver = Multifrontal(symmetric=False)
        self._indptr: Index = np.zeros(0, np.int64)
        self._indices: Index = self._indptr
        self._held = np.zeros(0, bool)

    def factorize(self, matrix: Sparse, constrained: Bools, node: Ints) -> None:
        """Factorize a scipy CSC matrix with diagonal rows and columns of prescribed dofs.

        Raises
        ------
        SingularError
            The matrix is singular to working precision.
        """
        import scipy.sparse as sp

        matrix.sort_indices()
        if not (diagonal_of(matrix) | ~constrained).all():
            matrix = (matrix + sp.diags_array(constrained.astype(float))).tocsc()
            matrix.sort_indices()
        rows, columns = entries_of(matrix)
        data = np.where(constrained[rows] | constrained[columns], 0.0, matrix.data)
        own = np.flatnonzero((rows == columns) & constrained[columns])
        size = np.abs(matrix.data[own])
        data[own] = np.where(size > 0.0, size, 1.0)
        old, new = (self._indptr, self._indices), (matrix.indptr, matrix.indices)
        same = all(map(np.array_equal, old, new))
        if not same or not np.array_equal(constrained, self._held):
            # Newly prescribed or released dofs are checked for free motions with the pattern.
            self._solver.analyze(matrix.indptr, matrix.indices, node)
            self._indptr, self._indices = matrix.indptr, matrix.indices
            self._held = constrained.copy()
        self._solver.factorize(data)

    def solve(self, rhs: Floats) -> Floats:
        """Solution for right-hand sides of shape (n,) or (n, k)."""
        return self._solver.solve(rhs)


def entries_of(matrix: Sparse) -> tuple[Index, Index]:
    """Rows and columns of the entries of a scipy CSC matrix."""
    counts = np.diff(matrix.indptr)
    return matrix.indices, np.repeat(np.arange(len(counts)), counts)


def diagonal_of(matrix: Sparse) -> Bools:
    """Which diagonal entries a scipy CSC matrix has a place for."""
    rows, columns = entries_of(matrix)
    has = np.zeros(matrix.shape[0], bool)
    has[rows[rows == columns]] = True
    return has
