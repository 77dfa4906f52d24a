"""Connected parts of cells and nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Bools, Ints, distinct

if TYPE_CHECKING:
    from corota.mesh.data import Mesh


def cells_of(mesh: Mesh, where: str | Ints) -> Ints:
    """Global cell indices of a set name (``all`` and the empty name: every cell) or array."""
    if not isinstance(where, str):
        return where
    if where in mesh.cell_sets:
        return mesh.cell_sets[where]
    if where in ("", "all"):
        return np.arange(mesh.n_cells)
    return np.zeros(0, np.int64)


def nodes_of(mesh: Mesh, where: str | Ints) -> Ints:
    """Node indices of a set name (the empty name: every node) or array."""
    if isinstance(where, str):
        return mesh.nodes_of(where) if where else np.arange(mesh.n_nodes)
    return np.asarray(where, np.int64)


def nodes_of_cells(mesh: Mesh, cells: Ints) -> Ints:
    """Nodes of cells, each once, in increasing order."""
    nodes, owner = _incidence(mesh)
    inside = np.zeros(mesh.n_cells, bool)
    inside[cells] = True
    return distinct(nodes[inside[owner]])


def part_of_cells(mesh: Mesh) -> Ints:
    """Number the parts connected by common nodes; shape (n_cells,)."""
    nodes, cells = _incidence(mesh)
    total = mesh.n_nodes + mesh.n_cells
    return components(nodes, cells + mesh.n_nodes, total)[mesh.n_nodes :]


def part_of_nodes(mesh: Mesh) -> Ints:
    """Number the parts connected by common nodes; shape (n_nodes,), -1 without cells."""
    nodes, cells = _incidence(mesh)
    part = components(nodes, cells + mesh.n_nodes, mesh.n_nodes + mesh.n_cells)
    out = np.full(mesh.n_nodes, -1, np.int64)
    out[nodes] = part[nodes]
    return out


def stiff_part_of_cells(mesh: Mesh) -> Ints:
    """Number the parts connected by common sides; shape (n_cells,)."""
    key, pairs = mesh.cell_edges()
    row = pairs[:, 0]
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(np.diff(key[order]) == 0)
    return components(row[order[same]], row[order[same + 1]], mesh.n_cells)


def parts_without(mesh: Mesh, without: Bools) -> Ints:
    """Number the parts connected by cells, except those of a mask; shape (n_nodes,)."""
    nodes, cells = _incidence(mesh)
    kept = ~without[cells]
    total = mesh.n_nodes + mesh.n_cells
    return components(nodes[kept], cells[kept] + mesh.n_nodes, total)[: mesh.n_nodes]


def _incidence(mesh: Mesh) -> tuple[Ints, Ints]:
    nodes, cells = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
        nodes.append(block.nodes.ravel())
        cells.append(np.repeat(np.arange(len(block)) + offset, block.nodes.shape[1]))
    return np.concatenate(nodes), np.concatenate(cells)


def components(a: Ints, b: Ints, total: int) -> Ints:
    """Number the parts connected by edges from `a` to `b`, in the order of their first members.

    Each pass joins the trees of connected members to the one with the smaller root, and then lets
    every member point to its root (Shiloach & Vishkin, *J. Algorithms* 3, 1982). SciPy's function
    takes as long, and importing it as long as the solution of a small model.
    """
    members = np.arange(total)
    root = members
    while not np.array_equal(one := root[a], other := root[b]):
        low = np.minimum(one, other)
        root = root.copy()
        np.minimum.at(root, one, low)
        np.minimum.at(root, other, low)
        while not np.array_equal(root, above := root[root]):
            root = above
    return (np.cumsum(root == members) - 1)[root]
