"""Derivatives of smooth functions by central differences of fourth order.

They differentiate functions whose values are exact to rounding, forces and stresses at a fixed
state, never solutions of an iteration: with steps of 1e-3 of a variable the error is about 1e-12.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from corota.arrays import Floats

#: Offsets in steps, and the factors of the values there.
STENCIL = ((1, 2.0 / 3.0), (-1, -2.0 / 3.0), (2, -1.0 / 12.0), (-2, 1.0 / 12.0))
#: First step, relative to the size of a variable.
STEP = 1e-3
#: First step times the number of variables of state. A bent strip of 400 thousand of them has an
#: error of 8e-7 by a step of 1e-4, and of 1e-10 by steps of 1e-5 and 1e-6.
STATE_STEP = 4.0
#: Relative difference of the results of second and fourth order above which the step shrinks: the
#: error of the fourth order is about its square.
ROUGH = 1e-5
#: Relative rounding error of a sum of forces.
ROUNDING = 1e-13
#: Step reductions, each by ten: a step must not reach the next point that begins to flow.
REDUCTIONS = 4


def derivative(
    function: Callable[[float], tuple[Floats, Floats]], size: float, first: float = STEP
) -> tuple[Floats, Floats]:
    """Derivative of a function of one variable at zero.

    Parameters
    ----------
    function : callable
        Gives values for an offset of the variable, and the sizes of the sums that they are: these
        times the machine precision are their rounding errors.
    size : float
        Size of the variable, over which the function is smooth.
    first : float
        First step, relative to the size.

    Returns
    -------
    slope : ndarray
    rough : ndarray
        Relative differences of the results of second and fourth order, beyond rounding. A kink
        leaves a large one, whatever the step.

    Notes
    -----
    Of several steps that with the least difference counts. Kinks beside the point let it rise from
    one step to the next until a step stays between them.
    """
    slope, rough = _difference(function, first * size)
    for reduction in range(1, REDUCTIONS + 1):
        if rough.max(initial=0.0) <= ROUGH:
            break
        other, its = _difference(function, first * size * 0.1**reduction)
        if its.max() < rough.max():
            slope, rough = other, its
    return slope, rough


def _difference(
    function: Callable[[float], tuple[Floats, Floats]], step: float
) -> tuple[Floats, Floats]:
    found = {k: function(k * step) for k, _ in STENCIL}
    values = {k: np.asarray(v, dtype=float) for k, (v, _) in found.items()}
    slope = np.asarray(sum(weight * values[k] for k, weight in STENCIL) / step)
    second = 0.5 * (values[1] - values[-1]) / step
    noise = ROUNDING * np.asarray(found[1][1]) / step
    off, size = np.abs(slope - second), np.abs(slope)
    significant = off > noise
    return slope, np.where(significant, off / np.where(size > 0.0, size, 1.0), 0.0)


def all_derivatives(function: Callable[[float], Floats], step: float) -> Floats:
    """Derivative at zero with one given step, of many values at once."""
    return np.asarray(sum(weight * function(k * step) for k, weight in STENCIL) / step)


def step_between_kinks(n_state: int) -> float:
    """First relative step for laws with so many variables of state.

    The step must not reach the next point that begins to flow, and the more points there are, the
    nearer it is.

    Returns
    -------
    float
    """
    return min(STEP, STATE_STEP / max(n_state, 1))
