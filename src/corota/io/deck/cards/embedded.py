"""Embedded elements: nodes that follow the elements around them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.build.mesh import views_in
from corota.io.deck.drafts import Draft
from corota.io.deck.keywords import keyword
from corota.mesh.kinds import PLANAR
from corota.mesh.parts import nodes_of_cells
from corota.mesh.shape_functions import shape_functions, shape_gradients

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.card import Card
    from corota.io.deck.deck import Deck
    from corota.mesh.data import Mesh

#: Share of the size of its host by which a node may lie outside.
OUTSIDE = 0.05
#: Weights below this are rounding.
ROUNDING = 1e-6


@dataclass(eq=False, repr=False)
class EmbeddedDraft:
    """One ``*EMBEDDED ELEMENT``: sets of elements whose nodes follow those of a host."""

    card: Card
    host: str
    targets: list[Draft] = field(default_factory=list)


@keyword(
    "EMBEDDED ELEMENT",
    "HOSTELSET EXTERIORTOLERANCE",
    "ROUNDOFFTOLERANCE ABSOLUTEEXTERIORTOLERANCE",
    place="model",
)
def embedded_element(deck: Deck, card: Card) -> None:
    """``*EMBEDDED ELEMENT[, HOST ELSET=][, EXTERIOR TOLERANCE=]``: sets of elements."""
    draft = EmbeddedDraft(card, card.value("HOSTELSET"))
    for row in card.rows():
        for index in range(len(row)):
            if row.get(index):
                draft.targets.append(Draft("elements", row, row.get(index), ()))
    if not draft.targets:
        card.error("a data line is missing: the sets of embedded elements")
    else:
        deck.later("sections", add_embedded, draft)


def add_embedded(targets: Targets, drafts: list[EmbeddedDraft]) -> None:
    """Let the nodes of embedded elements follow their hosts, by the shape functions of these."""
    deck, mesh = targets.deck, targets.mesh
    planar = np.array([c in PLANAR for c in _kinds(mesh)])
    for draft in drafts:
        card = draft.card
        for view in views_in(targets.meshes.views, deck, card.scope):
            found = [
                targets.sets.elements(view, d.target, d.row.where, card, d.row.text)
                for d in draft.targets
            ]
            cells = [np.zeros(0, np.int64), *(f.cells for f in found if f is not None)]
            inner = np.unique(np.concatenate(cells))
            host = np.setdiff1d(np.flatnonzero(planar), inner)
            if draft.host:
                named = targets.sets.elements(view, draft.host, card.at("HOSTELSET"), card)
                if named is None:
                    continue
                host = np.setdiff1d(named.cells[planar[named.cells]], inner)
            share = card.number("EXTERIORTOLERANCE", OUTSIDE, 0.0)
            free = np.setdiff1d(nodes_of_cells(mesh, inner), nodes_of_cells(mesh, host))
            _follow(targets, draft, free, host, share)


def _follow(
    targets: Targets, draft: EmbeddedDraft, nodes: Ints, host: Ints, outside: float
) -> None:
    mesh = targets.mesh
    corners = [mesh.points[_nodes(mesh, c)] for c in host.tolist()]
    low = np.array([x.min(axis=0) for x in corners]).reshape(-1, 2)
    high = np.array([x.max(axis=0) for x in corners]).reshape(-1, 2)
    margin = 2.0 * (outside + ROUNDING) * (high - low).max(axis=1, keepdims=True, initial=0.0)
    for node in nodes.tolist():
        x = mesh.points[node]
        near = np.flatnonzero(((x >= low - margin) & (x <= high + margin)).all(axis=1))
        places = [_natural(mesh, int(host[i]), x) for i in near.tolist()]
        if not places or min(p[1] for p in places) > 2.0 * outside + ROUNDING:
            draft.card.error(
                f"node {mesh.node_labels[node]} of the embedded elements is in no element of the "
                f"host{' ' + draft.host if draft.host else ''}",
                hint="move it, or enlarge the host or EXTERIOR TOLERANCE",
            )
            return
        best = min(range(len(places)), key=lambda k: places[k][1])
        weights = places[best][0]
        of = _nodes(mesh, int(host[near[best]])).tolist()
        terms = [(n, -w) for n, w in zip(of, weights.tolist(), strict=True) if abs(w) > ROUNDING]
        targets.equations([(node, 1.0), *terms], draft.card.where)


def _natural(mesh: Mesh, cell: int, x: Floats) -> tuple[Floats, float]:
    """Weights of the nodes of a cell at a point, and its natural distance outside."""
    kind = mesh.cells[mesh.locate(cell)[0]].kind
    points = mesh.points[_nodes(mesh, cell)]
    triangle = kind.startswith("tri")
    r = np.full(2, 1.0 / 3.0 if triangle else 0.0)
    for _ in range(50):
        miss = x - shape_functions(kind, r[None])[0] @ points
        step = np.linalg.solve((shape_gradients(kind, r[None])[0] @ points).T, miss)
        r = r + step
        if np.abs(step).max() < 1e-14:
            break
    away = max(-r[0], -r[1], r.sum() - 1.0) * 2.0 if triangle else np.abs(r).max() - 1.0
    return shape_functions(kind, r[None])[0], float(away) if np.isfinite(away) else np.inf


def _nodes(mesh: Mesh, cell: int) -> Ints:
    block, row = mesh.locate(cell)
    return np.asarray(mesh.cells[block].nodes[row], np.int64)


def _kinds(mesh: Mesh) -> list[str]:
    return [block.kind for block in mesh.cells for _ in range(len(block))]
