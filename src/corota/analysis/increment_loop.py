"""The one loop over the increments of a step.

A procedure provides a stepper, which takes one increment at a time. The loop does what all have in
common: the limit of increments, output, checkpoints, and stops requested by observers.
Steppers that use Newton's method also share attempts and cut-backs.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from corota.analysis.increments import CUT, Increments
from corota.analysis.newton import newton
from corota.analysis.rule import REST, Rule
from corota.analysis.state_tree import UnsuitableState
from corota.errors import ConvergenceError, Interrupted
from corota.lazy import lazy
from corota.results.observer import Iteration

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import Outcome, ResidualNorms, Settings
    from corota.analysis.observers import Observers
    from corota.analysis.state import State
    from corota.analysis.terms.contact.gaps import ContactState
    from corota.arrays import Floats
    from corota.model.steps import Dynamic, Static, Step

    Save = Callable[[State, int, float, dict[str, float]], None]
    Report = Callable[[int, ResidualNorms, float, str], None]

contact_equations = lazy("corota.analysis.terms.contact.equations:ContactEquations")

#: Advice where a step has used all its increments.
MORE_OR_LONGER = "allow more (INC=) or longer ones"


@dataclass
class Accepted:
    """An accepted increment for output.

    Parameters
    ----------
    number : int
        Of the increment in its step, from 1.
    factor : float
        Load factor, or share of the period.
    scalars : dict of str to float
        Scalars of its frame.
    """

    number: int
    factor: float
    scalars: dict[str, float]


class Stepper(ABC):
    """The part of a step that depends on the procedure.

    Attributes
    ----------
    kind : str
        Name of the procedure's state in checkpoints; empty where it cannot be resumed.
    advice : str
        Advice where the step has used all its increments; empty where it has no such limit.
    remembered : tuple of str
        Attributes that a checkpoint holds beside the committed state.
    taken : int
        Increments so far.
    """

    kind = advice = ""
    remembered: ClassVar[tuple[str, ...]] = ()
    taken = 0
    state: State

    @property
    @abstractmethod
    def finished(self) -> bool:
        """Whether the step is at its end."""

    @property
    @abstractmethod
    def where(self) -> str:
        """Progress of the step in words."""

    @abstractmethod
    def advance(self) -> Accepted | None:
        """Take increments up to the next one for output; None at the end of the step.

        Raises
        ------
        ConvergenceError
            With the reason, when no smaller increment helps.
        """

    def memory(self) -> dict[str, object]:
        """State of the stepper beside the committed state, by name."""
        return {name: getattr(self, name) for name in self.remembered}

    def resume(self) -> None:
        """Take the state of a checkpoint."""
        loop = self.state.resume(self.kind, **self.memory())
        missing = [name for name in self.remembered if name not in loop]
        if missing:
            raise UnsuitableState(f"it has no {missing[0]!r}")
        for name in self.remembered:
            setattr(self, name, loop[name])


class IncrementLoop:
    """The increments of one step.

    Parameters
    ----------
    number : int
        Of the step, from 1.
    save : callable
        Called with state, increment, load factor and scalars of every increment for output.
    """

    def __init__(
        self,
        system: System,
        step: Step,
        number: int,
        state: State,
        observers: Observers,
        save: Save,
    ) -> None:
        self.system, self.step, self.number, self.state = system, step, number, state
        self.observers, self.save = observers, save

    def show_start(self, scalars: dict[str, float]) -> None:
        """Output the initial state of an analysis that starts in motion, as increment 0."""
        if self.number == 1 and not self.state.resumes:
            self.save(self.state, 0, 0.0, scalars)

    def run(self, stepper: Stepper) -> None:
        """Take increments to the end of the step.

        Raises
        ------
        ConvergenceError
            If the step needs more increments than it may take, or one cannot be taken.
        Interrupted
            If an observer requests a stop.
        """
        most = self.step.max_increments if stepper.advice else math.inf
        while not stepper.finished:
            if stepper.taken >= most:
                raise ConvergenceError(
                    f"step {self.number} used its {most} increments at {stepper.where}; "
                    f"{stepper.advice}"
                )
            shown = stepper.advance()
            if shown is None:
                return
            self.state.loop = {"kind": stepper.kind, **stepper.memory()} if stepper.kind else None
            self.save(self.state, shown.number, shown.factor, shown.scalars)
            if self.observers.stop_requested:
                raise Interrupted(
                    f"stopped at step {self.number}, {stepper.where}; all results up to there are "
                    "kept"
                )

    def count(self, what: str, more: int = 1) -> None:
        """Add to a counter of the analysis."""
        self.state.counters[what] = self.state.counters.get(what, 0) + more

    def cut_back(self, increment: int, attempt: int, reason: str, size: float) -> None:
        """Tell observers of an attempt that failed, and of the size of the next."""
        self.observers.cut_back(self.number, increment, attempt, reason, size)

    def iteration(
        self,
        increment: int,
        attempt: int,
        iteration: int,
        norms: ResidualNorms,
        correction: float,
        note: str = "",
        size: float = 0.0,
        factor: float = 0.0,
    ) -> None:
        """Tell observers of an iteration."""
        self.observers.iteration(
            Iteration(
                self.number,
                increment,
                attempt,
                iteration,
                norms.force,
                norms.moment,
                correction,
                int(self.system.node_of_dof[norms.worst]),
                int(self.system.component[norms.worst]),
                note,
                size,
                factor,
            )
        )


class ContactIncrement(Protocol):
    """Contact of a solved increment, which a model without it has as well."""

    contact_state: ContactState | None

    @property
    def force(self) -> Floats:
        """Of contact on the nodes at its end, shape (n_dofs,)."""

    def accept(self, u: Floats, step_time: float) -> list[str]:
        """Commit contact with the increment; returns remarks that are new."""


class NoContact:
    """An increment of a model without pairs and ties.

    Parameters
    ----------
    n_dofs : int
    """

    contact_state: ContactState | None = None

    def __init__(self, n_dofs: int) -> None:
        self.force: Floats = np.zeros(n_dofs)

    def accept(self, u: Floats, step_time: float) -> list[str]:
        """Nothing to commit."""
        return []


def solve_increment(
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Report | None = None,
    known: Evaluation | None = None,
    last_chance: bool = False,
    rule: Rule = REST,
) -> tuple[Outcome, ContactIncrement]:
    """Newton's method on displacements and, with contact or ties, on their multipliers.

    Parameters
    ----------
    system : System
    u, prescribed, step_time, settings, report
        As for :func:`corota.analysis.newton.newton`.
    known : Evaluation, optional
        Without contact at `u` and an earlier time: its tangent is the first one.
    last_chance : bool
        Whether no shorter increment may follow: the attempt is then not given up early.
    rule : Rule
        What the increment makes of its unknowns.

    Returns
    -------
    outcome : Outcome
        In terms of the system; the internal force holds that of contact.
    contact : ContactIncrement
        Its ``accept`` commits contact, once the increment is taken.
    """
    if system.n_multipliers:
        equations = contact_equations(system, rule)
        solved = equations.solve_increment(
            u, prescribed, step_time, settings, report, known, last_chance
        )
        return solved, equations
    begin = None if known is None else system.with_loads(known, u, step_time)
    outcome = newton(system, u, prescribed, step_time, settings, begin, report, rule)
    return outcome, NoContact(system.n_dofs)


@dataclass
class Attempt:
    """Result of Newton's method for an increment.

    Parameters
    ----------
    target : float
        Step time at its end [time].
    contact : ContactIncrement or None
        None where nothing was solved.
    reason : str
        Why it is refused; empty if it is accepted.
    share : float
        Share of its size that is tried next, if it is refused.
    """

    target: float
    outcome: Outcome
    contact: ContactIncrement | None
    reason: str = ""
    share: float = CUT


class NewtonStepper(Stepper):
    """Increments solved by Newton's method, cut back on failure.

    Parameters
    ----------
    stops : list of float
        Step times that must be hit exactly.
    """

    advice = MORE_OR_LONGER

    def __init__(self, loop: IncrementLoop, step: Static | Dynamic, stops: list[float]) -> None:
        self.loop, self.control = loop, Increments(step, stops)
        self.system, self.state = loop.system, loop.state

    @property
    def finished(self) -> bool:
        return self.control.finished

    @property
    def taken(self) -> int:  # type: ignore[override]
        return self.control.number

    @property
    def where(self) -> str:
        return f"step time {self.control.time:g} of {self.control.step.period:g}"

    def target(self) -> float:
        """Target step time of the next attempt [time]."""
        return self.control.target()

    @abstractmethod
    def solve(self, target: float) -> Attempt:
        """Attempt an increment that ends at a step time."""

    def rescue(self, failed: Attempt, end: str) -> Attempt | None:
        """Another method for the next increment, or None; `end`: why it cannot be shorter, if so.

        At the end of the step it leaves the stepper `finished`.
        """
        return None

    @abstractmethod
    def refusal(self, failed: Attempt, end: str) -> str:
        """Message where no increment is left to try."""

    @abstractmethod
    def accept(self, attempt: Attempt) -> Accepted:
        """Commit an increment."""

    @property
    def report(self) -> Report | None:
        """Reports an iteration of the current attempt to observers, if there are any."""
        if not self.loop.observers.each:
            return None
        control = self.control

        def report(iteration: int, norms: ResidualNorms, correction: float, note: str) -> None:
            self.loop.iteration(
                control.number + 1, control.attempt, iteration, norms, correction, note
            )

        return report

    def advance(self) -> Accepted | None:
        """Take one increment, after as many attempts as it needs."""
        loop, control = self.loop, self.control
        while True:
            attempt = self.solve(self.target())
            loop.count("iterations", attempt.outcome.iterations)
            if not attempt.reason:
                return self.accept(attempt)
            near = loop.system.constraints.near_their_limit(loop.state.u)
            if near and near not in attempt.reason:
                attempt.reason = f"{attempt.reason}; {near}"
            loop.count("cut-backs")
            loop.state.failed = attempt.outcome
            end = control.cut(attempt.target, attempt.share)
            rescued = self.rescue(attempt, end)
            if rescued is not None:
                loop.count("iterations", rescued.outcome.iterations)
                return self.accept(rescued)
            if self.finished:
                return None
            if end:
                raise ConvergenceError(self.refusal(attempt, end))
            loop.cut_back(control.number + 1, control.attempt - 1, attempt.reason, control.size)
