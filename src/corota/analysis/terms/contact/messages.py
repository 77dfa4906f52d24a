"""What a failed increment hung on, in the words of the model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.corners import sunk_corner

if TYPE_CHECKING:
    from corota.analysis.terms.contact.problem import ContactEvaluation, ContactProblem

#: How often a state must have changed to be named.
OFTEN = 2


def explanation(problem: ContactProblem, at: ContactEvaluation | None) -> str:
    """Pair and nodes that caused a failed increment, and what was tried."""
    if at is None:
        return ""
    said = ""
    complementarity, k, i = problem.complementarity(at)
    pair, terms = problem.contact_term.pairs[k], at.contact_state.terms[k]
    if complementarity > 0.0:
        p = problem.contact_term.parts(at.contact_state.multipliers)[k][0][i]
        area = terms.area[i]
        gap = f"{terms.gap[i] / area:.3g}" if area > 0.0 else "none"
        said = (
            f"; contact pair {pair.name!r}: worst at node {problem.contact_term.label(pair, i)} "
            f"(gap {gap}, pressure {p:.3g})"
        )
    flipping = [
        (int(f[j]), pair, int(j))
        for pair, f in zip(problem.contact_term.pairs, problem.flips, strict=True)
        for j in np.flatnonzero(f > OFTEN)
    ]
    flipping.sort(key=lambda item: -item[0])
    if flipping:
        names = ", ".join(str(problem.contact_term.label(q, j)) for _, q, j in flipping[:5])
        said += (
            "; the contact state (open, stick or slip) kept changing at "
            f"node{'s' if len(flipping) > 1 else ''} {names}"
            f"{', ...' if len(flipping) > 5 else ''} of pair {flipping[0][1].name!r}"
        )
        if problem.sliding > OFTEN:
            said += "; friction does not hold the bodies: they slide"
        if problem.single:
            said += f"; {problem.single} iterations changed the state of one node at a time"
    if problem.loose:
        said += f"; without contact pressure, {problem.loose}"
    if problem.pivoted:
        said += (
            f"; {problem.pivoted} iterations chose the states of all contact nodes together "
            "(by pivoting), which did not converge either"
        )
    return said + sunk_corner(problem.contact_term)


__all__ = ["explanation"]
