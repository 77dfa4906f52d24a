"""An increment with contact that Newton's method does not find, by relaxation to rest.

The equilibrium that an increment starts from may end: a node goes round a corner, a hook snaps. The
bodies then move through states that are not in equilibrium until they rest again. Here they creep:
a viscous force holds every node back in each correction, and fades as the residual does. It
is no part of the residual, so the state that is found is an equilibrium of the unregularized
problem, with the exact cone of friction. Which of several it is, the creep has chosen.

Source: C. T. Kelley, D. E. Keyes, *Convergence analysis of pseudo-transient continuation*, SIAM J.
Numer. Anal. 35 (1998).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.newton import ElementFailure, GiveUp, Outcome
from corota.analysis.terms.contact.equations import ContactEquations
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import ResidualNorms, Settings
    from corota.analysis.terms.contact.problem import ContactEvaluation

    Floats = NDArray[np.float64]

#: Most corrections, and those in a row that may fail.
MOST, FAILURES = 120, 12
#: Viscous stiffness per stiffness at the start: first, at most, and below which it is none.
FIRST, LARGEST, NONE = 0.3, 10.0, 1e-3
#: Residual below which the viscous stiffness fades fast.
CLOSE = 1e-3
#: Longest correction, in the shortest edge of a slave surface.
FARTHEST = 0.5


def relax(
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
) -> tuple[Outcome[Evaluation], ContactEquations]:
    """Find an equilibrium by a creep that fades.

    The parameters and results are those of
    :func:`corota.analysis.terms.contact.newton.newton_with_contact`.
    """
    problem = ContactEquations(system, system)
    problem.pivoting = problem.relaxing = True
    found = _creep(problem, system, u, prescribed, step_time, settings, report)
    return problem.settle(found), problem


def _creep(
    problem: ContactEquations,
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None,
) -> Outcome[ContactEvaluation]:
    z = problem.start(u)
    out: Outcome[ContactEvaluation] = Outcome(False, z, None)
    try:
        at = problem.evaluate(z, step_time)
    except ElementFailure as error:
        out.reason = str(error)
        return out
    brake = at.at.values.copy()
    constrained = np.concatenate([prescribed, z[problem.n :]]) - z
    edges = [float(p.slave.length.min()) for p in problem.contact_term.pairs]
    farthest = FARTHEST * min(edges)
    share, failed, before = FIRST, 0, np.inf
    out.sizes.append(problem.residual_norms(at, z).size)
    for iteration in range(1, MOST + 1):
        plain = at.at.values
        at.at.values = plain + share * brake
        try:
            dz, out.negative = problem.predict(at, constrained)
        except (SingularError, GiveUp) as error:
            at.at.values = plain
            share, failed = max(2.0 * share, FIRST), failed + 1
            if failed > FAILURES or share > LARGEST:
                out.reason = f"relaxation met a singular tangent ({error})"
                return out
            continue
        at.at.values = plain
        largest = float(np.abs(dz[: problem.n][~system.is_rotation]).max(initial=0.0))
        length = min(1.0, farthest / largest) if largest > 0.0 else 1.0
        try:
            there = z + length * dz
            next_at = problem.evaluate(there, step_time)
        except ElementFailure as error:
            share, failed = max(2.0 * share, FIRST), failed + 1
            farthest *= 0.5
            if failed > FAILURES:
                out.reason = f"relaxation: {error}"
                return out
            continue
        failed = 0
        z, at = there, next_at
        constrained = (1.0 - length) * constrained
        norms = problem.residual_norms(at, z)
        size = norms.size
        out.u, out.at, out.iterations = z, at, iteration
        out.sizes.append(size)
        if report is not None:
            report(iteration, norms, length * largest, f"relaxation, brake {share:.1g}")
        if not np.isfinite(size):
            out.reason = "the residual is not finite"
            return out
        if not constrained.any() and (
            size <= settings.tolerance
            or (norms.rounding(settings.tolerance) and size >= 0.1 * before)
        ):
            out.converged = True
            out.note = f"relaxed to rest in {iteration} corrections"
            return out
        share = _next(share, size, before, length)
        before = size
    out.reason = f"no rest in {MOST} corrections of relaxation (residual {out.sizes[-1]:.1e})"
    return out


def _next(share: float, size: float, before: float, length: float) -> float:
    """Viscous stiffness of the next correction."""
    if size < CLOSE and size < before and length == 1.0:
        return 0.1 * share if share > NONE else 0.0
    if size > max(before, CLOSE):
        return min(max(1.3 * share, 0.1 * FIRST), FIRST)
    return 0.8 * share if share > NONE else 0.0


__all__ = ["relax"]
