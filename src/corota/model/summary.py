"""A model in a few lines of text."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from corota.model.model import Model


def model_lines(model: Model) -> list[str]:
    """Counts, extent, sets, sections and steps of a model."""
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
        lines.append(
            f"  {where or 'all'}: {section.element}, plane {section.plane}, {material}, "
            f"thickness {section.thickness:g}"
        )
    for number, step in enumerate(model.steps, 1):
        geometry = "nonlinear" if step.nlgeom else "linear"
        lines.append(
            f"step {number}: {step.procedure}, geometrically {geometry}, period {step.period:g}, "
            f"{len(step.supports) + len(model.supports)} supports, "
            f"{len(step.loads) + len(model.loads)} loads"
        )
    if not model.steps and (model.supports or model.loads):
        lines.append(f"{len(model.supports)} supports, {len(model.loads)} loads, no step yet")
    for pair in model.contacts:
        lines.append(f"contact {pair.name}")
    return lines
