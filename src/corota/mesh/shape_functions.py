"""Shape functions of the cell kinds, for geometry and nodal fields."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def shape_functions(kind: str, at: Floats) -> Floats:
    """Shape functions of a cell kind at natural coordinates, shape (m, k)."""
    x, y = at[:, 0], at[:, 1]
    if kind.startswith("tri"):
        a = np.stack([1 - x - y, x, y], axis=1)
        if kind == "tri3":
            return a
        middle = [4 * a[:, 0] * a[:, 1], 4 * a[:, 1] * a[:, 2], 4 * a[:, 2] * a[:, 0]]
        return np.concatenate([a * (2 * a - 1), np.stack(middle, axis=1)], axis=1)
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    if kind == "quad4":
        return np.stack([0.25 * (1 + i * x) * (1 + j * y) for i, j in corners], axis=1)
    sides = [(0, -1), (1, 0), (0, 1), (-1, 0)]
    if kind == "quad9":

        def line(i: int, t: Floats) -> Floats:
            return 1 - t * t if i == 0 else 0.5 * t * (t + i)

        return np.stack([line(i, x) * line(j, y) for i, j in [*corners, *sides, (0, 0)]], axis=1)
    corner = [0.25 * (1 + i * x) * (1 + j * y) * (i * x + j * y - 1) for i, j in corners]
    side = [
        0.5 * ((1 - x * x) * (1 + j * y) if i == 0 else (1 - y * y) * (1 + i * x)) for i, j in sides
    ]
    return np.stack(corner + side, axis=1)


__all__ = ["shape_functions"]
