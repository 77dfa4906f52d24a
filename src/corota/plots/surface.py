"""Cells as small triangles, edges as short lines, to draw curved shapes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.mesh import EDGES
from corota.mesh.shape_functions import edge_functions, shape_functions

if TYPE_CHECKING:
    from corota.arrays import Bools, Floats, Ints
    from corota.mesh import Mesh


def pattern(kind: str, parts: int) -> tuple[Floats, Ints]:
    """Natural points and triangles that divide a cell into ``parts`` along each side."""
    line = np.linspace(0.0, 1.0, parts + 1)
    if kind.startswith("tri"):
        points = [(line[i], line[j]) for j in range(parts + 1) for i in range(parts + 1 - j)]
        starts = np.cumsum([0] + [parts + 1 - j for j in range(parts + 1)])
        triangles = []
        for j in range(parts):
            for i in range(parts - j):
                low, high = int(starts[j]) + i, int(starts[j + 1]) + i
                triangles.append((low, low + 1, high))
                if i < parts - j - 1:
                    triangles.append((low + 1, high + 1, high))
        return np.array(points), np.array(triangles, dtype=np.int64)
    x, y = np.meshgrid(2 * line - 1, 2 * line - 1)
    corner = (np.arange(parts)[:, None] * (parts + 1) + np.arange(parts)).ravel()
    a, b, c, d = corner, corner + 1, corner + parts + 2, corner + parts + 1
    # Diagonals towards the middle keep the picture symmetric.
    column, row = np.meshgrid(np.arange(parts), np.arange(parts))
    half = (parts - 1) / 2.0
    along = ((column - half) * (row - half)).ravel() >= 0.0
    first = np.where(along[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(along[:, None], np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([x.ravel(), y.ravel()], axis=1), np.concatenate([first, second])


def parts_of(kind: str, n_cells: int) -> int:
    """Number of parts of a side: fewer in large meshes."""
    if kind == "tri3":
        return 1
    if n_cells > 40000:
        return 1
    if kind == "quad4":
        return 2
    return 2 if n_cells > 4000 else 4


@dataclass
class Surface:
    """Triangles of chosen cells, with the map from nodal to drawn values.

    Parameters
    ----------
    triangles : ndarray of int, shape (t, 3)
    owner : ndarray of int, shape (t,)
        Global cell of each triangle.
    """

    triangles: Ints
    owner: Ints
    _pieces: list[tuple[Ints, Floats]]

    def values(self, nodal: Floats) -> Floats:
        """Nodal values (n_nodes,) or (n_nodes, 2) at the drawn points."""
        parts = [np.einsum("mk,nk...->nm...", s, nodal[n]) for n, s in self._pieces]
        return np.concatenate([p.reshape(-1, *p.shape[2:]) for p in parts])


def surface(mesh: Mesh, chosen: Bools) -> Surface:
    """Divide the chosen cells (mask over all cells) into triangles."""
    triangles, owner, pieces, start = [], [], [], 0
    total = int(chosen.sum())
    for offset, cells in zip(mesh.offsets, mesh.cells, strict=False):
        mask = chosen[offset : offset + len(cells)]
        if not EDGES[cells.kind] or not mask.any():
            continue
        at, small = pattern(cells.kind, parts_of(cells.kind, total))
        nodes = cells.nodes[mask]
        pieces.append((nodes, shape_functions(cells.kind, at)))
        shift = start + len(at) * np.arange(len(nodes))
        triangles.append((small[None] + shift[:, None, None]).reshape(-1, 3))
        owner.append(np.repeat(np.flatnonzero(mask) + offset, len(small)))
        start += len(at) * len(nodes)
    if not triangles:
        return Surface(np.zeros((0, 3), np.int64), np.zeros(0, np.int64), [])
    return Surface(np.concatenate(triangles), np.concatenate(owner), pieces)


def _curves(nodes: list[Ints], positions: Floats, parts: int) -> list[Floats]:
    """Lines through edges given as arrays (n, 2) or (n, 3) of nodes: shape (n, m, 2) each."""
    lines = []
    for group in nodes:
        if group.shape[1] == 2:
            lines.append(positions[group])
            continue
        t = np.linspace(-1.0, 1.0, parts + 1)
        lines.append(np.einsum("mk,nkd->nmd", edge_functions(t)[0], positions[group]))
    return lines


def edge_lines(mesh: Mesh, positions: Floats) -> list[Floats]:
    """Lines of all cell edges, once each."""
    groups = [block.nodes[:, list(local)] for block in mesh.cells for local in EDGES[block.kind]]
    found = []
    for width in (2, 3):
        same = [g for g in groups if g.shape[1] == width]
        if not same:
            continue
        joined = np.concatenate(same)
        ends = np.sort(joined[:, :2], axis=1)
        _, first = np.unique(ends[:, 0] * np.int64(mesh.n_nodes) + ends[:, 1], return_index=True)
        found.append(joined[first])
    return [line for block in _curves(found, positions, 8) for line in block]


def outline(mesh: Mesh, positions: Floats) -> list[Floats]:
    """Lines of the edges that belong to one cell only."""
    groups: dict[int, list[Ints]] = {}
    for nodes in mesh.edge_nodes(mesh.boundary_edges()):
        groups.setdefault(len(nodes), []).append(nodes)
    stacked = [np.stack(g) for g in groups.values()]
    return [line for block in _curves(stacked, positions, 8) for line in block]
