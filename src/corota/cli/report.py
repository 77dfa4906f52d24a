"""``corota report``: one page for a browser from the files of a job."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Write the page and print its size."""
    from corota.report import report_job

    path = report_job(args.job, args.output, other=args.other, limit=args.limit, title=args.title)
    size = path.stat().st_size
    terminal.line(f"wrote {path} ({size / 1e6:.1f} MB); open it in a browser")
    terminal.record({"event": "report", "file": str(path), "bytes": size})
    return 0
