"""Whether the reason that a contact run gives for its end is right: a look at its states alone.

A message may name plastic collapse or a limit point. What it names is looked for in the states of
the run by other means than those that wrote the message. A message that names nothing of this kind
("no progress", "no equilibrium nearby") gives no reason: such a run counts as failed.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    import corota as ct

    Floats = NDArray[np.float64]

#: Displacement per load at a limit over that of the first increment.
SOFT = 5.0
#: Share of the internal energy that has flowed where a structure collapses plastically.
FLOWED = 0.1


def reason(results: ct.Results | None, why: str) -> tuple[str, bool]:
    """Reason that a message names, and whether the states of the run show it.

    Returns
    -------
    named : str
        ``"collapse"``, ``"limit point"``, or ``"none"``.
    right : bool
    """
    if results is None or len(results.frames) < 3:
        return "none", False
    if "plastic collapse:" in why:
        return "collapse", _soft(results) and _flowed(results)
    if why.startswith("limit point"):
        yields = "with yielding" not in why or _flowed(results)
        return "limit point", yields and _soft(results)
    return "none", False


def _soft(results: ct.Results) -> bool:
    """Whether displacements grow much faster with the load at the end of a step than at first.

    The slope of a limit point has no bound: the last two increments count.
    """
    last = [f for f in results.frames if f.step == results.frames[-1].step]
    u = [f.U for f in last]
    factor = np.array([f.factor for f in last])
    if len(last) < 3:
        return False
    way = np.array([np.abs(b - a).max() for a, b in zip(u, u[1:], strict=False)])
    rise = np.abs(np.diff(factor))
    known = rise > 0.0
    slope = way[known] / rise[known]
    return bool(len(slope) > 1 and slope[-2:].max() >= SOFT * slope[0])


def _flowed(results: ct.Results) -> bool:
    """Whether plastic work is a notable part of the internal energy."""
    of = results.frames[-1].scalars
    return float(of.get("ALLPD", 0.0)) >= FLOWED * abs(float(of.get("ALLIE", np.inf)))


__all__ = ["reason"]
