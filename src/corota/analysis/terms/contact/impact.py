"""How much an increment of a motion misses of the moment of impact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.terms.contact.contact import ContactState, ContactTerm

    Floats = NDArray[np.float64]


def impact_error(
    contact_term: ContactTerm,
    contact_state: ContactState,
    moved: Floats,
    energy: float,
    tolerance: float,
) -> float:
    """What an increment misses of the moment of impact, over the allowed share.

    Gaps that close within the increment: the work contact does on the way, against a thousandth
    of the energy for a tolerance of one percent; where a rate condition keeps that at zero, the
    depth they are left with, against a tenth of an edge.

    Parameters
    ----------
    moved : ndarray, shape (n_dofs,)
        Displacement of the increment.
    energy : float
        Of the motion [force*length].
    tolerance : float
        Of the step [1].
    """
    if contact_term.persistent:
        depth = 0.0
        for pair, terms in zip(contact_term.pairs, contact_state.terms, strict=True):
            if pair.start is not None and pair.law is None and pair.n:
                deeper = np.minimum(pair.begun()[0], 0.0) - (terms.bare or terms).gap
                edge = float(pair.slave.length.mean())
                depth = max(depth, float((deeper / pair.full).max()) / edge)
        return 0.1 * depth / tolerance
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
    return 10.0 * abs(work) / (tolerance * energy) if energy > 0.0 else 0.0


__all__ = ["impact_error"]
