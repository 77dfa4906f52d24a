"""Contact states for the next correction, and what ends their cycles."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import GiveUp
from corota.analysis.terms.contact.pair import COVERED, OPEN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.analysis.terms.contact.gaps import ContactState
    from corota.analysis.terms.contact.problem import ContactProblem

    States = list[NDArray[np.int8]]

#: Repetitions of a set of states before single changes are made.
MAX_STATE_REPEATS = 2
#: Repetitions before the increment is given up.
MAX_REPEATS_BEFORE_CUTBACK = 7
#: Relative difference of contact residuals that counts as zero.
RELATIVE_DIFFERENCE = 1e-6


def chosen(problem: ContactProblem, contact_state: ContactState) -> States:
    """States for the next correction; single changes once a set comes back."""
    before: Sequence[NDArray[np.int8] | None] = problem.last or [None] * len(
        problem.contact_term.pairs
    )
    wanted = [
        pair.states(terms, p, q, last)
        for (pair, terms, (p, q)), last in zip(problem._pairs(contact_state), before, strict=True)
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
            problem.cautious = problem.cautious or problem.seen[key] > MAX_STATE_REPEATS
            problem.pivoting = problem.pivoting or problem.cautious
            if problem.cautious:
                wanted = _one_change(problem, contact_state, wanted, changed)
    problem.last = wanted
    return wanted


def _one_change(
    problem: ContactProblem,
    contact_state: ContactState,
    wanted: States,
    changed: list[NDArray[np.bool_]],
) -> States:
    """Only the change with the largest contact residual, and all with negligible ones."""
    assert problem.last is not None
    problem.single += 1
    best, where = -1.0, (0, 0)
    for k, (pair, terms, (p, q)) in enumerate(problem._pairs(contact_state)):
        complementarity = np.where(changed[k], pair.violation(terms, p, q), -1.0)
        # Of equals, as in symmetric models, the first: rounding must not choose.
        if pair.n and complementarity.max() > (1.0 + RELATIVE_DIFFERENCE) * best:
            first = int(
                np.argmax(complementarity >= (1.0 - RELATIVE_DIFFERENCE) * complementarity.max())
            )
            best, where = float(complementarity[first]), (k, first)
    out = [s.copy() for s in problem.last]
    out[where[0]][where[1]] = wanted[where[0]][where[1]]
    # Constraints without an opposite surface cannot be closed.
    for state, pair, terms in zip(
        out, problem.contact_term.pairs, contact_state.terms, strict=True
    ):
        state[terms.area <= COVERED * pair.full] = OPEN
    return out


__all__ = ["chosen"]
