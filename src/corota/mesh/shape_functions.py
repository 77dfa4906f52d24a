"""Shape functions of the cell kinds, for geometry and nodal fields."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Floats
from corota.mesh.kinds import KINDS, monomials


def shape_functions(kind: str, at: Floats) -> Floats:
    """Shape functions of a cell kind at natural coordinates (m, 2), shape (m, k)."""
    return np.asarray(monomials(at, KINDS[kind].powers) @ KINDS[kind].coefficients)


def edge_functions(r: Floats, curved: bool = True) -> tuple[Floats, Floats]:
    """Shape functions of both ends and the middle of edges, and their derivatives, shape (..., 3).

    Parameters
    ----------
    r : ndarray
        Natural coordinates, from -1 to 1.
    curved : bool
        Whether the middle is a node; otherwise its functions are zero.
    """
    if curved:
        shape = (0.5 * r * (r - 1.0), 0.5 * r * (r + 1.0), 1.0 - r * r)
        slope = (r - 0.5, r + 0.5, -2.0 * r)
    else:
        one = np.ones_like(r)
        shape, slope = (0.5 - 0.5 * r, 0.5 + 0.5 * r, 0.0 * r), (-0.5 * one, 0.5 * one, 0.0 * one)
    return np.stack(shape, axis=-1), np.stack(slope, axis=-1)


def shape_gradients(kind: str, at: Floats) -> Floats:
    """Derivatives of the shape functions by both natural coordinates, shape (m, 2, k)."""
    powers = KINDS[kind].powers
    parts = []
    for axis in (0, 1):
        factor = np.array([power[axis] for power in powers])
        lower = tuple((max(i - 1 + axis, 0), max(j - axis, 0)) for i, j in powers)
        parts.append(factor * monomials(at, lower) @ KINDS[kind].coefficients)
    return np.stack(parts, axis=1)
