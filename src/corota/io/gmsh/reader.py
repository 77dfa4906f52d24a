"""Meshes of Gmsh: MSH 2.2, 4.0 and 4.1, text and binary, physical groups as sets."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os

import numpy as np

import corota._core as _core
from corota.arrays import Floats, Ints, Lookup
from corota.errors import InputError
from corota.io.deck.lexer import READ
from corota.io.gmsh.parse import Parsed, Reader
from corota.io.regular_file import read_bytes, require_regular
from corota.mesh.data import Cells, Mesh
from corota.mesh.kinds import KINDS
from corota.mesh.plane import into_plane
from corota.mesh.quality import CLOCKWISE, FLAT, FOLDED, classify

#: Default names of physical groups, as Gmsh writes them into decks.
_UNNAMED = {0: "PhysicalPoint", 1: "PhysicalLine", 2: "PhysicalSurface"}


def read_gmsh(path: str | os.PathLike[str]) -> Mesh:
    """Read a ``.msh`` file.

    Surfaces give cells and cell sets; curves give edge sets and node sets, points node sets.
    Clockwise cells are reversed; nodes without a cell are dropped. ``Mesh.notes`` lists them.

    Raises
    ------
    InputError
        With file and line of the error.
    FileError
        If the file cannot be read.
    """
    require_regular(path)
    _core.require_memory(READ * os.path.getsize(path), f"reading {path}")
    parsed = Reader(str(path), read_bytes(path)).read()
    return _mesh(parsed, str(path))


def _mesh(parsed: Parsed, path: str) -> Mesh:
    index = Lookup(parsed.tags)
    blocks: dict[str, list[tuple[Ints, Ints, Ints]]] = {}
    lines: list[tuple[Ints, Ints]] = []
    spots: list[tuple[Ints, Ints]] = []
    for row_number, block in enumerate(parsed.blocks):
        nodes = index(block.nodes)
        if (nodes < 0).any():
            row = int(np.flatnonzero((nodes < 0).any(axis=1))[0])
            missing = block.nodes[row][nodes[row] < 0][0]
            raise InputError(f"{path}: element {block.tags[row]}: node {missing} is not defined")
        if block.kind == "point1":
            spots.append((nodes, np.full(len(nodes), row_number)))
        elif block.kind.startswith("line"):
            lines.append((nodes, np.full(len(nodes), row_number)))
        else:
            blocks.setdefault(block.kind, []).append(
                (nodes, block.tags, np.full(len(nodes), row_number))
            )
    if not blocks:
        raise InputError(
            f"{path}: the file has no triangles or quadrilaterals; "
            "mesh the surfaces (gmsh -2), and put them into a physical group"
        )
    used = np.zeros(len(parsed.tags), bool)
    for parts in blocks.values():
        for nodes, _, _ in parts:
            used[nodes] = True
    placed = into_plane(parsed.points, used)
    if placed is None:
        x, y, z = np.ptp(parsed.points[used], axis=0).tolist()
        raise InputError(
            f"{path}: the part lies in no plane normal to an axis: it extends over {x:g}, {y:g}, "
            f"{z:g}; the plane is z = 0"
        )
    points, notes = placed
    cells, groups = [], []
    for kind, parts in blocks.items():
        nodes, tags, numbers = (np.concatenate([p[i] for p in parts]) for i in range(3))
        nodes, first, back = _without_copies(nodes)
        nodes = _turned(kind, nodes, tags[first], points, path, notes)
        cells.append(Cells(kind, nodes, tags[first].astype(np.int64)))
        groups.append((back, numbers))
    mesh = Mesh(points, cells, parsed.tags, notes=notes)
    _cell_sets(mesh, parsed, groups)
    _line_sets(mesh, parsed, lines)
    for nodes, numbers in spots:
        for name in _names(parsed, int(numbers[0])):
            _add(mesh.node_sets, name, nodes.ravel())
            used[nodes] = True
    return _compact(mesh, used)


def _without_copies(nodes: Ints) -> tuple[Ints, Ints, Ints]:
    """Cells once each: MSH 2 repeats a cell for every group that holds it."""
    _, first, back = np.unique(nodes, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return nodes[first[order]], first[order], place[back.reshape(-1)]


def _turned(
    kind: str, nodes: Ints, tags: Ints, points: Floats, path: str, notes: list[str]
) -> Ints:
    shape = classify(kind, points[nodes])
    for code, text in (
        (FLAT, "has no area or a side of no length"),
        (FOLDED, "is folded or inverted"),
    ):
        bad = np.flatnonzero(shape == code)
        if len(bad):
            more = f" ({len(bad)} such elements in all)" if len(bad) > 1 else ""
            raise InputError(f"{path}: element {tags[bad[0]]} {text}{more}")
    turned = shape == CLOCKWISE
    if turned.any():
        nodes = nodes.copy()
        nodes[turned] = nodes[turned][:, KINDS[kind].reversal]
        notes.append(f"{int(turned.sum())} clockwise {kind} cells are turned")
    return nodes


def _names(parsed: Parsed, number: int) -> list[str]:
    """Names of the physical groups of a block."""
    block = parsed.blocks[number]
    return [
        parsed.names.get((block.dimension, group), f"{_UNNAMED[block.dimension]}{group}")
        for group in block.groups
    ]


def _cell_sets(mesh: Mesh, parsed: Parsed, groups: list[tuple[Ints, Ints]]) -> None:
    for offset, (rows, numbers) in zip(mesh.offsets, groups, strict=False):
        for number in np.unique(numbers):
            for name in _names(parsed, int(number)):
                _add(mesh.cell_sets, name, rows[numbers == number] + offset)


def _line_sets(mesh: Mesh, parsed: Parsed, lines: list[tuple[Ints, Ints]]) -> None:
    if not lines:
        return
    edges = mesh.edges_between(np.concatenate([nodes[:, :2] for nodes, _ in lines]))
    start, lost = 0, 0
    for nodes, number in lines:
        mine = edges[start : start + len(nodes)]
        start += len(nodes)
        on_cell = mine[:, 0] >= 0
        for name in _names(parsed, int(number[0])):
            lost += int((~on_cell).sum())
            _add(mesh.node_sets, name, nodes.ravel())
            old = mesh.edge_sets.get(name, np.zeros((0, 2), np.int64))
            mesh.edge_sets[name] = np.unique(np.concatenate([old, mine[on_cell]]), axis=0)
    if lost:
        mesh.notes.append(f"{lost} line elements of named curves lie on no cell and are ignored")


def _add(table: dict[str, Ints], name: str, values: Ints) -> None:
    together = np.concatenate([table.get(name, np.zeros(0, np.int64)), values])
    _, first = np.unique(together, return_index=True)
    table[name] = together[np.sort(first)]


def _compact(mesh: Mesh, used: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> Mesh:
    """Mesh without unused nodes."""
    if used.all():
        return mesh
    new = np.full(mesh.n_nodes, -1)
    new[used] = np.arange(int(used.sum()))
    cells = [Cells(c.kind, new[c.nodes], c.labels) for c in mesh.cells]
    notes = [*mesh.notes, f"{int((~used).sum())} nodes without a cell are ignored"]
    sets = {name: new[nodes][new[nodes] >= 0] for name, nodes in mesh.node_sets.items()}
    return Mesh(
        mesh.points[used],
        cells,
        mesh.node_labels[used],
        sets,
        mesh.cell_sets,
        mesh.edge_sets,
        notes,
    )
