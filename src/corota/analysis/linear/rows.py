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
    from corota.analysis.linear.types import Index
    from corota.analysis.parallel.communicator import Communicator
    from corota.arrays import Bools, Floats

    Ints = Index


class Rows:
    """The rows of this process.

    Parameters
    ----------
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
        indptr: Index,
        indices: Index,
        node: Index,
        triangle: bool,
        both: bool = False,
    ) -> None:
        self.communicator, self.n = communicator, len(indptr) - 1
        from scipy.sparse import csc_array

        n = self.n
        # Half the memory, and so half the time.
        kind = np.int32 if max(n, len(indices)) < np.iinfo(np.int32).max else np.int64
        row: Ints = np.asarray(indices, kind)
        starts = np.asarray(indptr, kind)
        column = np.repeat(np.arange(n, dtype=kind), starts[1:] - starts[:-1])
        loose = np.zeros(0, bool)
        self.order, bounds = np.arange(n), np.array([0, n])
        if communicator.size > 1:
            node = np.asarray(node, kind)
            between = csc_array(((node[row] != node[column]).astype(kind), row, starts), (n, n))
            one = np.ones(n, kind)
            degree = between @ one + between.T @ one
            loose = (degree == 0)[row]
            owner = self._owners(degree, node)
            self.order = np.concatenate(
                [np.flatnonzero(owner == process) for process in range(communicator.size)]
            )
            bounds = np.concatenate([[0], np.bincount(owner, minlength=communicator.size)]).cumsum()
            number = np.empty(n, kind)
            number[self.order] = np.arange(n)
            row, column = number[row], number[column]
        if triangle:
            row, column = np.minimum(row, column), np.maximum(row, column)
        self.first, self.last = (int(b) for b in bounds[communicator.rank :][:2])
        entry = None
        if triangle and both:
            off = np.flatnonzero(row != column)
            entry = np.concatenate([np.arange(len(row)), off])
            row, column = np.concatenate([row, column[off]]), np.concatenate([column, row[off]])
        if entry is not None and len(loose):
            loose = loose[entry]
        parts = self._lay_out(row, column, bounds, loose)
        self._sent = parts if entry is None else [entry[part] for part in parts]

    def _owners(self, degree: Ints, node: Ints) -> Ints:
        size, rank = self.communicator.size, self.communicator.rank
        count = np.bincount(node, degree).astype(np.int64)
        code = self.communicator.largest(count * size + (size - 1 - rank))
        return (size - 1 - code % size)[node]

    def _lay_out(self, row: Ints, column: Ints, bounds: Ints, loose: Bools) -> list[Any]:
        """Entries for each process; places of those of the other processes."""
        from scipy.sparse import coo_array

        n, rank, first = self.n, self.communicator.rank, self.first
        parts: list[Any] = [slice(None)]
        if self.communicator.size > 1:
            parts = [
                np.flatnonzero((row >= begin) & (row < end))
                for begin, end in zip(bounds[:-1], bounds[1:], strict=True)
            ]
        # Most unknowns belong to elements of other processes, and nothing is added to them. What is
        # not coupled to other nodes here comes last, and is sent only where it is not zero.
        self._coupled = [0] * len(parts)
        for p, part in enumerate(parts):
            if p != rank:
                last = loose[part]
                self._coupled[p] = len(last) - int(np.count_nonzero(last))
                parts[p] = part[np.argsort(last, kind="stable")]
        keys = [
            row[part].astype(np.int64) * n + column[part] if p != rank else np.zeros(0, np.int64)
            for p, part in enumerate(parts)
        ]
        received = self.communicator.exchange(keys)
        row, column = row[parts[rank]] - first, column[parts[rank]]
        # Own entries are distinct: sorting them by rows takes linear time.
        shape = self.last - first, n
        entry = np.arange(len(row), dtype=row.dtype)
        matrix = coo_array((entry, (row, column)), shape=shape).tocsr()
        matrix.sort_indices()
        rows = np.repeat(np.arange(first, self.last, dtype=row.dtype), np.diff(matrix.indptr))
        columns = matrix.indices
        # Every own row has its diagonal.
        missing = np.ones(shape[0], bool)
        missing[row[row + first == column]] = False
        diagonal = (first + np.flatnonzero(missing)) * (n + 1)
        place: Ints = entry
        self._received = received
        if len(diagonal) + sum(map(len, received)):
            # Few entries are not among the own ones: they are put between them.
            known = rows.astype(np.int64) * n + columns
            new = np.unique(
                np.concatenate([diagonal, *(_others(keys, known) for keys in received)])
            )
            before = np.searchsorted(known, new)
            moved = np.diff(before, prepend=0, append=len(known))
            place = place + np.repeat(np.arange(len(new) + 1), moved)
            rows = np.insert(rows, before, new // n)
            columns = np.insert(columns, before, new % n)
            known = np.insert(known, before, new)
            self._received = [np.searchsorted(known, keys) for keys in received]
        self._own = np.empty(len(row), np.int64)
        self._own[matrix.data] = place
        #: Row of each entry of the own rows.
        self.rows = rows
        self.indptr = np.concatenate([[0], np.bincount(rows - first, minlength=shape[0])]).cumsum()
        self.indices = columns
        return parts

    def values(self, data: Floats) -> Floats:
        """Entries of the own rows from the values of all processes for their patterns."""
        rank = self.communicator.rank
        out = np.zeros(len(self.indices))
        out[self._own] = data[self._sent[rank]]
        if self.communicator.size > 1:
            parts = [data[s] if p != rank else data[:0] for p, s in enumerate(self._sent)]
            parts = [
                part if part[count:].any() else part[:count]
                for part, count in zip(parts, self._coupled, strict=True)
            ]
            received = self.communicator.exchange(parts)
            for place, part in zip(self._received, received, strict=True):
                out[place[: len(part)]] += part
        return out

    def whole(self, own: Floats) -> Floats:
        """Vector of all rows from the own part of each process."""
        return self.communicator.concatenate(own)


def _others(keys: Ints, known: Ints) -> Ints:
    """Keys that are not among known ones, which are sorted."""
    place = np.searchsorted(known, keys)
    found = np.zeros(len(keys), bool)
    inside = place < len(known)
    found[inside] = known[place[inside]] == keys[inside]
    return keys[~found]
