"""``*PRE-TENSION SECTION``: the mesh is cut along a surface, and a node moves the faces.

The elements of the surface get nodes of their own on it; the old ones stay with the other side, as
in CalculiX. With n the normal out of these elements and s the displacement of the node in its
first direction, u(near) - u(far) = s n at every pair of nodes: a force on the node is the tension
of the bolt, and a fixed node locks it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from corota.io.deck import numerals
from corota.io.deck.build.mesh import View, turned, views_in
from corota.io.deck.card import Card, Refused, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import Draft, PretensionDraft
from corota.io.deck.keywords import keyword
from corota.mesh.kinds import EDGES
from corota.model.constraints import Equation, LocalAxes
from corota.model.loads import Fixed, InitialTemperature, InitialVelocity, Temperature

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.build.sets import Sets
    from corota.io.deck.build.targets import Targets
    from corota.mesh.data import Mesh
    from corota.model.model import Model

_Item = TypeVar("_Item")


@keyword("PRE-TENSION SECTION", "SURFACE ELEMENT NODE", "NAME", place="model")
def pretension(deck: Deck, card: Card) -> None:
    """``*PRE-TENSION SECTION, SURFACE=, NODE=``: components of the normal."""
    if card.has("ELEMENT"):
        text = "a section in a beam or truss is not part of this version"
        hint = "shorten it by *EXPANSION and *TEMPERATURE, or cut planar elements: SURFACE="
        card.refuse(text, "ELEMENT", hint)
    surface, node = card.required("SURFACE"), card.required("NODE")
    rows = list(card.rows())
    if len(rows) > 1:
        rows[1].error(0, "one data line is expected")
    if not surface or not node:
        return
    found = PretensionDraft(card, surface, Draft("node", card.row_of("NODE"), node, (0.0,)))
    if rows and any(rows[0].fields):
        rows[0].at_most(3)
        x, y, z = rows[0].reals(("the normal x", "the normal y", "the normal z"), 0.0)
        size = math.hypot(x, y)
        if size == 0.0 or z != 0.0:
            rows[0].refuse(0, "the normal must lie in the plane: x, y, 0")
        found.normal = (x / size, y / size)
    deck.pretensions.append(found)


class PretensionBuilder:
    """Cuts the mesh of a model, and joins the faces when the rotations of nodes are known.

    Parameters
    ----------
    model : Model
        With the sets of its mesh.
    """

    def __init__(self, deck: Deck, model: Model, sets: Sets) -> None:
        self.deck, self.model, self.sets = deck, model, sets
        #: Each section with its view, its nodes on the near and on the far side, and the normal.
        self.cuts: list[tuple[PretensionDraft, View, Ints, Ints, Floats]] = []

    def cut(self) -> None:
        """Give the elements of each surface separate nodes there."""
        for draft in self.deck.pretensions:
            for view in views_in(self.sets.views, self.deck, draft.card.scope):
                name = self.sets.mesh_name(self.model.mesh.edge_sets, view, draft.surface)
                if not name:
                    draft.card.error(
                        f"no surface named {numerals.shown(draft.surface)}",
                        "SURFACE",
                        hint=nearest(draft.surface, self.model.mesh.edge_sets),
                    )
                    continue
                self._cut(draft, self.model.mesh.edge_sets[name], view)

    def _cut(self, draft: PretensionDraft, edges: Ints, view: View) -> None:
        mesh = self.model.mesh
        nodes = np.asarray(mesh.edge_set_nodes(edges), np.int64)
        near = _near_cells(mesh, edges, nodes)
        if near is None or not len(nodes):
            draft.card.error(
                f"the surface {draft.surface} does not cut the body in two",
                "SURFACE",
                hint="name the faces of the elements on one side, from one outer edge to the other",
            )
            return
        normal = np.zeros(2)
        for ends in mesh.edge_nodes(edges):
            along = mesh.points[ends[1]] - mesh.points[ends[0]]
            normal += [along[1], -along[0]]  # the element is on the left
        if draft.normal is not None:
            normal = turned(np.array(draft.normal), view.instance)
        fresh = mesh.n_nodes + np.arange(len(nodes))
        label = 10 ** len(str(int(mesh.node_labels.max())))
        mesh.points = np.concatenate([mesh.points, mesh.points[nodes]])
        mesh.node_labels = np.concatenate([mesh.node_labels, label + mesh.node_labels[nodes]])
        new = np.arange(mesh.n_nodes)
        new[nodes] = fresh
        for number, block in enumerate(mesh.cells):
            inside = near - mesh.offsets[number]
            inside = inside[(inside >= 0) & (inside < len(block))]
            block.nodes[inside] = new[block.nodes[inside]]
        self.cuts.append((draft, view, fresh, nodes, normal / np.hypot(*normal)))
        self.deck.note(
            f"{draft.card.where}: the mesh is cut along {draft.surface}: its elements have nodes "
            f"from {label} on there, and the normal keeps its direction"
        )

    def twins(self) -> tuple[Ints, Ints]:
        """Nodes that the cuts made, and those from which they were separated."""
        none = np.zeros(0, np.int64)
        near = [none, *(near for _, _, near, _, _ in self.cuts)]
        far = [none, *(far for _, _, _, far, _ in self.cuts)]
        return np.concatenate(near), np.concatenate(far)

    def share_fields(self) -> None:
        """Give both faces of each cut the temperatures and initial velocities of the place."""
        model = self.model
        model.initial_temperatures = self._shared(model.initial_temperatures)
        model.velocities = self._shared(model.velocities)
        for step in model.steps:
            step.loads = self._shared(step.loads)

    def _shared(self, items: list[_Item]) -> list[_Item]:
        """Each item on nodes, followed by itself on the nodes that were separated from these."""
        near, far = self.twins()
        found: list[_Item] = []
        for item in items:
            found.append(item)
            if isinstance(item, (Temperature, InitialTemperature, InitialVelocity)):
                own = near[np.isin(far, self._nodes(item.nodes))]
                if len(own):
                    found.append(replace(item, nodes=own))
        return found

    def _nodes(self, nodes: str | Ints) -> Ints:
        # Without a name they are all nodes, those of the cut included.
        every = isinstance(nodes, str) and not nodes
        return np.zeros(0, np.int64) if every else self.model.mesh.node_indices(nodes)

    def _angles(self) -> dict[int, float]:
        """Angles of the local axes of nodes at the cuts, which both faces get."""
        near, far = self.twins()
        angles: dict[int, float] = {}
        for axes in list(self.model.axes):
            chosen = np.isin(far, self._nodes(axes.nodes))
            for a, b in zip(near[chosen].tolist(), far[chosen].tolist(), strict=True):
                angle = axes.angle
                if axes.center is not None:
                    arm = self.model.mesh.points[b] - np.asarray(axes.center)
                    angle += math.atan2(arm[1], arm[0])
                angles[b] = angle
                self.model.axes.append(LocalAxes(np.array([a]), angle, None, axes.where))
        return angles

    def join(self, targets: Targets) -> None:
        """Tie the faces of each cut to the node of its section."""
        angles, rotating = self._angles(), targets.rotating
        for draft, view, near, far, normal in self.cuts:
            try:
                with targets.inside(view):
                    node = targets.one_node(draft.node)
            except Refused:
                continue
            where = draft.card.where
            for a, b in zip(near.tolist(), far.tolist(), strict=True):
                c, s = math.cos(angles.get(b, 0.0)), math.sin(angles.get(b, 0.0))
                own = (c * normal[0] + s * normal[1], c * normal[1] - s * normal[0])
                for dof in (0, 1):
                    terms = [(a, dof, 1.0), (b, dof, -1.0)]
                    if own[dof] != 0.0:
                        terms.append((node, 0, -float(own[dof])))
                    self.model.constraints.append(Equation(terms, 0.0, where))
                if rotating[a] and rotating[b]:
                    terms = [(a, 2, 1.0), (b, 2, -1.0)]
                    self.model.constraints.append(Equation(terms, 0.0, where))
            # The node has one direction only.
            self.model.supports.append(Fixed(np.array([node]), 1, 0.0, "", where))


def _near_cells(mesh: Mesh, edges: Ints, nodes: Ints) -> Ints | None:
    """Cells at the cut on the side of its elements; ``None`` where that is not one side.

    Cells at a node of the cut are on one side if edges that start there and are not cut join them.
    """
    on_cut = np.zeros(mesh.n_nodes, bool)
    on_cut[nodes] = True
    cut = {frozenset(ends[:2].tolist()) for ends in mesh.edge_nodes(edges)}
    group: dict[int, int] = {}
    shared: dict[frozenset[int], int] = {}
    owners = set(edges[:, 0].tolist())
    opposite: set[int] = set()

    def root(cell: int) -> int:
        while group[cell] != cell:
            cell = group[cell]
        return cell

    for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
        for row in np.flatnonzero(on_cut[block.nodes].any(axis=1)).tolist():
            cell = int(offset) + row
            group[cell] = cell
            for side in EDGES[block.kind]:
                ends = frozenset(block.nodes[row, list(side[:2])].tolist())
                if ends in cut:
                    if cell not in owners:
                        opposite.add(cell)
                elif any(on_cut[n] for n in ends):
                    if ends in shared:
                        group[root(cell)] = root(shared[ends])
                    shared[ends] = cell
    sides = {root(cell) for cell in owners}
    if sides & {root(cell) for cell in opposite} or not opposite:
        return None
    return np.array(sorted(cell for cell in group if root(cell) in sides), np.int64)
