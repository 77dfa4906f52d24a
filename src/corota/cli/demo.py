"""``corota demo``: run a built-in example without files or network."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
import warnings
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.progress import Progress, duration

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Solve an example, write its results and, where matplotlib is installed, a picture."""
    from corota import examples
    from corota.analysis.run import solve
    from corota.io.job import JobFiles

    if args.list:
        for name in examples.names():
            terminal.line(f"{name:<10} {examples.describe(name)}")
        return 0
    begin = time.perf_counter()
    model = examples.load(args.name)
    terminal.line(examples.describe(args.name))
    folder = Path(args.output or Path("corota-demo") / model.name)
    with JobFiles(folder, model.name) as files, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are among the notes of the results
        results = solve(model, observers=[files, Progress(terminal, args.verbose)])
    for note in results.notes:
        terminal.line(f"  note: {note}")
    paths = [p for p in files.paths if p.exists()]
    if find_spec("matplotlib") is not None:
        picture = folder / f"{model.name}.png"
        results.plot(path=picture)
        paths.append(picture)
    else:
        terminal.line("pip install 'corota[plot]' adds pictures")
    terminal.line(f"Done in {duration(time.perf_counter() - begin)}. Files in {folder}:")
    for path in paths:
        terminal.line(f"  {path.name}")
    terminal.line(
        "The same in Python: import corota as ct; model = ct.examples.load"
        f'("{model.name}"); results = ct.solve(model)'
    )
    terminal.record({"event": "files", "files": [str(p) for p in paths]})
    return 0
