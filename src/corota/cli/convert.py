"""``corota convert``: from one format to another, as the endings say."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.cli.reading import is_result, read_input

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Convert a file."""
    if is_result(args.source):
        from corota.io.result_reader import read_results

        with read_results(args.source) as results:
            path = results.write(args.target)
    else:
        from corota.io.writers import write_mesh

        path = write_mesh(read_input(args.source, args).mesh, args.target)
    terminal.line(f"{args.source} -> {path}")
    terminal.record({"event": "convert", "source": args.source, "target": str(path)})
    return 0
