"""What a failed increment hung on, and what gives way at a limit, in the words of the model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.corners import sunk_corner

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.problem import ContactProblem

#: How often a state must have changed to be named.
OFTEN = 2
#: Part of the force of a pair from which a node carries it alone, and of its friction bound from
#: which friction is used up.
WHOLE = 0.99
#: Least turn of a body's boundary at a corner [rad], as for constraints of corners.
LEAST_TURN = np.radians(50.0)


def explanation(problem: ContactProblem, at: Evaluation | None) -> str:
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
        if problem.single:
            said += f"; {problem.single} iterations changed the state of one node at a time"
    if way := gives_way(problem.contact_term):
        said += f"; {way}"
    elif problem.sliding > OFTEN:
        said += "; friction does not hold the bodies: they slide"
    if problem.loose:
        said += f"; without contact pressure, {problem.loose}"
    if problem.pivoted:
        said += (
            f"; {problem.pivoted} iterations chose the states of all contact nodes together "
            "(by pivoting), which did not converge either"
        )
    return said + sunk_corner(problem.system)


def gives_way(contact_term: ContactTerm) -> str:
    """Whether a body slides or tips beyond the committed state; empty if neither.

    A pair whose friction is used up lets a body slide, one that presses at a corner of a body alone
    lets it tip. At a collapse of the bodies themselves there is neither.
    """
    if contact_term.at is None:
        return ""
    parts = contact_term.parts(contact_term.committed)
    for pair, terms, (p, q) in zip(contact_term.pairs, contact_term.at.terms, parts, strict=True):
        force = p * terms.area
        total = float(force.sum())
        if pair.tied or not total > 0.0:
            continue
        if pair.friction and float(np.abs(q * terms.area).sum()) > WHOLE * pair.friction * total:
            return (
                f"friction of contact pair {pair.name!r} is used up: a body that it alone holds "
                "slides"
            )
        nodes = pair.nodes.copy()
        nodes[pair.of_surfaces :] = np.where(
            pair.corners >= 0, pair.corners, nodes[pair.of_surfaces :]
        )
        at_node = np.bincount(nodes, force)
        node = int(np.argmax(at_node))
        if at_node[node] > WHOLE * total and _corners(contact_term)[node]:
            label = contact_term.system.model.mesh.node_labels[node]
            return (
                f"contact pair {pair.name!r} presses at corner {label} alone: a body that it alone "
                "holds tips about it"
            )
    return ""


def _corners(contact_term: ContactTerm) -> NDArray[np.bool_]:
    """Whether the boundary of a body turns sharply at a node, shape (n_nodes,)."""
    mesh = contact_term.system.model.mesh
    ends = np.array([nodes[:2] for nodes in mesh.edge_nodes(mesh.boundary_edges())], np.int64)
    along = mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]]
    comes, goes = np.zeros((mesh.n_nodes, 2)), np.zeros((mesh.n_nodes, 2))
    comes[ends[:, 1]], goes[ends[:, 0]] = along, along
    cross = comes[:, 0] * goes[:, 1] - comes[:, 1] * goes[:, 0]
    found: NDArray[np.bool_] = np.arctan2(cross, (comes * goes).sum(axis=1)) > LEAST_TURN
    return found


__all__ = ["explanation", "gives_way"]
