"""``corota info``: what is in a deck, a mesh or a result file."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.cli.reading import is_result, read_input

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.io.result_reader import FileResults
    from corota.model.model import Model


def run(args: Any, terminal: Terminal) -> int:
    """Describe a file."""
    if not is_result(args.file):
        model = read_input(args.file, args)
        for text in model_lines(model):
            terminal.line(text)
        for note in model.notes:
            terminal.line(f"note: {note}")
        terminal.record(model_record(model))
        return 0
    from corota.cli.run import profile_lines
    from corota.io.result_reader import read_results

    with read_results(args.file) as results:
        for text in model_lines(results.model):
            terminal.line(text)
        for text in result_lines(results):
            terminal.line(text)
        profile = results.info.get("profile")
        if profile:
            terminal.line("Phases of the run")
            for text in profile_lines(profile):
                terminal.line(text)
        terminal.record(
            model_record(results.model)
            | {
                "frames": len(results.frames),
                "times": results.times.tolist(),
                "variables": results.variables(),
                "info": results.info,
            }
        )
    return 0


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
    return lines


def model_record(model: Model) -> dict[str, Any]:
    """Give the same for machines."""
    mesh = model.mesh
    return {
        "event": "model",
        "job": model.name,
        "nodes": mesh.n_nodes,
        "elements": mesh.n_cells,
        "node sets": {k: len(v) for k, v in mesh.node_sets.items()},
        "element sets": {k: len(v) for k, v in mesh.cell_sets.items()},
        "edge sets": {k: len(v) for k, v in mesh.edge_sets.items()},
        "steps": len(model.steps),
        "notes": model.notes,
    }


def result_lines(results: FileResults) -> list[str]:
    """Frames, times, variables and ranges of results."""
    frames = results.frames
    if not frames:
        return ["no frames"]
    first, last = frames[0], frames[-1]
    lines = [
        f"{len(frames)} frames, time {first.time:g} ... {last.time:g}; last: step {last.step}, "
        f"increment {last.increment}, load factor {last.factor:g}",
        f"  {'variable':<10}{'smallest':>14}{'largest':>14}   (last frame, at nodes)",
    ]
    for name in results.variables():
        values = results.nodal(name)
        lines.append(f"  {name:<10}{values.min():>14.6g}{values.max():>14.6g}")
    return lines
