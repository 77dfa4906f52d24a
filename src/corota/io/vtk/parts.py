"""A grid cut into parts, one for each process of a run, and put together again.

Parts of a VTKHDF unstructured grid follow each other in its arrays. Each numbers its own points
from 0, so that points on a border are there once for each part that they belong to. Rigid curves
are no cells of the mesh: they follow the last part.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise

import numpy as np

from corota.arrays import Ints, distinct


class Parts:
    """Rows of a grid by parts.

    Parameters
    ----------
    chain, ends : ndarray of int
        Connectivity of the cells, and offsets: one more than cells.
    part : ndarray of int, shape (n_cells,)
        Part of each cell.
    n_nodes : int
        Nodes without a cell belong to the first part.

    Attributes
    ----------
    cells : ndarray of int, shape (n_cells,)
        Cell of each row.
    nodes : ndarray of int
        Node of each row.
    chain, ends : ndarray of int
        Connectivity by the numbers of the points in their part; offsets from 0 in each part, one
        more than it has cells.
    sizes : ndarray of int, shape (n_parts, 3)
        Points, cells and entries of the connectivity of each part.
    """

    def __init__(self, chain: Ints, ends: Ints, part: Ints, n_nodes: int) -> None:
        self.cells = np.argsort(part, kind="stable")
        bounds = np.searchsorted(part[self.cells], np.arange(int(part.max(initial=0)) + 2))
        counts = np.diff(ends)[self.cells]
        new = np.concatenate([[0], np.cumsum(counts)])
        places = np.repeat(ends[:-1][self.cells] - new[:-1], counts) + np.arange(new[-1])
        moved = chain[places]
        lone = np.ones(n_nodes, dtype=bool)
        lone[chain] = False
        chains: list[Ints] = []
        offsets: list[Ints] = []
        nodes: list[Ints] = []
        sizes: list[list[int]] = []
        for first, end in pairwise(bounds.tolist()):
            own = moved[new[first] : new[end]]
            here = distinct(own if chains else np.concatenate([own, np.flatnonzero(lone)]))
            chains.append(np.searchsorted(here, own))
            offsets.append(new[first : end + 1] - new[first])
            nodes.append(here)
            sizes.append([len(here), end - first, len(own)])
        self.chain, self.ends = np.concatenate(chains), np.concatenate(offsets)
        self.nodes, self.sizes = np.concatenate(nodes), np.array(sizes)


def whole(chain: Ints, ends: Ints, sizes: Ints, nodes: Ints, cells: Ints) -> tuple[Ints, Ints]:
    """Connectivity and offsets of all cells from those of parts: the reverse of `Parts`.

    Parameters
    ----------
    chain, ends, sizes
        As `Parts` has them.
    nodes, cells : ndarray of int
        Node and cell of each row; rows behind those of cells are rigid curves.
    """
    points, last = np.cumsum(sizes[:, 0]), np.cumsum(sizes[:, 1] + 1)
    counts = np.delete(np.diff(ends), last[:-1] - 1)[: len(cells)]
    shift = np.repeat(points - sizes[:, 0], sizes[:, 2])[: counts.sum()]
    by_node = nodes[chain[: counts.sum()] + shift]
    old = np.concatenate([[0], np.cumsum(counts)])
    order = np.argsort(cells)
    new = np.concatenate([[0], np.cumsum(counts[order])])
    places = np.repeat(old[:-1][order] - new[:-1], counts[order]) + np.arange(new[-1])
    return by_node[places], new
