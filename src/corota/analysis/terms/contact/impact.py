"""Error of a dynamic increment in the instant of impact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.pair import COVERED, OPEN

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.gaps import ContactState

    Floats = NDArray[np.float64]


#: First contact may be found so late, over the tolerance of the step [slave edges].
FIRST = 1.0


def impact_error(
    contact_term: ContactTerm,
    contact_state: ContactState,
    moved: Floats,
    energy: float,
    tolerance: float,
    meets: bool = False,
) -> float:
    """Error of an increment in the instant of impact, relative to the allowed one.

    Gaps that close within the increment: the work of contact within it, against a thousandth
    of the energy for a tolerance of one percent; where a rate condition keeps that at zero, the
    depth they are left with, against a tenth of an edge. Surfaces that meet for the first time:
    a hundredth of an edge, which is the depth, or the gap that the increment began with where it
    was not to end at their first touch.

    Parameters
    ----------
    moved : ndarray, shape (n_dofs,)
        Displacement of the increment.
    energy : float
        Of the motion [force*length].
    tolerance : float
        Of the step [1].
    meets : bool
        Whether the increment was to end where surfaces meet.
    """
    first = _first_contact(contact_term, contact_state, meets) / (FIRST * tolerance)
    if contact_term.persistent:
        depth = 0.0
        for pair, terms in zip(contact_term.pairs, contact_state.terms, strict=True):
            if pair.start is not None and pair.law is None and pair.n:
                deeper = np.minimum(pair.begun()[0], 0.0) - (terms.bare or terms).gap
                edge = float(pair.slave.length.mean())
                depth = max(depth, float((deeper / pair.full).max()) / edge)
        return max(first, 0.1 * depth / tolerance)
    work = float(contact_state.force @ moved)
    parts = contact_term.parts(contact_state.multipliers)
    for k, (pair, terms, (_, q)) in enumerate(
        zip(contact_term.pairs, contact_state.terms, parts, strict=True)
    ):
        if pair.friction:
            work -= float(q @ terms.slip)
        if pair.law is not None:
            before = 0.0 if contact_term.at is None else pair.law_energy(contact_term.at.terms[k])
            work += pair.law_energy(terms) - before
    return max(first, 10.0 * abs(work) / (tolerance * energy) if energy > 0.0 else 0.0)


def _first_contact(contact_term: ContactTerm, contact_state: ContactState, meets: bool) -> float:
    """How late the first contact of surfaces is found [slave edges]."""
    late = 0.0
    parts = contact_term.parts(contact_state.multipliers)
    before = contact_term.at
    x = contact_term.positions(contact_term.u)
    for number, (pair, terms, (p, q)) in enumerate(
        zip(contact_term.pairs, contact_state.terms, parts, strict=True)
    ):
        if pair.tied or not pair.n or before is None or (meets and pair.start is None):
            continue
        begun = pair.gaps_at(contact_term, number, x)
        apart = pair.apart(begun, before.states[number])
        if pair.start is not None:
            depth = -(terms.bare or terms).gap
        else:
            seen = begun.area > COVERED * pair.full
            depth = np.where(seen & (pair.states(terms, p, q) != OPEN), begun.gap, 0.0)
        if pair.law is None and apart.any():
            depth = np.where(apart, depth / pair.full, 0.0)
            late = max(late, float(depth.max()) / float(pair.slave.length.mean()))
    return late


__all__ = ["impact_error"]
