"""Where contact changes its states along a path, to first order: the predictor passes kinks.

From an equilibrium the direction of the path holds until the first gap closes, the first pressure
vanishes or the first traction reaches the friction bound. From there the direction is that of
the new states, oriented so that the change continues.

Source: the pivoting of parametric linear complementarity, R. W. Cottle, J.-S. Pang and R. E. Stone,
*The Linear Complementarity Problem* (2009), ch. 4.5.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from corota.analysis.path_system import Metric, Point, Tangent
from corota.analysis.terms.contact.pair import CLOSED, COVERED, OPEN, SLIPPING
from corota.errors import SingularError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.contact import ContactTerm

    Floats = NDArray[np.float64]
    States = list[NDArray[np.int8]]
    #: Distance, pair, constraint and its new state.
    Event = tuple[float, int, int, int]

#: Most changes in one increment, and share of it within which they happen at once.
MOST, AT_ONCE = 12, 1e-9


class EventSystem(Protocol):
    """Interface of a system with contact on a path for the predictor."""

    n: int
    contact_term: ContactTerm

    def evaluate(self, z: Floats, step_time: float) -> Any:
        """Residual, tangent, gaps and slips."""
        ...

    def restart(self, loose: bool = False, like: Any = None) -> None:
        """Begin an attempt."""
        ...

    def load_rate(self, z: Floats) -> tuple[Floats, Floats]:
        """Change of forces and of prescribed dofs per unit of load factor."""
        ...

    def gap_rates(self, at: Any, rate: Floats) -> list[tuple[Floats, Floats]]:
        """Change of weighted gaps and slips of each pair along a direction."""
        ...

    def rate_with(
        self,
        at: Any,
        states: States,
        force: Floats,
        move: Floats,
        slip_directions: dict[tuple[int, int], float] | None = None,
    ) -> tuple[Floats, int]:
        """Change per unit of load factor with given states, and negative pivots."""
        ...


def predict_through_events(
    path: EventSystem,
    base: Point,
    tangent: Tangent,
    metric: Metric,
    size: float,
    period: float,
) -> tuple[Point, Tangent, States] | None:
    """Predict a point behind changes of states; None where there is none on the way.

    Parameters
    ----------
    base : Point
        Committed.
    tangent : Tangent
        Direction there.
    size : float
        Distance to go, by the metric.

    Returns
    -------
    point : Point
    tangent : Tangent
        Direction of the last part of the way.
    states : list of ndarray
        Predicted at the point.
    """
    committed = path.contact_term.at
    if committed is None or not committed.states:
        return None
    way = EventPath(path, base, tangent, [s.copy() for s in committed.states])
    left, met = size, None
    for _ in range(MOST):
        event = way.first(None if met is None else met[0])
        if event is None or event[0] >= left:
            break
        distance, k, i, state = event
        way.go(distance)
        left -= distance
        if met is None or distance > AT_ONCE * size:
            met = ((k, i), int(way.states[k][i]), state)
        if not way.change(k, i, state, period) or not way.turn(metric, *met):
            return None
    if met is None:
        return None
    way.go(left)
    return Point(way.z, way.factor, None), way.tangent, way.states


class EventPath:
    """A way along directions of the linearized path.

    Parameters
    ----------
    path : EventSystem
    base : Point
        Committed.
    tangent : Tangent
        Direction there.
    states : list of ndarray
        There; changed in place.
    """

    def __init__(self, path: EventSystem, base: Point, tangent: Tangent, states: States) -> None:
        self.path, self.base, self.tangent, self.states = path, base, tangent, states
        self.at: Evaluation = base.at
        self.gaps = [terms.gap for terms in self.at.contact_state.terms]
        self.z, self.factor = base.u, base.factor
        self.seen = {(k, i, int(s[i])) for k, s in enumerate(states) for i in range(len(s))}
        self.slip_directions: dict[tuple[int, int], float] = {}
        self._changed = False

    def go(self, distance: float) -> None:
        """Go on along the direction."""
        rates = self.path.gap_rates(self.at, self.tangent.u)
        self.gaps = [gap + distance * rate for gap, (rate, _) in zip(self.gaps, rates, strict=True)]
        self.z = self.z + distance * self.tangent.u
        self.factor += distance * self.tangent.factor

    def change(self, k: int, i: int, state: int, period: float) -> bool:
        """Give a constraint another state; False where it had it before."""
        path = self.path
        pair = path.contact_term.pairs[k]
        slides = path.gap_rates(self.at, self.tangent.u)[k][1][i]
        if pair.friction and self.states[k][i] == OPEN and slides != 0.0:
            # A constraint that closes while sliding continues to slip, if possible.
            state, self.slip_directions[k, i] = SLIPPING, -float(np.sign(slides))
        elif state == SLIPPING:
            q = path.contact_term.parts(self.z[path.n :])[k][1][i]
            dq = path.contact_term.parts(self.tangent.u[path.n :])[k][1][i]
            self.slip_directions[k, i] = 1.0 if (q or dq) > 0.0 else -1.0
        if (k, i, state) in self.seen:
            return False
        if not self._changed:
            # The core's derivatives are those of what was evaluated last.
            path.restart()
            self.at = path.evaluate(self.base.u.copy(), self.base.factor * period)
            self._changed = True
        self.seen.add((k, i, state))
        self.states[k][i] = state
        return True

    def turn(self, metric: Metric, where: tuple[int, int], before: int, state: int) -> bool:
        """Take the direction of the states, oriented so that one change continues."""
        path = self.path
        try:
            x, negative = path.rate_with(
                self.at, self.states, *path.load_rate(self.base.u), self.slip_directions
            )
        except SingularError:
            return False
        length, old = metric.size(x, 1.0), self.tangent
        self.tangent = Tangent(x / length, 1.0 / length, negative)
        going = self._going(where, before, state)
        if going < 0.0:
            self.tangent = self.tangent.reversed()
        # Friction lets the path change direction; a reversal would be the opposite loading.
        new, gaps = self.tangent, OPEN in (before, state)
        return going != 0.0 and (gaps or metric.dot(new.u, new.factor, old.u, old.factor) > 0.0)

    def _going(self, where: tuple[int, int], before: int, state: int) -> float:
        """Positive where the direction leads into a new state."""
        (k, i), path = where, self.path
        dp, dq = path.contact_term.parts(self.tangent.u[path.n :])[k]
        dgap, dslip = path.gap_rates(self.at, self.tangent.u)[k]
        if state == OPEN:
            return float(dgap[i])
        if before == OPEN:
            return float(dp[i])
        q = path.contact_term.parts(self.z[path.n :])[k][1][i]
        slip_direction = self.slip_directions.get((k, i), 1.0 if q > 0.0 else -1.0)
        if state == SLIPPING:
            return float(-slip_direction * dslip[i])
        # A constraint that sticks again unloads.
        return float(path.contact_term.pairs[k].friction * dp[i] - slip_direction * dq[i])

    def first(self, latest: tuple[int, int] | None) -> Event | None:
        """The next change along the direction; of several at once, that of the latest first."""
        best: Event | None = None
        path, contact_term = self.path, self.path.contact_term
        tractions, rates = (
            contact_term.parts(self.z[path.n :]),
            contact_term.parts(self.tangent.u[path.n :]),
        )
        moves = path.gap_rates(self.at, self.tangent.u)
        for k, pair in enumerate(contact_term.pairs):
            if pair.tied or pair.law is not None or not pair.n:
                continue
            (p, q), (dp, dq), (dgap, dslip) = tractions[k], rates[k], moves[k]
            state, seen = self.states[k], self.at.contact_state.terms[k].area > COVERED * pair.full
            found = [
                (_reach(self.gaps[k], -dgap, seen & (state == OPEN)), CLOSED),
                (_reach(p, -dp, state != OPEN), OPEN),
            ]
            if pair.friction:
                mu, sticks = pair.friction, state == CLOSED
                for sign in (1.0, -1.0):
                    margin = _reach(mu * p - sign * q, sign * dq - mu * dp, sticks)
                    found.append((margin, SLIPPING))
                slip_direction = np.sign(q)
                for (which, i), other in self.slip_directions.items():
                    if which == k:
                        slip_direction[i] = other
                found.append((_reach(0.0 * q, dslip * slip_direction, state == SLIPPING), CLOSED))
            for ways, new in found:
                i = int(np.argmin(ways))
                if latest is not None and latest[0] == k and ways[latest[1]] <= ways[i]:
                    i = latest[1]
                if ways[i] < (np.inf if best is None else best[0]):
                    best = (float(ways[i]), k, i, new)
        return best


def _reach(margin: Floats, rate: Floats, which: NDArray[np.bool_]) -> Floats:
    """Distances after which quantities that decrease at a rate reach zero."""
    shrinks = which & (rate > 0.0)
    return np.where(shrinks, np.maximum(margin, 0.0) / np.where(shrinks, rate, 1.0), np.inf)


__all__ = ["predict_through_events"]
