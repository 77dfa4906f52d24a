"""An increment of a static step by relaxation, where Newton's method finds none."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.increment_loop import Attempt
from corota.analysis.terms.contact.messages import sunk_corner
from corota.analysis.terms.contact.relaxation import relax
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.analysis.procedures.static import StaticStepper
    from corota.analysis.terms.contact.relaxation import Aid

#: Increments tried by relaxation where no shorter one is found, relative to the period.
RELAXED = (1e-3, 1e-2)
#: The same with drift, where none of these is found.
DRIFTED = (1e-3, 1e-2, 3e-2)
#: The same from where a damped motion brings the bodies to rest.
MOVED = (1e-3, 1e-2)
#: The same for first increments, in which bodies held only by contact come into contact.
FIRST_RELAXED = (1e-2, 3e-2, 0.1, 0.2, 0.3)
#: Halvings of the interval in which a first contact closes.
HALVINGS = 4


def by_relaxation(stepper: StaticStepper, early: bool) -> Attempt | str:
    """The increment by relaxation, where contact is driven by supports; or why it fails.

    With loads, the end of an equilibrium is a limit point, which the user has to
    assess; only the first equilibrium is sought, near the start. While increments may still
    be cut (`early`), a distant state is refused.
    """
    system, state, control = stepper.system, stepper.state, stepper.control
    first = stepper.loop.number == 1 and not control.number
    loaded = not stepper.may_relax()
    if loaded and (early or not first or not system.joined):
        return ""
    fractions: tuple[float, ...]
    aided: dict[Aid, tuple[float, ...]]
    if early or control.step.fixed_increments:
        fractions = (control.size / control.step.period,)
        aided = {"drift": fractions, "motion": fractions}
    else:
        fractions = FIRST_RELAXED if first else RELAXED
        aided = {"drift": FIRST_RELAXED if first else DRIFTED, "motion": MOVED}
    if early or loaded:
        aided = {}
    tries = _Sizes(fractions, aided, HALVINGS if first else 0)
    for fraction, aid in tries:
        size = fraction * control.step.period
        target = min([control.time + size, *(s for s in control.stops if s > control.time)])
        prescribed = system.conditions.supports.at(target, state.u)
        try:
            outcome, contact = relax(
                system,
                state.u,
                prescribed,
                target,
                stepper.settings,
                stepper.report,
                nearby=loaded,
                aid=aid,
            )
        except SingularError:
            continue
        # Unconstrained bodies that did not move are not in a first equilibrium.
        untouched = outcome.converged and first and not contact.presses
        if untouched or not outcome.converged:
            system.revert()
            tries.nothing_closed = untouched
            continue
        if early and not contact.near(outcome.u):
            system.revert()
            return ""
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
    tried = "neither relaxation nor a damped motion" if aided else "no relaxation"
    said = f"; {tried} from the last converged state found an equilibrium nearby"
    if sunk_corner(system):
        return said  # the message has the reason
    return f"{said}: the bodies snap or fold; use Dynamic to follow that"


class _Sizes:
    """Increments to try in turn, and what helps relaxation.

    Between the largest one that closes no contact and one without an equilibrium the first contact
    is found by bisection.

    Parameters
    ----------
    fractions : tuple of float
        Of the period, by relaxation alone.
    aided : dict of str to tuple of float
        The same with what helps it, in turn.
    halvings : int

    Attributes
    ----------
    nothing_closed : bool
        Set by the caller after a try: whether no contact has closed.
    """

    def __init__(
        self, fractions: tuple[float, ...], aided: dict[Aid, tuple[float, ...]], halvings: int
    ) -> None:
        self.fractions, self.aided, self.halvings = fractions, aided, halvings
        self.nothing_closed = False

    def __iter__(self) -> Iterator[tuple[float, Aid]]:
        low = 0.0
        for high in self.fractions:
            self.nothing_closed = False
            yield high, ""
            if self.nothing_closed:
                low = high
                continue
            for _ in range(self.halvings if low else 0):
                middle = 0.5 * (low + high)
                self.nothing_closed = False
                yield middle, ""
                low, high = (middle, high) if self.nothing_closed else (low, middle)
            low = 0.0
        for aid, fractions in self.aided.items():
            for fraction in fractions:
                yield fraction, aid


__all__ = ["by_relaxation"]
