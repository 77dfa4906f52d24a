"""From the constraints of a deck to those of a model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from corota.errors import InputError
from corota.io.deck.card import key, nearest
from corota.model.constraints import Coupling, Equation, LocalAxes, StraightLine

if TYPE_CHECKING:
    from typing import Literal

    from corota.arrays import Floats, Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.drafts import Draft, TieDraft
    from corota.model.model import Model


def build_tie(targets: Targets, tie: TieDraft) -> None:
    """Add one of the deck's constraints to the model; reference nodes get a rotation."""
    if not tie.ready:
        text = "*KINEMATIC or *DISTRIBUTING is missing after this card"
        targets.deck.error(tie.card, tie.where, text)
        return
    try:
        _build(targets, tie)
    except InputError as error:
        targets.deck.error(tie.card, tie.where, error.message)


def _build(targets: Targets, tie: TieDraft) -> None:
    model = targets.model
    if tie.kind == "axes":
        assert tie.target is not None
        nodes = targets.nodes(tie.target)
        if nodes is not None:
            model.axes.append(LocalAxes(nodes, tie.angle, tie.center, tie.where))
        return
    if tie.kind in OTHERS:
        OTHERS[tie.kind](targets, tie)
        return
    if tie.members:
        _weighted(targets, tie)
        return
    single = [single_node(targets, term) for term in tie.terms]
    if None in single:
        return
    numbers = cast("list[int]", single)
    reference = numbers[0]
    weights: Floats | None = None
    chosen: str | Ints | None
    if tie.surface:
        chosen, weights = _surface(targets, tie)
        if chosen is not None:
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
    labels = model.mesh.node_labels
    columns: list[Ints] = []
    for term in tie.terms:
        found = targets.nodes(term)
        if found is None:
            return
        nodes = model.mesh.node_indices(found)
        if key(term.target) not in deck.unsorted:
            nodes = nodes[np.argsort(labels[nodes])]
        columns.append(nodes)
    count = max(len(nodes) for nodes in columns)
    for term, nodes in zip(tie.terms, columns, strict=True):
        if len(nodes) not in (1, count):
            term.row.error(
                0,
                f"the sets of an equation have as many nodes or one; {term.target} has "
                f"{len(nodes)}, another {count}",
            )
            return
    for rows in zip(*(np.broadcast_to(nodes, count) for nodes in columns), strict=True):
        terms = [(int(n), t.index, t.value[0]) for n, t in zip(rows, tie.terms, strict=True)]
        model.constraints.append(Equation(terms, 0.0, tie.where))


def _weighted(targets: Targets, tie: TieDraft) -> None:
    """Distributing coupling of listed nodes; its element names the reference node."""
    deck, model = targets.deck, targets.model
    draft = deck.couplers.get(key(tie.elset))
    if draft is None:
        tie.card.error(
            f"no set named {tie.elset!r} of DCOUP2D or DCOUP3D elements",
            "ELSET",
            hint=nearest(tie.elset, deck.couplers),
        )
        return
    reference = single_node(targets, draft)
    found = [(targets.nodes(item), weight) for item, weight in tie.members]
    if reference is None or any(nodes is None for nodes, _ in found):
        return
    share = np.zeros(model.mesh.n_nodes)
    for nodes, weight in found:
        assert nodes is not None
        share[model.mesh.node_indices(nodes)] += weight
    chosen = np.flatnonzero(share)
    if deck.dialect == "calculix" and key(draft.card.value("TYPE")) == "DCOUP3D":
        deck.note(
            f"{tie.where}: the reference node follows the mean displacement, as in CalculiX: its "
            "distance from the nodes gives no moment; *COUPLING with *DISTRIBUTING does"
        )
        # The first term of an equation is the dof that it determines: none that a support moves.
        every = [*deck.supports, *(item for step in deck.steps for item in step.supports)]
        moved = {item.index for item in every if _names(model, targets.nodes(item), reference)}
        part = -share[chosen] / share.sum()
        for dof in (0, 1):
            rows = [(int(n), dof, float(w)) for n, w in zip(chosen, part, strict=True)]
            rows.insert(1 if dof in moved else 0, (reference, dof, 1.0))
            model.constraints.append(Equation(rows, 0.0, tie.where))
        return
    coupling = Coupling(chosen, reference, "distributing", tie.dofs, share[chosen], "", tie.where)
    model.constraints.append(coupling)
    targets.rotating[reference] = True


def _names(model: Model, nodes: str | Ints | None, node: int) -> bool:
    """Whether a set or nodes hold a node."""
    return nodes is not None and node in (model.mesh.node_indices(nodes))


def _straight(targets: Targets, tie: TieDraft) -> None:
    """Nodes on the line through the first two."""
    model = targets.model
    found = [targets.nodes(term) for term in tie.terms]
    if any(nodes is None for nodes in found):
        return
    parts = [model.mesh.node_indices(n) for n in found if n is not None]
    nodes = np.concatenate([np.zeros(0, np.int64), *parts])
    if len(nodes) < 3:
        text = "at least three nodes are expected, beginning with the two of the line"
        targets.deck.error(tie.card, tie.where, text)
        return
    ends = int(nodes[0]), int(nodes[1])
    model.constraints.append(StraightLine(nodes[2:], *ends, tie.where))


def _between(targets: Targets, tie: TieDraft) -> None:
    """Dofs of a node by linear interpolation between two others, from its place between them."""
    model = targets.model
    found = [single_node(targets, term) for term in tie.terms]
    if None in found:
        return
    if len(found) != 3:
        raise InputError(f"three nodes are expected, not {len(found)}", tie.where)
    node, first, second = cast("list[int]", found)
    x = model.mesh.points[[node, first, second]]
    way = x[2] - x[1]
    length = float(way @ way)
    if length == 0.0:
        raise InputError("the two nodes to interpolate between are at one place", tie.where)
    share = float((x[0] - x[1]) @ way) / length
    turns = targets.rotating[[node, first, second]].all()
    for dof in range(3 if turns else 2):
        terms = [(node, dof, 1.0), (first, dof, share - 1.0), (second, dof, -share)]
        model.constraints.append(Equation(terms, 0.0, tie.where))


def _same(targets: Targets, tie: TieDraft) -> None:
    """Equal displacements, and rotations where both have one, of pairs of nodes."""
    model, rotating = targets.model, targets.rotating
    assert tie.target is not None
    pairs = []
    for draft in (tie.target, tie.terms[0]):
        found = targets.nodes(draft)
        if found is None:
            return
        pairs.append(model.mesh.node_indices(found))
    first, second = pairs
    if len(second) == 1:
        second = np.broadcast_to(second, len(first))
    if len(first) != len(second):
        raise InputError(f"{len(first)} nodes cannot be paired with {len(second)} nodes", tie.where)
    for a, b in zip(first.tolist(), second.tolist(), strict=True):
        for dof in tie.dofs:
            if a != b and (dof < 2 or (rotating[a] and rotating[b])):
                terms = [(a, dof, 1.0), (b, dof, -1.0)]
                model.constraints.append(Equation(terms, 0.0, tie.where))


def single_node(targets: Targets, draft: Draft) -> int | None:
    """Index of the one node that a draft names, by number or set; ``None`` after an error."""
    found = targets.nodes(draft)
    if found is None:
        return None
    nodes = targets.mesh.node_indices(found)
    if len(nodes) != 1:
        text = f"one node is expected; the set {draft.target} has {len(nodes)}"
        draft.row.error(0, text)
        return None
    return int(nodes[0])


def _surface(targets: Targets, tie: TieDraft) -> tuple[Ints | None, Floats | None]:
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
    if name:
        return np.asarray(mesh.node_sets[name], np.int64), None
    hint = nearest(tie.surface, mesh.edge_sets)
    where = tie.card.at("SURFACE")
    targets.deck.error(tie.card, where, f"no surface named {tie.surface}", hint=hint)
    return None, None


#: Constraints that are not couplings, by kind.
OTHERS = {
    "straight": _straight,
    "between": _between,
    "same": _same,
    "equation": _equations,
}
