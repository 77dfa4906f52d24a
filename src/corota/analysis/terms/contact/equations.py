"""A system with contact for Newton's method: displacements and multipliers together.

The choice of the active set and Newton's method are one loop: every correction is made with the
current states of gaps, slips and tractions (a semismooth Newton method). The
increment is converged when forces balance and gaps, slips and tractions satisfy the conditions
of contact; the set is then constant.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.newton import PROGRESS, Outcome, ResidualNorms
from corota.analysis.terms.contact.contact import few
from corota.analysis.terms.contact.gaps import WAITED
from corota.analysis.terms.contact.impact import impact_error
from corota.analysis.terms.contact.kinks import along_kink, both_sides, keeps_kink
from corota.analysis.terms.contact.messages import explanation
from corota.analysis.terms.contact.pivoting import pivoted
from corota.analysis.terms.contact.problem import ContactProblem, RightHandSides
from corota.analysis.terms.contact.tunneling import outside, passed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Floats

    States = list[NDArray[np.int8]]

#: Complementarity tolerance from which only digits are missing: states that do not change any more
#: are those of the end, and a position on the way is reached.
SETTLED = 1e-6
#: Search radius: displacement of an increment found by pivoting, relative to its first correction,
#: beyond which it counts as a jump to another equilibrium; driven by supports, and by forces, under
#: which it would pass a limit point unseen.
JUMP, JUMP_OF_FORCE = 10.0, 4.0


class ContactEquations(ContactProblem):
    """A system with contact, for one increment: see :class:`ContactProblem`."""

    # -- the protocol of Newton's method -----------------------------------------------

    def start(self, u: Floats) -> Floats:
        """Displacements with the committed multipliers."""
        self.origin = u
        return np.concatenate([u, self.term.committed])

    def residual_norms(self, at: Evaluation, z: Floats) -> ResidualNorms:
        """Size of the residual, of equilibrium and of the contact conditions."""
        norms = self.system.residual_norms(at, z[: self.n])
        if not self.places or not np.array_equal(self.places[-1], z[: self.n]):
            self.places = [*self.places[-2:], z[: self.n].copy()]
        norms.note = self.stage
        complementarity, pair, constraint = self.complementarity(at)
        before = norms.force
        if self.kink is not None:
            stiffness = float(self.kink.move**2 @ self.term.nodal)
            apart = max(abs(self.kink.distance) - self.term.pairs[0].noise, 0.0)
            complementarity = max(complementarity, self.kink.excess, stiffness * apart)
        self.system.scales.add_complementarity(norms, complementarity)
        if norms.force > before:
            node = self.term.pairs[pair].nodes[constraint]
            norms.worst = int(self.system.start[node])
        self.size = norms.size
        if self.corrections:  # before the first one, supports may not have moved
            self.waited = 0 if norms.size < PROGRESS * self.least else self.waited + 1
            self.least = min(self.least, norms.size)
        return norms

    def return_tangent(self, at: Evaluation) -> None:
        """Keep the tangent: states of contact are used later."""

    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction of displacements and multipliers."""
        return self.correct(at, -at.residual, du_prescribed)

    def correct(self, at: Evaluation, rhs: Floats, du_prescribed: Floats) -> tuple[Floats, int]:
        """Correction for a right-hand side of equilibrium; that of contact is added."""
        right_sides = RightHandSides(rhs[: self.n, None], du_prescribed[: self.n, None], np.ones(1))
        if keeps_kink(self, at):
            corrected = along_kink(self, at, right_sides)
            if corrected is not None:
                return corrected
        before = self.pivoting = self.pivoting or self.waited >= WAITED
        z = None
        if before and not self.settles(at):
            self.freeze()
            z = self._by_pivoting(at, right_sides)
        if z is None:
            columns, negative = self.columns(at, right_sides, self.chosen(at.contact_state))
            z, self.stage = columns[:, 0], ""
            if self.pivoting and not before:
                # States chosen one by one did not come to an end.
                found = self._by_pivoting(at, right_sides)
                z = z if found is None else found
        return self.moved(z), -1 if self.pivoting else negative

    def _by_pivoting(self, at: Evaluation, right_sides: RightHandSides) -> Floats | None:
        """A correction with states from the whole linearized problem; None if there is none."""
        found = pivoted(self, at, right_sides)
        if found is None:
            return None
        z, self.last, self.slip_directions = found
        self.pivoted += 1
        self.stage = "contact states by pivoting"
        return z

    def settles(self, at: Evaluation) -> bool:
        """Whether pivoting has found the states, and only digits are missing.

        It adds up the whole tractions of a correction, which leaves their rounding.
        """
        if self.last is None or self.size > SETTLED:
            return False
        state = at.contact_state
        now = self.term.states(state.terms, state.multipliers, self.last)
        return all(np.array_equal(a, b) for a, b in zip(now, self.last, strict=True))

    def inherit_kink(self) -> None:
        """Begin at the kink at which the committed equilibrium lies, if there is one.

        One side of it alone is no equilibrium, and a correction from there may go anywhere.
        """
        kink = self.term.kink
        if kink is not None and self.system.nlgeom and not self.term.persistent:
            self.kink, self.inherits = replace(kink, base=None), True

    # -- the end of an increment -------------------------------------------------------

    def settle(self, outcome: Outcome) -> Outcome:
        """Result of an increment in terms of the system; explains failures."""
        u = outcome.u[: self.n].copy()
        if outcome.converged and outcome.at is not None:
            outcome.reason = self.refuse(outcome.at, outcome.u)
            outcome.converged = not outcome.reason
        settled = replace(outcome, u=u)
        self.contact_state = None if outcome.at is None else outcome.at.contact_state
        if not outcome.converged:
            settled.reason = f"{outcome.reason}{self.explain(outcome.at)}"
            self.term.revert()
        if outcome.converged and self.pivoted:
            said = f"contact states by pivoting in {self.pivoted} iterations"
            settled.note = f"{settled.note}; {said}".strip("; ")
        if outcome.converged and self.kink is not None and self.contact_state is not None:
            state = self.contact_state
            self.contact_state = replace(state, terms=both_sides(self.kink, state.terms))
            said = "equilibrium at a kink of the contact surfaces"
            settled.note = f"{settled.note}; {said}".strip("; ")
        return settled

    def refuse(self, at: Evaluation, z: Floats) -> str:
        """Why an equilibrium is refused; empty if it is not.

        Nodes passed through the opposite surface, or an unconstrained body is far away.
        """
        moves = self.rule.moves
        if not moves and (unlikely := self.system.scales.implausible_displacement(z)):
            return unlikely
        if not self.system.nlgeom:
            return ""
        since = None if moves else self.since
        old, new = (
            self.term.positions(self.term.u if since is None else since),
            self.term.positions(z[: self.n]),
        )
        still = self.pivoted and not self.relaxing and not moves
        if still and not self.near(z[: self.n]):
            return (
                "the equilibrium found is far from the last one: the bodies would jump in this "
                "increment"
            )
        for k, (pair, terms, (p, q)) in enumerate(self.pairs(at.contact_state)):
            starts = partial(outside, self.term, k, moves)
            states = partial(pair.states, terms, p, q)
            found = passed(pair, old, new, states, terms, starts)
            if len(found):
                return (
                    f"node {self.term.label(pair, int(found[0]))} passed through the "
                    f"opposite surface of contact pair {pair.name!r} in one increment"
                )
        return ""

    @property
    def presses(self) -> bool:
        """Whether any contact has a pressure above rounding at the end of the increment."""
        assert self.contact_state is not None
        none = self.system.scales.zero_force
        return any(
            not pair.tied and bool((p * terms.area > none).any())
            for pair, terms, (p, _) in self.pairs(self.contact_state)
        )

    def near(self, u: Floats) -> bool:
        """Whether an equilibrium is near the start, as far as its first correction says."""
        moved = float(np.abs((u - self.origin)[~self.system.is_rotation]).max())
        forces = bool(np.any(self.system.load_rate(u)[0]))
        limit = (JUMP_OF_FORCE if forces else JUMP) * self.first_move
        return limit == 0.0 or moved <= limit

    @property
    def force(self) -> Floats:
        """Of contact on the nodes at the end of the increment, shape (n_dofs,)."""
        assert self.contact_state is not None
        return self.contact_state.force_at_end

    def impact_error(self, moved: Floats, energy: float, tolerance: float, meets: bool) -> float:
        """See :func:`corota.analysis.terms.contact.impact.impact_error`."""
        assert self.contact_state is not None
        return impact_error(self.term, self.contact_state, moved, energy, tolerance, meets)

    def accept(self, u: Floats, step_time: float) -> list[str]:
        """Commit contact with the increment; returns remarks that are new."""
        assert self.contact_state is not None
        self.term.accept(u, self.contact_state, step_time)
        self.term.kink = None if self.kink is None else replace(self.kink, base=None)
        notes = []
        if self.loose and not self.presses and not self.term.reported_loose:
            self.term.reported_loose = True
            notes.append(
                f"no contact is closed, and {self.loose}: the position of that body is "
                "undetermined until contact or a support constrains it"
            )
        dropped: dict[str, list[int]] = {}
        for number in sorted(self.border.dropped - self.term.reported_constraints):
            pair = next(p for p in reversed(self.term.pairs) if p.first <= number)
            constraint = (number - pair.first) % pair.n
            if constraint < pair.of_nodes:  # not a facet between two nodes that are closed as well
                dropped.setdefault(pair.name, []).append(self.term.label(pair, constraint))
        for name, labels in dropped.items():
            notes.append(
                f"contact pair {name!r}: the constraint at node {few(labels)} is redundant and was "
                "dropped: supports, ties or other contact constraints fix the node in that "
                "direction and carry its force"
            )
        self.term.reported_constraints |= self.border.dropped
        return notes

    def explain(self, at: Evaluation | None) -> str:
        """Pair and nodes that caused a failed increment, and what was tried."""
        return explanation(self, at)
