"""A whole model as a deck that reads back to the same model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError, UnsupportedError
from corota.io.atomic_file import replace_text
from corota.io.deck.laws import law_cards
from corota.io.deck.write.contact import contact_cards, step_cards, surfaces
from corota.io.deck.write.lines import LINE_TYPES, line_cards
from corota.io.deck.write.mesh import TYPES
from corota.io.deck.write.thermal import expansion_cards, initial_cards, temperatures
from corota.mesh import EDGES
from corota.mesh.parts import cells_of
from corota.model.loads import BodyForce, EdgeLoad, NodalForce, Temperature, applied, kind_of
from corota.model.steps import Static

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Iterator

    from corota.mesh.data import Ints, Mesh
    from corota.model.loads import AppliedLoad, Fixed, LoadKind
    from corota.model.materials import Material
    from corota.model.model import Model
    from corota.model.steps import Step

#: Entries on a line of a set.
PER_LINE = 10
#: Data of a model for which the writer has no card, and how a message calls them.
#: Cards that take away the loads of a kind.
_NEW: dict[LoadKind, str] = {"force": "CLOAD", "distributed": "DLOAD", "temperature": "TEMPERATURE"}
_UNWRITTEN = {
    "velocities": "initial velocities",
    "point_masses": "point masses",
    "dashpots": "dashpots",
    "constraints": "equations and couplings",
    "axes": "local axes of nodes",
}


def write_deck(model: Model, path: str | os.PathLike[str]) -> Path:
    """Write a model as a deck.

    Parameters
    ----------
    model : Model
    path : path-like

    Returns
    -------
    Path

    Raises
    ------
    UnsupportedError
        If something of the model has no card here; nothing is left out in silence.
    FileError
        If the disk refuses.
    """
    target = Path(path)
    replace_text(target, "".join(_Writer(model).cards()))
    return target


class _Writer:
    """Cards of one model; sets that it has to invent start with an underscore."""

    def __init__(self, model: Model) -> None:
        self.model, self.mesh = model, model.mesh
        self._sets: list[str] = []
        self._invented = 0
        self._materials: dict[int, str] = {}
        self._edges: list[tuple[Ints, str]] = []  # surfaces that had to be invented

    def cards(self) -> Iterator[str]:
        model = self.model
        self._refuse()
        # The steps come first here since they may need sets of their own.
        steps = model.steps or ([Static()] if model.loads else [])
        tail = [*self._materials_and_sections(), *self._tables(), *contact_cards(self)]
        tail += initial_cards(self, model)
        tail += _boundary(self, model.supports, False)
        for number, step in enumerate(steps):
            own = applied(model.loads, model.mesh)
            again = [x for x in own if number == 0 or step.renews(kind_of(x))]
            loads = again + applied(step.loads, model.mesh)
            tail += self._step(step, loads, number)
        yield f"*HEADING\n{model.title or model.name}\n"
        if model.unit_system:
            yield f"** UNITS: {model.unit_system}\n"
        yield from self._mesh()
        yield from self._sets
        yield from tail

    def _refuse(self) -> None:
        """Say what of the model no card here can hold, instead of leaving it out."""
        model = self.model
        for name, what in _UNWRITTEN.items():
            if getattr(model, name):
                raise UnsupportedError(f"{what} cannot be written to a deck: keep them in Python")

    def _mesh(self) -> Iterator[str]:
        mesh = self.mesh
        yield "*NODE\n"
        for label, (x, y) in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True):
            yield f"{label}, {_number(x)}, {_number(y)}\n"
        names = np.full(mesh.n_cells, "", dtype="U8")
        for section in self.model.sections:
            names[cells_of(mesh, self._cells(section.cells))] = section.element
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
        for section in self.model.sections:
            if section.element in LINE_TYPES:
                spring = section.element.startswith("SPRING")
                name = "" if spring else self._material(section.material, lines)
                lines.append(line_cards(section, self.cell_set(section.cells), name))
                continue
            name = self._material(section.material, lines)
            options = f"ELSET={self.cell_set(section.cells)}, MATERIAL={name}"
            if section.plane == "strain":
                options += ", PLANE=STRAIN"
            if section.local_strain != "linear":
                options += f", LOCAL STRAIN={section.local_strain.replace('_', ' ').upper()}"
            if section.mean_dilatation:
                options += ", DILATATION=MEAN"
            if section.beta0 is not None:
                options += f", BETA0={_number(section.beta0)}"
            if section.orientation != 0.0:
                angle = section.orientation
                if angle not in angles:
                    angles[angle] = f"AXES{len(angles) + 1}"
                    c, s = math.cos(angle), math.sin(angle)
                    lines.append(
                        f"*ORIENTATION, NAME={angles[angle]}\n{_number(c)}, {_number(s)}, 0., "
                    )
                    lines.append(f"{_number(-s)}, {_number(c)}, 0.\n")
                options += f", ORIENTATION={angles[angle]}"
            lines.append(f"*SOLID SECTION, {options}\n{_number(section.thickness)}\n")
        return lines

    def _material(self, material: Material, lines: list[str]) -> str:
        for other, name in self._materials.items():
            if self.model.sections[other].material == material:
                return name
        index = next(i for i, s in enumerate(self.model.sections) if s.material is material)
        name = _plain(material.name or f"material {len(self._materials) + 1}")
        while name in self._materials.values():
            name += "_"
        self._materials[index] = name
        law = law_cards(material, _number)
        if law is None:
            raise UnsupportedError(
                f"a material of type {type(material).__name__} cannot be written to a deck"
            )
        lines.append(f"*MATERIAL, NAME={name}\n{law}")
        lines.append(expansion_cards(material))
        if material.rho:
            lines.append(f"*DENSITY\n{_number(material.rho)}\n")
        return name

    def _tables(self) -> Iterator[str]:
        for name, table in self.model.amplitudes.items():
            total = ", TIME=TOTAL TIME" if table.total_time else ""
            yield f"*AMPLITUDE, NAME={_plain(name)}{total}\n"
            for time, value in zip(table.time.tolist(), table.value.tolist(), strict=True):
                yield f"{_number(time)}, {_number(value)}\n"
        for name, times in self.model.time_points.items():
            yield f"*TIME POINTS, NAME={_plain(name)}\n"
            yield "".join(f"{_number(time)}\n" for time in times.tolist())

    def _step(self, step: Step, loads: list[AppliedLoad], number: int) -> Iterator[str]:
        if type(step) is not Static:
            raise UnsupportedError(
                f"step {number + 1}: {type(step).__name__} cannot be written to a deck"
            )
        for name, default in (("path", None), ("at_limit", "stop"), ("plastic_increment", 0.0)):
            if getattr(step, name) != default:
                raise UnsupportedError(
                    f"step {number + 1}: {name} of Static cannot be written to a deck: leave it "
                    "out, or keep the model in Python"
                )
        if step.tolerance > 1e-9:
            raise UnsupportedError(
                f"step {number + 1}: a tolerance of {step.tolerance:g} cannot be written to a "
                "deck, whose steps take 1e-9 or a tighter one"
            )
        options = ", NLGEOM" if step.nlgeom else ", NLGEOM=NO"
        options += f", INC={step.max_increments}" + ("" if step.ramp else ", AMPLITUDE=STEP")
        yield f"*STEP{options}\n{_controls(step)}"
        yield f"*STATIC{', DIRECT' if step.fixed_increments else ''}\n"
        yield f"{_number(step.first_increment)}, {_number(step.period)}, "
        yield f"{_number(step.smallest_increment)}, {_number(step.largest_increment)}\n"
        yield from step_cards(self, number + 1)
        yield from _boundary(self, step.supports, step.new_supports)
        for kind, card in _NEW.items():
            if step.renews(kind):
                yield f"*{card}, OP=NEW\n"
        for load in loads:
            yield from self._load(load)
        for request in step.outputs:
            yield f"*{request.kind.upper()}"
            if request.kind == "contact print" and request.where:
                pairs = {p.name: p for p in self.model.contacts}
                slave, master = surfaces(self, pairs[request.where])
                yield f", SLAVE={slave}, MASTER={master}"
            elif request.where:
                yield f", {'N' if 'node' in request.kind else 'EL'}SET={_plain(request.where)}"
            if request.frequency != 1:
                yield f", FREQUENCY={request.frequency}"
            if request.totals != "no":
                yield f", TOTALS={request.totals.upper()}"
            if request.time_points:
                yield f", TIME POINTS={_plain(request.time_points)}"
            yield "\n" + ", ".join(request.variables) + "\n"
        yield "*END STEP\n"

    def _load(self, load: AppliedLoad) -> Iterator[str]:
        option = f", AMPLITUDE={_plain(load.amplitude)}" if load.amplitude else ""
        if isinstance(load, NodalForce):
            yield f"*CLOAD{', FOLLOWER' if load.follower else ''}{option}\n"
            if np.ndim(load.value):  # a value for each node
                labels = self.mesh.node_labels[self.mesh.node_indices(load.nodes)].tolist()
                rows = list(zip(map(str, labels), np.asarray(load.value).tolist(), strict=True))
            else:
                rows = [(target, float(load.value)) for target in self.nodes(load.nodes)]
            for target, value in rows:
                yield f"{target}, {_dof(load.dof)}, {_number(value)}\n"
        elif isinstance(load, EdgeLoad):
            name = self.edge_set(load.edges)
            if load.kind == "pressure":
                yield f"*DSLOAD{option}\n{name}, P, {_number(load.value[0])}\n"
                return
            if load.kind == "shear":
                yield from self._shear(load, name, option)
                return
            x, y = load.value
            size = math.hypot(x, y)
            if size == 0.0:
                return
            force = size / self._area(load.edges) if load.total else size
            dead = "" if load.kind == "following traction" else ", FOLLOWER=NO"
            yield f"*DSLOAD{dead}{option}\n"
            yield f"{name}, TRVEC, {_number(force)}, {_number(x / size)}, {_number(y / size)}\n"
        elif isinstance(load, Temperature):
            yield f"*TEMPERATURE{option}\n" + temperatures(self, load.nodes, load.value)
        elif isinstance(load, BodyForce):
            yield f"*DLOAD{option}\n" + self._body(load)

    def _shear(self, load: EdgeLoad, name: str, option: str) -> Iterator[str]:
        """A shear along edges: they must have a direction in common, which the card names."""
        edges = self.mesh.edge_pairs(load.edges)
        ends = np.array([nodes[:2] for nodes in self.mesh.edge_nodes(edges)])
        along = self.mesh.points[ends[:, 1]] - self.mesh.points[ends[:, 0]]
        mean = (along / np.linalg.norm(along, axis=1, keepdims=True)).sum(axis=0)
        if (along @ mean <= 1e-6 * np.linalg.norm(along, axis=1) * len(along)).any():
            raise InputError(
                f"the edges of {name} have no direction in common: give the shear of each side "
                "apart to write it to a deck"
            )
        x, y = (mean / np.linalg.norm(mean)).tolist()
        yield f"*DSLOAD{option}\n{name}, TRSHR, "
        yield f"{_number(load.value[0])}, {_number(x)}, {_number(y)}\n"

    def _body(self, load: BodyForce) -> str:
        where = self.cell_set(load.cells)
        if load.kind == "centrifugal":
            square, x, y = load.value
            return (
                f"{where}, CENTRIF, {_number(square)}, {_number(x)}, {_number(y)}, 0., 0., 0., 1.\n"
            )
        along = load.axis
        if along is None:
            return ""
        size = math.hypot(*load.value)
        if load.direction:
            size = math.copysign(size, float(along @ load.value))
        x, y = along.tolist()
        return f"{where}, GRAV, {_number(size)}, {_number(x)}, {_number(y)}, 0.\n"

    def nodes(self, where: str | Ints) -> list[str]:
        """Targets of a support or nodal force: a set, or node numbers."""
        if not isinstance(where, str):
            return [str(label) for label in self.mesh.node_labels[where].tolist()]
        if where in self.mesh.node_sets:
            return [_plain(where)]
        return [self._invent("NSET", self.mesh.node_labels[self.mesh.nodes_of(where)])]

    def _cells(self, where: str | Ints) -> str | Ints:
        """Cells of a section: all are the planar ones, where there are lines too."""
        blocks = list(zip(self.mesh.offsets, self.mesh.cells, strict=False))
        planar = [o + np.arange(len(c)) for o, c in blocks if EDGES[c.kind]]
        named = not isinstance(where, str) or (where or "all") in self.mesh.cell_sets
        if named or len(planar) == len(blocks) or not planar:
            return where
        return np.concatenate(planar)

    def cell_set(self, where: str | Ints) -> str:
        """Name of an element set, invented for an array."""
        where = self._cells(where)
        if isinstance(where, str):
            return _plain(where or "all")
        for name, cells in self.mesh.cell_sets.items():
            if np.array_equal(np.sort(cells), np.sort(where)):
                return _plain(name)
        return self._invent("ELSET", self.mesh.cell_labels[where])

    def edge_set(self, where: str | Ints) -> str:
        """Name of a surface, invented for an array."""
        if isinstance(where, str):
            return _plain(where)
        for edges, name in [*((e, n) for n, e in self.mesh.edge_sets.items()), *self._edges]:
            if np.array_equal(edges, where):
                return _plain(name)
        self._invented += 1
        self._sets.append(_surface(self.mesh, f"_{self._invented}", where))
        self._edges.append((where, f"_{self._invented}"))
        return f"_{self._invented}"

    def _invent(self, kind: str, labels: Ints) -> str:
        self._invented += 1
        self._sets.append(_set(kind, f"_{self._invented}", labels))
        return f"_{self._invented}"

    def _area(self, where: str | Ints) -> float:
        edges = self.mesh.edge_sets[where] if isinstance(where, str) else where
        thickness = np.ones(self.mesh.n_cells)
        for section in self.model.sections:
            thickness[cells_of(self.mesh, section.cells)] = section.thickness
        area = 0.0
        for (cell, _), nodes in zip(edges, self.mesh.edge_nodes(edges), strict=True):
            if len(nodes) == 3:
                a, b, m = self.mesh.points[nodes]
                if np.abs(2 * m - a - b).max() > 1e-9 * np.abs(b - a).max():
                    raise InputError("a total force on a curved edge cannot be written to a deck")
            ends = self.mesh.points[nodes[:2]]
            area += thickness[cell] * math.dist(ends[0], ends[1])
        return area


def _boundary(writer: _Writer, supports: list[Fixed], new: bool) -> Iterator[str]:
    if new:
        yield "*BOUNDARY, OP=NEW\n"
    for (amplitude, keep), group in groupby(supports, key=lambda s: (s.amplitude, s.keep)):
        option = f", AMPLITUDE={_plain(amplitude)}" if amplitude else ""
        option += ", FIXED" if keep else ""
        yield f"*BOUNDARY{option}\n"
        for support in group:
            dof = _dof(support.dof)
            for target in writer.nodes(support.nodes):
                yield f"{target}, {dof}, {dof}, {_number(support.value)}\n"


def _controls(step: Static) -> str:
    """Tolerance and iterations; they hold until the next card, so every step says its own."""
    text = "*CONTROLS, RESET\n"
    if step.tolerance != 1e-9:
        text += f"*CONTROLS, PARAMETERS=FIELD\n{_number(step.tolerance)},\n"
    if step.max_iterations != 16:
        text += f"*CONTROLS, PARAMETERS=TIME INCREMENTATION\n, , , , {step.max_iterations}\n"
    return text


def _number(value: float) -> str:
    """Shortest text that reads back to the same number."""
    return repr(float(value))


def _dof(dof: int) -> int:
    return (1, 2, 6)[dof]


def _surface(mesh: Mesh, name: str, edges: Ints) -> str:
    labels = mesh.cell_labels
    rows = "".join(f"{labels[cell]}, S{side + 1}\n" for cell, side in edges.tolist())
    return f"*SURFACE, NAME={_plain(name)}\n{rows}" if rows else ""


def _set(kind: str, name: str, labels: Ints) -> str:
    return f"*{kind}, {kind}={_plain(name)}\n" + "".join(_rows(labels.tolist()))


def _rows(numbers: Iterable[int]) -> Iterator[str]:
    row = [str(number) for number in numbers]
    for start in range(0, len(row), PER_LINE):
        yield ", ".join(row[start : start + PER_LINE]) + "\n"


def _plain(name: str) -> str:
    """Name that a deck can hold; one that starts with a digit would be read as a number."""
    text = re.sub(r"[\s,=*\"]+", "_", name)
    return f"_{text}" if re.match(r"[-+.\d]", text) else text
