"""Newton's method for one increment, with or without contact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure
from corota.analysis.newton import newton
from corota.analysis.rule import REST, Rule
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.gaps import CHANGES, PATIENCE

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import Outcome, ResidualNorms, Settings
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.arrays import Floats


class NoContact:
    """An increment of a model without pairs and ties, as one with (`ContactEquations`).

    Parameters
    ----------
    n_dofs : int
    """

    def __init__(self, n_dofs: int) -> None:
        self.force: Floats = np.zeros(n_dofs)

    def accept(self, u: Floats, step_time: float) -> list[str]:
        """Nothing to commit."""
        return []

    def impact_error(self, moved: Floats, energy: float, tolerance: float, meets: bool) -> float:
        """No contact, no impact."""
        return 0.0


if TYPE_CHECKING:
    #: Contact results of a solved increment for a procedure.
    ContactIncrement = ContactEquations | NoContact


def solve_increment(
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
    known: Evaluation | None = None,
    last_chance: bool = False,
    rule: Rule = REST,
) -> tuple[Outcome, ContactIncrement]:
    """Newton's method on displacements and, with contact, on its multipliers.

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
    term = system.term(ContactTerm)
    if not term.pairs:
        begin = None if known is None else system.with_loads(known, u, step_time)
        outcome = newton(system, u, prescribed, step_time, settings, begin, report, rule)
        return outcome, NoContact(system.n_dofs)
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.analysis.terms.contact.output import pressures

    problem = ContactEquations(system, rule)
    problem.inherit_kink()
    n = system.n_dofs
    z = problem.start(u)
    target = np.concatenate([prescribed, z[n:]])
    most = settings.max_iterations + CHANGES
    patience = 0 if last_chance else PATIENCE
    more = replace(settings, max_iterations=most, patience=patience, reuse=None)
    start = None
    if known is not None:
        with contextlib.suppress(ElementFailure):  # which Newton's method reports
            start = problem.evaluate(z, step_time, rule)
            start.values[:] = known.values
            # Stabilizing damping of this increment.
            for added, sign in ((known.added, -1.0), (start.added, 1.0)):
                if added is not None:
                    system.pattern.add_diagonal(start.values, sign * added)
    fluids = system.conditions.fluids
    if fluids:
        known_terms = None if term.at is None else term.at.terms
        system.conditions.begin_fluids(*pressures(term, known_terms, term.committed), u)
        start = None
    found = newton(problem, z, target, step_time, more, start, report, rule)
    while fluids and found.converged and found.at is not None:
        state = found.at.contact_state
        contact = pressures(term, state.terms, state.multipliers)
        if not system.conditions.advance_fluids(*contact, found.u[:n], step_time):
            break
        problem.go_on()
        again = newton(problem, found.u, target, step_time, more, None, report, rule)
        again.iterations += found.iterations
        found = again
    return problem.settle(found), problem
