"""A whole model as a deck that reads back to the same model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import UnsupportedError
from corota.io.atomic_file import replace_text
from corota.io.deck.cards.user_material import user_material_cards
from corota.io.deck.laws import law_cards
from corota.io.deck.write.attachments import (
    attachment_cards,
    damping_card,
    model_damping,
    velocity_cards,
)
from corota.io.deck.write.compare import Written, refuse_loss
from corota.io.deck.write.constraints import constraint_cards
from corota.io.deck.write.contact import contact_cards
from corota.io.deck.write.lines import LINE_TYPES, line_cards
from corota.io.deck.write.loads import boundary
from corota.io.deck.write.mesh import TYPES
from corota.io.deck.write.plastic import plastic_cards, prony_cards
from corota.io.deck.write.steps import step_cards
from corota.io.deck.write.text import number, plain, rows
from corota.io.deck.write.thermal import expansion_cards, initial_cards
from corota.mesh import EDGES
from corota.mesh.parts import cells_of, nodes_of_cells
from corota.model.compiled import Umat
from corota.model.local_strain import dialect_strain
from corota.model.material_table import MaterialTable
from corota.model.mullins import Mullins
from corota.model.released import without_releases
from corota.model.steps import Static, Step
from corota.model.viscoelastic import Viscoelastic

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence

    from corota.arrays import Ints
    from corota.mesh.data import Mesh
    from corota.model.materials import Material
    from corota.model.model import Model
    from corota.model.sections import Section
    from corota.model.stages import Stage


def write_deck(
    model: Model, path: str | os.PathLike[str], steps: Step | Sequence[Step] | None = None
) -> Path:
    """Write a model as a deck.

    Parameters
    ----------
    steps : Step or sequence of Step, optional
        Steps to write; by default those of the model, or one static step if it has loads and no
        step.

    Raises
    ------
    UnsupportedError
        If a part of the model has no card, or the deck reads back as another model; nothing is
        silently omitted.
    FileError
        If writing fails.
    """
    target = Path(path)
    chosen = [steps] if isinstance(steps, Step) else list(model.steps if steps is None else steps)
    writer = _Writer(*without_releases(model, chosen))
    text = "".join(writer.cards())
    refuse_loss(writer, text)
    replace_text(target, text)
    return target


class _Writer:
    """Cards of one model; generated sets start with an underscore."""

    def __init__(self, model: Model, steps: list[Step]) -> None:
        self.model, self.mesh = model, model.mesh
        self.steps = steps or ([Static()] if model.loads else [])
        self._sets: list[str] = []
        self._invented = 0
        self._materials: dict[int, str] = {}
        self._edges: list[tuple[Ints, str]] = []  # generated surfaces
        #: Loads and supports that the cards of each step stand for.
        self.written: list[Written] = []

    def cards(self) -> Iterator[str]:
        model = self.model
        if model.start is not None:
            raise UnsupportedError(
                "a model that starts from a checkpoint (*RESTART, READ) cannot be written to a "
                "deck: write that of the whole analysis"
            )
        # The steps come first here since they may need sets of their own.
        tail = [model_damping(self, self.steps), *self._materials_and_sections(), *self._tables()]
        tail += constraint_cards(self)
        tail += contact_cards(self)
        tail += attachment_cards(self)
        tail += velocity_cards(self, self.steps)
        tail += initial_cards(self, model)
        tail += boundary(self, model.supports, False)
        self.written = [Written(step, [], []) for step in self.steps]
        tail += step_cards(self, self.written)
        yield f"*HEADING\n{model.title or model.name}\n"
        yield "** DIALECT: calculix\n"
        if model.unit_system:
            yield f"** UNITS: {model.unit_system}\n"
        for stage in model.stages:
            yield f"** STAGE: {self._stage(stage)}\n"
        yield from self._mesh()
        yield from self._sets
        yield from tail

    def _stage(self, stage: Stage) -> str:
        """A stage as the text of a comment."""
        against = None if stage.against is None else self.node_set(stage.against)
        return replace(stage, nodes=self.node_set(stage.nodes), against=against).text

    def _mesh(self) -> Iterator[str]:
        mesh = self.mesh
        yield "*NODE\n"
        for label, (x, y) in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True):
            yield f"{label}, {number(x)}, {number(y)}\n"
        names = np.full(mesh.n_cells, "", dtype="U8")
        for section in self.model.sections:
            names[cells_of(mesh, self._planar(section))] = section.element
        for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
            mine = names[offset : offset + len(block)]
            nodes = mesh.node_labels[block.nodes].tolist()
            rows = zip(mine.tolist(), block.labels.tolist(), nodes, strict=True)
            for name, run in groupby(rows, key=lambda row: row[0]):
                type_ = LINE_TYPES.get(name, name) or TYPES.get(block.kind)
                if type_ is None:
                    continue
                yield f"*ELEMENT, TYPE={type_}\n"
                for _, label, row in run:
                    yield f"{label}, {', '.join(map(str, row))}\n"
        for name, members in mesh.node_sets.items():
            yield _set("NSET", name, mesh.node_labels[members])
        for name, members in mesh.cell_sets.items():
            yield _set("ELSET", name, mesh.cell_labels[members])
        if "all" not in {name.lower() for name in mesh.cell_sets}:
            yield _set("ELSET", "all", mesh.cell_labels)
        for name, edges in mesh.edge_sets.items():
            yield _surface(mesh, name, edges)

    def _materials_and_sections(self) -> list[str]:
        lines: list[str] = []
        angles: dict[float, str] = {}
        nodal: dict[int, float] = {}
        for section in self.model.sections:
            if section.element in LINE_TYPES:
                spring = section.element.startswith("SPRING")
                name = "" if spring else self._material(section.material, lines)
                lines.append(line_cards(section, self.cell_set(self._planar(section)), name))
                continue
            name = self._material(section.material, lines)
            options = f"ELSET={self.cell_set(self._planar(section))}, MATERIAL={name}"
            if section.plane != "stress":
                options += f", PLANE={section.plane.upper()}"
            # Written decks say that they are read as those of CalculiX.
            strain = str(section.local_strain)
            if strain != dialect_strain(section.material.default_strain, "calculix"):
                options += f", LOCAL STRAIN={strain.replace('_', ' ').upper()}"
            if section.mean_dilatation:
                options += ", DILATATION=MEAN"
            if section.beta0 is not None:
                options += f", BETA0={number(section.beta0)}"
            if section.orientation != 0.0:
                angle = section.orientation
                if angle not in angles:
                    angles[angle] = f"AXES{len(angles) + 1}"
                    c, s = math.cos(angle), math.sin(angle)
                    lines.append(
                        f"*ORIENTATION, NAME={angles[angle]}\n{number(c)}, {number(s)}, 0., "
                    )
                    lines.append(f"{number(-s)}, {number(c)}, 0.\n")
                options += f", ORIENTATION={angles[angle]}"
            if section.nodal_thickness is not None:
                options += ", NODAL THICKNESS"
                self._add_thickness(section, nodal)
            depth = "" if section.axisymmetric else f"{number(section.thickness)}\n"
            lines.append(f"*SOLID SECTION, {options}\n{depth}")
        if nodal:
            lines.append("*NODAL THICKNESS\n")
            labels = self.mesh.node_labels
            lines += [f"{labels[n]}, {number(t)}\n" for n, t in sorted(nodal.items())]
        return lines

    def _add_thickness(self, section: Section, nodal: dict[int, float]) -> None:
        """The thickness of the nodes of a section; a deck has one for each node."""
        nodes = nodes_of_cells(self.mesh, cells_of(self.mesh, section.cells))
        values = section.thickness_at(nodes, self.mesh.points).tolist()
        for node, value in zip(nodes.tolist(), values, strict=True):
            if nodal.setdefault(node, value) != value:
                raise UnsupportedError(
                    f"node {self.mesh.node_labels[node]} has two thicknesses in two sections, "
                    "which a deck cannot express: give each section its own nodes"
                )

    def _material(self, material: Material, lines: list[str]) -> str:
        for other, name in self._materials.items():
            if self.model.sections[other].material == material:
                return name
        index = next(i for i, s in enumerate(self.model.sections) if s.material is material)
        name = plain(material.name or f"material {len(self._materials) + 1}")
        while name in self._materials.values():
            name += "_"
        self._materials[index] = name
        relaxing = material
        if isinstance(material, Viscoelastic | Mullins):
            material = material.parent
        law = (
            user_material_cards(material, number)
            if isinstance(material, Umat)
            else law_cards(material, number)
        )
        if law is None:
            raise UnsupportedError(
                f"a material of type {type(material).__name__} cannot be written to a deck"
            )
        if isinstance(relaxing, Viscoelastic) and relaxing.moduli == "instantaneous":
            law = law.replace("\n", ", MODULI=INSTANTANEOUS\n", 1)
        lines.append(f"*MATERIAL, NAME={name}\n{law}{plastic_cards(material)}")
        if isinstance(relaxing, Viscoelastic):
            lines.append(prony_cards(relaxing))
        if isinstance(relaxing, Mullins):
            softening = (relaxing.r, relaxing.m, relaxing.beta)
            lines.append(f"*MULLINS EFFECT\n{', '.join(number(v) for v in softening)}\n")
        material = relaxing
        lines.append(expansion_cards(material) + damping_card(material.rayleigh))
        if isinstance(material, MaterialTable) and material.density_varies:
            lines.append("*DENSITY\n")
            lines += [f"{number(m.rho)}, {number(t)}\n" for t, m in material.table]
        elif material.rho:
            lines.append(f"*DENSITY\n{number(material.rho)}\n")
        return name

    def _tables(self) -> Iterator[str]:
        for name, table in self.model.amplitudes.items():
            total = ", TIME=TOTAL TIME" if table.total_time else ""
            yield f"*AMPLITUDE, NAME={plain(name)}{total}\n"
            for time, value in zip(table.time.tolist(), table.value.tolist(), strict=True):
                yield f"{number(time)}, {number(value)}\n"
        for name, times in self.model.time_points.items():
            yield f"*TIME POINTS, NAME={plain(name)}\n"
            yield "".join(f"{number(time)}\n" for time in times.tolist())

    def nodes(self, where: str | Ints) -> list[str]:
        """Targets of a support or nodal force: a set, or node numbers."""
        if not isinstance(where, str):
            return [str(label) for label in self.mesh.node_labels[where].tolist()]
        if where in self.mesh.node_sets:
            return [plain(where)]
        return [self._invent("NSET", self.mesh.node_labels[self.mesh.nodes_of(where)])]

    def node_set(self, where: str | Ints) -> str:
        """Name of a node set, invented for an array and for the nodes of other sets."""
        if isinstance(where, str) and where in self.mesh.node_sets:
            return plain(where)
        return self._invent("NSET", self.mesh.node_labels[self.mesh.node_indices(where)])

    def _planar(self, section: Section) -> str | Ints:
        """Cells of a section: all are the planar ones, where there are lines too."""
        where = section.cells
        blocks = list(zip(self.mesh.offsets, self.mesh.cells, strict=False))
        planar = [o + np.arange(len(c)) for o, c in blocks if EDGES[c.kind]]
        named = not isinstance(where, str) or (where or "all") in self.mesh.cell_sets
        if named or len(planar) == len(blocks) or not planar:
            return where
        return np.concatenate(planar)

    def cell_set(self, where: str | Ints) -> str:
        """Name of an element set, generated for an array."""
        if isinstance(where, str):
            return plain(where or "all")
        for name, cells in self.mesh.cell_sets.items():
            if np.array_equal(np.sort(cells), np.sort(where)):
                return plain(name)
        return self._invent("ELSET", self.mesh.cell_labels[where])

    def edge_set(self, where: str | Ints) -> str:
        """Name of a surface, generated for an array."""
        if isinstance(where, str):
            return plain(where)
        for edges, name in [*((e, n) for n, e in self.mesh.edge_sets.items()), *self._edges]:
            if np.array_equal(edges, where):
                return plain(name)
        self._invented += 1
        self._sets.append(_surface(self.mesh, f"_{self._invented}", where))
        self._edges.append((where, f"_{self._invented}"))
        return f"_{self._invented}"

    def _invent(self, kind: str, labels: Ints) -> str:
        self._invented += 1
        self._sets.append(_set(kind, f"_{self._invented}", labels))
        return f"_{self._invented}"


def _surface(mesh: Mesh, name: str, edges: Ints) -> str:
    labels = mesh.cell_labels
    lines = mesh.are_lines(edges[:, 0])
    rows = "".join(
        f"{labels[cell]}, {'' if line else f'S{side + 1}'}\n"
        for (cell, side), line in zip(edges.tolist(), lines, strict=True)
    )
    return f"*SURFACE, NAME={plain(name)}\n{rows}" if rows else ""


def _set(kind: str, name: str, labels: Ints) -> str:
    return f"*{kind}, {kind}={plain(name)}\n" + "".join(rows(labels.tolist()))
