"""Shape of cells: orientation, folds, Jacobians, aspect ratio."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.mesh.data import Floats, Ints

#: Order in which the nodes of a clockwise cell become counter-clockwise; the first stays.
REVERSED: dict[str, list[int]] = {
    "tri3": [0, 2, 1],
    "tri6": [0, 2, 1, 5, 4, 3],
    "quad4": [0, 3, 2, 1],
    "quad8": [0, 3, 2, 1, 7, 6, 5, 4],
    "quad9": [0, 3, 2, 1, 7, 6, 5, 4, 8],
}

#: Smallest corner sine, relative to the lengths of its sides, that counts as not straight.
STRAIGHT = 1e-12

GOOD, CLOCKWISE, FOLDED, FLAT = 0, 1, 2, 3


def n_corners(kind: str) -> int:
    """Count the corners of a cell kind."""
    return 3 if kind.startswith("tri") else 4


def corner_sines(kind: str, points: Floats) -> Floats:
    """Sine of the angle at each corner, positive counter-clockwise.

    Parameters
    ----------
    kind : str
    points : ndarray, shape (n_cells, n_nodes, 2)

    Returns
    -------
    ndarray, shape (n_cells, n_corners)
    """
    dx, dy, length = _sides(kind, points)
    sines = np.empty_like(length)
    for i in range(length.shape[1]):
        cross = dx[:, i - 1] * dy[:, i] - dy[:, i - 1] * dx[:, i]
        lengths = length[:, i - 1] * length[:, i]
        sines[:, i] = cross / np.where(lengths > 0.0, lengths, 1.0)
    return sines


def _sides(kind: str, points: Floats) -> tuple[Floats, Floats, Floats]:
    """Components and lengths of the sides from each corner to the next, (n_cells, n_corners)."""
    count = n_corners(kind)
    following = [*range(1, count), 0]
    dx = points[:, following, 0] - points[:, :count, 0]
    dy = points[:, following, 1] - points[:, :count, 1]
    return dx, dy, np.hypot(dx, dy)


def classify(kind: str, points: Floats) -> Ints:
    """Say of each cell whether it is ``GOOD``, ``CLOCKWISE``, ``FOLDED`` or ``FLAT``.

    A flat cell has no area, is a triangle with a side of no length, or a quadrilateral with two;
    one such side makes a triangle of a quadrilateral. A folded cell has angles of both signs at its
    corners, or its Jacobian changes sign at integration points.

    Parameters
    ----------
    kind : str
    points : ndarray, shape (n_cells, n_nodes, 2)

    Returns
    -------
    ndarray of int, shape (n_cells,)
    """
    sines = corner_sines(kind, points)
    left, right = (sines > STRAIGHT).any(axis=1), (sines < -STRAIGHT).any(axis=1)
    found = np.full(len(points), GOOD, dtype=np.int64)
    found[right] = CLOCKWISE
    found[left & right] = FOLDED
    found[~left & ~right] = FLAT
    sides = _sides(kind, points)[2]
    found[_closed(sides).sum(axis=1) > n_corners(kind) - 3] = FLAT
    if kind != "tri3":
        jacobian = jacobians(kind, points)
        sign = np.where(found == CLOCKWISE, -1.0, 1.0)[:, None]
        bad = (jacobian * sign <= 0.0).any(axis=1)
        found[bad & (found != FLAT)] = FOLDED
    return found


def _closed(sides: Floats) -> NDArray[np.bool_]:
    """Whether a side has no length, shape (n_cells, n_corners)."""
    return np.asarray(sides <= STRAIGHT * sides.max(axis=1, initial=0.0)[:, None])


def jacobians(kind: str, points: Floats) -> Floats:
    """Evaluate the determinants of the isoparametric map at integration points.

    Parameters
    ----------
    kind : str
    points : ndarray, shape (n_cells, n_nodes, 2)

    Returns
    -------
    ndarray, shape (n_cells, n_points)
    """
    gradients = _gradients(kind)
    map_ = np.einsum("pdn,cnx->cpdx", gradients, points)
    return np.asarray(map_[..., 0, 0] * map_[..., 1, 1] - map_[..., 0, 1] * map_[..., 1, 0])


def aspect_ratio(kind: str, points: Floats) -> Floats:
    """Longest over shortest side of each cell, but for sides of no length; shape (n_cells,)."""
    sides = _sides(kind, points)[2]
    shortest = np.where(_closed(sides), np.inf, sides).min(axis=1)
    return np.asarray(sides.max(axis=1) / shortest)


def _gradients(kind: str) -> Floats:
    """Differentiate the shape functions at integration points: (n_points, 2, n_nodes)."""
    if kind.startswith("tri"):
        inner = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]])
        return np.stack([_triangle(kind, r, s) for r, s in inner])
    g = np.sqrt(0.6) if kind != "quad4" else np.sqrt(1 / 3)
    at = (-g, 0.0, g) if kind != "quad4" else (-g, g)
    return np.stack([_quadrilateral(kind, r, s) for s in at for r in at])


def _triangle(kind: str, r: float, s: float) -> Floats:
    t = 1.0 - r - s
    if kind == "tri3":
        return np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    return np.array(
        [
            [1 - 4 * t, 4 * r - 1, 0.0, 4 * (t - r), 4 * s, -4 * s],
            [1 - 4 * t, 0.0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)],
        ]
    )


def _quadrilateral(kind: str, r: float, s: float) -> Floats:
    a = np.array([-1.0, 1.0, 1.0, -1.0])
    b = np.array([-1.0, -1.0, 1.0, 1.0])
    if kind == "quad4":
        return np.stack([a * (1 + b * s), b * (1 + a * r)]) / 4
    if kind == "quad8":
        corner = np.stack(
            [a * (1 + b * s) * (2 * a * r + b * s), b * (1 + a * r) * (2 * b * s + a * r)]
        )
        middle = np.array(
            [
                [-r * (1 - s), (1 - s * s) / 2, -r * (1 + s), -(1 - s * s) / 2],
                [-(1 - r * r) / 2, -s * (1 + r), (1 - r * r) / 2, -s * (1 - r)],
            ]
        )
        return np.concatenate([corner / 4, middle], axis=1)
    x = np.array([-1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0])
    y = np.array([-1.0, -1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0, 0.0])
    return np.stack([_line(x, r, 1) * _line(y, s, 0), _line(x, r, 0) * _line(y, s, 1)])


def _line(nodes: Floats, r: float, order: int) -> Floats:
    """Quadratic Lagrange functions on -1, 0, 1 (or their derivative) of the given nodes."""
    if order == 0:
        return np.where(nodes == 0.0, 1 - r * r, (r * r + nodes * r) / 2)
    return np.where(nodes == 0.0, -2 * r, r + nodes / 2)
