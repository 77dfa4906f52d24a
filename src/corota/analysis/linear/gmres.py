"""GMRES for a factorized matrix and a few entries beside it (Saad and Schultz 1986)."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.linear.triplets import Triplets
    from corota.arrays import Floats


#: Relative residual that is enough, and largest number of steps.
TOLERANCE, MOST_STEPS = 1e-9, 60


def gmres(
    solve: Callable[[Floats], Floats], rest: Triplets, b: Floats, n_inner: int
) -> tuple[Floats | None, int]:
    """Solution of (M + N) x = b with M factorized and N few entries.

    Parameters
    ----------
    solve : callable
        Solves with M.
    rest : Triplets
        Entries of N.
    b : ndarray, shape (n,)
    n_inner : int
        Displacements among the unknowns; the others are multipliers, of another magnitude.

    Returns
    -------
    x : ndarray, shape (n,), or None
        None if the iteration stalls or numbers overflow.
    steps : int
    """
    # What N multiplies decides on the rest: x = M^-1 (b - N z) with these few unknowns z.
    used = np.zeros(len(b), bool)
    used[rest.columns] = True
    few = np.flatnonzero(used)
    columns = np.searchsorted(few, rest.columns)
    start = solve(b)
    r = start[few]
    scale = np.ones(len(few))
    for part in (few < n_inner, few >= n_inner):
        top = float(np.abs(r[part]).max(initial=0.0))
        scale[part] = top if top > 0.0 else 1.0
    r = r / scale
    beta = _length(r)
    if not (np.isfinite(beta) and np.isfinite(start).all()):
        return None, 0
    if beta == 0.0:
        return start, 0
    basis, h = np.empty((MOST_STEPS + 1, len(few))), np.zeros((MOST_STEPS, MOST_STEPS))
    basis[0], moved = r / beta, []
    turns: list[tuple[float, float]] = []  # that make h triangular: cosines and sines
    sides = [beta]  # turned as well: the last is what is left
    for k in range(MOST_STEPS):
        values = rest.values * (basis[k] * scale)[columns]
        moved.append(solve(np.asarray(np.bincount(rest.rows, values, len(b)), np.float64)))
        w = basis[k] + moved[k][few] / scale
        for _ in range(2):
            part = basis[: k + 1] @ w
            h[: k + 1, k] += part
            w -= part @ basis[: k + 1]
        length = _length(w)
        if not math.isfinite(length):
            return None, k + 1
        h[: k + 1, k], size = _turned([*h[: k + 1, k].tolist(), length], turns)
        if size == 0.0:
            return None, k + 1
        cosine, sine = turns[-1]
        sides[k:] = [cosine * sides[k], -sine * sides[k]]
        left = abs(sides[-1])
        if left <= TOLERANCE * beta or length <= 1e-15 * beta:
            y = np.array(sides[:-1])
            for i in range(k, -1, -1):
                y[i] /= h[i, i]
                y[:i] -= y[i] * h[:i, i]
                start -= y[i] * moved[i]
            return start, k + 1
        if k > 20 and left > 0.5 * beta:
            return None, k + 1
        basis[k + 1] = w / length
    return None, MOST_STEPS


def _turned(column: list[float], turns: list[tuple[float, float]]) -> tuple[list[float], float]:
    """A column after the turns so far and one that makes its last entry zero, which is added.

    Returns the column without that entry, and what is then its last one.
    """
    for i, (cosine, sine) in enumerate(turns):
        above, below = column[i : i + 2]
        column[i : i + 2] = cosine * above + sine * below, cosine * below - sine * above
    *column, above, below = column
    size = math.hypot(above, below)
    turns.append((above / size, below / size) if size > 0.0 else (1.0, 0.0))
    return [*column, size], size


def _length(a: Floats) -> float:
    return math.sqrt(a @ a)
