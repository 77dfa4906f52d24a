"""An increment of a static step by relaxation, where Newton's method finds none."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from corota.analysis.increment_loop import Attempt
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.analysis.procedures.static import StaticStepper


class Rung(NamedTuple):
    """A way to the next equilibrium where Newton's method finds none.

    Parameters
    ----------
    motion : bool
        Whether it starts where a damped motion brings the bodies to rest.
    first : tuple of float
        Increments to try, of the period: of the first one, in which bodies that contact alone
        holds come into contact.
    later : tuple of float
        And where an equilibrium has ended.
    """

    motion: bool
    first: tuple[float, ...]
    later: tuple[float, ...]


#: Tried in turn. Of 286 torture problems relaxation solves an increment in 26, the damped motion in
#: 5 of the 8 in which relaxation alone fails.
LADDER: tuple[Rung, ...] = (
    Rung(False, (1e-2, 3e-2, 0.1, 0.2, 0.3), (1e-3, 1e-2)),
    Rung(True, (1e-3, 1e-2), (1e-3, 1e-2)),
)
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
    ladder = LADDER
    if control.step.fixed_increments:
        whole = (control.size / control.step.period,)
        ladder = tuple(Rung(rung.motion, whole, whole) for rung in LADDER)
    if loaded:
        ladder = tuple(rung for rung in ladder if not rung.motion)
    tries = _Sizes(ladder, first)
    for fraction, motion in tries:
        size = fraction * control.step.period
        target = min([control.time + size, *(s for s in control.stops if s > control.time)])
        try:
            outcome, contact = stepper.relax(target, loaded, motion)
        except SingularError:
            continue
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
    tried = "neither relaxation nor a damped motion" if len(ladder) > 1 else "no relaxation"
    said = f"; {tried} from the last converged state found an equilibrium nearby"
    if system.wedges():
        return said  # the message has the reason
    return (
        f"{said}: the bodies snap or fold (Dynamic follows that), or supports press them into a "
        "place that is too small for them"
    )


class _Sizes:
    """Increments to try in turn, and whether a damped motion begins.

    Between the largest first one that closes no contact and one without an equilibrium the first
    contact is found by bisection.

    Parameters
    ----------
    first : bool
        Whether it is the first increment.

    Attributes
    ----------
    nothing_closed : bool
        Set by the caller after a try: whether no contact has closed.
    """

    def __init__(self, ladder: tuple[Rung, ...], first: bool) -> None:
        self.ladder, self.first = ladder, first
        self.nothing_closed = False

    def __iter__(self) -> Iterator[tuple[float, bool]]:
        for rung in self.ladder:
            low = 0.0
            for high in rung.first if self.first else rung.later:
                self.nothing_closed = False
                yield high, rung.motion
                if self.nothing_closed and not rung.motion:
                    low = high
                    continue
                for _ in range(HALVINGS if low and self.first else 0):
                    middle = 0.5 * (low + high)
                    self.nothing_closed = False
                    yield middle, rung.motion
                    low, high = (middle, high) if self.nothing_closed else (low, middle)
                low = 0.0
