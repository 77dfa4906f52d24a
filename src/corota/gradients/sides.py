"""One-sided derivatives where a measure has a kink: limits of those beside it.

Beside a kink (a node between stick and slip, a gap about to close, a point about to flow) a
measure is smooth on each side. Its exact derivatives at three states on one side, each of an
analysis of its own, are extrapolated to the kink by a parabola.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.errors import InputError, UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Floats

    #: Side of a parameter's value: below or above.
    Side = Literal["left", "right"]

#: First distance of a state, relative to the size of a parameter; it shrinks by ten.
STEP = 1e-3
#: Reductions: a kink further on must not stand between the states.
REDUCTIONS = 2
#: Difference of the extrapolations by a line and a parabola that shows another kink.
ROUGH = 1e-3
#: Derivative over that of a measure in proportion to the parameter that is none.
FLOOR = 1e-6


def require_side(side: str | None) -> None:
    """Refuse what is no side.

    Raises
    ------
    InputError
    """
    if side not in (None, "left", "right"):
        raise InputError(f"one_sided must be 'left' or 'right', not {side!r}")


def one_sided(
    slope: Callable[[float], Floats], values: Floats, size: float, side: str, name: str
) -> Floats:
    """Limit of a derivative at zero from one side.

    Parameters
    ----------
    slope : callable
        Derivatives of the measures at an offset of the parameter.
    values : ndarray, shape (n_measures,)
        The measures there.
    size : float
        Size of the parameter.
    side : {"left", "right"}
        Below or above the value of the parameter.
    name : str
        Of the parameter, for messages.

    Returns
    -------
    ndarray, shape (n_measures,)

    Raises
    ------
    UnsupportedError
        If there are more kinks beside the value.
    """
    sign = 1.0 if side == "right" else -1.0
    for reduction in range(REDUCTIONS + 1):
        step = sign * STEP * size * 0.1**reduction
        one, two, three = (slope(k * step) for k in (1, 2, 3))
        line, parabola = 2.0 * one - two, 3.0 * one - 3.0 * two + three
        largest = np.maximum(np.abs([one, two, three]).max(axis=0), FLOOR * np.abs(values) / size)
        if np.all(np.abs(parabola - line) <= ROUGH * largest):
            return np.asarray(parabola)
    raise UnsupportedError(
        f"{name}: the measure has more kinks close to the {side} of the value; change the "
        "parameter or the load a little"
    )
