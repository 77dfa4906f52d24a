"""Reading a written deck again and comparing it with the model: nothing may be lost."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import tempfile
import warnings
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from corota.errors import CorotaError, UnsupportedError
from corota.io.deck.write.attachments import dampers
from corota.io.deck.write.loads import edge_area
from corota.io.deck.write.text import Writer
from corota.mesh.parts import cells_of
from corota.model.constraints import Coupling, Equation
from corota.model.contact import RigidCurve, edges_or_nodes
from corota.model.loads import BodyForce, EdgeLoad, NodalForce, Temperature, applied
from corota.model.material_table import MaterialTable
from corota.model.materials import Expansion
from corota.model.single_point import LawOfTheCore

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from corota.mesh.data import Mesh
    from corota.model.loads import AppliedLoad, Fixed
    from corota.model.materials import Material
    from corota.model.model import Model
    from corota.model.sections import Section
    from corota.model.stages import Stage
    from corota.model.steps import Step

#: Relative difference of numbers that counts as rounding of a changed form, such as a size and
#: a direction for two components.
ROUNDING = 1e-9
#: Strain of the path that compares plastic laws, in strains at first yield.
PAST_YIELD = 20.0
#: Fields of sections that are compared elsewhere or not at all.
_ELSEWHERE = ("cells", "where", "material", "thickness", "nodal_thickness", "fiber")


@dataclass
class Written:
    """A step, and the loads and supports that its cards stand for."""

    step: Step
    loads: list[AppliedLoad]
    supports: list[Fixed]


class DeckWriter(Writer, Protocol):
    """Writer that knows what it has written."""

    written: list[Written]


def refuse_loss(writer: DeckWriter, text: str) -> None:
    """Read the text of a deck and compare it with what was to be written.

    Raises
    ------
    UnsupportedError
        Naming the first thing that differs.
    """
    from corota.io.deck.read import read_deck

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder) / "written.inp"
        path.write_text(text, encoding="utf-8")
        try:
            again = read_deck(path)
        except CorotaError as error:
            raise UnsupportedError(
                f"the deck of this model could not be read again: {error}; keep the model in Python"
            ) from error
    one, two = _content(writer), _read_content(writer, again)
    for name in dict.fromkeys([*one, *two]):
        if not _equal(one.get(name), two.get(name)):
            raise UnsupportedError(
                f"{name} would not be the same after reading the deck again "
                f"({_short(one.get(name))} in the model, {_short(two.get(name))} in the deck): "
                "keep the model in Python"
            )


def _content(writer: DeckWriter) -> dict[str, Any]:
    """What a writer was to write, by names for messages."""
    model = writer.model
    found = _model(model)
    _add_steps(found, writer, model, writer.written)
    return found


def _read_content(writer: DeckWriter, again: Model) -> dict[str, Any]:
    found = _model(again)
    steps = [Written(s, applied(s.loads, again.mesh), list(s.supports)) for s in again.steps]
    _add_steps(found, writer, again, steps)
    return found


def _stage(mesh: Mesh, stage: Stage) -> tuple[Any, ...]:
    against = None if stage.against is None else sorted(mesh.node_indices(stage.against).tolist())
    nodes, place = sorted(mesh.node_indices(stage.nodes).tolist()), stage.place(mesh).tolist()
    values = {key: np.ravel(value).tolist() for key, value in stage.allowable.items()}
    more = (stage.name, stage.direction.tolist(), stage.input, stage.stiffness)
    return (nodes, place, against, values, *more)


def _model(model: Model) -> dict[str, Any]:
    mesh = model.mesh
    found: dict[str, Any] = {
        "the numbers of nodes": mesh.node_labels,
        "the coordinates": mesh.points,
        "the elements": dict(_cells(mesh)),
    }
    found |= {f"the section of element {label}": v for label, v in _sections(model)}
    for name, items in (
        ("ties", [_tie(mesh, tie) for tie in model.ties]),
        ("contact pairs", [_pair(mesh, pair) for pair in model.contacts]),
    ):
        found[f"the number of {name}"] = len(items)
        for number, item in enumerate(items, start=1):
            found[f"number {number} of the {name}"] = item
    found["the point masses"] = _summed(
        (int(n), mass.mass) for mass in model.point_masses for n in mesh.node_indices(mass.nodes)
    )
    found["the constraints"] = _constraints(model)
    found["the stages"] = [_stage(mesh, stage) for stage in model.stages]
    found["the dashpots"] = [
        (d.first, d.second, places, c, d.table) for d in model.dashpots for places, c in dampers(d)
    ]
    found["the initial temperatures"] = _nodal(mesh, model.initial_temperatures)
    found["the initial stresses"] = dict(_stresses(model))
    found["the initial velocities"] = _velocities(model)
    return found


def _add_steps(
    found: dict[str, Any], writer: DeckWriter, model: Model, steps: list[Written]
) -> None:
    found["the number of steps"] = len(steps)
    acting: dict[tuple[int, int], Any] = {}
    for number, written in enumerate(steps, start=1):
        of = f"of step {number}"
        step = written.step
        found[f"the procedure {of}"] = type(step).__name__
        if number == 1 or step.new_supports:
            acting = _supports(model.mesh, model.supports)
        acting = acting | _supports(model.mesh, written.supports)
        found[f"the supports {of}"] = acting
        for key, values in _loads(writer, model, written.loads).items():
            found[f"{key} {of}"] = values
        for item in ("nlgeom", "period", "fixed_increments", "new_supports", "ramp"):
            found[f"{item} {of}"] = getattr(step, item, None)
        rayleigh = getattr(step, "rayleigh", None)
        if rayleigh is not None:
            # Damping that all materials share may stand in the step.
            found[f"damping {of}"] = [np.add(rayleigh, damping) for damping in _damping(model)]


def _cells(mesh: Mesh) -> Iterator[tuple[int, tuple[str, tuple[int, ...]]]]:
    for block in mesh.cells:
        if block.kind == "point1" and not len(block):
            continue
        for label, row in zip(block.labels.tolist(), block.nodes.tolist(), strict=True):
            yield label, (block.kind, tuple(mesh.node_labels[row].tolist()))


def _sections(model: Model) -> Iterator[tuple[int, Any]]:
    """Section of the first cell of each run of cells with the same one."""
    owner = np.full(model.mesh.n_cells, -1)
    for number, section in enumerate(model.sections):
        owner[cells_of(model.mesh, section.cells)] = number
    known = [_section(model, s) for s in model.sections]
    for cell, number in enumerate(owner.tolist()):
        if number >= 0:
            section = model.sections[number]
            nodal = section.nodal_thickness
            thickness: Any = section.thickness
            if nodal is not None:
                block, row = model.mesh.locate(cell)
                thickness = nodal[model.mesh.cells[block].nodes[row]]
            yield int(model.mesh.cell_labels[cell]), (known[number], thickness)


def _section(model: Model, section: Section) -> dict[str, Any]:
    found = {f.name: getattr(section, f.name) for f in fields(section) if f.name not in _ELSEWHERE}
    line = section.element in ("BEAM", "TRUSS") or section.element.startswith("SPRING")
    if line:
        # Lines have neither plane nor local strain; a general section has its own material.
        for name in ("plane", "local_strain", "orientation"):
            del found[name]
        if section.material.linear:
            # An elastic beam is known by its numbers.
            del found["fibers"]
    if section.element.startswith("SPRING"):
        return found
    material = _material(section.material)
    if line and not section.profile[2]:
        # Without shear deformation Poisson's ratio has no effect.
        material["nu"] = None
    return found | {"material": material}


def _material(material: Material) -> dict[str, Any]:
    """What a material does."""
    expansion = Expansion.of(material.expansion)
    found: dict[str, Any] = {
        "expansion": (list(expansion.alpha), expansion.zero, list(expansion.temperature)),
        "rho": material.rho,
    }
    if not isinstance(material, MaterialTable):
        return found | _law(material)
    laws = [(t, _law(m) | {"rho": m.rho * material.density_varies}) for t, m in material.table]
    return found | {"table": laws}


def _law(material: Material) -> dict[str, Any]:
    """Constants; of a law with plastic flow the stress on a path far past yield."""
    if isinstance(material, LawOfTheCore):
        top = PAST_YIELD * material.first_yield / material.E
        way = np.concatenate([np.linspace(0.0, top, 20), np.linspace(top, -top, 40)])
        path = way[:, None] * np.array([1.0, -0.4, 0.3])
        return {"stress": material.respond(path, "strain")["stress"]}
    skipped = ("name", "where", "rayleigh", "expansion", "rho")
    every = fields(material)
    return {f.name: getattr(material, f.name) for f in every if f.name not in skipped}


def _damping(model: Model) -> list[tuple[float, float]]:
    """Damping of the materials, in the order of the cells."""
    first = [int(cells_of(model.mesh, s.cells)[:1].sum()) for s in model.sections]
    order = np.argsort(first, kind="stable").tolist()
    return [model.sections[i].material.rayleigh for i in order]


def _supports(mesh: Mesh, supports: Iterable[Fixed]) -> dict[tuple[int, int], Any]:
    found: dict[tuple[int, int], Any] = {}
    for support in supports:
        for node in mesh.node_indices(support.nodes).tolist():
            value = 0.0 if support.keep else support.value
            found[node, support.dof] = (value, support.amplitude, support.keep)
    return found


def _loads(writer: DeckWriter, model: Model, loads: Iterable[AppliedLoad]) -> dict[str, Any]:
    """Loads by kind and amplitude, summed for each node, edge or cell."""
    mesh = model.mesh
    found: dict[str, dict[Any, Any]] = {}

    def add(kind: str, at: Any, value: Any) -> None:
        table = found.setdefault(f"{kind}", {})
        table[at] = table.get(at, 0.0) + np.asarray(value, dtype=float)

    for load in loads:
        by = f" by {load.amplitude}" if load.amplitude else ""
        if isinstance(load, NodalForce):
            nodes = mesh.node_indices(load.nodes)
            values = np.broadcast_to(load.value, len(nodes))
            kind = "the follower force" if load.follower else "the force"
            for node, value in zip(nodes.tolist(), values.tolist(), strict=True):
                add(kind + by, (node, load.dof), value)
        elif isinstance(load, EdgeLoad):
            edges = mesh.edge_pairs(load.edges)
            share = 1.0 / edge_area(writer, load.edges) if load.total else 1.0
            for pair in edges.tolist():
                add(f"the {load.kind}{by}", tuple(pair), share * np.array(load.value))
        elif isinstance(load, BodyForce):
            more = load.value[1:] if load.kind == "centrifugal" else ()
            if load.kind == "gravity" and not any(load.value) and load.axis is not None:
                # Of size zero it ends the one of its direction.
                more = tuple(np.round(load.axis, 6).tolist())
            for cell in cells_of(mesh, load.cells).tolist():
                if load.kind in ("volume", "line"):
                    for axis in (0, 1):
                        if load.direction is None or load.direction[axis] != 0.0:
                            add(f"the {load.kind} load{by}", (cell, axis), load.value[axis])
                    continue
                value = load.value[:1] if load.kind == "centrifugal" else load.value
                add(f"the {load.kind}{by}", (cell, *more), value)
            for mass, nodes in load.point_masses(mesh, model.point_masses):
                value = load.value[:1] if load.kind == "centrifugal" else load.value
                for node in nodes.tolist():
                    at = ("mass", node, *more)
                    add(f"the {load.kind}{by}", at, mass.mass * np.array(value))
        elif isinstance(load, Temperature):
            for node, value in _nodal(mesh, [load]).items():
                found.setdefault(f"the temperature{by}", {})[node] = value
    return found


def _nodal(mesh: Mesh, items: Iterable[Any]) -> dict[int, float]:
    found: dict[int, float] = {}
    for item in items:
        every = isinstance(item.nodes, str) and not item.nodes
        nodes = np.arange(mesh.n_nodes) if every else mesh.node_indices(item.nodes)
        values = np.broadcast_to(np.asarray(item.value, dtype=float), len(nodes))
        found.update(zip(nodes.tolist(), values.tolist(), strict=True))
    return found


def _stresses(model: Model) -> Iterator[tuple[int, list[float]]]:
    mesh = model.mesh
    for item in model.initial_stresses:
        cells = np.arange(mesh.n_cells) if not len(item.cells) else cells_of(mesh, item.cells)
        columns = [np.broadcast_to(np.ravel(v), len(cells)) for v in item.value]
        yield from zip(cells.tolist(), np.stack(columns, axis=1).tolist(), strict=True)


def _velocities(model: Model) -> dict[tuple[int, int], float]:
    mesh = model.mesh
    found: dict[tuple[int, int], float] = {}
    for item in model.velocities:
        every = isinstance(item.nodes, str) and not item.nodes
        nodes = np.arange(mesh.n_nodes) if every else mesh.node_indices(item.nodes)
        for node in nodes.tolist():
            if item.dof is not None:
                found[node, item.dof] = item.value[0]
                continue
            vx, vy, spin, x0, y0 = (*item.value, 0.0, 0.0, 0.0)[:5]
            x, y = mesh.points[node]
            found[node, 0], found[node, 1] = vx - spin * (y - y0), vy + spin * (x - x0)
            if len(item.value) > 2:
                found[node, 2] = spin
    return {at: v for at, v in found.items() if v != 0.0}


def _constraints(model: Model) -> dict[str, Any]:
    """Constraints by kind; a kinematic one by node and dof, since cards may share it."""
    kinematic: set[tuple[int, int, int]] = set()
    straight: set[tuple[int, int, int]] = set()
    equations, means = [], []
    for item in model.constraints:
        if isinstance(item, Equation):
            equations.append(([tuple(t) for t in item.terms], item.rhs))
            continue
        nodes = sorted(model.mesh.node_indices(item.nodes).tolist())
        if not isinstance(item, Coupling):
            ends = (item.first, item.last)
            straight |= {(node, *ends) for node in nodes if node not in ends}
        elif item.kind == "kinematic":
            at = item.reference
            kinematic |= {(node, at, dof) for node in nodes if node != at for dof in item.dofs}
        else:
            weights = np.ones(len(nodes)) if item.weights is None else np.asarray(item.weights)
            means.append((nodes, item.reference, sorted(item.dofs), weights / weights.sum()))
    return {
        "equations": equations,
        "rigid": sorted(kinematic),
        "lines": sorted(straight),
        "means": means,
    }


def _side(mesh: Mesh, where: Any) -> Any:
    edges, nodes = edges_or_nodes(mesh, where)
    return sorted(nodes.tolist()) if len(nodes) else sorted(map(tuple, edges.tolist()))


def _tie(mesh: Mesh, tie: Any) -> Any:
    return [_side(mesh, side) for side in (tie.slave, tie.master)]


def _pair(mesh: Mesh, pair: Any) -> Any:
    law = pair.law and (pair.law.kind, pair.law.pressure, pair.law.overclosure)
    found: list[Any] = [pair.method, pair.friction, law, pair.clearance, pair.smooth]
    found += [pair.shear_limit, pair.separates, pair.steps]
    found += [pair.friction_steps, bool(pair.friction_steps) and pair.friction_ramps]
    for side in (pair.slave, pair.master):
        if isinstance(side, RigidCurve):
            # Arcs may be written in pieces.
            found.append(side.reference)
        else:
            found.append(_side(mesh, side))
    return found


def _summed(items: Iterable[tuple[Any, float]]) -> dict[Any, float]:
    found: dict[Any, float] = {}
    for at, value in items:
        found[at] = found.get(at, 0.0) + value
    return found


def _equal(one: Any, two: Any) -> bool:
    """Equality of nested data, numbers up to rounding."""
    if isinstance(one, dict) and isinstance(two, dict):
        return one.keys() == two.keys() and all(_equal(one[k], two[k]) for k in one)
    if isinstance(one, str) or isinstance(two, str) or one is None or two is None:
        return bool(one == two)
    if isinstance(one, list | tuple) and isinstance(two, list | tuple):
        return len(one) == len(two) and all(map(_equal, one, two))
    if np.ndim(one) or np.ndim(two):
        a, b = np.asarray(one), np.asarray(two)
        if a.shape != b.shape or a.dtype.kind not in "fiub" or b.dtype.kind not in "fiub":
            return a.shape == b.shape and bool((a == b).all())
        size = float(np.abs(np.nan_to_num(b)).max(initial=0.0))
        return bool(np.allclose(a, b, ROUNDING, ROUNDING * size, equal_nan=True))
    if isinstance(one, int | float) and isinstance(two, int | float):
        return math.isclose(one, two, rel_tol=ROUNDING, abs_tol=1e-300)
    return bool(one == two)


def _short(value: Any) -> str:
    text = "nothing" if value is None else str(value)
    return text if len(text) <= 300 else text[:297] + "..."
