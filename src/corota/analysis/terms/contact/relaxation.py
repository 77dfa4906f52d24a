"""Solve an increment with contact by relaxation, where Newton's method fails.

The equilibrium that an increment starts from may end: a node passes a corner, a hook snaps. The
bodies then move through states that are not in equilibrium until they rest again. Here they creep:
springs hold every node at its last position, all contact conditions are satisfied with them,
the springs are released, and so on with softer ones (a proximal point method). The last
correction has none, so the state that is found is an equilibrium of the unregularized problem, with
the exact cone of friction. If there are several, the creep selects one.

Where surfaces change what they meet, gaps may jump, and a position that balances may not exist on
either side. Then no springs are stiff enough: an explicit damped motion brings the bodies to rest,
and Newton's method starts from there.

Source: R. T. Rockafellar, *Monotone operators and the proximal point algorithm*, SIAM J. Control
Optim. 14 (1976).

The damped motion is dynamic relaxation: central differences with a diagonal mass for which the
increment 1 is stable. Velocities are set to zero at every peak of the kinetic energy. Contact acts
by forward-increment multipliers. Nothing is committed, and stresses are those of one increment from
the committed state.

Sources: P. Underwood, *Dynamic relaxation*, in: Computational Methods for Transient Analysis
(1983); P. A. Cundall, *Explicit finite difference methods in geomechanics* (1976), for kinetic
damping.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.energies import Energies
from corota.analysis.failure import ElementFailure
from corota.analysis.newton import Outcome, newton
from corota.analysis.rule import REST, Rule
from corota.analysis.terms.contact.equations import ContactEquations
from corota.analysis.terms.contact.gaps import PATIENCE, SAME, SMALL, WAITED
from corota.analysis.terms.contact.motion import ForwardContact
from corota.analysis.terms.contact.pair import UNSEEN
from corota.errors import ConvergenceError, SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.newton import ResidualNorms, Settings
    from corota.analysis.terms.contact.pair import Terms
    from corota.arrays import Floats


#: Limit of corrections in a relaxation.
MOST = 400
#: Proximal point method: first stiffness of the springs per stiffness of their nodes. The largest
#: is its inverse; the least, `SMALL`, has forces within the tolerance of a position.
FIRST = 1e-2
#: Factors on this stiffness after a position was reached, and where none was. The mass of a damped
#: motion grows by the inverse of the first where an element fails.
EASED, TIGHTENED = 0.25, 8.0


def relax(
    system: System,
    u: Floats,
    prescribed: Floats,
    step_time: float,
    settings: Settings,
    report: Callable[[int, ResidualNorms, float, str], None] | None = None,
    rule: Rule = REST,
    nearby: bool = False,
    motion: bool = False,
) -> tuple[Outcome, ContactEquations]:
    """Find an equilibrium by creep; in dynamics (by its `rule`) with the inertia of an increment.

    The other parameters and the results are those of
    :func:`corota.analysis.increment_loop.solve_increment`.

    Parameters
    ----------
    nearby : bool
        Whether no node may move farther than half of the shortest edge of the slave surfaces.
    motion : bool
        Whether the bodies start where a damped motion brings them to rest.
    """
    creep = _Creep(rule, system, u, prescribed, step_time, settings, report)
    if nearby:
        creep.within = u.copy()
    return creep.problem.settle(creep.run(motion)), creep.problem


class _Creep:
    """The positions of one relaxation."""

    def __init__(
        self,
        rule: Rule,
        system: System,
        u: Floats,
        prescribed: Floats,
        step_time: float,
        settings: Settings,
        report: Callable[[int, ResidualNorms, float, str], None] | None,
    ) -> None:
        self.system, self.step_time, self.report = system, step_time, report
        self.problem = ContactEquations(system, rule)
        self.z = self.problem.start(u)
        self.left = prescribed - u  # that supports still have to move
        most = settings.max_iterations + WAITED * PATIENCE
        self.last = replace(settings, max_iterations=most, patience=PATIENCE, reuse=None)
        tolerance = max(SMALL, settings.tolerance)
        self.each = replace(self.last, tolerance=tolerance)
        self.corrections = 0
        #: Displacements that the bodies have to stay near.
        self.within: Floats | None = None
        #: Whether a damped motion has brought the bodies to where they are.
        self.moved = False
        edges = [float(p.slave.length.min()) for p in self.problem.term.pairs]
        self.edge = min(edges)
        self.farthest = UNSEEN * self.edge
        self.stiffness = self.problem.term.nodal

    def run(self, motion: bool) -> Outcome:
        """Positions until one needs no springs."""
        if motion:
            out = self._from_rest()
            if out.converged or not self.moved:
                return out
        share, tries = FIRST, 0
        while self.corrections < MOST and share <= 1.0 / FIRST:
            out = self._place(share)
            moved = self._largest(out.u - self.z)
            if out.converged and out.at is not None:
                out.reason = self.problem.refuse(out.at, out.u)
            if not out.converged or out.reason or moved > self.farthest:
                share *= TIGHTENED
                continue
            if self._leaves(out.u):
                break
            self.z, self.left = out.u, np.zeros_like(self.left)
            share *= EASED
            if share >= SMALL:
                continue
            out = self._place(0.0)
            if out.converged and self._leaves(out.u):
                break
            if out.converged:
                return self._found(out)
            share, tries = SMALL * TIGHTENED**2, tries + 1
            if tries > 2:
                break
        return self._missed(out)

    def _found(self, out: Outcome) -> Outcome:
        out.iterations = self.corrections
        by = "a damped motion and relaxation" if self.moved else "relaxation"
        out.note = f"found by {by} in {self.corrections} iterations"
        return out

    def _missed(self, out: Outcome) -> Outcome:
        out.converged = False
        out.iterations = self.corrections
        out.reason = (
            f"relaxation found no equilibrium in {self.corrections} iterations ({out.reason})"
        )
        return out

    def _from_rest(self) -> Outcome:
        """An equilibrium without springs, from where a damped motion brings the bodies to rest."""
        problem, n, term = self.problem, self.problem.n, self.problem.term
        begin, left = self.z, self.left
        reason = "a damped motion did not bring the bodies to rest"
        out: Outcome = Outcome(False, begin, None, reason=reason)
        for remains in REMAINS:
            rest = come_to_rest(problem, begin[:n], left, self.step_time, self.edge, remains)
            if rest is None:
                term.revert()
                continue
            self.moved = True
            self.z, self.left = np.concatenate([rest.u, rest.multipliers]), np.zeros_like(left)
            problem.last = [states.copy() for states in rest.states]
            term.slip_start = rest.u  # friction of the motion is over
            out = self._place(0.0)
            if out.converged and out.at is not None:
                out.reason = self.problem.refuse(out.at, out.u)
                out.converged = not out.reason
            if out.converged:
                return self._found(out)
        return out if self.moved else self._missed(out)

    def _largest(self, change: Floats) -> float:
        """Largest displacement of a change of the unknowns [length]."""
        return float(np.abs(change[: self.problem.n])[~self.system.is_rotation].max())

    def _leaves(self, z: Floats) -> bool:
        """Whether a position is farther from the start than it may be."""
        if self.within is None:
            return False
        return self._largest(z[: self.problem.n] - self.within) > self.farthest

    def _place(self, share: float) -> Outcome:
        """The next position, with springs of a fraction of the nodal stiffness."""
        problem, n, rule = self.problem, self.problem.n, self.problem.rule
        states = problem.last
        problem.forget()
        problem.last, problem.relaxing = states, True
        problem.since = self.z[:n].copy()
        if share:
            problem.term.springs = (share * self.stiffness, problem.since)
        target = self.z.copy()
        target[:n] += self.left
        settings = self.each if share else self.last
        before = self.corrections

        def report(iteration: int, norms: ResidualNorms, correction: float, note: str) -> None:
            self.corrections = before + iteration
            if self.report is not None:
                said = "relaxation after a damped motion" if self.moved else "relaxation"
                said += f", springs {share:.1g}" if share else ", no springs"
                self.report(self.corrections, norms, correction, f"{said}; {note}".strip("; "))

        try:
            out = newton(problem, self.z, target, self.step_time, settings, None, report, rule)
        except SingularError as error:
            out = Outcome(False, self.z, None, reason=f"singular tangent: {error}")
            self.corrections += 1
        if not out.converged:
            problem.last = states
        return out


#: Dynamic relaxation: largest number of increments in which the unbalanced force does not halve.
STALLED = 1500
#: Complementarity tolerance of rest: unbalanced force over the largest force.
AT_REST = 1e-4
#: Dynamic relaxation: increments between two updates of the mass.
UPDATE = 50
#: Stability of central differences: mass over the least one by Gershgorin's bound.
SAFETY = 2.0
#: Fraction of an overlap that remains after an increment: all of it, as in central differences, or
#: less. A gap that jumps back and forth has no position of rest if the overlap is removed.
REMAINS = (1.0, 0.95)
#: Largest growth of the mass before the motion is given up.
HEAVIEST = 1e3
#: Longest displacement of supports in an increment, in shortest edges of a slave surface.
LONGEST_STEP = 0.02


@dataclass
class Rest:
    """A position at which the bodies rest.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    multipliers : ndarray, shape (n_multipliers,)
    states : list of ndarray
        Of contact; no node slips any more.
    """

    u: Floats
    multipliers: Floats
    states: list[NDArray[np.int8]]


class _Forces(ForwardContact):
    """Contact of a motion that is not part of the analysis: nothing is counted or committed."""

    multipliers: Floats
    remains = 1.0

    def _count(self, *_: object) -> None:
        """No work."""

    def _commit(
        self,
        u: Floats,
        found: list[Terms],
        multipliers: Floats,
        force: Floats,
        size: Floats,
        time: float,
    ) -> None:
        self.multipliers = multipliers
        self.depth = [self.remains * depth for depth in self.depth]


def come_to_rest(
    problem: ContactEquations,
    u: Floats,
    left: Floats,
    step_time: float,
    edge: float,
    remains: float = 1.0,
) -> Rest | None:
    """Move from a position until the bodies rest; None if they do not.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    left : ndarray, shape (n_dofs,)
        Displacement that supports still have to make.
    step_time : float
        Step time of the loads and of the position of rest.
    edge : float
        Shortest edge of the slave surfaces [length].
    remains : float
        Fraction of an overlap that remains after an increment.
    """
    system = problem.system
    if system.link.couples:
        return None  # eliminated dofs make the mass matrix full
    held = system.conditions.constrained
    u, v = u.copy(), np.zeros_like(u)
    contact = _Forces(system, Energies(system), 1.0)
    contact.remains = remains
    parts = max(1, int(np.ceil(float(np.abs(left).max()) / (LONGEST_STEP * edge))))
    mass, heavier = np.ones_like(u), 1.0
    kinetic, least, since = 0.0, np.inf, parts
    i = 0
    while True:  # the force halves until the bodies rest, or does not
        driven = left / parts if i < parts else np.zeros_like(u)
        try:
            at = system.evaluate(u, step_time)
            if i % UPDATE == 0:
                mass = heavier * _stable_mass(system, at.values)
            inverse = np.where(held, 0.0, 1.0 / mass)
            free = np.where(held, driven, v - inverse * at.residual)
            before = np.where(held, driven, v)
            force = contact.act(u, v, free, before, 1.0, inverse, step_time)
        except ElementFailure:
            # The motion was too fast: it goes on from rest where it came from, with more mass.
            heavier, mass = heavier / EASED, mass / EASED
            if heavier > HEAVIEST:
                return None
            u, v, kinetic = np.where(held, u, u - v), np.where(held, v, 0.0), 0.0
            continue
        except ConvergenceError:
            return None
        unbalanced = np.where(held, 0.0, at.residual - force)
        largest = max(float(np.abs(at.internal).max()), float(np.abs(force).max()))
        rest = float(np.abs(unbalanced).max())
        if i >= parts and rest <= AT_REST * largest:
            return Rest(u, contact.multipliers, contact.state)
        if i >= parts and rest < 0.5 * least:
            least, since = rest, i
        if i > since + STALLED:
            return None
        v = np.where(held, driven, v - inverse * unbalanced)
        last, kinetic = kinetic, float((mass * v * v)[~held].sum())
        if i >= parts and kinetic < last:
            v, kinetic = np.zeros_like(v), 0.0
        u, i = u + v, i + 1


def _stable_mass(system: System, values: Floats) -> Floats:
    """Diagonal mass for which the increment 1 is stable, shape (n_dofs,).

    The largest eigenvalue of M^-1 K is at most the largest sum of a row, over the mass of the row.
    """
    rows: Floats = system.pattern.multiply(np.abs(values), np.ones(system.n_dofs))
    out: Floats = 0.25 * SAFETY * np.maximum(rows, SAME * rows.max())
    return out
