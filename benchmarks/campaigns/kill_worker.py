"""A run in a forked process that is ended at a chosen moment, also in the middle of a write."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import json
import os
import resource
import signal
import sys
import time
import traceback
import warnings
from argparse import Namespace
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.analysis.parallel.communicator import ALONE
from corota.cli import main as corota
from corota.cli.run import carry_out
from corota.cli.terminal import Terminal
from corota.errors import CorotaError
from corota.io import atomic_file
from corota.io.checkpoint import newest
from corota.io.job import JobFiles
from corota.io.resume import files_of, model_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.model.model import Model

#: Seconds after which a run hangs: of the processor, and by the clock of a busy machine.
LIMIT, CLOCK = 120, 1800.0
JOB = "job"


@dataclass
class Case:
    """A run that can be made again at any time.

    Parameters
    ----------
    name, kind : str
    deck : str
        Text of its deck; empty where there is a model.
    build : callable, optional
        Makes the model with its steps.
    options : tuple of str
        More of the command line.
    values : str
        Of a sweep, such as ``load=.2,.4``; empty for a single run.
    """

    name: str
    kind: str
    deck: str = ""
    build: Callable[[], Model] | None = None
    options: tuple[str, ...] = ()
    values: str = ""


@dataclass
class Strike:
    """When and how a run is ended.

    Parameters
    ----------
    after : float
        Seconds after the start at which a signal is sent; 0 for no signal.
    signal : int
    inside : str
        Name of the call in which the process kills itself: see :func:`_arm`.
    count : int
        In which of these calls, from 1.
    """

    after: float = 0.0
    signal: int = signal.SIGKILL
    inside: str = ""
    count: int = 0


def run(case: Case, folder: Path, every: int, resume: bool, strike: Strike) -> tuple[int, str]:
    """Run or resume a case in a process of its own.

    Returns
    -------
    int
        Exit code; minus the signal that ended it.
    str
        What it wrote to standard error.
    """
    log = folder.with_suffix(".log")
    log.touch()  # a signal may end the child before it opens its log
    child = os.fork()
    if child == 0:
        code = 99
        try:
            code = _child(case, folder, every, resume, strike, log)
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
        finally:
            os._exit(code)
    begin = time.monotonic()
    struck = not strike.after
    while True:
        done, status, used = os.wait4(child, os.WNOHANG)
        if done:
            if used.ru_utime + used.ru_stime >= LIMIT:
                return 124, "working after the limit of processor time"
            return os.waitstatus_to_exitcode(status), log.read_text(errors="replace")
        spent = time.monotonic() - begin
        if not struck and spent >= strike.after:
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, strike.signal)
            struck = True
        if spent > CLOCK:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return 124, "waiting after the limit"
        time.sleep(0.0005)


def _child(case: Case, folder: Path, every: int, resume: bool, strike: Strike, log: Path) -> int:
    """What happens in the forked process; the exit code."""
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 5))
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        signal.signal(getattr(signal, name), signal.SIG_DFL)
    errors = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(errors, 2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)  # noqa: SIM115
    calls = _arm(strike)
    warnings.simplefilter("ignore")
    if case.values:
        folder.mkdir(exist_ok=True)
        words = ["sweep", str(folder.parent / f"{JOB}.inp"), "-q", "--workers", "1"]
        words += ["-p", case.values, "-m", "last(U2@RIGHTA)", "-m", "max(RF2@LEFTA)"]
        code = corota([*words, "-o", str(folder / f"{JOB}.csv")])
    elif case.deck:
        options = ["-q", "--threads", "1", *case.options]
        if resume:
            code = corota(["resume", str(folder / JOB), *options])
        else:
            deck = folder.parent / f"{JOB}.inp"
            more = ["-o", str(folder), "--checkpoint-every", str(every)]
            code = corota(["run", str(deck), *more, *options])
    else:
        code = _model(case, folder, every, resume)
    log.with_suffix(".calls").write_text(json.dumps(calls))
    sys.stderr.flush()
    return code


def _model(case: Case, folder: Path, every: int, resume: bool) -> int:
    """The same for a model that is made by a function."""
    assert case.build is not None
    args, terminal = Namespace(threads=1, verbose=0, formats=None), Terminal(quiet=True)
    begin = time.perf_counter()
    try:
        if resume:
            saved, _ = newest(folder / JOB)
            model, steps = model_of(saved, case.build() if saved.model is None else None)
            files = files_of(saved)
            return carry_out(
                model, steps, files, terminal, args, begin, saved.state, communicator=ALONE
            )
        files = JobFiles(folder, JOB, checkpoint_every=every, checkpoint_seconds=0.0)
        return carry_out(case.build(), None, files, terminal, args, begin, communicator=ALONE)
    except CorotaError as error:
        terminal.error(str(error))
        return error.exit_code


def _arm(strike: Strike) -> Counter[str]:
    """Count what changes files; end the process in the call that is chosen.

    Names and calls: ``append`` (a piece of text, half of it written), ``commit`` (the numbers of
    a result file, half of them written), and before or after the system's ``replace``, ``link``,
    ``unlink`` and ``fsync``.
    """
    calls: Counter[str] = Counter()

    def due(name: str) -> bool:
        calls[name] += 1
        return name == strike.inside and calls[name] == strike.count

    def end() -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    def around(name: str) -> None:
        true = getattr(os, name)

        def call(*args: Any, **options: Any) -> Any:
            if due(f"before {name}"):
                end()
            found = true(*args, **options)
            if due(f"after {name}"):
                end()
            return found

        setattr(os, name, call)

    for name in ("replace", "link", "unlink", "fsync"):
        around(name)
    append, commit = atomic_file.TextFile.append, atomic_file.AtomicFile.commit

    def half_text(self: Any, text: str) -> None:
        if due("append"):
            self._file.write(text.encode()[: len(text) // 2])
            end()
        append(self, text)

    def half_numbers(self: Any, last: bool = False) -> None:
        pages = {**self._behind, **self._pages}
        if pages and due("commit"):
            numbers = sorted(pages)
            half = len(numbers) // 2
            with open(self.hidden, "r+b") as file:
                for n in numbers[: half + 1]:
                    file.seek(n * atomic_file.PAGE)
                    file.write(pages[n] if n < numbers[half] else pages[n][: len(pages[n]) // 2])
                file.flush()
                end()
        commit(self, last)

    atomic_file.TextFile.append = half_text  # type: ignore[method-assign]
    atomic_file.AtomicFile.commit = half_numbers  # type: ignore[method-assign]
    return calls


__all__ = ["JOB", "Case", "Strike", "run"]
