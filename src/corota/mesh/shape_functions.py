"""Shape functions of the cell kinds, for geometry and nodal fields."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Floats
from corota.mesh.kinds import KINDS, monomials


def shape_functions(kind: str, at: Floats) -> Floats:
    """Shape functions of a cell kind at natural coordinates (m, 2), shape (m, k)."""
    return np.asarray(monomials(at, KINDS[kind].powers) @ KINDS[kind].coefficients)


def shape_gradients(kind: str, at: Floats) -> Floats:
    """Derivatives of the shape functions by both natural coordinates, shape (m, 2, k)."""
    powers = KINDS[kind].powers
    parts = []
    for axis in (0, 1):
        factor = np.array([power[axis] for power in powers])
        lower = tuple((max(i - 1 + axis, 0), max(j - axis, 0)) for i, j in powers)
        parts.append(factor * monomials(at, lower) @ KINDS[kind].coefficients)
    return np.stack(parts, axis=1)
