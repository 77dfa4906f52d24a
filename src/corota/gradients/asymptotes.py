"""The method of moving asymptotes: many parameters, few inequalities.

K. Svanberg, *The method of moving asymptotes - a new method for structural optimization*, Int. J.
Numer. Meth. Engng 24 (1987) 359-373, by the package mmapy.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from corota.arrays import Floats
from corota.errors import InputError, ResourceError

#: Cost of a violated constraint over its scaled value: above that of the objective.
COST = 1e3
#: Halved steps towards a design that could be analyzed.
BACK = 12


class Outcome(NamedTuple):
    """Where the method ended."""

    x: Floats
    success: bool
    message: str


def moving_asymptotes(
    at: Callable[[Floats], tuple[Floats, Floats]],
    usable: Callable[[Floats], bool],
    start: Floats,
    bounds: tuple[Floats, Floats],
    limits: Sequence[tuple[float, float]],
    tolerance: float,
    most: int,
    move: float = 0.5,
) -> Outcome:
    """Minimize the first value within limits of the others.

    Parameters
    ----------
    at : callable
        Values, shape (1 + m,), and gradients, shape (1 + m, n), of order one.
    usable : callable
        Whether a design can be analyzed; else the step to it is halved.
    start : ndarray, shape (n,)
    bounds : tuple of ndarray, shapes (n,)
    limits : sequence of (float, float)
        Of the values after the first, infinite where there is none.
    tolerance : float
        It ends where no parameter changes by more than the square root of it.
    most : int
        Most iterations.
    move : float
        Largest change of a parameter in an iteration, over the range of its bounds.

    Raises
    ------
    InputError
        If a constraint is an equation.
    ResourceError
        If mmapy is not installed.
    """
    try:
        from mmapy import mmasub
    except ImportError:
        raise ResourceError(
            "method='MMA' needs mmapy, which is not installed: pip install corota[optimize]"
        ) from None
    if any(low == high for low, high in limits):
        raise InputError("MMA takes no equations: give a constraint different bounds, or 'SLSQP'")
    sides = [(k, s, b) for k, pair in enumerate(limits, 1) for s, b in _sides(*pair)]
    low, high = (b[:, None] for b in bounds)
    m, n = max(len(sides), 1), len(start)
    one = np.ones((m, 1))
    asymptotes: Any = (low.copy(), high.copy())
    x = start
    old, older = x, x
    for iteration in range(1, most + 1):
        values, slopes = at(x)
        excess, by = -one.copy(), np.zeros((m, n))  # without constraints one that always is kept
        for row, (k, sign, bound) in enumerate(sides):
            excess[row], by[row] = sign * (values[k] - bound), sign * slopes[k]
        found = mmasub(
            *(m, n, iteration, x[:, None], low, high, old[:, None], older[:, None]),
            *(values[0], slopes[0][:, None], excess, by, *asymptotes),
            *(1.0, 0.0 * one, COST * one, one, move),
        )
        asymptotes = found[-2:]
        new = np.clip(found[0][:, 0], low[:, 0], high[:, 0])
        for _ in range(BACK):
            if usable(new):
                break
            new = 0.5 * (new + x)
        else:
            return Outcome(x, False, "no design near the last one could be analyzed")
        older, old, x = old, x, new
        if np.abs(x - old).max() <= math.sqrt(tolerance) * (high - low).max():
            return Outcome(x, True, f"no parameter changes after {iteration} iterations")
    return Outcome(x, False, f"{most} iterations")


def _sides(low: float, high: float) -> list[tuple[float, float]]:
    """Sign and bound of the inequalities ``sign * (value - bound) <= 0``."""
    found = [(-1.0, low), (1.0, high)]
    return [(sign, bound) for sign, bound in found if math.isfinite(bound)]
