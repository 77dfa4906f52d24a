"""Solve an increment with contact by relaxation, where Newton's method fails.

The equilibrium that an increment starts from may end: a node passes a corner, a hook snaps. The
bodies then move through states that are not in equilibrium until they rest again. Here they creep:
springs hold every node at its last position, all contact conditions are satisfied with them,
the springs are released, and so on with softer ones (a proximal point method). The last
correction has none, so the state that is found is an equilibrium of the unregularized problem, with
the exact cone of friction. If there are several, the creep selects one.

Source: R. T. Rockafellar, *Monotone operators and the proximal point algorithm*, SIAM J. Control
Optim. 14 (1976).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.newton import Outcome, newton
from corota.analysis.terms.contact.equations import (
    MAX_EXTRA_CONTACT_ITERATIONS,
    PATIENCE,
    ContactEquations,
)
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import ResidualNorms, Settings
    from corota.analysis.terms.contact.problem import ContactEvaluation

    Floats = NDArray[np.float64]

#: Largest number of corrections, of those per position, and residual at which a position is
#: reached.
MOST, EACH, REACHED = 400, 14, 1e-6
#: Stiffness of the springs per stiffness of their nodes: first, at most, at least.
FIRST, LARGEST, LEAST = 1e-2, 1e2, 1e-6
#: Factors on it after a position was reached in few corrections, in more, or not at all; limit of
#: few.
EASED, KEPT, TIGHTENED, FEW = 0.25, 0.5, 8.0, 6
#: Largest distance between positions, in shortest edges of a slave surface.
FARTHEST = 0.5


def relax(
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
    inner: Any = None,
    nearby: bool = False,
) -> tuple[Outcome[Evaluation], ContactEquations]:
    """Find an equilibrium by creep; in dynamics (`inner`) with the inertia of an increment.

    The parameters and results are those of
    :func:`corota.analysis.terms.contact.newton.solve_increment`; with `nearby`, no node may move
    farther than half of the shortest edge of the slave surfaces.
    """
    creep = _Creep(inner or system, system, u, prescribed, step_time, settings, report)
    if nearby:
        creep.within = u.copy()
    return creep.problem.settle(creep.run()), creep.problem


class _Creep:
    """The positions of one relaxation."""

    def __init__(
        self,
        inner: Any,
        system: System,
        u: Floats,
        prescribed: Floats,
        step_time: float,
        settings: Settings,
        report: Callable[[int, ResidualNorms, float, str], None] | None,
    ) -> None:
        self.system, self.step_time, self.report = system, step_time, report
        self.problem = ContactEquations(inner, system)
        self.z = self.problem.start(u)
        self.left = prescribed - u  # that supports still have to move
        most = settings.max_iterations + MAX_EXTRA_CONTACT_ITERATIONS
        self.last = replace(settings, max_iterations=most, patience=PATIENCE, reuse=None)
        tolerance = max(REACHED, settings.tolerance)
        self.each = replace(self.last, tolerance=tolerance, max_iterations=EACH)
        self.corrections = 0
        #: Displacements that the bodies have to stay near.
        self.within: Floats | None = None
        edges = [float(p.slave.length.min()) for p in self.problem.contact_term.pairs]
        self.farthest = FARTHEST * min(edges)
        self.stiffness = self.problem.contact_term.nodal

    def run(self) -> Outcome[ContactEvaluation]:
        share, tries = FIRST, 0
        while self.corrections < MOST and share <= LARGEST:
            out = self._place(share)
            moved = self._moved(out.u, self.z)
            if out.converged and out.at is not None:
                out.reason = self.problem.refuse(out.at, out.u)
            if not out.converged or out.reason or moved > self.farthest:
                share *= TIGHTENED
                continue
            if self._leaves(out.u):
                break
            self.z, self.left = out.u, np.zeros_like(self.left)
            share *= EASED if out.iterations <= FEW else KEPT
            if share >= LEAST:
                continue
            out = self._place(0.0)
            if out.converged and self._leaves(out.u):
                break
            if out.converged:
                out.iterations = self.corrections
                out.note = f"found by relaxation in {self.corrections} iterations"
                return out
            share, tries = LEAST * TIGHTENED**2, tries + 1
            if tries > 2:
                break
        out.converged = False
        out.iterations = self.corrections
        out.reason = (
            f"relaxation found no equilibrium in {self.corrections} iterations ({out.reason})"
        )
        return out

    def _moved(self, z: Floats, since: Floats) -> float:
        """Largest displacement of a node between two positions [length]."""
        n, turns = self.problem.n, self.system.is_rotation
        return float(np.abs(z[:n] - since[:n])[~turns].max())

    def _leaves(self, z: Floats) -> bool:
        """Whether a position is farther from the start than it may be."""
        return self.within is not None and self._moved(z, self.within) > self.farthest

    def _place(self, share: float) -> Outcome[ContactEvaluation]:
        """The next position, with springs of a fraction of the nodal stiffness."""
        problem, n = self.problem, self.problem.n
        states = problem.last
        problem.forget()
        problem.last, problem.relaxing = states, True
        problem.since = self.z[:n].copy()
        if share:
            problem.brake = (share * self.stiffness, problem.since)
        target = self.z.copy()
        target[:n] += self.left
        settings = self.each if share else self.last
        before = self.corrections

        def report(iteration: int, norms: ResidualNorms, correction: float, note: str) -> None:
            self.corrections = before + iteration
            if self.report is not None:
                said = f"relaxation, springs {share:.1g}" if share else "relaxation, no springs"
                self.report(self.corrections, norms, correction, f"{said}; {note}".strip("; "))

        try:
            out = newton(problem, self.z, target, self.step_time, settings, None, report)
        except SingularError as error:
            out = Outcome(False, self.z, None, reason=f"singular tangent: {error}")
            self.corrections += 1
        if not out.converged:
            problem.last = states
        return out


__all__ = ["relax"]
