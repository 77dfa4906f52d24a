"""From what a deck said to a model: sections, materials, supports, loads, steps."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from corota.errors import InputError
from corota.io.deck import numerals
from corota.io.deck.build.base_motion import base_motion
from corota.io.deck.build.contact import build_contacts
from corota.io.deck.build.materials import build_material, settle_temperature, share_damping
from corota.io.deck.build.mesh import MeshBuilder, View, view_of, views_in
from corota.io.deck.build.pretension import PretensionBuilder
from corota.io.deck.build.sets import Elements, Sets
from corota.io.deck.build.ties import build_tie
from corota.io.deck.cards.attachments import build_attachments
from corota.io.deck.cards.lines import build_lines, truss_section
from corota.io.deck.cards.thermal import build_initial, build_temperature
from corota.io.deck.deck import nearest
from corota.io.deck.elements import (
    ASK,
    DRILLING,
    ELEMENTS,
    LINE_ELEMENTS,
    LINES,
    WRITTEN_BY_MESHIO,
)
from corota.io.deck.lexer import key
from corota.mesh.parts import cells_of
from corota.model.loads import BodyForce, EdgeLoad, Fixed, InitialVelocity, NodalForce
from corota.model.local_strain import LocalStrain
from corota.model.materials import Orthotropic
from corota.model.model import Model
from corota.model.sections import Section
from corota.model.steps import Static, SteadyState

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import Draft, SectionDraft, StepDraft, TieDraft
    from corota.mesh.data import Ints
    from corota.model.loads import Load
    from corota.model.materials import Material
    from corota.model.steps import Step

#: Cards that give beams and springs their section.
SECTION_CARDS = {"beam": "*BEAM SECTION", "spring": "*SPRING"}


class ModelBuilder:
    """Builds the model of a deck; faults go to ``deck.diagnostics``."""

    def __init__(self, deck: Deck, name: str) -> None:
        self.deck = deck
        self.meshes = MeshBuilder(deck)
        self.model = Model(self.meshes.build(), name)
        self.mesh = self.model.mesh
        self.sets = Sets(self.meshes, self.mesh)
        #: Thickness of nodes, nan where none is given; worked out where it is wanted.
        self.nodal: np.ndarray[tuple[int], np.dtype[np.float64]] | None = None
        #: Part or assembly whose names come first.
        self.at = self.meshes.views[0]
        self.rotating = np.zeros(self.mesh.n_nodes, bool)

    def build(self) -> Model:
        """Everything."""
        self.sets.fill()
        pretension = PretensionBuilder(self.deck, self.model, self.sets)
        pretension.cut()
        self.rotating = np.zeros(self.mesh.n_nodes, bool)
        share_damping(self.deck)
        until = sum(step.times[1] for step in self.deck.steps)
        for name, curve in self.deck.curves.items():
            self.deck.amplitudes[name] = curve.sampled(until)
        settle_temperature(self.deck, self._temperature())
        self._drop_temperatures()
        self._sections()
        model, deck = self.model, self.deck
        for tie in deck.ties:
            for view in views_in(self.meshes.views, deck, tie.card.scope):
                self.at = view
                build_tie(
                    deck, model, self._nodes, self._tied, self._surface_name, self.rotating, tie
                )
        self.at = self.meshes.views[0]
        build_contacts(deck, model, self.sets, self._nodes, self.rotating)
        model.amplitudes = {a.name: a for a in deck.amplitudes.values()}
        pretension.join(self._nodes, self.rotating)
        model.supports += self._supports(deck.supports)
        build_attachments(deck, model, self._nodes)
        for item in deck.velocities:
            nodes = self._nodes(item)
            if nodes is not None:
                model.velocities.append(
                    InitialVelocity(nodes, item.value, item.index, item.row.where)
                )
        build_initial(deck, model, self._nodes, self._cells_of)
        for draft in deck.steps:
            step = self._step(draft)
            if step is not None:
                step.restart = draft.restart
                model.steps.append(step)
        self.sets.report_missing(self._names_used())
        model.time_points = deck.time_points
        model.title = " ".join(deck.heading)
        self._move_supports()
        self._unused()
        model.notes += deck.notes
        return model

    def _tied(self, tie: TieDraft) -> Ints | None:
        return self.sets.nodes_of_elements(self.at, tie.elset, tie.card.at("ELSET"), tie.card)

    def _surface_name(self, table: Mapping[str, object], name: str) -> str:
        return self.sets.mesh_name(table, self.at, name)

    def _cells_of(self, draft: Draft) -> Elements | None:
        view = self.meshes.views[0]
        if numerals.is_integer(draft.target):
            view = self._numbering(view, draft.target, "cells")
        return self.sets.elements(view, draft.target, draft.row.at(0), draft.card, draft.row.text)

    def _names_used(self) -> set[str]:
        """Keys of the names that supports, loads and constraints use."""
        deck = self.deck
        drafts = deck.supports + deck.velocities + [item.draft for item in deck.initial]
        drafts += [d for step in deck.steps for d in step.supports + step.loads]
        drafts += [d for tie in deck.ties for d in (*tie.terms, tie.target) if d is not None]
        return {key(d.target) for d in drafts} | {key(tie.surface) for tie in deck.ties}

    def _unused(self) -> None:
        deck = self.deck
        scopes = [view.scope for view in self.meshes.views]
        used = {key(s.material) for scope in scopes for s in scope.sections}
        used |= {key(s.material) for scope in scopes for s in scope.lines}
        for name, material in deck.materials.items():
            if name not in used and self.model.sections:
                deck.note(f"{material.card.where}: material {material.name} is not used")
        drafts = deck.supports + [d for s in deck.steps for d in s.supports + s.loads]
        named = {key(draft.amplitude) for draft in drafts}
        for name, amplitude in deck.amplitudes.items():
            if name not in named and deck.steps:
                deck.note(f"{amplitude.where}: amplitude {amplitude.name} is not used")

    def _sections(self) -> None:
        owner = np.full(self.mesh.n_cells, -1, np.int64)
        drafts = [(view, draft) for view in self.meshes.views for draft in view.scope.sections]
        materials = {name: build_material(self.deck, m) for name, m in self.deck.materials.items()}
        for number, (view, draft) in enumerate(drafts):
            card = draft.card
            found = self.sets.elements(view, draft.elset, card.at("ELSET"), card)
            if found is None:
                continue
            if len(found.lines) and not len(found.cells):
                self.deck.error(
                    card,
                    card.at("ELSET"),
                    f"{draft.elset} holds line elements of curves only",
                    hint="for trusses, put the set and the section beside the elements",
                )
                continue
            taken = found.cells[owner[found.cells] >= 0]
            if len(taken):
                first = drafts[int(owner[taken[0]])][1].card.where
                label = self.mesh.cell_labels[taken[0]]
                self.deck.error(
                    card, card.where, f"element {label} already has a section ({first})"
                )
                continue
            owner[found.cells] = number
            if draft.material and key(draft.material) not in materials:
                names = [m.name for m in self.deck.materials.values()]
                self.deck.error(
                    card,
                    card.at("MATERIAL"),
                    f"no material named {draft.material!r}",
                    hint=nearest(draft.material, names),
                )
                continue
            material = materials[key(draft.material)]
            if material is not None:
                self._section(view, draft, found.cells, material)
        build_lines(self.deck, self.model, self.meshes, self.sets, materials, self.rotating, owner)
        bare = np.flatnonzero(owner == -1)
        if len(bare) and (drafts or self.deck.steps):
            label = self.mesh.cell_labels[bare[0]]
            more = f" and {len(bare) - 1} others have" if len(bare) > 1 else " has"
            line_element = LINE_ELEMENTS.get(self.meshes.types[self.meshes.cell_type[bare[0]]])
            wanted = SECTION_CARDS[line_element.role] if line_element else "*SOLID SECTION"
            self.deck.error(None, None, f"element {label}{more} no {wanted}", hint="give it one")

    def _section(self, view: View, draft: SectionDraft, cells: Ints, material: Material) -> None:
        deck, card = self.deck, draft.card
        angle = 0.0
        if draft.orientation:
            tables = (view.scope.orientations, deck.root.orientations)
            named = next((t for t in tables if key(draft.orientation) in t), None)
            if named is None:
                names = [n for t in tables for n in t]
                deck.error(
                    card,
                    card.at("ORIENTATION"),
                    f"no orientation named {draft.orientation!r}",
                    hint=nearest(draft.orientation, names),
                )
                return
            angle = named[key(draft.orientation)]
            if math.isnan(angle):
                if isinstance(material, Orthotropic):
                    text = "axes that turn about a point are not part of this version"
                    deck.error(
                        card,
                        card.at("ORIENTATION"),
                        text,
                        hint="give *ORIENTATION, SYSTEM=RECTANGULAR to parts of the body",
                    )
                    return
                deck.note(
                    f"{card.where}: {card.spelled}: the axes of an isotropic material do "
                    "not matter; results are in global axes"
                )
                angle = 0.0
            if view.instance is not None:
                angle += view.instance.angle
        groups: dict[tuple[str, str], list[Ints]] = {}
        types = self.meshes.cell_type[cells]
        for code in np.unique(types):
            name = self.meshes.types[code]
            if name in LINES:
                truss = truss_section(deck, draft, cells[types == code], material)
                self.model.sections += [truss] if truss else []
                continue
            if name in LINE_ELEMENTS:
                wanted = SECTION_CARDS[LINE_ELEMENTS[name].role]
                deck.error(card, card.at("ELSET"), f"elements of type {name} take {wanted}")
                continue
            info = ELEMENTS[name]
            ask = info.ask
            if name in WRITTEN_BY_MESHIO and any("written by meshio" in t for t in deck.heading):
                info, ask = replace(info, plane=""), ASK
            if draft.plane and info.plane and draft.plane != info.plane:
                deck.error(
                    card,
                    card.at("PLANE"),
                    f"{self.meshes.types[code]} elements are in plane {info.plane}; "
                    f"PLANE={draft.plane.upper()} does not fit",
                )
                return
            mapped = self.deck.element_map.get(name)
            if ask and not draft.plane and not mapped:
                deck.error(
                    card,
                    card.where,
                    f"{name} elements: {ask}",
                    hint=f"or replace them: --element {name}=CPS{info.kind[-1]}",
                )
                return
            plane = draft.plane or info.plane or (mapped[1] if mapped else "") or "stress"
            element = self._element(self.meshes.types[code])
            groups.setdefault((element, plane), []).append(cells[types == code])
        full = self.sets.full_name(self.sets.elsets, view, draft.elset)
        pieces: list[tuple[str, str, Ints, float]] = [
            (element, plane, mine, thickness)
            for (element, plane), parts in groups.items()
            for mine, thickness in self._thickness(draft, np.sort(np.concatenate(parts)))
        ]
        for element, plane, mine, thickness in pieces:
            if element in DRILLING:
                for block, row in ((self.mesh.cells[b], r) for b, r in self._rows(mine)):
                    self.rotating[block.nodes[row]] = True
            whole = full and len(mine) == len(cells)
            where = self.sets.spelled(self.sets.elsets, full) if whole else mine
            try:
                self.model.sections.append(
                    Section(
                        where,
                        element,
                        material,
                        thickness,
                        cast("Literal['stress', 'strain']", plane),
                        cast("LocalStrain", draft.local_strain),
                        angle,
                        card.where,
                        mean_dilatation=draft.mean_dilatation,
                        beta0=draft.beta0,
                    )
                )
            except InputError as error:
                deck.error(card, card.where, error.message)

    def _thickness(self, draft: SectionDraft, cells: Ints) -> list[tuple[Ints, float]]:
        """Cells of a section by their thickness: that of the section, or the mean of their nodes.

        As in CalculiX and Abaqus, ``*NODAL THICKNESS`` counts where the section says so.
        """
        if not draft.nodal:
            if self.deck.thicknesses:
                self.deck.note(
                    f"{draft.card.where}: {draft.card.spelled} has no NODAL THICKNESS: its own "
                    "thickness is taken, that of *NODAL THICKNESS is not"
                )
            return [(cells, draft.thickness)]
        if self.nodal is None:
            self.nodal = np.full(self.mesh.n_nodes, np.nan)
            for item in self.deck.thicknesses:
                for view in views_in(self.meshes.views, self.deck, item.card.scope):
                    self.at = view
                    nodes = self._nodes(item)
                    if nodes is not None:
                        at = self.mesh.nodes_of(nodes) if isinstance(nodes, str) else nodes
                        self.nodal[at] = item.value[0]
            self.at = self.meshes.views[0]
        values = np.where(np.isnan(self.nodal), draft.thickness, self.nodal)
        if not self.deck.thicknesses:
            text = "NODAL THICKNESS is given, and no card *NODAL THICKNESS"
            self.deck.error(draft.card, draft.card.at("NODALTHICKNESS"), text)
        mean, spread = np.zeros(len(cells)), 0.0
        offsets = self.mesh.offsets
        for number, block in enumerate(self.mesh.cells):
            inside = (cells >= offsets[number]) & (cells < offsets[number + 1])
            corners = 3 if block.kind.startswith("tri") else 4
            own = values[block.nodes[cells[inside] - offsets[number], :corners]]
            mean[inside] = own.mean(axis=1)
            spread = max(spread, float(np.ptp(own, axis=1).max(initial=0.0)))
        if spread > 1e-9 * float(mean.max(initial=1.0)):
            self.deck.note(
                f"{draft.card.where}: the thickness differs between the nodes of an element by up "
                f"to {spread:g}; each element has the mean of its corners"
            )
        sizes, group = np.unique(np.round(mean, 12), return_inverse=True)
        return [(cells[group == i], float(size)) for i, size in enumerate(sizes)]

    def _element(self, type_: str) -> str:
        mapped = self.deck.element_map.get(type_)
        own, literal = ELEMENTS[type_].element, ELEMENTS[type_].literal
        if mapped or not literal:
            return mapped[0] if mapped else own
        if self.deck.literal:
            return literal
        self.deck.note(
            f"{type_} becomes {own}, which is more accurate on coarse meshes than one point with "
            f"a stabilized hourglass ({literal}); --as-written (as_written=True) takes {literal}"
        )
        return own

    def _rows(self, cells: Ints) -> list[tuple[int, Ints]]:
        offsets = self.mesh.offsets
        inside = [(cells >= a) & (cells < b) for a, b in pairwise(offsets)]
        return [(i, cells[m] - offsets[i]) for i, m in enumerate(inside) if m.any()]

    def _nodes(self, draft: Draft) -> str | Ints | None:
        """Name in the mesh, or indices, of a target of supports and nodal forces."""
        target, row = draft.target, draft.row
        found: tuple[View, str] | None
        if numerals.is_integer(target):
            found = (self._numbering(self.at, target, "nodes"), target)
        else:
            full = self.sets.full_name(self.sets.nsets, self.at, target)
            if full:
                if not len(self.mesh.node_sets.get(self.sets.spelled(self.sets.nsets, full), ())):
                    self.deck.row_error(draft.card, row, 0, f"node set {target} is empty")
                    return None
                return self.sets.spelled(self.sets.nsets, full)
            name = self.sets.mesh_name(self.mesh.node_sets, self.at, target)
            if name:
                return name
            found = view_of(self.meshes.views, target)
        if found and numerals.is_label(found[1]):
            node = found[0].nodes(np.array([int(found[1])]))
            if node[0] >= 0:
                return node
            self.deck.row_error(draft.card, row, 0, f"node {target} is not defined")
            return None
        self.deck.row_error(
            draft.card,
            row,
            0,
            f"no node set named {numerals.shown(target)}",
            nearest(target, self.mesh.node_sets),
        )
        return None

    def _numbering(self, view: View, number: str, what: Literal["nodes", "cells"]) -> View:
        """View whose numbers are meant: the assembly's own, else those of the only instance."""
        views = self.meshes.views
        if view is not views[0] or len(views) != 2 or not numerals.is_label(number):
            return view
        own = view.nodes if what == "nodes" else view.cells
        return view if own(np.array([int(number)]))[0] >= 0 else views[1]

    def _amplitude(self, draft: Draft) -> str | None:
        if not draft.amplitude:
            return ""
        found = self.deck.amplitudes.get(key(draft.amplitude))
        if found is None:
            names = [a.name for a in self.deck.amplitudes.values()]
            self.deck.error(
                draft.card,
                draft.card.at("AMPLITUDE"),
                f"no amplitude named {draft.amplitude!r}",
                hint=nearest(draft.amplitude, names),
            )
            draft.amplitude = ""
            return None
        return found.name

    def _supports(self, drafts: list[Draft], step: StepDraft | None = None) -> list[Fixed]:
        found = []
        for draft in drafts:
            nodes, amplitude = self._nodes(draft), self._amplitude(draft)
            if draft.order and step is not None and amplitude is not None:
                amplitude = base_motion(self.deck, self.model, draft, amplitude, step)
            if nodes is None or amplitude is None or draft.kind == "nothing":
                continue
            if draft.index == 2:
                if not self._rotating(nodes).any():
                    if draft.silent or draft.value[0] == 0.0:
                        continue
                    self._no_rotation(draft)
                    continue
                if not isinstance(nodes, str):
                    nodes = nodes[self.rotating[nodes]]
            value, where = draft.value[0], draft.row.where
            if draft.order == 2 and any(
                np.isin(self.mesh.node_indices(v.nodes), self.mesh.node_indices(nodes)).any()
                for v in self.model.velocities
            ):
                self.deck.row_error(
                    draft.card,
                    draft.row,
                    0,
                    "nodes with a prescribed acceleration start from rest; these have an initial "
                    "velocity",
                    "give TYPE=VELOCITY",
                )
                continue
            found.append(Fixed(nodes, draft.index, value, amplitude, where, keep=draft.keep))
        return found

    def _rotating(self, nodes: str | Ints) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        indices = self.mesh.nodes_of(nodes) if isinstance(nodes, str) else nodes
        return cast("np.ndarray[tuple[int], np.dtype[np.bool_]]", self.rotating[indices])

    def _no_rotation(self, draft: Draft) -> None:
        self.deck.row_error(
            draft.card,
            draft.row,
            1,
            f"{draft.target}: its elements have no rotation (dof 6)",
            "use elements Q4D or OPT, or map them: --element CPS4=Q4D",
        )

    def _drop_temperatures(self) -> None:
        """Leave out temperatures where no material expands: they act on nothing."""
        deck = self.deck
        if any(m.expansion != 0.0 for m in deck.materials.values()):
            return
        given = [d for step in deck.steps for d in step.loads if d.kind == "temperature"]
        if given:
            deck.note(
                f"{given[0].row.where}: temperatures have no effect: no material has *EXPANSION"
            )
        for step in deck.steps:
            step.loads = [d for d in step.loads if d.kind != "temperature"]
        deck.initial = [i for i in deck.initial if i.draft.kind != "initial temperature"]

    def _temperature(self) -> float | None:
        """Temperature of the whole model in all steps; ``None`` where there are several."""
        deck = self.deck
        if not any(m.table for m in deck.materials.values()):
            return 0.0
        if any(d.kind == "temperature" for step in deck.steps for d in step.loads):
            return None
        found = np.zeros(self.mesh.n_nodes)
        for item in deck.initial:
            nodes = self._nodes(item.draft) if item.draft.kind == "initial temperature" else None
            if nodes is not None:
                found[self.mesh.nodes_of(nodes) if isinstance(nodes, str) else nodes] = (
                    item.draft.value[0]
                )
        cells = [block.nodes.ravel() for block in self.mesh.cells]
        mine = found[np.concatenate([np.zeros(0, np.int64), *cells])]
        return float(mine[0]) if len(mine) and (mine == mine[0]).all() else None

    def _loads(self, draft: Draft) -> list[Load]:
        if draft.kind == "surface shear":
            return list(self._shear(draft))
        if draft.kind == "volume":
            return list(self._volume_force(draft))
        load = self._load(draft)
        return [] if load is None else [load]

    def _shear(self, draft: Draft) -> Iterator[Load]:
        """Shear along the edges of a surface, towards a direction."""
        name, amplitude = self._edges_of(draft), self._amplitude(draft)
        if name is None or amplitude is None:
            return
        edges = self.mesh.edge_sets[name] if isinstance(name, str) else name
        ends = np.array([nodes[:2] for nodes in self.mesh.edge_nodes(edges)])
        along = self.mesh.points[ends[:, 1]] - self.mesh.points[ends[:, 0]]
        along = np.asarray(along / np.hypot(along[:, :1], along[:, 1:]), np.float64)
        size = math.hypot(*draft.value)
        if size == 0.0:
            yield EdgeLoad(edges, "shear", (0.0,), amplitude, where=draft.row.where)
            return
        share = along @ (np.array(draft.value) / size)
        if (np.abs(share) < 1e-6).any():
            self.deck.row_error(
                draft.card, draft.row, 3, "the direction of the shear is normal to an edge"
            )
            return
        for sign in (-1.0, 1.0):
            mine = edges[np.sign(share) == sign]
            if len(mine):
                yield EdgeLoad(mine, "shear", (sign * size,), amplitude, where=draft.row.where)

    def _load(self, draft: Draft) -> Load | None:
        amplitude = self._amplitude(draft)
        where = draft.row.where
        if draft.kind == "force":
            nodes = self._nodes(draft)
            if nodes is None or amplitude is None:
                return None
            if draft.index == 2 and not self._rotating(nodes).all():
                self._no_rotation(draft)
                return None
            force = NodalForce(nodes, draft.index, draft.value[0], amplitude, where)
            force.follower = draft.card.has("FOLLOWER") and self._turns(draft, nodes)
            return force
        if draft.kind == "temperature":
            nodes = self._nodes(draft)
            if nodes is None or amplitude is None:
                return None
            return build_temperature(draft, nodes, amplitude)
        if draft.kind.startswith("surface "):
            edges = self._edges_of(draft)
            if edges is None or amplitude is None:
                return None
            kind = draft.kind.removeprefix("surface ")
            return EdgeLoad(
                edges,
                cast("Literal['pressure', 'traction', 'following traction']", kind),
                draft.value,
                amplitude,
                where=where,
            )
        return self._cell_load(draft, amplitude)

    def _turns(self, draft: Draft, nodes: str | Ints) -> bool:
        """Whether a force can turn with its nodes; told where it cannot and should."""
        if draft.index == 2:
            return False
        if self._rotating(nodes).all():
            return True
        if any(step.nlgeom for step in self.deck.steps):
            self.deck.error(
                draft.card,
                draft.card.at("FOLLOWER"),
                f"FOLLOWER: {draft.target} has no rotation to turn with",
                hint="load the edges: *DSLOAD with P, or TRVEC, which follow them",
            )
        else:
            self.deck.note(
                f"{draft.card.where}: without NLGEOM a force keeps its direction, FOLLOWER or not"
            )
        return False

    def _cell_load(self, draft: Draft, amplitude: str | None) -> Load | None:
        where, root = draft.row.where, self.meshes.views[0]
        if not draft.target and draft.kind != "pressure":
            return None if amplitude is None else self._body(draft, "", amplitude)
        if numerals.is_integer(draft.target):
            root = self._numbering(root, draft.target, "cells")
        found = self.sets.elements(root, draft.target, draft.row.at(0), draft.card, draft.row.text)
        if found is None or amplitude is None:
            return None
        if not len(found.cells):
            # Lines of a meshing program are no elements here; a set of them alone is empty too.
            self.deck.row_error(draft.card, draft.row, 0, f"element set {draft.target} is empty")
            return None
        if draft.kind == "pressure":
            edges = self.sets.faces(
                found.cells, draft.index, draft.card, draft.row.at(1), draft.row.text
            )
            if edges is None or not len(edges):
                return None  # the side of a quadrilateral that is one node
            return EdgeLoad(edges, "pressure", draft.value, amplitude, where=where)
        full = self.sets.full_name(self.sets.elsets, root, draft.target)
        name = self.sets.spelled(self.sets.elsets, full) if full else ""
        return self._body(draft, name or found.cells, amplitude)

    def _volume_force(self, draft: Draft) -> Iterator[Load]:
        """A force per volume as gravity: the core takes forces per mass."""
        amplitude, root = self._amplitude(draft), self.meshes.views[0]
        cells = np.arange(self.mesh.n_cells)
        if draft.target:
            if numerals.is_integer(draft.target):
                root = self._numbering(root, draft.target, "cells")
            row = draft.row
            found = self.sets.elements(root, draft.target, row.at(0), draft.card, row.text)
            if found is None:
                return
            cells = found.cells
        if amplitude is None:
            return
        rho = np.full(self.mesh.n_cells, -1.0)
        for section in self.model.sections:
            rho[cells_of(self.mesh, section.cells)] = section.material.rho
        for density in np.unique(rho[cells]).tolist():
            if density == 0.0:
                self.deck.row_error(
                    draft.card,
                    draft.row,
                    1,
                    "a force per volume is taken per mass, and a material here has no density",
                    "give *DENSITY; statics does not depend on its value",
                )
                return
            if density > 0.0:
                value = (draft.value[0] / density, draft.value[1] / density)
                mine = cells[rho[cells] == density]
                yield BodyForce(mine, "gravity", value, amplitude, draft.row.where)

    def _edges_of(self, draft: Draft) -> str | Ints | None:
        """Name of a surface, or edges of one face of elements."""
        if draft.index < 0:
            return self._edge_set(draft)
        root, row = self.meshes.views[0], draft.row
        if numerals.is_integer(draft.target):
            root = self._numbering(root, draft.target, "cells")
        found = self.sets.elements(root, draft.target, row.at(0), draft.card, row.text)
        if found is None:
            return None
        edges = self.sets.faces(found.cells, draft.index, draft.card, row.at(1), row.text)
        return edges if edges is not None and len(edges) else None

    def _body(self, draft: Draft, cells: str | Ints, amplitude: str) -> BodyForce:
        kind = cast("Literal['gravity', 'centrifugal']", draft.kind)
        if kind == "gravity":
            along = (draft.value[2], draft.value[3]) if len(draft.value) > 2 else None
            return BodyForce(
                cells, kind, draft.value[:2], amplitude, draft.row.where, direction=along
            )
        return BodyForce(cells, kind, draft.value, amplitude, draft.row.where)

    def _edge_set(self, draft: Draft) -> str | None:
        name = self.sets.mesh_name(self.mesh.edge_sets, self.at, draft.target)
        if name:
            if len(self.mesh.edge_sets[name]):
                return name
            self.deck.row_error(draft.card, draft.row, 0, f"surface {name} has no edges")
            return None
        self.deck.row_error(
            draft.card,
            draft.row,
            0,
            f"no surface named {numerals.shown(draft.target)}",
            nearest(draft.target, self.mesh.edge_sets),
        )
        return None

    def _step(self, draft: StepDraft) -> Step | None:
        deck = self.deck
        if draft.procedure is None:
            return None
        behind = {id(d) for d in (*draft.supports, *draft.loads) if self._is_imaginary(d, draft)}
        supports = self._supports([d for d in draft.supports if id(d) not in behind], draft)
        ahead = [d for d in draft.loads if id(d) not in behind]
        loads = [load for item in ahead for load in self._loads(item)]
        for request in draft.outputs:
            self._check_target(request.kind, request.where, draft)
        first, period, least, most = draft.times
        try:
            make = draft.make or Static
            options = draft.options or {"ramp": draft.ramp}
            if behind:
                late = [x for d in draft.loads if id(d) in behind for x in self._loads(d)]
                options = {
                    **options,
                    "imaginary_supports": self._supports(
                        [d for d in draft.supports if id(d) in behind], draft
                    ),
                    "imaginary_loads": late,
                }
            return make(
                nlgeom=draft.nlgeom if draft.preload is None else draft.preload,
                period=period,
                first_increment=first,
                smallest_increment=least,
                largest_increment=most,
                fixed_increments=draft.direct,
                max_increments=draft.max_increments,
                supports=supports,
                loads=loads,
                new_supports=draft.new_supports,
                new_loads=draft.new_loads,
                outputs=draft.outputs,
                where=draft.card.where,
                **options,
            )
        except InputError as error:
            deck.error(draft.procedure, draft.procedure.where, error.message)
            return None

    def _is_imaginary(self, item: Draft, draft: StepDraft) -> bool:
        """Whether ``LOAD CASE=2`` makes a load of a harmonic step act out of phase."""
        case = item.card.value("LOADCASE") or "1"
        if case not in ("1", "2"):
            self.deck.error(
                item.card, item.card.at("LOADCASE"), f"LOAD CASE must be 1 or 2, not {case}"
            )
        elif case == "2" and draft.make is not SteadyState:
            self.deck.error(
                item.card,
                item.card.at("LOADCASE"),
                "LOAD CASE=2 (out of phase) belongs to *STEADY STATE DYNAMICS",
            )
        return case == "2" and draft.make is SteadyState

    def _check_target(self, kind: str, where: str, draft: StepDraft) -> None:
        known: dict[str, Mapping[str, object]] = {
            "node print": self.mesh.node_sets,
            "el print": self.mesh.cell_sets,
            "contact print": {pair.name: None for pair in self.model.contacts},
        }
        tables = known.get(kind, {**self.mesh.node_sets, **self.mesh.cell_sets})
        request = next(o for o in draft.outputs if o.kind == kind and o.where == where)
        if not where:
            return
        name = self.sets.mesh_name(tables, self.meshes.views[0], where)
        if name:
            request.where = name
            return
        what = {
            "node print": "node set",
            "el print": "element set",
            "contact print": "contact pair",
        }.get(kind, "set")
        self.deck.error(
            None, request.source, f"no {what} named {where!r}", hint=nearest(where, tables)
        )

    def _move_supports(self) -> None:
        """Supports before the first step end with the first ``OP=NEW``, as the others do."""
        steps = self.model.steps
        if any(step.new_supports for step in steps):
            if not steps[0].new_supports:
                steps[0].supports = self.model.supports + steps[0].supports
            self.model.supports = []
