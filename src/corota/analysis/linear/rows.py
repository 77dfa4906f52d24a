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
        self._lay_out(row * n + column, entry, bounds)

    def _owners(self, degree: Ints, node: Ints) -> Ints:
        """Process that owns each unknown."""
        size, rank = self.communicator.size, self.communicator.rank
        count = np.bincount(node, degree).astype(np.int64)
        code = self.communicator.largest(count * size + (size - 1 - rank))
        owner: Ints = (size - 1 - code % size)[node]
        return owner

    def _lay_out(self, keys: Ints, entry: Ints, bounds: Ints) -> None:
        n, rank = self.n, self.communicator.rank
        row = keys // n
        parts = [
            np.flatnonzero((row >= begin) & (row < end))
            for begin, end in zip(bounds[:-1], bounds[1:], strict=True)
        ]
        self._sent = [entry[part] for part in parts]
        own = keys[parts[rank]]
        parts = [keys[part] if p != rank else keys[:0] for p, part in enumerate(parts)]
        received = self.communicator.exchange(parts)
        # Every own row has its diagonal.
        every = np.arange(self.first, self.last, dtype=np.int64) * (n + 1)
        unique = np.unique(np.concatenate([own, every, *received]))
        self._own = np.searchsorted(unique, own)
        self._received = [np.searchsorted(unique, keys) for keys in received]
        rows = unique // n
        self.indptr = np.searchsorted(rows, np.arange(self.first, self.last + 1))
        self.indices = unique % n
        #: Row of each entry of the own rows.
        self.rows = rows

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
