"""Contact linearized about a state: what is closed stays closed and sticks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.coupling import Coupling
from corota.analysis.linear.triplets import Triplets
from corota.analysis.terms.contact.equations import ContactEquations
from corota.analysis.terms.contact.linearization import stacked
from corota.analysis.terms.contact.pair import CLOSED, SLIPPING

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation

    Floats = NDArray[np.float64]
    States = list[NDArray[np.int8]]

#: Compliance of closed constraints relative to that of their nodes: constraints that follow from
#: others then leave the matrix regular.
COMPLIANCE = 1e-10


def linearized_contact(
    system: System, u: Floats, multipliers: Floats, states: States | None, time: float
) -> tuple[Evaluation, Coupling, States]:
    """Evaluation of the bodies with the forces of contact, the rows of contact, and its states.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    multipliers : ndarray, shape (n_multipliers,)
    states : list of ndarray or None
        Of the constraints; the committed ones by default, with what slips stuck.
    time : float
        Step time.
    """
    contact_term = system.contact_term
    if not contact_term.pairs:
        none, entries = np.zeros(0), Triplets.join([])
        coupling = Coupling(entries, entries, entries, entries, none, none, lambda: stacked([]))
        return system.evaluate(u.copy(), time), coupling, []
    contact = ContactEquations(system, system)
    found = contact.evaluate(np.concatenate([u, multipliers]), time)
    if states is None and contact_term.at is not None and contact_term.at.states:
        states = contact_term.at.states
    elif states is None:
        states = [
            pair.states(terms, p, q) for pair, terms, (p, q) in contact._pairs(found.contact_state)
        ]
    states = [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
    contact.slip_directions = {p.first: np.ones(p.n) for p in contact_term.pairs}
    coupling = contact._coupling(found.contact_state, states)[0]
    own, hard = np.zeros(contact_term.n), np.zeros(contact_term.n, bool)
    for pair in contact_term.pairs:
        part = pair.full / pair.stiffness
        own[pair.first : pair.first + pair.width] = np.tile(part, pair.width // pair.n)
        hard[pair.first : pair.first + pair.width] = pair.law is None
        # Slips of a pair with a pressure law have no compliance either.
        hard[pair.first + pair.n : pair.first + pair.width] = True
    bare = hard & (coupling.diagonal <= 0.0)
    coupling.diagonal[bare] = -COMPLIANCE * own[bare]
    contact_term.restore()
    return found.at, coupling, states


__all__ = ["COMPLIANCE", "linearized_contact"]
