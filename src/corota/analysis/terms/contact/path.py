"""A system with contact on an equilibrium path: dofs, then multipliers, and the load factor.

Every attempt begins with the states of the last commit; a point's own states give the direction of
the path there. It holds until the first gap closes, the first pressure vanishes or the first
traction reaches the friction bound. From there the direction is that of the new states, oriented so
that the change continues: to first order the predictor passes such kinks.

Source: the pivoting of parametric linear complementarity, R. W. Cottle, J.-S. Pang and R. E. Stone,
*The Linear Complementarity Problem* (2009), ch. 4.5.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.path_system import NOT_CONSERVATIVE, Metric, Point, SmoothPath, Tangent
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.equations import ContactEquations
from corota.analysis.terms.contact.gaps import (
    PATIENCE,
    SAME,
    SMALL,
    WAITED,
    RightHandSides,
    covered,
)
from corota.analysis.terms.contact.pivoting import Pivoting
from corota.errors import ModelError, SingularError

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.gaps import States
    from corota.arrays import Bools, Floats

    Event = tuple[float, int, int, int]


class ContactPathEquations(ContactEquations):
    """See :class:`corota.analysis.path_system.PathSystem`.

    Parameters
    ----------
    system : System
    notes : list of str
        Takes remarks for the user.

    Raises
    ------
    ModelError
        If an overlap is to be ramped along the path.
    """

    more_iterations = WAITED * PATIENCE
    #: By the control of the path.
    bounded = True

    def __init__(self, system: System, notes: list[str]) -> None:
        super().__init__(system)
        term = self.term
        for pair in term.pairs:
            ramped = getattr(pair.item, "start", "") == "ramp" and term.number == 1
            if ramped and pair.overlap.any():
                raise ModelError(
                    f"contact pair {pair.name!r} overlaps at the start, which start='ramp' would "
                    "remove over a step that follows a path; use a static step before, or "
                    "start='keep' or 'adjust'",
                    pair.item.where,
                )
        term.damps = False
        self.notes = notes
        self.n_dofs, self.length = system.n_dofs, system.length
        self.counted = np.concatenate([system.counted, np.zeros(term.n, bool)])
        #: States of the direction at the committed state, with which an attempt begins.
        self._base: States | None = None
        #: Whether nothing was tried since. An attempt brings bodies into contact at the start
        #: only: on a path, a singular stiffness is a critical point.
        self._fresh, self.holds = True, False

    @property
    def not_conservative(self) -> str:
        """Why pivots do not show stability."""
        if not any(pair.rubs for pair in self.term.pairs):
            return NOT_CONSERVATIVE
        return (
            "friction slips, and has no potential: the tangent is not symmetric, its pivots do not "
            "show stability there (use dynamics)"
        )

    def restart(self, loose: bool = False, like: Evaluation | None = None) -> None:
        """Begin an attempt with the states of the last commit, or of another evaluation."""
        self.term.revert()
        self.forget((like and like.contact_state.settled) or self._base)
        self._fresh, self.holds = False, loose

    def take_over(self, at: Evaluation, last: Evaluation) -> None:
        """Take the tangent of flow; what slips goes on: its traction alone could stick as well."""
        at.values[:] = last.values
        if self.term.at is not None:
            at.contact_state.settled = [s.copy() for s in self.term.at.states]

    def rows(self, z: Floats, step_time: float) -> Floats:
        """Forces at dofs, then gaps and slips in the rows of the multipliers."""
        at = self.evaluate(z, step_time)
        parts = [at.internal]
        for pair, terms in zip(self.term.pairs, at.contact_state.terms, strict=True):
            parts += [-terms.gap, -terms.slip] if pair.two else [-terms.gap]
        return np.concatenate(parts)

    def load_rate(self, z: Floats) -> tuple[Floats, Floats]:
        """Change of forces and of prescribed dofs per unit of load factor, 0 for multipliers."""
        none = np.zeros(self.term.n)
        force, move = self.system.load_rate(z[: self.n])
        return np.concatenate([force, none]), np.concatenate([move, none])

    def advance(self, at: Evaluation, force: Floats, move: Floats) -> tuple[Floats, Floats]:
        """Newton correction, and the change per unit of load factor with the same states."""
        n = self.n
        right_sides = RightHandSides(
            np.stack([-at.residual, force[:n]], axis=1),
            np.stack([np.zeros(n), move[:n]], axis=1),
            np.array([1.0, 0.0]),
        )
        x, _ = self.columns(at, right_sides, self.chosen(at.contact_state))
        return x[:, 0], x[:, 1]

    def rate(self, at: Evaluation, force: Floats, move: Floats) -> tuple[Floats, int]:
        """Change per unit of load factor with the states of a point, and negative pivots.

        The pivots are those of the bodies: one for each closed constraint is taken off.
        """
        n, found = self.n, None
        if self._fresh and not self.corrections and not at.contact_state.settled:
            # With a small first load: what touches without pressure may open, stick or slip, and
            # so may what is at its bound.
            load = RightHandSides(SMALL * force[:n, None], SMALL * move[:n, None], np.ones(1))
            found = Pivoting(self, at, load).solve()
        _, states, signs = found or (None, self._settled(at), None)
        if self._fresh:
            self._base = states
        return self.rate_with(at, states, force, move, signs)

    def rate_with(
        self,
        at: Evaluation,
        states: States,
        force: Floats,
        move: Floats,
        signs: list[Floats] | None = None,
    ) -> tuple[Floats, int]:
        """The same with given states, and signs of slipping tractions; 0 where not given."""
        self.holds = False
        right_sides = RightHandSides(force[: self.n, None], move[: self.n, None], np.zeros(1))
        x, negative = self.columns(at, right_sides, states, signs)
        return x[:, 0], negative

    def around(
        self, base: Point, tangent: Tangent, metric: Metric, size: float, period: float
    ) -> tuple[Point, Tangent] | None:
        """A point behind the next changes of states, and the direction there; None without any.

        `size` is the distance to go, by the metric.
        """
        committed = self.term.at
        if committed is None:
            return None
        self._base = None
        way = EventPath(self, base, tangent, [s.copy() for s in committed.states])
        left, met = size, None
        while True:  # no constraint takes a state twice
            event = way.first(None if met is None else met[0])
            if event is None or event[0] >= left:
                break
            distance, k, i, state = event
            way.go(distance)
            left -= distance
            if met is None or distance > SAME * size:
                met = ((k, i), int(way.states[k][i]), state)
            if not way.change(k, i, state, period) or not way.turn(metric, *met):
                return None
        if met is None:
            return None
        way.go(left)
        self._base = way.states
        return Point(way.z, way.factor, None), way.tangent

    def solve_with_last_factor(self, rhs: Floats) -> Floats:
        """All unknowns for forces of shape (n_dofs,), with the last factorization."""
        return np.concatenate(self.border.correct_with_last_factor(rhs))

    def ahead(self, at: Evaluation, rate: Floats) -> float:
        """Whether state changes since the commit continue along a direction.

        Where a constraint closed its pressure grows from zero; where one opened its gap does;
        so does the slip of what began to slip.
        """
        if self.term.at is None:
            return 0.0
        each = zip(
            self.term.each(at.contact_state.terms, rate[self.n :]),
            self.gap_rates(at, rate[: self.n]),
            self.term.at.states,
            self._settled(at),
            strict=True,
        )
        total = 0.0
        for (pair, terms, (dp, _)), (dgap, dslip), before, now in each:
            closed, opened = (before == OPEN) & (now != OPEN), (before != OPEN) & (now == OPEN)
            slid = (before == CLOSED) & (now == SLIPPING)
            total += float((dp * np.maximum(terms.area, pair.full))[closed].sum())
            total += float((dgap * pair.stiffness)[opened].sum())
            total += float((np.sign(terms.slip) * dslip * pair.stiffness)[slid].sum())
        return total

    def has_corner(self, base: Point, point: Point, period: float) -> bool:
        """Only kinks of contact are known."""
        return False

    def commit(self) -> None:
        """Accept the last evaluated state, of bodies and contact."""
        u, self.contact_state = self.term.last
        self.system.commit()
        self.notes += self.accept(u, self.contact_state.time)
        self._base, self._fresh = None, True

    # -- parts -------------------------------------------------------------------------

    def _settled(self, at: Evaluation) -> States:
        """States of a point: as the last correction left them, if one was made."""
        state = at.contact_state
        if not state.settled:
            corrected = self.last if self.corrections else None
            state.settled = self.term.states(state.terms, state.multipliers, corrected)
        return state.settled


def path_system(system: System, notes: list[str]) -> SmoothPath | ContactPathEquations:
    """The system for path following; `notes` collects remarks for the user."""
    return (
        ContactPathEquations(system, notes)
        if system.term(ContactTerm).pairs
        else SmoothPath(system)
    )


class EventPath:
    """A way along directions of the linearized path, from a committed point and its states."""

    def __init__(
        self, path: ContactPathEquations, base: Point, tangent: Tangent, states: States
    ) -> None:
        self.path, self.base, self.tangent, self.states = path, base, tangent, states
        self.at = base.evaluation
        self.gaps = [terms.gap for terms in self.at.contact_state.terms]
        self.z, self.factor = base.u, base.factor
        self.seen = {(k, i, int(s[i])) for k, s in enumerate(states) for i in range(len(s))}
        #: Signs of the tractions of what slips since; 0 elsewhere.
        self.signs = [np.zeros(len(s)) for s in states]
        self._changed = False

    @property
    def moves(self) -> list[tuple[Floats, Floats]]:
        """Changes of gaps and slips of each pair along the direction."""
        return self.path.gap_rates(self.at, self.tangent.u[: self.path.n])

    def tractions(self, z: Floats) -> list[tuple[Floats, Floats]]:
        """Pressures and shear tractions of each pair in all unknowns, or in their changes."""
        return self.path.term.parts(z[self.path.n :])

    def go(self, distance: float) -> None:
        """Go on along the direction."""
        each = zip(self.gaps, self.moves, strict=True)
        self.gaps = [gap + distance * rate for gap, (rate, _) in each]
        self.z = self.z + distance * self.tangent.u
        self.factor += distance * self.tangent.factor

    def change(self, k: int, i: int, state: int, period: float) -> bool:
        """Give a constraint another state; False where it had it before."""
        slides = self.moves[k][1][i]
        if self.path.term.pairs[k].rubs and self.states[k][i] == OPEN and slides != 0.0:
            # A constraint that closes while sliding continues to slip, if possible.
            state, self.signs[k][i] = SLIPPING, -np.sign(slides)
        elif state == SLIPPING:
            q, dq = (self.tractions(z)[k][1][i] for z in (self.z, self.tangent.u))
            self.signs[k][i] = 1.0 if (q or dq) > 0.0 else -1.0
        if (k, i, state) in self.seen:
            return False
        if not self._changed:
            # The core's derivatives are those of what was evaluated last.
            self.path.restart()
            self.at = self.path.evaluate(self.base.u.copy(), self.base.factor * period)
            self._changed = True
        self.seen.add((k, i, state))
        self.states[k][i] = state
        return True

    def turn(self, metric: Metric, where: tuple[int, int], before: int, state: int) -> bool:
        """Take the direction of the states, oriented so that one change continues."""
        path = self.path
        try:
            x, negative = path.rate_with(
                self.at, self.states, *path.load_rate(self.base.u), self.signs
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
        k, i = where
        (dp, dq), (dgap, dslip) = self.tractions(self.tangent.u)[k], self.moves[k]
        if state == OPEN:
            return float(dgap[i])
        if before == OPEN:
            return float(dp[i])
        sign = self.signs[k][i] or (1.0 if self.tractions(self.z)[k][1][i] > 0.0 else -1.0)
        if state == SLIPPING:
            return float(-sign * dslip[i])
        # A constraint that sticks again unloads.
        return float(self.path.term.pairs[k].friction[i] * dp[i] - sign * dq[i])

    def first(self, latest: tuple[int, int] | None) -> Event | None:
        """The next change along the direction; of several at once, that of the latest first."""
        best: Event | None = None
        tractions, rates = (self.tractions(z) for z in (self.z, self.tangent.u))
        moves = self.moves
        for k, pair in enumerate(self.path.term.pairs):
            if pair.tied or pair.law is not None:
                continue
            (p, q), (dp, dq), (dgap, dslip) = tractions[k], rates[k], moves[k]
            state, seen = self.states[k], covered(self.at.contact_state.terms[k].area, pair.full)
            found = [
                (_reach(self.gaps[k], -dgap, seen & (state == OPEN)), CLOSED),
                (_reach(p, -dp, state != OPEN), OPEN),
            ]
            if pair.rubs:
                mu, sticks = pair.friction, state == CLOSED
                for sign in (1.0, -1.0):
                    margin = _reach(mu * p - sign * q, sign * dq - mu * dp, sticks)
                    found.append((margin, SLIPPING))
                signs = np.where(self.signs[k] != 0.0, self.signs[k], np.sign(q))
                found.append((_reach(0.0 * q, dslip * signs, state == SLIPPING), CLOSED))
            for ways, new in found:
                i = int(np.argmin(ways))
                if latest is not None and latest[0] == k and ways[latest[1]] <= ways[i]:
                    i = latest[1]
                if ways[i] < (np.inf if best is None else best[0]):
                    best = (float(ways[i]), k, i, new)
        return best


def _reach(margin: Floats, rate: Floats, which: Bools) -> Floats:
    """Distances after which quantities that decrease at a rate reach zero."""
    shrinks = which & (rate > 0.0)
    return np.where(shrinks, np.maximum(margin, 0.0) / np.where(shrinks, rate, 1.0), np.inf)
