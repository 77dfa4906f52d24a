"""One increment with or without contact: Newton's method, first contact, error of an impact.

Time of first contact of separate surfaces, so that a dynamic increment can end there.

A wall does not act on a body in flight, and an increment limited only by its own error may end
at any depth behind it. The time to contact follows from gap, closing velocity and acceleration of
the body. At larger distance an increment covers most of the gap, because the estimate improves as
the surfaces approach; the last one ends a ten-thousandth of an edge behind the first contact.
Beyond the search distance there is no gap yet: an increment that passes through is refused and cut.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.analysis.failure import ElementFailure
from corota.analysis.newton import newton
from corota.analysis.rule import REST, Rule
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.gaps import CHANGES, OPEN, PATIENCE, covered
from corota.mesh.parts import part_of_nodes

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import Outcome, ResidualNorms, Settings
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.analysis.terms.contact.gaps import ContactState
    from corota.analysis.terms.contact.pair import Pair, Terms
    from corota.analysis.terms.inertia import MotionState
    from corota.arrays import Bools, Floats


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


def impact_error(
    term: ContactTerm,
    contact_state: ContactState,
    moved: Floats,
    energy: float,
    tolerance: float,
    meets: bool = False,
) -> float:
    """Error of an increment in the instant of impact, relative to the allowed one.

    Gaps that close within the increment: the work of contact within it, against a thousandth
    of the energy for a tolerance of one percent; where a rate condition keeps that at zero, the
    depth they are left with, against a tenth of an edge. Surfaces that meet for the first time:
    a hundredth of an edge, which is the depth, or the gap that the increment began with where it
    was not to end at their first touch.

    Parameters
    ----------
    moved : ndarray, shape (n_dofs,)
        Displacement of the increment.
    energy : float
        Of the motion [force*length].
    tolerance : float
        Of the step [1].
    meets : bool
        Whether the increment was to end where surfaces meet.
    """
    first = _first_contact(term, contact_state, meets) / tolerance
    if term.persistent:
        depth = 0.0
        for pair, terms in zip(term.pairs, contact_state.terms, strict=True):
            if pair.start is not None and pair.law is None and pair.n:
                deeper = np.minimum(pair.begun()[0], 0.0) - (terms.bare or terms).gap
                edge = float(pair.slave.length.mean())
                depth = max(depth, float((deeper / pair.full).max()) / edge)
        return max(first, 0.1 * depth / tolerance)
    work = float(contact_state.force @ moved)
    each = term.each(contact_state.terms, contact_state.multipliers)
    for k, (pair, terms, (_, q)) in enumerate(each):
        if pair.rubs:
            work -= float(q @ terms.slip)
        if pair.law is not None:
            before = 0.0 if term.at is None else pair.law_energy(term.at.terms[k])
            work += pair.law_energy(terms) - before
    return max(first, 10.0 * abs(work) / (tolerance * energy) if energy > 0.0 else 0.0)


def _first_contact(term: ContactTerm, contact_state: ContactState, meets: bool) -> float:
    """How late the first contact of surfaces is found [slave edges]."""
    late = 0.0
    before = term.at
    x = term.positions(term.u)
    each = term.each(contact_state.terms, contact_state.multipliers)
    for number, (pair, terms, (p, q)) in enumerate(each):
        if pair.tied or not pair.n or before is None or (meets and pair.start is None):
            continue
        begun = pair.gaps_at(term, number, x)
        apart = pair.apart(begun, before.states[number])
        if pair.start is not None:
            depth = -(terms.bare or terms).gap
        else:
            seen = covered(begun.area, pair.full)
            depth = np.where(seen & (pair.states(terms, p, q) != OPEN), begun.gap, 0.0)
        if pair.law is None and apart.any():
            depth = np.where(apart, depth / pair.full, 0.0)
            late = max(late, float(depth.max()) / float(pair.slave.length.mean()))
    return late


#: Error in the instant of impact: depth behind the first contact at which an increment ends [slave
#: edges].
BEYOND = 1e-4
#: Gap from which an increment leaves a remainder [slave edges], and the fraction left.
LEFT = 0.1


class Approach:
    """Times to contact of separate surfaces.

    Parameters
    ----------
    system : System
    massless : ndarray of bool, shape (n_dofs,)
        Displacements without mass; their accelerations are meaningless.

    Attributes
    ----------
    meets : bool
        Whether the last requested increment ends after a first contact.
    limited : bool
        Whether it was shortened.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"system", "term", "part", "heavy"})

    def __init__(self, system: System, massless: Bools) -> None:
        self.system, self.term = system, system.term(ContactTerm)
        self.meets = self.limited = False
        self.in_a_row = 0
        #: Displacement of the last increment by node and its time; velocities of nodes without
        #: mass oscillate about it.
        self.moved, self.dt = np.zeros((0, 3)), 0.0
        mesh = system.model.mesh
        opens = self.term.opens
        part = part_of_nodes(mesh) if opens else np.full(mesh.n_nodes, -1, np.int64)
        heavy = np.zeros(len(part), bool)
        heavy[system.node_of_dof[~massless & ~system.is_rotation]] = True
        #: Body of each node, -1 for none, and the nodes whose mean acceleration is the body's.
        self.part, self.heavy = part, heavy & (part >= 0)
        #: Nodes of bodies, bodies of heavy nodes, and how many each body has of these.
        self.known, self.owner = part >= 0, part[self.heavy]
        self.count = np.bincount(self.owner, minlength=part.max(initial=-1) + 1)

    def within(self, now: MotionState, dt: float, least: float) -> float:
        """The increment, or the shorter one that ends at first contact [time]."""
        self.meets = self.limited = False
        term = self.term
        # Surfaces may also pass closely.
        if not term.opens or self.in_a_row >= PATIENCE:
            return dt
        x, acceleration = term.positions(term.u), self._accelerations(now)
        rates, until = self._rates(now, acceleration), dt
        for number, pair in enumerate(term.pairs):
            if pair.tied:
                continue
            terms = pair.gaps_at(term, number, x)
            apart = pair.apart(terms, None if term.at is None else term.at.states[number])
            if not apart.any():
                continue
            seen = apart & covered(terms.area, pair.full)
            time, meets = _time_to_contact(pair, terms, seen, rates, acceleration)
            if time < until:
                until, self.meets, self.limited = time, meets, True
        return max(until, min(least, dt))

    def follow(self, before: Floats, after: Floats, dt: float) -> None:
        """Record an accepted increment between displacements of shape (n_dofs,)."""
        if not self.term.opens:
            return
        self.in_a_row = self.in_a_row + 1 if self.limited else 0
        self.moved, self.dt = self.system.by_node(after - before), dt
        self.meets = self.limited = False

    def _accelerations(self, now: MotionState) -> Floats:
        """Mean acceleration of the body of each node, shape (n_nodes, 3)."""
        out = self.system.by_node(now.a)
        if not len(self.owner):
            return out
        inner, size = self.part[self.known], np.maximum(self.count, 1)
        for i in (0, 1):
            sums = np.bincount(self.owner, out[self.heavy, i], len(self.count))
            out[self.known, i] = (sums / size)[inner]
        out[:, 2] = 0.0
        return out

    def _rates(self, now: MotionState, acceleration: Floats) -> Floats:
        """Velocity of each node, shape (n_nodes, 3)."""
        out = self.system.by_node(now.v)
        if self.dt:
            mean = self.moved[:, :2] / self.dt + 0.5 * self.dt * acceleration[:, :2]
            out[self.known, :2] = mean[self.known]
        return out


def _time_to_contact(
    pair: Pair, terms: Terms, seen: Bools, rates: Floats, acceleration: Floats
) -> tuple[float, bool]:
    """Time to the end of the next increment towards contact, and whether contact begins there."""
    if not seen.any():
        return np.inf, False
    area = np.where(seen, terms.area, 1.0)
    edge = float(pair.slave.length.mean())
    gap = terms.gap / area
    if pair.law is not None:
        gap = gap + pair.law.start

    def rate(of: Floats) -> Floats:
        part = (terms.gap_gradient * of.ravel()[terms.variables]).sum(axis=1)
        return -np.bincount(terms.constraint, part, pair.n) / area

    speed, growth = rate(rates), rate(acceleration)
    wide = gap > LEFT * edge
    way = np.where(wide, (1.0 - LEFT) * gap, gap + BEYOND * edge)
    # Schemes that close gaps at the end of an increment may start with such small gaps.
    least = pair.noise if pair.start is not None else BEYOND * edge
    square = speed**2 + 2.0 * growth * way
    root = speed + np.sqrt(np.maximum(square, 0.0))
    meets = seen & (gap > least) & (square >= 0.0) & (root > 0.0)
    if not meets.any():
        return np.inf, False
    time = np.where(meets, 2.0 * way / np.where(meets, root, 1.0), np.inf)
    first = int(np.argmin(time))
    return float(time[first]), not bool(wide[first])
