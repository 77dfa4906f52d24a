"""Problem P1: a cantilever with a dead shear at its end, as a deck for both programs.

Length 10, height 1, thickness 0.01, E = 1.2e6, nu = 0.3, plane stress; clamped on the left; 4000
per unit thickness spread on the right edge; ten equal increments.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

LENGTH, HEIGHT, THICKNESS = 10.0, 1.0, 0.01
YOUNG, POISSON = 1.2e6, 0.3
SHEAR = 4000.0
INCREMENTS = 10


def grid(n: int, order: int = 1) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Nodes and quadrilaterals of a mesh of 10 n by n elements.

    Parameters
    ----------
    n : int
        Elements through the height.
    order : {1, 2}
        Four or eight nodes an element.

    Returns
    -------
    points : ndarray, shape (m, 2)
    cells : ndarray, shape (10 n^2, 4 or 8)
        Indices from 0, counter-clockwise, corners first.
    """
    nx, ny = 10 * n * order, n * order
    i, j = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="ij")
    keep = (i % order == 0) | (j % order == 0)
    index = np.full(i.shape, -1, dtype=np.int64)
    index[keep] = np.arange(keep.sum())
    points = np.stack([i[keep] * LENGTH / nx, j[keep] * HEIGHT / ny], axis=1)

    def at(di: int, dj: int) -> NDArray[np.int64]:
        return index[di : nx + 1 - order + di : order, dj : ny + 1 - order + dj : order].ravel()

    corners = [(0, 0), (order, 0), (order, order), (0, order)]
    sides = [(1, 0), (2, 1), (1, 2), (0, 1)] if order == 2 else []
    return points, np.stack([at(*where) for where in corners + sides], axis=1)


def tip_shares(points: NDArray[np.float64], order: int = 1) -> dict[int, float]:
    """Shares of a uniform traction at the nodes of the right edge; they sum to one."""
    nodes = np.flatnonzero(points[:, 0] == LENGTH)
    shares = np.zeros(len(nodes))
    weights = np.array([0.5, 0.5] if order == 1 else [1.0, 4.0, 1.0])
    for first in range(0, len(nodes) - 1, order):
        shares[first : first + order + 1] += weights / weights.sum()
    return dict(zip(nodes.tolist(), (shares / shares.sum()).tolist(), strict=True))


def tip_middle(points: NDArray[np.float64]) -> int:
    """Node of the right edge at mid-height, or the next one above."""
    above = (points[:, 0] == LENGTH) & (points[:, 1] > HEIGHT / 2 - 1e-9)
    nodes = np.flatnonzero(above)
    return int(nodes[np.argmin(points[nodes, 1])])


def n_equations(n: int, order: int = 1) -> int:
    """Count the displacement components of the mesh."""
    return 2 * len(grid(n, order)[0])


def write_deck(path: Path, n: int, element: str) -> None:
    """Write the deck; the node set TIPMID holds :func:`tip_middle`.

    Parameters
    ----------
    path : Path
    n : int
        Elements through the height.
    element : str
        ``CPS4`` or ``CPS8``; or a name that only Corota knows.
    """
    order = 2 if "8" in element else 1
    points, cells = grid(n, order)
    clamp = np.flatnonzero(points[:, 0] == 0.0)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{k + 1}, {x:.9g}, {y:.9g}, 0." for k, (x, y) in enumerate(points.tolist())]
    lines.append(f"*ELEMENT, TYPE={element}, ELSET=EALL")
    lines += [
        f"{k + 1}, " + ", ".join(str(node + 1) for node in cell)
        for k, cell in enumerate(cells.tolist())
    ]
    lines.append("*NSET, NSET=CLAMP")
    lines += [f"{node + 1}," for node in clamp.tolist()]
    lines += ["*NSET, NSET=TIPMID", f"{tip_middle(points) + 1},"]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG:g}, {POISSON:g}"]
    lines += ["*SOLID SECTION, ELSET=EALL, MATERIAL=M", f"{THICKNESS:g}"]
    lines += ["*BOUNDARY", "CLAMP, 1, 3"]
    lines += ["*STEP, NLGEOM, INC=1000", "*STATIC, DIRECT", f"{1.0 / INCREMENTS:g}, 1."]
    lines.append("*CLOAD")
    force = SHEAR * THICKNESS
    lines += [f"{k + 1}, 2, {force * s:.12g}" for k, s in tip_shares(points, order).items()]
    lines += ["*NODE PRINT, NSET=TIPMID", "U", "*END STEP"]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
