"""Modified meshes; every function returns a new one."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.arrays import Bools, Floats, Ints, distinct
from corota.errors import InputError, number
from corota.mesh.data import Cells, Mesh
from corota.mesh.kinds import EDGES
from corota.renamed import accept_old_names

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


_SPLIT = {
    "right": {"quad4": ((0, 1, 2), (0, 2, 3)), "quad9": ((0, 1, 2, 4, 5, 8), (0, 2, 3, 8, 6, 7))},
    "left": {"quad4": ((0, 1, 3), (1, 2, 3)), "quad9": ((0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 6, 8))},
}
#: Triangle and side that replace each side of a quadrilateral.
_SIDES = {"right": ((0, 0), (0, 1), (1, 1), (1, 2)), "left": ((0, 0), (1, 0), (1, 1), (0, 2))}
_TRIANGLE = {"quad4": "tri3", "quad9": "tri6"}


def move(
    mesh: Mesh,
    shift: tuple[float, float] = (0.0, 0.0),
    angle: float = 0.0,
    scale: float = 1.0,
) -> Mesh:
    """Scale a mesh, then rotate it about the origin, then shift it.

    Parameters
    ----------
    mesh : Mesh
    shift : tuple of float
        [length]
    angle : float
        Counter-clockwise [degrees].
    scale : float
        Factor on lengths, > 0.

    Examples
    --------
    >>> from corota import mesh
    >>> turned = mesh.move(mesh.rectangle(2.0, 1.0, nx=2, ny=1), angle=37.0)
    """
    number(scale, "the scale", above=0.0)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    points = scale * mesh.points @ np.array([[c, s], [-s, c]]) + np.asarray(shift)
    return _copy(mesh, points)


def merge(*meshes: Mesh, tolerance: float | None = None) -> Mesh:
    """Join meshes and merge coincident nodes.

    Sets of the same name are united; node and cell numbers start again from 1. Edges along which
    two meshes are joined lie inside the body now: they leave the edge sets, and where a node set
    holds the nodes of the edge set of its name, as the sides of :func:`rectangle` do, the nodes of
    such edges are removed, too. Empty sets are removed; ``notes`` of the mesh list them.

    Parameters
    ----------
    *meshes : Mesh
    tolerance : float, optional
        Distance up to which nodes are merged [length]; 1e-9 of the largest extension if absent.

    Examples
    --------
    >>> from corota import mesh
    >>> a = mesh.rectangle(1.0, 1.0, nx=2, ny=2)
    >>> b = mesh.rectangle(1.0, 1.0, nx=2, ny=2, origin=(1.0, 0.0))
    >>> both = mesh.merge(a, b)
    >>> both.n_nodes
    15
    >>> both.points[both.nodes_of("right"), 0].tolist()  # the sides of b alone
    [2.0, 2.0, 2.0]
    """
    if not meshes:
        raise InputError("there is no mesh to merge")
    points = np.concatenate([m.points for m in meshes])
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    gap = 1e-9 * size if tolerance is None else tolerance
    new = _coincident(points, gap)
    firsts = np.flatnonzero(new == np.arange(len(points)))
    index = np.full(len(points), -1)
    index[firsts] = np.arange(len(firsts))
    index = index[new]
    kinds = list(dict.fromkeys(c.kind for m in meshes for c in m.cells))
    starts = np.concatenate([[0], np.cumsum([m.n_nodes for m in meshes])])
    blocks = {kind: [np.zeros((0, 0), np.int64)] * 0 for kind in kinds}
    moves: list[list[tuple[str, int]]] = []
    for mesh, start in zip(meshes, starts, strict=False):
        here = []
        for cells in mesh.cells:
            here.append((cells.kind, sum(map(len, blocks[cells.kind]))))
            blocks[cells.kind].append(index[cells.nodes + start])
        moves.append(here)
    first = dict(
        zip(
            kinds,
            np.concatenate([[0], np.cumsum([sum(map(len, blocks[k])) for k in kinds])]),
            strict=False,
        )
    )
    cells_out, label = [], 1
    for kind in kinds:
        nodes = np.concatenate(blocks[kind])
        cells_out.append(Cells(kind, nodes, np.arange(label, label + len(nodes))))
        label += len(nodes)
    joined = Mesh(points[firsts], cells_out)
    joined.notes = [note for mesh in meshes for note in mesh.notes]
    outer = {tuple(pair) for pair in joined.boundary_edges().tolist()}
    removed: dict[str, int] = {}
    for mesh, start, here in zip(meshes, starts, moves, strict=False):
        cell_index = np.concatenate(
            [np.zeros(0, np.int64)]
            + [
                np.arange(len(c), dtype=np.int64) + first[kind] + offset
                for c, (kind, offset) in zip(mesh.cells, here, strict=True)
            ]
        )
        own = {tuple(pair) for pair in mesh.boundary_edges().tolist()}
        for name, nodes in mesh.node_sets.items():
            kept = nodes
            if name in mesh.edge_sets:
                edges = mesh.edge_sets[name]
                if np.array_equal(mesh.edge_set_nodes(edges), distinct(nodes)):
                    left = edges[~_joints(edges, own, cell_index, outer)]
                    kept = nodes[np.isin(nodes, mesh.edge_set_nodes(left))]
            if len(kept) or not len(nodes):
                _unite(joined.node_sets, name, index[kept + start])
        for name, cells_of in mesh.cell_sets.items():
            _unite(joined.cell_sets, name, cell_index[cells_of])
        for name, edges in mesh.edge_sets.items():
            inside = _joints(edges, own, cell_index, outer)
            if inside.any():
                removed[name] = removed.get(name, 0) + int(inside.sum())
            left = edges[~inside]
            if len(edges) and not len(left):
                continue
            pairs = np.stack([cell_index[left[:, 0]], left[:, 1]], axis=1)
            old = joined.edge_sets.get(name, np.zeros((0, 2), np.int64))
            joined.edge_sets[name] = np.concatenate([old, pairs])
    for name, count in removed.items():
        gone = "" if name in joined.edge_sets else ", which is empty and gone"
        plural = "s lie" if count > 1 else " lies"
        joined.notes.append(
            f"{count} edge{plural} inside of the merged body and left the set {name!r}{gone}"
        )
    return joined


def _joints(
    edges: Ints, own: set[tuple[int, ...]], cell_index: Ints, outer: set[tuple[int, ...]]
) -> Bools:
    """Which edges were outer ones of their mesh and are inner ones of the joined mesh."""
    return np.array(
        [
            (cell, side) in own and (int(cell_index[cell]), side) not in outer
            for cell, side in edges.tolist()
        ],
        dtype=bool,
    )


def renumber(mesh: Mesh, seed: int = 0) -> Mesh:
    """Shuffle the numbers of nodes, and of cells within their kind.

    Parameters
    ----------
    mesh : Mesh
    seed : int, optional
        Of the random numbers.

    Returns
    -------
    Mesh
        With node and cell labels in the new order; sets follow.

    Examples
    --------
    >>> from corota import mesh
    >>> mixed = mesh.renumber(mesh.rectangle(2.0, 1.0, nx=2, ny=1), seed=3)
    """
    rng = np.random.default_rng(seed)
    order = rng.permutation(mesh.n_nodes)
    new = np.empty_like(order)
    new[order] = np.arange(mesh.n_nodes)
    cells, cell_new, start = [], [np.zeros(0, np.int64)], 0
    for block in mesh.cells:
        rows = rng.permutation(len(block))
        cells.append(Cells(block.kind, new[block.nodes[rows]], block.labels.copy()))
        place = np.empty_like(rows)
        place[rows] = np.arange(len(rows))
        cell_new.append(place + start)
        start += len(block)
    index = np.concatenate(cell_new)
    changed = Mesh(mesh.points[order], cells)
    changed.node_sets = {name: new[nodes] for name, nodes in mesh.node_sets.items()}
    changed.cell_sets = {name: index[rows] for name, rows in mesh.cell_sets.items()}
    changed.edge_sets = {
        name: np.stack([index[edges[:, 0]], edges[:, 1]], axis=1)
        for name, edges in mesh.edge_sets.items()
    }
    return changed


def to_triangles(mesh: Mesh, diagonal: Literal["right", "left"] = "right") -> Mesh:
    """Cut quadrilaterals (4 or 9 nodes) into triangles (3 or 6 nodes).

    Parameters
    ----------
    mesh : Mesh
    diagonal : {"right", "left"}
        From the first to the third corner, or from the second to the fourth.

    Examples
    --------
    >>> from corota import mesh
    >>> mesh.to_triangles(mesh.rectangle(1.0, 1.0, nx=2, ny=2)).n_cells
    8
    """
    if diagonal not in _SPLIT:
        raise InputError(f"unknown diagonal {diagonal!r}; known: right, left")
    cells, label, start = [], 1, 0
    firsts: list[Ints] = [np.zeros(0, np.int64)]
    split: list[Ints] = [np.zeros(0, bool)]
    for block in mesh.cells:
        if block.kind == "quad8":
            raise InputError("quad8 cells have no center node to cut through; use quad9")
        if block.kind in _TRIANGLE:
            parts = [block.nodes[:, list(t)] for t in _SPLIT[diagonal][block.kind]]
            nodes = np.stack(parts, axis=1).reshape(2 * len(block), -1)
            firsts.append(start + 2 * np.arange(len(block), dtype=np.int64))
        else:
            nodes = block.nodes.copy()
            firsts.append(start + np.arange(len(block), dtype=np.int64))
        split.append(np.full(len(block), block.kind in _TRIANGLE))
        kind = _TRIANGLE.get(block.kind, block.kind)
        cells.append(Cells(kind, nodes, np.arange(label, label + len(nodes))))
        label, start = label + len(nodes), start + len(nodes)
    first, cut = np.concatenate(firsts), np.concatenate(split)
    changed = Mesh(mesh.points.copy(), cells, mesh.node_labels.copy())
    changed.node_sets = {name: nodes.copy() for name, nodes in mesh.node_sets.items()}
    for name, rows in mesh.cell_sets.items():
        found = [first[rows], first[rows][cut[rows]] + 1]
        changed.cell_sets[name] = np.sort(np.concatenate(found))
    side_map = np.array(_SIDES[diagonal])
    for name, edges in mesh.edge_sets.items():
        pairs = edges.copy()
        pairs[:, 0] = first[edges[:, 0]]
        hit = cut[edges[:, 0]]
        pairs[hit, 0] += side_map[edges[hit, 1], 0]
        pairs[hit, 1] = side_map[edges[hit, 1], 1]
        changed.edge_sets[name] = pairs
    return changed


@accept_old_names(centre="center")
def to_quadratic(mesh: Mesh, center: bool = False) -> Mesh:
    """Add nodes in the middle of straight sides: tri3 to tri6, quad4 to quad8.

    A new node joins the node sets that hold both ends of its side; a set of nodes on the
    boundary takes those of boundary sides only.

    Parameters
    ----------
    mesh : Mesh
        Of tri3 and quad4 cells.
    center : bool, optional
        Whether quadrilaterals get a center node too (quad9).

    Examples
    --------
    >>> from corota import mesh
    >>> plate = mesh.to_quadratic(mesh.rectangle(1.0, 1.0, nx=2, ny=2), center=True)
    >>> plate.n_nodes, plate.cells[0].kind
    (25, 'quad9')
    """
    for block in mesh.cells:
        if block.kind not in ("tri3", "quad4"):
            raise InputError(f"{block.kind} cells cannot be made quadratic; expected tri3, quad4")
    sides = [
        np.sort(block.nodes[:, list(local)], axis=1)
        for block in mesh.cells
        for local in EDGES[block.kind]
    ]
    all_sides = np.concatenate([np.zeros((0, 2), np.int64), *sides])
    ends, inverse, counts = np.unique(all_sides, axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.reshape(-1)
    middle = mesh.n_nodes + inverse
    points = [mesh.points, mesh.points[ends].mean(axis=1)]
    total, at, cells = mesh.n_nodes + len(ends), 0, []
    centers: list[tuple[Ints, Ints]] = []
    for block in mesh.cells:
        parts = [block.nodes]
        for _ in EDGES[block.kind]:
            parts.append(middle[at : at + len(block), None])
            at += len(block)
        kind = "tri6" if block.kind == "tri3" else "quad8"
        if center and block.kind == "quad4":
            kind = "quad9"
            new = np.arange(total, total + len(block))
            centers.append((new, block.nodes))
            points.append(mesh.points[block.nodes].mean(axis=1))
            parts.append(new[:, None])
            total += len(block)
        cells.append(Cells(kind, np.concatenate(parts, axis=1), block.labels.copy()))
    labels = np.arange(1, total - mesh.n_nodes + 1) + int(mesh.node_labels.max(initial=0))
    changed = Mesh(np.concatenate(points), cells, np.concatenate([mesh.node_labels, labels]))
    outer = np.zeros(mesh.n_nodes, bool)
    outer[ends[counts == 1]] = True
    for name, nodes in mesh.node_sets.items():
        inside = np.zeros(mesh.n_nodes, bool)
        inside[nodes] = True
        whole = inside.all() or not outer[nodes].all()
        hit = inside[ends].all(axis=1) & (whole | (counts == 1))
        more = [mesh.n_nodes + np.flatnonzero(hit)]
        if whole:
            more += [new[inside[corners].all(axis=1)] for new, corners in centers]
        changed.node_sets[name] = np.concatenate([nodes, *more])
    changed.cell_sets = {name: rows.copy() for name, rows in mesh.cell_sets.items()}
    changed.edge_sets = {name: edges.copy() for name, edges in mesh.edge_sets.items()}
    return changed


def placed_middles(mesh: Mesh, points: Floats) -> Mesh:
    """Mesh with moved corners: inner side nodes and center nodes follow.

    Parameters
    ----------
    mesh : Mesh
    points : ndarray, shape (n_nodes, 2)
        New positions of the corners; other rows are replaced.
    """
    changed = _copy(mesh, points)
    outer = np.zeros(mesh.n_nodes, bool)
    outer[mesh.edge_set_nodes(mesh.boundary_edges())] = True
    for block in mesh.cells:
        for local in EDGES[block.kind]:
            if len(local) == 3:
                a, b, m = (block.nodes[:, i] for i in local)
                inner = ~outer[m]
                changed.points[m[inner]] = (points[a[inner]] + points[b[inner]]) / 2
    for block in mesh.cells:
        if block.kind == "quad9":
            n = changed.points[block.nodes[:, :8]]
            # Center of the serendipity map, so that the cell has no bubble.
            place = n[:, 4:].sum(axis=1) / 2 - n[:, :4].sum(axis=1) / 4
            changed.points[block.nodes[:, 8]] = place
    return changed


def _copy(mesh: Mesh, points: Floats) -> Mesh:
    return Mesh(
        np.array(points),
        [Cells(c.kind, c.nodes.copy(), c.labels.copy()) for c in mesh.cells],
        mesh.node_labels.copy(),
        {name: s.copy() for name, s in mesh.node_sets.items()},
        {name: s.copy() for name, s in mesh.cell_sets.items()},
        {name: s.copy() for name, s in mesh.edge_sets.items()},
    )


def _unite(table: dict[str, Ints], name: str, values: ArrayLike) -> None:
    together = np.concatenate([table.get(name, np.zeros(0, np.int64)), np.asarray(values)])
    _, first = np.unique(together, return_index=True)
    table[name] = together[np.sort(first)]


def _coincident(points: Floats, gap: float) -> Ints:
    """For each point the first one within ``gap``."""
    from scipy.spatial import cKDTree

    first = np.arange(len(points))
    if len(points) == 0:
        return first
    for a, b in sorted(cKDTree(points).query_pairs(gap)):
        first[b] = min(first[b], first[a])
    return first
