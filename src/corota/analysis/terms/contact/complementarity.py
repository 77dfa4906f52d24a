"""Complementarity problems: by pivoting (Lemke), and by sweeps and active sets for explicit steps.

Linear complementarity problems by Lemke's method.

Source: R. W. Cottle, J.-S. Pang, R. E. Stone, *The Linear Complementarity Problem* (2009), ch. 4.4
and, for ties of the ratio test by lexicographic order, ch. 4.9.

Unilateral constraints with Coulomb friction on bodies whose mass is diagonal.

The forces ``z = (p, q)`` of some constraints change their gaps and slips by ``A z``, where
``A = dt^2 G M^-1 G^T`` is symmetric and at least semidefinite. The set of closed and
slipping constraints is found by Newton's method; where that cycles, by sweeps.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.gaps import CHANGES, CLOSED, COMPLIANCE, HALVINGS, OPEN, SLIPPING

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    States = NDArray[np.int8]
    Law = Callable[[Ints, Floats], tuple[Floats, Floats]]

#: Rounding bounds of Lemke's method: relative size of a pivot that is zero, and difference of
#: ratios that tie.
ZERO, TIE = 1e-11, 1e-10


def lemke(c: Floats, m: Floats) -> tuple[Floats, NDArray[np.bool_]] | None:
    """Solve ``y = c + m x, x >= 0, y >= 0, x y = 0``.

    Parameters
    ----------
    c : ndarray, shape (n,)
    m : ndarray, shape (n, n)
        Rows and columns of like size.

    Returns
    -------
    x : ndarray, shape (n,)
    basic : ndarray of bool, shape (n,)
        Which x are in the basis at the end; their y are zero.
    None
        If the method ends on a ray: there is no solution, or it cannot find one.
    """
    n = len(c)
    basic = np.zeros(n, bool)
    if n == 0 or c.min() >= 0.0:
        return np.zeros(n), basic
    # Columns: y (n), x (n), the artificial variable, right-hand side: y - m x - d t = c.
    table = np.concatenate([np.eye(n), -m, -np.ones((n, 1)), c[:, None]], axis=1)
    base = np.arange(n)
    row = int(np.argmin(c))
    entering = 2 * n
    seen: set[bytes] = set()
    while (now := base.tobytes()) not in seen:  # no basis comes twice, but by rounding
        seen.add(now)
        leaving = int(base[row])
        pivot = table[row] / table[row, entering]
        column = table[:, entering].copy()
        column[row] = 0.0
        table -= np.outer(column, pivot)
        table[row] = pivot
        base[row] = entering
        if leaving == 2 * n:
            x = np.zeros(n)
            inside = (base >= n) & (base < 2 * n)
            x[base[inside] - n] = table[inside, -1]
            basic[base[inside] - n] = True
            return np.maximum(x, 0.0), basic
        entering = leaving + n if leaving < n else leaving - n
        column = table[:, entering]
        able = np.flatnonzero(column > ZERO * max(1.0, float(np.abs(column).max())))
        if not len(able):
            return None
        row = _leaving(table, column, able, base, n)
    return None


def _leaving(
    table: Floats, column: Floats, able: NDArray[np.int64], base: NDArray[np.int64], n: int
) -> int:
    """Row that leaves the basis; of ties the artificial variable, then the lexicographic least."""
    ratio = np.maximum(table[able, -1], 0.0) / column[able]
    size = max(float(np.abs(table[:, -1]).max()) / max(float(np.abs(column).max()), 1e-300), 1e-300)
    tied = able[ratio <= ratio.min() + TIE * min(size, max(float(ratio.min()), 1e-4 * size))]
    final = np.flatnonzero(base[tied] == 2 * n)
    if len(final):
        return int(tied[final[0]])
    for k in range(n):
        if len(tied) == 1:
            break
        other = table[tied, k] / column[tied]
        tied = tied[other <= other.min() + TIE * max(1.0, float(np.abs(other).max()))]
    # Of rows that are equal to rounding, the one with the largest pivot.
    return int(tied[np.argmax(column[tied])])


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
    tied: NDArray[np.bool_]
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


__all__ = ["UnilateralConstraints", "lemke"]
