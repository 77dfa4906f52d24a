"""Contact and ties in adjoint states: multipliers are unknowns of their own.

The constraints that press at a state stay closed; the others stay open. With their weighted gaps g
and multipliers the equations are those of a saddle point, whose matrix is symmetric, and a measure
changes by ``z . dr/dp - y . dg/dp``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import lsqr

from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.contact.equations import ContactEquations
from corota.analysis.terms.contact.gaps import ContactState, RightHandSides, covered
from corota.errors import UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Bools, Floats
    from corota.model.model import Model

    States = list[NDArray[np.int8]]

#: Gap of a closed constraint, over the size of the model.
TOUCHES = 1e-9
#: Share of the limit of friction at which a constraint slips, and slip that is none, over the size
#: of the model.
LIMIT, STANDS = 1e-7, 1e-12
#: Largest pressure of a constraint between open and closed, over the largest of all.
BETWEEN = 1e-6


@dataclass
class Surfaces:
    """Multipliers and states of all constraints at an increment.

    Parameters
    ----------
    multipliers : ndarray, shape (n_multipliers,)
    states : list of ndarray
        By pair.
    signs : list of ndarray
        Of the shear tractions, by pair.
    """

    multipliers: Floats
    states: States
    signs: list[Floats]

    @property
    def acting(self) -> Bools:
        """Multipliers of closed constraints, shape (n_multipliers,)."""
        found = []
        for state, sign in zip(self.states, self.signs, strict=True):
            found.append(np.tile(state != OPEN, 2 if len(sign) else 1))
        return np.concatenate([np.zeros(0, bool), *found])

    @property
    def slipping(self) -> list[Bools]:
        """Whether each constraint slips, by pair."""
        return [state == SLIPPING for state in self.states]


def contact_of(system: System) -> ContactTerm:
    """The term of contact and ties of a system."""
    return system.term(ContactTerm)


def refuse_surfaces(model: Model) -> None:
    """Refuse contact that depends on its path.

    Raises
    ------
    UnsupportedError
    """
    for pair in model.contacts:
        if pair.law is not None:
            why = "a law of pressure against overclosure"
        elif pair.shear_limit is not None or not pair.separates or pair.steps is not None:
            why = "a largest shear traction, surfaces that do not separate, or steps without them"
        elif pair.friction_steps or pair.varies:
            why = "friction that steps change or that depends on slip rate and pressure"
        elif pair.stabilize:
            why = "stabilization, which depends on increments"
        else:
            continue
        raise UnsupportedError(f"gradients do not include contact with {why}", pair.where)


def find(system: System, u: Floats, time: float, at: Evaluation, kinks: bool = False) -> Surfaces:
    """Multipliers that balance the forces of a state, on the constraints that are closed there.

    Raises
    ------
    UnsupportedError
        If a constraint stands between open and closed, or between stick and slip; not with `kinks`.
    """
    term = contact_of(system)
    state = evaluate(system, u, np.ones(term.n), time)
    rows, columns, values, states, closed = [], [], [], [], []
    for pair, terms in zip(term.pairs, state.terms, strict=True):
        seen = covered(terms.area, pair.full)
        # A node on the joint of two edges may be a little inside of one.
        touches = seen & (terms.gap <= TOUCHES * system.length * pair.full)
        if pair.tied:
            touches = seen
        states.append(np.where(touches, CLOSED, 0).astype(np.int8))
        dofs = pair.dofs(terms.variables)
        for start, gradient in _gradients(pair, terms):
            chosen = touches[terms.constraint][:, None] & (dofs >= 0)
            number = np.broadcast_to(start + terms.constraint[:, None], dofs.shape)
            rows.append(dofs[chosen])
            columns.append(number[chosen])
            values.append(gradient[chosen])
            closed.append(start + np.flatnonzero(touches))
    multipliers = np.zeros(term.n)
    which = np.concatenate([np.zeros(0, np.int64), *closed])
    if len(which):
        shape = (system.n_dofs, term.n)
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        matrix = sp.coo_array(entries, shape=shape).tocsc()[:, which]
        link = system.constraints.link(u)
        free = ~system.conditions.constrained
        border = sp.csc_array(link.gather(system.at_nodes(matrix.toarray())))[free]
        force = link.gather(at.residual)[free]
        size = sp.linalg.norm(border, axis=0)
        size[size == 0.0] = 1.0
        found = lsqr(border / size, force, atol=1e-15, btol=1e-15, iter_lim=20 * len(which) + 100)
        multipliers[which] = found[0] / size
    if not kinks:
        _refuse_between(system, states, multipliers)
    signs = []
    for k, (pair, (p, q)) in enumerate(zip(term.pairs, term.parts(multipliers), strict=True)):
        signs.append(np.sign(q) if pair.two else np.zeros(0))
        if pair.rubs:
            slips = (states[k] == CLOSED) & (np.abs(q) >= (1.0 - LIMIT) * pair.friction * p)
            states[k][slips] = SLIPPING
            if not kinks:
                _refuse_stuck(system, pair, state.terms[k], q, slips)
    return Surfaces(multipliers, states, signs)


def _refuse_stuck(system: System, pair: Any, terms: Any, q: Floats, slips: Bools) -> None:
    """Refuse constraints at the limit of friction that do not slip along the traction."""
    ahead = -np.sign(q) * terms.slip
    between = slips & (ahead <= STANDS * system.length * pair.full)
    if between.any():
        node = contact_of(system).label(pair, int(np.flatnonzero(between)[0]))
        raise UnsupportedError(
            f"node {node} of contact pair {pair.name!r} stands between stick and slip: measures "
            "have one-sided derivatives there. Change the load a little"
        )


def _refuse_between(system: System, states: States, multipliers: Floats) -> None:
    term = contact_of(system)
    most = float(np.abs(multipliers).max(initial=0.0))
    for pair, state, (p, _) in zip(term.pairs, states, term.parts(multipliers), strict=True):
        if pair.tied:
            continue
        between = (state == CLOSED) & (p <= BETWEEN * most)
        if between.any():
            node = term.label(pair, int(np.flatnonzero(between)[0]))
            raise UnsupportedError(
                f"node {node} of contact pair {pair.name!r} touches without pressure, between open "
                "and closed: measures have one-sided derivatives there. Change the load a little"
            )


def _gradients(pair: Any, terms: Any) -> Iterator[tuple[int, Floats]]:
    yield pair.first, terms.gap_gradient
    if pair.two:
        yield pair.first + pair.n, terms.slip_gradient


def evaluate(system: System, u: Floats, multipliers: Floats, time: float) -> ContactState:
    """Gaps, and forces of multipliers, without the tangent that only the choice of states needs."""
    return contact_of(system).evaluate(u, multipliers, time, np.empty(0))


def add_forces(
    system: System, u: Floats, time: float, at: Evaluation, surfaces: Surfaces
) -> Floats:
    """Add the forces of the multipliers to an evaluation.

    Returns
    -------
    ndarray, shape (n_multipliers,)
        Residuals of the closed constraints, 0 at open ones.
    """
    state = evaluate(system, u, surfaces.multipliers, time)
    at.internal = at.internal - state.force
    at.scale = at.scale + state.size
    return residuals(system, state, surfaces)


def slide(system: System, u: Floats | None = None, surfaces: Surfaces | None = None) -> None:
    """Let slips begin at a displacement, or where nothing has moved and all surfaces are open."""
    term = contact_of(system)
    term.u = np.zeros(system.n_dofs) if u is None else u.copy()
    for k, pair in enumerate(term.pairs):
        if surfaces is None:
            pair.keep_closed(np.zeros(pair.n, np.int8))
            continue
        pair.core.commit()
        pair.keep_closed(surfaces.states[k])


def residuals(system: System, state: ContactState, surfaces: Surfaces) -> Floats:
    """Gaps and slips of closed constraints, tractions of slipping ones less those of friction."""
    term = contact_of(system)
    out = np.zeros(term.n)
    parts = term.parts(surfaces.multipliers)
    each = zip(term.pairs, state.terms, parts, surfaces.states, surfaces.signs, strict=True)
    for pair, terms, (p, q), own, sign in each:
        out[pair.first : pair.first + pair.n] = np.where(own != OPEN, -terms.gap, 0.0)
        if pair.two:
            along = np.where(own == CLOSED, -terms.slip, 0.0)
            slips = own == SLIPPING
            along[slips] = (q - sign * pair.friction * p)[slips]
            out[pair.first + pair.n : pair.first + pair.width] = along
    return out


def solve(
    system: System, u: Floats, time: float, surfaces: Surfaces, rhs: Floats, moved: Floats
) -> tuple[Floats, Floats]:
    """Adjoint displacements and multipliers, shapes (n_dofs, m) and (n_multipliers, m)."""
    term = contact_of(system)
    contact = ContactEquations(system)
    term.nodal = np.zeros(0)  # stiffness of the nodes at this state
    at, symmetric = system.evaluate(np.concatenate([u, surfaces.multipliers]), time), True
    if at.load_stiffness is not None:
        symmetric = system._add_load_stiffness(at)[0]
        at.load_stiffness = None
    if not symmetric:
        raise UnsupportedError(
            "gradients with contact do not include follower loads without a potential (pressure on "
            "an edge with free ends)"
        )
    contact.slip_directions = [np.ones(pair.n) for pair in term.pairs]
    right = RightHandSides(np.asfortranarray(rhs), np.asfortranarray(moved), np.zeros(rhs.shape[1]))
    z, y, _ = contact.solve(at, [s.copy() for s in surfaces.states], right)
    return z, y
