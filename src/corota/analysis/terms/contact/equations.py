"""A system with contact for Newton's method: displacements and multipliers together.

The choice of the active set and Newton's method are one loop: every correction is made with the
current states of gaps, slips and tractions (a semismooth Newton method). The
increment is converged when forces balance and gaps, slips and tractions satisfy the conditions
of contact; the set is then constant.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corota.analysis.linear.saddle_point import Coupling, SaddlePointSystem
from corota.analysis.linear.triplets import Triplets
from corota.analysis.newton import PROGRESS, GiveUp, Outcome, ResidualNorms
from corota.analysis.terms.contact.columns import border, stacked
from corota.analysis.terms.contact.contact import ContactState, ContactTerm
from corota.analysis.terms.contact.impact import impact_error
from corota.analysis.terms.contact.kinks import Kink, Sides, again, both_sides, found
from corota.analysis.terms.contact.messages import explained
from corota.analysis.terms.contact.pair import CLOSED, OPEN, SLIPPING
from corota.analysis.terms.contact.pivoting import pivoted
from corota.analysis.terms.contact.problem import ContactEvaluation, RightHandSides
from corota.analysis.terms.contact.tunneling import passed
from corota.analysis.terms.term import StatePoint
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.pair import Terms

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    States = list[NDArray[np.int8]]

EPS = float(np.finfo(float).eps)
#: Additional iterations allowed for contact.
MAX_EXTRA_CONTACT_ITERATIONS = 24
#: Iterations without progress before an increment is cut: few that take more converge.
PATIENCE = 8
#: The same before states come from the whole linearized problem.
ITERATIONS_BEFORE_PIVOTING = 3
#: Repetitions of a set of states before single changes are made.
MAX_STATE_REPEATS = 2
#: Repetitions before the increment is given up.
MAX_REPEATS_BEFORE_CUTBACK = 7
#: Kinks of the contact surfaces that an attempt tries, and corrections in which one may carry
#: a force above its jump.
MAX_KINKS, MAX_BEYOND = 3, 3
#: Fractions of the jump between which an equilibrium is searched: beyond, the bodies do not rest
#: there.
FEWEST_SHARES, MOST_SHARES = -2.0, 3.0
#: Remainder of two corrections that cancel each other, relative to the last one.
TO_AND_FRO = 0.2
#: Corrections after which partly covered nodes keep their owners.
CORRECTIONS_BEFORE_FREEZE = 4
#: Relative difference of contact residuals that counts as zero.
RELATIVE_DIFFERENCE = 1e-6
#: Fraction of the friction bound from which a correction is repeated with slip, and how often.
FRICTION_EXCESS, MAX_SLIP_CORRECTIONS = 2.0, 3
#: Displacement of an increment, relative to its first correction, that counts as a jump, driven by
#: supports and by forces.
JUMP, JUMP_OF_FORCE = 10.0, 4.0

#: Marks the remark on an unconstrained body, in place of a constraint.
FLOATS = -1


class ContactEquations:
    """A system with contact, for one increment.

    Parameters
    ----------
    inner : System, or a motion around it
        Residual and tangent without contact.
    system : System
    """

    def __init__(self, inner: Any, system: System) -> None:
        self.inner, self.system = inner, system
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
        #: Stiffness of the spring at each dof, in relaxation.
        self.brake: tuple[Floats, Floats] | None = None
        #: Kink of the contact surfaces at which the bodies may rest, and how often one
        #: was tried.
        self.kink: Kink | None = None
        self.kinks = self.beyond = 0
        self.places: list[Floats] = []  # displacements of the last three evaluations
        self.time = 0.0
        self.first_move = 0.0  # of the first correction [length]
        self.loose = ""  # bodies that were unconstrained until contact was closed
        self.slip_directions: dict[
            int, Floats
        ] = {}  # of slipping tractions, by the pair's first multiplier

    # -- the protocol of Newton's method -----------------------------------------------

    def start(self, u: Floats) -> Floats:
        """Displacements with the committed multipliers."""
        return np.concatenate([u, self.contact_term.committed])

    def evaluate(self, z: Floats, step_time: float) -> ContactEvaluation:
        """Residual, tangent, gaps and slips; dependent dofs of `z` are set, in place."""
        u, multipliers = z[: self.n], z[self.n :].copy()
        at: Evaluation = self.inner.evaluate(u, step_time)
        point = StatePoint(u, step_time, multipliers=multipliers)
        self.contact_term.add(point, at, self._at_kink(u, multipliers, step_time))
        self.places = [*self.places[-2:], u.copy()]
        self.time = step_time
        if self.brake is not None:
            stiffness, since = self.brake
            at.internal = at.internal + stiffness * (u - since)
            at.added = stiffness if at.added is None else at.added + stiffness
        if at.added is not None:
            at.values[self.system.pattern.diagonal] += at.added
        return ContactEvaluation(at, at.contact)

    def residual_norms(self, at: ContactEvaluation, z: Floats) -> ResidualNorms:
        """Size of the residual, of equilibrium and of the contact conditions."""
        norms: ResidualNorms = self.inner.residual_norms(at.at, z[: self.n])
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

    def return_tangent(self, at: ContactEvaluation) -> None:
        """Keep the tangent: states of contact are used later."""

    def complementarity(self, at: ContactEvaluation) -> tuple[float, int, int]:
        """Largest contact residual as a force; its pair and constraint."""
        worst = (0.0, 0, 0)
        for k, (pair, terms, (p, q)) in enumerate(self._pairs(at.contact_state)):
            if pair.n:
                complementarity = pair.violation(terms, p, q)
                i = int(np.argmax(complementarity))
                if complementarity[i] > worst[0]:
                    worst = (float(complementarity[i]), k, i)
        return worst

    def predict(self, at: ContactEvaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction of displacements and multipliers."""
        return self.correct(at, -at.residual, du_prescribed)

    def correct(
        self, at: ContactEvaluation, rhs: Floats, du_prescribed: Floats
    ) -> tuple[Floats, int]:
        """Correction for a right-hand side of equilibrium; that of contact is added."""
        right_sides = RightHandSides(rhs[: self.n, None], du_prescribed[: self.n, None], np.ones(1))
        if self._keeps_kink(at):
            corrected = self._along_kink(at, right_sides)
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

    # -- equilibria at kinks -------------------------------------------------------------

    def _at_kink(self, u: Floats, multipliers: Floats, step_time: float) -> ContactState | None:
        """Contact on the near side of the kink, with the force that it carries; or None."""
        if self.kink is None:
            return None
        state = again(self, Sides(self, multipliers, step_time), u, self.kink)
        if state is None:
            self.kink = None
        return state

    def _keeps_kink(self, at: ContactEvaluation) -> bool:
        """Whether the correction is one at a kink; looks for one where there is no progress."""
        if self.kink is not None:
            self.beyond += self.kink.excess > 0.0
            if self.beyond <= MAX_BEYOND:
                return True
            raise GiveUp("no equilibrium at the kink of the contact surfaces")
        if (
            self.waited < ITERATIONS_BEFORE_PIVOTING
            or self.kinks >= MAX_KINKS
            or not self._to_and_fro()
            or at.at.link.couples
            or self.contact_term.persistent
            or not self.system.nlgeom
        ):
            return False
        sides = Sides(self, at.contact_state.multipliers, self.time)
        _, before, here = self.places
        self.kink = found(self, sides, here, before)
        # The candidates of the search may have changed.
        state, now = at.contact_state, sides.state(here)
        at.at.internal = at.at.internal + state.force - now.force
        at.contact_state = now
        self.kinks += self.kink is not None
        return self.kink is not None

    def _to_and_fro(self) -> bool:
        """Whether the last two corrections cancel each other."""
        if len(self.places) < 3:
            return False
        first, before, here = self.places
        return float(np.abs(here - first).max()) <= TO_AND_FRO * float(np.abs(here - before).max())

    def _along_kink(
        self, at: ContactEvaluation, right_sides: RightHandSides
    ) -> tuple[Floats, int] | None:
        """Newton correction with the force that the kink carries as an unknown."""
        kink = self.kink
        assert kink is not None
        both = RightHandSides(
            np.column_stack([right_sides.force[:, 0], kink.jump]),
            np.column_stack([right_sides.constrained[:, 0], np.zeros(self.n)]),
            np.array([1.0, 0.0]),
        )
        z, negative = self._columns(at, both, self._choose(at.contact_state))
        first, second = kink.normal @ z[: self.n]
        if second == 0.0:
            self.kink = None
            return None
        change = (kink.distance - float(first)) / float(second)
        if not FEWEST_SHARES <= kink.share + change <= MOST_SHARES:
            self.kink = None
            return None
        dz: Floats = z[:, 0] + change * z[:, 1]
        kink.base = (self.places[-1], kink.share, dz[: self.n].copy(), change)
        self.stage = "equilibrium at a kink of the contact surfaces"
        return self._moved(dz), negative

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
        at: ContactEvaluation,
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
        self, at: ContactEvaluation, states: States, right_sides: RightHandSides
    ) -> tuple[Floats, Floats, int]:
        coupling, own, expected = self._coupling(at.contact_state, states)
        force = right_sides.force + np.outer(self.system.at_nodes(coupling.force), right_sides.own)
        rows = np.outer(own, right_sides.own)
        du, dp, negative = self.border.solve(at.at, coupling, force, rows, right_sides.constrained)
        return du, dp, negative - expected if negative >= 0 else -1

    def _held(
        self, at: ContactEvaluation, states: States, right_sides: RightHandSides
    ) -> tuple[Floats, Floats, int, States]:
        """Correction for states that constrain the bodies, with the fewest changes.

        Where all nodes in contact with a body slip at once, it is unconstrained: some must stick.
        """
        stuck = [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
        slipping = any((s == SLIPPING).any() for s in states)
        tries = [states]
        if slipping:
            tries += [self._least_stick(at, states), stuck]
        problem: SingularError | None = None
        for tried in tries:
            try:
                du, dp, negative = self._solve(at, tried, right_sides)
            except SingularError as error:
                problem = error
                self.sliding += slipping
                continue
            if tried is not stuck and slipping and self._far(du, right_sides):
                self.sliding += 1
                continue
            du, dp, negative, tried = self._let_slip(at, tried, right_sides, (du, dp, negative))
            self.last = tried
            return du, dp, negative, tried
        assert problem is not None
        return self._close_some(at, stuck if slipping else states, right_sides, problem)

    def _least_stick(self, at: ContactEvaluation, states: States) -> States:
        """States with the half that exceeds the friction least sticking again."""
        out = []
        for s, (pair, terms, (p, q)) in zip(states, self._pairs(at.contact_state), strict=True):
            slips = np.flatnonzero(s == SLIPPING)
            shear, loaded = np.abs(pair.shear(terms, q))[slips], p[slips] > 0.0
            over = np.where(loaded, shear / np.where(loaded, p[slips], 1.0), np.inf)
            s = s.copy()
            s[slips[np.lexsort((shear, over))[: (len(slips) + 1) // 2]]] = CLOSED
            out.append(s)
        return out

    def _let_slip(
        self,
        at: ContactEvaluation,
        states: States,
        right_sides: RightHandSides,
        found: tuple[Floats, Floats, int],
    ) -> tuple[Floats, Floats, int, States]:
        """Let constraints slip at once that a correction would load far beyond friction.

        Otherwise a large displacement of supports distorts the mesh before anything slips.
        """
        for _ in range(MAX_SLIP_CORRECTIONS if self.corrections <= 2 else 0):
            new = [s.copy() for s in states]
            slip_directions = dict(self.slip_directions)
            for s, (pair, _, (p, q)) in zip(new, self._pairs(at.contact_state), strict=True):
                if not pair.friction:
                    continue
                p1 = p + found[1][pair.first : pair.first + pair.n, 0]
                q1 = q + found[1][pair.first + pair.n : pair.first + pair.width, 0]
                over = (s == CLOSED) & (
                    np.abs(q1) > FRICTION_EXCESS * pair.friction * np.maximum(p1, p)
                )
                s[over] = SLIPPING
                slip_direction = self.slip_directions[pair.first]
                slip_directions[pair.first] = np.where(
                    over, np.where(q1 > 0.0, 1.0, -1.0), slip_direction
                )
            if all(np.array_equal(a, b) for a, b in zip(new, states, strict=True)):
                break
            before, self.slip_directions = self.slip_directions, slip_directions
            try:
                other = self._solve(at, new, right_sides)
            except SingularError:
                self.slip_directions = before
                break
            if self._far(other[0], right_sides):
                self.slip_directions = before
                break
            found, states = other, new
        return *found, states

    def _far(self, du: Floats, right_sides: RightHandSides) -> bool:
        """Whether a correction moves the surfaces beyond the contact search distance."""
        moved = self.system.by_node(du[:, 0])[:, :2]
        constrained = 2.0 * float(
            np.abs(self.system.by_node(right_sides.constrained[:, 0])[:, :2]).max()
        )
        for pair in self.contact_term.pairs:
            if (
                pair.friction
                and np.abs(moved[pair.slave.node_list]).max() > pair.reach + constrained
            ):
                return True
        return False

    def _close_some(
        self,
        at: ContactEvaluation,
        states: States,
        right_sides: RightHandSides,
        error: SingularError,
    ) -> tuple[Floats, Floats, int, States]:
        """Bring unconstrained bodies into contact: close the nearest nodes, increasingly many."""
        gaps = [
            np.where((s == OPEN) & (not pair.tied), pair.trial(terms, p)[0], np.inf)
            for s, (pair, terms, (p, _)) in zip(states, self._pairs(at.contact_state), strict=True)
        ]
        nearest = min(float(gap.min(initial=np.inf)) for gap in gaps)
        for count in (0, 1, 2, None):
            tried = [s.copy() for s in states]
            for s, gap in zip(tried, gaps, strict=True):
                near = np.argsort(gap, kind="stable")[: count or (None if count is None else 1)]
                limit = nearest if count == 0 else np.finfo(float).max
                s[near[gap[near] <= limit]] = CLOSED
            if all(np.array_equal(a, b) for a, b in zip(tried, states, strict=True)):
                break
            try:
                du, dp, negative = self._solve(at, tried, right_sides)
            except SingularError:
                continue
            self.last, self.loose = tried, str(error)
            return du, dp, negative, tried
        open_pairs = [
            pair.name
            for pair, s in zip(self.contact_term.pairs, states, strict=True)
            if not (s != OPEN).any()
        ]
        if open_pairs:
            raise SingularError(
                f"{error}; contact pair {open_pairs[0]!r} is open: support the body until it is "
                "in contact, start in contact (start='adjust'), or damp it (stabilise=True, "
                "*CONTACT CONTROLS, STABILIZE)",
                error.equation,
                error.mode,
            ) from None
        raise error

    @property
    def border(self) -> SaddlePointSystem:
        """Linear algebra, kept with the system."""
        border = self.contact_term.border
        if border is None:
            border = self.contact_term.border = SaddlePointSystem(self.system, self.contact_term.n)
        return border

    # -- states ------------------------------------------------------------------------

    def _pairs(self, contact_state: ContactState) -> Any:
        return zip(
            self.contact_term.pairs,
            contact_state.terms,
            self.contact_term.parts(contact_state.multipliers),
            strict=True,
        )

    def _choose(self, contact_state: ContactState) -> States:
        """States for the next correction; single changes once a set comes back."""
        before: Sequence[NDArray[np.int8] | None] = self.last or [None] * len(
            self.contact_term.pairs
        )
        wanted = [
            pair.states(terms, p, q, last)
            for (pair, terms, (p, q)), last in zip(self._pairs(contact_state), before, strict=True)
        ]
        if self.last is not None:
            changed = [a != b for a, b in zip(wanted, self.last, strict=True)]
            for flips, new in zip(self.flips, changed, strict=True):
                flips += new
            if any(c.any() for c in changed):
                key = b"".join(s.tobytes() for s in wanted)
                self.seen[key] = self.seen.get(key, 0) + 1
                if self.seen[key] > MAX_REPEATS_BEFORE_CUTBACK:
                    raise GiveUp(
                        "the contact states cycle: the same nodes open, stick and slip as in "
                        f"{self.seen[key] - 1} earlier iterations"
                    )
                self.cautious = self.cautious or self.seen[key] > MAX_STATE_REPEATS
                self.pivoting = self.pivoting or self.cautious
                if self.cautious:
                    wanted = self._one_change(contact_state, wanted, changed)
        self.last = wanted
        return wanted

    def _one_change(
        self, contact_state: ContactState, wanted: States, changed: list[NDArray[np.bool_]]
    ) -> States:
        """Only the change with the largest contact residual, and all with negligible ones."""
        assert self.last is not None
        self.single += 1
        best, where = -1.0, (0, 0)
        for k, (pair, terms, (p, q)) in enumerate(self._pairs(contact_state)):
            complementarity = np.where(changed[k], pair.violation(terms, p, q), -1.0)
            # Of equals, as in symmetric models, the first: rounding must not choose.
            if pair.n and complementarity.max() > (1.0 + RELATIVE_DIFFERENCE) * best:
                first = int(
                    np.argmax(
                        complementarity >= (1.0 - RELATIVE_DIFFERENCE) * complementarity.max()
                    )
                )
                best, where = float(complementarity[first]), (k, first)
        out = [s.copy() for s in self.last]
        out[where[0]][where[1]] = wanted[where[0]][where[1]]
        # Constraints without an opposite surface cannot be closed.
        for state, pair, terms in zip(
            out, self.contact_term.pairs, contact_state.terms, strict=True
        ):
            state[terms.area <= 1e-9 * pair.full] = OPEN
        return out

    # -- linear equations --------------------------------------------------------------

    def _coupling(
        self, contact_state: ContactState, states: States
    ) -> tuple[Coupling, Floats, int]:
        """The border for states, its right-hand side, and its negative pivots."""
        contact_term = self.contact_term
        m = contact_term.n
        geometric_stiffness, rows, follow = [], [], []
        diagonal, rhs = np.ones(m), np.zeros(m)
        force = np.zeros(self.n + 1)
        near: list[tuple[Ints, Ints]] = []
        expected = 0
        for (pair, terms, (p, q)), state in zip(self._pairs(contact_state), states, strict=True):
            first, n = pair.first, pair.n
            dp, rp, dq, rq, ratio = pair.rows(terms, state, p, q, self.slip_directions[first])
            diagonal[first : first + n], rhs[first : first + n] = dp, rp
            expected += int((state != OPEN).sum())
            closed, share = state != OPEN, contact_term.share(pair)
            if share != 1.0:
                diagonal[first : first + n] *= share
                rhs[first : first + n] *= share
            acting = terms.acting
            to_rows, to_acting = (contact_term.dofs(t.variables) for t in (terms, acting))

            def columns(
                name: str,
                start: int,
                chosen: NDArray[np.bool_],
                terms: Terms = terms,
                acting: Terms = acting,
                to_rows: Ints = to_rows,
                to_acting: Ints = to_acting,
                share: float = 1.0,
            ) -> None:
                """A gradient at the end in rows and columns; forces may act along another."""
                k, own = terms.constraint, share * getattr(terms, name)
                rows.append(border(to_rows, start + k, -own, chosen[k]))
                if acting is not terms:
                    follow.append(border(to_rows, start + k, own, chosen[k]))
                    k, own = acting.constraint, share * getattr(acting, name)
                    follow.append(border(to_acting, start + k, -own, chosen[k]))

            columns("gap_gradient", first, closed, share=share)
            k = acting.constraint
            # Tractions that are known after the correction go to the right-hand side.
            known = np.where(closed, 0.0, -share * p)
            part = known[k, None] * acting.gap_gradient
            if pair.two:
                second = first + n
                diagonal[second : second + n], rhs[second : second + n] = dq, rq
                expected += int((state == CLOSED).sum())
                columns("slip_gradient", second, state == CLOSED)
                known = np.where(state == CLOSED, 0.0, ratio * p - q)
                part += known[k, None] * acting.slip_gradient
                slope = -ratio[k, None] * acting.slip_gradient
                follow.append(border(to_acting, first + k, slope, state[k] == SLIPPING))
            np.add.at(force, to_acting, part)
            if self.system.nlgeom and (p.any() or q.any()):
                # Half way an end moves by half.
                half = 1.0 if acting is terms else 0.5
                geometric_stiffness.append(
                    self._geometric_stiffness(pair, half * share * p, half * q)
                )
            near.append(self._near(pair, terms))
        coupling = Coupling(
            Triplets.join(geometric_stiffness),
            Triplets.join(rows),
            Triplets.join(follow),
            diagonal,
            force[:-1],
            stacked(near),
        )
        return coupling, rhs, expected

    def _geometric_stiffness(self, pair: Any, p: Floats, q: Floats) -> Triplets:
        with self.system.timed("contact"):
            _, variables, values = pair.core.hessian(p[pair.owner], q[pair.owner])
        where = self.contact_term.dofs(variables)
        v = where.shape[1]
        a, b = np.repeat(where, v, axis=1).ravel(), np.tile(where, (1, v)).ravel()
        entries = -values.reshape(-1)
        keep = (a >= 0) & (b >= 0) & (entries != 0.0)
        return Triplets(a[keep], b[keep], entries[keep])

    def _near(self, pair: Any, terms: Any) -> tuple[Ints, Ints]:
        """Dofs and multipliers of candidate pairs next to closed ones."""
        if not self.system.nlgeom:
            return np.zeros((0, 0), np.int64), np.zeros((0, 0), np.int64)
        variables, constraints = pair.core.pattern()
        found = pair.core.candidates()
        used = np.zeros(len(found), bool)
        used[terms.pair] = True
        if not used.any():
            return np.zeros((0, 0), np.int64), np.zeros((0, 0), np.int64)
        width = int(found[:, 1].max()) + 8
        key = found[:, 0] * width + found[:, 1] + 3
        contact_term = np.sort(key[used])
        next_up = np.minimum(np.searchsorted(contact_term, key - 2), len(contact_term) - 1)
        close = np.abs(contact_term[next_up] - key) <= 2
        variables, constraints = variables[close], constraints[close]
        own = np.where(constraints >= 0, pair.first + pair.owner[constraints], -1)
        if pair.two:
            own = np.concatenate([own, np.where(own >= 0, own + pair.n, -1)], axis=1)
        return self.contact_term.dofs(variables), own

    # -- the end of an increment -------------------------------------------------------

    def settle(self, outcome: Outcome[ContactEvaluation]) -> Outcome[Evaluation]:
        """Result of an increment in terms of the system; explains failures."""
        u = outcome.u[: self.n].copy()
        at = None if outcome.at is None else outcome.at.at
        if outcome.converged and outcome.at is not None:
            outcome.reason = self.refuse(outcome.at, outcome.u)
            outcome.converged = not outcome.reason
        settled: Outcome[Any] = replace(outcome, u=u, at=cast("Any", at))
        self.contact_state = None if outcome.at is None else outcome.at.contact_state
        if not outcome.converged:
            settled.reason = f"{outcome.reason}{self.explain(outcome.at)}"
            self.contact_term.restore()
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

    def refuse(self, at: ContactEvaluation, z: Floats) -> str:
        """Why an equilibrium is refused; empty if it is not.

        Nodes passed through the opposite surface, or an unconstrained body is far away.
        """
        if self.inner is self.system:
            far: str = self.system.scales.senseless(z)
            if far:
                return far
        if not self.system.nlgeom:
            return ""
        old, new = (
            self.contact_term.positions(self.contact_term.u if self.since is None else self.since),
            self.contact_term.positions(z[: self.n]),
        )
        still = self.pivoted and not self.relaxing and self.inner is self.system
        if still and not self.near(z[: self.n]):
            return (
                "the equilibrium found is far from the last one: the bodies would jump in this "
                "increment"
            )
        for pair, terms, (p, q) in self._pairs(at.contact_state):
            found = passed(pair, old, new, pair.states(terms, p, q))
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
        none = self.system.scales.nothing
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
        notes = []
        if self.loose and not self.presses and FLOATS not in self.contact_term.told:
            self.contact_term.told.add(FLOATS)
            notes.append(
                f"no contact is closed, and {self.loose}: the position of that body is "
                "undetermined until contact or a support constrains it"
            )
        for number in sorted(self.border.dropped - self.contact_term.told):
            pair = next(p for p in reversed(self.contact_term.pairs) if p.first <= number)
            constraint = (number - pair.first) % pair.n
            if constraint >= pair.of_nodes:
                continue  # a facet between two nodes that are closed as well
            notes.append(
                f"contact pair {pair.name!r}: the constraint at node "
                f"{self.contact_term.label(pair, constraint)} is redundant (supports, ties or "
                "other pairs impose it already) and was dropped"
            )
        self.contact_term.told |= self.border.dropped
        return notes

    def explain(self, at: ContactEvaluation | None) -> str:
        """Pair and nodes that caused a failed increment, and what was tried."""
        return explained(self, at)


__all__ = ["MAX_EXTRA_CONTACT_ITERATIONS", "PATIENCE", "ContactEquations"]
