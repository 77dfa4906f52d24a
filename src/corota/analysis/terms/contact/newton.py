"""Newton's method with contact, for the procedures that have it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.newton import ElementFailure, newton

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import Evaluation, System
    from corota.analysis.newton import Outcome, ResidualNorms, Settings
    from corota.analysis.terms.contact.equations import ContactEquations

    Floats = NDArray[np.float64]


def newton_with_contact(
    inner: Any,
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
    weight: float = 1.0,
    tangent: Floats | None = None,
    last_chance: bool = False,
) -> tuple[Outcome[Evaluation], ContactEquations]:
    """Newton's method on displacements and multipliers of contact.

    Parameters
    ----------
    inner : System, or a motion around it
        What gives residual and tangent without contact.
    system : System
    u, prescribed, step_time, settings, report
        As for :func:`corota.analysis.newton.newton`.
    weight : float
        Share of the contact forces in the residual.
    tangent : ndarray, shape (nnz,), optional
        Tangent of the committed increment to start with.
    last_chance : bool
        Whether no shorter increment may follow: nothing is given up early then.

    Returns
    -------
    outcome : Outcome
        In terms of the system; the internal force holds that of contact.
    touching : TouchingSystem
        Its ``accept`` commits contact, once the increment is taken.
    """
    from corota.analysis.terms.contact.equations import (
        MAX_EXTRA_CONTACT_ITERATIONS,
        PATIENCE,
        ContactEquations,
    )

    problem = ContactEquations(inner, system, weight)
    n = system.n_dofs
    z = problem.start(u)
    target = np.concatenate([prescribed, z[n:]])
    most = settings.max_iterations + MAX_EXTRA_CONTACT_ITERATIONS
    more = replace(settings, max_iterations=most, patience=0 if last_chance else PATIENCE)
    start = None
    if tangent is not None:
        with contextlib.suppress(ElementFailure):  # which Newton's method reports
            start = problem.evaluate(z, step_time)
            start.at.values[:] = tangent
    outcome = newton(problem, z, target, step_time, more, start, report)
    return problem.settle(outcome), problem


__all__ = ["newton_with_contact"]
