"""Contact of central differences: forward-increment Lagrange multipliers.

The contact forces at the beginning of an increment make its end fit the surfaces (Carpenter,
Taylor and Katona 1991): with the displacement that the motion would have without them,

    gap + dt G v + dt^2 G M^-1 G^T p >= 0,    p >= 0,

and the same for the slip and Coulomb's bound. Gaps and gradients are those of the beginning,
so that forces conserve linear and angular momentum to rounding; errors of second order in the
increment are corrected in the next one.

A pressure law takes the mean ``(g0 + 2 g1 + g2) / 4`` of three gaps, which keeps energy; where it
is too stiff for the increment, the gap at its end, as if there were none. Both are stable.

The forces ``z = (p, q)`` of some constraints change their gaps and slips by ``A z``, where
``A = dt^2 G M^-1 G^T`` is symmetric and at least semidefinite. The set of closed and slipping
constraints is found by Newton's method; where that cycles, by sweeps of Gauss and Seidel.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.gaps import (
    CHANGES,
    CLOSED,
    COMPLIANCE,
    HALVINGS,
    OPEN,
    SLIPPING,
    SMALL,
    ContactState,
    covered,
)
from corota.errors import ConvergenceError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.energies import Energies
    from corota.analysis.equations import System
    from corota.analysis.terms.contact.pair import Pair, Terms
    from corota.arrays import Bools, Floats, Ints

    States = NDArray[np.int8]
    #: Pressures and their derivatives of some constraints at some gaps.
    Law = Callable[[Ints, Floats], tuple[Floats, Floats]]

#: Entries of a matrix from which it is treated as sparse (cost alone).
DENSE = 100_000


class NoForwardContact:
    """A model without pairs and ties.

    Parameters
    ----------
    n_dofs : int
    """

    def __init__(self, n_dofs: int) -> None:
        self.n_dofs = n_dofs

    def act(self, *_: object) -> Floats:
        """No force."""
        return np.zeros(self.n_dofs)

    def sums(self) -> dict[str, float]:
        """No output."""
        return {}


class ForwardContact:
    """Contact pairs and ties in a step of central differences.

    Parameters
    ----------
    contact : ContactTerm
    account : Energies
    dt : float
        Increment [time].

    Attributes
    ----------
    depth : list of ndarray
        Of each pair, overlap that is not removed [length]: the overlap
        at the beginning of contact. It remains until the gap opens.
    """

    def __init__(self, contact: ContactTerm, account: Energies, dt: float) -> None:
        self.contact, self.account, self.dt = contact, account, dt
        self.depth = [np.zeros(pair.n) for pair in contact.pairs]
        self.state = [np.full(pair.n, OPEN, np.int8) for pair in contact.pairs]
        self.sense = [np.ones(pair.n if pair.two else 0) for pair in contact.pairs]
        # Work of the forces of the last state in the first half of what follows.
        self.pending = 0.0
        self.rubbed = [0.0] * len(contact.pairs)
        if account.impact is None:
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
        u : ndarray, shape (n_dofs,)
        moved : ndarray, shape (n_dofs,)
            Increment that ended at `u`.
        ahead : ndarray, shape (n_dofs,)
            Increment that follows without contact.
        before : ndarray, shape (n_dofs,)
            What it would be if no force acted on free dofs.
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
        with system.timed("contact"):
            x = contact.positions(u)
            # Coefficients of friction are those at the slip rates of the increment before.
            for pair, (p, _) in zip(contact.pairs, contact.parts(contact.committed), strict=True):
                pair.rub(contact.number, 1.0, p)
            found = [self._look(pair, x, time) for pair in contact.pairs]
            problem = _Increment(self, found, ahead, before, share, inverse, time)
            multipliers = problem.solve()
            force, size = self._forces(found, multipliers)
            along = system.at_nodes(force)
            self._count(found, multipliers, along, moved, ahead + problem.pushed)
            self._commit(u, found, multipliers, force, size, time)
        return along

    def sums(self) -> dict[str, float]:
        """Contact output of a frame."""
        return {"contact work": self.account.contact}

    def _look(self, pair: Pair, x: Floats, time: float) -> Terms:
        """Gaps at a state."""
        pair.core.offset = self.contact.offset_at(pair, time)
        return pair.evaluate(x, x, self.contact.system.nlgeom)

    def _forces(self, found: list[Terms], multipliers: Floats) -> tuple[Floats, Floats]:
        """Forces in global axes, and their sizes, shape (n_dofs,)."""
        contact, n = self.contact, self.contact.system.n_dofs
        force, size = np.zeros(n), np.zeros(n)
        for pair, terms, (p, q) in contact.each(found, multipliers):
            pair.add_forces(terms, contact.dofs(terms.variables), p, q, force, size)
        return force, size

    def _count(
        self,
        found: list[Terms],
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
        for i, (pair, terms, (_, q)) in enumerate(contact.each(found, multipliers)):
            stored = pair.law_energy(contact.at.terms[i]) if contact.at is not None else 0.0
            seen = covered(terms.area, pair.full)
            pair.area = np.where(seen, terms.area, pair.full)
            account.impact += pair.law_energy(terms) - stored
            if not pair.rubs:
                continue
            slip = travel(contact, terms, terms.slip_gradient, moved, pair.n)
            more = travel(contact, terms, terms.slip_gradient, ahead, pair.n)
            rubbed = self.rubbed[i] + 0.5 * float(np.maximum(-q * slip, 0.0).sum())
            self.rubbed[i] = 0.5 * float(np.maximum(-q * more, 0.0).sum())
            pair.friction_work += rubbed
            account.impact += rubbed
            pair.slid += np.where(q != 0.0, slip / pair.area, 0.0)
            pair.slide(replace(terms, slip=slip), self.dt)

    def _commit(
        self,
        u: Floats,
        found: list[Terms],
        multipliers: Floats,
        force: Floats,
        size: Floats,
        time: float,
    ) -> None:
        contact = self.contact
        for pair in contact.pairs:
            pair.core.commit()
        contact.u, contact.committed, contact.time = u.copy(), multipliers, time
        states = [state.copy() for state in self.state]
        for pair, state in zip(contact.pairs, states, strict=True):
            pair.keep_closed(state)
        where = contact.positions(u)
        contact.at = ContactState(
            found, force, size, multipliers, states=states, acting=found, where=where
        )


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
        joined = {
            "area": [terms.area for terms in found],
            "full": [pair.full for pair in pairs],
            "gap": [terms.gap for terms in found],
            "slip": [terms.slip if pair.tied else np.zeros(pair.n) for pair, terms in self._each()],
            "noise": [np.full(pair.n, pair.noise) for pair in pairs],
        }
        self.area, self.full, gap, slip, noise = (np.concatenate(v) for v in joined.values())
        self.tied = np.repeat([pair.tied for pair in pairs], counts)
        self.ruled = np.repeat([pair.law is not None for pair in pairs], counts)
        self.friction = np.concatenate([pair.friction for pair in pairs])
        self.two = np.repeat([pair.two for pair in pairs], counts)
        self.seen = covered(self.area, self.full)
        self.tolerance = noise * self.full
        self.state = np.concatenate(own.state)
        self.sense = np.ones(self.n)
        self.sense[self.two] = np.concatenate(own.sense)
        traveled, slid = self._travel(ahead)
        self.travel = traveled
        ramp = np.concatenate([self._ramp(pair, time) for pair in pairs])
        depth = self._depth(gap)
        own.depth = np.split(depth, self.first[1:-1])
        self.gap = gap + depth * self.area + traveled + ramp * self.area
        self.slip = slip + slid
        # A law takes the mean of the last three gaps: a quarter of dt^2 times the acceleration.
        rest = self._travel(before)[0]
        self.soft = gap + 0.25 / share * (traveled - rest)

    def _each(self) -> list[tuple[Pair, Terms]]:
        return list(zip(self.contact.pairs, self.found, strict=True))

    def _travel(self, moved: Floats) -> tuple[Floats, Floats]:
        """Changes of all gaps and slips by a displacement, linearized."""
        gaps, slips = [], []
        for pair, terms in self._each():
            gaps.append(travel(self.contact, terms, terms.gap_gradient, moved, pair.n))
            some = travel(self.contact, terms, terms.slip_gradient, moved, pair.n)
            slips.append(some if pair.two else np.zeros(pair.n))
        return np.concatenate(gaps), np.concatenate(slips)

    def _ramp(self, pair: Pair, time: float) -> Floats:
        """Change of gaps while initial overlaps are removed over the step [length]."""
        later = self.contact.offset_at(pair, time + self.own.dt)
        return np.asarray(self.contact.offset_at(pair, time) - later)

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
        own = self.contact
        multipliers = np.zeros(own.n)
        p, q = np.zeros(self.n), np.zeros(self.n)
        chosen = self.seen & (self.tied | (self.state != OPEN) | (self.gap < -self.tolerance))
        chosen |= self.seen & self.ruled & (self.gap < self.area * self._start_of_laws())
        movable = np.zeros(self.n, bool)
        while chosen.any():
            movable, p, q, self.pushed = self._forces(chosen)
            rise = self._travel(self.pushed)[0] if self.pushed.any() else 0.0
            more = self.seen & ~chosen & ~self.ruled & (self.gap + rise < -self.tolerance)
            if not more.any():
                break
            chosen = chosen | more
        self._check(chosen & ~movable)
        self.state[~chosen | ~movable] = OPEN
        self.own.state = np.split(self.state, self.first[1:-1])
        sense = np.split(self.sense, self.first[1:-1])
        self.own.sense = [s[: len(old)] for s, old in zip(sense, self.own.sense, strict=True)]
        for pair, a, b in zip(own.pairs, self.first[:-1], self.first[1:], strict=True):
            multipliers[pair.first : pair.first + pair.n] = p[a:b]
            if pair.two:
                multipliers[pair.first + pair.n : pair.first + pair.width] = q[a:b]
        return multipliers

    def _start_of_laws(self) -> Floats:
        """Gaps below which pressure laws act, shape (n,), doubled for other constraints."""
        starts = [
            np.full(pair.n, 0.0 if pair.law is None else max(-pair.law.start, 0.0))
            for pair in self.contact.pairs
        ]
        return 2.0 * np.concatenate(starts)

    def _forces(self, chosen: Bools) -> tuple[Bools, Floats, Floats, Floats]:
        """Forces of some constraints: which can act, p and q, and the resulting motion."""
        rows, columns, values = self._gradients(chosen)
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
        place = np.cumsum(movable) - 1
        matrix *= self.own.dt**2
        laws = self._laws(movable, place)
        stiff = np.zeros(len(normal), bool)
        deepest = np.minimum(self.gap, self.gap - self.travel)[normal]
        for some, law in laws:
            square = -law(some, deepest[some])[1] * np.diagonal(matrix)[some] / self.share
            # Beyond a frequency of 1/dt the increment does not resolve the law.
            stiff[some] = square > 1.0
        problem = UnilateralConstraints(
            matrix,
            self.gap[normal],
            self.slip[tangent],
            place[tangent],
            self.friction[tangent],
            self.tied[normal],
            self.tolerance[normal],
            np.where(stiff, self.gap[normal], self.soft[normal]),
            np.where(stiff, 1.0, 0.25 / self.share),
            laws,
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
        p[normal], q[tangent] = z[: len(normal)], z[len(normal) :]
        pushed = np.zeros_like(self.inverse)
        moved = np.bincount(columns, values * z[rows], len(dofs))
        pushed[dofs] = self.own.dt**2 * mass * moved
        return movable, p, q, pushed

    def _gradients(self, chosen: Bools) -> tuple[Ints, Ints, Floats]:
        """Triplets of the gradients of gaps, and of slips behind them, where masses move."""
        rows, columns, values = [], [], []
        for (pair, terms), first in zip(self._each(), self.first, strict=False):
            own = chosen[first : first + pair.n]
            kept = own[terms.constraint]
            where = self.contact.dofs(terms.variables[kept])
            row = np.repeat(first + terms.constraint[kept], where.shape[1])
            kinds = [(0, terms.gap_gradient)]
            if pair.two:
                kinds.append((self.n, terms.slip_gradient))
            for offset, gradient in kinds:
                flat, value = where.ravel(), gradient[kept].ravel()
                acts = (flat >= 0) & (value != 0.0)
                rows.append(offset + row[acts])
                columns.append(flat[acts])
                values.append(value[acts])
        along, dofs, parts = self.contact.system.constraints.entries_to_axes(
            np.concatenate(rows), np.concatenate(columns), np.concatenate(values)
        )
        acts = self.inverse[dofs] > 0.0
        return along[acts], dofs[acts], parts[acts]

    def _laws(self, movable: Bools, place: Ints) -> list[tuple[Ints, Law]]:
        out: list[tuple[Ints, Law]] = []
        area = self.area[movable]
        for (pair, _), first in zip(self._each(), self.first, strict=False):
            if pair.law is None:
                continue
            mine = np.flatnonzero(movable[first : first + pair.n])

            def law(rows: Ints, gap: Floats, pair: Pair = pair) -> tuple[Floats, Floats]:
                pressure, slope, _ = pair.conditions.pressure(gap / area[rows])
                return pressure, -slope / area[rows]

            out.append((place[first + mine], law))
        return out

    def _check(self, held: Bools) -> None:
        """Refuse two fixed surfaces that are pressed into each other."""
        for (pair, _), first in zip(self._each(), self.first, strict=False):
            if pair.tied or pair.law is not None:
                continue
            k = slice(first, first + pair.n)
            length = np.where(self.seen[k], self.gap[k] / np.maximum(self.area[k], 1e-300), 0.0)
            wrong = held[k] & (length < -SMALL * float(pair.slave.length.mean()))
            if wrong.any():
                label = self.contact.label(pair, int(np.argmax(wrong)))
                raise ConvergenceError(
                    f"contact pair {pair.name!r}: node {label} is fixed and pressed into the other "
                    "side, which is fixed too; release one of them"
                )


def _compliance(rows: Ints, columns: Ints, values: Floats, mass: Floats, n: int) -> Floats:
    """``G W G^T`` of a matrix G with n rows in triplets and diagonal weights W."""
    if n * len(mass) <= DENSE:
        g = np.zeros((n, len(mass)))
        np.add.at(g, (rows, columns), values)
        return np.asarray((g * mass) @ g.T)
    import scipy.sparse as sp

    many: Any = sp.csr_array((values, (rows, columns)), shape=(n, len(mass)))
    return np.asarray(((many * mass) @ many.T).toarray())


def travel(contact: ContactTerm, terms: Terms, gradient: Floats, moved: Floats, n: int) -> Floats:
    """Change of the gaps or slips of a pair by a displacement, linearized, shape (n,)."""
    moved = contact.system.in_space(moved)
    by_dof = np.append(moved, 0.0)[contact.dofs(terms.variables)]
    return np.asarray(np.bincount(terms.constraint, (gradient * by_dof).sum(axis=1), n), np.float64)


#: Limit of the sweeps of Gauss and Seidel in an explicit step.
SWEEPS = 5000
#: Rounding bound of explicit steps: relative change of a force, or error of a law.
ROUNDING = 1e-12


@dataclass
class UnilateralConstraints:
    """Constraints of one increment.

    Parameters
    ----------
    matrix : ndarray, shape (m + t, m + t)
        Change of gaps and slips by forces p and q.
    gap, slip : ndarray, shapes (m,) and (t,)
        Without these forces.
    of : ndarray of int, shape (t,)
        Constraint that a slip belongs to.
    friction : ndarray, shape (t,)
    tied : ndarray of bool, shape (m,)
        Constraints whose gap and slip stay zero.
    tolerance : ndarray, shape (m,)
        Gaps and slips that are rounding.
    soft : ndarray, shape (m,)
        Gap that a law takes, without these forces.
    share : ndarray, shape (m,)
        Fraction of the change of a gap that a law sees.
    laws : list of tuple
        Constraints with functions for pressures and their derivatives by the gap, for some of them.
    """

    matrix: Floats
    gap: Floats
    slip: Floats
    of: Ints
    friction: Floats
    tied: Bools
    tolerance: Floats
    soft: Floats
    share: Floats
    laws: list[tuple[Ints, Law]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.m, self.t = len(self.gap), len(self.slip)
        self._diagonal = np.diagonal(self.matrix)
        self._ruled = np.zeros(self.m, bool)
        for rows, _ in self.laws:
            self._ruled[rows] = True

    def solve(self, state: States, sense: Floats) -> tuple[Floats, States, Floats] | None:
        """Forces, states and senses of slip; None where none are found.

        Parameters
        ----------
        state : ndarray of int, shape (m,)
            To start from: OPEN, CLOSED (sticks) or SLIPPING.
        sense : ndarray, shape (t,)
            Sign of q if it slips.

        Returns
        -------
        z : ndarray, shape (m + t,)
        state, sense : ndarray
        """
        found = self._newton(state, sense)
        if found is not None:
            return found
        z = self._sweep()
        if z is None:
            return None
        state, sense = self._read(z)
        # Sweeps stop before the exact solution of their set.
        return self._newton(state, sense) or (z, state, sense)

    # -- Newton's method on the set ----------------------------------------------------

    def _newton(self, state: States, sense: Floats) -> tuple[Floats, States, Floats] | None:
        pressure, slope = self._follow(self.soft)
        state = np.where(self._ruled & (slope == 0.0), OPEN, state).astype(np.int8)
        soft = self.soft
        seen: set[bytes] = set()
        for _ in range(CHANGES):
            z = self._forces(state, sense, soft, pressure, slope)
            gap, slip = self._motion(z)
            soft = self.soft + self.share * (gap - self.gap)
            pressure, slope = self._follow(soft)
            missed = np.abs(z[: self.m] - pressure)[self._ruled]
            rounding = ROUNDING * pressure.max(initial=0.0) - slope * self.tolerance
            settled = bool((missed <= rounding[self._ruled]).all())
            after, turned = self._update(state, sense, z, gap, slip, slope)
            if (after == state).all() and (turned == sense).all() and settled:
                return z, state, sense
            state, sense = after, turned
            key = state.tobytes() + sense.tobytes()
            if settled and key in seen:
                return None
            seen.add(key)
        return None

    def _forces(
        self, state: States, sense: Floats, soft: Floats, pressure: Floats, slope: Floats
    ) -> Floats:
        """Forces of a set, laws linearized at their gaps, shape (m + t,)."""
        m = self.m
        closed = state != OPEN
        free = np.concatenate([closed, (state == CLOSED)[self.of]])
        z = np.zeros(m + self.t)
        if not free.any():
            return z
        place = np.cumsum(free) - 1
        columns = self.matrix[:, free]
        slipping = np.flatnonzero((state == SLIPPING)[self.of])
        ratio = sense[slipping] * self.friction[slipping]
        columns[:, place[self.of[slipping]]] += ratio * self.matrix[:, m + slipping]
        rest = -np.concatenate([self.gap, self.slip])[free]
        rows = columns[free]
        ruled = np.flatnonzero(self._ruled & closed)
        at = place[ruled]
        rows[at] *= self.share[ruled, None]
        rest[at] = soft[ruled] - self.soft[ruled] + pressure[ruled] / -slope[ruled]
        ridge = COMPLIANCE * self._diagonal[free]
        ridge[at] = 1.0 / -slope[ruled]
        rows[np.diag_indices(len(rows))] += ridge
        z[free] = np.linalg.solve(rows, rest)
        z[m + slipping] = ratio * z[self.of[slipping]]
        return z

    def _motion(self, z: Floats) -> tuple[Floats, Floats]:
        """Gaps and slips with forces."""
        moved = self.matrix @ z
        return self.gap + moved[: self.m], self.slip + moved[self.m :]

    def _follow(self, soft: Floats) -> tuple[Floats, Floats]:
        """Pressures of the laws and their derivatives by the gap, zero elsewhere."""
        pressure, slope = np.zeros(self.m), np.zeros(self.m)
        for rows, law in self.laws:
            pressure[rows], slope[rows] = law(rows, soft[rows])
        return pressure, slope

    def _update(
        self, state: States, sense: Floats, z: Floats, gap: Floats, slip: Floats, slope: Floats
    ) -> tuple[States, Floats]:
        p, q = z[: self.m], z[self.m :]
        hard, of = ~self._ruled, self.of
        after = state.copy()
        after[hard & (state == OPEN) & (gap < -self.tolerance)] = CLOSED
        after[self._ruled & (state == OPEN) & (slope != 0.0)] = CLOSED
        slips = ((state == CLOSED) & ~self.tied)[of]
        slips &= np.abs(q) > self.friction * p[of] * (1.0 + ROUNDING)
        after[of[slips]] = SLIPPING
        sense = np.where(slips, np.where(q > 0.0, 1.0, -1.0), sense)
        turned = (state == SLIPPING)[of] & (sense * slip > self.tolerance[of])
        after[of[turned]] = CLOSED
        after[hard & (state != OPEN) & (p < 0.0)] = OPEN
        after[self._ruled & (slope == 0.0)] = OPEN
        after[self.tied] = CLOSED
        return after, sense

    # -- sweeps ------------------------------------------------------------------------

    def _sweep(self) -> Floats | None:
        """Forces by Gauss and Seidel's method with projections, shape (m + t,)."""
        m, d = self.m, self._diagonal
        rest = np.concatenate([self.gap, self.slip])
        law_of = {i: law for rows, law in self.laws for i in rows.tolist()}
        tangents = dict(zip(self.of.tolist(), range(m, m + self.t), strict=True))
        z = np.zeros(m + self.t)
        size = max(float(np.abs(rest).max()), float(self.tolerance.max()))
        for _ in range(SWEEPS):
            change = 0.0
            for i in range(m):
                for row in (i, tangents.get(i, -1)):
                    if row < 0 or d[row] <= 0.0:
                        continue
                    old, moved = z[row], float(self.matrix[row] @ z)
                    new = old - (rest[row] + moved) / d[row]
                    if row >= m and not self.tied[i]:
                        most = self.friction[row - m] * z[i]
                        new = min(max(new, -most), most)
                    elif row < m and i in law_of:
                        start = self.soft[i] + self.share[i] * (moved - d[i] * old)
                        new = _balance(law_of[i], i, start, float(self.share[i] * d[i]))
                    elif row < m and not self.tied[i]:
                        new = max(new, 0.0)
                    z[row] = new
                    change = max(change, abs(new - old) * d[row])
            if change <= ROUNDING * size:
                return z
        return None

    def _read(self, z: Floats) -> tuple[States, Floats]:
        """States and slip directions from forces."""
        p, q = z[: self.m], z[self.m :]
        state = np.where((p > 0.0) | self.tied, CLOSED, OPEN).astype(np.int8)
        bound = self.friction * p[self.of]
        slips = (np.abs(q) >= bound * (1.0 - ROUNDING)) & (p[self.of] > 0.0) & ~self.tied[self.of]
        state[self.of[slips]] = SLIPPING
        return state, np.where(q > 0.0, 1.0, -1.0)


def _balance(law: Law, row: int, start: float, rise: float) -> float:
    """Pressure of a law at the gap that it causes, ``start + rise p``."""

    def pressure(p: float) -> float:
        return float(law(np.array([row]), np.array([start + rise * p]))[0][0])

    low, high = 0.0, pressure(0.0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pressure(middle) > middle else (low, middle)
    return 0.5 * (low + high)


def forward_contact(
    system: System, account: Energies, dt: float
) -> ForwardContact | NoForwardContact:
    """Contact of an explicit step, with or without pairs."""
    contact = system.term(ContactTerm)
    if not contact.pairs:
        return NoForwardContact(system.n_dofs)
    return ForwardContact(contact, account, dt)
