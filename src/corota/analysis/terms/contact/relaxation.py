"""Solve an increment with contact by pseudo-transient continuation, where Newton's method fails.

The equilibrium that an increment starts from may end: a node passes a corner, a hook snaps. The
bodies then creep through a pseudo-time until they rest again: springs hold every node at its last
position, the bodies move to where their forces and those of the springs balance, the springs
follow, and become softer from position to position. Implicit Euler for a viscous motion is the
same, with steps that grow as it comes to rest.

Where surfaces change what they meet, gaps may jump, and a position without overlap that balances
may not exist on either side. As in Moreau's time stepping, the conditions on the way are therefore
those on rates: surfaces that touch or overlap do not approach each other any more, and a small part
of the overlap is removed at each position. For the same reason a position between stiff springs is
accepted where a few corrections do not balance it.

At last Newton's method without springs, with all conditions of contact, starts from where the
bodies rest, so the state that is found is an equilibrium of the unregularized problem, with the
exact cone of friction. If there are several, the creep selects one.

Sources: C. T. Kelley and D. E. Keyes, *Convergence analysis of pseudo-transient continuation*, SIAM
J. Numer. Anal. 35 (1998); J. J. Moreau, *Unilateral contact and dry friction in finite freedom
dynamics* (1988).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure, GiveUp
from corota.analysis.newton import Outcome, newton
from corota.analysis.rule import REST, Rule
from corota.analysis.terms.contact.equations import ContactEquations
from corota.analysis.terms.contact.gaps import PATIENCE, SMALL, WAITED
from corota.analysis.terms.contact.pair import UNSEEN
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import ResidualNorms, Settings
    from corota.arrays import Floats


#: Limit of corrections in a relaxation.
MOST = 400
#: Pseudo-time: first stiffness of the springs per stiffness of their nodes. The largest is the
#: inverse of its square.
FIRST = 1e-2
#: Factor on this stiffness after a position was reached; the inverse of its square where none was.
EASED = 0.5
#: What counts as small on the way: the residual of a position, and the stiffness of springs over
#: that of their nodes. Between stiffer springs only a jump of gaps or of their gradients leaves a
#: larger residual, and the position is accepted.
ERROR = 0.1
#: Fraction of an overlap that is removed at each position.
REMOVED = 0.05


def relax(
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
    rule: Rule = REST,
    nearby: bool = False,
) -> tuple[Outcome, ContactEquations]:
    """Find an equilibrium by creep; in dynamics (by its `rule`) with the inertia of an increment.

    The other parameters and the results are those of
    :func:`corota.analysis.increment_loop.solve_increment`.

    Parameters
    ----------
    nearby : bool
        Whether no node may move farther than half of the shortest edge of the slave surfaces.
    """
    creep = _Creep(system, rule, step_time, settings, report)
    return creep.settle(creep.run(u, prescribed, nearby)), creep


class _Creep(ContactEquations):
    """The positions of one relaxation."""

    def __init__(
        self,
        system: System,
        rule: Rule,
        step_time: float,
        settings: Settings,
        report: Callable[[int, ResidualNorms, float, str], None] | None,
    ) -> None:
        super().__init__(system, rule)
        self.step_time, self.report = step_time, report
        most = settings.max_iterations + WAITED * PATIENCE
        self.settings = replace(settings, max_iterations=most, patience=PATIENCE, reuse=None)
        #: Corrections of all positions.
        self.made = 0
        #: What is said of the equilibrium that is found.
        self.said = ""
        edges = [float(pair.slave.length.min()) for pair in self.term.pairs]
        self.farthest = UNSEEN * min(edges)

    def run(self, u: Floats, prescribed: Floats, nearby: bool) -> Outcome:
        """Positions until one needs no springs."""
        self.z, self.left = self.start(u), np.append(prescribed - u, np.zeros(self.term.n))
        share, reason = FIRST, ""
        while self.made < MOST and share <= FIRST**-2:
            failed = self._place(share)
            if failed:
                share, reason = share / EASED**2, failed
                continue
            share = FIRST if self.left.any() else share * EASED
            if nearby and self._leaves(self.z):
                break
            if share >= SMALL:
                continue
            out = self._at_rest()
            if out.converged and nearby and self._leaves(out.u):
                break
            if out.converged:
                out.iterations = self.made
                out.note = f"found by relaxation in {self.made} iterations{self.said}"
                return out
            share, reason = SMALL / EASED**WAITED**2, out.reason
        reason = (
            f"relaxation found no equilibrium in {self.made} iterations"
            f"{f' ({reason})' if reason else ''}"
        )
        return Outcome(False, self.z, None, self.made, reason=reason)

    def _leaves(self, z: Floats) -> bool:
        """Whether a position is farther from the start than it may be."""
        return self.largest(z[: self.n] - self.origin) > self.farthest

    def _begin(self) -> None:
        """Begin corrections from the last position, with its states; slips count from there."""
        self.forget(self.last)
        self.since = self.z[: self.n].copy()
        # In dynamics rates are those of the whole increment.
        self.term.slip_start = None if self.rule.moves else self.since

    def _place(self, share: float) -> str:
        """Move to the next position, with springs of a fraction of the nodal stiffness.

        Returns why there is none; empty if there is.
        """
        states = self.last
        self._begin()
        assert self.since is not None
        self.pivoting = True
        self.term.springs = (share * self.term.nodal, self.since)
        try:
            reason = self._corrected(share)
        except (ElementFailure, GiveUp, SingularError) as error:
            reason = str(error)
        if reason:
            self.last = states
        return reason

    def _corrected(self, share: float) -> str:
        """Corrections of one position."""
        z, removed = self.z, REMOVED
        far = self.largest(self.left)
        part = min(1.0, 0.5 * self.farthest / far) if far > 0.0 else 1.0
        left = part * self.left
        at = self.evaluate(z, self.step_time, self.rule)
        for _ in range(PATIENCE):
            self._keep_overlap(at, removed)
            dz, _ = self.correct(at, -at.residual, left)
            z, left, removed = z + dz, np.zeros_like(left), 0.0
            self.made += 1
            if not self.largest(z - self.z) <= self.farthest:
                return "the bodies move too far at once"
            at = self.evaluate(z, self.step_time, self.rule)
            self._keep_overlap(at, 0.0)
            norms = self.residual_norms(at, z)
            if self.report is not None:
                note = f"relaxation, springs {share:.1g}; {norms.note}".strip("; ")
                self.report(self.made, norms, self.largest(dz), note)
            if norms.size <= ERROR:
                break
        else:
            if share < ERROR:
                return f"no convergence in {PATIENCE} iterations (residual {norms.size:.1e})"
        reason = self.refuse(at, z)
        if not reason:
            self.z, self.left = z, (1.0 - part) * self.left
        return reason

    def _keep_overlap(self, at: Evaluation, removed: float) -> None:
        """Make the conditions those on rates: of an overlap, only a part is a gap to close."""
        if self.rule.moves:
            return  # inertia takes the bodies past a jump
        for pair, terms in zip(self.term.pairs, at.contact_state.terms, strict=True):
            if not pair.tied and pair.law is None:
                terms.gap = terms.gap - (1.0 - removed) * np.minimum(terms.gap, 0.0)

    def _at_rest(self) -> Outcome:
        """An equilibrium without springs, by Newton's method from the last position.

        Friction acts against the slips of the whole increment. Where no equilibrium with these is
        found, as behind a jump, friction of the way is over, and slips count from the position.
        """
        out = self._unsprung(None)
        if out.converged or self.rule.moves or not any(pair.rubs for pair in self.term.pairs):
            return out
        out = self._unsprung(self.z[: self.n].copy())
        if out.converged and out.at is not None:
            self._count_slips(out.at, out.u)
            self.said = ", with friction against slips from the position of rest"
        return out

    def _unsprung(self, slip_start: Floats | None) -> Outcome:
        states, before = self.last, self.made
        self._begin()
        self.term.springs, self.term.slip_start = None, slip_start

        def report(iteration: int, norms: ResidualNorms, correction: float, note: str) -> None:
            self.made = before + iteration
            if self.report is not None:
                said = f"relaxation, no springs; {note}".strip("; ")
                self.report(self.made, norms, correction, said)

        z, time = self.z, self.step_time
        try:
            out = newton(self, z, z, time, self.settings, None, report, self.rule)
        except SingularError as error:
            out = Outcome(False, z, None, reason=f"singular tangent: {error}")
            self.made += 1
        if out.converged and out.at is not None:
            out.reason = self.refuse(out.at, out.u)
            out.converged = not out.reason
        if not out.converged:
            self.last = states
        return out

    def _count_slips(self, at: Evaluation, z: Floats) -> None:
        """Take the slips of the whole way, of which friction did work."""
        term, state = self.term, at.contact_state
        term.slip_start = None
        rates = [(pair.rate, pair.friction) for pair in term.pairs]
        whole = term.evaluate(z[: self.n], state.multipliers, state.time, np.zeros(0))
        for terms, of_way in zip(state.terms, whole.terms, strict=True):
            terms.slip = of_way.slip
        for pair, (rate, friction) in zip(term.pairs, rates, strict=True):
            pair.rate, pair.friction = rate, friction
