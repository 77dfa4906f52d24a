"""Contact in motion: forces of central differences, first contact, error of an impact.

Central differences have forward-increment Lagrange multipliers: contact forces at the beginning of
an increment make its end fit the surfaces (Carpenter, Taylor and Katona 1991). With the
displacement that the motion would have without them,

    gap + dt G v + dt^2 G M^-1 G^T p >= 0,    p >= 0,

and the same for the slip and Coulomb's bound. Gaps and gradients are those of the beginning,
so that forces conserve linear and angular momentum to rounding; errors of second order in the
increment are corrected in the next one. A pressure law takes the mean ``(g0 + 2 g1 + g2) / 4`` of
three gaps, which keeps energy; where it is too stiff for the increment, the gap at its end, as if
there were none. Both are stable.

Implicit increments end where separate surfaces meet: a wall does not act on a body in flight, and
an increment limited only by its own error may end at any depth behind it. The time to contact
follows from gap, closing velocity and acceleration of the body. At larger distance an increment
covers most of the gap, because the estimate improves as the surfaces approach. Beyond the search
distance there is no gap yet: an increment that passes through is refused and cut.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import corota._core as _core
from corota._core import CLOSED, OPEN
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.gaps import (
    AT_ONCE,
    COMPLIANCE,
    PATIENCE,
    SMALL,
    WAITED,
    ContactState,
    covered,
)
from corota.errors import ConvergenceError
from corota.mesh.parts import part_of_nodes

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.energies import Energies
    from corota.analysis.equations import System
    from corota.analysis.linear.types import Kind
    from corota.analysis.terms.contact.pair import Pair, Terms
    from corota.analysis.terms.inertia import MotionState
    from corota.arrays import Bools, Floats, Ints

    States = NDArray[np.int8]
    #: Pressures of constraints at their gaps, and their derivatives.
    Law = Callable[[Floats], tuple[Floats, Floats]]


class ForwardContact:
    """Contact pairs and ties in a step of central differences.

    Parameters
    ----------
    system : System
    account : Energies
    dt : float
        Increment [time].
    """

    def __init__(self, system: System, account: Energies, dt: float) -> None:
        self.account, self.dt = account, dt
        contact = self.contact = system.term(ContactTerm)
        #: Of each pair, overlap that is not removed [length]: that at the beginning of contact,
        #: which remains until the gap opens; states, and signs of the tractions that slip.
        self.depth = [np.zeros(pair.n) for pair in contact.pairs]
        self.state = [np.full(pair.n, OPEN, np.int8) for pair in contact.pairs]
        self.sense = [np.ones(pair.n if pair.two else 0) for pair in contact.pairs]
        #: Work of the forces of the last state in the first half of what follows.
        self.pending = 0.0
        self.rubbed = [0.0] * len(contact.pairs)
        if contact.pairs and account.impact is None:
            account.impact = 0.0

    def act(
        self,
        u: Floats,
        moved: Floats,
        ahead: Floats,
        before: Floats,
        share: float,
        inverse: Floats,
        time: float,
    ) -> Floats:
        """Contact forces at a state, committed with it.

        Parameters
        ----------
        u, moved : ndarray, shape (n_dofs,)
            Displacement, and the increment that ended at it.
        ahead, before : ndarray, shape (n_dofs,)
            Increment that follows without contact, and what it would be if no force acted on free
            dofs.
        share : float
            Of the increment that the forces act over: 1, or 1/2 at the start of a motion.
        inverse : ndarray, shape (n_dofs,)
            Inverse mass, zero where nothing moves by force.
        time : float
            Step time.

        Returns
        -------
        ndarray, shape (n_dofs,)

        Raises
        ------
        ConvergenceError
            If two fixed surfaces are pressed into each other, or no forces are found.
        """
        contact, system = self.contact, self.contact.system
        if not contact.pairs:
            return np.zeros(system.n_dofs)
        with system.timed("contact"):
            x, found = contact.positions(u), []
            for pair, (p, _) in zip(contact.pairs, contact.parts(contact.committed), strict=True):
                # Coefficients of friction are those at the slip rates of the increment before.
                pair.rub(contact.number, 1.0, p)
                pair.core.offset = contact.offset_at(pair, time)
                found.append(pair.evaluate(x, x, system.nlgeom))
            problem = _Increment(self, found, ahead, before, share, inverse, time)
            multipliers = problem.solve()
            force, size = contact.forces(found, multipliers)
            self._count(problem, multipliers, force, moved, ahead + problem.pushed)
            states = [state.copy() for state in self.state]
            for pair, state in zip(contact.pairs, states, strict=True):
                pair.core.commit()
                pair.keep_closed(state)
            contact.u, contact.committed, contact.time = u.copy(), multipliers, time
            contact.at = ContactState(
                found, force, size, multipliers, states=states, acting=found, where=x
            )
        return force

    def sums(self) -> dict[str, float]:
        """Contact output of a frame."""
        return {"contact work": self.account.contact} if self.contact.pairs else {}

    def _count(
        self,
        problem: _Increment,
        multipliers: Floats,
        force: Floats,
        moved: Floats,
        ahead: Floats,
    ) -> None:
        """Add the work of the forces, half of it on either side of the state."""
        contact, account = self.contact, self.account
        assert account.impact is not None
        done = self.pending + 0.5 * float(force @ moved)
        self.pending = 0.5 * float(force @ ahead)
        account.contact += done
        account.impact += done
        slips, follow = (problem.split(problem.travel(by)[1]) for by in (moved, ahead))
        for i, (pair, terms, (_, q)) in enumerate(contact.each(problem.found, multipliers)):
            stored = pair.law_energy(contact.at.terms[i]) if contact.at is not None else 0.0
            seen = covered(terms.area, pair.full)
            pair.area = np.where(seen, terms.area, pair.full)
            account.impact += pair.law_energy(terms) - stored
            if not pair.rubs:
                continue
            rubbed = self.rubbed[i] + 0.5 * float(np.maximum(-q * slips[i], 0.0).sum())
            self.rubbed[i] = 0.5 * float(np.maximum(-q * follow[i], 0.0).sum())
            pair.friction_work += rubbed
            account.impact += rubbed
            pair.slid += np.where(q != 0.0, slips[i] / pair.area, 0.0)
            pair.slide(replace(terms, slip=slips[i]), self.dt)


class _Increment:
    """The constraints of one increment, those of all pairs one after the other."""

    def __init__(
        self,
        own: ForwardContact,
        found: list[Terms],
        ahead: Floats,
        before: Floats,
        share: float,
        inverse: Floats,
        time: float,
    ) -> None:
        self.own, self.contact, self.found = own, own.contact, found
        self.share, self.inverse = share, inverse
        self.pushed: Floats = np.zeros_like(ahead)
        pairs = self.contact.pairs
        counts = [pair.n for pair in pairs]
        self.first = np.concatenate([[0], np.cumsum(counts)])
        self.n = int(self.first[-1])
        self.area = np.concatenate([terms.area for terms in found])
        self.full = np.concatenate([pair.full for pair in pairs])
        self.tied = np.repeat([pair.tied for pair in pairs], counts)
        self.ruled = np.repeat([pair.law is not None for pair in pairs], counts)
        # Gaps below which pressure laws act, doubled for other constraints.
        starts = [0.0 if pair.law is None else max(-pair.law.start, 0.0) for pair in pairs]
        self.near = 2.0 * np.repeat(starts, counts)
        self.friction = np.concatenate([pair.friction for pair in pairs])
        self.two = np.repeat([pair.two for pair in pairs], counts)
        self.seen = covered(self.area, self.full)
        self.tolerance = np.repeat([pair.noise for pair in pairs], counts) * self.full
        self.state = np.concatenate(own.state)
        self.sense = np.ones(self.n)
        self.sense[self.two] = np.concatenate(own.sense)
        # Gradients of all gaps and slips, a term per row.
        some = [k for k, terms in enumerate(found) if len(terms.constraint)] or [0]
        self.constraint = np.concatenate([self.first[k] + found[k].constraint for k in some])
        self.dofs = np.concatenate([pairs[k].dofs(found[k].variables) for k in some])
        slides = self.two[self.constraint, None]
        slip_gradients = np.concatenate([found[k].slip_gradient for k in some])
        self.gradients = (
            np.concatenate([found[k].gap_gradient for k in some]),
            np.where(slides, slip_gradients, 0.0),
        )
        gap = np.concatenate([terms.gap for terms in found])
        self.change, slid = self.travel(ahead)
        offset = self.contact.offset_at
        now, later = (
            np.concatenate([offset(pair, t) for pair in pairs]) for t in (time, time + own.dt)
        )
        depth = self._depth(gap)
        own.depth = self.split(depth)
        # Initial overlaps may be removed over the step.
        self.gap = gap + depth * self.area + self.change + (now - later) * self.area
        self.slip = np.where(self.tied, np.concatenate([terms.slip for terms in found]), 0.0) + slid
        # A law takes the mean of the last three gaps: a quarter of dt^2 times the acceleration.
        self.soft = gap + 0.25 / share * (self.change - self.travel(before)[0])

    def split(self, values: NDArray[Kind]) -> list[NDArray[Kind]]:
        """Values of all constraints by pair."""
        return np.split(values, self.first[1:-1])

    def travel(self, moved: Floats) -> tuple[Floats, Floats]:
        """Changes of all gaps and slips by a displacement, linearized."""
        by_dof = np.append(self.contact.system.in_space(moved), 0.0)[self.dofs]
        gap, slip = (
            np.bincount(self.constraint, (gradient * by_dof).sum(axis=1), self.n).astype(float)
            for gradient in self.gradients
        )
        return gap, slip

    def _depth(self, gap: Floats) -> Floats:
        """Overlap that is not removed: that at the beginning of contact, or its remainder."""
        overlap = np.where(self.seen, np.maximum(-gap, 0.0) / np.maximum(self.area, 1e-300), 0.0)
        old = np.concatenate(self.own.depth)
        depth = np.where(self.state != OPEN, np.minimum(old, overlap), overlap)
        return np.where(self.tied | self.ruled, 0.0, depth)

    # -- forces ------------------------------------------------------------------------

    def solve(self) -> Floats:
        """Multipliers of all pairs, shape (contact.n,)."""
        self.state[~self.seen] = OPEN
        p, q = np.zeros(self.n), np.zeros(self.n)
        chosen = self.seen & (self.tied | (self.state != OPEN) | (self.gap < -self.tolerance))
        chosen |= self.seen & self.ruled & (self.gap < self.area * self.near)
        movable = np.zeros(self.n, bool)
        while chosen.any():
            movable, p, q, self.pushed = self._forces(chosen)
            rise = self.travel(self.pushed)[0] if self.pushed.any() else 0.0
            more = self.seen & ~chosen & ~self.ruled & (self.gap + rise < -self.tolerance)
            if not more.any():
                break
            chosen = chosen | more
        self._check(chosen & ~movable)
        self.state[~chosen | ~movable] = OPEN
        self.own.state = self.split(self.state)
        each = zip(self.split(self.sense), self.own.sense, strict=True)
        self.own.sense = [sense[: len(old)] for sense, old in each]
        tractions = zip(self.contact.pairs, self.split(p), self.split(q), strict=True)
        return np.concatenate([x for pair, *both in tractions for x in both[: 1 + pair.two]])

    def _forces(self, chosen: Bools) -> tuple[Bools, Floats, Floats, Floats]:
        """Forces of some constraints: which can act, p and q, and the resulting motion."""
        rows, columns, values = self._entries(chosen)
        dofs, columns = np.unique(columns, return_inverse=True)
        mass = self.share * self.inverse[dofs]
        size = np.bincount(rows, values * values * mass[columns], 2 * self.n)
        movable = chosen & (size[: self.n] > 0.0)
        normal = np.flatnonzero(movable)
        tangent = np.flatnonzero(movable & self.two & (size[self.n :] > 0.0))
        here = np.concatenate([normal, self.n + tangent])
        kept = np.isin(rows, here)
        rows, columns, values = np.searchsorted(here, rows[kept]), columns[kept], values[kept]
        matrix = _compliance(rows, columns, values, mass, len(here))
        matrix *= self.own.dt**2
        law = partial(self._law, normal)
        slope = law(np.minimum(self.gap, self.gap - self.change)[normal])[1]
        # Beyond a frequency of 1/dt the increment does not resolve the law.
        stiff = -slope * np.diagonal(matrix)[: len(normal)] / self.share > 1.0
        problem = UnilateralConstraints(
            matrix,
            self.gap[normal],
            self.slip[tangent],
            np.searchsorted(normal, tangent),
            self.friction[tangent],
            self.tied[normal],
            self.tolerance[normal],
            np.where(stiff, self.gap[normal], self.soft[normal]),
            np.where(stiff, 1.0, 0.25 / self.share),
            self.ruled[normal],
            law,
        )
        fresh = (self.state[normal] == OPEN) & (self.gap[normal] < -self.tolerance[normal])
        start = np.where(fresh, CLOSED, self.state[normal]).astype(np.int8)
        found = problem.solve(start, self.sense[tangent])
        if found is None:
            raise ConvergenceError(
                f"found no contact forces for {len(normal)} nodes in contact: the constraints "
                "contradict each other; use fewer pairs at the same nodes, or an implicit scheme"
            )
        z, state, sense = found
        self.state[normal], self.sense[tangent] = state, sense
        p, q = np.zeros(self.n), np.zeros(self.n)
        p[normal], q[tangent] = np.split(z, [len(normal)])
        pushed = np.zeros_like(self.inverse)
        moved = np.bincount(columns, values * z[rows], len(dofs))
        pushed[dofs] = self.own.dt**2 * mass * moved
        return movable, p, q, pushed

    def _entries(self, chosen: Bools) -> tuple[Ints, Ints, Floats]:
        """Triplets of the gradients of gaps, and of slips behind them, where masses move."""
        kept = chosen[self.constraint]
        where = self.dofs[kept]
        row = np.repeat(self.constraint[kept], where.shape[1])
        columns, values = np.tile(where.ravel(), 2), np.ravel([g[kept] for g in self.gradients])
        acts = (columns >= 0) & (values != 0.0)
        rows, columns, values = self.contact.system.constraints.entries_to_axes(
            np.concatenate([row, self.n + row])[acts], columns[acts], values[acts]
        )
        acts = self.inverse[columns] > 0.0
        return rows[acts], columns[acts], values[acts]

    def _law(self, normal: Ints, gap: Floats) -> tuple[Floats, Floats]:
        """Pressures of the laws of some constraints at gaps, and derivatives; zero elsewhere."""
        pressure, slope = np.zeros(len(normal)), np.zeros(len(normal))
        for pair, first in zip(self.contact.pairs, self.first[:-1], strict=True):
            if pair.law is not None:
                own = (normal >= first) & (normal < first + pair.n)
                area = self.area[normal][own]
                pressure[own], rise, _ = pair.conditions.pressure(gap[own] / area)
                slope[own] = -rise / area
        return pressure, slope

    def _check(self, held: Bools) -> None:
        """Refuse two fixed surfaces that are pressed into each other."""
        held = self.seen & held & ~self.tied & ~self.ruled
        parts = map(self.split, (held, self.gap, self.area))
        for pair, own, gap, area in zip(self.contact.pairs, *parts, strict=True):
            wrong = own & (gap < -SMALL * area * float(pair.slave.length.mean()))
            if wrong.any():
                label = self.contact.label(pair, int(np.argmax(wrong)))
                raise ConvergenceError(
                    f"contact pair {pair.name!r}: node {label} is fixed and pressed into the other "
                    "side, which is fixed too; release one of them"
                )


def _compliance(rows: Ints, columns: Ints, values: Floats, mass: Floats, n: int) -> Floats:
    """``G W G^T`` of a matrix G with n rows in triplets and diagonal weights W."""
    if n * len(mass) <= AT_ONCE:
        g = np.zeros((n, len(mass)))
        np.add.at(g, (rows, columns), values)
        return np.asarray((g * mass) @ g.T)
    import scipy.sparse as sp

    many: Any = sp.csr_array((values, (rows, columns)), shape=(n, len(mass)))
    return np.asarray(((many * mass) @ many.T).toarray())


@dataclass
class UnilateralConstraints:
    """m constraints of one increment, of which t have slips."""

    matrix: Floats  # change of gaps and slips by forces p and q, shape (m + t, m + t)
    gap: Floats  # without these forces, shape (m,)
    slip: Floats  # likewise, shape (t,)
    of: Ints  # constraint that a slip belongs to, shape (t,)
    friction: Floats  # shape (t,)
    tied: Bools  # constraints whose gap and slip stay zero, shape (m,)
    tolerance: Floats  # gaps that are rounding, shape (m,)
    soft: Floats  # gap that a law takes, without these forces, shape (m,)
    share: Floats  # fraction of the change of a gap that a law sees, shape (m,)
    ruled: Bools  # constraints with a pressure law, shape (m,)
    law: Law  # their pressures at gaps, and the derivatives by these; zero elsewhere, shape (m,)

    def solve(self, state: States, sense: Floats) -> tuple[Floats, States, Floats] | None:
        """Forces, states and senses of slip; None where none are found.

        Laws are linearized at their gaps, from those without forces on. States to start from, of
        shape (m,), are OPEN, CLOSED (sticks) or SLIPPING; senses, of shape (t,), are signs of q.
        """
        m, t, tied, own = len(self.gap), len(self.slip), self.tied, self.tied[self.of]
        rest, matrix = np.concatenate([self.gap, self.slip]), self.matrix.copy()
        matrix.flat[:: m + t + 1] *= 1.0 + COMPLIANCE * (np.append(self.ruled, np.zeros(t)) == 0.0)
        # What is tied has no choice: it is eliminated.
        held, normal, slips = np.append(tied, own), np.flatnonzero(~tied), np.flatnonzero(~own)
        free, of = np.flatnonzero(~held), np.searchsorted(normal, self.of[slips])
        known = np.column_stack([matrix[np.ix_(held, free)], rest[held]])
        back = np.linalg.solve(matrix[np.ix_(held, held)], known)
        across = matrix[np.ix_(free, held)]
        start = rest[free] - across @ back[:, -1]
        matrix = matrix[np.ix_(free, free)] - across @ back[:, :-1]
        n = len(normal)
        unit = 1.0 / np.sqrt(np.maximum(matrix.diagonal(), 1e-300))
        # Of each constraint its pressure and its traction.
        table = np.zeros((len(free), 1 + 2 * n))
        table[:, 0] = unit * start
        table[:, 1::2] = unit[:, None] * matrix[:, :n] * unit[:n]
        table[:, 2 + 2 * of] = unit[:, None] * matrix[:, n:] * unit[n:]
        rubs, friction, direction = np.zeros(n, bool), np.zeros(n), np.ones(n)
        rubs[of], friction[of] = True, self.friction[slips] * unit[of] / unit[n:]
        direction[of] = sense[slips]
        ruled = np.flatnonzero(self.ruled[normal])
        law, plain = normal[ruled], table[ruled]
        z, after, turned = np.zeros(m + t), state[normal], sense.copy()
        gap, (pressure, slope) = self.soft, self.law(self.soft)
        for _ in range(WAITED * PATIENCE):
            acts = slope[law] < 0.0
            after[ruled] = np.where(acts, np.maximum(after[ruled], CLOSED), OPEN)
            give = np.where(acts, -1.0 / np.where(acts, slope[law], 1.0), 0.0)
            table[ruled] = plain * (acts * self.share[law])[:, None]
            table[ruled, 1 + 2 * ruled] += give * unit[ruled] ** 2
            moved = self.soft[law] + self.share[law] * (start - rest[free])[ruled] - gap[law]
            # A law that does not press at its gap is open.
            apart = float(np.abs(table[:, 0]).max(initial=0.0)) or 1.0
            table[ruled, 0] = unit[ruled] * (moved - pressure[law] * give)
            table[ruled[~acts], 0] = apart
            found = _core.unilateral(
                np.full(n, OPEN, np.int8), direction, friction, rubs, table[:n], table[n:], after
            )
            if found is None:
                return None
            _, after, direction, p, q = found
            z[free] = unit * np.append(p, q[of])
            z[held] = -(back[:, :-1] @ z[free] + back[:, -1])
            gap = self.soft + self.share * (self.matrix @ z)[:m]
            pressure, slope = self.law(gap)
            missed = np.abs(z[:m] - pressure)
            rounding = COMPLIANCE * pressure.max(initial=0.0) - slope * self.tolerance
            if (missed <= rounding)[self.ruled].all():
                states = np.full(m, CLOSED, np.int8)
                states[normal], turned[slips] = after, direction[of]
                return z, states, turned
        return None


#: Error in the instant of impact: depth behind the first contact at which an increment ends [slave
#: edges].
BEYOND = 1e-4
#: Gap from which an increment leaves a remainder [slave edges], and the fraction left.
LEFT = 0.1


class Approach:
    """Times to contact of separate surfaces, and the error of an increment in which they meet.

    Parameters
    ----------
    system : System
    massless : ndarray of bool, shape (n_dofs,)
        Displacements without mass; their accelerations are meaningless.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"system", "term", "part", "heavy"})

    def __init__(self, system: System, massless: Bools) -> None:
        self.system, self.term = system, system.term(ContactTerm)
        #: Whether the last requested increment ends after a first contact; whether it was
        #: shortened, and how many were in a row.
        self.meets = self.limited = False
        self.in_a_row = 0
        #: Displacement of the last increment by node and its time; velocities of nodes without
        #: mass oscillate about it.
        self.moved, self.dt = np.zeros((0, 3)), 0.0
        mesh = system.model.mesh
        part = part_of_nodes(mesh) if self.term.opens else np.full(mesh.n_nodes, -1, np.int64)
        heavy = np.zeros(len(part), bool)
        heavy[system.node_of_dof[~massless & ~system.is_rotation]] = True
        #: Body of each node, -1 for none, and the nodes whose mean acceleration is the body's.
        self.part, self.heavy = part, heavy & (part >= 0)

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

    def impact_error(
        self, state: ContactState | None, moved: Floats, energy: float, tolerance: float
    ) -> float:
        """Error of an increment in the instant of impact, relative to the allowed one.

        Gaps that close within the increment: the work of contact within it, against a thousandth
        of the energy for a tolerance of one percent; where a rate condition keeps that at zero, the
        depth they are left with, against a tenth of an edge. Surfaces that meet for the first time:
        a hundredth of an edge, which is the depth, or the gap that the increment began with where
        it was not to end at their first touch.

        Parameters
        ----------
        state : ContactState or None
            At the end of the increment; None without contact.
        moved : ndarray, shape (n_dofs,)
            Displacement of the increment.
        energy : float
            Of the motion [force*length].
        tolerance : float
            Of the step [1].
        """
        term = self.term
        if state is None:
            return 0.0
        first = self._first_contact(state) / tolerance
        if term.persistent:
            depth = 0.0
            for pair, terms in zip(term.pairs, state.terms, strict=True):
                if pair.start is not None and pair.law is None:
                    deeper = np.minimum(pair.begun()[0], 0.0) - (terms.bare or terms).gap
                    edge = float(pair.slave.length.mean())
                    depth = max(depth, float((deeper / pair.full).max()) / edge)
            return max(first, 0.1 * depth / tolerance)
        work = float(state.force @ moved)
        for k, (pair, terms, (_, q)) in enumerate(term.each(state.terms, state.multipliers)):
            if pair.rubs:
                work -= float(q @ terms.slip)
            if pair.law is not None:
                before = 0.0 if term.at is None else pair.law_energy(term.at.terms[k])
                work += pair.law_energy(terms) - before
        return max(first, 10.0 * abs(work) / (tolerance * energy) if energy > 0.0 else 0.0)

    def _first_contact(self, state: ContactState) -> float:
        """How late the first contact of surfaces is found [slave edges]."""
        late, term = 0.0, self.term
        before, x = term.at, term.positions(term.u)
        each = term.each(state.terms, state.multipliers)
        for number, (pair, terms, (p, q)) in enumerate(each):
            if pair.tied or before is None or (self.meets and pair.start is None):
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

    def _accelerations(self, now: MotionState) -> Floats:
        """Mean acceleration of the body of each node, shape (n_nodes, 3)."""
        out = self.system.by_node(now.a)
        known, owner = self.part >= 0, self.part[self.heavy]
        count = np.bincount(owner, minlength=self.part.max(initial=-1) + 1)
        for i in (0, 1):
            sums = np.bincount(owner, out[self.heavy, i], len(count))
            out[known, i] = (sums / np.maximum(count, 1))[self.part[known]]
        out[:, 2] = 0.0
        return out

    def _rates(self, now: MotionState, acceleration: Floats) -> Floats:
        """Velocity of each node, shape (n_nodes, 3)."""
        out = self.system.by_node(now.v)
        if self.dt:
            mean = self.moved[:, :2] / self.dt + 0.5 * self.dt * acceleration[:, :2]
            known = self.part >= 0
            out[known, :2] = mean[known]
        return out


def _time_to_contact(
    pair: Pair, terms: Terms, seen: Bools, rates: Floats, acceleration: Floats
) -> tuple[float, bool]:
    """Time to the end of the next increment towards contact, and whether contact begins there."""
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
