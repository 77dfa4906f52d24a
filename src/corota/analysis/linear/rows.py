"""A sparse matrix by rows on several processes, from the entries that each process adds.

Every process has a pattern of its own and values for it; the matrix is the sum. A node belongs
to the process that adds most of its entries. Unknowns are numbered by process, and each
process owns the rows of its unknowns; entries of other rows are sent to their owner.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.parallel.communicator import Communicator

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


class Rows:
    """The rows of this process.

    Parameters
    ----------
    communicator : Communicator
    indptr : ndarray of int, shape (n + 1,)
        Start of each column of the pattern of this process.
    indices : ndarray of int, shape (nnz,)
        Row of each entry.
    node : ndarray of int, shape (n,)
        Node of each unknown; those of one node are contiguous.
    triangle : bool
        Whether the entries are those of the upper triangle of a symmetric matrix.
    both : bool
        Whether rows have both triangles then.

    Attributes
    ----------
    order : ndarray of int, shape (n,)
        Unknowns in the order of the rows.
    first, last : int
        First own row, and the one after the last.
    indptr, indices : ndarray of int
        Start of each own row, and columns in the order of the rows, increasing.
    """

    def __init__(
        self,
        communicator: Communicator,
        indptr: NDArray[Any],
        indices: NDArray[Any],
        node: NDArray[Any],
        triangle: bool,
        both: bool = False,
    ) -> None:
        self.communicator, self.n = communicator, len(indptr) - 1
        n = self.n
        starts: Ints = np.asarray(indptr, np.int64)
        column = np.repeat(np.arange(n), starts[1:] - starts[:-1])
        row = np.asarray(indices, np.int64)
        chosen: Ints | slice = slice(None)
        self.order, bounds = np.arange(n), np.array([0, n])
        if communicator.size > 1:
            degree = np.bincount(column[row != column], minlength=n)
            degree += np.bincount(row[row != column], minlength=n)
            owner = self._owners(degree, np.asarray(node, np.int64))
            self.order = np.argsort(owner, kind="stable")
            bounds = np.searchsorted(owner[self.order], np.arange(communicator.size + 1))
            number = np.empty(n, np.int64)
            number[self.order] = np.arange(n)
            # Most unknowns belong to elements of other processes: nothing is added to them.
            idle = (degree == 0) & (owner != communicator.rank) & (not communicator.first)
            chosen = np.flatnonzero(~idle[row])
            row, column = number[row[chosen]], number[column[chosen]]
        if triangle:
            row, column = np.minimum(row, column), np.maximum(row, column)
        self.first, self.last = (int(b) for b in bounds[communicator.rank :][:2])
        entry = np.arange(len(indices))[chosen]
        if triangle and both:
            off = row != column
            row, column = np.concatenate([row, column[off]]), np.concatenate([column, row[off]])
            entry = np.concatenate([entry, entry[off]])
        self._lay_out(row, column, entry, bounds)

    def _owners(self, degree: Ints, node: Ints) -> Ints:
        """Process that owns each unknown."""
        size, rank = self.communicator.size, self.communicator.rank
        count = np.bincount(node, degree).astype(np.int64)
        code = self.communicator.largest(count * size + (size - 1 - rank))
        owner: Ints = (size - 1 - code % size)[node]
        return owner

    def _lay_out(self, row: Ints, column: Ints, entry: Ints, bounds: Ints) -> None:
        from scipy.sparse import coo_array

        n, rank = self.n, self.communicator.rank
        parts: list[Ints | slice] = [slice(None)]
        if self.communicator.size > 1:
            parts = [
                np.flatnonzero((row >= begin) & (row < end))
                for begin, end in zip(bounds[:-1], bounds[1:], strict=True)
            ]
        self._sent = [entry[part] for part in parts]
        keys = [
            row[part] * n + column[part] if p != rank else np.zeros(0, np.int64)
            for p, part in enumerate(parts)
        ]
        received = self.communicator.exchange(keys)
        row, column = row[parts[rank]], column[parts[rank]]
        # Own entries are distinct: sorting them by rows takes linear time.
        count = self.last - self.first
        where = row - self.first, column
        matrix = coo_array((np.arange(len(row)), where), shape=(count, n)).tocsr()
        matrix.sort_indices()
        sorted_rows = np.repeat(np.arange(self.first, self.last), np.diff(matrix.indptr))
        sorted_keys = sorted_rows * n + matrix.indices
        # Every own row has its diagonal.
        missing = np.ones(count, bool)
        missing[row[row == column] - self.first] = False
        diagonal = (self.first + np.flatnonzero(missing)) * (n + 1)
        unique = sorted_keys
        if more := len(diagonal) + sum(map(len, received)):
            unique = np.concatenate([sorted_keys, np.unique(np.concatenate([diagonal, *received]))])
            unique.sort(kind="stable")  # which merges sorted parts
            unique = unique[np.concatenate([[True], unique[1:] != unique[:-1]])]
        self._own = np.empty(len(row), np.int64)
        self._own[matrix.data] = (
            np.searchsorted(unique, sorted_keys) if more else np.arange(len(row))
        )
        self._received = [np.searchsorted(unique, keys) for keys in received]
        #: Row of each entry of the own rows.
        self.rows = unique // n if more else sorted_rows
        self.indptr = np.searchsorted(self.rows, np.arange(self.first, self.last + 1))
        self.indices = unique % n if more else matrix.indices

    def values(self, data: Floats) -> Floats:
        """Entries of the own rows from the values of all processes for their patterns."""
        rank = self.communicator.rank
        out = np.zeros(len(self.indices))
        out[self._own] = data[self._sent[rank]]
        if self.communicator.size > 1:
            parts = [data[s] if p != rank else data[:0] for p, s in enumerate(self._sent)]
            received = self.communicator.exchange(parts)
            for place, part in zip(self._received, received, strict=True):
                out[place] += part
        return out

    def whole(self, own: Floats) -> Floats:
        """Vector of all rows from the own part of each process."""
        return self.communicator.concatenate(own)


__all__ = ["Rows"]
