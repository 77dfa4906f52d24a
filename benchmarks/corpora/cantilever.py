"""Problem P1: a cantilever with a dead shear at its end.

Length 10, height 1, thickness 0.01, E = 1.2e6, nu = 0.3, plane stress; clamped on the left; 4000
per unit thickness spread on the right edge; ten equal increments.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
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
