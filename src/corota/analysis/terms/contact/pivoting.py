"""Contact states from the whole linearized problem, where individual choices cycle.

A semismooth Newton method chooses the state of each constraint by itself. Where constraints
depend on each other, as at the friction bound of a body held only by friction, such choices
may never converge. Here the linearized equations with all their conditions, a linear
complementarity
problem, are solved by pivoting (Lemke, in the core): every correction then satisfies all conditions
to first order (the method of Josephy and Newton). Nothing is regularized.

Sources: A. Klarbring, *A mathematical programming approach to three-dimensional contact problems
with friction*, Comput. Methods Appl. Mech. Engrg. 58 (1986); N. H. Josephy, *Newton's method for
generalized equations*, MRC report 1965 (1979).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import corota._core as _core
from corota.analysis.terms.contact.gaps import SAME, RightHandSides, covered, sticking
from corota.analysis.terms.contact.pair import CLOSED, OPEN, SLIPPING
from corota.errors import SingularError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.equations import ContactEquations
    from corota.arrays import Bools, Floats, Ints

    States = list[NDArray[np.int8]]
    #: Correction of dofs and multipliers, its states, signs of slipping tractions.
    Found = tuple[Floats, States, list[Floats]]

#: Size of the linear complementarity problem: most constraints (its cost grows with the cube); a
#: tenth of them may be open ones from the start.
MOST = 500


@dataclass
class Chosen:
    """Constraints of one pair that are chosen together.

    Parameters
    ----------
    k : int
        Pair.
    rows : ndarray of int, shape (n,)
        Constraints.
    force, gap : ndarray, shape (n,)
        Force of a unit of traction, and of a unit of weighted gap.
    """

    k: int
    rows: Ints
    force: Floats
    gap: Floats


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

    def solve(self, bases: list[States]) -> Found | None:
        """Correction of dofs and multipliers, its states and senses; None where none is found.

        Parameters
        ----------
        bases : list of list of ndarray
            Initial states, the best first; states with a singular tangent are skipped.
        """
        for base in bases:
            chosen: list[Chosen] | None = self._first(base)
            while chosen is not None:
                try:
                    found = self._with(base, chosen)
                except SingularError:
                    break
                if found is None:
                    break
                z, states, slip_directions = found
                chosen = self._violated(z, states, chosen)
                if chosen is None:
                    return z, states, slip_directions
        return None

    # -- which constraints ------------------------------------------------------------

    def _able(self, k: int) -> Bools:
        """Constraints that may change their state."""
        pair, terms, _ = self.pairs[k]
        if pair.tied or pair.law is not None or pair.shear_limit < np.inf or not pair.separates:
            return np.zeros(pair.n, bool)
        able: Bools = covered(terms.area, pair.full) & np.isfinite(pair.stiffness)
        return able

    def _first(self, base: States) -> list[Chosen]:
        """Closed constraints, and the nearest open ones."""
        wanted = []
        for k, (pair, terms, _) in enumerate(self.pairs):
            able = self._able(k)
            gap = np.where(able & (base[k] == OPEN), terms.gap * pair.stiffness, np.inf)
            near = np.argsort(gap, kind="stable")[: MOST // 10]
            mask = able & (base[k] != OPEN)
            mask[near[np.isfinite(gap[near])]] = True
            wanted.append(mask)
        return self._listed(wanted)

    def _listed(self, wanted: list[Bools]) -> list[Chosen]:
        left = MOST
        out = []
        for k, mask in enumerate(wanted):
            rows = np.flatnonzero(mask)[:left]
            left -= len(rows)
            pair, terms, _ = self.pairs[k]
            if len(rows):
                out.append(Chosen(k, rows, terms.area[rows], pair.stiffness[rows]))
        return out

    def _violated(self, z: Floats, states: States, chosen: list[Chosen]) -> list[Chosen] | None:
        """The choice with the constraints that a solution would violate; None if there are none."""
        problem = self.problem
        n, more = problem.n, False
        wanted = []
        moves = problem.gap_rates(self.at, z[:n])
        for k, (pair, terms, (p, q)) in enumerate(self.pairs):
            mask = np.zeros(pair.n, bool)
            for c in chosen:
                if c.k == k:
                    mask[c.rows] = True
            p1 = p + z[n + pair.first : n + pair.first + pair.n]
            gap = terms.gap + moves[k][0]
            small = SAME * max(float(np.abs(p1 * terms.area).max(initial=0.0)), _small(problem))
            bad = (states[k] == OPEN) & (gap * pair.stiffness < -small)
            bad |= (states[k] != OPEN) & (p1 * terms.area < -small)
            if pair.rubs:
                q1 = q + z[n + pair.first + pair.n : n + pair.first + pair.width]
                over = (np.abs(q1) - pair.friction * np.maximum(p1, 0.0)) * terms.area > small
                bad |= (states[k] == CLOSED) & over
            bad &= self._able(k) & ~mask
            more = more or bool(bad.any())
            wanted.append(mask | bad)
        if not more or sum(int(w.sum()) for w in wanted) > MOST:
            return None
        return self._listed(wanted)

    # -- the linearized problem -------------------------------------------------------

    def _with(self, base: States, chosen: list[Chosen]) -> Found | None:
        """Solution from one basis."""
        problem, n = self.problem, self.problem.n
        slip_directions = [np.ones(pair.n) for pair, _, _ in self.pairs]
        for k, (pair, terms, (_, q)) in enumerate(self.pairs):
            if pair.rubs:
                # What sticks would slip against its trial traction.
                slips = (base[k] == SLIPPING) & (q != 0.0)
                slip_directions[k] = np.where(slips, np.sign(q), pair.slip_direction(terms, q))
        problem.slip_directions = slip_directions
        force, rows = self._inputs(base, chosen, slip_directions)
        one = self.right_sides
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
        values = [self._values(base, c, slip_directions[c.k], du, dp) for c in chosen]
        return self._pivoted(base, chosen, slip_directions, values, du, dp, n)

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

    def _inputs(
        self, base: States, chosen: list[Chosen], slip_directions: list[Floats]
    ) -> tuple[Floats, Floats]:
        """Two columns of forces and right-hand sides for each constraint.

        Closed: a unit of gap; open: a unit of pressure. Sticking: a unit of slip; slipping or
        open: a unit of traction less than the bound.
        """
        problem = self.problem
        count = 2 * sum(len(c.rows) for c in chosen)
        force, rows = np.zeros((problem.n + 1, count)), np.zeros((problem.term.n, count))
        at = 0
        for c in chosen:
            pair, terms, _ = self.pairs[c.k]
            column = np.full(pair.n, -1, np.int64)
            column[c.rows] = at + 2 * np.arange(len(c.rows))
            state, slip_direction = base[c.k], slip_directions[c.k]
            acting = terms.acting
            where = pair.dofs(acting.variables)
            i = acting.constraint
            of_open = (column[i] >= 0) & (state[i] == OPEN)
            push = acting.gap_gradient
            if pair.two:
                push = push + (pair.friction * slip_direction)[i, None] * acting.slip_gradient
            wide = where.shape[1]
            np.add.at(
                force,
                (where[of_open], np.repeat(column[i][of_open][:, None], wide, 1)),
                push[of_open],
            )
            closed = c.rows[state[c.rows] != OPEN]
            rows[pair.first + closed, column[closed]] = -1.0
            if pair.two:
                less = (column[i] >= 0) & (state[i] != CLOSED)
                np.add.at(
                    force,
                    (where[less], np.repeat(column[i][less][:, None] + 1, wide, 1)),
                    -slip_direction[i[less], None] * acting.slip_gradient[less],
                )
                stuck = c.rows[state[c.rows] == CLOSED]
                rows[pair.first + pair.n + stuck, column[stuck] + 1] = -1.0
            at += 2 * len(c.rows)
        return force[:-1], rows

    def _values(
        self, base: States, c: Chosen, slip_direction: Floats, du: Floats, dp: Floats
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Pressure, gap, slip and traction as forces: values, then changes by inputs."""
        problem = self.problem
        pair, terms, (p, q) = self.pairs[c.k]
        (moves,) = problem.gap_rates(self.at, du, c.k)
        gap, slip = moves[0][c.rows], moves[1][c.rows]
        gap[:, 0] += terms.gap[c.rows]
        slip[:, 0] += terms.slip[c.rows]
        pressure = dp[pair.first + c.rows].copy()
        pressure[:, 0] += p[c.rows]
        shear = np.zeros_like(pressure)
        if pair.two:
            stuck = dp[pair.first + pair.n + c.rows].copy()
            stuck[:, 0] += q[c.rows]
            shear = np.where((base[c.k][c.rows] == CLOSED)[:, None], stuck, shear)
        force, stiff = c.force[:, None], c.gap[:, None]
        return pressure * force, gap * stiff, slip * stiff, shear * force

    def _pivoted(
        self,
        base: States,
        chosen: list[Chosen],
        slip_directions: list[Floats],
        values: list[tuple[Floats, Floats, Floats, Floats]],
        du: Floats,
        dp: Floats,
        n: int,
    ) -> Found | None:
        """Set up the complementarity problem, solve it, and go back to corrections."""
        blocks = []  # (table of y by columns, scale, column) of each complementary pair
        kinds: list[tuple[int, int, str]] = []
        inputs: list[tuple[int, float]] = []
        at = 1
        for c, (pressure, gap, slip, shear) in zip(chosen, values, strict=True):
            pair = self.pairs[c.k][0]
            for j, i in enumerate(c.rows.tolist()):
                state, slip_direction = base[c.k][i], slip_directions[c.k][i]
                first, second = at + 2 * j, at + 2 * j + 1
                if state == OPEN:
                    blocks.append(gap[j])
                    kinds.append((c.k, i, "gap"))
                    inputs.append((first, 1.0 / c.force[j]))
                else:
                    blocks.append(pressure[j])
                    kinds.append((c.k, i, "pressure"))
                    inputs.append((first, 1.0 / c.gap[j]))
                if not pair.rubs:
                    continue
                mu = pair.friction[i]
                if state == CLOSED:
                    # The slip is the difference of two; each goes with one side of the bound.
                    blocks += [mu * pressure[j] + shear[j], mu * pressure[j] - shear[j]]
                    kinds += [(c.k, i, "forth"), (c.k, i, "back")]
                    inputs += [(second, 1.0 / c.gap[j]), (second, -1.0 / c.gap[j])]
                    continue
                # Slack of the bound against the slip along it, and of the other side.
                bound = pressure[j].copy()
                if state == OPEN:
                    bound[:] = 0.0
                    bound[first] = c.force[j]
                other = 2.0 * mu * bound
                other[second] -= c.force[j]
                blocks += [-slip_direction * slip[j], other]
                kinds += [(c.k, i, "along"), (c.k, i, "against")]
                inputs += [(second, 1.0 / c.force[j]), (-1, float(slip_direction))]
            at += 2 * len(c.rows)
        if not kinds:
            return None
        y = np.array(blocks)
        size = len(kinds)
        m = np.zeros((size, size))
        for a, (column, factor) in enumerate(inputs):
            if column >= 0:
                m[:, a] = factor * y[:, column]
        for a, (_, _, kind) in enumerate(kinds):
            if kind == "along":
                m[a, a + 1] += 1.0  # the slip against the traction is one of two that differ
        found = _core.lemke(y[:, 0], m)
        if found is None and self.problem.slides:
            found = _core.lemke(y[:, 0], m, _sliding(y[:, 0], m, kinds))
        if found is None:
            return None
        x, basic = found
        u, traction = du[:, 0].copy(), dp[:, 0].copy()
        for a, (column, factor) in enumerate(inputs):
            if column >= 0 and x[a] != 0.0:
                u += x[a] * factor * du[:, column]
                traction += x[a] * factor * dp[:, column]
        states, slip_directions = self._read(
            base, chosen, slip_directions, kinds, x, basic, inputs, traction
        )
        return np.concatenate([u, traction]), states, slip_directions

    def _read(
        self,
        base: States,
        chosen: list[Chosen],
        slip_directions: list[Floats],
        kinds: list[tuple[int, int, str]],
        x: Floats,
        basic: Bools,
        inputs: list[tuple[int, float]],
        traction: Floats,
    ) -> tuple[States, list[Floats]]:
        """States of a solution; tractions of slipping or opening constraints are corrected."""
        out = [s.copy() for s in base]
        slip_direction = [s.copy() for s in slip_directions]
        slack = {}
        for a, (k, i, kind) in enumerate(kinds):
            was, on = base[k][i], bool(basic[a])
            if kind == "gap":
                out[k][i] = CLOSED if on else OPEN
                if on:
                    pair, _, (p, _) = self.pairs[k]
                    traction[pair.first + i] = x[a] * inputs[a][1] - p[i]
            elif kind == "pressure":
                out[k][i] = OPEN if on else was
            elif out[k][i] == OPEN:
                continue
            elif kind == "forth" and on:
                out[k][i], slip_direction[k][i] = SLIPPING, -1.0
            elif kind == "back" and on:
                out[k][i], slip_direction[k][i] = SLIPPING, 1.0
            elif kind == "along":
                slack[k, i] = x[a] * inputs[a][1]
                out[k][i] = CLOSED if on else SLIPPING
            elif kind == "against" and on:
                out[k][i], slip_direction[k][i] = SLIPPING, -slip_directions[k][i]
        for c in chosen:
            pair, _, (p, q) = self.pairs[c.k]
            for i in c.rows.tolist():
                state = out[c.k][i]
                if state == OPEN:
                    traction[pair.first + i] = -p[i]
                if not pair.rubs:
                    continue
                at = pair.first + pair.n + i
                p1 = p[i] + traction[pair.first + i]
                if state == OPEN:
                    traction[at] = -q[i]
                elif state == SLIPPING:
                    traction[at] = pair.friction[i] * slip_direction[c.k][i] * p1 - q[i]
                elif base[c.k][i] != CLOSED:
                    s = slip_directions[c.k][i]
                    traction[at] = s * (pair.friction[i] * p1 - slack[c.k, i]) - q[i]
        for k, (pair, _, (p, q)) in enumerate(self.pairs):
            # Slipping tractions of constraints that were not chosen follow their pressure.
            if not pair.rubs:
                continue
            mine = np.ones(pair.n, bool)
            for c in chosen:
                if c.k == k:
                    mine[c.rows] = False
            free = np.flatnonzero(mine & (base[k] != CLOSED))
            bound = pair.bound(p + traction[pair.first : pair.first + pair.n])
            follow = np.where(base[k] == SLIPPING, slip_directions[k] * bound, 0.0)
            traction[pair.first + pair.n + free] = (follow - q)[free]
        return out, slip_direction


def pivoted(problem: ContactEquations, at: Evaluation, right_sides: RightHandSides) -> Found | None:
    """A correction with states from the whole linearized problem; None if there is none."""
    pairs = list(problem.pairs(at.contact_state))
    first = problem.term.states(at.contact_state.terms, at.contact_state.multipliers)
    starts = [first] if problem.last is None else [problem.last, first]
    # With all closed constraints sticking, bodies held by friction are constrained and the matrix
    # is symmetric.
    bases = [sticking(b) for b in starts] + [[s.copy() for s in b] for b in starts]
    for base in bases:
        for s, (pair, terms, _) in zip(base, pairs, strict=True):
            s[~covered(terms.area, pair.full)] = OPEN
    key = [b"".join(s.tobytes() for s in base) for base in bases]
    bases = [base for i, base in enumerate(bases) if key[i] not in key[:i]]
    return Pivoting(problem, at, right_sides).solve(bases)


def _sliding(c: Floats, m: Floats, kinds: list[tuple[int, int, str]]) -> Bools:
    """The basis in which what sticks slips the way it would without shear tractions."""
    names = np.array([kind for _, _, kind in kinds])
    forth, back = np.flatnonzero(names == "forth"), np.flatnonzero(names == "back")
    shear, by_slip = 0.5 * (c[forth] - c[back]), 0.5 * (m[forth] - m[back])[:, forth]
    slip = -np.linalg.lstsq(by_slip, shear, rcond=None)[0]
    out = np.zeros(len(c), bool)
    out[forth], out[back] = slip > 0.0, slip < 0.0
    return out


def _small(problem: ContactEquations) -> float:
    """Force that counts as zero."""
    scales = problem.system.scales
    return SAME * max(scales.force, scales.zero_force)
