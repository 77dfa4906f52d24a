"""GMRES for a factorized matrix and a few entries beside it (Saad and Schultz 1986)."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.linear.triplets import Triplets

    Floats = NDArray[np.float64]

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

    def apply(v: Floats) -> Floats:
        product = np.zeros(len(b))
        np.add.at(product, rest.rows, rest.values * v[rest.columns])
        return v + solve(product)

    r = solve(b)
    scale = np.ones(len(b))
    for part in (slice(0, n_inner), slice(n_inner, len(b))):
        top = float(np.abs(r[part]).max(initial=0.0))
        scale[part] = top if top > 0.0 else 1.0
    r = r / scale
    beta = _length(r)
    if beta == 0.0:
        return r, 0
    if not np.isfinite(beta):
        return None, 0
    basis, h = [r / beta], np.zeros((MOST_STEPS + 1, MOST_STEPS))
    turns: list[tuple[float, float]] = []  # that make h triangular: cosines and sines
    left = beta
    for k in range(MOST_STEPS):
        w = apply(basis[k] * scale) / scale
        for _ in range(2):
            for i, v in enumerate(basis):
                part_of = _product(v, w)
                h[i, k] += part_of
                w -= part_of * v
        h[k + 1, k] = length = _length(w)
        if not math.isfinite(length):
            return None, k + 1
        turns.append(_turn(h[: k + 2, k].tolist(), turns))
        left *= abs(turns[-1][1])
        if left <= TOLERANCE * beta or length <= 1e-15 * beta:
            small = np.zeros(k + 2)
            small[0] = beta
            y, *_ = np.linalg.lstsq(h[: k + 2, : k + 1], small, rcond=None)
            x = scale * np.sum([c * v for c, v in zip(y, basis, strict=False)], axis=0)
            return np.asarray(x), k + 1
        if k > 20 and left > 0.5 * beta:
            return None, k + 1
        basis.append(w / length)
    return None, MOST_STEPS


def _turn(column: list[float], turns: list[tuple[float, float]]) -> tuple[float, float]:
    """Cosine and sine that turn the last entry of a column away, after the turns before."""
    last = column[0]
    for below, (cosine, sine) in zip(column[1:], turns, strict=False):
        last = cosine * below - sine * last
    size = math.hypot(last, column[-1])
    return (last / size, column[-1] / size) if size > 0.0 else (1.0, 0.0)


def _product(a: Floats, b: Floats) -> float:
    """Scalar product without the threads of BLAS, which cost more than they save here."""
    return float(np.einsum("i,i->", a, b))


def _length(a: Floats) -> float:
    return math.sqrt(_product(a, a))


__all__ = ["gmres"]
