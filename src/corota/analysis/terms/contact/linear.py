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
    Ints = NDArray[np.int64]
    States = list[NDArray[np.int8]]

#: Compliance of closed constraints relative to that of their nodes: constraints that follow from
#: others then leave the matrix regular.
COMPLIANCE = 1e-10


def linearized_contact(
    system: System, u: Floats, multipliers: Floats | None, states: States | None, time: float
) -> tuple[Evaluation, Coupling, States, Ints]:
    """Evaluation with the forces of contact, its rows and states, and multipliers of laws.

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
    contact_term = system.contact_term
    if not contact_term.pairs:
        none, entries = np.zeros(0), Triplets.join([])
        coupling = Coupling(entries, entries, entries, entries, none, none, lambda: stacked([]))
        return system.evaluate(u.copy(), time), coupling, [], contact_term.law_multipliers()
    if multipliers is None:
        multipliers = contact_term.committed
    contact = ContactEquations(system)
    at = system.evaluate(np.concatenate([u, multipliers]), time)
    if states is None and contact_term.at is not None and contact_term.at.states:
        states = contact_term.at.states
    elif states is None:
        states = [
            pair.states(terms, p, q) for pair, terms, (p, q) in contact.pairs(at.contact_state)
        ]
    states = [np.where(s == SLIPPING, CLOSED, s).astype(np.int8) for s in states]
    contact.slip_directions = {p.first: np.ones(p.n) for p in contact_term.pairs}
    coupling = contact.coupling(at.contact_state, states)[0]
    own, hard = np.zeros(contact_term.n), np.zeros(contact_term.n, bool)
    for pair in contact_term.pairs:
        part = pair.full / pair.stiffness
        own[pair.first : pair.first + pair.width] = np.tile(part, pair.width // pair.n)
        hard[pair.first : pair.first + pair.width] = pair.law is None
        # Slips of a pair with a pressure law have no compliance either.
        hard[pair.first + pair.n : pair.first + pair.width] = True
    bare = hard & (coupling.diagonal <= 0.0)
    coupling.diagonal[bare] = -COMPLIANCE * own[bare]
    contact_term.revert()
    return at, coupling, states, contact_term.law_multipliers()


__all__ = ["COMPLIANCE", "linearized_contact"]
