"""Meshes of lines and points."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.mesh import Mesh
from corota.mesh.data import Cells


def lines(points: list[tuple[float, float]], *cells: tuple[str, list[list[int]]]) -> Mesh:
    """A mesh of lines and points."""
    blocks, label = [], 1
    for kind, nodes in cells:
        array = np.array(nodes)
        blocks.append(Cells(kind, array, np.arange(label, label + len(array))))
        label += len(array)
    return Mesh(np.array(points), blocks, np.arange(1, len(points) + 1))


def chain(n: int, length: float) -> Mesh:
    """A straight line of n cells."""
    points = [(length * i / n, 0.0) for i in range(n + 1)]
    return lines(points, ("line2", [[i, i + 1] for i in range(n)]))
