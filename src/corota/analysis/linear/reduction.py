"""Positions of matrix entries after the elimination of dofs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.matrix import SymmetricPattern

if TYPE_CHECKING:
    from corota.analysis.linear.types import Sparse
    from corota.arrays import Floats, Ints

    #: Key, entry, two places of numbers, and factor of each product.
    Products = tuple[Ints, Ints, Ints, Ints, Floats]


@dataclass
class Rows:
    """Some rows of a matrix whose others are those of the identity.

    Parameters
    ----------
    dofs : ndarray of int, shape (m,)
        Which rows.
    matrix : scipy CSR array, shape (m, n)
    """

    dofs: Ints
    matrix: Sparse


class Layout:
    """The fixed pattern of rows whose values change.

    Row i of the full matrix has columns ``column[ptr[i]:ptr[i + 1]]`` and its numbers stand
    at ``at`` in the vector that :meth:`numbers` gives, whose entry 0 is one.
    """

    def __init__(self, n: int, rows: Rows, renumber: Ints) -> None:
        matrix = rows.matrix.tocsr()
        matrix.sort_indices()
        count = np.ones(n, np.int64)
        count[rows.dofs] = np.diff(matrix.indptr)
        self.n = n
        self.keys = self._keys(matrix)
        self.ptr = np.concatenate([[0], np.cumsum(count)])
        self.column = np.empty(self.ptr[-1], np.int64)
        self.at = np.zeros(self.ptr[-1], np.int64)
        plain = np.ones(n, bool)
        plain[rows.dofs] = False
        self.column[self.ptr[:-1][plain]] = np.flatnonzero(plain)
        inside = np.repeat(self.ptr[rows.dofs] - matrix.indptr[:-1], np.diff(matrix.indptr))
        inside = inside + np.arange(len(matrix.data))
        self.column[inside] = matrix.indices
        self.at[inside] = 1 + np.arange(len(matrix.data))
        self.column = renumber[self.column]

    def _keys(self, matrix: Sparse) -> Ints:
        row = np.repeat(np.arange(matrix.shape[0], dtype=np.int64), np.diff(matrix.indptr))
        return row * self.n + matrix.indices

    def numbers(self, matrix: Sparse) -> Floats:
        """Numbers of a matrix with this pattern or a part of it."""
        matrix = matrix.tocsr()
        matrix.sort_indices()
        out = np.zeros(1 + len(self.keys))
        out[0] = 1.0
        out[1 + np.searchsorted(self.keys, self._keys(matrix))] = matrix.data
        return out

    def expand(self, i: Ints, j: Ints) -> tuple[Ints, Ints, Ints, Ints, Ints]:
        """Products of the rows i and j: entry, columns of both, places of both numbers."""
        wide, tall = np.diff(self.ptr)[i], np.diff(self.ptr)[j]
        count = wide * tall
        entry = np.repeat(np.arange(len(i)), count)
        inner = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        a = self.ptr[i][entry] + inner // tall[entry]
        b = self.ptr[j][entry] + inner % tall[entry]
        return entry, self.column[a], self.column[b], self.at[a], self.at[b]


@dataclass
class Terms:
    """Products that add to the reduced matrix, sorted by target."""

    entry: Ints
    one: Ints
    two: Ints
    factor: Floats
    target: Ints  # places in the reduced values, one for each run
    first: Ints  # start of each run

    def add(self, out: Floats, values: Floats, numbers: Floats) -> None:
        """Add ``values * numbers * numbers`` to `out`."""
        if len(self.entry):
            terms = values[self.entry] * numbers[self.one] * numbers[self.two] * self.factor
            out[self.target] += np.add.reduceat(terms, self.first)


class Reduction:
    """The map from the full upper triangle to the reduced one.

    Parameters
    ----------
    whole : SymmetricPattern
        Of all dofs.
    free : ndarray of int
        Dofs that stay, sorted.
    turned : Rows
        Rows of ``Q G``, structure only.
    tied : Rows
        Rows of ``G``, structure only.
    pairs : list of tuple of ndarray
        Rows and columns of the entries of second derivatives.
    """

    def __init__(
        self,
        whole: SymmetricPattern,
        free: Ints,
        turned: Rows,
        tied: Rows,
        pairs: list[tuple[Ints, Ints]],
    ) -> None:
        n, m = whole.n, len(free)
        self.n, self.free = n, free
        renumber = np.full(n, -1, np.int64)
        renumber[free] = np.arange(m)
        self.renumber = renumber
        self.turned = Layout(n, turned, renumber)
        self.tied = Layout(n, tied, renumber)
        self.tied_dofs = tied.dofs
        special = renumber < 0
        special[turned.dofs] = True
        row, column = whole.rows, whole.columns
        changed = special[row] | special[column]
        self.plain = np.flatnonzero(~changed)
        keys = [renumber[column[self.plain]] * m + renumber[row[self.plain]]]
        some = np.flatnonzero(changed)
        raw = [self._products(self.turned, row[some], column[some], m)]
        i = np.concatenate([np.zeros(0, np.int64), *(p[0] for p in pairs)])
        j = np.concatenate([np.zeros(0, np.int64), *(p[1] for p in pairs)])
        self.geometric_pairs = (i, j)
        raw.append(self._products(self.tied, i, j, m))
        keys += [r[0] for r in raw]
        # Every unknown keeps its diagonal.
        keys.append(np.arange(m, dtype=np.int64) * (m + 1))
        unique = _union(keys[0], np.concatenate(keys[1:]))
        counts = np.bincount(unique // m, minlength=m)
        start = np.concatenate([[0], np.cumsum(counts)]).astype(np.uint64)
        #: Of the matrix of the dofs that stay.
        self.pattern = SymmetricPattern(
            start,
            (unique % m).astype(np.uint32),
            whole.node[free],
            communicator=whole.communicator,
        )
        self.plain_target = np.searchsorted(unique, keys[0])
        self.terms = self._terms(raw[0], unique, some)
        self.geometric_terms = self._terms(raw[1], unique, None)

    def _products(self, layout: Layout, i: Ints, j: Ints, m: int) -> Products:
        entry, a, b, one, two = layout.expand(i, j)
        diagonal = (i == j)[entry]
        keep = (a >= 0) & (b >= 0) & ~(diagonal & (a > b))
        entry, a, b, one, two = entry[keep], a[keep], b[keep], one[keep], two[keep]
        factor = np.where((a == b) & ~diagonal[keep], 2.0, 1.0)
        return np.maximum(a, b) * m + np.minimum(a, b), entry, one, two, factor

    def _terms(self, raw: Products, unique: Ints, chosen: Ints | None) -> Terms:
        key, entry, one, two, factor = raw
        order = np.argsort(key, kind="stable")
        key = key[order]
        first = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]])[: len(key)])
        entry = entry[order] if chosen is None else chosen[entry[order]]
        target = np.searchsorted(unique, key[first])
        return Terms(entry, one[order], two[order], factor[order], target, first)

    def reduce(
        self, values: Floats, turned: Rows, g: Sparse, geometric_stiffness: Floats
    ) -> Floats:
        """Values of the reduced upper triangle."""
        out = self.pattern.zeros()
        out[self.plain_target] = values[self.plain]
        self.terms.add(out, values, self.turned.numbers(turned.matrix))
        if self.pattern.communicator.first:
            self.geometric_terms.add(out, geometric_stiffness, self.tied.numbers(g))
        return out

    def whole(self, rows: Rows) -> Sparse:
        """All dofs by the unknowns, scipy CSC: the rows given, those of the identity elsewhere."""
        import scipy.sparse as sp

        one = np.ones(self.n)
        one[rows.dofs] = 0.0
        put = sp.csr_array(
            (np.ones(len(rows.dofs)), (rows.dofs, np.arange(len(rows.dofs)))),
            shape=(self.n, len(rows.dofs)),
        )
        found: Sparse = (sp.diags_array(one) + put @ rows.matrix).tocsc()[:, self.free]
        return found

    def reduce_full(
        self, matrix: Sparse, turned: Rows, g: Sparse, geometric_stiffness: Floats
    ) -> Sparse:
        """Reduce a full matrix, scipy CSC."""
        import scipy.sparse as sp

        t = self.whole(turned)
        out = t.T @ matrix @ t
        if len(geometric_stiffness):
            i, j = self.geometric_pairs
            half = sp.coo_array((geometric_stiffness, (i, j)), shape=(self.n, self.n)).tocsr()
            side = sp.coo_array(
                (np.where(i == j, 0.0, geometric_stiffness), (j, i)), shape=(self.n, self.n)
            ).tocsr()
            tied = self.whole(Rows(self.tied_dofs, g))
            out = out + tied.T @ (half + side) @ tied
        return out.tocsc()


def _union(much: Ints, more: Ints) -> Ints:
    """Sorted distinct numbers of a sorted array without repeats and a small one."""
    more = np.sort(more)
    more = more[np.concatenate([[True], more[1:] != more[:-1]])[: len(more)]]
    place = np.minimum(np.searchsorted(much, more), max(len(much) - 1, 0))
    if len(much):
        more = more[much[place] != more]
    both = np.concatenate([much, more])
    both.sort(kind="stable")
    return both
