"""From the constraints of a deck to those of a model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, cast

import numpy as np

from corota.errors import InputError
from corota.io.deck.build.mesh import placed
from corota.io.deck.card import Refused, key, nearest
from corota.model.constraints import Coupling, Equation, LocalAxes, StraightLine

if TYPE_CHECKING:
    from typing import Literal

    from corota.arrays import Floats, Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.drafts import TieDraft


def build_tie(targets: Targets, tie: TieDraft) -> None:
    """Add one of the deck's constraints to the model; reference nodes get a rotation."""
    if not tie.ready:
        text = "*KINEMATIC or *DISTRIBUTING is missing after this card"
        targets.deck.error(tie.card, tie.where, text)
        return
    try:
        with suppress(Refused):
            _build(targets, tie)
    except InputError as error:
        targets.deck.error(tie.card, tie.where, error.message)


def _build(targets: Targets, tie: TieDraft) -> None:
    model = targets.model
    if tie.kind == "axes":
        assert tie.target is not None
        nodes = targets.nodes(tie.target)
        if nodes is not None:
            angle, center, placing = tie.angle, tie.center, targets.at.instance
            if placing is not None and center is None:
                angle += placing.angle
            elif center is not None:
                x, y = placed(np.array(center), placing).tolist()
                center = (x, y)
            model.axes.append(LocalAxes(nodes, angle, center, tie.where))
        return
    if tie.kind in OTHERS:
        OTHERS[tie.kind](targets, tie)
        return
    if tie.members:
        _weighted(targets, tie)
        return
    reference = targets.one_node(tie.terms[0])
    weights: Floats | None = None
    chosen: str | Ints | None
    if tie.surface:
        chosen, weights = _surface(targets, tie)
        near = np.hypot(*(model.mesh.points[chosen] - model.mesh.points[reference]).T)
        inside = near <= tie.radius * (1.0 + 1e-9)
        if not inside.any():
            raise InputError(f"no node of {tie.surface} is within the radius", tie.where)
        chosen = chosen[inside]
        weights = weights[inside] if weights is not None else None
    elif tie.elset:
        chosen = targets.tied(tie)
    else:
        assert tie.target is not None
        chosen = targets.nodes(tie.target)
    if chosen is None:
        return
    if tie.kind == "kinematic":
        weights = None
    kind = cast("Literal['kinematic', 'distributing']", tie.kind)
    title = "rigid body" if not tie.surface else ""
    model.constraints.append(Coupling(chosen, reference, kind, tie.dofs, weights, title, tie.where))
    if kind == "distributing" and 2 not in tie.dofs and not targets.rotating[reference]:
        targets.deck.without_moment.add(reference)
    targets.rotating[reference] = True


def _equations(targets: Targets, tie: TieDraft) -> None:
    """An equation; between sets as many, node by node in the order of their numbers.

    Sets with ``UNSORTED`` keep their order, and a single node is in all equations, as in Abaqus.
    """
    deck, model = targets.deck, targets.model
    columns: list[Ints] = []
    for term in tie.terms:
        nodes = targets.indices(term)
        if key(term.target) not in deck.unsorted:
            nodes = nodes[np.argsort(model.mesh.node_labels[nodes])]
        columns.append(nodes)
    count = max(len(nodes) for nodes in columns)
    for term, nodes in zip(tie.terms, columns, strict=True):
        if len(nodes) not in (1, count):
            term.row.refuse(
                0,
                f"the sets of an equation have as many nodes or one; {term.target} has "
                f"{len(nodes)}, another {count}",
            )
    for rows in zip(*(np.broadcast_to(nodes, count) for nodes in columns), strict=True):
        terms = [(int(n), t.index, t.value[0]) for n, t in zip(rows, tie.terms, strict=True)]
        model.constraints.append(Equation(terms, 0.0, tie.where))


def _weighted(targets: Targets, tie: TieDraft) -> None:
    """Distributing coupling of listed nodes; its element names the reference node."""
    deck, model = targets.deck, targets.model
    draft = deck.couplers.get(key(tie.elset))
    if draft is None:
        text = f"no set named {tie.elset!r} of DCOUP2D or DCOUP3D elements"
        tie.card.refuse(text, "ELSET", nearest(tie.elset, deck.couplers))
    items = [draft, *(item for item, _ in tie.members)]
    _, *members = targets.all_indices(items)
    reference = targets.one_node(draft)
    share = np.zeros(model.mesh.n_nodes)
    for nodes, (_, weight) in zip(members, tie.members, strict=True):
        share[nodes] += weight
    chosen = np.flatnonzero(share)
    if deck.dialect == "calculix" and key(draft.card.value("TYPE")) == "DCOUP3D":
        deck.note(
            f"{tie.where}: the reference node follows the mean displacement, as in CalculiX: its "
            "distance from the nodes gives no moment; *COUPLING with *DISTRIBUTING does"
        )
        # The first term of an equation is the dof that it determines: none that a support moves.
        moved = set()
        for item in [*deck.supports, *(item for step in deck.steps for item in step.supports)]:
            held = targets.nodes(item)
            if held is not None and reference in model.mesh.node_indices(held):
                moved.add(item.index)
        part = -share[chosen] / share.sum()
        for dof in (0, 1):
            rows = [(int(n), dof, float(w)) for n, w in zip(chosen, part, strict=True)]
            rows.insert(1 if dof in moved else 0, (reference, dof, 1.0))
            targets.equation(rows, tie.where)
        return
    coupling = Coupling(chosen, reference, "distributing", tie.dofs, share[chosen], "", tie.where)
    model.constraints.append(coupling)
    targets.rotating[reference] = True


def _straight(targets: Targets, tie: TieDraft) -> None:
    """Nodes on the line through the first two."""
    nodes = np.concatenate([np.zeros(0, np.int64), *targets.all_indices(tie.terms)])
    if len(nodes) < 3:
        raise InputError("at least three nodes are expected, beginning with the two of the line")
    ends = int(nodes[0]), int(nodes[1])
    targets.model.constraints.append(StraightLine(nodes[2:], *ends, tie.where))


def _between(targets: Targets, tie: TieDraft) -> None:
    """Dofs of a node by linear interpolation between two others, from its place between them."""
    model = targets.model
    targets.all_indices(tie.terms)
    found = [targets.one_node(term) for term in tie.terms]
    if len(found) != 3:
        raise InputError(f"three nodes are expected, not {len(found)}", tie.where)
    node, first, second = found
    x = model.mesh.points[found]
    way = x[2] - x[1]
    length = float(way @ way)
    if length == 0.0:
        raise InputError("the two nodes to interpolate between are at one place", tie.where)
    share = float((x[0] - x[1]) @ way) / length
    terms = [(node, 1.0), (first, share - 1.0), (second, -share)]
    targets.equations(terms, tie.where)
    if targets.rotating[found].all():
        targets.equation([(n, 2, c) for n, c in terms], tie.where)


def _same(targets: Targets, tie: TieDraft) -> None:
    """Equal displacements, and rotations where both have one, of pairs of nodes."""
    rotating = targets.rotating
    assert tie.target is not None
    first, second = (targets.indices(draft) for draft in (tie.target, tie.terms[0]))
    if len(second) == 1:
        second = np.broadcast_to(second, len(first))
    if len(first) != len(second):
        raise InputError(f"{len(first)} nodes cannot be paired with {len(second)} nodes", tie.where)
    for a, b in zip(first.tolist(), second.tolist(), strict=True):
        if a != b:
            targets.equations([(a, 1.0), (b, -1.0)], tie.where)
            if 2 in tie.dofs and rotating[a] and rotating[b]:
                targets.equation([(a, 2, 1.0), (b, 2, -1.0)], tie.where)


def _surface(targets: Targets, tie: TieDraft) -> tuple[Ints, Floats | None]:
    """Nodes of a surface, and their shares of its length."""
    mesh = targets.mesh
    name = targets.surface_name(mesh.edge_sets, tie.surface)
    if name:
        share = np.zeros(mesh.n_nodes)
        for ends in mesh.edge_nodes(mesh.edge_sets[name]):
            length = float(np.hypot(*(mesh.points[ends[1]] - mesh.points[ends[0]])))
            if len(ends) == 2:
                share[ends] += 0.5 * length
            else:
                share[ends] += np.array([1.0, 1.0, 4.0]) / 6.0 * length
        nodes = np.flatnonzero(share)
        return nodes, share[nodes]
    name = targets.surface_name(mesh.node_sets, tie.surface)
    if not name:
        hint = nearest(tie.surface, mesh.edge_sets)
        tie.card.refuse(f"no surface named {tie.surface}", "SURFACE", hint)
    return np.asarray(mesh.node_sets[name], np.int64), None


#: Constraints that are not couplings, by kind.
OTHERS = {
    "straight": _straight,
    "between": _between,
    "same": _same,
    "equation": _equations,
}
