"""Contact states of a correction: chosen one by one until they cycle, and such that bodies hold."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import GiveUp
from corota.analysis.terms.contact.pair import CLOSED, OPEN, SLIPPING
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.gaps import ContactState
    from corota.analysis.terms.contact.problem import ContactProblem, RightHandSides

    States = list[NDArray[np.int8]]
    Floats = NDArray[np.float64]

#: Repetitions of a set of states before the whole linearized problem decides.
MAX_STATE_REPEATS = 2
#: Repetitions before the increment is given up.
MAX_REPEATS_BEFORE_CUTBACK = 7


def chosen(problem: ContactProblem, contact_state: ContactState) -> States:
    """States for the next correction; the whole linearized problem once a set comes back."""
    before: Sequence[NDArray[np.int8] | None] = problem.last or [None] * len(problem.term.pairs)
    wanted = [
        pair.states(terms, p, q, last)
        for (pair, terms, (p, q)), last in zip(problem.pairs(contact_state), before, strict=True)
    ]
    if problem.last is not None:
        changed = [a != b for a, b in zip(wanted, problem.last, strict=True)]
        for flips, new in zip(problem.flips, changed, strict=True):
            flips += new
        if any(c.any() for c in changed):
            key = b"".join(s.tobytes() for s in wanted)
            problem.seen[key] = problem.seen.get(key, 0) + 1
            if problem.seen[key] > MAX_REPEATS_BEFORE_CUTBACK:
                raise GiveUp(
                    "the contact states cycle: the same nodes open, stick and slip as in "
                    f"{problem.seen[key] - 1} earlier iterations"
                )
            problem.pivoting = problem.pivoting or problem.seen[key] > MAX_STATE_REPEATS
    problem.last = wanted
    return wanted


#: Fraction of the friction bound from which a correction is repeated with slip, and how often.
FRICTION_EXCESS, MAX_SLIP_CORRECTIONS = 2.0, 3
#: Relative difference of two gaps that is rounding.
EQUAL = 1e-6


def columns(
    problem: ContactProblem,
    at: Evaluation,
    right_sides: RightHandSides,
    states: States,
    slip_directions: dict[tuple[int, int], float] | None = None,
) -> tuple[Floats, int]:
    """Solutions of one linearization, shape (n_dofs + n_multipliers, k)."""
    problem.freeze()
    problem.slip_directions = {
        pair.first: pair.slip_direction(terms, q)
        for pair, terms, (p, q) in problem.pairs(at.contact_state)
    }
    for (k, i), slip_direction in (slip_directions or {}).items():
        problem.slip_directions[problem.term.pairs[k].first][i] = slip_direction
    du, dp, negative, states = held(problem, at, states, right_sides)
    for (pair, terms, (p, q)), state in zip(problem.pairs(at.contact_state), states, strict=True):
        if pair.two:
            # Slipping tractions follow the pressure; they are no unknowns of the solution.
            rows = pair.rows(terms, state, p, q, problem.slip_directions[pair.first])
            ratio, level = rows[4:]
            now = np.outer(p, right_sides.own) + dp[pair.first : pair.first + pair.n]
            new = ratio[:, None] * now - np.outer(q - level, right_sides.own)
            slips = state != CLOSED
            dp[pair.first + pair.n : pair.first + pair.width][slips] = new[slips]
    return np.concatenate([du, dp]), negative


def held(
    problem: ContactProblem, at: Evaluation, states: States, right_sides: RightHandSides
) -> tuple[Floats, Floats, int, States]:
    """Correction for states that constrain the bodies.

    Where all nodes in contact with a body slip at once, it is unconstrained: they must stick.
    """
    if not problem.holds:
        return *problem.solve(at, states, right_sides), states
    slipping = any((s == SLIPPING).any() for s in states)
    tries, stuck = [states], states
    if slipping:
        stuck = [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
        tries.append(stuck)
    reason: SingularError | None = None
    for tried in tries:
        try:
            du, dp, negative = problem.solve(at, tried, right_sides)
        except SingularError as error:
            reason = error
            problem.sliding += slipping
            continue
        if tried is not stuck and slipping and far(problem, du, right_sides):
            problem.sliding += 1
            continue
        du, dp, negative, tried = let_slip(problem, at, tried, right_sides, (du, dp, negative))
        problem.last = tried
        return du, dp, negative, tried
    assert reason is not None
    return _close_some(problem, at, stuck, right_sides, reason)


def let_slip(
    problem: ContactProblem,
    at: Evaluation,
    states: States,
    right_sides: RightHandSides,
    found: tuple[Floats, Floats, int],
) -> tuple[Floats, Floats, int, States]:
    """Let constraints slip at once that a correction would load far beyond friction.

    Otherwise a large displacement of supports distorts the mesh before anything slips. What
    supports move over the surface slips in any case: no traction can hold it.
    """
    early = problem.corrections <= 2 and not problem.bounded
    for _ in range(MAX_SLIP_CORRECTIONS):
        new = [s.copy() for s in states]
        slip_directions = dict(problem.slip_directions)
        for s, (pair, _, (p, q)) in zip(new, problem.pairs(at.contact_state), strict=True):
            if not pair.friction:
                continue
            p1 = p + found[1][pair.first : pair.first + pair.n, 0]
            q1 = q + found[1][pair.first + pair.n : pair.first + pair.width, 0]
            own = slice(pair.first + pair.n, pair.first + pair.width)
            left = problem.border.left[own]
            left = left + np.where(pair.weightless(q), problem.border.left_by_others[own], 0.0)
            bound = pair.bound(np.maximum(p1, p))
            moved = (s == CLOSED) & (np.abs(left) > pair.noise) & np.isfinite(bound)
            q1[moved] = -left[moved]
            slips = pair.first + pair.n + np.flatnonzero(moved)
            problem.border.dropped.difference_update(slips.tolist())
            over = moved
            if early:
                over = over | (s == CLOSED) & (np.abs(q1) > FRICTION_EXCESS * bound)
            s[over] = SLIPPING
            slip_direction = problem.slip_directions[pair.first]
            slip_directions[pair.first] = np.where(
                over, np.where(q1 > 0.0, 1.0, -1.0), slip_direction
            )
        if all(np.array_equal(a, b) for a, b in zip(new, states, strict=True)):
            break
        before, problem.slip_directions = problem.slip_directions, slip_directions
        try:
            other = problem.solve(at, new, right_sides)
        except SingularError:
            problem.slip_directions = before
            break
        if far(problem, other[0], right_sides):
            problem.slip_directions = before
            break
        found, states = other, new
    return *found, states


def far(problem: ContactProblem, du: Floats, right_sides: RightHandSides) -> bool:
    """Whether a correction moves the surfaces beyond the contact search distance."""
    if problem.bounded:
        return False
    moved = problem.system.by_node(du[:, 0])[:, :2]
    constrained = 2.0 * float(
        np.abs(problem.system.by_node(right_sides.constrained[:, 0])[:, :2]).max()
    )
    for pair in problem.term.pairs:
        if pair.friction and np.abs(moved[pair.slave.node_list]).max() > pair.reach + constrained:
            return True
    return False


def _close_some(
    problem: ContactProblem,
    at: Evaluation,
    states: States,
    right_sides: RightHandSides,
    error: SingularError,
) -> tuple[Floats, Floats, int, States]:
    """Bring unconstrained bodies into contact: close the nearest nodes, increasingly many."""
    gaps = [
        np.where((s == OPEN) & (not pair.tied), pair.trial(terms, p)[0], np.inf)
        for s, (pair, terms, (p, _)) in zip(states, problem.pairs(at.contact_state), strict=True)
    ]
    nearest = min(float(gap.min(initial=np.inf)) for gap in gaps)
    for count in (0, 1, 2, None):
        tried = [s.copy() for s in states]
        for s, gap in zip(tried, gaps, strict=True):
            if count == 0:
                # A flat side comes to rest on all of its nodes.
                s[gap <= nearest * (1.0 + EQUAL)] = CLOSED
                continue
            near = np.argsort(gap, kind="stable")[:count]
            s[near[gap[near] < np.inf]] = CLOSED
        if all(np.array_equal(a, b) for a, b in zip(tried, states, strict=True)):
            break
        try:
            du, dp, negative = problem.solve(at, tried, right_sides)
        except SingularError:
            continue
        problem.last, problem.loose = tried, str(error)
        return du, dp, negative, tried
    open_pairs = [
        pair.name
        for pair, s in zip(problem.term.pairs, states, strict=True)
        if not (s != OPEN).any()
    ]
    if open_pairs:
        raise SingularError(
            f"{error}; contact pair {open_pairs[0]!r} is open: support the body until it is "
            "in contact, start in contact (start='adjust'), or damp it (stabilize=True, "
            "*CONTACT CONTROLS, STABILIZE)",
            error.equation,
            error.mode,
        ) from None
    raise error


__all__ = ["chosen", "columns"]
