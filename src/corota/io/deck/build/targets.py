"""What the drafts of a deck name: nodes, cells, surfaces and amplitudes of the model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import contextmanager
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.io.deck import numerals
from corota.io.deck.build.mesh import MeshBuilder, View, view_of, views_in
from corota.io.deck.build.sets import Elements, Sets
from corota.io.deck.card import Refused, key, nearest
from corota.io.deck.deck import Deck
from corota.model.constraints import Equation, local_axes
from corota.model.model import Model

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from corota.arrays import Floats, Ints
    from corota.errors import Location
    from corota.io.deck.drafts import Draft, TieDraft


#: Share of the largest coefficient of an equation below which one is none.
ROUNDING = 1e-12


class Targets:
    """Looks up names and numbers in the mesh that a deck made.

    Attributes
    ----------
    at : View
        Part or assembly whose names come first.
    rotating : ndarray of bool, shape (n_nodes,)
        Nodes that have a rotation.
    twins : tuple of ndarray of int
        Nodes that cuts of the mesh made, and those from which they were separated.
    """

    def __init__(self, deck: Deck, meshes: MeshBuilder, model: Model) -> None:
        self.deck, self.meshes, self.model, self.mesh = deck, meshes, model, model.mesh
        self.sets = Sets(meshes, self.mesh)
        self.at = meshes.views[0]
        self.rotating = np.zeros(self.mesh.n_nodes, bool)
        #: Factor of the mass of each cell by mass scaling, which leaves its weight.
        self.mass_factor: Floats = np.ones(self.mesh.n_cells)
        #: Keys of the names of node sets that were looked up.
        self.used: set[str] = set()
        self.twins: tuple[Ints, Ints] = (np.zeros(0, np.int64), np.zeros(0, np.int64))

    @contextmanager
    def inside(self, view: View) -> Iterator[None]:
        """Look for names in one view first."""
        before, self.at = self.at, view
        try:
            yield
        finally:
            self.at = before

    @cached_property
    def axes(self) -> dict[int, Floats]:
        """Axes (columns) of the nodes that have their own."""
        return local_axes(self.mesh, self.model.axes)

    def equation(self, terms: Sequence[tuple[int, int, float]], where: Location | None) -> None:
        """Add an equation of dofs along the global axes; one of its first node is eliminated."""
        total: dict[tuple[int, int], float] = {}
        for node, dof, factor in terms:
            own = self.axes.get(node)
            parts = [(dof, 1.0)] if own is None or dof == 2 else [*enumerate(own[dof].tolist())]
            for place, share in parts:
                total[node, place] = total.get((node, place), 0.0) + share * factor
        small = ROUNDING * max(map(abs, total.values()))
        rows = [(node, dof, c) for (node, dof), c in total.items() if abs(c) > small]
        rows.sort(key=lambda row: -abs(row[2]) if row[0] == terms[0][0] and row[1] < 2 else 0.0)
        self.model.constraints.append(Equation(rows, 0.0, where))

    def equations(self, terms: Sequence[tuple[int, float]], where: Location | None) -> None:
        """Let a sum of displacements, factor times vector, vanish; the first is eliminated."""
        for way in self.axes.get(terms[0][0], np.eye(2)).T.tolist():
            self.equation([(n, d, c * way[d]) for n, c in terms for d in (0, 1)], where)

    def nodes(self, draft: Draft) -> str | Ints | None:
        """Name in the mesh, or indices, of a target of supports and nodal forces."""
        views = self._views(draft)
        if len(views) == 1:
            return self._nodes(draft, views[0])
        found = [self._nodes(draft, view) for view in views]
        known = [self.mesh.node_indices(nodes) for nodes in found if nodes is not None]
        return np.concatenate(known) if known and len(known) == len(found) else None

    def _views(self, draft: Draft) -> list[View]:
        """Where a draft looks for names: in the instances of its part, if it stands in one."""
        views = self.meshes.views
        if self.at is not views[0]:
            return [self.at]
        return views_in(views, self.deck, draft.card.scope)

    def _nodes(self, draft: Draft, at: View) -> str | Ints | None:
        target, row = draft.target, draft.row
        self.used.add(key(target))
        found: tuple[View, str] | None
        if numerals.is_integer(target):
            found = (self.numbering(at, target, "nodes"), target)
        else:
            full = self.sets.full_name(self.sets.nsets, at, target)
            if full:
                if not len(self.mesh.node_sets.get(self.sets.spelled(self.sets.nsets, full), ())):
                    row.error(0, f"node set {target} is empty")
                    return None
                return self.sets.spelled(self.sets.nsets, full)
            name = self.sets.mesh_name(self.mesh.node_sets, at, target)
            if name:
                return name
            found = view_of(self.meshes.views, target)
        if found and numerals.is_label(found[1]):
            node = found[0].nodes(np.array([int(found[1])]))
            if node[0] >= 0:
                return node
            row.error(0, f"node {target} is not defined")
            return None
        row.error(
            0, f"no node set named {numerals.shown(target)}", nearest(target, self.mesh.node_sets)
        )
        return None

    def numbering(self, view: View, number: str, what: Literal["nodes", "cells"]) -> View:
        """View whose numbers are meant: the assembly's own, else those of the only instance."""
        views = self.meshes.views
        if view is not views[0] or len(views) != 2 or not numerals.is_label(number):
            return view
        own = view.nodes if what == "nodes" else view.cells
        return view if own(np.array([int(number)]))[0] >= 0 else views[1]

    def amplitude(self, draft: Draft) -> str | None:
        """Name of the amplitude of a draft, empty where it has none; ``None`` after an error."""
        if not draft.amplitude:
            return ""
        found = self.deck.amplitudes.get(key(draft.amplitude))
        if found is None:
            hint = nearest(draft.amplitude, [a.name for a in self.deck.amplitudes.values()])
            draft.card.error(f"no amplitude named {draft.amplitude!r}", "AMPLITUDE", hint)
            return None
        if key(draft.amplitude) in self.deck.absolute:
            if draft.kind not in ("fixed", "force", "pressure", "surface pressure"):
                draft.card.error(
                    f"amplitude {draft.amplitude} has VALUE=ABSOLUTE, which fits one number: "
                    "supports, forces and pressures",
                    "AMPLITUDE",
                    hint="give the load its size and the amplitude VALUE=RELATIVE",
                )
                return None
            draft.value = (1.0, *draft.value[1:])
        return found.name

    def cells_of(self, draft: Draft) -> Elements | None:
        """Cells that a draft names."""
        views, row, found = self._views(draft), draft.row, []
        for view in views:
            at = view
            if numerals.is_integer(draft.target):
                at = self.numbering(view, draft.target, "cells")
            found.append(self.sets.elements(at, draft.target, row.at(0), draft.card, row.text))
        known = [one for one in found if one is not None]
        if len(known) < len(found) or not known:
            return None
        names = ("cells", "lines", "attached")
        return Elements(*(np.concatenate([getattr(one, n) for one in known]) for n in names))

    def tied(self, tie: TieDraft) -> Ints | None:
        """Nodes of the elements that a constraint names."""
        return self.sets.nodes_of_elements(self.at, tie.elset, tie.card.at("ELSET"), tie.card)

    def surface_name(self, table: Mapping[str, object], name: str) -> str:
        """Name in the mesh of a surface, empty where there is none."""
        return self.sets.mesh_name(table, self.at, name)

    def indices(self, draft: Draft) -> Ints:
        """Nodes that a draft names; as :meth:`nodes`.

        Raises
        ------
        Refused
            After an error.
        """
        found = self.nodes(draft)
        if found is None:
            raise Refused
        return self.mesh.node_indices(found)

    def all_indices(self, drafts: Sequence[Draft]) -> list[Ints]:
        """Nodes of each of several drafts; as :meth:`indices`, after the errors of all."""
        found = [nodes for draft in drafts if (nodes := self.nodes(draft)) is not None]
        if len(found) < len(drafts):
            raise Refused
        return [self.mesh.node_indices(nodes) for nodes in found]

    def one_node(self, draft: Draft) -> int:
        """Index of the one node that a draft names; as :meth:`indices`."""
        nodes = self.indices(draft)
        if len(nodes) != 1:
            draft.row.refuse(0, f"one node is expected; the set {draft.target} has {len(nodes)}")
        return int(nodes[0])
