"""Rows of a matrix on several processes, without MPI: the processes are threads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.typing import NDArray

from corota.analysis.linear.rows import Rows
from corota.analysis.parallel.communicator import Communicator

#: Nodes of the test matrix, in a chain, and unknowns of each.
NODES, UNKNOWNS = 12, 2


class Thread(Communicator):
    """One of several threads that exchange by a common list."""

    def __init__(self, rank: int, size: int, table: list[Any], barrier: threading.Barrier) -> None:
        self.rank, self.size = rank, size  # type: ignore[misc]
        self._table, self._barrier = table, barrier

    def _all(self, value: Any) -> list[Any]:
        self._table[self.rank] = value
        self._barrier.wait()
        every = list(self._table)
        self._barrier.wait()
        return every

    def largest(self, values: NDArray[Any]) -> NDArray[Any]:
        return np.max(self._all(values), axis=0)

    def exchange(self, parts: Any) -> list[Any]:
        return [part[self.rank] for part in self._all(list(parts))]


def pattern(rank: int, size: int) -> sp.csc_array:
    """Blocks of all nodes, and couplings of the own part of the chain; upper triangle."""
    nodes = np.zeros((NODES, NODES))
    np.fill_diagonal(nodes, 1.0)
    first, last = rank * NODES // size, (rank + 1) * NODES // size
    for node in range(first, min(last, NODES - 1)):
        nodes[node, node + 1] = 1.0
    full = np.kron(nodes, np.ones((UNKNOWNS, UNKNOWNS)))
    return sp.csc_array(np.triu(full))


def results(
    size: int, triangle: bool, both: bool, elsewhere: bool
) -> tuple[list[Rows], list[Any], list[Any]]:
    """Rows, their values and the given matrices of all threads.

    With `elsewhere` values are also given for nodes of other threads.
    """
    table, barrier = [None] * size, threading.Barrier(size)
    node = np.repeat(np.arange(NODES), UNKNOWNS)

    def work(rank: int) -> tuple[Rows, Any, Any]:
        matrix = pattern(rank, size)
        rows = Rows(
            Thread(rank, size, table, barrier),
            matrix.indptr,
            matrix.indices,
            node,
            triangle,
            both,
        )
        data = np.random.default_rng(rank).uniform(1.0, 2.0, matrix.nnz)
        column = np.repeat(np.arange(len(node)), np.diff(matrix.indptr))
        coupled = np.zeros(NODES, bool)
        between = node[column] != node[matrix.indices]
        coupled[node[column[between]]] = coupled[node[matrix.indices[between]]] = True
        if not elsewhere:
            data[~coupled[node[column]]] = 0.0
        matrix.data[:] = data
        return rows, rows.values(data), matrix.toarray()

    with ThreadPoolExecutor(size) as pool:
        found = list(pool.map(work, range(size)))
    rows, values, given = zip(*found, strict=True)
    return list(rows), list(values), list(given)


@pytest.mark.parametrize("size", [1, 2, 3])
@pytest.mark.parametrize(("triangle", "both"), [(True, False), (True, True), (False, False)])
@pytest.mark.parametrize("elsewhere", [False, True])
def test_rows_are_those_of_the_sum(size: int, triangle: bool, both: bool, elsewhere: bool) -> None:
    rows, values, given = results(size, triangle, both, elsewhere)
    whole = np.sum(given, axis=0)
    if triangle:
        whole = np.triu(whole) + np.triu(whole, 1).T
    order = rows[0].order
    assert sorted(order) == list(range(NODES * UNKNOWNS))
    whole = whole[np.ix_(order, order)]
    if triangle and not both:
        whole = np.triu(whole)
    last = 0
    for own, data in zip(rows, values, strict=True):
        assert own.first == last
        last = own.last
        csr = sp.csr_array(
            (data, own.indices, own.indptr), shape=(own.last - own.first, NODES * UNKNOWNS)
        )
        assert csr.has_sorted_indices
        assert csr.has_canonical_format
        np.testing.assert_allclose(csr.toarray(), whole[own.first : own.last], rtol=1e-14)
        np.testing.assert_array_equal(
            own.rows, np.repeat(np.arange(own.first, last), np.diff(own.indptr))
        )
    assert last == NODES * UNKNOWNS


def test_an_unknown_without_entries_has_its_diagonal() -> None:
    empty = sp.csc_array((3, 3))
    rows = Rows(Communicator(), empty.indptr, empty.indices, np.arange(3), True)
    np.testing.assert_array_equal(rows.indices, [0, 1, 2])
    np.testing.assert_array_equal(rows.values(np.zeros(0)), np.zeros(3))
