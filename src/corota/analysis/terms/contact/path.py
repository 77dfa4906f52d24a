"""A system with contact on an equilibrium path: dofs, then multipliers, and the load factor.

Lengths are those of displacements alone. Every attempt begins with the states of the last
commit; a point's own states give the direction of the path there.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.path_system import NOT_CONSERVATIVE, SmoothPath
from corota.analysis.terms.contact.equations import MAX_EXTRA_CONTACT_ITERATIONS, ContactEquations
from corota.analysis.terms.contact.event_predictor import predict_through_events
from corota.analysis.terms.contact.pair import CLOSED, OPEN, SLIPPING
from corota.analysis.terms.contact.problem import RightHandSides
from corota.errors import ModelError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.path_system import Metric, Point, Tangent

    Floats = NDArray[np.float64]
    States = list[NDArray[np.int8]]

#: Message for slipping friction, where stability is unknown.
SLIPS = (
    "friction slips, and has no potential: the tangent is not symmetric, its pivots do not show "
    "stability there (use dynamics)"
)


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

    more_iterations = MAX_EXTRA_CONTACT_ITERATIONS

    def __init__(self, system: System, notes: list[str]) -> None:
        super().__init__(system)
        contact_term = self.contact_term
        for pair in contact_term.pairs:
            ramped = getattr(pair.item, "start", "") == "ramp" and contact_term.number == 1
            if ramped and pair.overlap.any():
                raise ModelError(
                    f"contact pair {pair.name!r} overlaps at the start, which start='ramp' would "
                    "remove over a step that follows a path; use a static step before, or "
                    "start='keep' or 'adjust'",
                    pair.item.where,
                )
        contact_term.damps = False
        self.notes = notes
        self.n_dofs, self.length = system.n_dofs, system.length
        self.counted = np.concatenate([system.counted, np.zeros(contact_term.n, bool)])
        #: States of the direction at the committed state, with which an attempt begins.
        self._base: States | None = None
        #: Whether nothing was tried since, and whether an attempt may bring bodies into contact.
        self._fresh, self._loose = True, False

    @property
    def not_conservative(self) -> str:
        """Why pivots do not show stability."""
        return SLIPS if any(p.friction for p in self.contact_term.pairs) else NOT_CONSERVATIVE

    def restart(self, loose: bool = False, like: Evaluation | None = None) -> None:
        """Begin an attempt with the states of the last commit, or of another evaluation."""
        self.contact_term.revert()
        self.forget()
        self._fresh, self._loose = False, loose
        first = (
            self._base if not (like and like.contact_state.settled) else like.contact_state.settled
        )
        if first is not None:
            self.last = [s.copy() for s in first]

    def rows(self, z: Floats, step_time: float) -> Floats:
        """Forces at dofs, then gaps and slips in the rows of the multipliers."""
        at = self.evaluate(z, step_time)
        parts = [at.internal]
        for pair, terms in zip(self.contact_term.pairs, at.contact_state.terms, strict=True):
            parts += [-terms.gap, -terms.slip] if pair.two else [-terms.gap]
        return np.concatenate(parts)

    def load_rate(self, z: Floats) -> tuple[Floats, Floats]:
        """Change of forces and of prescribed dofs per unit of load factor, 0 for multipliers."""
        none = np.zeros(self.contact_term.n)
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
        x, _ = self._columns(at, right_sides, self._choose(at.contact_state))
        return x[:, 0], x[:, 1]

    def rate(self, at: Evaluation, force: Floats, move: Floats) -> tuple[Floats, int]:
        """Change per unit of load factor with the states of a point, and negative pivots.

        The pivots are those of the bodies: one for each closed constraint is taken off.
        """
        states = self._settled(at)
        if self._fresh:
            self._base = states
        return self.rate_with(at, states, force, move)

    def rate_with(
        self,
        at: Evaluation,
        states: States,
        force: Floats,
        move: Floats,
        slip_directions: dict[tuple[int, int], float] | None = None,
    ) -> tuple[Floats, int]:
        """The same with given states, and senses of slip of some (pair, constraint)."""
        self._loose = False
        right_sides = RightHandSides(force[: self.n, None], move[: self.n, None], np.zeros(1))
        x, negative = self._columns(at, right_sides, states, slip_directions)
        return x[:, 0], negative

    def around(
        self, base: Point, tangent: Tangent, metric: Metric, size: float, period: float
    ) -> tuple[Point, Tangent] | None:
        """A point behind the next kinks, and the direction there."""
        if self.contact_term.at is not None:
            self._base = None
        found = predict_through_events(self, base, tangent, metric, size, period)
        if found is None:
            return None
        point, now, self._base = found
        return point, now

    def solve_with_last_factor(self, rhs: Floats) -> Floats:
        """All unknowns for forces of shape (n_dofs,), with the last factorization."""
        return np.concatenate(self.border.correct_with_last_factor(rhs))

    def ahead(self, at: Evaluation, rate: Floats) -> float:
        """Whether state changes since the commit continue along a direction.

        Where a constraint closed its pressure grows from zero; where one opened its gap does;
        so does the slip of what began to slip.
        """
        if self.contact_term.at is None:
            return 0.0
        gaps = self.gap_rates(at, rate)
        total = 0.0
        for k, (pair, (dp, _)) in enumerate(
            zip(self.contact_term.pairs, self.contact_term.parts(rate[self.n :]), strict=True)
        ):
            before, now = self.contact_term.at.states[k], self._settled(at)[k]
            area = np.maximum(at.contact_state.terms[k].area, pair.full)
            closed, opened = (before == OPEN) & (now != OPEN), (before != OPEN) & (now == OPEN)
            total += float((dp * area)[closed].sum())
            total += float((gaps[k][0] * pair.stiffness)[opened].sum())
            slid = (before == CLOSED) & (now == SLIPPING)
            slip = at.contact_state.terms[k].slip
            total += float((np.sign(slip) * gaps[k][1] * pair.stiffness)[slid].sum())
        return total

    def has_corner(self, base: Point, point: Point, period: float) -> bool:
        """Only kinks of contact are known."""
        return False

    def commit(self) -> None:
        """Accept the last evaluated state, of bodies and contact."""
        u, self.contact_state = self.contact_term.last
        self.system.commit()
        self.notes += self.accept(u, self.contact_state.time)
        self._base, self._fresh = None, True

    # -- parts -------------------------------------------------------------------------

    def _settled(self, at: Evaluation) -> States:
        """States of a point: as the last correction left them, if one was made."""
        state = at.contact_state
        if not state.settled:
            corrected = self.last if self.corrections else None
            before: Any = corrected or [None] * len(self.contact_term.pairs)
            state.settled = [
                pair.states(terms, p, q, last)
                for (pair, terms, (p, q)), last in zip(self._pairs(state), before, strict=True)
            ]
        return state.settled

    def gap_rates(self, at: Evaluation, rate: Floats) -> list[tuple[Floats, Floats]]:
        """Change of weighted gaps and slips of each pair along a direction."""
        moved = np.append(rate[: self.n], 0.0)
        out = []
        for pair, terms in zip(self.contact_term.pairs, at.contact_state.terms, strict=True):
            du = moved[self.contact_term.dofs(terms.variables)]
            gap, slip = np.zeros(pair.n), np.zeros(pair.n)
            np.add.at(gap, terms.constraint, (terms.gap_gradient * du).sum(axis=1))
            np.add.at(slip, terms.constraint, (terms.slip_gradient * du).sum(axis=1))
            out.append((gap, slip))
        return out

    def _held(
        self, at: Evaluation, states: States, right_sides: RightHandSides
    ) -> tuple[Floats, Floats, int, States]:
        """Correction with unchanged states: on a path, a singular stiffness is a critical point.

        Unconstrained bodies are brought into contact only at the start of a path.
        """
        if self._loose:
            return super()._held(at, states, right_sides)
        return *self._solve(at, states, right_sides), states

    # A control bounds the correction that is made: none of its parts is one by itself.

    def _far(self, du: Floats, right_sides: RightHandSides) -> bool:
        return False

    def _let_slip(self, at: Any, states: States, right_sides: RightHandSides, found: Any) -> Any:
        return *found, states


def path_system(system: System, notes: list[str]) -> Any:
    """The system for path following; `notes` collects remarks for the user."""
    return ContactPathEquations(system, notes) if system.contact_term.pairs else SmoothPath(system)


__all__ = ["SLIPS", "ContactPathEquations", "path_system"]
