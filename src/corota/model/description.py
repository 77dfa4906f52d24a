"""A model as plain data for reports, beside the mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import distinct
from corota.model import elements
from corota.model.constraints import Coupling
from corota.model.contact import RigidCurve
from corota.model.loads import BodyForce, EdgeLoad, Fixed, Load, NodalForce, applied
from corota.model.material_table import MaterialTable
from corota.model.plasticity import Mises, Voce
from corota.model.summary import joint_lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.materials import Material
    from corota.model.model import Model
    from corota.model.sections import Section
    from corota.model.steps import Step


#: Points of a curve that is drawn from a formula.
CURVE_POINTS = 61
#: Plastic strain up to which a hardening law without a table is drawn.
CURVE_STRAIN = 0.1
#: Fields of materials and steps that are omitted in tables.
HIDDEN = {"where", "name", "rows", "yield_curve", "supports", "loads", "outputs", "path"}


def describe(model: Model, steps: Sequence[Step] = ()) -> dict[str, Any]:
    """Describe sections, materials, supports, loads, constraints and steps.

    Parameters
    ----------
    model : Model
    steps : sequence of Step, optional
        Those that are run; the model's own by default.

    Returns
    -------
    dict
        Of lists, dicts, strings and numbers only. Nodes and cells are indices from 0; ``step``
        is 0 for entries of every step.
    """
    steps = list(steps) or model.steps
    materials = list({id(s.material): s.material for s in model.sections}.values())
    index = {id(m): i for i, m in enumerate(materials)}
    return {
        "title": model.title,
        "materials": [_material(m) for m in materials],
        "sections": [_section(s, index[id(s.material)], model) for s in model.sections],
        "supports": [
            _support(s, number, model) for number, of in _by_step(model, steps) for s in of.supports
        ],
        "loads": [
            found
            for number, of in _by_step(model, steps)
            for load in applied(of.loads, model.mesh)
            if (found := _load(load, number, model)) is not None
        ],
        "amplitudes": [
            {"name": name, "time": a.time.tolist(), "value": a.value.tolist()}
            for name, a in model.amplitudes.items()
        ],
        "masses": [
            {"nodes": _nodes(m.nodes, model), "mass": m.mass, "inertia": m.inertia}
            for m in model.point_masses
        ],
        "dashpots": [[d.first, -1 if d.second is None else d.second] for d in model.dashpots],
        "couplings": [
            {"nodes": _nodes(c.nodes, model), "reference": int(c.reference), "kind": c.kind}
            for c in model.constraints
            if isinstance(c, Coupling)
        ],
        "joints": joint_lines(model),
        "steps": [_step(s) for s in steps],
    }


def _by_step(model: Model, steps: Sequence[Step]) -> list[tuple[int, Any]]:
    return [(0, model), *enumerate(steps, 1)]


def _nodes(where: Any, model: Model) -> list[int]:
    return [int(n) for n in distinct(model.mesh.node_indices(where))]


def _named(where: Any, noun: str) -> str:
    return where if isinstance(where, str) else f"{len(where)} {noun}"


def _section(section: Section, material: int, model: Model) -> dict[str, Any]:
    found: dict[str, Any] = {
        "where": _named(section.cells, "elements") or "all",
        "element": section.element,
        "material": material,
        "line": elements.find(section.element).line,
        "plane": section.plane,
        "thickness": section.thickness,
        "local strain": section.local_strain,
    }
    if section.nodal_thickness is not None:
        found["thickness of nodes"] = [float(t) for t in section.nodal_thickness]
    if section.orientation:
        found["orientation"] = section.orientation
    if section.mean_dilatation:
        found["mean dilatation"] = True
    if any(section.profile):
        found["profile"] = [float(p) for p in section.profile]
    if section.height:
        found["height"] = section.height
    if section.table:
        found["curve"] = {
            "x": "elongation",
            "y": "force",
            "lines": {"spring": [[float(a), float(b)] for a, b in section.table]},
        }
    return found


def _material(material: Material) -> dict[str, Any]:
    """Constants by name, and the curve of hardening where there is one."""
    if isinstance(material, MaterialTable):
        return _table(material)
    constants: dict[str, Any] = {}
    if isinstance(material, Mises) and material.rate is not None:
        constants["rate"] = str(material.rate)
    for item in fields(material):
        value = getattr(material, item.name)
        if item.name in HIDDEN or not isinstance(value, int | float | tuple | list | Voce):
            continue
        if isinstance(value, int | float):
            if value or item.name == "nu":
                constants[item.name] = float(value)
        elif isinstance(value, Voce):
            constants[item.name] = f"Q {value.Q:g}, b {value.b:g}, H {value.H:g}"
        elif np.any(np.asarray(value, dtype=float)):
            constants[item.name] = " ".join(str(v) for v in value)
    found: dict[str, Any] = {
        "name": material.name,
        "type": type(material).__name__,
        "constants": constants,
    }
    if isinstance(material, Mises) and material.has_yield:
        found["curve"] = hardening(material)
    return found


def _table(material: MaterialTable) -> dict[str, Any]:
    """The same for a table: all values of constants that change, one curve per temperature."""
    rows = [(t, _material(m)) for t, m in material.table]
    constants: dict[str, Any] = {}
    for name in rows[0][1]["constants"]:
        values = [row["constants"].get(name, 0.0) for _, row in rows]
        same = all(v == values[0] for v in values)
        shown = ", ".join(f"{v} at {t:g}" for v, (t, _) in zip(values, rows, strict=True))
        constants[name] = values[0] if same else shown
    found: dict[str, Any] = {
        "name": material.name,
        "type": f"{type(material.first).__name__} by temperature",
        "constants": constants,
    }
    if all("curve" in row for _, row in rows):
        lines = {
            f"{name} at {t:g}": line
            for t, row in rows
            for name, line in row["curve"]["lines"].items()
        }
        found["curve"] = {"x": "plastic strain", "y": "stress", "lines": lines}
    return found


def hardening(material: Mises) -> dict[str, Any]:
    """Uniaxial stress against plastic strain under growing strain, and the isotropic part of it."""
    if material.yield_curve is not None:
        table = np.asarray(material.yield_curve, dtype=float)
        end = 1.05 * float(table[-1, 1]) or CURVE_STRAIN
        p = distinct(np.concatenate([table[:, 1], np.linspace(0.0, end, CURVE_POINTS)]))
        isotropic = np.interp(p, table[:, 1], table[:, 0])
    else:
        assert material.yield_stress is not None
        p = np.linspace(0.0, CURVE_STRAIN, CURVE_POINTS)
        law = material.isotropic
        if not isinstance(law, Voce):
            law = Voce(0.0, 0.0, float(law))
        isotropic = material.yield_stress + law.Q * -np.expm1(-law.b * p) + law.H * p
    lines = {"isotropic": np.stack([p, isotropic], axis=1).tolist()}
    back = np.zeros(len(p))
    for c, gamma in material.back_stresses:
        back += c * p if gamma == 0.0 else c / gamma * -np.expm1(-gamma * p)
    if back.any():
        lines["with back-stress"] = np.stack([p, isotropic + back], axis=1).tolist()
    return {"x": "plastic strain", "y": "stress", "lines": lines}


def _support(support: Fixed, step: int, model: Model) -> dict[str, Any]:
    return {
        "step": step,
        "where": _named(support.nodes, "nodes"),
        "dof": support.dof,
        "value": support.value,
        "free": support.free,
        "amplitude": support.amplitude,
        "nodes": _nodes(support.nodes, model),
    }


def _load(load: Load, step: int, model: Model) -> dict[str, Any] | None:
    found: dict[str, Any] = {"step": step, "amplitude": getattr(load, "amplitude", "")}
    if isinstance(load, NodalForce):
        values = np.atleast_1d(np.asarray(load.value, dtype=float))
        nodes = model.mesh.node_indices(load.nodes)
        if len(values) == 1:
            nodes = distinct(nodes)
        found |= {
            "kind": "moment" if load.dof == 2 else "force",
            "where": _named(load.nodes, "nodes"),
            "dof": load.dof,
            "value": values.tolist(),
            "nodes": [int(n) for n in nodes],
        }
    elif isinstance(load, EdgeLoad):
        pairs = model.mesh.edge_pairs(load.edges)
        found |= {
            "kind": load.kind,
            "where": _named(load.edges, "edges"),
            "total": load.total,
            "value": list(load.value),
            "edges": [[int(n) for n in ends[:2]] for ends in model.mesh.edge_nodes(pairs)],
        }
    elif isinstance(load, BodyForce):
        found |= {
            "kind": load.kind,
            "where": _named(load.cells, "elements") or "all",
            "value": list(load.value),
        }
    else:
        value = np.asarray(getattr(load, "value", 0.0), dtype=float)
        found |= {
            "kind": "temperature",
            "where": _named(getattr(load, "nodes", ""), "nodes") or "all",
            "value": [float(value.min()), float(value.max())] if value.size else [],
        }
    return found


def _step(step: Step) -> dict[str, Any]:
    found: dict[str, Any] = {"name": step.name, "procedure": step.procedure}
    for item in fields(step):
        value = getattr(step, item.name)
        if item.name in HIDDEN or item.name in found:
            continue
        if isinstance(value, bool | int | float | str) and value not in ("", 0):
            found[item.name] = value
    path = getattr(step, "path", None)
    if path is not None:
        found["path"] = str(path)
    return found


def rigid_curves(model: Model) -> list[dict[str, Any]]:
    """Segments of the rigid curves, each once, and the node that carries them or -1."""
    curves = {
        id(pair.master): pair.master
        for pair in model.contacts
        if isinstance(pair.master, RigidCurve)
    }
    return [
        {
            "segments": curve.segments.tolist(),
            "reference": int(curve.reference)
            if isinstance(curve.reference, int | np.integer)
            else -1,
        }
        for curve in curves.values()
    ]
