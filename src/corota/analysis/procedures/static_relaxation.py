"""An increment of a static step by relaxation, where Newton's method finds none."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.increment_loop import Attempt

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.analysis.procedures.static import StaticStepper


#: Increments to try in turn, of the period: of the first one, in which bodies that contact alone
#: holds come into contact; and where an equilibrium has ended.
FIRST, LATER = (1e-2, 3e-2, 0.1, 0.2, 0.3), (1e-3, 1e-2)
#: Halvings of the interval in which a first contact closes.
HALVINGS = 4


def by_relaxation(stepper: StaticStepper) -> Attempt | str:
    """The increment by relaxation, where contact is driven by supports; or why it fails.

    With loads, the end of an equilibrium is a limit point, which the user has to
    assess; only the first equilibrium is sought, near the start.
    """
    system, state, control = stepper.system, stepper.state, stepper.control
    first = stepper.loop.number == 1 and not control.number
    loaded = not stepper.may_relax()
    if loaded and not (first and system.joined):
        return ""
    sizes: tuple[float, ...] = FIRST if first else LATER
    if control.step.fixed_increments:
        sizes = (control.size / control.step.period,)
    tries = _Sizes(sizes, first)
    for fraction in tries:
        size = fraction * control.step.period
        target = min([control.time + size, *(s for s in control.stops if s > control.time)])
        outcome, contact = stepper.relax(target, loaded)
        # Unconstrained bodies that did not move are not in a first equilibrium.
        untouched = outcome.converged and first and not contact.presses
        if untouched or not outcome.converged:
            system.revert()
            tries.nothing_closed = untouched
            continue
        if first:
            state.notes.append(
                f"step time {target:.6g}: at the start the bodies are supported by contact "
                f"alone, which was still open; this is the first equilibrium ({outcome.note})"
            )
        elif not contact.near(outcome.u):
            jump = float(np.abs(outcome.u - state.u)[~system.is_rotation].max())
            state.notes.append(
                f"step time {target:.6g}: the equilibrium ended (a snap, or a node past "
                f"a corner) and the bodies moved on to another one, by up to {jump:.3g} "
                f"({outcome.note}); it may be one of several: Dynamic follows the motion"
            )
        control.size = max(target - control.time, control.step.smallest_increment)
        return Attempt(target, outcome, contact)
    if loaded:
        return ""
    said = "; no relaxation from the last converged state found an equilibrium nearby"
    if system.wedges():
        return said  # the message has the reason
    return (
        f"{said}: the bodies snap or fold (Dynamic follows that), or supports press them into a "
        "place that is too small for them"
    )


class _Sizes:
    """Increments to try in turn.

    Between the largest first one that closes no contact and one without an equilibrium the first
    contact is found by bisection.

    Parameters
    ----------
    sizes : tuple of float
    first : bool
        Whether it is the first increment.

    Attributes
    ----------
    nothing_closed : bool
        Set by the caller after a try: whether no contact has closed.
    """

    def __init__(self, sizes: tuple[float, ...], first: bool) -> None:
        self.sizes, self.first = sizes, first
        self.nothing_closed = False

    def __iter__(self) -> Iterator[float]:
        low = 0.0
        for high in self.sizes:
            self.nothing_closed = False
            yield high
            if self.nothing_closed:
                low = high
                continue
            for _ in range(HALVINGS if low and self.first else 0):
                middle = 0.5 * (low + high)
                self.nothing_closed = False
                yield middle
                low, high = (middle, high) if self.nothing_closed else (low, middle)
            low = 0.0
