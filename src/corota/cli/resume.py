"""``corota resume``: resume a stopped run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.run import carry_out
from corota.cli.together import together
from corota.errors import FileError

if TYPE_CHECKING:
    from corota.analysis.parallel.communicator import Communicator
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Resume a job; return the exit code."""
    with together(args, terminal) as communicator:
        return _run(args, terminal, communicator)


def _run(args: Any, terminal: Terminal, communicator: Communicator) -> int:
    from corota._core import __version__
    from corota.analysis.state_tree import UnsuitableState
    from corota.io.checkpoint import newest, rebuilt
    from corota.io.provenance import changed_file
    from corota.io.resume import files_of, foreign

    begin = time.perf_counter()
    terminal.line(terminal.color(f"Corota {__version__}", "bold") + f"  {args.job}")
    job = Path(args.job)
    saved, refused = newest(job if args.output is None else Path(args.output) / job.name)
    for reason in refused:
        terminal.line(f"  note: not used: {reason}")
    source = saved.options["source"]
    deck = job.suffix == ".inp" and job.exists()
    if deck and "sha256" in source and (changed := changed_file(source, job)):
        raise FileError(
            f"{changed}: it has changed since {saved.path} was written: run {job} again, or "
            f"continue with the old model: corota resume {saved.path}"
        )
    model, steps = rebuilt(saved)
    terminal.line(f"From {saved.path}: {saved.state.where}")
    files = files_of(saved)
    try:
        return carry_out(
            model, steps, files, terminal, args, begin, saved.state, communicator=communicator
        )
    except UnsuitableState as error:
        raise foreign(saved, error) from None
