"""The large-rotation cantilever beside Kratos, Akantu and DOLFINx: time per Newton iteration.

Each program solves the same mesh of bilinear quadrilaterals to the same relative residual in a
process of its own, in turn; setting up and output are left out, since they differ in kind. The
peers compute the total-Lagrangian St. Venant-Kirchhoff element, which is Corota's ``Q4`` with the
local strain ``modified``: the tip displacements must agree.

A peer's Python is looked for in ``$COROTA_PEERS/<name>/bin/python`` and then on the path.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

from benchmarks.cantilever import n_equations
from benchmarks.common import TIME_LIMIT, Run, process, report

ROOT = Path(__file__).resolve().parent.parent
#: Elements through the height.
SIZES = {"4k": 14, "40k": 45, "400k": 141}
#: Program and the module that shows whether it is there.
PEERS = {"Kratos": "KratosMultiphysics", "Akantu": "akantu", "DOLFINx": "dolfinx"}
TOLERANCE = 1e-8
#: Corota's residual is relative to the sum of absolute element forces, here a thousand times the
#: load increment that the others start from.
TOLERANCE_COROTA = 1e-11


def interpreter(name: str) -> str | None:
    """Find a Python that can import a peer.

    Parameters
    ----------
    name : str
        A key of :data:`PEERS`.
    """
    places = [
        Path(os.environ.get("COROTA_PEERS", "peers")) / name.lower() / "bin" / "python",
        *(Path(found) for found in (shutil.which("python3"),) if found),
        Path("/usr/bin/python3"),
    ]
    for place in places:
        if place.exists():
            command = [str(place), "-c", f"import {PEERS[name]}"]
            if subprocess.run(command, capture_output=True, check=False).returncode == 0:
                return str(place.absolute())
    return None


def solve(python: str, driver: str, arguments: list[str], threads: int) -> Run:
    """Run a driver and read the line of JSON that it ends with."""
    script = ROOT / "benchmarks" / "peers" / f"{driver}_p1.py"
    with tempfile.TemporaryDirectory() as folder:
        command: list[str | Path] = ["env", f"PYTHONPATH={ROOT}", python, script, *arguments]
        run = process(command, Path(folder), threads=threads)
    lines = [line for line in run.output.splitlines() if line.startswith("{")]
    if run.ok and lines:
        run.values = json.loads(lines[-1])
    elif run.ok:
        run.ok, run.note = False, "no results"
    return run


def measure(size: str, repeats: int, threads: int) -> list[list[object]]:
    """Rows of the table for one size."""
    n = SIZES[size]
    dofs = n_equations(n)
    common = [str(n), str(TOLERANCE)]
    ours = [str(n), str(TOLERANCE_COROTA)]
    programs = {
        f"Corota {element}, {strain}": partial(
            solve, sys.executable, "corota", [*ours, element, strain, str(threads)], threads
        )
        for element, strain in (("Q4", "modified"), ("Q4I", "simplified"))
    }
    for name in PEERS:
        python = interpreter(name)
        if python is not None:
            programs[name] = partial(solve, python, name.lower(), common, threads)
    runs: dict[str, list[Run]] = {name: [] for name in programs}
    for _ in range(repeats if dofs < 100_000 else 1):
        for name, program in programs.items():
            if not (runs[name] and runs[name][0].seconds >= TIME_LIMIT):
                runs[name].append(program())
    base = 0.0
    rows: list[list[object]] = []
    for name, done in runs.items():
        good = sorted((r for r in done if r.ok), key=lambda r: r.values["solve"])
        if not good:
            rows.append([name, dofs, done[0].note, "", "", "", ""])
            continue
        values = good[len(good) // 2].values
        each = values["solve"] / values["iterations"]
        base = base or each
        tip = f"({values['u']:.7f}, {values['v']:.7f})"
        count = int(values["iterations"])
        rows.append([name, dofs, count, values["solve"], 1e3 * each, each / base, tip])
    return rows


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--sizes", nargs="+", default=["4k", "40k"], choices=list(SIZES))
    options.add_argument("--repeats", type=int, default=3)
    options.add_argument("--threads", type=int, default=1)
    chosen = options.parse_args()
    missing = [name for name in PEERS if interpreter(name) is None]
    if missing:
        sys.stdout.write(f"p1_peers: not installed and left out: {', '.join(missing)}\n")
    rows = [row for size in chosen.sizes for row in measure(size, chosen.repeats, chosen.threads)]
    head = ["program", "dofs", "iterations", "time [s]", "per iteration [ms]"]
    head += ["relative to Corota Q4", "tip displacement"]
    report(f"P1, residual {TOLERANCE:g}, {chosen.threads} thread(s)", head, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
