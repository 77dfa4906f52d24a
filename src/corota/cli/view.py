"""``corota view``: results in an interactive window."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Open the window, or write its picture."""
    from corota.io.result_reader import read_results

    with read_results(args.file) as results:
        results.view(args.field, scale=args.scale, path=args.output)
    if args.output:
        terminal.line(f"wrote {args.output}")
        terminal.record({"event": "picture", "file": args.output})
    return 0
