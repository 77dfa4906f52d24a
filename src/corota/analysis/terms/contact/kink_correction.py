"""Newton corrections at a kink of the contact surfaces: when one is tried, and how it is found."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import GiveUp
from corota.analysis.terms.contact.kinks import Sides, found
from corota.analysis.terms.contact.problem import RightHandSides

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.problem import ContactProblem

    Floats = NDArray[np.float64]

#: Iterations without progress after which a kink is searched.
WAITED = 3
#: Kinks that an attempt tries, and corrections in which one may carry a force above its jump.
MAX_KINKS, MAX_BEYOND = 3, 3
#: Fractions of the jump between which an equilibrium is searched: beyond, the bodies do not rest
#: there.
FEWEST_SHARES, MOST_SHARES = -2.0, 3.0
#: Remainder of two corrections that cancel each other, relative to the last one.
TO_AND_FRO = 0.2


def keeps_kink(problem: ContactProblem, at: Evaluation) -> bool:
    """Whether the correction is one at a kink; looks for one where there is no progress."""
    if problem.kink is not None:
        problem.beyond += problem.kink.excess > 0.0
        if problem.beyond <= MAX_BEYOND:
            return True
        if problem.inherits:
            problem.kink, problem.beyond, problem.inherits = None, 0, False
            return False
        raise GiveUp("no equilibrium at the kink of the contact surfaces")
    if (
        problem.waited < WAITED
        or problem.kinks >= MAX_KINKS
        or not _to_and_fro(problem.places)
        or at.link.couples
        or problem.contact_term.persistent
        or not problem.system.nlgeom
    ):
        return False
    sides = Sides(problem.contact_term, at.contact_state.multipliers, at.contact_state.time)
    _, before, here = problem.places
    problem.kink = found(sides, here, before)
    # The candidates of the search may have changed.
    state, now = at.contact_state, sides.state(here)
    at.internal = at.internal + state.force - now.force
    at.contact_state = now
    problem.kinks += problem.kink is not None
    return problem.kink is not None


def _to_and_fro(places: list[Floats]) -> bool:
    """Whether the last two corrections cancel each other."""
    if len(places) < 3:
        return False
    first, before, here = places
    return float(np.abs(here - first).max()) <= TO_AND_FRO * float(np.abs(here - before).max())


def along_kink(
    problem: ContactProblem, at: Evaluation, right_sides: RightHandSides
) -> tuple[Floats, int] | None:
    """Newton correction with the force that the kink carries as an unknown."""
    kink = problem.kink
    assert kink is not None
    both = RightHandSides(
        np.column_stack([right_sides.force[:, 0], kink.jump]),
        np.column_stack([right_sides.constrained[:, 0], np.zeros(problem.n)]),
        np.array([1.0, 0.0]),
    )
    z, negative = problem._columns(at, both, problem._choose(at.contact_state))
    first, second = kink.normal @ z[: problem.n]
    if second == 0.0:
        problem.kink = None
        return None
    change = (kink.distance - float(first)) / float(second)
    if not FEWEST_SHARES <= kink.share + change <= MOST_SHARES:
        problem.kink = None
        return None
    dz: Floats = z[:, 0] + change * z[:, 1]
    kink.base = (problem.places[-1], kink.share, dz[: problem.n].copy(), change)
    problem.stage = "equilibrium at a kink of the contact surfaces"
    return problem._moved(dz), negative


__all__ = ["along_kink", "keeps_kink"]
