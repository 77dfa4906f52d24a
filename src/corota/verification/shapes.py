"""Shape functions and quadrature from their definitions, independent of the compiled core.

Cells of 3, 4, 6, 8 and 9 nodes, numbered as everywhere: corners, mid-sides, center.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

QUAD = np.array(
    [[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]], float
)
TRIANGLE = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]], float)
POWERS = {
    3: [(0, 0), (1, 0), (0, 1)],
    4: [(0, 0), (1, 0), (0, 1), (1, 1)],
    6: [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
    8: [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2)],
    9: [(i, j) for i in range(3) for j in range(3)],
}


def shape(n: int, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions (p, n) and natural derivatives (p, n, 2) at points (p, 2)."""
    nodes = (TRIANGLE if n in (3, 6) else QUAD)[:n]

    def power(x: np.ndarray, k: int) -> np.ndarray:
        return x**k if k >= 0 else np.zeros_like(x)

    def monomials(x: np.ndarray, di: int, dj: int) -> np.ndarray:
        return np.stack(
            [
                (i if di else 1)
                * (j if dj else 1)
                * power(x[:, 0], i - di)
                * power(x[:, 1], j - dj)
                for i, j in POWERS[n]
            ],
            axis=1,
        )

    coefficients = np.linalg.inv(monomials(nodes, 0, 0))
    values = monomials(xi, 0, 0) @ coefficients
    slopes = [monomials(xi, 1, 0) @ coefficients, monomials(xi, 0, 1) @ coefficients]
    return values, np.stack(slopes, axis=2)


def gauss(n_nodes: int, order: int) -> tuple[np.ndarray, np.ndarray]:
    """Points (p, 2) and weights (p,): `order` a direction; triangles by a collapsed square."""
    x, w = np.polynomial.legendre.leggauss(order)
    r, s = (g.ravel() for g in np.meshgrid(x, x))
    weight = np.outer(w, w).ravel()
    if n_nodes in (3, 6):
        r, s = (1 + r) / 2, (1 + s) / 2
        return np.stack([r * (1 - s), s], axis=1), weight * (1 - s) / 4
    return np.stack([r, s], axis=1), weight
