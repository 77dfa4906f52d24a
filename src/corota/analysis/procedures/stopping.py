"""Why a static step stopped, with advice that fits the step."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from corota.model.plasticity import Mises

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.increments import Increments
    from corota.analysis.newton import Outcome
    from corota.analysis.state import State
    from corota.model.steps import Static, Step

#: Growth of the displacement per load since the first increment that indicates collapse.
SOFT = 10.0
#: And growth that is none: the load stays the same but for rounding.
ENDLESS = 1e6
#: Words that identify a tangent without stiffness.
FREE = "can move freely"


def driven(system: System, step: Step, state: State) -> bool:
    """Whether supports move in the step."""
    constrained = system.conditions.constrained
    ends = [system.conditions.supports.at(t, state.u)[constrained] for t in (0.0, step.period)]
    return bool(np.any(ends[0] != ends[1]))


def at_limit(system: System, step: Static, number: int, factor: float, state: State) -> str:
    """Message of a limit point."""
    moves = driven(system, step, state)
    yielding = ", with yielding (plastic collapse, unless its shape snaps)" * (
        not moves and _yields(system)
    )
    way = system.gives_way()
    return (
        f"limit point at load factor {factor:.6g} of step {number}{yielding}: the structure "
        f"cannot carry more load in this equilibrium{way and f' ({way})'}. The states up to it are "
        f"kept; to continue, {remedies(moves, follow=step.at_limit == 'stop')}"
    )


def remedies(moves: bool, follow: bool = False) -> str:
    """How to continue beyond a limit point or a jump.

    Parameters
    ----------
    moves : bool
        Whether supports drive the step.
    follow : bool
        Whether the step may follow its path.
    """
    found = []
    if follow:
        found.append(
            "follow the path (Static(path=ArcLength(...)) or at_limit='follow', *STATIC, RIKS)"
        )
    if not moves:
        found.append("prescribe a displacement instead of the load")
    found.append("compute the jump as dynamics")
    return ", ".join(found[:-1]) + f", or {found[-1]}" if len(found) > 1 else found[0]


def collapse(
    system: System, step: Step, number: int, factor: float, rates: tuple[float, float], why: str
) -> str:
    """Message on plastic collapse under loads, or on creep without end; empty if there is none.

    Parameters
    ----------
    rates : tuple of float
        Displacement per unit of time in the first increment of the step (where materials creep:
        the smallest one) and in the last.
    why : str
        Why the last attempt failed: where all yields at once, by a mechanism.
    """
    if any(term.fades for term in system.terms):
        return ""  # a body moves away at the end of its damping: not a collapse
    grown = rates[1] / rates[0] if rates[0] > 0.0 else 0.0
    if step.lasting and system.creeps:
        if grown <= SOFT:
            return ""
        return (
            f"creep accelerates without end: at step time {factor * step.period:.6g} of step "
            f"{number} displacements grow {grown:.3g} times as fast as at their slowest; the "
            "structure does not bear its load for longer"
        )
    if not _yields(system) or not (grown > SOFT or (grown > 0.0 and FREE in why)):
        return ""
    # At a load that stays the same it is infinite.
    finite = SOFT < grown < ENDLESS
    how = f", with displacements that grow {grown:.0f} times as fast as initially" * finite
    return (
        f"plastic collapse: the limit load of step {number} is reached at load factor "
        f"{factor:.6g}{how}; yielding makes the structure a mechanism that cannot carry more"
    )


def plateau(system: System) -> float:
    """Longest flow at a stress that rises again behind it, over the elastic strain."""
    laws = [b.section.material for b in system.blocks if isinstance(b.section.material, Mises)]
    return max(
        (
            (end - begin) * law.E / stress
            for law in laws
            for (stress, begin), (same, end) in pairwise((law.yield_curve or [])[:-1])
            if same == stress
        ),
        default=0.0,
    )


def passed(number: int, between: tuple[float, float], negative: int) -> str:
    """Where an increment lost stability, from the inertia at its ends."""
    return (
        f"between step times {between[0]:.6g} and {between[1]:.6g} of step {number} a bifurcation "
        f"or limit point was passed (negative pivots of the tangent: {negative})"
    )


def unstable(state: State) -> str:
    """Message on an unstable last equilibrium; empty if it is stable."""
    if state.negative <= 0:
        return ""
    return (
        f". The last equilibrium is unstable (negative pivots of the tangent: {state.negative}): "
        "a real structure snaps or tips over before it"
    )


def _yields(system: System) -> bool:
    laws = [b.section.material for b in system.blocks]
    return any(isinstance(m, Mises) and (m.yield_curve or m.yield_stress) for m in laws)


def explanation(
    system: System,
    number: int,
    control: Increments,
    outcome: Outcome,
    state: State,
    end: str,
    rates: tuple[float, float],
) -> str:
    """Message with cause, place and advice.

    Parameters
    ----------
    rates : tuple of float
        As of :func:`collapse`.
    """
    period = control.step.period
    moves = driven(system, control.step, state)
    instead = "; compute the jump as dynamics" if moves else "; prescribe a displacement instead"
    instead += "" if moves else " of the load"
    where = (
        f"step {number} stopped at step time {control.time:g} of {period:g} "
        f"(load factor {control.time / period:.6g}): {end}; last attempt: {outcome.reason}"
    )
    collapses = (
        ""
        if moves
        else collapse(system, control.step, number, control.time / period, rates, outcome.reason)
    )
    if collapses:
        where = f"{collapses}: {end}; last attempt: {outcome.reason}"
    if outcome.at is not None:
        norms = system.residual_norms(outcome.at, outcome.u)
        where += f"; largest residual at {system.describe(norms.worst)}"
    if collapses and control.step.lasting and system.creeps:
        where += ". The load must be smaller, or the period shorter"
    elif state.negative > 0:
        where += unstable(state) + instead
    elif outcome.negative > 0:
        where += (
            f". The tangent has {outcome.negative} negative "
            f"pivot{'s' if outcome.negative > 1 else ''}: a limit or bifurcation point is just "
            f"ahead, where the structure cannot carry more{instead}"
        )
    elif collapses:
        where += ". To continue beyond it, prescribe a displacement instead of the load"
    return (
        where + ". All converged increments are kept; the last attempt "
        "is results.last_iterate (corota plot JOB.vtkhdf --last-iterate)"
    )
