"""``corota convert``: from one format to another, by file extension."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from corota.cli.reading import is_result, read_input
from corota.errors import InputError

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Convert a file.

    Raises
    ------
    InputError
        If the target is the source, or a file that the source includes.
    """
    if args.paraview:
        from corota.io.paraview import write_paraview

        path = write_paraview(args.source, args.field, scale=args.scale, target=args.target)
        terminal.line(f"wrote {path}; open it with: paraview --script={path}")
        terminal.record({"event": "convert", "source": args.source, "target": str(path)})
        return 0
    if not args.target:
        raise InputError("name the file to write, such as job.frd; or give --paraview")
    target = os.path.realpath(args.target)
    if target == os.path.realpath(args.source):
        raise InputError(f"{args.target} is the source: name another file")
    if is_result(args.source):
        from corota.io.result_reader import read_results

        with read_results(args.source) as results:
            path = results.write(args.target)
    else:
        from corota.io.writers import write_mesh

        model = read_input(args.source, args)
        if target in model.sources:
            raise InputError(f"{args.target} is included by {args.source}: name another file")
        path = write_mesh(model.mesh, args.target)
    terminal.line(f"{args.source} -> {path}")
    terminal.record({"event": "convert", "source": args.source, "target": str(path)})
    return 0
