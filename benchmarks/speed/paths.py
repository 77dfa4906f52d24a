"""Arc length beside load control, and linear buckling beside one factorization.

An arc-length increment solves for two right-hand sides where load control solves for one;
everything else is the same work. Buckling needs many solutions with one factorization.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time

import corota as ct
from benchmarks.common import report
from corota.analysis.linear.solvers import Multifrontal

#: Cells along and across a cantilever of 100 x 10: about 250,000 equations.
SIZES = {"20k": (320, 31), "250k": (1120, 111)}
INCREMENTS = 10
#: Targets: time of an arc-length increment over load control's; buckling in factorizations.
ARC_TARGET, BUCKLING_TARGET = 1.15, 10.0


def strut(nx: int, ny: int, *, across: float, along: float) -> ct.Model:
    """Cantilever under a shear and a compression on its end."""
    model = ct.Model(ct.mesh.rectangle(100.0, 10.0, nx=nx, ny=ny))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.traction("right", x=-along / 10.0, y=across / 10.0)
    return model


class Timed(Multifrontal):
    """The built-in solver with a clock of its own.

    With one thread the clock tells processor time: others on the machine do not count.
    """

    def __init__(self, threads: int) -> None:
        super().__init__()
        self.clock = time.process_time if threads == 1 else time.perf_counter
        self.ready, self.factorizations = 0.0, []

    def analyze(self, *pattern: object) -> None:
        super().analyze(*pattern)
        self.ready = self.clock()

    def factorize(self, data: object) -> object:
        start = self.clock()
        inertia = super().factorize(data)
        self.factorizations.append(self.clock() - start)
        return inertia


def run(
    model: ct.Model, step: ct.model.steps.Step, threads: int
) -> tuple[float, float, ct.Results]:
    """Time of a run from its first factorization on, the median one, and the results.

    Numbering, loads, the first assembly and ordering are the same for every analysis.
    """
    solver = Timed(threads)
    results = ct.solve(model, step, fields=False, keep="last", threads=threads, solver=solver)
    seconds = solver.clock() - solver.ready
    return seconds, statistics.median(solver.factorizations), results


def increments(size: str, threads: int, repeats: int) -> list[object]:
    """Time per increment of both controls, increments of the same size, in turn."""
    model = strut(*SIZES[size], across=1.0, along=0.0)
    times: dict[str, list[float]] = {"load": [], "arc": []}
    counts = {}
    steps = {
        "load": ct.Static(increments=INCREMENTS, fixed_increments=True),
        "arc": ct.Static(
            increments=INCREMENTS,
            fixed_increments=True,
            path=ct.ArcLength(increments=INCREMENTS),
        ),
    }
    for _ in range(repeats):
        for name, step in steps.items():
            seconds, _, results = run(model, step, threads)
            times[name].append(seconds)
            counts[name] = (results.info["iterations"], results.frames[-1].factor)
    load, arc = (statistics.median(times[k]) / INCREMENTS for k in ("load", "arc"))
    return [
        size,
        results.info["n_dofs"],
        threads,
        f"{counts['load'][0]} / {counts['arc'][0]}",
        round(counts["arc"][1], 3),
        load,
        arc,
        arc / load,
        "yes" if arc <= ARC_TARGET * load else "NO",
    ]


def buckling(size: str, threads: int, repeats: int) -> list[object]:
    """Time of the lowest factors over that of a factorization."""
    model = strut(*SIZES[size], across=0.0, along=1.0)
    rows = []
    for _ in range(repeats):
        seconds, factor, results = run(model, ct.Buckle(modes=3), threads)
        rows.append((seconds, factor))
    seconds, factor = min(rows)
    ratio = seconds / factor
    euler = 3.141592653589793**2 * 1000.0 * 10.0**3 / 12.0 / (4.0 * 100.0**2)
    return [
        size,
        results.info["n_dofs"],
        threads,
        results.modes[0].factors[0] / euler,
        factor,
        seconds,
        ratio,
        "yes" if ratio <= BUCKLING_TARGET else "NO",
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", nargs="*", choices=SIZES, default=list(SIZES))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    args = parser.parse_args()
    if "OPENBLAS_NUM_THREADS" not in os.environ:
        # NumPy's threads are set before it is imported.
        environment = dict(os.environ, OPENBLAS_NUM_THREADS=str(args.threads))
        command = [sys.executable, "-m", "benchmarks.speed.paths", *sys.argv[1:]]
        sys.exit(subprocess.run(command, env=environment, check=False).returncode)
    cases = [(s, args.threads, args.repeats) for s in args.sizes]
    head = [
        "size",
        "equations",
        "threads",
        "iterations load/arc",
        "factor by arc",
        "load [s/inc]",
        "arc [s/inc]",
        "ratio",
        f"<= {ARC_TARGET}",
    ]
    report("Arc length beside load control", head, [increments(*c) for c in cases])
    head = [
        "size",
        "equations",
        "threads",
        "factor / Euler",
        "factorization [s]",
        "buckling [s]",
        "ratio",
        f"<= {BUCKLING_TARGET:g}",
    ]
    report("Three buckling modes", head, [buckling(*c) for c in cases])


if __name__ == "__main__":
    main()
