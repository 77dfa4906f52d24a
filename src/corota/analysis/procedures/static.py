"""A static step: increments of Newton's method until the end of the step."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.increments import Increments
from corota.analysis.newton import Outcome, Settings
from corota.analysis.procedures.path.arc_length import path_step
from corota.analysis.procedures.stopping import at_limit, collapse, driven, reason
from corota.analysis.terms.contact.newton import solve_increment
from corota.analysis.terms.contact.relaxation import relax
from corota.errors import (
    ConvergenceError,
    Interrupted,
    ModelError,
    SingularError,
)
from corota.model.paths import ArcLength
from corota.results.observer import Iteration

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import Evaluation, System
    from corota.analysis.newton import ResidualNorms
    from corota.analysis.observers import Observers
    from corota.analysis.state import State
    from corota.analysis.terms.contact.newton import ContactIncrement
    from corota.model.steps import Static

    Floats = NDArray[np.float64]

#: Failed attempts under growing negative pivots after which a limit point is looked for.
STALLED = 3
#: Increments that are tried by relaxation where none that is shorter is found, of the period.
RELAXED = (1e-3, 1e-2)
#: Attempt from which an increment is tried by relaxation before it is cut further.
RESTS = 4


def static_step(
    system: System,
    step: Static,
    number: int,
    state: State,
    observers: Observers,
    save: Callable[[State, int, float, dict[str, float]], None],
    stops: list[float],
) -> None:
    """Run a static step from the committed state; `save` is told every accepted increment.

    Raises
    ------
    ConvergenceError
        With the reason, when no smaller increment helps.
    SingularError
        If the structure is not held.
    """
    if not state.resumes:
        state.step_time = 0.0
        state.stand_still()
    if step.path is not None:
        path_step(system, step, number, state, observers, save, step.path)
        return
    control = Increments(step, stops)
    settings = Settings(step.tolerance, step.max_iterations)
    first = rate = 0.0  # displacement per time, of the first increment and the last
    if state.resumes == "path":
        _go_along_path(system, step, number, state, observers, save, control, (0.0, 0.0))
        return
    if state.resumes:
        loop = state.resume("static", control=control)
        first, rate = loop["first"], loop["rate"]
    while not control.finished:
        if control.number >= step.max_increments:
            raise ConvergenceError(
                f"step {number} used its {step.max_increments} increments at step time "
                f"{control.time:g} of {step.period:g}; allow more (INC=) or longer ones"
            )
        target = control.target()
        # Temperatures that change need a new evaluation.
        heated = system.free.expands and not system.free.follows(
            system.conditions.temperatures(target)
        )
        report = iteration_reporter(observers, system, number, control)
        prescribed = system.conditions.prescribed(target, state.u)
        try:
            outcome, contact = solve_increment(
                system,
                system,
                state.u,
                prescribed,
                target,
                settings,
                report,
                known=None if heated else state.at,
                last_chance=step.fixed_increments,
            )
        except SingularError as error:
            if number == 1 and control.number == 0:
                raise
            outcome = Outcome(False, state.u, None, reason=f"the tangent is singular: {error}")
        count = state.counters
        count["iterations"] = count.get("iterations", 0) + outcome.iterations
        if outcome.converged and (problem := system.scales.senseless(outcome.u)):
            outcome.converged, outcome.reason = False, problem
        grown = 0.0
        if outcome.converged and step.plastic_increment:
            grown = system.plastic_increment()
            if grown > step.plastic_increment:
                outcome.converged = False
                outcome.reason = (
                    f"the equivalent plastic strain grew by {grown:.3g}, "
                    f"{step.plastic_increment:g} is allowed in one increment"
                )
        if not outcome.converged:
            count["cut-backs"] = count.get("cut-backs", 0) + 1
            state.failed = outcome
            softer = outcome.negative > max(state.negative, 0)
            end = control.cut(target)
            early = control.attempt == RESTS and not end
            if (end or early) and (
                rested := _relaxed(system, control, state, settings, report, early)
            ) is not None:
                outcome, contact, target = rested
                count["iterations"] += outcome.iterations
        if not outcome.converged:
            if (end or (softer and control.attempt > STALLED)) and _go_along_path(
                system, step, number, state, observers, save, control, (first, rate)
            ):
                return
            if end:
                raise ConvergenceError(
                    reason(system, number, control, outcome, state, end, (first, rate))
                )
            observers.cut_back(
                number, control.number + 1, control.attempt - 1, outcome.reason, control.size
            )
            continue
        state.notes += contact.accept(outcome.u, target)
        dt = target - control.time
        rate = float(np.abs(outcome.u - state.u).max(initial=0.0)) / dt
        first = first or rate
        _accept(system, state, outcome, target)
        attempts = control.attempt
        control.accept(target, outcome.iterations)
        if grown > 0.0 and not step.fixed_increments:
            control.size = min(control.size, dt * step.plastic_increment / grown)
        scalars: dict[str, float] = {
            "dt": dt,
            "iterations": float(outcome.iterations),
            "attempts": float(attempts),
            "residual": outcome.sizes[-1],
            "external work": state.energies.work if state.energies else 0.0,
        }
        if outcome.negative >= 0:
            scalars["negative pivots"] = float(outcome.negative)
            scalars["stable"] = float(outcome.negative == 0)
        state.loop = {"kind": "static", "control": control, "first": first, "rate": rate}
        save(state, control.number, target / step.period, scalars)
        if observers.stop_requested:
            raise Interrupted(
                f"stopped at step {number}, step time {target:g}; everything up to there is kept"
            )


def _relaxed(
    system: System,
    control: Increments,
    state: State,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None,
    early: bool,
) -> tuple[Outcome[Evaluation], ContactIncrement, float] | None:
    """The increment by relaxation, where contact is driven by supports; None where it fails.

    Where loads drive, an equilibrium that ends is a limit point, which is for the user to judge.
    While increments may still be cut (`early`), what is far away is not taken.
    """
    if not (system.contact_term.acts and control.number):
        return None
    period = control.step.period
    force, _ = system.load_rate(state.u)
    if np.any(force):
        return None
    sizes = [control.size] if early or control.step.fixed_increments else []
    for size in sizes or [share * period for share in RELAXED]:
        target = min([control.time + size, *(s for s in control.stops if s > control.time)])
        prescribed = system.conditions.prescribed(target, state.u)
        try:
            outcome, contact = relax(system, state.u, prescribed, target, settings, report)
        except SingularError:
            continue
        if outcome.converged and early and not contact.near(outcome.u):
            system.contact_term.restore()
            return None
        if outcome.converged:
            jump = float(np.abs(outcome.u - state.u)[~system.is_rotation].max())
            if not contact.near(outcome.u):
                state.notes.append(
                    f"step time {target:.6g}: the equilibrium before ended and the bodies moved "
                    f"on to another, by up to {jump:.3g} ({outcome.note}); statics has no path "
                    "between, and there may be others: Dynamic follows the motion"
                )
            control.size = max(target - control.time, control.step.smallest_increment)
            return outcome, contact, target
    return None


def _go_along_path(
    system: System,
    step: Static,
    number: int,
    state: State,
    observers: Observers,
    save: Callable[[State, int, float, dict[str, float]], None],
    control: Increments,
    rates: tuple[float, float],
) -> bool:
    """Go on by arc length from where load control stalls; False where that is no help.

    Raises
    ------
    ConvergenceError
        At the limit point, unless the step is to follow the path beyond it.
    """
    if system.contact_term.damped.any():
        return False  # damping needs a time
    try:
        system.conditions.check_proportional()
    except ModelError:
        return False
    path = ArcLength(factor=1.0, stop_at_limit=step.at_limit == "stop")
    along = replace(
        step,
        path=path,
        increments=0,
        first_increment=max(control.size, step.smallest_increment),
        largest_increment=0.0,
        fixed_increments=False,
    )
    before, here = control.number, state.u
    kept = [control.time / step.period]

    def keep(state: State, increment: int, factor: float, scalars: dict[str, float]) -> None:
        if len(kept) == 1:
            text = (
                f"load control stalls at load factor {kept[0]:.6g}; arc length takes over from "
                f"increment {before + 1} (column 'arc length' of the histories): the load factor "
                "adapts, and step time only counts on within the period"
            )
            state.notes.append(f"step {number}: {text}")
            observers.note(number, text)
        kept.append(factor)
        save(state, increment, factor, scalars)

    try:
        limit = path_step(
            system,
            along,
            number,
            state,
            observers,
            keep,
            path,
            factor=control.time / step.period,
            increment=before,
            takes_over=True,
            rates=rates,
        )
    except (ConvergenceError, SingularError, ModelError) as error:
        if state.u is not here:
            # The states that the path found are kept: there the step stops.
            factor = kept[-1]
            said = str(error).removesuffix(". All converged increments are kept")
            fails = ""
            if not driven(system, step, state):
                fails = collapse(system, number, factor, rates, said)
            raise ConvergenceError(
                f"{fails + '. ' if fails else ''}step {number} stopped at step time "
                f"{factor * step.period:g} of {step.period:g} (load factor {factor:.6g}): "
                f"{said}. All converged increments are kept"
            ) from None
        return False
    state.counters["arc length took over"] = 1
    if limit is None:
        return True
    raise ConvergenceError(at_limit(system, step, number, limit.factor, state))


def _accept(system: System, state: State, outcome: Outcome[Evaluation], target: float) -> None:
    new = outcome.at
    assert new is not None
    assert state.energies is not None
    state.energies.add_quasi_static(outcome.u, state.u, new)
    if state.at is not None:
        system.return_tangent(state.at)
    system.commit()
    state.u, state.at, state.failed = outcome.u, new, None
    state.step_time = target
    state.negative = outcome.negative


def iteration_reporter(
    observers: Observers, system: System, number: int, control: Increments
) -> Callable[[int, ResidualNorms, float, str], None] | None:
    """Pass Newton's iterations on to the observers, if there are any."""
    if not observers.each:
        return None

    def report(iteration: int, norms: ResidualNorms, correction: float, note: str) -> None:
        observers.iteration(
            Iteration(
                number,
                control.number + 1,
                control.attempt,
                iteration,
                norms.force,
                norms.moment,
                correction,
                int(system.node_of_dof[norms.worst]),
                int(system.component[norms.worst]),
                note,
            )
        )

    return report
