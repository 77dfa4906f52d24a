"""``corota run``: read, solve, write, report."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli import collect_garbage, end_at_once
from corota.cli.progress import Progress, duration
from corota.cli.reading import read_input
from corota.cli.together import together
from corota.errors import CorotaError, ModelError
from corota.model import elements
from corota.results.observer import BaseObserver

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.analysis.checkpoint import Checkpoint
    from corota.analysis.parallel.communicator import Communicator
    from corota.cli.terminal import Terminal
    from corota.io.job import JobFiles
    from corota.model.model import Model
    from corota.model.steps import Step


class Stop(BaseObserver):
    """Observer that ends the analysis after the increment in which a signal came.

    The first signal requests the end; a second one ends the process within a second,
    even in the core. SIGUSR1 requests a checkpoint only.
    """

    #: Signals that end a run, where the system has them.
    ENDING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU")

    def __init__(self, terminal: Terminal, files: JobFiles | None = None) -> None:
        self.terminal, self.files, self.signal = terminal, files, ""
        self.stop = False

    def on_signal(self, number: int, frame: object) -> None:
        """Note the signal; a second one stops at once."""
        if self.signal:
            raise KeyboardInterrupt
        self.signal, self.stop = signal.Signals(number).name, True
        self.terminal.warning("stopping after this increment; press again to stop at once")

    def save(self, number: int, frame: object) -> None:
        """Request a checkpoint after this increment."""
        if self.files is not None:
            self.files.checkpoint_requested = True

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        """Handle the signals in a block; ignored ones, as under nohup, stay ignored."""
        before: dict[int, Any] = {}
        handlers = {name: self.on_signal for name in self.ENDING} | {"SIGUSR1": self.save}
        for name, handler in handlers.items():
            number = getattr(signal, name, None)
            if number is None or signal.getsignal(number) is signal.SIG_IGN:
                continue
            with contextlib.suppress(ValueError):  # not in the main thread
                found = signal.signal(number, handler)
                # Files are closed on the way out.
                before[number] = signal.default_int_handler if found is end_at_once else found
        ending = {getattr(signal, name) for name in self.ENDING if hasattr(signal, name)}
        with _second(ending & set(before)):
            try:
                yield
            finally:
                for number, handler in before.items():
                    signal.signal(number, handler)


@contextlib.contextmanager
def _second(numbers: set[int]) -> Iterator[None]:
    """End the process soon after a second signal: Python's handlers wait for the core."""
    ear, mouth = os.pipe()
    if os.name == "posix":
        os.set_blocking(mouth, False)
    try:
        before = signal.set_wakeup_fd(mouth, warn_on_full_buffer=False)
    except ValueError:  # not in the main thread
        os.close(ear)
        os.close(mouth)
        yield
        return

    def listen() -> None:
        heard = 0
        while got := os.read(ear, 1):
            heard += got[0] in numbers
            if heard > 1:
                time.sleep(1.0)
                os._exit(7)

    listener = threading.Thread(target=listen, name="corota-signals", daemon=True)
    listener.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        os.close(mouth)
        listener.join(5.0)
        os.close(ear)


def run(args: Any, terminal: Terminal) -> int:
    """Run a deck; return the exit code."""
    with together(args, terminal) as communicator:
        return _run(args, terminal, communicator)


def _run(args: Any, terminal: Terminal, communicator: Communicator) -> int:
    from corota._core import __version__
    from corota.io.job import CHECKPOINT_SECONDS, JobFiles
    from corota.io.provenance import write_provenance
    from corota.io.writers import STREAMS

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
    if any(elements.find(section.element).bending_cells for section in model.sections):
        from corota.model.locking import locking

        model.notes += [f"{found.message}: {found.hint}" for found in locking(model)]
    for note in model.notes:
        terminal.line(f"  note: {note}")
    if not model.steps:
        raise ModelError(f"{args.deck}: there is no *STEP, so there is nothing to solve")
    if args.provenance and communicator.first:
        write_provenance(Path(args.output), model.name, model.sources)
    every = args.checkpoint_every
    streams = [f for f in args.formats or ["vtkhdf"] if f in STREAMS]
    files = JobFiles(
        args.output,
        model.name,
        formats=[*streams, *([args.frd] if args.frd and args.frd not in streams else [])],
        histories=args.histories,
        points=args.points,
        single=args.single,
        fields=args.fields,
        compression=args.compression,
        parts=communicator.size,
        profile={"read": read},
        checkpoint_every=every or 0,
        checkpoint_seconds=CHECKPOINT_SECONDS if every is None else 0.0,
    )
    return carry_out(model, None, files, terminal, args, begin, communicator=communicator)


def carry_out(
    model: Model,
    steps: list[Step] | None,
    files: JobFiles,
    terminal: Terminal,
    args: Any,
    begin: float,
    start: Checkpoint | None = None,
    *,
    communicator: Communicator,
) -> int:
    """Solve, from a checkpoint if there is one, and report; return the exit code."""
    from corota.analysis.run import solve
    from corota.io.events import Events

    formats = getattr(args, "formats", None) or []
    progress, stop = Progress(terminal, args.verbose), Stop(terminal, files)
    observers: list[Any] = [files, progress, stop]
    if terminal.json:
        observers.insert(1, Events(terminal.record))
    if not communicator.first:
        observers = [stop]
    whole = any(f in ("npz", "vtu") for f in formats)
    collect_garbage()
    with (
        _served(
            files,
            model.name,
            terminal,
            getattr(args, "serve", None) if communicator.first else None,
        ),
        files,
        stop.listening(),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")  # they are among the notes of the results
        try:
            results = solve(
                model,
                steps,
                observers=observers,
                solver=getattr(args, "solver", "multifrontal"),
                threads=args.threads,
                keep="all" if whole else "last",
                start=start,
            )
        except CorotaError as error:
            files.close()
            for note in getattr(getattr(error, "results", None), "notes", ()):
                terminal.line(f"  note: {note}")
            _tell_files(files, terminal)
            _tell_checkpoint(files, terminal)
            raise
        if files.error is not None:
            raise files.error
    for ending in formats:
        if ending in ("npz", "vtu") and communicator.first:
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


@contextlib.contextmanager
def _served(files: JobFiles, name: str, terminal: Terminal, port: int | None) -> Iterator[None]:
    if port is None:
        yield
        return
    from corota.cli.watch import tell_address
    from corota.report.records import JobPaths
    from corota.report.server import PageServer

    with PageServer(JobPaths(files.folder, files.name or name), port) as server:
        tell_address(server.address, terminal)
        try:
            yield
        finally:
            server.wait_for_pages()


def _tell_checkpoint(files: JobFiles, terminal: Terminal) -> None:
    path = files.folder / f"{files.name}.ckpt"
    if files.error is None and files.checkpointed is not None and path.exists():
        terminal.line(
            f"Checkpoint of {files.checkpointed.where}; continue with: corota resume {path}"
        )


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
