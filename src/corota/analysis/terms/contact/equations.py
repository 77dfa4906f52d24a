"""A system with contact for Newton's method: displacements and multipliers together.

The choice of the active set and Newton's method are one loop: every correction is made with the
current states of gaps, slips and tractions (a semismooth Newton method). The increment is converged
when forces balance and the conditions of contact hold; the set is then constant. States are chosen
one by one until they cycle, and such that bodies hold.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.failure import ElementFailure, GiveUp
from corota.analysis.linear.coupling import Coupling
from corota.analysis.linear.saddle_point import SaddlePointSystem
from corota.analysis.linear.triplets import Triplets
from corota.analysis.newton import PROGRESS, Outcome, ResidualNorms, newton
from corota.analysis.rule import REST, Rule
from corota.analysis.terms.contact.contact import ContactTerm, few
from corota.analysis.terms.contact.gaps import (
    COMPLIANCE,
    EXCESS,
    FAR,
    PATIENCE,
    SAME,
    SMALL,
    WAITED,
    RightHandSides,
    sticking,
)
from corota.errors import SingularError
from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.newton import Settings
    from corota.analysis.terms.contact.contact import Each
    from corota.analysis.terms.contact.gaps import ContactState, Kink, States, Terms
    from corota.analysis.terms.contact.pair import Pair
    from corota.arrays import Bools, Floats, Ints

    #: Corrections of dofs and multipliers, and negative pivots; -1 if not symmetric.
    Solution = tuple[Floats, Floats, int]
    Linearized = tuple[Coupling, list[tuple[Floats, Floats]]]

# What most increments do not need.
keeps_kink = lazy("corota.analysis.terms.contact.kinks:keeps_kink")
along_kink = lazy("corota.analysis.terms.contact.kinks:along_kink")
both_sides = lazy("corota.analysis.terms.contact.kinks:both_sides")
pivoting = lazy("corota.analysis.terms.contact.pivoting:Pivoting")
explanation = lazy("corota.analysis.terms.contact.output:explanation")
pressures = lazy("corota.analysis.terms.contact.output:pressures")


class ContactEquations:
    """One attempt at an increment with contact: its data, and its linearized equations.

    Parameters
    ----------
    system : System
    rule : Rule
        What the increment makes of its unknowns.
    """

    #: Whether corrections are bounded by something else: none is too long, or slips at once.
    bounded = False
    #: Whether bodies that are not constrained are brought to a hold.
    holds = True

    def __init__(self, system: System, rule: Rule = REST) -> None:
        self.system, self.rule = system, rule
        self.evaluate = system.evaluate
        self.term = system.term(ContactTerm)
        self.n = system.n_dofs
        self.origin: Floats = self.term.u
        self.forget()

    def forget(self, states: States | None = None) -> None:
        """Begin an attempt at the increment, with the committed states if none are given."""
        if states is None and self.term.at is not None:
            states = self.term.at.states
        #: States of the last correction. Closed constraints stay closed while their pressure does.
        self.last = states and [s.copy() for s in states]
        #: How often a set of states came back, and how often that of each constraint changed.
        self.seen: dict[bytes, int] = {}
        self.flips: list[Ints] = [np.zeros(p.n, np.int64) for p in self.term.pairs]
        #: Times that bodies slid, all corrections, and those by pivoting.
        self.sliding = self.corrections = self.pivoted = 0
        #: Whether states come from the whole linearized problem.
        self.pivoting = False
        #: Whether constraints were released one after the other without an end.
        self.slides = False
        #: Residual of the last iterate, the least one, and iterations without progress.
        self.size, self.least, self.waited = np.inf, np.inf, 0
        #: How the last correction was found.
        self.stage = ""
        #: From where the bodies creep to another equilibrium, in a relaxation.
        self.since: Floats | None = None
        self.term.springs = None
        #: Kink of the contact surfaces at which the bodies may rest; how many were tried, and
        #: corrections in which one carried more than its jump.
        self.kink: Kink | None = None
        self.kinks = self.beyond = 0
        #: Whether the kink is that of the committed state, which may lie behind by now.
        self.inherits = False
        #: Displacements of the last three evaluations.
        self.places: list[Floats] = []
        #: Length of the first correction.
        self.first_move = 0.0
        #: Bodies that were unconstrained until contact was closed.
        self.loose = ""
        #: Signs of slipping tractions of each pair.
        self.slip_directions: list[Floats] = []

    def go_on(self) -> None:
        """Begin again at the equilibrium that was found, with its states."""
        kink, first = self.kink, self.first_move
        self.forget(self.last)
        self.kink, self.first_move = kink, first

    @property
    def kink(self) -> Kink | None:
        """Kink of the contact surfaces at which the bodies may rest."""
        return self.term.trial_kink

    @kink.setter
    def kink(self, kink: Kink | None) -> None:
        self.term.trial_kink = kink

    def solve_increment(
        self,
        u: Floats,
        prescribed: Floats,
        step_time: float,
        settings: Settings,
        report: Callable[[int, ResidualNorms, float, str], None] | None,
        known: Evaluation | None,
        last_chance: bool,
    ) -> Outcome:
        """See :func:`corota.analysis.increment_loop.solve_increment`."""
        term, n, system, rule = self.term, self.n, self.system, self.rule
        if term.kink is not None and system.nlgeom and not term.persistent:
            # One side alone of the kink at which the committed equilibrium lies is none, and a
            # correction from there may go anywhere.
            self.kink, self.inherits = replace(term.kink, base=None), True
        z = self.start(u)
        target = np.concatenate([prescribed, z[n:]])
        most = settings.max_iterations + WAITED * PATIENCE
        patience = 0 if last_chance else PATIENCE
        more = replace(settings, max_iterations=most, patience=patience, reuse=None)
        start = None
        if known is not None:
            with contextlib.suppress(ElementFailure):  # which Newton's method reports
                start = self.evaluate(z, step_time, rule)
                start.values[:] = known.values
                # Stabilizing damping of this increment.
                for added, sign in ((known.added, -1.0), (start.added, 1.0)):
                    if added is not None:
                        system.pattern.add_diagonal(start.values, sign * added)
        fluids = system.conditions.fluids
        if fluids:
            terms = None if term.at is None else term.at.terms
            contact: tuple[Floats, Bools] = pressures(term, terms, term.committed)
            system.conditions.begin_fluids(*contact, u)
            start = None
        found = newton(self, z, target, step_time, more, start, report, rule)
        while fluids and found.converged and found.at is not None:
            state = found.at.contact_state
            contact = pressures(term, state.terms, state.multipliers)
            if not system.conditions.advance_fluids(*contact, found.u[:n], step_time):
                break
            self.go_on()
            again = newton(self, found.u, target, step_time, more, None, report, rule)
            again.iterations += found.iterations
            found = again
        return self.settle(found)

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
        if (self.kink is not None or self.waited >= WAITED) and keeps_kink(self, at):
            corrected: tuple[Floats, int] | None = along_kink(self, at, right_sides)
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
        found: tuple[Floats, States, list[Floats]] | None
        found = pivoting(self, at, right_sides).solve()
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
        if self.last is None or self.size > SMALL:
            return False
        state = at.contact_state
        now = self.term.states(state.terms, state.multipliers, self.last)
        return all(map(np.array_equal, now, self.last))

    def complementarity(self, at: Evaluation) -> tuple[float, int, int]:
        """Largest contact residual as a force; its pair and constraint."""
        worst = (0.0, 0, 0)
        for k, (pair, terms, (p, q)) in enumerate(self.pairs(at.contact_state)):
            complementarity = pair.violation(terms, p, q)
            i = int(np.argmax(complementarity))
            if complementarity[i] > worst[0]:
                worst = (float(complementarity[i]), k, i)
        return worst

    # -- one linearization ---------------------------------------------------------------

    def moved(self, z: Floats) -> Floats:
        """A correction, whose first size is kept."""
        if not self.first_move:
            self.first_move = self.largest(z)
        return z

    def largest(self, change: Floats) -> float:
        """Largest displacement of a change of the unknowns [length]."""
        return float(np.abs(change[: self.n])[~self.system.is_rotation].max())

    def freeze(self) -> None:
        self.corrections += 1
        for pair in self.term.pairs:
            pair.freeze(self.corrections)

    def solve(self, at: Evaluation, states: States, right_sides: RightHandSides) -> Solution:
        """Corrections of dofs and multipliers for states, and negative pivots of the bodies."""
        coupling, slopes = linearized(self.term, at.contact_state, states, self.slip_directions)
        force = right_sides.force + self.system.at_nodes(coupling.force)[:, None] * right_sides.own
        rows = coupling.rhs[:, None] * right_sides.own
        if right_sides.rows is not None:
            rows = rows + right_sides.rows
        release = -at.contact_state.multipliers[:, None] * right_sides.own
        du, dp, negative = self.border.solve(
            at, coupling, force, rows, release, right_sides.constrained
        )
        each = zip(self.pairs(at.contact_state), states, slopes, strict=True)
        for (pair, _, (p, q)), state, (ratio, level) in each:
            if pair.two:
                # Slipping tractions follow the pressure; they are no unknowns of the solution.
                slips = np.flatnonzero(state != CLOSED)
                now = np.outer(p[slips], right_sides.own) + dp[pair.first + slips]
                new = ratio[slips, None] * now - np.outer((q - level)[slips], right_sides.own)
                dp[pair.first + pair.n + slips] = new
        return du, dp, negative - coupling.expected if negative >= 0 else -1

    @property
    def border(self) -> SaddlePointSystem:
        """Linear algebra, kept with the system."""
        border = self.term.border
        if border is None:
            ties = sum(pair.width for pair in self.term.pairs if pair.tied)
            border = SaddlePointSystem(self.system, self.term.n, ties)
            self.term.border = border
        return border

    def pairs(self, contact_state: ContactState) -> Iterator[Each]:
        return self.term.each(contact_state.terms, contact_state.multipliers)

    def gap_rates(self, at: Evaluation, du: Floats) -> list[tuple[Floats, Floats]]:
        """Changes of weighted gaps and slips of each pair by columns of displacements."""
        moved = np.stack([self.system.in_space(u) for u in du.reshape(self.n, -1).T], axis=1)
        moved = np.concatenate([moved, np.zeros((1, moved.shape[1]))])
        out = []
        for pair, terms, _ in self.pairs(at.contact_state):
            where, parts = pair.dofs(terms.variables), []
            for gradient in (terms.gap_gradient, terms.slip_gradient):
                change = np.zeros((pair.n, moved.shape[1]))
                np.add.at(change, terms.constraint, np.einsum("tv,tvc->tc", gradient, moved[where]))
                parts.append(change if du.ndim > 1 else change[:, 0])
            out.append((parts[0], parts[1]))
        return out

    # -- states --------------------------------------------------------------------------

    def chosen(self, contact_state: ContactState) -> States:
        """States for the next correction; the whole linearized problem once a set comes back."""
        wanted = self.term.states(contact_state.terms, contact_state.multipliers, self.last)
        last, self.last = self.last, wanted
        if last is None or all(map(np.array_equal, wanted, last)):
            return wanted
        for flips, old, new in zip(self.flips, last, wanted, strict=True):
            flips += old != new
        key = b"".join(s.tobytes() for s in wanted)
        self.seen[key] = self.seen.get(key, 0) + 1
        if self.seen[key] >= PATIENCE:
            raise GiveUp(
                "the contact states cycle: the same nodes open, stick and slip as in "
                f"{self.seen[key] - 1} earlier iterations"
            )
        self.pivoting = self.pivoting or self.seen[key] >= WAITED
        return wanted

    def columns(
        self,
        at: Evaluation,
        right_sides: RightHandSides,
        states: States,
        signs: list[Floats] | None = None,
    ) -> tuple[Floats, int]:
        """Solutions of one linearization, shape (n_dofs + n_multipliers, k).

        Signs of slipping tractions are those of their trial values where none other than 0 is
        given.
        """
        self.freeze()
        self.slip_directions = [
            pair.slip_direction(terms, q) for pair, terms, (_, q) in self.pairs(at.contact_state)
        ]
        if signs is not None:
            each = zip(signs, self.slip_directions, strict=True)
            self.slip_directions = [np.where(sign != 0.0, sign, own) for sign, own in each]
        du, dp, negative = self._held(at, states, right_sides)
        return np.concatenate([du, dp]), negative

    def _held(self, at: Evaluation, states: States, right_sides: RightHandSides) -> Solution:
        """Correction for states that constrain the bodies.

        Where all nodes in contact with a body slip at once, it is unconstrained: they must stick.
        """
        if not self.holds:
            return self.solve(at, states, right_sides)
        slipping = any((s == SLIPPING).any() for s in states)
        stuck = sticking(states) if slipping else states
        reason: SingularError | None = None
        for tried in [states, stuck] if slipping else [states]:
            try:
                found = self.solve(at, tried, right_sides)
            except SingularError as error:
                reason = error
                self.sliding += slipping
                continue
            if tried is not stuck and slipping and self._far(found[0], right_sides):
                self.sliding += 1
                continue
            found, self.last = self._let_slip(at, tried, right_sides, found)
            return found
        assert reason is not None
        return self._close_some(at, stuck, right_sides, reason)

    def _let_slip(
        self,
        at: Evaluation,
        states: States,
        right_sides: RightHandSides,
        found: Solution,
    ) -> tuple[Solution, States]:
        """Let constraints slip at once that a correction would load far beyond friction.

        Otherwise a large displacement of supports distorts the mesh before anything slips. What
        supports move over the surface slips in any case: no traction can hold it.
        """
        early, border = self.corrections <= 2 and not self.bounded, self.border
        if not (early or border.left.any() or border.left_by_others.any()):
            return found, states
        # What slid before may go back by an edge: friction that holds it there first tips a body.
        slid = [(s == SLIPPING) & early & (self.corrections == 1) for s in states]
        released, back = list(slid), [np.zeros(p.n, bool) for p in self.term.pairs]
        for count in range(1 + WAITED):
            new = [s.copy() for s in states]
            slip_directions = list(self.slip_directions)
            rates, turned = self.gap_rates(at, found[0][:, 0]), False
            each = zip(new, self.pairs(at.contact_state), strict=True)
            for k, (s, (pair, terms, (p, q))) in enumerate(each):
                if not pair.rubs:
                    continue
                own = slice(pair.first + pair.n, pair.first + pair.width)
                p1, q1 = p + found[1][pair.first : own.start, 0], q + found[1][own, 0]
                left = border.left[own] + border.left_by_others[own]
                bound = pair.bound(np.maximum(p1, p))
                moved = (s == CLOSED) & (np.abs(left) > pair.noise) & np.isfinite(bound)
                q1[moved] = -left[moved]
                border.dropped.difference_update((own.start + np.flatnonzero(moved)).tolist())
                over = moved | early & (s == CLOSED) & (np.abs(q1) > EXCESS * bound)
                s[over] = SLIPPING
                slip_direction = self.slip_directions[k]
                slip_direction = np.where(over, np.where(q1 > 0.0, 1.0, -1.0), slip_direction)
                # What stuck without traction, or goes far, takes the direction of its slip. What
                # slid and then slips in neither direction sticks.
                slip = (terms.slip + rates[k][1]) * slip_direction
                least = np.where(slid[k], 1.0, SMALL)
                wrong = released[k] & (slip > least * pair.edge * pair.full)
                slip_direction = np.where(wrong, -slip_direction, slip_direction)
                turned = turned or bool(wrong.any())
                s[wrong & back[k]] = CLOSED
                back[k] = wrong & slid[k]
                released[k] = (released[k] | over) & (s != CLOSED)
                slip_directions[k] = slip_direction
            if all(map(np.array_equal, new, states)) and not turned:
                break
            if count == WAITED:
                # One release overloads the next constraint, as along a rope.
                self.pivoting = self.slides = True
                break
            before, self.slip_directions = self.slip_directions, slip_directions
            with contextlib.suppress(SingularError):
                other = self.solve(at, new, right_sides)
                if not self._far(other[0], right_sides):
                    found, states = other, new
                    continue
            self.slip_directions = before
            break
        return found, states

    def _far(self, du: Floats, right_sides: RightHandSides) -> bool:
        """Whether a correction moves the surfaces beyond the contact search distance."""
        if self.bounded:
            return False
        moved, moves = (
            np.abs(self.system.by_node(x[:, 0])[:, :2]) for x in (du, right_sides.constrained)
        )
        return any(
            pair.rubs and float(moved[pair.on_slave].max()) > pair.reach + 2.0 * float(moves.max())
            for pair in self.term.pairs
        )

    def _close_some(
        self,
        at: Evaluation,
        states: States,
        right_sides: RightHandSides,
        error: SingularError,
    ) -> Solution:
        """Bring unconstrained bodies into contact: close the nearest nodes, increasingly many."""
        gaps = [
            np.where((s == OPEN) & (not pair.tied), pair.trial(terms, p)[0], np.inf)
            for s, (pair, terms, (p, _)) in zip(states, self.pairs(at.contact_state), strict=True)
        ]
        nearest = min(float(gap.min(initial=np.inf)) for gap in gaps)
        for count in (0, 1, 2, None):
            tried = [s.copy() for s in states]
            for s, gap in zip(tried, gaps, strict=True):
                if count == 0:
                    # A flat side comes to rest on all of its nodes.
                    s[gap <= nearest * (1.0 + SAME)] = CLOSED
                    continue
                near = np.argsort(gap, kind="stable")[:count]
                s[near[gap[near] < np.inf]] = CLOSED
            if all(map(np.array_equal, tried, states)):
                break
            try:
                found = self.solve(at, tried, right_sides)
            except SingularError:
                continue
            self.last, self.loose = tried, str(error)
            return found
        each = zip(self.term.pairs, states, strict=True)
        open_pair = next((pair.name for pair, s in each if (s == OPEN).all()), None)
        if open_pair is not None:
            raise SingularError(
                f"{error}; contact pair {open_pair!r} is open: support the body until it is "
                "in contact, start in contact (start='adjust'), or damp it (stabilize=True, "
                "*CONTACT CONTROLS, STABILIZE)",
                error.equation,
                error.mode,
            ) from None
        raise error

    # -- the end of an increment -------------------------------------------------------

    def settle(self, outcome: Outcome) -> Outcome:
        """Result of an increment in terms of the system; explains failures."""
        if outcome.converged and outcome.at is not None:
            outcome.reason = self.refuse(outcome.at, outcome.u)
            outcome.converged = not outcome.reason
        settled = replace(outcome, u=outcome.u[: self.n].copy())
        self.contact_state = None if outcome.at is None else outcome.at.contact_state
        if not outcome.converged:
            settled.reason = f"{outcome.reason}{self.explain(outcome.at)}"
            self.term.revert()
        notes = [settled.note] if settled.note else []
        if outcome.converged and self.pivoted:
            notes.append(f"contact states by pivoting in {self.pivoted} iterations")
        if outcome.converged and self.kink is not None and self.contact_state is not None:
            state = self.contact_state
            self.contact_state = replace(state, terms=both_sides(self.kink, state.terms))
            notes.append("equilibrium at a kink of the contact surfaces")
        settled.note = "; ".join(notes)
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
        still = self.pivoted and self.since is None and not moves
        if still and not self.near(z[: self.n]):
            return (
                "the equilibrium found is far from the last one: the bodies would jump in this "
                "increment"
            )
        start = self.term.u if moves or self.since is None else self.since
        ends = self.term.positions(start), self.term.positions(z[: self.n])
        for k, (pair, terms, tractions) in enumerate(self.pairs(at.contact_state)):
            found = pair.passed(self.term, k, ends, terms, tractions, moves)
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
        return not self.first_move or self.largest(u - self.origin) <= FAR * self.first_move

    @property
    def force(self) -> Floats:
        """Of contact on the nodes at the end of the increment, shape (n_dofs,)."""
        assert self.contact_state is not None
        return self.contact_state.force_at_end

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
        said: str = explanation(self, at)
        return said


def linearized(
    term: ContactTerm, at: ContactState, states: States, slip_directions: list[Floats]
) -> Linearized:
    """What contact adds to the equations for states, and the signs of tractions that slip.

    Behind it, of each pair: the slopes of slipping tractions over the pressure, and their
    tractions at no pressure, shapes (n,).
    """
    near = partial(_near, term, at.terms)
    coupling, slopes = Coupling(term.system.n_dofs, term.n, near), []
    # Where all stick, nothing moves along the tractions, which take the skew part up: without it
    # the matrix is symmetric, and its inertia known.
    slips = any(bool((state == SLIPPING).any()) for state in states)
    each = zip(term.each(at.terms, at.multipliers), states, slip_directions, strict=True)
    for (pair, terms, (p, q)), state, slip_direction in each:
        slopes.append(pair.linearize(terms, state, p, q, slip_direction, coupling))
        if pair.active and term.system.nlgeom and (p.any() or q.any()):
            # Half way an end moves by half.
            half = 1.0 if terms.between is None else 0.5
            even, odd = second_derivatives(term, pair, half * pair.share * p, half * q)
            coupling.geometric_stiffness.add(even)
            if slips:
                coupling.skew.add(odd)
    return coupling, slopes


def second_derivatives(
    term: ContactTerm, pair: Pair, p: Floats, q: Floats
) -> tuple[Triplets, Triplets]:
    """Geometric stiffness, derivatives of the directions of the tractions: even and skew part."""
    with term.system.timed("contact"):
        _, variables, values = pair.core.hessian(p[pair.owner], q[pair.owner])
    where = pair.dofs(variables)
    v = where.shape[1]
    a, b = np.repeat(where, v, axis=1).ravel(), np.repeat(where, v, axis=0).ravel()
    inside = (a >= 0) & (b >= 0)

    def entries(part: Floats) -> Triplets:
        flat = -part.reshape(-1)
        return Triplets(a, b, flat).keep(inside & (flat != 0.0))

    if not pair.rubs or not q.any():
        return entries(values), Triplets.join([])
    turned = values.transpose(0, 2, 1)
    return entries(0.5 * (values + turned)), entries(0.5 * (values - turned))


def _near(term: ContactTerm, found: list[Terms]) -> list[tuple[Ints, Ints]]:
    """Dofs and multipliers of the candidates of each pair next to closed ones."""
    out = []
    for pair, terms in zip(term.pairs, found, strict=True):
        if term.system.nlgeom and len(terms.pair):
            variables, constraints = pair.core.near(terms.pair)
            own = np.where(constraints >= 0, pair.first + pair.owner[constraints], -1)
            if pair.two:
                own = np.concatenate([own, np.where(own >= 0, own + pair.n, -1)], axis=1)
            out.append((pair.dofs(variables), own))
    return out


def linearized_contact(
    system: System, u: Floats, multipliers: Floats | None, states: States | None, time: float
) -> tuple[Evaluation, Coupling, Floats, States, Ints]:
    """Evaluation with the forces of contact, its rows, residuals, states, and multipliers of laws.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    multipliers : ndarray, shape (n_multipliers,), or None
        The committed ones by default.
    states : list of ndarray or None
        Of the constraints; the committed ones by default, with what slips stuck.
    time : float
        Step time.
    """
    term = system.term(ContactTerm)
    if multipliers is None:
        multipliers = term.committed
    term.springs = term.trial_kink = None
    at = system.evaluate(np.concatenate([u, multipliers]), time)
    if states is None and term.at is not None:
        states = term.at.states
    states = sticking(states or term.states(at.contact_state.terms, multipliers))
    ones = [np.ones(pair.n) for pair in term.pairs]
    coupling, _ = linearized(term, at.contact_state, states, ones)
    # Rows without a compliance, which those of a pressure law have.
    laws, bare = term.law_multipliers(), coupling.diagonal <= 0.0
    bare[laws] = False
    own = [np.tile(pair.full / pair.stiffness, 1 + pair.two) for pair in term.pairs]
    coupling.diagonal[bare] = -COMPLIANCE * np.concatenate([np.zeros(0), *own])[bare]
    term.revert()
    return at, coupling, coupling.rhs, states, laws
