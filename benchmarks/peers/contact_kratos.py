"""A contact problem with Kratos, in its environment (:mod:`benchmarks.peers.run_kratos_problem`).

It gets as many equal increments as Corota used, but so many that a support moves by at most
:data:`STRIDE` times the shortest edge: an iteration of Kratos begins with the supports moved and
the rest at its place, and longer strides fold the elements beside them. An increment that fails
is split into tenths, up to three times (``adaptative_strategy``, with its defaults).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import math
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.peers.contact_data import ContactData, Outcome, mean
from benchmarks.peers.install import interpreter

#: Formulations, and what the tables call them.
KINDS = {"ALM": "ALM", "Penalty": "penalty"}
ROOT = Path(__file__).parents[2]
#: Way of a support in an increment over the shortest edge.
STRIDE = 0.1


def increments(data: ContactData, used: list[int]) -> list[int]:
    """Number of increments of each step.

    Parameters
    ----------
    data : ContactData
    used : list of int
        What Corota used.
    """
    points = data.points
    shortest = min(
        math.dist(points[a], points[b])
        for cell in data.cells
        for a, b in zip(cell, [*cell[1:], cell[0]], strict=True)
    )
    out, before = [], dict[tuple[int, int], float]()
    for count, stage in zip(used, data.stages, strict=True):
        now = {(node, dof): value for node, dof, value in stage.driven}
        far = max((abs(v - before.get(key, 0.0)) for key, v in now.items()), default=0.0)
        out.append(max(1, count, math.ceil(far / (STRIDE * shortest))))
        before = now
    return out


def run(data: ContactData, kind: str, used: list[int], limit: int) -> Outcome:
    """The outcome of Kratos.

    Parameters
    ----------
    data : ContactData
    kind : str
        A key of :data:`KINDS`.
    used : list of int
        Increments of Corota.
    limit : int
        Longest processor time [s].
    """
    said, rows, seconds = call(data, kind, increments(data, used), limit)
    good = [row for row in rows if row["converged"]]
    share = good[-1]["time"] / data.period if good else 0.0
    # Its tables have a line for each iteration, those of failed parts of increments included.
    iterations = len(re.findall(r"^\|\s*\d+\|", said, re.MULTILINE))
    why = ""
    if share < 1.0 - 1e-9:
        why = "diverges"
        if seconds > 0.95 * limit:
            why = f"over {limit} s"
        elif "SINGULAR" in said:
            why = "singular"
        elif not rows or rows[-1]["converged"]:
            why = "stops"
    force = mean(((row["time"], math.hypot(*row["force"])) for row in good), data.period)
    reported = "yes" if not why else f"{why}, {share:.0%}"
    return Outcome(reported, iterations, force)


def call(
    data: ContactData, kind: str, counts: list[int], limit: int
) -> tuple[str, list[dict[str, Any]], float]:
    """What Kratos says, its increments, and its processor time.

    Parameters
    ----------
    data : ContactData
    kind : str
        A key of :data:`KINDS`.
    counts : list of int
        Increments of each step.
    limit : int
        Longest processor time [s].
    """
    python = interpreter("Kratos")
    if python is None:
        raise SystemExit("Kratos is not installed: python -m benchmarks.peers.install Kratos")
    module = "benchmarks.peers.run_kratos_problem"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data.save(folder / "data.json")
        begin = resource.getrusage(resource.RUSAGE_CHILDREN)
        found = subprocess.run(
            [str(python), "-m", module, "data.json", kind, *map(str, counts)],
            cwd=folder,
            check=False,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)),
        )
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
    said = found.stdout.decode(errors="replace")
    lines = said.splitlines()
    rows = [json.loads(line) for line in lines if line.startswith('{"time"')]
    return said, rows, end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime
