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
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.linear.saddle_point import SaddlePointSystem
from corota.analysis.newton import PROGRESS, Outcome, ResidualNorms
from corota.analysis.rule import REST, Rule
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.gaps import ContactState, Kink
from corota.analysis.terms.contact.holding import far, held, let_slip
from corota.analysis.terms.contact.impact import impact_error
from corota.analysis.terms.contact.kink_correction import along_kink, keeps_kink
from corota.analysis.terms.contact.kinks import both_sides
from corota.analysis.terms.contact.linearization import linearized
from corota.analysis.terms.contact.messages import explanation
from corota.analysis.terms.contact.pair import CLOSED
from corota.analysis.terms.contact.pivoting import pivoted
from corota.analysis.terms.contact.problem import RightHandSides
from corota.analysis.terms.contact.state_choice import chosen
from corota.analysis.terms.contact.tunneling import outside, passed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.linear.coupling import Coupling

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    States = list[NDArray[np.int8]]

#: Nodes that a note lists.
MAX_LISTED = 8
#: Additional iterations allowed for contact.
MAX_EXTRA_CONTACT_ITERATIONS = 24
#: Iterations without progress before an increment is cut: few that take more converge.
PATIENCE = 8
#: The same before states come from the whole linearized problem.
ITERATIONS_BEFORE_PIVOTING = 3
#: Corrections after which partly covered nodes keep their owners.
CORRECTIONS_BEFORE_FREEZE = 4
#: Displacement of an increment, relative to its first correction, that counts as a jump, driven by
#: supports and by forces.
JUMP, JUMP_OF_FORCE = 10.0, 4.0

#: Marks the remark on an unconstrained body, in place of a constraint.
FLOATS = -1


class ContactEquations:
    """A system with contact, for one increment.

    Parameters
    ----------
    system : System
    rule : Rule
        What the increment makes of its unknowns.
    """

    def __init__(self, system: System, rule: Rule = REST) -> None:
        self.system, self.rule = system, rule
        self.evaluate = system.evaluate
        self.contact_term: ContactTerm = system.contact_term
        self.n = system.n_dofs
        self.forget()

    def forget(self) -> None:
        """Begin an attempt at the increment."""
        # Closed constraints stay closed while their pressure does.
        self.last: States | None = None
        if self.contact_term.at is not None and self.contact_term.at.states:
            self.last = [s.copy() for s in self.contact_term.at.states]
        self.seen: dict[bytes, int] = {}
        self.cautious = False
        self.flips: list[Ints] = [np.zeros(p.n, np.int64) for p in self.contact_term.pairs]
        self.single = self.sliding = self.corrections = self.pivoted = 0
        self.pivoting = False  # whether states come from the whole linearized problem
        self.least, self.waited = np.inf, 0
        self.stage = ""  # how the last correction was found
        self.relaxing = False  # whether the bodies may move to another equilibrium
        #: Previous position in relaxation, for the tunneling check.
        self.since: Floats | None = None
        self.contact_term.springs = None
        #: Kink of the contact surfaces at which the bodies may rest, and how often one
        #: was tried.
        self.kink: Kink | None = None
        self.kinks = self.beyond = 0
        #: Whether the kink is that of the committed state, which may lie behind by now.
        self.inherits = False
        self.places: list[Floats] = []  # displacements of the last three evaluations
        self.first_move = 0.0  # of the first correction [length]
        self.loose = ""  # bodies that were unconstrained until contact was closed
        self.slip_directions: dict[
            int, Floats
        ] = {}  # of slipping tractions, by the pair's first multiplier

    def go_on(self) -> None:
        """Begin again at the equilibrium that was found, with its states."""
        last, kink, first = self.last, self.kink, self.first_move
        self.forget()
        self.last, self.kink, self.first_move = last, kink, first

    # -- the protocol of Newton's method -----------------------------------------------

    def start(self, u: Floats) -> Floats:
        """Displacements with the committed multipliers."""
        return np.concatenate([u, self.contact_term.committed])

    @property
    def kink(self) -> Kink | None:
        """Kink of the contact surfaces at which the bodies may rest."""
        return self.contact_term.trial_kink

    @kink.setter
    def kink(self, kink: Kink | None) -> None:
        self.contact_term.trial_kink = kink

    def residual_norms(self, at: Evaluation, z: Floats) -> ResidualNorms:
        """Size of the residual, of equilibrium and of the contact conditions."""
        norms = self.system.residual_norms(at, z[: self.n])
        if not self.places or not np.array_equal(self.places[-1], z[: self.n]):
            self.places = [*self.places[-2:], z[: self.n].copy()]
        norms.note = self.stage
        complementarity, pair, constraint = self.complementarity(at)
        before = norms.force
        if self.kink is not None:
            stiffness = float(self.kink.move**2 @ self.contact_term.nodal)
            apart = max(abs(self.kink.distance) - self.contact_term.pairs[0].noise, 0.0)
            complementarity = max(complementarity, self.kink.excess, stiffness * apart)
        self.system.scales.add_complementarity(norms, complementarity)
        if norms.force > before:
            node = self.contact_term.pairs[pair].nodes[constraint]
            norms.worst = int(self.system.start[node])
        if self.corrections:  # before the first one, supports may not have moved
            self.waited = 0 if norms.size < PROGRESS * self.least else self.waited + 1
            self.least = min(self.least, norms.size)
        return norms

    def return_tangent(self, at: Evaluation) -> None:
        """Keep the tangent: states of contact are used later."""

    def complementarity(self, at: Evaluation) -> tuple[float, int, int]:
        """Largest contact residual as a force; its pair and constraint."""
        worst = (0.0, 0, 0)
        for k, (pair, terms, (p, q)) in enumerate(self._pairs(at.contact_state)):
            if pair.n:
                complementarity = pair.violation(terms, p, q)
                i = int(np.argmax(complementarity))
                if complementarity[i] > worst[0]:
                    worst = (float(complementarity[i]), k, i)
        return worst

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
        self.pivoting = self.pivoting or self.waited >= ITERATIONS_BEFORE_PIVOTING
        if self.pivoting:
            self._freeze()
            found = pivoted(self, at, right_sides)
            if found is not None:
                z, self.last, slip_directions = found
                self.slip_directions = {
                    p.first: s
                    for p, s in zip(self.contact_term.pairs, slip_directions, strict=True)
                }
                self.pivoted += 1
                self.stage = "contact states by pivoting"
                return self._moved(z), -1
        before = self.single
        z, negative = self._columns(at, right_sides, self._choose(at.contact_state))
        self.stage = "contact state changed at one node" if self.single > before else ""
        return self._moved(z[:, 0]), negative

    def inherit_kink(self) -> None:
        """Begin at the kink at which the committed equilibrium lies, if there is one.

        One side of it alone is no equilibrium, and a correction from there may go anywhere.
        """
        kink = self.contact_term.kink
        if kink is not None and self.system.nlgeom and not self.contact_term.persistent:
            self.kink, self.inherits = replace(kink, base=None), True

    # -- one linearization ---------------------------------------------------------------

    def _moved(self, z: Floats) -> Floats:
        """A correction, whose first size is kept."""
        if not self.first_move:
            self.first_move = float(np.abs(z[: self.n][~self.system.is_rotation]).max())
        return z

    def _freeze(self) -> None:
        self.corrections += 1
        for pair in self.contact_term.pairs:
            pair.frozen = self.corrections >= CORRECTIONS_BEFORE_FREEZE

    def _columns(
        self,
        at: Evaluation,
        right_sides: RightHandSides,
        states: States,
        slip_directions: dict[tuple[int, int], float] | None = None,
    ) -> tuple[Floats, int]:
        """Solutions of one linearization, shape (n_dofs + n_multipliers, k)."""
        self._freeze()
        self.slip_directions = {
            pair.first: pair.slip_direction(terms, q)
            for pair, terms, (p, q) in self._pairs(at.contact_state)
        }
        for (k, i), slip_direction in (slip_directions or {}).items():
            self.slip_directions[self.contact_term.pairs[k].first][i] = slip_direction
        du, dp, negative, states = self._held(at, states, right_sides)
        for (pair, terms, (p, q)), state in zip(self._pairs(at.contact_state), states, strict=True):
            if pair.two:
                # Slipping tractions follow the pressure; they are no unknowns of the solution.
                ratio = pair.rows(terms, state, p, q, self.slip_directions[pair.first])[4]
                now = np.outer(p, right_sides.own) + dp[pair.first : pair.first + pair.n]
                new = ratio[:, None] * now - np.outer(q, right_sides.own)
                slips = state != CLOSED
                dp[pair.first + pair.n : pair.first + pair.width][slips] = new[slips]
        return np.concatenate([du, dp]), negative

    def _solve(
        self, at: Evaluation, states: States, right_sides: RightHandSides
    ) -> tuple[Floats, Floats, int]:
        coupling, own, expected = self._coupling(at.contact_state, states)
        force = right_sides.force + self.system.at_nodes(coupling.force)[:, None] * right_sides.own
        rows = own[:, None] * right_sides.own
        release = -at.contact_state.multipliers[:, None] * right_sides.own
        du, dp, negative = self.border.solve(
            at, coupling, force, rows, release, right_sides.constrained
        )
        return du, dp, negative - expected if negative >= 0 else -1

    def _held(
        self, at: Evaluation, states: States, right_sides: RightHandSides
    ) -> tuple[Floats, Floats, int, States]:
        """Correction for states that constrain the bodies, with the fewest changes."""
        return held(self, at, states, right_sides)

    def _let_slip(
        self,
        at: Evaluation,
        states: States,
        right_sides: RightHandSides,
        found: tuple[Floats, Floats, int],
    ) -> tuple[Floats, Floats, int, States]:
        """Let constraints slip at once that a correction would load far beyond friction."""
        return let_slip(self, at, states, right_sides, found)

    def _far(self, du: Floats, right_sides: RightHandSides) -> bool:
        """Whether a correction moves the surfaces beyond the contact search distance."""
        return far(self, du, right_sides)

    @property
    def border(self) -> SaddlePointSystem:
        """Linear algebra, kept with the system."""
        border = self.contact_term.border
        if border is None:
            ties = sum(pair.width for pair in self.contact_term.pairs if pair.tied)
            border = SaddlePointSystem(self.system, self.contact_term.n, ties)
            self.contact_term.border = border
        return border

    def _pairs(self, contact_state: ContactState) -> Any:
        return zip(
            self.contact_term.pairs,
            contact_state.terms,
            self.contact_term.parts(contact_state.multipliers),
            strict=True,
        )

    def _choose(self, contact_state: ContactState) -> States:
        """States for the next correction; single changes once a set comes back."""
        return chosen(self, contact_state)

    def _coupling(
        self, contact_state: ContactState, states: States
    ) -> tuple[Coupling, Floats, int]:
        """The border for states, its right-hand side, and its negative pivots."""
        return linearized(self.contact_term, contact_state, states, self.slip_directions)

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
            self.contact_term.revert()
        elif self.single:
            settled.note = (
                f"{outcome.note}; contact state changed at one node at a time in {self.single} "
                "iterations"
            ).strip("; ")
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
            self.contact_term.positions(self.contact_term.u if since is None else since),
            self.contact_term.positions(z[: self.n]),
        )
        still = self.pivoted and not self.relaxing and not moves
        if still and not self.near(z[: self.n]):
            return (
                "the equilibrium found is far from the last one: the bodies would jump in this "
                "increment"
            )
        for k, (pair, terms, (p, q)) in enumerate(self._pairs(at.contact_state)):
            starts = partial(outside, self.contact_term, k, moves)
            states = partial(pair.states, terms, p, q)
            found = passed(pair, old, new, states, terms, starts)
            if len(found):
                return (
                    f"node {self.contact_term.label(pair, int(found[0]))} passed through the "
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
            for pair, terms, (p, _) in self._pairs(self.contact_state)
        )

    def near(self, u: Floats) -> bool:
        """Whether an equilibrium is near the committed one, as far as its first correction says."""
        moved = float(np.abs((u - self.contact_term.u)[~self.system.is_rotation]).max())
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
        return impact_error(self.contact_term, self.contact_state, moved, energy, tolerance, meets)

    def accept(self, u: Floats, step_time: float) -> list[str]:
        """Commit contact with the increment; returns remarks that are new."""
        assert self.contact_state is not None
        self.contact_term.accept(u, self.contact_state, step_time)
        self.contact_term.kink = None if self.kink is None else replace(self.kink, base=None)
        notes = []
        if self.loose and not self.presses and FLOATS not in self.contact_term.reported_constraints:
            self.contact_term.reported_constraints.add(FLOATS)
            notes.append(
                f"no contact is closed, and {self.loose}: the position of that body is "
                "undetermined until contact or a support constrains it"
            )
        dropped: dict[str, list[str]] = {}
        for number in sorted(self.border.dropped - self.contact_term.reported_constraints):
            pair = next(p for p in reversed(self.contact_term.pairs) if p.first <= number)
            constraint = (number - pair.first) % pair.n
            if constraint < pair.of_nodes:  # not a facet between two nodes that are closed as well
                label = str(self.contact_term.label(pair, constraint))
                dropped.setdefault(pair.name, []).append(label)
        for name, labels in dropped.items():
            some = ", ".join(labels[:MAX_LISTED])
            more = f" and {len(labels) - MAX_LISTED} more" if len(labels) > MAX_LISTED else ""
            notes.append(
                f"contact pair {name!r}: the constraint at node {some}{more} is redundant and was "
                "dropped: supports, ties or other contact constraints fix the node in that "
                "direction and carry its force"
            )
        self.contact_term.reported_constraints |= self.border.dropped
        return notes

    def explain(self, at: Evaluation | None) -> str:
        """Pair and nodes that caused a failed increment, and what was tried."""
        return explanation(self, at)


__all__ = ["MAX_EXTRA_CONTACT_ITERATIONS", "PATIENCE", "ContactEquations"]
