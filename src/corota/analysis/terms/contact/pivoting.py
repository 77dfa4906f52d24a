"""Contact states from the whole linearized problem, where individual choices cycle.

A semismooth Newton method chooses the state of each constraint by itself. Where constraints
depend on each other, as at the friction bound of a body held only by friction, such choices
may never converge. Here the linearized equations with all their conditions, a linear
complementarity problem, are solved by pivoting (in the core): every correction then satisfies all
conditions to first order (the method of Josephy and Newton). Nothing is regularized.

Sources: A. Klarbring, *A mathematical programming approach to three-dimensional contact problems
with friction*, Comput. Methods Appl. Mech. Engrg. 58 (1986); N. H. Josephy, *Newton's method for
generalized equations*, MRC report 1965 (1979).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import corota._core as _core
from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.terms.contact.gaps import AT_ONCE, SAME, RightHandSides, covered, sticking
from corota.errors import SingularError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.linear.types import Kind
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.analysis.terms.contact.gaps import States
    from corota.arrays import Floats, Ints

    #: Correction of dofs and multipliers, its states, signs of slipping tractions.
    Found = tuple[Floats, States, list[Floats]]


class Pivoting:
    """One correction with states from the whole linearized problem.

    Parameters
    ----------
    problem : ContactEquations
    at : Evaluation
    right_sides : RightHandSides
        One right-hand side.
    """

    def __init__(
        self, problem: ContactEquations, at: Evaluation, right_sides: RightHandSides
    ) -> None:
        self.problem, self.at, self.right_sides = problem, at, right_sides
        self.pairs = list(problem.pairs(at.contact_state))
        #: Constraints of one problem (its cost grows with the cube); a tenth may be open at first.
        self.most = math.isqrt(AT_ONCE)
        #: Constraints with an opposite surface, and those of these that may change their state.
        self.seen = [covered(terms.area, pair.full) for pair, terms, _ in self.pairs]
        self.able = [
            seen & (pair.separates and pair.law is None and pair.shear_limit == np.inf)
            for seen, (pair, _, _) in zip(self.seen, self.pairs, strict=True)
        ]

    def solve(self) -> Found | None:
        """Correction of dofs and multipliers, its states and senses; None where none is found."""
        for base in self._bases():
            chosen: list[Ints] | None = self._first(base)
            while chosen is not None and any(map(len, chosen)):
                try:
                    found = self._with(base, chosen)
                except SingularError:
                    break
                if found is None:
                    break
                chosen = self._violated(found[0], found[1], chosen)
                if chosen is None:
                    return found
        return None

    def _bases(self) -> list[States]:
        """Initial states, the best first."""
        problem, state = self.problem, self.at.contact_state
        first = problem.term.states(state.terms, state.multipliers)
        starts = [first] if problem.last is None else [problem.last, first]
        # With all closed constraints sticking, bodies held by friction are constrained and the
        # matrix is symmetric.
        bases: dict[bytes, States] = {}
        for states in [*map(sticking, starts), *starts]:
            base = [
                np.where(seen, s, OPEN).astype(np.int8)
                for s, seen in zip(states, self.seen, strict=True)
            ]
            bases.setdefault(b"".join(s.tobytes() for s in base), base)
        return list(bases.values())

    # -- which constraints ------------------------------------------------------------

    def _first(self, base: States) -> list[Ints]:
        """Closed constraints, and the nearest open ones."""
        left, out = self.most, []
        for able, state, (pair, terms, _) in zip(self.able, base, self.pairs, strict=True):
            gap = np.where(able & (state == OPEN), terms.gap * pair.stiffness, np.inf)
            near = np.argsort(gap, kind="stable")[: self.most // 10]
            wanted = able & (state != OPEN)
            wanted[near[np.isfinite(gap[near])]] = True
            out.append(np.flatnonzero(wanted)[:left])
            left -= len(out[-1])
        return out

    def _violated(self, z: Floats, states: States, chosen: list[Ints]) -> list[Ints] | None:
        """The choice with the constraints that a solution would violate; None if there are none."""
        problem, n = self.problem, self.problem.n
        wanted, scales = [], problem.system.scales
        none = SAME * max(scales.force, scales.zero_force)
        moves = problem.gap_rates(self.at, z[:n])
        for k, (pair, terms, (p, q)) in enumerate(self.pairs):
            p1 = p + z[n + pair.first : n + pair.first + pair.n]
            gap = terms.gap + moves[k][0]
            small = SAME * max(float(np.abs(p1 * terms.area).max(initial=0.0)), none)
            bad = (states[k] == OPEN) & (gap * pair.stiffness < -small)
            bad |= (states[k] != OPEN) & (p1 * terms.area < -small)
            if pair.rubs:
                q1 = q + z[n + pair.first + pair.n : n + pair.first + pair.width]
                over = (np.abs(q1) - pair.friction * np.maximum(p1, 0.0)) * terms.area > small
                bad |= (states[k] == CLOSED) & over
            bad &= self.able[k]
            bad[chosen[k]] = True
            wanted.append(np.flatnonzero(bad))
        count = sum(map(len, wanted))
        return wanted if sum(map(len, chosen)) < count <= self.most else None

    # -- the linearized problem -------------------------------------------------------

    def _with(self, base: States, chosen: list[Ints]) -> Found | None:
        """Solution from one basis."""
        problem, one = self.problem, self.right_sides
        slip_directions = [np.ones(pair.n) for pair, _, _ in self.pairs]
        for k, (pair, terms, (_, q)) in enumerate(self.pairs):
            if pair.rubs:
                # What sticks would slip against its trial traction.
                slips = (base[k] == SLIPPING) & (q != 0.0)
                slip_directions[k] = np.where(slips, np.sign(q), pair.slip_direction(terms, q))
        problem.slip_directions = slip_directions
        force, rows = self._inputs(base, chosen)
        none = np.zeros_like(force)
        du, dp, _ = problem.solve(
            self.at,
            base,
            RightHandSides(
                np.column_stack([one.force, *(problem.system.at_nodes(f) for f in force.T)]),
                np.column_stack([one.constrained, none]),
                np.append(one.own, none[0]),
                np.column_stack([np.zeros(len(rows)), rows]),
            ),
        )
        driven = self._driven(base)
        if driven is not None:
            return self._with(driven, chosen)

        def joined(values: list[NDArray[Kind]]) -> NDArray[Kind]:
            return np.concatenate([v[own] for v, own in zip(values, chosen, strict=True)])

        found = _core.unilateral(
            joined(base),
            joined(slip_directions),
            joined([pair.friction for pair, _, _ in self.pairs]),
            joined([np.full(pair.n, pair.rubs) for pair, _, _ in self.pairs]),
            *self._values(base, chosen, du, dp),
            None,
            problem.slides,
        )
        if found is None:
            return None
        inputs, now, directions, pressure, shear = found
        u, traction = (table[:, 0] + table[:, 1:] @ inputs for table in (du, dp))
        states = [s.copy() for s in base]
        first = 0
        for k, (own, (pair, terms, (p, q))) in enumerate(zip(chosen, self.pairs, strict=True)):
            part, force = slice(first, first + len(own)), terms.area[own]
            first, before, after = part.stop, base[k][own], now[part]
            states[k][own], slip_directions[k][own] = after, directions[part]
            # What the solution has as an unknown keeps its digits.
            put = (before == OPEN) | (after == OPEN)
            traction[pair.first + own[put]] = (pressure[part] / force - p[own])[put]
            if pair.rubs:
                put = (before != CLOSED) | (after != CLOSED)
                traction[pair.first + pair.n + own[put]] = (shear[part] / force - q[own])[put]
        return np.concatenate([u, traction]), states, slip_directions

    def _driven(self, base: States) -> States | None:
        """A basis in which slips what supports move over the surface; None if nothing of it sticks.

        No traction can hold it, so that its constraint was taken out of the solution.
        """
        border, out = self.problem.border, [s.copy() for s in base]
        for s, (pair, _, _) in zip(out, self.pairs, strict=True):
            if pair.rubs:
                own = slice(pair.first + pair.n, pair.first + pair.width)
                left = np.abs(border.left[own]) + np.abs(border.left_by_others[own])
                moved = np.flatnonzero((s == CLOSED) & (left > pair.noise))
                s[moved] = SLIPPING
                border.dropped.difference_update((own.start + moved).tolist())
        return None if all(map(np.array_equal, out, base)) else out

    def _inputs(self, base: States, chosen: list[Ints]) -> tuple[Floats, Floats]:
        """Two columns of forces and right-hand sides for each constraint, of a unit of force.

        Closed: its gap; open: its pressure. Sticking: its slip; otherwise: its traction.
        """
        count = 2 * sum(map(len, chosen))
        force, rows = np.zeros((self.problem.n + 1, count)), np.zeros((self.problem.term.n, count))
        first = 0
        for own, state, (pair, terms, _) in zip(chosen, base, self.pairs, strict=True):
            acting, i, now = terms.acting, terms.acting.constraint, state[own]
            where = pair.dofs(acting.variables)
            inputs = [(now != OPEN, acting.gap_gradient), (now == CLOSED, acting.slip_gradient)]
            for second, (held, gradient) in enumerate(inputs[: 1 + pair.rubs]):
                column = first + second + 2 * np.arange(len(own))
                rows[pair.first + second * pair.n + own[held], column[held]] = (
                    -1.0 / pair.stiffness[own[held]]
                )
                to = np.full(pair.n, -1, np.int64)
                to[own[~held]] = column[~held]
                on = to[i] >= 0
                unit = gradient[on] / terms.area[i[on], None]
                np.add.at(force, (where[on], to[i[on], None]), unit)
            first += 2 * len(own)
        return force[:-1], rows

    def _values(
        self, base: States, chosen: list[Ints], du: Floats, dp: Floats
    ) -> tuple[Floats, Floats]:
        """Pressures or gaps, tractions or slips as forces: values, then changes by inputs."""

        def table(own: Ints, factor: Floats, now: Floats, changes: Floats) -> Floats:
            out = changes[own]
            out[:, 0] += now[own]
            return factor[own, None] * out

        out: tuple[list[Floats], list[Floats]] = ([], [])
        moves = self.problem.gap_rates(self.at, du)
        each = zip(chosen, base, self.pairs, moves, strict=True)
        for own, state, (pair, terms, tractions), travel in each:
            distances = (terms.gap, terms.slip)
            held = (state[own, None] != OPEN, state[own, None] == CLOSED)
            for k in range(1 + pair.rubs):
                change = dp[pair.first + k * pair.n :][: pair.n]
                inside = table(own, terms.area, tractions[k], change)
                outside = table(own, pair.stiffness, distances[k], travel[k])
                out[k].append(np.where(held[k], inside, outside))
        none = np.zeros((0, dp.shape[1]))
        return np.concatenate(out[0]), np.concatenate([none, *out[1]])
