"""Linear complementarity problems by Lemke's method.

Source: R. W. Cottle, J.-S. Pang, R. E. Stone, *The Linear Complementarity Problem* (2009), ch. 4.4
and, for ties of the ratio test by lexicographic order, ch. 4.9.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Pivots by unknown before the search is given up, and relative size of a pivot that is zero.
PIVOTS, SMALL = 12, 1e-11
#: Relative difference of ratios that tie.
TIE = 1e-10


def lemke(c: Floats, m: Floats) -> tuple[Floats, NDArray[np.bool_]] | None:
    """Solve ``y = c + m x, x >= 0, y >= 0, x y = 0``.

    Parameters
    ----------
    c : ndarray, shape (n,)
    m : ndarray, shape (n, n)
        Rows and columns of like size.

    Returns
    -------
    x : ndarray, shape (n,)
    basic : ndarray of bool, shape (n,)
        Which x are in the basis at the end; their y are zero.
    None
        If the method ends on a ray: there is no solution, or it cannot find one.
    """
    n = len(c)
    basic = np.zeros(n, bool)
    if n == 0 or c.min() >= 0.0:
        return np.zeros(n), basic
    # Columns: y (n), x (n), the artificial variable, right-hand side: y - m x - d t = c.
    table = np.concatenate([np.eye(n), -m, -np.ones((n, 1)), c[:, None]], axis=1)
    base = np.arange(n)
    row = int(np.argmin(c))
    entering = 2 * n
    for _ in range(PIVOTS * n + 20):
        leaving = int(base[row])
        pivot = table[row] / table[row, entering]
        column = table[:, entering].copy()
        column[row] = 0.0
        table -= np.outer(column, pivot)
        table[row] = pivot
        base[row] = entering
        if leaving == 2 * n:
            x = np.zeros(n)
            inside = (base >= n) & (base < 2 * n)
            x[base[inside] - n] = table[inside, -1]
            basic[base[inside] - n] = True
            return np.maximum(x, 0.0), basic
        entering = leaving + n if leaving < n else leaving - n
        column = table[:, entering]
        able = np.flatnonzero(column > SMALL * max(1.0, float(np.abs(column).max())))
        if not len(able):
            return None
        row = _leaving(table, column, able, base, n)
    return None


def _leaving(
    table: Floats, column: Floats, able: NDArray[np.int64], base: NDArray[np.int64], n: int
) -> int:
    """Row that leaves the basis; of ties the artificial variable, then the lexicographic least."""
    ratio = np.maximum(table[able, -1], 0.0) / column[able]
    size = max(float(np.abs(table[:, -1]).max()) / max(float(np.abs(column).max()), 1e-300), 1e-300)
    tied = able[ratio <= ratio.min() + TIE * min(size, max(float(ratio.min()), 1e-4 * size))]
    final = np.flatnonzero(base[tied] == 2 * n)
    if len(final):
        return int(tied[final[0]])
    for k in range(n):
        if len(tied) == 1:
            break
        other = table[tied, k] / column[tied]
        tied = tied[other <= other.min() + TIE * max(1.0, float(np.abs(other).max()))]
    # Of rows that are equal to rounding, the one with the largest pivot.
    return int(tied[np.argmax(column[tied])])


__all__ = ["lemke"]
