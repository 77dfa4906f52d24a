"""A model in a few lines of text."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model import elements
from corota.model.constraints import Coupling
from corota.model.contact import RigidCurve
from corota.model.friction import described
from corota.model.material_table import MaterialTable
from corota.model.steps import listed_steps

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from corota.model.loads import Fixed
    from corota.model.materials import Material
    from corota.model.model import Model
    from corota.model.sections import Section
    from corota.model.steps import Step


def model_lines(model: Model, steps: Step | Sequence[Step] | None = None) -> list[str]:
    """Counts, extent, sets, sections and steps of a model, its own by default."""
    steps = model.steps if steps is None else listed_steps(steps)
    mesh = model.mesh
    lines = [f"{model.name}: {mesh.n_nodes:,} nodes, {mesh.n_cells:,} elements"]
    kinds: dict[str, int] = {}
    for cells in mesh.cells:
        kinds[cells.kind] = kinds.get(cells.kind, 0) + len(cells)
    lines += [f"  {count:>10,} {kind}" for kind, count in kinds.items()]
    if mesh.n_nodes:
        low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
        lines.append(f"  x {low[0]:g} ... {high[0]:g}, y {low[1]:g} ... {high[1]:g}")
    for kind in ("node", "cell", "edge"):
        sets = getattr(mesh, f"{kind}_sets")
        if sets:
            lines.append(f"{'element' if kind == 'cell' else kind} sets")
            lines += [f"  {len(members):>10,} {name}" for name, members in sets.items()]
    if model.sections:
        lines.append("sections")
    for section in model.sections:
        where = (
            section.cells if isinstance(section.cells, str) else f"{len(section.cells)} elements"
        )
        material = section.material.name or type(section.material).__name__
        solid = not elements.find(section.element).line
        strain = f"{str(section.local_strain).replace('_', '-')} strain, " if solid else ""
        lines.append(
            f"  {where or 'all'}: {section.element}, plane {section.plane}, {material}, {strain}"
            f"thickness {_thickness(section)}"
        )
    lines += material_lines(model) + joint_lines(model) + support_lines(model, model.supports)
    for number, step in enumerate(steps, 1):
        geometry = "nonlinear" if step.nlgeom else "linear"
        lines.append(
            f"step {number}: {step.procedure}, geometrically {geometry}, period {step.period:g}, "
            f"{len(step.supports) + len(model.supports)} supports, "
            f"{len(step.loads) + len(model.loads)} loads"
        )
        lines += support_lines(model, step.supports)
    if not steps and (model.supports or model.loads):
        lines.append(f"{len(model.supports)} supports, {len(model.loads)} loads, no step yet")
    return lines


def material_lines(model: Model) -> list[str]:
    """Materials with their constants and curves."""
    lines = []
    for whole in {id(s.material): s.material for s in model.sections}.values():
        rows = whole.table if isinstance(whole, MaterialTable) else [(None, whole)]
        for temperature, material in rows:
            at = "" if temperature is None else f" at {temperature:g}"
            name = f"{whole.name or 'unnamed'}{at}"
            lines.append(f"  {name}: {', '.join(_constants(material))}")
    return ["materials", *lines] if lines else []


def _constants(material: Material) -> list[str]:
    shown = [type(material).__name__]
    for name in ("E", "nu", "E1", "E2", "nu12", "G12", "rho"):
        value = getattr(material, name, None)
        if isinstance(value, (int, float)) and not (name == "rho" and value == 0.0):
            shown.append(f"{name} {value:g}")
    curve = getattr(material, "yield_curve", None)
    if curve is not None:
        first, last = curve[0], curve[-1]
        shown.append(
            f"yield stress {first[0]:g} to {last[0]:g} at plastic strain {last[1]:g} "
            f"({len(curve)} points)"
        )
    elif getattr(material, "yield_stress", None) is not None:
        shown.append(f"yield stress {material.yield_stress:g}")  # type: ignore[attr-defined]
    for name in ("kinematic", "chaboche"):
        value = getattr(material, name, None)
        if value:
            shown.append(f"{name} {value if isinstance(value, float) else len(value)}")
    return shown


def joint_lines(model: Model) -> list[str]:
    """Contact pairs, ties, rigid bodies, couplings, equations, stages."""
    lines = []
    for pair in model.contacts:
        law = pair.law.kind if pair.law is not None else "hard"
        lines.append(
            f"contact {_named(pair.slave)} on {_named(pair.master)}: {pair.method}, {law}, "
            f"friction {described(pair.friction)}"
            + "".join(f", {described(mu)} from step {n}" for n, mu in pair.friction_steps.items())
            + (f" up to {pair.shear_limit:g}" if pair.shear_limit is not None else "")
            + ("" if pair.separates else ", no separation")
            + ("" if pair.steps is None else f", in steps {', '.join(map(str, pair.steps))}")
        )
    lines += [f"tie {_named(tie.slave)} to {_named(tie.master)}" for tie in model.ties]
    counts: dict[str, int] = {}
    for constraint in model.constraints:
        if isinstance(constraint, Coupling):
            nodes = constraint.nodes
            count = len(model.mesh.nodes_of(nodes) if isinstance(nodes, str) else nodes)
            label = model.mesh.node_labels[constraint.reference]
            what = constraint.name or f"{constraint.kind} coupling"
            lines.append(f"{what}: {count} nodes, reference node {label}")
        else:
            name = type(constraint).__name__.lower()
            counts[name] = counts.get(name, 0) + 1
    lines += [f"constraints: {count} {name}" for name, count in counts.items()]
    lines += [f"stage {stage.name}: axis {stage.axis}" for stage in model.stages]
    return lines


def support_lines(model: Model, supports: Iterable[Fixed]) -> list[str]:
    """Directions that each support fixes or moves, up to ten places."""
    found: dict[str, list[str]] = {}
    for support in supports:
        where = support.nodes
        if not isinstance(where, str):
            nodes = model.mesh.node_indices(where)
            label = f"node {model.mesh.node_labels[nodes[0]]}" if len(nodes) else "no node"
            where = label if len(nodes) == 1 else f"{len(nodes)} nodes from {label}"
        amplitude = f" by {support.amplitude}" if support.amplitude else ""
        direction = ("x", "y", "rotation")[support.dof]
        implied = f" (fixed as well: {direction}=None leaves it free)" * support.implied
        value = "free" if support.free else f"{support.value:g}{amplitude}{implied}"
        found.setdefault(where, []).append(f"{direction} {value}")
    lines = [f"  support {where}: {', '.join(what)}" for where, what in list(found.items())[:10]]
    return lines + ([f"  and {len(found) - 10} more supports"] if len(found) > 10 else [])


def _thickness(section: Section) -> str:
    nodal = section.nodal_thickness
    if nodal is None:
        return f"{section.thickness:g}"
    known = nodal[np.isfinite(nodal)]
    return f"{known.min(initial=np.inf):g} to {known.max(initial=0.0):g}"


def _named(where: object) -> str:
    name = where if isinstance(where, str) else getattr(where, "name", "")
    return str(name) or ("rigid curve" if isinstance(where, RigidCurve) else "edges")
