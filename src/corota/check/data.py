"""Counts, unused sets, steps and loads without effect."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import Diagnostic
from corota.mesh.parts import cells_of
from corota.model.joints import constrained_nodes
from corota.model.loads import AppliedLoad, BodyForce, EdgeLoad, NodalForce, Temperature, applied
from corota.model.rotations import reference_nodes, rotating_nodes, without_rotation

if TYPE_CHECKING:
    from corota.model.model import Model


def check_data(model: Model) -> list[Diagnostic]:
    """Findings about the model's lists."""
    mesh = model.mesh
    kinds = ", ".join(f"{len(c)} {c.kind}" for c in mesh.cells) or "no cells"
    found = [Diagnostic("note", f"{mesh.n_nodes} nodes, {kinds}, {len(model.steps)} steps")]
    every = [*model.loads, *(load for step in model.steps for load in step.loads)]
    loads = applied(every, mesh)
    found += _effects(model, loads)
    found += _unused(model, loads)
    found += _rotations(model)
    for number, step in enumerate(model.steps, start=1):
        moved = any(s.value != 0.0 for s in model.supports + step.supports)
        later = number > 1
        moving = step.procedure.startswith("dynamic") and model.velocities
        if not (moved or moving or later or step.loads or model.loads):
            found.append(
                Diagnostic("warning", f"step {number}: no load and no moving support", step.where)
            )
        if step.procedure.startswith("dynamic"):
            found += [
                Diagnostic(
                    "error",
                    f"step {number}: material {s.material.name} has no density",
                    s.where,
                    hint="give *DENSITY (rho=)",
                )
                for s in model.sections
                if s.material.rho == 0.0
            ]
    return found


def _rotations(model: Model) -> list[Diagnostic]:
    """Rotations that are supported in Python at nodes without one; decks often have dofs 1 to 6."""
    supports = [*model.supports, *(s for step in model.steps for s in step.supports)]
    rotations = [s for s in supports if s.dof == 2 and s.where is None]
    if not rotations or not model.sections:
        return []
    has = rotating_nodes(model)
    has[reference_nodes(model)] = True
    idle = [s for s in rotations if not has[model.mesh.node_indices(s.nodes)].any()]
    return [Diagnostic("warning", without_rotation(model.mesh, s)) for s in idle]


def _effects(model: Model, loads: list[AppliedLoad]) -> list[Diagnostic]:
    found = []
    mesh = model.mesh
    bare = ~constrained_nodes(model)
    for block in mesh.cells:
        bare[block.nodes] = False
    light = np.zeros(mesh.n_cells, bool)
    for section in model.sections:
        if section.material.rho == 0.0:
            light[cells_of(mesh, section.cells)] = True
    for load in loads:
        if isinstance(load, NodalForce):
            nodes = mesh.nodes_of(load.nodes) if isinstance(load.nodes, str) else load.nodes
            lost = nodes[bare[nodes]]
            if len(lost):
                found.append(
                    Diagnostic(
                        "error",
                        f"node {mesh.node_labels[lost[0]]} is loaded and belongs to no cell",
                        load.where,
                    )
                )
        elif isinstance(load, BodyForce) and load.kind in ("gravity", "centrifugal"):
            cells = cells_of(mesh, load.cells)
            if len(cells) and light[cells].any():
                label = mesh.cell_labels[cells[light[cells]][0]]
                found.append(
                    Diagnostic(
                        "error",
                        f"{load.kind} acts on element {label}, whose material has no density",
                        load.where,
                        hint="give *DENSITY (rho=)",
                    )
                )
    return found


def _unused(model: Model, loads: list[AppliedLoad]) -> list[Diagnostic]:
    used: set[str] = set()

    def use(where: object) -> None:
        if isinstance(where, str):
            used.add(where)

    for section in model.sections:
        use(section.cells)
    for support in model.supports + [s for step in model.steps for s in step.supports]:
        use(support.nodes)
    for load in loads:
        if isinstance(load, NodalForce | Temperature):
            use(load.nodes)
        elif isinstance(load, EdgeLoad):
            use(load.edges)
        else:
            use(load.cells)
    for pair in model.contacts:
        use(pair.slave)
        use(pair.master)
    for tie in model.ties:
        use(tie.slave)
        use(tie.master)
    for constraint in model.constraints:
        use(getattr(constraint, "nodes", None))
    for axes in model.axes:
        use(axes.nodes)
    for mass in model.point_masses:
        use(mass.nodes)
    for velocity in model.velocities:
        use(velocity.nodes)
    for start in model.initial_temperatures:
        use(start.nodes)
    for stress in model.initial_stresses:
        use(stress.cells)
    for stage in model.stages:
        use(stage.nodes)
        use(stage.against)
    for step in model.steps:
        for request in step.outputs:
            use(request.where)
    mesh = model.mesh
    names = dict.fromkeys([*mesh.node_sets, *mesh.cell_sets, *mesh.edge_sets])
    idle = [name for name in names if name not in used and name != "all"]
    if not idle:
        return []
    shown = ", ".join(idle[:8]) + (f" and {len(idle) - 8} more" if len(idle) > 8 else "")
    return [Diagnostic("note", f"unused sets: {shown}")]
