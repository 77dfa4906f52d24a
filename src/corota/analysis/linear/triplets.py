"""Entries of sparse matrices in any order."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import scipy.sparse as sp

    from corota.analysis.linear.types import Index, Sparse
    from corota.arrays import Bools, Floats, Ints


#: Skew part of a matrix, relative to its largest entry, that is rounding.
SKEW = 1e-9


@dataclass
class Triplets:
    """Entries of a sparse matrix, those at one place to be added."""

    rows: Ints
    columns: Ints
    values: Floats

    @classmethod
    def join(cls, parts: list[Triplets]) -> Triplets:
        """All entries of several."""
        if not parts:
            return cls(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
        return cls(
            np.concatenate([p.rows for p in parts]),
            np.concatenate([p.columns for p in parts]),
            np.concatenate([p.values for p in parts]),
        )

    def add(self, more: Triplets) -> None:
        """Take more entries."""
        both = Triplets.join([self, more])
        self.rows, self.columns, self.values = both.rows, both.columns, both.values

    def keep(self, chosen: Bools) -> Triplets:
        """Some of the entries."""
        return Triplets(self.rows[chosen], self.columns[chosen], self.values[chosen])

    def matrix(self, n: int, m: int | None = None) -> Sparse:
        """Sum of the entries, scipy CSR of shape (n, m)."""
        import scipy.sparse as sp  # takes longer to import than a small job to solve

        shape = (n, n if m is None else m)
        return sp.coo_array((self.values, (self.rows, self.columns)), shape=shape).tocsr()

    @classmethod
    def of(cls, matrix: Sparse) -> Triplets:
        """Entries of a scipy sparse matrix."""
        found = matrix.tocoo()
        return cls(found.row.astype(np.int64), found.col.astype(np.int64), np.asarray(found.data))

    @classmethod
    def halves(cls, matrix: Sparse) -> tuple[Triplets, Triplets]:
        """Upper triangle of the symmetric part of a matrix, and the skew part if there is one."""
        import scipy.sparse as sp

        size = float(abs(matrix).max()) if matrix.nnz else 0.0
        even, odd = cls.of(sp.triu(0.5 * (matrix + matrix.T))), cls.of(0.5 * (matrix - matrix.T))
        return even, odd.keep(np.abs(odd.values) > SKEW * size)


def nonempty_columns(matrix: Sparse) -> Ints:
    """Columns of a scipy CSC matrix that have entries."""
    return np.flatnonzero(np.diff(matrix.indptr))


def arrays_of(matrix: Sparse | sp.coo_array[np.float64]) -> list[Index | Floats]:
    """The arrays of a scipy sparse matrix: positions, then values."""
    coo = matrix.format == "coo"
    names = ("row", "col", "data") if coo else ("indptr", "indices", "data")
    return [getattr(matrix, name) for name in names]
