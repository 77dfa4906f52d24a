"""A system with contact as Newton's method sees it: displacements and multipliers together.

The choice of the active set and Newton's method are one loop: every correction is made with the
states that gaps, slips and tractions ask for at the moment (a semismooth Newton method). The
increment is converged when forces balance and gaps, slips and tractions fulfil the conditions
of contact; that implies a settled set.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corota.analysis.linear.saddle_point import Bordered, Coupling, Triplets
from corota.analysis.newton import PROGRESS, GiveUp, Judgement, Outcome
from corota.analysis.terms.contact.columns import border, stacked
from corota.analysis.terms.contact.contact import Touch, Touching
from corota.analysis.terms.contact.messages import explained
from corota.analysis.terms.contact.pair import CLOSED, OPEN, SLIPPING
from corota.analysis.terms.contact.pivoting import pivoted
from corota.analysis.terms.contact.tunneling import passed
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.analysis.equations import Evaluation, System

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    States = list[NDArray[np.int8]]

EPS = float(np.finfo(float).eps)
#: Iterations that contact may take beyond those of the step.
MORE = 24
#: Iterations without progress after which an increment is cut: few that take more converge.
PATIENCE = 8
#: And after which states come from the whole linearised problem.
WAITED = 3
#: How often a set of states may come back before single changes are made.
RETURNS = 2
#: And how often before the increment is given up.
HOPELESS = 7
#: Corrections after which partly covered nodes keep to whom they belong.
SETTLED = 4
#: Relative difference of lacks that is none.
ALIKE = 1e-6
#: Share of the friction bound from which a correction is made anew with slip, and how often.
BEYOND, SLIPS = 2.0, 3
#: Times the first correction that an increment may move before it counts as a jump, driven by
#: supports and by forces.
JUMP, JUMP_OF_FORCE = 10.0, 4.0


@dataclass
class Touched:
    """Evaluation of a system and its contact.

    Parameters
    ----------
    at : Evaluation
        Of the system; its internal force holds that of contact.
    touch : Touch
    """

    at: Evaluation
    touch: Touch

    @property
    def residual(self) -> Floats:
        """That of equilibrium, and zeros for the multipliers."""
        return np.concatenate([self.at.residual, np.zeros(len(self.touch.multipliers))])

    @property
    def internal(self) -> Floats:
        return self.at.internal

    @property
    def external(self) -> Floats:
        return self.at.external

    @property
    def scale(self) -> Floats:
        return self.at.scale


@dataclass
class Asked:
    """Right-hand sides of one linearisation, a column each.

    Parameters
    ----------
    force, held : ndarray, shape (n_dofs, k)
        Of equilibrium, and prescribed changes at held dofs.
    own : ndarray, shape (k,)
        Share of what the contact conditions lack: 1 in a Newton correction, 0 in a rate.
    """

    force: Floats
    held: Floats
    own: Floats


class TouchingSystem:
    """A system with contact, for one increment.

    Parameters
    ----------
    inner : System, or a motion around it
        What gives residual and tangent without contact.
    system : System
    weight : float
        Share of the contact forces in the residual.
    """

    def __init__(self, inner: Any, system: System, weight: float = 1.0) -> None:
        assert system.touching is not None
        self.inner, self.system, self.weight = inner, system, weight
        self.touching: Touching = system.touching
        self.n = system.n_dofs
        self.forget()

    def forget(self) -> None:
        """Begin an attempt at the increment."""
        # What was closed stays so while its pressure does.
        self.last: States | None = None
        if self.touching.at is not None and self.touching.at.states:
            self.last = [s.copy() for s in self.touching.at.states]
        self.seen: dict[bytes, int] = {}
        self.cautious = False
        self.flips: list[Ints] = [np.zeros(p.n, np.int64) for p in self.touching.pairs]
        self.single = self.sliding = self.corrections = self.pivoted = 0
        self.pivoting = False  # whether states come from the whole linearised problem
        self.least, self.waited = np.inf, 0
        self.stage = ""  # how the last correction was found
        self.relaxing = False  # whether the bodies may move to another equilibrium
        self.first_move = 0.0  # of the first correction [length]
        self.loose = ""  # what nothing held until contact was closed for it
        self.senses: dict[int, Floats] = {}  # of slipping tractions, by the pair's first multiplier

    # -- the protocol of Newton's method -----------------------------------------------

    def start(self, u: Floats) -> Floats:
        """Displacements with the committed multipliers."""
        return np.concatenate([u, self.touching.committed])

    def evaluate(self, z: Floats, step_time: float) -> Touched:
        """Residual, tangent, gaps and slips; dependent dofs of `z` are set, in place."""
        u, multipliers = z[: self.n], z[self.n :].copy()
        at = self.inner.evaluate(u, step_time)
        touch = self.touching.evaluate(u, multipliers, step_time, at.values)
        at.internal = at.internal - self.weight * touch.force
        at.scale = at.scale + self.weight * touch.size
        if touch.damping is not None:
            at.internal += touch.damping * (u - self.touching.u)
            at.added = touch.damping
            at.values[self.system.indptr[1:].astype(np.int64) - 1] += touch.damping
        return Touched(at, touch)

    def judge(self, at: Touched, z: Floats) -> Judgement:
        """Size of the residual, of equilibrium and of the contact conditions."""
        judged: Judgement = self.inner.judge(at.at, z[: self.n])
        judged.note = self.stage
        lack, pair, constraint = self.lack(at)
        before = judged.force
        self.system.scales.add_lack(judged, lack)
        if judged.force > before:
            node = self.touching.pairs[pair].nodes[constraint]
            judged.worst = int(self.system.start[node])
        if self.corrections:  # before the first, supports may still have to move
            self.waited = 0 if judged.size < PROGRESS * self.least else self.waited + 1
            self.least = min(self.least, judged.size)
        return judged

    def release(self, at: Touched) -> None:
        """Keep the tangent: states of contact are looked back at."""

    def lack(self, at: Touched) -> tuple[float, int, int]:
        """Largest lack of the contact conditions as a force; its pair and constraint."""
        worst = (0.0, 0, 0)
        for k, (pair, terms, (p, q)) in enumerate(self._pairs(at.touch)):
            if pair.n:
                lack = pair.violation(terms, p, q)
                i = int(np.argmax(lack))
                if lack[i] > worst[0]:
                    worst = (float(lack[i]), k, i)
        return worst

    def predict(self, at: Touched, du_held: Floats) -> tuple[Floats, int]:
        """Newton correction of displacements and multipliers."""
        return self.correct(at, -at.residual, du_held)

    def correct(self, at: Touched, rhs: Floats, du_held: Floats) -> tuple[Floats, int]:
        """Correction for a right-hand side of equilibrium; that of contact is added."""
        asked = Asked(rhs[: self.n, None], du_held[: self.n, None], np.ones(1))
        self.pivoting = self.pivoting or self.waited >= WAITED
        if self.pivoting:
            self._freeze()
            found = pivoted(self, at, asked)
            if found is not None:
                z, self.last, senses = found
                self.senses = {p.first: s for p, s in zip(self.touching.pairs, senses, strict=True)}
                self.pivoted += 1
                self.stage = "contact states by pivoting"
                return self._moved(z), -1
        before = self.single
        z, negative = self._columns(at, asked, self._choose(at.touch))
        self.stage = "single change of contact" if self.single > before else ""
        return self._moved(z[:, 0]), negative

    def _moved(self, z: Floats) -> Floats:
        """A correction, whose first size is kept."""
        if not self.first_move:
            self.first_move = float(np.abs(z[: self.n][~self.system.is_rotation]).max())
        return z

    def _freeze(self) -> None:
        self.corrections += 1
        for pair in self.touching.pairs:
            pair.frozen = self.corrections >= SETTLED

    def _columns(
        self,
        at: Touched,
        asked: Asked,
        states: States,
        senses: dict[tuple[int, int], float] | None = None,
    ) -> tuple[Floats, int]:
        """Solutions of one linearisation, shape (n_dofs + n_multipliers, k)."""
        self._freeze()
        self.senses = {
            pair.first: pair.sense(terms, q) for pair, terms, (p, q) in self._pairs(at.touch)
        }
        for (k, i), sense in (senses or {}).items():
            self.senses[self.touching.pairs[k].first][i] = sense
        du, dp, negative, states = self._held(at, states, asked)
        for (pair, terms, (p, q)), state in zip(self._pairs(at.touch), states, strict=True):
            if pair.two:
                # Slipping tractions follow the pressure; they are no unknowns of the solution.
                ratio = pair.rows(terms, state, p, q, self.senses[pair.first])[4]
                now = np.outer(p, asked.own) + dp[pair.first : pair.first + pair.n]
                new = ratio[:, None] * now - np.outer(q, asked.own)
                slips = state != CLOSED
                dp[pair.first + pair.n : pair.first + pair.width][slips] = new[slips]
        return np.concatenate([du, dp]), negative

    def _solve(self, at: Touched, states: States, asked: Asked) -> tuple[Floats, Floats, int]:
        coupling, own, expected = self._coupling(at.touch, states)
        force = asked.force + np.outer(self.system.at_nodes(coupling.force), asked.own)
        rows = np.outer(own, asked.own)
        du, dp, negative = self.border.solve(at.at, coupling, force, rows, asked.held)
        return du, dp, negative - expected if negative >= 0 else -1

    def _held(
        self, at: Touched, states: States, asked: Asked
    ) -> tuple[Floats, Floats, int, States]:
        """Correction for states that hold the bodies, changed as little as that takes.

        Where all nodes that held a body slip at once, nothing holds it: some must still stick.
        """
        stuck = [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
        slipping = any((s == SLIPPING).any() for s in states)
        tries = [states]
        if slipping:
            tries += [self._least_stick(at, states), stuck]
        problem: SingularError | None = None
        for tried in tries:
            try:
                du, dp, negative = self._solve(at, tried, asked)
            except SingularError as error:
                problem = error
                self.sliding += slipping
                continue
            if tried is not stuck and slipping and self._far(du, asked):
                self.sliding += 1
                continue
            du, dp, negative, tried = self._let_slip(at, tried, asked, (du, dp, negative))
            self.last = tried
            return du, dp, negative, tried
        assert problem is not None
        return self._close_some(at, stuck if slipping else states, asked, problem)

    def _least_stick(self, at: Touched, states: States) -> States:
        """States with the half that exceeds the friction least sticking again."""
        out = []
        for s, (pair, terms, (p, q)) in zip(states, self._pairs(at.touch), strict=True):
            slips = np.flatnonzero(s == SLIPPING)
            shear, loaded = np.abs(pair.shear(terms, q))[slips], p[slips] > 0.0
            over = np.where(loaded, shear / np.where(loaded, p[slips], 1.0), np.inf)
            s = s.copy()
            s[slips[np.lexsort((shear, over))[: (len(slips) + 1) // 2]]] = CLOSED
            out.append(s)
        return out

    def _let_slip(
        self,
        at: Touched,
        states: States,
        asked: Asked,
        found: tuple[Floats, Floats, int],
    ) -> tuple[Floats, Floats, int, States]:
        """Let slip at once what a correction would load far beyond friction.

        Otherwise a long motion of supports drags the mesh along before anything slips.
        """
        for _ in range(SLIPS if self.corrections <= 2 else 0):
            new = [s.copy() for s in states]
            senses = dict(self.senses)
            for s, (pair, _, (p, q)) in zip(new, self._pairs(at.touch), strict=True):
                if not pair.friction:
                    continue
                p1 = p + found[1][pair.first : pair.first + pair.n, 0]
                q1 = q + found[1][pair.first + pair.n : pair.first + pair.width, 0]
                over = (s == CLOSED) & (np.abs(q1) > BEYOND * pair.friction * np.maximum(p1, p))
                s[over] = SLIPPING
                sense = self.senses[pair.first]
                senses[pair.first] = np.where(over, np.where(q1 > 0.0, 1.0, -1.0), sense)
            if all(np.array_equal(a, b) for a, b in zip(new, states, strict=True)):
                break
            before, self.senses = self.senses, senses
            try:
                other = self._solve(at, new, asked)
            except SingularError:
                self.senses = before
                break
            if self._far(other[0], asked):
                self.senses = before
                break
            found, states = other, new
        return *found, states

    def _far(self, du: Floats, asked: Asked) -> bool:
        """Whether a correction moves the surfaces farther than contact looks."""
        moved = self.system.by_node(du[:, 0])[:, :2]
        held = 2.0 * float(np.abs(self.system.by_node(asked.held[:, 0])[:, :2]).max())
        for pair in self.touching.pairs:
            if pair.friction and np.abs(moved[pair.slave.node_list]).max() > pair.reach + held:
                return True
        return False

    def _close_some(
        self, at: Touched, states: States, asked: Asked, error: SingularError
    ) -> tuple[Floats, Floats, int, States]:
        """Bring bodies that nothing holds into contact: close the nearest nodes, ever more."""
        gaps = [
            np.where((s == OPEN) & (not pair.tied), pair.trial(terms, p)[0], np.inf)
            for s, (pair, terms, (p, _)) in zip(states, self._pairs(at.touch), strict=True)
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
                du, dp, negative = self._solve(at, tried, asked)
            except SingularError:
                continue
            self.last, self.loose = tried, str(error)
            return du, dp, negative, tried
        open_pairs = [
            pair.name for pair, s in zip(self.touching.pairs, states, strict=True)
            if not (s != OPEN).any()
        ]  # fmt: skip
        if open_pairs:
            raise SingularError(
                f"{error}; contact pair {open_pairs[0]!r} is open: hold the body until it "
                "touches, start in contact (start='adjust'), or let it be damped "
                "(stabilise=True, *CONTACT CONTROLS, STABILIZE)",
                error.equation,
                error.mode,
            ) from None
        raise error

    @property
    def border(self) -> Bordered:
        """Linear algebra, kept with the system."""
        border = self.touching.border
        if border is None:
            border = self.touching.border = Bordered(self.system, self.touching.n)
        return border

    # -- states ------------------------------------------------------------------------

    def _pairs(self, touch: Touch) -> Any:
        return zip(
            self.touching.pairs, touch.terms, self.touching.parts(touch.multipliers), strict=True
        )

    def _choose(self, touch: Touch) -> States:
        """States for the next correction; single changes once a set comes back."""
        before: Sequence[NDArray[np.int8] | None] = self.last or [None] * len(self.touching.pairs)
        wanted = [
            pair.states(terms, p, q, last)
            for (pair, terms, (p, q)), last in zip(self._pairs(touch), before, strict=True)
        ]
        if self.last is not None:
            changed = [a != b for a, b in zip(wanted, self.last, strict=True)]
            for flips, new in zip(self.flips, changed, strict=True):
                flips += new
            if any(c.any() for c in changed):
                key = b"".join(s.tobytes() for s in wanted)
                self.seen[key] = self.seen.get(key, 0) + 1
                if self.seen[key] > HOPELESS:
                    raise GiveUp("the contact states go round in a circle")
                self.cautious = self.cautious or self.seen[key] > RETURNS
                self.pivoting = self.pivoting or self.cautious
                if self.cautious:
                    wanted = self._one_change(touch, wanted, changed)
        self.last = wanted
        return wanted

    def _one_change(self, touch: Touch, wanted: States, changed: list[NDArray[np.bool_]]) -> States:
        """Only the change that the conditions lack most, and all that lie next to nothing."""
        assert self.last is not None
        self.single += 1
        best, where = -1.0, (0, 0)
        for k, (pair, terms, (p, q)) in enumerate(self._pairs(touch)):
            lack = np.where(changed[k], pair.violation(terms, p, q), -1.0)
            # Of equals, as in symmetric models, the first: rounding must not choose.
            if pair.n and lack.max() > (1.0 + ALIKE) * best:
                first = int(np.argmax(lack >= (1.0 - ALIKE) * lack.max()))
                best, where = float(lack[first]), (k, first)
        out = [s.copy() for s in self.last]
        out[where[0]][where[1]] = wanted[where[0]][where[1]]
        # What sees nothing of the other side cannot be closed.
        for state, pair, terms in zip(out, self.touching.pairs, touch.terms, strict=True):
            state[terms.area <= 1e-9 * pair.full] = OPEN
        return out

    # -- linear equations --------------------------------------------------------------

    def _coupling(self, touch: Touch, states: States) -> tuple[Coupling, Floats, int]:
        """The border for states, its right-hand side, and its negative pivots."""
        touching, w = self.touching, self.weight
        m = touching.n
        bend, rows, follow = [], [], []
        diagonal, rhs = np.ones(m), np.zeros(m)
        force = np.zeros(self.n + 1)
        near: list[tuple[Ints, Ints]] = []
        expected = 0
        for (pair, terms, (p, q)), state in zip(self._pairs(touch), states, strict=True):
            first, n = pair.first, pair.n
            dp, rp, dq, rq, ratio = pair.rows(terms, state, p, q, self.senses[first])
            diagonal[first : first + n], rhs[first : first + n] = dp, rp
            expected += int((state != OPEN).sum())
            where = touching.dofs(terms.variables)
            k = terms.constraint
            closed = state != OPEN
            rows.append(border(where, first + k, -w * terms.gap_gradient, closed[k]))
            # Tractions that are known after the correction go to the right-hand side.
            known = np.where(closed, 0.0, -p)
            part = w * known[k, None] * terms.gap_gradient
            if pair.two:
                second = first + n
                diagonal[second : second + n], rhs[second : second + n] = dq, rq
                expected += int((state == CLOSED).sum())
                rows.append(border(where, second + k, -w * terms.slip_gradient, state[k] == CLOSED))
                known = np.where(state == CLOSED, 0.0, ratio * p - q)
                part += w * known[k, None] * terms.slip_gradient
                slope = -w * ratio[k, None] * terms.slip_gradient
                follow.append(border(where, first + k, slope, state[k] == SLIPPING))
            np.add.at(force, where, part)
            if self.system.turning and (p.any() or q.any()):
                bend.append(self._bend(pair, p, q))
            near.append(self._near(pair, terms))
        coupling = Coupling(
            Triplets.join(bend), Triplets.join(rows), Triplets.join(follow), diagonal,
            force[:-1], stacked(near),
        )  # fmt: skip
        return coupling, rhs, expected

    def _bend(self, pair: Any, p: Floats, q: Floats) -> Triplets:
        with self.system.timed("contact"):
            _, variables, values = pair.core.hessian(p[pair.owner], q[pair.owner])
        where = self.touching.dofs(variables)
        v = where.shape[1]
        a, b = np.repeat(where, v, axis=1).ravel(), np.tile(where, (1, v)).ravel()
        entries = -self.weight * values.reshape(-1)
        keep = (a >= 0) & (b >= 0) & (entries != 0.0)
        return Triplets(a[keep], b[keep], entries[keep])

    def _near(self, pair: Any, terms: Any) -> tuple[Ints, Ints]:
        """Dofs and multipliers of candidate pairs next to those that touch."""
        if not self.system.turning:
            return np.zeros((0, 0), np.int64), np.zeros((0, 0), np.int64)
        variables, constraints = pair.core.pattern()
        found = pair.core.candidates()
        used = np.zeros(len(found), bool)
        used[terms.pair] = True
        if not used.any():
            return np.zeros((0, 0), np.int64), np.zeros((0, 0), np.int64)
        width = int(found[:, 1].max()) + 8
        key = found[:, 0] * width + found[:, 1] + 3
        touching = np.sort(key[used])
        next_up = np.minimum(np.searchsorted(touching, key - 2), len(touching) - 1)
        close = np.abs(touching[next_up] - key) <= 2
        variables, constraints = variables[close], constraints[close]
        own = np.where(constraints >= 0, pair.first + pair.owner[constraints], -1)
        if pair.two:
            own = np.concatenate([own, np.where(own >= 0, own + pair.n, -1)], axis=1)
        return self.touching.dofs(variables), own

    # -- the end of an increment -------------------------------------------------------

    def settle(self, outcome: Outcome[Touched]) -> Outcome[Evaluation]:
        """What became of an increment in terms of the system; explains failures."""
        u = outcome.u[: self.n].copy()
        at = None if outcome.at is None else outcome.at.at
        if outcome.converged and outcome.at is not None:
            outcome.reason = self.refuse(outcome.at, outcome.u)
            outcome.converged = not outcome.reason
        settled: Outcome[Any] = replace(outcome, u=u, at=cast("Any", at))
        self.touch = None if outcome.at is None else outcome.at.touch
        if not outcome.converged:
            settled.reason = f"{outcome.reason}{self.explain(outcome.at)}"
            self.touching.restore()
        elif self.single:
            settled.note = f"{outcome.note}; {self.single} single changes of contact".strip("; ")
        if outcome.converged and self.pivoted:
            said = f"contact states by pivoting in {self.pivoted} iterations"
            settled.note = f"{settled.note}; {said}".strip("; ")
        return settled

    def refuse(self, at: Touched, z: Floats) -> str:
        """Why an equilibrium is not taken, or nothing.

        Nodes went through the other surface, or a body that nothing holds is far away.
        """
        if self.inner is self.system:
            far: str = self.system.scales.senseless(z)
            if far:
                return far
        if not self.system.turning:
            return ""
        old, new = self.touching.positions(self.touching.u), self.touching.positions(z[: self.n])
        still = self.pivoted and not self.relaxing and self.inner is self.system
        if still and not self.near(z[: self.n]):
            return "the equilibrium that was found is far from the one before"
        for pair, terms, (p, q) in self._pairs(at.touch):
            found = passed(pair, old, new, pair.states(terms, p, q))
            if len(found):
                return (
                    f"node {self.touching.label(pair, int(found[0]))} went through the other "
                    f"side of contact pair {pair.name!r} in one increment"
                )
        return ""

    def near(self, u: Floats) -> bool:
        """Whether an equilibrium is near the committed one, as far as its first correction says."""
        moved = float(np.abs((u - self.touching.u)[~self.system.is_rotation]).max())
        forces = bool(np.any(self.system.load_rate(u)[0]))
        limit = (JUMP_OF_FORCE if forces else JUMP) * self.first_move
        return limit == 0.0 or moved <= limit

    def accept(self, u: Floats, step_time: float) -> list[str]:
        """Commit contact with the increment; returns remarks that are new."""
        assert self.touch is not None
        self.touching.commit(u, self.touch, step_time)
        notes = []
        for number in sorted(self.border.dropped - self.touching.told):
            pair = next(p for p in reversed(self.touching.pairs) if p.first <= number)
            label = self.touching.label(pair, (number - pair.first) % pair.n)
            notes.append(
                f"contact pair {pair.name!r}: the constraint at node {label} follows from others "
                "(supports, ties or other pairs) and was left out"
            )
        self.touching.told |= self.border.dropped
        return notes

    def explain(self, at: Touched | None) -> str:
        """Which pair and nodes a failed increment hung on, and what was tried."""
        return explained(self, at)


__all__ = ["MORE", "PATIENCE", "Touched", "TouchingSystem"]
