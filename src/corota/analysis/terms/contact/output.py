"""Output of contact: values at slave nodes, resultants of pairs, energies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.gaps import CLOSED, OPEN, mean
from corota.arrays import distinct

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.pair import Pair, Terms

    Floats = NDArray[np.float64]


def output(
    term: ContactTerm,
) -> tuple[Floats | None, dict[str, float], dict[str, Floats]]:
    """Contact at the nodes of the committed state, and sums of the pairs.

    Returns
    -------
    values : ndarray, shape (n_nodes, 5), or None without pairs
        See :attr:`corota.results.Frame.C`.
    sums : dict of str to float
        Force on the slave surface, its moment about the origin, area, gap, and energies.
    pairs : dict of str to ndarray, shape (n_nodes, 5)
        See :attr:`corota.results.Frame.pairs`.
    """
    if not term.pairs:
        return None, {}, {}
    n = len(term.system.per_node)
    values = np.zeros((n, 5))
    sums: dict[str, float] = {}
    several = sum(not pair.tied for pair in term.pairs) > 1
    each = {p.name: np.zeros((n, 5)) for p in term.pairs if several and not p.tied}
    contact_state = term.at
    friction = law = 0.0
    for k, (pair, (p, q)) in enumerate(zip(term.pairs, term.parts(term.committed), strict=True)):
        if contact_state is None:
            if not pair.tied:
                rows = np.zeros((pair.n, 5))
                rows[:, 2] = pair.first_gap
                sums[f"{pair.name}: gap"] = float(rows[:, 2].min(initial=pair.reach))
                for table in (values, *([each[pair.name]] if pair.name in each else [])):
                    _spread(table, pair, rows[pair.owner])
            continue
        terms, state = contact_state.terms[k], contact_state.states[k]
        acting, x = contact_state.acting[k], contact_state.where
        assert x is not None
        gap = mean(terms.gap, terms.area, pair.full, pair.reach)
        # Positive when the slave is pulled along its own edges' direction.
        rows = np.column_stack([p, q, gap, pair.slid, state])[pair.owner]
        if pair.tied:
            rows[:] = 0.0
        _spread(values, pair, rows, terms)
        if pair.name in each:
            _spread(each[pair.name], pair, rows, terms)
        fx, fy, moment = resultant(pair, acting, p, q, x)
        sums[f"{pair.name}: force x"] = fx
        sums[f"{pair.name}: force y"] = fy
        sums[f"{pair.name}: moment"] = moment
        if not pair.tied:
            closed = np.zeros(n)
            area = np.where(state != OPEN, terms.area, 0.0)
            np.maximum.at(closed, pair.nodes[: pair.of_surfaces], area[: pair.of_surfaces])
            # A corner that presses alone counts as a node does.
            area[: pair.of_surfaces] = 0.0
            area[pair.backed(terms, state)] = 0.0
            sums[f"{pair.name}: gap"] = float(gap.min(initial=pair.reach))
            sums[f"{pair.name}: area"] = float(closed.sum() + area.sum())
        if pair.rubs:
            shear = resultant(pair, acting, np.zeros_like(p), q, x)
            for name, value in zip(("x", "y", "moment"), shear, strict=True):
                sums[f"{pair.name}: friction {name}"] = value
        friction += pair.friction_work
        law += pair.law_energy(terms)
    sums["friction energy"] = friction
    sums["contact energy"] = law
    sums["stabilization energy"] = term.damping_work
    return values, sums, each


def pressures(
    term: ContactTerm, terms: list[Terms] | None, multipliers: Floats
) -> tuple[Floats, NDArray[np.bool_]]:
    """Contact pressure of the slave nodes, and nodes whose pair has a pressure law.

    Parameters
    ----------
    term : ContactTerm
    terms : list of Terms or None
        Of all pairs at the state; None before the first increment.
    multipliers : ndarray, shape (n_multipliers,)
    """
    n = len(term.system.per_node)
    values, soft = np.zeros((n, 5)), np.zeros(n, bool)
    each = zip(term.pairs, term.parts(multipliers), strict=True)
    for k, (pair, (p, _)) in enumerate(each):
        if pair.tied:
            continue
        rows = np.zeros((pair.n, 5))
        rows[:, 0], rows[:, 4] = p, np.where(p > 0.0, CLOSED, OPEN)
        _spread(values, pair, rows[pair.owner], None if terms is None else terms[k])
        soft[pair.nodes] |= pair.law is not None
    return values[:, 0], soft


def _spread(values: Floats, pair: Pair, rows: Floats, terms: Terms | None = None) -> None:
    """Add a pair's rows to the nodes."""
    n = len(values)
    own = np.zeros((n, 5))
    own[pair.nodes[: pair.of_nodes]] = rows[: pair.of_nodes]
    # Facets in contact with rounded corners are shown at their first nodes.
    facets = pair.nodes[pair.of_nodes : pair.of_surfaces]
    more = rows[pair.of_nodes : pair.of_surfaces]
    for column in (0, 1, 3):
        own[facets, column] += more[:, column]
    own[facets, 2] = np.minimum(own[facets, 2], more[:, 2])
    own[facets, 4] = np.maximum(own[facets, 4], more[:, 4])
    if terms is not None and len(pair.corners):
        _spread_corners(own, pair, rows, terms)
    nodes = distinct(pair.nodes)
    before = values[nodes, 4] > 0.0
    values[nodes, :2] += own[nodes, :2]
    values[nodes, 3] += own[nodes, 3]
    # The gap of a node with several pairs is that of the closed one, else the smallest.
    first = ~before & (values[nodes, 2] == 0.0)
    values[nodes, 2] = np.where(first, own[nodes, 2], np.minimum(values[nodes, 2], own[nodes, 2]))
    values[nodes, 4] = np.maximum(values[nodes, 4], own[nodes, 4])


def _spread_corners(own: Floats, pair: Pair, rows: Floats, terms: Terms) -> None:
    """Add the forces of corners as tractions of slave nodes, in place.

    A corner of the slave is a node itself; one of the master presses on those of an edge.
    """
    edges = pair.slave.nodes
    for k, variables, gradient in zip(
        terms.constraint, terms.variables, terms.gap_gradient, strict=True
    ):
        if k < pair.of_surfaces or rows[k, 4] == OPEN:
            continue
        a, b = (int(v) // 3 for v in variables[[0, 2]])
        edge = np.flatnonzero((edges[:, 0] == a) & (edges[:, 1] == b))
        shares = {a: 1.0}
        if len(edge) and pair.corners[k - pair.of_surfaces] not in (a, b):
            nodes = edges[int(edge[0])]
            width = 3 if nodes[2] >= 0 else 2
            shares = {
                int(variables[2 * i]) // 3: float(np.hypot(*gradient[2 * i : 2 * i + 2]))
                for i in range(width)
            }
        whole = sum(shares.values())
        for n, share in shares.items():
            own[n, :2] += share / whole * rows[k, :2] * pair.full[k] / pair.full[pair.place[n]]
            own[n, 4] = max(own[n, 4], rows[k, 4])


def resultant(
    pair: Pair, terms: Terms, p: Floats, q: Floats, x: Floats
) -> tuple[float, float, float]:
    """Force on the slave surface and its moment about the origin."""
    part = p[terms.constraint, None] * terms.gap_gradient
    if pair.two:
        part = part + q[terms.constraint, None] * terms.slip_gradient
    node = np.maximum(terms.variables, 0) // 3
    on = (terms.variables >= 0) & pair.on_slave[node]
    nodal = np.zeros((len(x), 3))
    np.add.at(nodal, (node[on], terms.variables[on] % 3), part[on])
    moment = x[:, 0] @ nodal[:, 1] - x[:, 1] @ nodal[:, 0] + nodal[:, 2].sum()
    return float(nodal[:, 0].sum()), float(nodal[:, 1].sum()), float(moment)


__all__ = ["output", "pressures", "resultant"]
