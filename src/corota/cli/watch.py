"""``corota watch``: a run in progress, in a browser or in the terminal."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import shutil
import time
from typing import TYPE_CHECKING, Any

from corota.cli.progress import duration
from corota.errors import FileError
from corota.report.records import ITERATION, JobPaths, Records, find_job

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.report.server import JobWatch

#: Seconds between two checks of the files, and seconds that a job may take to write its first.
BEAT, PATIENCE = 0.5, 30.0
#: Residuals of these powers of ten and below, or above, have the lowest and the highest bar.
LOWEST, HIGHEST = -12.0, 0.0
BARS, PLAIN_BARS = "▁▂▃▄▅▆▇█", "_.-=+*%#"


def run(args: Any, terminal: Terminal) -> int:
    """Show a run until it ends."""
    from corota.report.server import JobWatch, PageServer

    job = _wait_for(args.job, args.output, terminal)
    if args.terminal:
        _in_terminal(JobWatch(job), terminal)
        return 0
    with PageServer(job, args.port) as server:
        tell_address(server.address, terminal)
        if args.open:
            import webbrowser

            webbrowser.open(server.address)
        try:
            while server.watch.at_work():
                time.sleep(BEAT)
            terminal.line("The run has ended; Ctrl-C closes this page")
            while True:
                time.sleep(3600.0)
        except KeyboardInterrupt:
            return 0


def tell_address(address: str, terminal: Terminal) -> None:
    """Print the address of the page."""
    terminal.line(f"Watch at {address}")
    terminal.record({"event": "page", "address": address})


def _wait_for(name: str, folder: str | None, terminal: Terminal) -> JobPaths:
    """Find the job; one that was just started may have no files yet."""
    limit = time.monotonic() + PATIENCE
    announced = False
    while True:
        try:
            return find_job(name, folder)
        except FileError:
            if time.monotonic() > limit:
                raise
        if not announced:
            terminal.line(f"waiting for the files of {name}")
            announced = True
        time.sleep(BEAT)


def _in_terminal(watch: JobWatch, terminal: Terminal) -> None:
    """Lines of increments and cut-backs, and the residuals of the newest iterations."""
    shown = [0, 0, 0]
    while True:
        found = watch.records()
        over = not watch.at_work(found)
        for text in _news(found, shown):
            terminal.line(text)
        if found.iterations:
            terminal.status(_status(found, terminal.unicode))
        if over:
            break
        time.sleep(BEAT)
    terminal.status("")
    end = found.end
    status = end.get("status", "ended without a message")
    terminal.line(
        f"{status} after {duration(float(end.get('elapsed', 0.0)))}: {end.get('message', '')}"
    )


def _news(records: Records, shown: list[int]) -> list[str]:
    """News since the last check, in the order of their kinds."""
    lines = [_increment(r) for r in records.increments[shown[0] :] if r.get("increment")]
    lines += [
        f"  step {c['step']}, increment {c['increment']}, attempt {c['attempt']}: {c['reason']}; "
        f"next time increment {c['dt']:.4g}"
        for c in records.cut_backs[shown[1] :]
    ]
    lines += [f"  note: {text}" for text in records.notes[shown[2] :]]
    shown[:] = [len(records.increments), len(records.cut_backs), len(records.notes)]
    return lines


def _increment(record: dict[str, Any]) -> str:
    residual = record.get("residual")
    tail = f"  residual {residual:.1e}" if residual is not None else ""
    return (
        f"step {record['step']}  increment {record['increment']}  time {record['time']:.6g}  "
        f"load factor {record['load factor']:.6g}  "
        f"{record.get('iterations') or 0:.0f} iterations{tail}"
    )


def _status(records: Records, unicode: bool) -> str:
    """The residuals of the newest iterations as bars, and the newest as a number."""
    width = max(10, min(60, shutil.get_terminal_size().columns - 44))
    newest = records.iterations[-width:]
    last = dict(zip(ITERATION, newest[-1], strict=True))
    residuals = [max(row[4], row[5]) for row in newest]
    return (
        f"inc {last['increment']:.0f} it {last['iteration']:.0f} "
        f"{bars(residuals, BARS if unicode else PLAIN_BARS)} {residuals[-1]:.1e}"
    )


def bars(residuals: list[float], levels: str) -> str:
    """A bar for each residual, by its power of ten.

    Examples
    --------
    >>> bars([1.0, 1e-3, 1e-6, 1e-12], "_.-=+*%#")
    '#%+_'
    """
    text = ""
    for value in residuals:
        power = math.log10(value) if value > 0.0 and math.isfinite(value) else LOWEST
        share = (min(max(power, LOWEST), HIGHEST) - LOWEST) / (HIGHEST - LOWEST)
        text += levels[min(int(share * len(levels)), len(levels) - 1)]
    return text
