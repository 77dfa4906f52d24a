"""``corota mesh``: the outline of a drawing or a face becomes a mesh with sets."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.errors import InputError

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Mesh an outline and write it.

    Raises
    ------
    InputError
        If the target is the drawing, or the outline is not closed; a picture shows where.
    """
    from corota.io.writers import write_mesh
    from corota.outline import OutlineError, outline

    target = Path(args.output or Path(args.outline).with_suffix(".inp").name)
    if os.path.realpath(target) == os.path.realpath(args.outline):
        raise InputError(f"{target} is the outline: name another file (-o)")
    try:
        mesh = outline(
            args.outline,
            args.size,
            through=args.through,
            triangles=args.triangles,
            quadratic=args.quadratic,
            gap=args.gap,
            layers=args.layers,
            path=target if target.suffix.lower() == ".msh" else None,
        )
    except OutlineError as error:
        if find_spec("matplotlib") is None:
            raise
        picture = args.plot or f"{target.stem}.refused.png"
        error.plot(path=picture)
        raise InputError(f"{args.outline}: {error}; {picture} shows where") from None
    for note in mesh.notes:
        terminal.line(f"  {note}")
    for kind, sets in (("edges", mesh.edge_sets), ("cells", mesh.cell_sets)):
        listed = ", ".join(f"{name} ({len(members)})" for name, members in sets.items())
        terminal.line(f"  sets of {kind}: {listed or 'none'}")
    if target.suffix.lower() != ".msh":
        write_mesh(mesh, target)
    terminal.line(f"{args.outline} -> {target}")
    terminal.record({"event": "mesh", "source": args.outline, "target": str(target)})
    if args.plot:
        from corota import plots
        from corota.model.model import Model

        plots.model(Model(mesh, target.stem), path=args.plot)
        terminal.line(f"picture: {args.plot}")
    return 0
