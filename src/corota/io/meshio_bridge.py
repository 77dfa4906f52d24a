"""Meshes of other formats, through meshio."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import FileError, InputError, UnsupportedError
from corota.mesh.data import Cells, Mesh
from corota.mesh.kinds import KINDS, PLANAR
from corota.mesh.plane import into_plane
from corota.mesh.quality import CLOCKWISE, FLAT, FOLDED, classify

if TYPE_CHECKING:
    import os

#: Planar kinds by meshio's names; other cells are ignored.
NAMES = {KINDS[name].meshio: name for name in PLANAR}

#: Cell numbers of formats, and the names of their sets.
TAGS = {"nastran:ref": "PID", "medit:ref": "REF", "su2:tag": "TAG", "gmsh:physical": "Physical"}


def read_meshio(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh by meshio.

    Raises
    ------
    UnsupportedError
        If meshio is not installed.
    InputError
        If it cannot read the file, or the mesh is not planar.
    """
    suffix = Path(path).suffix or "a file without an extension"
    if find_spec("meshio") is None:
        raise UnsupportedError(
            f"{path}: no reader for {suffix}; known: .msh, .unv, .inp, and more with meshio "
            "(pip install meshio)"
        )
    if not Path(path).is_file():
        raise FileError(f"{path}: no such file")
    try:
        found = import_module("meshio").read(path)
    except (Exception, SystemExit) as error:  # meshio raises many types and may exit
        raise InputError(f"{path}: meshio cannot read it: {error}") from error
    return from_meshio(found, str(path))


def from_meshio(found: Any, path: str) -> Mesh:
    """Convert a ``meshio.Mesh``; its point sets and cell sets are kept."""
    points = np.asarray(found.points, dtype=np.float64)
    notes: list[str] = []
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise InputError(f"{path}: the file has no points of the plane or of space")
    if points.shape[1] == 3:
        used = np.zeros(len(points), bool)
        for block in found.cells:
            if block.type in NAMES:
                used[np.asarray(block.data, dtype=np.int64).ravel()] = True
        placed = into_plane(points, used)
        if placed is None:
            raise InputError(
                f"{path}: the part must lie in one plane normal to an axis, such as z = 0"
            )
        points, notes = placed
    cells: list[Cells] = []
    starts: list[int] = []
    total = 0
    lines: dict[int, Any] = {}
    for block in found.cells:
        kind = NAMES.get(block.type, "")
        if block.type in ("line", "line3"):
            lines[len(starts)] = np.asarray(block.data, dtype=np.int64)[:, :2]
        starts.append(total if kind else -1)
        if not kind:
            continue
        nodes = np.array(block.data, dtype=np.int64)
        shape = classify(kind, points[nodes])
        for code, text in (
            (FLAT, "has no area or a side of no length"),
            (FOLDED, "is folded or inverted"),
        ):
            if (shape == code).any():
                row = int(np.flatnonzero(shape == code)[0])
                raise InputError(f"{path}: {block.type} {row} (from 0) {text}")
        nodes[shape == CLOCKWISE] = nodes[shape == CLOCKWISE][:, KINDS[kind].reversal]
        cells.append(Cells(kind, nodes, np.arange(total + 1, total + len(nodes) + 1)))
        total += len(nodes)
    if not cells:
        raise InputError(f"{path}: the file has no triangles or quadrilaterals")
    mesh = Mesh(points[:, :2], cells, notes=notes)
    _take_labels(found, mesh)
    point_sets, cell_sets = _groups(found)
    for name, nodes in point_sets.items():
        mesh.node_sets[str(name)] = np.asarray(nodes, dtype=np.int64).ravel()
    for name, parts in cell_sets.items():
        rows = [
            np.asarray(part, dtype=np.int64) + start
            for part, start in zip(parts, starts, strict=False)
            if start >= 0 and part is not None
        ]
        if any(map(len, rows)):
            mesh.cell_sets[str(name)] = np.concatenate(rows)
        ends = [
            lines[block][np.asarray(part, dtype=np.int64)]
            for block, part in enumerate(parts)
            if block in lines and part is not None
        ]
        if any(map(len, ends)):
            edges = mesh.edges_between(np.concatenate(ends))
            if (edges >= 0).all():
                mesh.edge_sets[str(name)] = edges
            else:
                mesh.notes.append(f"{path}: lines of set {name!r} are not edges of elements")
    return mesh


def _groups(found: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """Sets of points and of cells, also those that a format gives by a number for each cell."""
    points = dict(getattr(found, "point_sets", None) or {})
    cells = dict(getattr(found, "cell_sets", None) or {})
    data = getattr(found, "cell_data", None) or {}
    numbers = data.get("cell_tags") or ()
    for tag, names in (getattr(found, "cell_tags", None) or {}).items():  # MED
        for name in names if len(numbers) else ():
            mine = [np.flatnonzero(np.asarray(part) == tag) for part in numbers]
            cells[name] = _joined(cells.get(name), mine)
    at = np.asarray((getattr(found, "point_data", None) or {}).get("point_tags", ()))
    for tag, names in (getattr(found, "point_tags", None) or {}).items():
        for name in names if len(at) else ():
            own = np.flatnonzero(at == tag)
            points[name] = np.union1d(points.get(name, own), own).astype(np.int64)
    for key, prefix in TAGS.items():
        parts = data.get(key, ())
        for tag in np.unique(np.concatenate([np.zeros(0), *map(np.ravel, parts)])).tolist():
            mine = [np.flatnonzero(np.ravel(part) == tag) for part in parts]
            cells.setdefault(f"{prefix}{tag:g}", mine)
    return points, cells


def _joined(one: Any, other: list[Any]) -> list[Any]:
    """Members of a set by block, from two lists of them."""
    if one is None:
        return other
    return [np.union1d(a, b).astype(np.int64) for a, b in zip(one, other, strict=True)]


def _take_labels(found: Any, mesh: Mesh) -> None:
    """Labels that :func:`to_meshio` wrote."""
    data = (getattr(found, "point_data", None) or {}).get("node label")
    if data is not None and len(np.unique(data)) == mesh.n_nodes:
        mesh.node_labels = np.asarray(data, dtype=np.int64).ravel()
    parts = (getattr(found, "cell_data", None) or {}).get("element label")
    if parts is not None:
        own = [p for p, block in zip(parts, found.cells, strict=False) if block.type in NAMES]
        if len(np.unique(np.concatenate(own))) == mesh.n_cells:
            for cells, labels in zip(mesh.cells, own, strict=True):
                cells.labels = np.asarray(labels, dtype=np.int64).ravel()


def to_meshio(mesh: Mesh) -> Any:
    """Convert to a ``meshio.Mesh``; see :meth:`corota.mesh.Mesh.to_meshio`."""
    if find_spec("meshio") is None:
        raise UnsupportedError("this needs meshio, which is not installed: pip install meshio")
    blocks: list[tuple[str, Any]] = []
    labels: list[Any] = []
    starts: list[tuple[int, int]] = []
    for offset, cells in zip(mesh.offsets, mesh.cells, strict=False):
        if len(cells):
            blocks.append((KINDS[cells.kind].meshio, cells.nodes))
            labels.append(cells.labels)
            starts.append((int(offset), len(cells)))
    sets: dict[str, list[Any]] = {}
    for name, rows in mesh.cell_sets.items():
        sets[name] = [rows[(rows >= o) & (rows < o + n)] - o for o, n in starts]
    for name, edges in mesh.edge_sets.items():
        sides = mesh.edge_nodes(edges)
        for width, kind in ((2, "line"), (3, "line3")):
            part = [s for s in sides if len(s) == width]
            if not part:
                continue
            own = sets.setdefault(name, [])
            own += [np.zeros(0, np.int64)] * (len(blocks) - len(own)) + [np.arange(len(part))]
            blocks.append((kind, np.array(part)))
            labels.append(np.zeros(len(part), np.int64))
    for parts in sets.values():
        parts += [np.zeros(0, np.int64)] * (len(blocks) - len(parts))
    return import_module("meshio").Mesh(
        np.column_stack([mesh.points, np.zeros(mesh.n_nodes)]),
        blocks,
        point_data={"node label": mesh.node_labels},
        cell_data={"element label": labels},
        point_sets=dict(mesh.node_sets),
        cell_sets=sets,
    )
