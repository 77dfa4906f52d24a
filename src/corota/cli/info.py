"""``corota info``: contents of a deck, a mesh or a result file."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.cli.reading import is_result, read_input
from corota.errors import InputError
from corota.model.summary import joint_lines, material_lines, model_lines
from corota.results.table import NODAL

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.model.model import Model
    from corota.results.results import Results


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


def model_record(model: Model) -> dict[str, Any]:
    """Return the same as a record."""
    mesh = model.mesh
    return {
        "event": "model",
        "job": model.name,
        "nodes": mesh.n_nodes,
        "elements": mesh.n_cells,
        "node sets": {k: len(v) for k, v in mesh.node_sets.items()},
        "element sets": {k: len(v) for k, v in mesh.cell_sets.items()},
        "edge sets": {k: len(v) for k, v in mesh.edge_sets.items()},
        "materials": material_lines(model)[1:],
        "joints": joint_lines(model),
        "steps": len(model.steps),
        "notes": model.notes,
    }


def result_lines(results: Results) -> list[str]:
    """Frames, times, variables and ranges of results."""
    frames = results.frames
    if not frames:
        return ["no frames"]
    first, last = frames[0], frames[-1]
    lines = [
        f"{len(frames)} frames, time {first.time:g} ... {last.time:g}; last: step {last.step}, "
        f"increment {last.increment}, load factor {last.factor:g}",
        f"  {'last frame':<10}{'smallest':>14}  {'where':<26}{'largest':>14}  where",
    ]
    for name in results.variables():
        try:
            found = results.extremes(name)
        except InputError:  # files with nodal values only
            found = results.extremes(name, at="nodes")
        low, high = found.smallest, found.largest
        kind = " (nodal)" if found.at == "nodes" and name not in NODAL else ""
        lines.append(
            f"  {name:<10}{low.value:>14.6g}  {low.place:<26}{high.value:>14.6g}  "
            f"{high.place}{kind}"
        )
    return lines
