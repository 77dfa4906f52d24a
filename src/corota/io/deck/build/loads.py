"""Supports and loads of a model from those of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Literal, NoReturn, cast

import numpy as np

from corota.arrays import Ints, distinct
from corota.io.deck import numerals
from corota.io.deck.card import Refused, both, key, nearest
from corota.io.deck.drafts import SurfaceRow
from corota.io.deck.elements import SHELLS
from corota.lazy import lazy
from corota.mesh.parts import cells_of
from corota.model.loads import BodyForce, EdgeLoad, Fixed, Load, NodalForce, Temperature

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from corota.io.deck.build.targets import Targets
    from corota.io.deck.drafts import Draft, StepDraft

base_motion = lazy("corota.io.deck.build.base_motion:base_motion")

#: Beams whose second direction Abaqus defines to lie in the plane, to the left of their first.
PLANAR_BEAMS = {"B21", "B22", "B23", "PIPE21"}


class LoadBuilder:
    """Makes supports and loads."""

    def __init__(self, targets: Targets) -> None:
        self.targets, self.deck, self.sets = targets, targets.deck, targets.sets
        self.meshes, self.model, self.mesh = targets.meshes, targets.model, targets.mesh

    def supports(self, drafts: list[Draft], step: StepDraft | None = None) -> list[Fixed]:
        found: list[Fixed] = []
        for draft in drafts:
            with suppress(Refused):
                found += self._support(draft, step)
        return found

    def _support(self, draft: Draft, step: StepDraft | None) -> list[Fixed]:
        nodes, name = self._acting(draft)
        if draft.kind == "nothing":
            return []
        if draft.order and step is not None:
            name = base_motion(self.deck, self.model, draft, name, step)
        if draft.index == 2:
            if not self._rotating(nodes).any():
                if not draft.silent and draft.value[0] != 0.0:
                    self._no_rotation(draft)
                return []
            if not isinstance(nodes, str):
                nodes = nodes[self.targets.rotating[nodes]]
        if draft.order == 2 and any(
            np.isin(self.mesh.node_indices(v.nodes), self.mesh.node_indices(nodes)).any()
            for v in self.model.velocities
        ):
            text = "nodes with a prescribed acceleration start from rest; these have an initial"
            draft.row.refuse(0, f"{text} velocity", "give TYPE=VELOCITY")
        value, where = draft.value[0], draft.row.where
        return [Fixed(nodes, draft.index, value, name, where, keep=draft.keep)]

    def _acting(self, draft: Draft) -> tuple[str | Ints, str]:
        """Nodes and amplitude of a draft."""
        nodes, amplitude = self.targets.nodes(draft), self.targets.amplitude(draft)
        if nodes is None or amplitude is None:
            raise Refused
        return nodes, amplitude

    def _rotating(self, nodes: str | Ints) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        indices = self.mesh.node_indices(nodes)
        return cast("np.ndarray[tuple[int], np.dtype[np.bool_]]", self.targets.rotating[indices])

    def _no_rotation(self, draft: Draft) -> NoReturn:
        draft.row.refuse(
            1,
            f"{draft.target}: its elements have no rotation (dof 6)",
            "use elements Q4D or OPT, or map them: --element CPS4=Q4D",
        )

    def loads(self, draft: Draft) -> list[Load]:
        with suppress(Refused):
            return list(self._loads(draft))
        return []

    def _loads(self, draft: Draft) -> Iterable[Load]:
        if draft.kind == "surface shear":
            return self._shear(draft)
        if draft.kind in ("volume", "line"):
            return [self._volume_force(draft)]
        if draft.kind == "pressure" and draft.index == 1 and self.deck.dialect == "abaqus":
            beams = self._planar_beams(draft)
            if beams is not None:
                return self._across(draft, beams)
        load = self._load(draft)
        if isinstance(load, BodyForce) and key(draft.row.get(1)) == "CENT":
            return self._by_density(draft, load)
        if isinstance(load, BodyForce) and (self.targets.mass_factor != 1.0).any():
            return self._weights(draft, load)
        return [load]

    def _planar_beams(self, draft: Draft) -> Ints | None:
        """Cells that a load names, if all are beams of the plane in Abaqus; else None."""
        found = self.targets.cells_of(draft)
        if found is None or not len(found.cells):
            return None
        types = {str(self.meshes.types[i]) for i in self.meshes.cell_type[found.cells]}
        return found.cells if types <= PLANAR_BEAMS else None

    def _across(self, draft: Draft, cells: Ints) -> Iterator[Load]:
        """``P2`` of Abaqus: force per length across beams, to the left of their direction."""
        _, amplitude = both(draft, self.targets.amplitude(draft))
        if any(step.nlgeom for step in self.deck.steps):
            draft.row.refuse(
                1,
                "P2 of beams turns with them under NLGEOM, which is not part of this version",
                "give PX and PY, forces per length in global directions",
            )
        places = [self.mesh.locate(int(cell)) for cell in cells]
        ends = np.array([self.mesh.cells[block].nodes[row][:2] for block, row in places])
        along = self.mesh.points[ends[:, 1]] - self.mesh.points[ends[:, 0]]
        left = np.stack([-along[:, 1], along[:, 0]], axis=1)
        left /= np.hypot(left[:, :1], left[:, 1:])
        ways, which = np.unique(left.round(12), axis=0, return_inverse=True)
        for number, (x, y) in enumerate(ways.tolist()):
            mine = cells[which.reshape(-1) == number]
            value = (draft.value[0] * x, draft.value[0] * y)
            where = draft.row.where
            yield BodyForce(mine, "line", value, amplitude, where, direction=(x, y))

    def _by_density(self, draft: Draft, load: BodyForce) -> Iterator[Load]:
        """``CENT``: density times the square of the angular velocity, by the density of cells."""
        cells = cells_of(self.mesh, load.cells)
        density = np.zeros(self.mesh.n_cells)
        for section in self.model.sections:
            density[cells_of(self.mesh, section.cells)] = section.material.rho
        density *= self.targets.mass_factor
        if (density[cells] <= 0.0).any():
            label = self.mesh.cell_labels[cells[np.argmin(density[cells])]]
            text = f"element {label} has no density, which CENT contains"
            draft.row.refuse(1, text, "give *DENSITY to its material")
        square, *center = load.value
        for value in distinct(density[cells]).tolist():
            mine = cells[density[cells] == value]
            size, none = (square / value, *center), np.zeros(0, np.int64)
            yield replace(load, cells=mine, value=size, masses=none)

    def _weights(self, draft: Draft, load: BodyForce) -> Iterator[Load]:
        """Gravity of cells with a scaled mass: their weight is that of the mass before."""
        if load.kind != "gravity":
            draft.row.refuse(
                1,
                "a centrifugal load of elements with a scaled mass is not part of this version",
                "scale the density itself, or leave the mass scaling out",
            )
        cells = cells_of(self.mesh, load.cells)
        factor, masses = self.targets.mass_factor[cells], load.masses
        for value in distinct(factor).tolist():
            mine = cells[factor == value]
            size = tuple(v / value for v in load.value)
            yield replace(load, cells=mine, value=size, masses=masses)
            masses = np.zeros(0, np.int64)

    def _shear(self, draft: Draft) -> Iterator[Load]:
        """Shear along the edges of a surface, towards a direction."""
        found, amplitude = self._edges_of(draft)
        edges = self.mesh.edge_sets[found] if isinstance(found, str) else found
        ends = np.array([nodes[:2] for nodes in self.mesh.edge_nodes(edges)])
        along = self.mesh.points[ends[:, 1]] - self.mesh.points[ends[:, 0]]
        along = np.asarray(along / np.hypot(along[:, :1], along[:, 1:]), np.float64)
        size = math.hypot(*draft.value)
        if size == 0.0:
            yield EdgeLoad(edges, "shear", (0.0,), amplitude, where=draft.row.where)
            return
        share = along @ (np.array(draft.value) / size)
        if (np.abs(share) < 1e-6).any():
            draft.row.refuse(3, "the direction of the shear is normal to an edge")
        for sign in (-1.0, 1.0):
            mine = edges[np.sign(share) == sign]
            if len(mine):
                yield EdgeLoad(mine, "shear", (sign * size,), amplitude, where=draft.row.where)

    def _load(self, draft: Draft) -> Load:
        where = draft.row.where
        if draft.kind == "force":
            nodes, name = self._acting(draft)
            if draft.index == 2 and not self._rotating(nodes).all():
                self._no_rotation(draft)
            at = self.mesh.node_indices(nodes)
            if draft.index == 2 and not self.deck.without_moment.isdisjoint(at.tolist()):
                text = f"{draft.target}: its *DISTRIBUTING leaves out the rotation (dof 6)"
                draft.row.refuse(1, text, "couple dofs 1 to 6 there")
            force = NodalForce(nodes, draft.index, draft.value[0], name, where)
            force.follower = draft.card.has("FOLLOWER") and self._turns(draft, nodes)
            return force
        if draft.kind == "temperature":
            nodes, name = self._acting(draft)
            return Temperature(nodes, draft.value[0], name, where)
        if draft.kind == "penetrating pressure":
            return self._penetrating(draft)
        if draft.kind.startswith("surface "):
            edges, name = self._edges_of(draft)
            kind = draft.kind.removeprefix("surface ")
            return EdgeLoad(
                edges,
                cast("Literal['pressure', 'traction', 'following traction']", kind),
                draft.value,
                name,
                where=where,
            )
        return self._cell_load(draft)

    def _penetrating(self, draft: Draft) -> Load:
        """A fluid that passes along the slave surface of a contact pair."""
        (start, name), card = self._acting(draft), draft.card
        slave, master = (
            self.sets.mesh_name(self.mesh.edge_sets, self.targets.at, card.value(side))
            for side in ("SLAVE", "MASTER")
        )
        if not slave:
            text = f"no surface of elements named {numerals.shown(card.value('SLAVE'))}"
            card.refuse(text, "SLAVE", nearest(card.value("SLAVE"), self.mesh.edge_sets))
        where, kind = draft.row.where, cast("Literal['penetrating pressure']", draft.kind)
        return EdgeLoad(
            slave, kind, draft.value, name, where=where, opposite=master or None, start=start
        )

    def _turns(self, draft: Draft, nodes: str | Ints) -> bool:
        """Whether a force can follow its nodes; an error where it cannot but should."""
        if draft.index == 2:
            return False
        if self._rotating(nodes).all():
            return True
        if any(step.nlgeom for step in self.deck.steps):
            text = f"FOLLOWER: {draft.target} has no rotation to turn with"
            hint = "load the edges: *DSLOAD with P, or TRVEC, which follow them"
            draft.card.error(text, "FOLLOWER", hint)
        else:
            self.deck.note(
                f"{draft.card.where}: without NLGEOM a force keeps its direction, with or without "
                "FOLLOWER"
            )
        return False

    def _cell_load(self, draft: Draft) -> Load:
        where, root = draft.row.where, self.meshes.views[0]
        amplitude = self.targets.amplitude(draft)
        if not draft.target and draft.kind != "pressure":
            return self._body(draft, "", both(draft, amplitude)[1])
        if numerals.is_integer(draft.target):
            root = self.targets.numbering(root, draft.target, "cells")
        found, name = both(self.targets.cells_of(draft), amplitude)
        attached = len(found.attached) > 0 and draft.kind in ("gravity", "centrifugal")
        if not len(found.cells) and not attached:
            # Lines of a meshing program are not elements here; a set of lines only is empty too.
            draft.row.refuse(0, f"element set {draft.target} is empty")
        if draft.kind == "pressure":
            codes = self.meshes.cell_type[found.cells]
            if any(self.meshes.types[code] in SHELLS for code in distinct(codes).tolist()):
                draft.row.refuse(
                    1,
                    "a pressure on a shell is normal to its plane, whatever its number",
                    "load the edges: *DSLOAD on a *SURFACE of their faces S3 to S6",
                )
            edges = self._faces(draft, found.cells)
            of_edges: Literal["pressure", "hydrostatic pressure"] = (
                "pressure" if len(draft.value) == 1 else "hydrostatic pressure"
            )
            return EdgeLoad(edges, of_edges, draft.value, name, where=where)
        full = self.sets.full_name(self.sets.elsets, root, draft.target)
        spelled = self.sets.spelled(self.sets.elsets, full) if full else ""
        masses = self.deck.masses
        numbers = [masses[i] for i in found.attached.tolist() if i in masses]
        return self._body(draft, spelled or found.cells, name, np.array(numbers, np.int64))

    def _volume_force(self, draft: Draft) -> Load:
        """A force per volume, or per length of beams and trusses."""
        amplitude = self.targets.amplitude(draft)
        found = self.targets.cells_of(draft) if draft.target else None
        cells = np.arange(self.mesh.n_cells)
        if draft.target:
            cells = both(found, amplitude)[0].cells
        if draft.kind == "line":
            lines = np.zeros(self.mesh.n_cells, bool)
            for section in self.model.sections:
                if section.element in ("TRUSS", "BEAM"):
                    lines[cells_of(self.mesh, section.cells)] = True
            if not lines[cells].all():
                label = self.mesh.cell_labels[cells[np.argmin(lines[cells])]]
                draft.row.refuse(
                    1,
                    "PX and PY are forces per length of beams and trusses; element "
                    f"{label} is none",
                    "give BX and BY, or pressures and tractions on its faces",
                )
        kind = cast("Literal['volume', 'line']", draft.kind)
        along = (1.0, 0.0) if key(draft.row.get(1)).endswith("X") else (0.0, 1.0)
        where, name = draft.row.where, both(draft, amplitude)[1]
        return BodyForce(cells, kind, draft.value, name, where, direction=along)

    def _edges_of(self, draft: Draft) -> tuple[str | Ints, str]:
        """Name of a surface, or edges of one face of elements, and the amplitude."""
        amplitude = self.targets.amplitude(draft)
        if draft.index < 0:
            return both(self._edge_set(draft), amplitude)
        found, name = both(self.targets.cells_of(draft), amplitude)
        return self._faces(draft, found.cells), name

    def _faces(self, draft: Draft, cells: Ints) -> Ints:
        """Edges of the face of a draft."""
        row = draft.row
        at = SurfaceRow(row.card, row.at(1), row.text, draft.target, "")
        edges = self.sets.faces(cells, draft.index, at)
        if not len(edges):
            raise Refused  # the side of a quadrilateral that is one node
        return edges

    def _body(
        self, draft: Draft, cells: str | Ints, amplitude: str, masses: Ints | None = None
    ) -> BodyForce:
        kind = cast("Literal['gravity', 'centrifugal']", draft.kind)
        value, along = draft.value, None
        if kind == "gravity":
            along = (value[2], value[3]) if len(value) > 2 else None
            value = value[:2]
        elif draft.index != (1 if any(s.axisymmetric for s in self.model.sections) else 2):
            text = (
                "the axis must be normal to the plane, 0, 0, 1; of axisymmetric parts it is 0, 1, 0"
            )
            draft.row.error(6, text)
        where = draft.row.where
        return BodyForce(cells, kind, value, amplitude, where, direction=along, masses=masses)

    def _edge_set(self, draft: Draft) -> str | None:
        name = self.sets.mesh_name(self.mesh.edge_sets, self.targets.at, draft.target)
        if not name:
            hint = nearest(draft.target, self.mesh.edge_sets)
            draft.row.error(0, f"no surface named {numerals.shown(draft.target)}", hint)
        elif not len(self.mesh.edge_sets[name]):
            draft.row.error(0, f"surface {name} has no edges")
        else:
            return name
        return None
