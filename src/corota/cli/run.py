"""``corota run``: read, solve, write, tell."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import signal
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.progress import Progress, duration
from corota.cli.reading import read_input
from corota.errors import CorotaError, ModelError
from corota.results.observer import BaseObserver

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.cli.terminal import Terminal
    from corota.io.job import JobFiles


class Stop(BaseObserver):
    """Observer that ends the analysis after the increment in which a signal came."""

    def __init__(self, terminal: Terminal) -> None:
        self.terminal, self.asked = terminal, ""
        self.stop = False

    def ask(self, number: int, frame: object) -> None:
        """Note the signal; a second one stops at once."""
        if self.asked:
            raise KeyboardInterrupt
        self.asked, self.stop = signal.Signals(number).name, True
        self.terminal.warning("stopping after this increment; once more stops at once")

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        """Take over SIGINT and SIGTERM for a while."""
        before = {}
        for name in (signal.SIGINT, signal.SIGTERM):
            with contextlib.suppress(ValueError):  # not in the main thread
                before[name] = signal.signal(name, self.ask)
        try:
            yield
        finally:
            for name, handler in before.items():
                signal.signal(name, handler)


def run(args: Any, terminal: Terminal) -> int:
    """Run a deck; return the exit code."""
    from corota import __version__
    from corota.analysis.run import solve
    from corota.io.events import Events
    from corota.io.job import JobFiles

    begin = time.perf_counter()
    terminal.line(terminal.color(f"Corota {__version__}", "bold") + f"  {args.deck}")
    model = read_input(args.deck, args)
    read = time.perf_counter() - begin
    model.name = args.name or Path(args.deck).stem
    mesh = model.mesh
    terminal.line(
        f"{counted(mesh.n_nodes, 'node')}, {counted(mesh.n_cells, 'element')}, "
        f"{counted(len(model.steps), 'step')}, read in {duration(read)}"
    )
    for note in model.notes:
        terminal.line(f"  note: {note}")
    if not model.steps:
        raise ModelError(f"{args.deck}: there is no *STEP, so there is nothing to solve")
    formats = args.formats or ["vtkhdf"]
    progress, stop = Progress(terminal, args.verbose), Stop(terminal)
    files = JobFiles(
        args.output,
        model.name,
        formats=[f for f in formats if f in ("vtkhdf", "pvd")],
        histories=args.histories,
        points=not args.no_points,
        profile={"read": read},
    )
    observers: list[Any] = [files, progress, stop]
    if terminal.json:
        observers.insert(1, Events(terminal.record))
    whole = any(f in ("npz", "vtu") for f in formats)
    with files, stop.listening(), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are among the notes of the results
        try:
            results = solve(
                model,
                observers=observers,
                threads=args.threads,
                keep="all" if whole else "last",
            )
        except CorotaError as error:
            files.close()
            for note in getattr(getattr(error, "results", None), "notes", ()):
                terminal.line(f"  note: {note}")
            _tell_files(files, terminal)
            raise
        if files.error is not None:
            raise files.error
    for ending in formats:
        if ending in ("npz", "vtu"):
            files.paths.append(results.write(files.folder / f"{model.name}.{ending}"))
    for note in results.notes:
        terminal.line(f"  note: {note}")
    _tell_files(files, terminal)
    wall = time.perf_counter() - begin
    terminal.line(
        terminal.color("Done", "green")
        + f" in {duration(wall)}: {counted(progress.increments, 'increment')}, "
        f"{counted(progress.iterations, 'iteration')}, {counted(progress.cut_backs, 'cut-back')}"
    )
    if args.verbose:
        for text in profile_lines(results.info.get("profile", {}), wall):
            terminal.line(text)
    terminal.record(
        {
            "event": "files",
            "files": [str(p) for p in files.paths],
            "wall": wall,
            "increments": progress.increments,
            "iterations": progress.iterations,
        }
    )
    return 0


def _tell_files(files: JobFiles, terminal: Terminal) -> None:
    names = [p.name for p in files.paths if p.exists()]
    if not names:
        return
    terminal.line(f"Files in {files.folder}: {', '.join(names)}")


def counted(number: int, noun: str) -> str:
    """A number with its noun in the right form."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


#: Phases in the order in which a run goes through them.
PHASES = ("read", "order", "assemble", "factor", "solve", "recover", "write")


def profile_lines(profile: dict[str, float], wall: float = 0.0) -> list[str]:
    """Table of the phases of a run, in the order of :data:`PHASES`."""
    rest = [p for p in profile if p not in PHASES]
    profile = {p: profile[p] for p in (*PHASES, *rest) if p in profile}
    total = wall or sum(profile.values()) or 1.0
    lines = [f"  {'phase':<12}{'seconds':>10}{'share':>8}"]
    for phase, seconds in profile.items():
        lines.append(f"  {phase:<12}{seconds:>10.3f}{seconds / total:>8.1%}")
    if wall:
        other = max(wall - sum(s for p, s in profile.items() if p != "write"), 0.0)
        lines.append(f"  {'other':<12}{other:>10.3f}{other / total:>8.1%}")
        lines.append(f"  {'wall':<12}{wall:>10.3f}   (write runs beside the others)")
    return lines
