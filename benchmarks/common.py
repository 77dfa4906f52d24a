"""What the benchmarks share: interleaved timing, peers as processes, tables, the machine."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import platform
import shutil
import signal
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

#: Longest time a peer may take [s]; what takes longer is printed as "over limit".
TIME_LIMIT = 1200.0


def machine() -> str:
    """Processor, cores, memory and versions in one line."""
    model = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        names = [
            line.split(":", 1)[1].strip()
            for line in information.read_text(encoding="utf-8").splitlines()
            if line.startswith("model name")
        ]
        model = names[0] if names else model
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    memory = ""
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        size = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        memory = f", {size / 2**30:.0f} GiB"
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    return f"{model}, {cores} cores{memory}, Python {platform.python_version()}{load}"


def interleaved(
    runs: Mapping[str, Callable[[], object]],
    repeats: int = 5,
    warm_up: int = 1,
    clock: Callable[[], float] = time.perf_counter,
) -> dict[str, float]:
    """Time functions in turn, so that a disturbance meets all of them alike.

    Parameters
    ----------
    runs : mapping of str to callable
    repeats : int
        Timed rounds.
    warm_up : int
        Rounds before, not timed.
    clock : callable
        Wall time; ``time.thread_time`` for what runs in this thread alone, so that other
        programs do not count.

    Returns
    -------
    dict of str to float
        Median time of each [s].
    """
    times: dict[str, list[float]] = {name: [] for name in runs}
    for attempt in range(warm_up + repeats):
        for name, run in runs.items():
            start = clock()
            run()
            taken = clock() - start
            if attempt >= warm_up:
                times[name].append(taken)
    return {name: statistics.median(taken) for name, taken in times.items()}


@dataclass
class Run:
    """Outcome of a program that ran as a process of its own."""

    seconds: float
    peak_mb: float
    output: str
    ok: bool
    note: str = ""
    cpu: float = 0.0


def process(
    command: Sequence[str | Path],
    folder: Path,
    *,
    threads: int = 1,
    limit: float = TIME_LIMIT,
) -> Run:
    """Run a program with a number of threads and a time limit.

    Peak memory and processor time come from GNU ``time`` where it is installed: the kernel's own
    account of a child begins with the memory of its parent.

    Parameters
    ----------
    command : sequence of str or Path
    folder : Path
        Working folder.
    threads : int
        Told through the usual variables.
    limit : float
        Longest time [s].
    """
    names = ("OMP", "OPENBLAS", "MKL", "RAYON", "BLIS")
    environment = dict(os.environ, **{f"{name}_NUM_THREADS": str(threads) for name in names})
    watch, note = shutil.which("time"), folder / ".time"
    before = [watch, "-f", "%M %U %S", "-o", note] if watch else []
    start = time.perf_counter()
    with subprocess.Popen(
        [str(part) for part in [*before, *command]],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        start_new_session=True,
    ) as child:
        try:
            output, _ = child.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            child.communicate()
            return Run(limit, 0.0, "", ok=False, note="over limit")
    seconds = time.perf_counter() - start
    peak = cpu = float("nan")
    if note.exists():
        memory, user, system = note.read_text(encoding="ascii").splitlines()[-1].split()
        peak, cpu = float(memory) / 1024.0, float(user) + float(system)
    said = "" if child.returncode == 0 else f"exit {child.returncode}"
    return Run(seconds, peak, output, ok=child.returncode == 0, note=said, cpu=cpu)


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Markdown table with aligned columns."""
    text = [list(head), *([cell(value) for value in row] for row in rows)]
    widths = [max(len(row[k]) for row in text) for k in range(len(head))]
    lines = [
        "| "
        + " | ".join(value.ljust(width) for value, width in zip(row, widths, strict=True))
        + " |"
        for row in text
    ]
    lines.insert(1, "| " + " | ".join("-" * width for width in widths) + " |")
    return "\n".join(lines)


def cell(value: object) -> str:
    """Text of a table cell: floats to four digits."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def report(title: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Print a titled table and the machine."""
    sys.stdout.write(f"\n### {title}\n\n{machine()}\n\n{table(head, rows)}\n")
    sys.stdout.flush()


def write_between(page: Path, name: str, text: str) -> None:
    """Replace what stands between the marks ``name: begin`` and ``name: end`` of a page."""
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    head, rest = page.read_text(encoding="utf-8").split(begin)
    body = f"{head}{begin}\n{text}\n{end}{rest.split(end)[1]}"
    page.write_text(body, encoding="utf-8", newline="\n")
