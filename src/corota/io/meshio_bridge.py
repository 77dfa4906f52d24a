"""Meshes of other formats, by way of meshio."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import FileError, InputError, UnsupportedError
from corota.mesh.data import Cells, Mesh
from corota.mesh.quality import CLOCKWISE, FLAT, FOLDED, REVERSED, classify

if TYPE_CHECKING:
    import os

#: Kinds by meshio's names; other cells are left out.
KINDS = {
    "triangle": "tri3",
    "triangle6": "tri6",
    "quad": "quad4",
    "quad8": "quad8",
    "quad9": "quad9",
}


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
            f"{path}: no reader for {suffix}; known: .msh, .inp, and more with meshio "
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
    if points.shape[1] == 3 and np.abs(points[:, 2]).max(initial=0.0) > 1e-6 * np.ptp(points):
        raise InputError(f"{path}: the part must lie in the plane z = 0")
    cells, starts, total = [], [], 0
    for block in found.cells:
        kind = KINDS.get(block.type, "")
        starts.append(total if kind else -1)
        if not kind:
            continue
        nodes = np.array(block.data, dtype=np.int64)
        shape = classify(kind, points[nodes][:, :, :2])
        for code, text in (
            (FLAT, "has no area or a side of no length"),
            (FOLDED, "is folded or inverted"),
        ):
            if (shape == code).any():
                row = int(np.flatnonzero(shape == code)[0])
                raise InputError(f"{path}: {block.type} {row} (from 0) {text}")
        nodes[shape == CLOCKWISE] = nodes[shape == CLOCKWISE][:, REVERSED[kind]]
        cells.append(Cells(kind, nodes, np.arange(total + 1, total + len(nodes) + 1)))
        total += len(nodes)
    if not cells:
        raise InputError(f"{path}: the file has no triangles or quadrilaterals")
    mesh = Mesh(points[:, :2], cells)
    for name, nodes in (getattr(found, "point_sets", None) or {}).items():
        mesh.node_sets[str(name)] = np.asarray(nodes, dtype=np.int64).ravel()
    for name, parts in (getattr(found, "cell_sets", None) or {}).items():
        rows = [
            np.asarray(part, dtype=np.int64) + start
            for part, start in zip(parts, starts, strict=False)
            if start >= 0 and part is not None
        ]
        if any(map(len, rows)):
            mesh.cell_sets[str(name)] = np.concatenate(rows)
    return mesh
