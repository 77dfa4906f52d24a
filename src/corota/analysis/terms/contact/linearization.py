"""The linearized equations of contact: the border of the tangent for a set of states."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.coupling import Coupling
from corota.analysis.linear.triplets import Triplets
from corota.analysis.terms.contact.pair import CLOSED, OPEN, SLIPPING

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.gaps import ContactState
    from corota.analysis.terms.contact.pair import Pair, Terms

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    States = list[NDArray[np.int8]]
    Linearized = tuple[Coupling, Floats, int, list[tuple[Floats, Floats]]]


def linearized(
    term: ContactTerm, at: ContactState, states: States, slip_directions: dict[int, Floats]
) -> Linearized:
    """The border for states, its right-hand side, and its negative pivots.

    Behind these, of each pair: the slopes of slipping tractions over the pressure and their
    tractions at no pressure, shapes (n,).

    Parameters
    ----------
    slip_directions : dict of int to ndarray
        Signs of slipping tractions, by the pair's first multiplier.
    """
    geometric_stiffness, skew, rows, follow, slopes = [], [], [], [], []
    diagonal, rhs = np.ones(term.n), np.zeros(term.n)
    force = np.zeros(term.system.n_dofs)
    expected = 0
    parts = term.parts(at.multipliers)
    for pair, terms, (p, q), state in zip(term.pairs, at.terms, parts, states, strict=True):
        first, second, end = pair.first, pair.first + pair.n, pair.first + pair.width
        dp, rp, dq, rq, ratio, level = pair.rows(terms, state, p, q, slip_directions[first])
        slopes.append((ratio, level))
        closed, sticks, share = state != OPEN, state == CLOSED, term.share(pair)
        diagonal[first:second], rhs[first:second] = share * dp, share * rp
        expected += int(closed.sum())
        acting = terms.acting
        to_rows = term.dofs(terms.variables)
        to_acting = to_rows if acting is terms else term.dofs(acting.variables)

        def columns(
            name: str,
            start: int,
            chosen: NDArray[np.bool_],
            share: float = 1.0,
            both: tuple[Terms, Terms] = (terms, acting),
            dofs: tuple[Ints, Ints] = (to_rows, to_acting),
        ) -> None:
            """A gradient at the end in rows and columns; forces may act along another."""
            k, own = both[0].constraint, share * getattr(both[0], name)
            rows.append(border(dofs[0], start + k, -own, chosen[k]))
            if both[1] is not both[0]:
                follow.append(border(dofs[0], start + k, own, chosen[k]))
                k, own = both[1].constraint, share * getattr(both[1], name)
                follow.append(border(dofs[1], start + k, -own, chosen[k]))

        columns("gap_gradient", first, closed, share)
        # Tractions that are known after the correction go to the right-hand side.
        known, shear = np.where(closed, 0.0, -share * p), np.zeros(pair.n)
        if pair.two:
            diagonal[second:end], rhs[second:end] = dq, rq
            expected += int(sticks.sum())
            columns("slip_gradient", second, sticks)
            shear = np.where(sticks, 0.0, ratio * p + level - q)
            k = acting.constraint
            slope = -ratio[k, None] * acting.slip_gradient
            follow.append(border(to_acting, first + k, slope, state[k] == SLIPPING))
        pair.add_forces(acting, to_acting, known, shear, force, None)
        if pair.active and term.system.nlgeom and (p.any() or q.any()):
            # Half way an end moves by half.
            half = 1.0 if acting is terms else 0.5
            even, odd = second_derivatives(term, pair, half * share * p, half * q)
            geometric_stiffness.append(even)
            skew.append(odd)

    # Where all stick, nothing moves along the tractions, which take the skew part up: without it
    # the matrix is symmetric, and its inertia known.
    slips = any(bool((state == SLIPPING).any()) for state in states)

    def near() -> tuple[Ints, Ints]:
        each = zip(term.pairs, at.terms, strict=True)
        return stacked([_near(term, pair, terms) for pair, terms in each])

    coupling = Coupling(
        Triplets.join(geometric_stiffness),
        Triplets.join(skew if slips else []),
        Triplets.join(rows),
        Triplets.join(follow),
        diagonal,
        force,
        near,
    )
    return coupling, rhs, expected, slopes


def second_derivatives(
    term: ContactTerm, pair: Pair, p: Floats, q: Floats
) -> tuple[Triplets, Triplets]:
    """Geometric stiffness: derivatives of the directions of the tractions.

    Returns
    -------
    even, odd : Triplets
        Symmetric part, and the skew part that friction has.
    """
    with term.system.timed("contact"):
        _, variables, values = pair.core.hessian(p[pair.owner], q[pair.owner])
    where = term.dofs(variables)
    v = where.shape[1]
    a, b = np.repeat(where, v, axis=1).ravel(), np.repeat(where, v, axis=0).ravel()
    inside = (a >= 0) & (b >= 0)

    def entries(part: Floats) -> Triplets:
        flat = -part.reshape(-1)
        return Triplets(a, b, flat).keep(inside & (flat != 0.0))

    if not pair.rubs or not q.any():
        return entries(values), Triplets.join([])
    turned = values.transpose(0, 2, 1)
    return entries(0.5 * (values + turned)), entries(0.5 * (values - turned))


def _near(term: ContactTerm, pair: Pair, terms: Terms) -> tuple[Ints, Ints]:
    """Dofs and multipliers of candidate pairs next to closed ones."""
    none = np.zeros((0, 0), np.int64)
    if not term.system.nlgeom:
        return none, none
    variables, constraints = pair.core.pattern()
    found = pair.core.candidates()
    used = np.zeros(len(found), bool)
    used[terms.pair] = True
    if not used.any():
        return none, none
    width = int(found[:, 1].max()) + 8
    key = found[:, 0] * width + found[:, 1] + 3
    keys = np.sort(key[used])
    next_up = np.minimum(np.searchsorted(keys, key - 2), len(keys) - 1)
    close = np.abs(keys[next_up] - key) <= 2
    variables, constraints = variables[close], constraints[close]
    own = np.where(constraints >= 0, pair.first + pair.owner[constraints], -1)
    if pair.two:
        own = np.concatenate([own, np.where(own >= 0, own + pair.n, -1)], axis=1)
    return term.dofs(variables), own


def border(where: Ints, column: Ints, gradient: Floats, rows: NDArray[np.bool_]) -> Triplets:
    """Gradients of some terms as columns."""
    where, gradient = where[rows], gradient[rows]
    columns = np.repeat(column[rows], where.shape[1])
    flat, values = where.ravel(), gradient.ravel()
    keep = (flat >= 0) & (values != 0.0)
    return Triplets(flat[keep], columns[keep], values[keep])


def stacked(parts: list[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    """Rows of several pairs below each other, filled with -1."""
    out = []
    for which in (0, 1):
        tables = [p[which] for p in parts if len(p[which])]
        width = max((t.shape[1] for t in tables), default=0)
        full = np.full((sum(len(t) for t in tables), width), -1, np.int64)
        first = 0
        for table in tables:
            full[first : first + len(table), : table.shape[1]] = table
            first += len(table)
        out.append(full)
    return out[0], out[1]


__all__ = ["border", "linearized", "second_derivatives", "stacked"]
