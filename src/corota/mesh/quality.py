"""Shape of cells: orientation, folds, Jacobians, aspect ratio."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Bools, Floats, Ints
from corota.mesh.kinds import KINDS
from corota.mesh.shape_functions import shape_gradients

#: Smallest corner sine, relative to the lengths of its sides, that counts as not straight.
STRAIGHT = 1e-12

GOOD, CLOCKWISE, FOLDED, FLAT = 0, 1, 2, 3


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


def corner_angles(kind: str, points: Floats) -> Floats:
    """Angle at each corner, from 0 to 360 degrees counter-clockwise.

    Parameters
    ----------
    kind : str
    points : ndarray, shape (n_cells, n_nodes, 2)

    Returns
    -------
    ndarray, shape (n_cells, n_corners) [degrees]
    """
    dx, dy, _ = _sides(kind, points)
    cross = np.roll(dx, 1, 1) * dy - np.roll(dy, 1, 1) * dx
    along = np.roll(dx, 1, 1) * dx + np.roll(dy, 1, 1) * dy
    return np.asarray(180.0 - np.degrees(np.arctan2(cross, along)))


def _sides(kind: str, points: Floats) -> tuple[Floats, Floats, Floats]:
    """Components and lengths of the sides from each corner to the next, (n_cells, n_corners)."""
    count = KINDS[kind].n_corners
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
    found[_closed(sides).sum(axis=1) > KINDS[kind].n_corners - 3] = FLAT
    if kind != "tri3":
        jacobian = jacobians(kind, points)
        sign = np.where(found == CLOCKWISE, -1.0, 1.0)[:, None]
        bad = (jacobian * sign <= 0.0).any(axis=1)
        found[bad & (found != FLAT)] = FOLDED
    return found


def _closed(sides: Floats) -> Bools:
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
    """Differentiate the shape functions at the kind's points: (n_points, 2, n_nodes)."""
    return shape_gradients(kind, np.array(KINDS[kind].points))
