"""One model on one and two processes, beside the default solver: values, time, memory.

``python -m benchmarks.several_processes`` starts ``mpiexec`` for each row:

``--catalogue`` runs the analyses of a part of the verification catalogue, of all kinds, again with
the solver ``petsc`` on all processes together: displacements and reactions of every frame against
those of the default solver.

``--problems P1:40k P2:40k`` runs increments of the benchmark problems; ``--gamg 143 286`` the
multigrid on a clamped square with so many elements a side. ``--times`` adds wall and processor time
[s]: a process that waits for a message uses its core, so they mean something only on a quiet
machine. ``--write`` puts the tables into docs/scale.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
import corota.analysis.run as analysis
from benchmarks.common import machine, table, write_between
from benchmarks.peers.run_corota import model_of
from benchmarks.problems import build
from benchmarks.solvers_agree import NAMES
from corota.errors import CorotaError

PAGE = Path(__file__).parents[1] / "docs" / "scale.md"
#: Problems of the catalogue that are too small to be cut, or take minutes.
LEFT_OUT = {"best_fit_frame"}
CATALOGUE = [name for name in NAMES if name not in LEFT_OUT]
#: Time of one row [s].
LIMIT = 1800.0


# -- on every process --------------------------------------------------------------------


def analyses(name: str) -> list[tuple[Any, Any]]:
    """Arguments and results of all analyses that a problem of the catalogue makes."""
    from corota.verification.catalogue import problems

    found: list[tuple[Any, Any]] = []

    class Watched(analysis.Analysis):
        def __init__(self, *given: Any) -> None:
            super().__init__(*given)
            self.given = given

        def run(self) -> Any:
            found.append((self.given, None))
            results = super().run()
            found[-1] = (self.given, results)
            return results

    before = analysis.Analysis
    analysis.Analysis = Watched  # type: ignore[misc]
    for module in [m for k, m in sys.modules.items() if k.startswith("corota.verification")]:
        for item in vars(module).values():  # problems keep their results
            if hasattr(item, "cache_clear"):
                item.cache_clear()
    try:
        list(problems()[name].measure())
    finally:
        analysis.Analysis = before  # type: ignore[misc]
    return found


def differences(ours: Any, theirs: Any) -> tuple[float, float]:
    """Largest relative differences of displacements and of forces.

    Reactions are compared with the largest of reactions, loads and the mean force in the body,
    because in free expansion reactions are rounding errors of that.
    """
    pairs = list(zip(ours.frames, theirs.frames, strict=True))
    moved = max((float(np.abs(a.U).max()) for a, _ in pairs), default=0.0)
    error = max((float(np.abs(a.U - b.U).max()) for a, b in pairs), default=0.0)
    force = max((max(float(np.abs(x).max()) for x in (a.RF, a.F)) for a, _ in pairs), default=0.0)
    held = max((float(np.abs(a.RF - b.RF).max()) for a, b in pairs), default=0.0)
    for a in (a for a, _ in pairs if a.fields):
        size = float(
            np.ptp(np.concatenate([f.points.reshape(-1, 2) for f in a.fields]), axis=0).max()
        )
        inside = sum(float((np.abs(f.values["S"]).max(axis=2) * f.volume).sum()) for f in a.fields)
        force = max(force, inside / size)
    return error / moved if moved else 0.0, held / force if force else 0.0


def catalogue_rows(names: list[str]) -> list[list[object]]:
    """Name, analyses, frames and the two differences of each problem."""
    rows: list[list[object]] = []
    for name in names:
        worst = (0.0, 0.0)
        count = frames = 0
        for given, ours in analyses(name):
            model, steps, _, _, _, keep, fields, start = given
            if ours is None or start is not None:
                continue
            try:
                theirs = analysis.solve(
                    model, steps, solver="petsc", threads=1, keep=keep, fields=fields
                )
            except CorotaError as error:
                if "each process needs an element" in str(error):
                    continue
                raise
            count, frames = count + 1, frames + len(ours.frames)
            u, rf = differences(ours, theirs)
            worst = max(worst[0], u), max(worst[1], rf)
        rows.append([name, count, frames, f"{worst[0]:.1e}", f"{worst[1]:.1e}"])
        sys.stderr.write(f"{rows[-1]}\n")
    return rows


def run_problem(name: str, size: str, solver: str) -> dict[str, Any]:
    """Time, memory and result of one benchmark problem."""
    p = build(name, size)
    model = model_of(p, "Q4I", "linear")
    share = p.last / p.increments
    step: ct.Static | ct.Dynamic
    if p.name == "P4":
        step = ct.Dynamic(period=p.period * share, increments=p.last, mass="constant")
    else:
        for item in (*model.supports, *model.loads):
            item.value *= share
        step = ct.Static(increments=p.last)
    return solved(model, step, solver)


def square(side: int) -> tuple[ct.Model, ct.Static]:
    """An elastic square clamped at one side and sheared at the other."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=side, ny=side))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-1.0)
    return model, ct.Static(nlgeom=False)


def solved(model: Any, step: Any, solver: str) -> dict[str, Any]:
    """Run a model; what it costs this process."""
    before, begin = time.process_time(), time.perf_counter()
    own = analysis.make_solver(solver)
    results = ct.solve(model, step, solver=own, threads=1, fields=False, keep="last")
    frame = results.frames[-1]
    return {
        "dofs": results.info["n_dofs"],
        "cpu": time.process_time() - before,
        "wall": time.perf_counter() - begin,
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6,
        "iterations": results.info["iterations"],
        "krylov": getattr(own, "iterations", 0),
        "U": [float(np.abs(frame.U).max()), float(np.linalg.norm(frame.U))],
    }


def worker(job: str, path: Path) -> None:
    """Carry out a job on all processes; process 0 writes what all have found."""
    warnings.simplefilter("ignore")
    kind, *rest = job.split(":")
    found: Any
    if kind == "catalogue":
        found = catalogue_rows(rest)
    elif kind == "square":
        found = solved(*square(int(rest[0])), ":".join(rest[1:]))
    else:
        found = run_problem(kind, rest[0], ":".join(rest[1:]))
    every = [found]
    if int(os.environ.get("OMPI_COMM_WORLD_SIZE", os.environ.get("PMI_SIZE", "1"))) > 1:
        from mpi4py import MPI

        every = MPI.COMM_WORLD.gather(found)
    if every is not None:
        path.write_text(json.dumps(every))


# -- the process that starts them --------------------------------------------------------


def started(job: str, count: int) -> list[Any]:
    """What each of `count` processes found; 0 is this program without mpiexec."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "found.json"
        command = [sys.executable, "-m", "benchmarks.several_processes", "--worker", job, str(path)]
        if count:
            command = ["mpiexec", "-n", str(count), *command]
        own = {"OMP_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "0"}
        subprocess.run(command, env=os.environ | own, check=True, timeout=LIMIT)
        found: list[Any] = json.loads(path.read_text())
        return found


def cost_rows(jobs: list[tuple[str, str, list[int]]], times: bool) -> list[list[object]]:
    """A row for each job and number of processes; values against the first row of a job."""
    rows: list[list[object]] = []
    reference: dict[str, list[float]] = {}
    for job, solver, counts in jobs:
        for count in counts:
            found = started(f"{job}:{solver}", count)
            one = found[0]
            expected = reference.setdefault(job, one["U"])
            error = max(abs(a / b - 1.0) for a, b in zip(one["U"], expected, strict=True))
            spent = [
                f"{max(f['wall'] for f in found):.1f}",
                " ".join(f"{f['cpu']:.1f}" for f in found),
            ]
            rows.append(
                [
                    job.replace(":", " "),
                    one["dofs"],
                    solver,
                    max(count, 1),
                    one["iterations"],
                    one["krylov"] or "",
                    " ".join(f"{f['memory']:.2f}" for f in found),
                    f"{error:.1e}",
                    *(spent if times else []),
                ]
            )
            sys.stderr.write(f"{rows[-1]}\n")
    return rows


COST = ["problem", "dofs", "solver", "processes", "Newton", "CG", "GB", "values"]
TIMES = ["wall s", "CPU s"]
VALUES = ["problem", "analyses", "frames", "U", "RF"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--worker", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("--processes", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--catalogue", nargs="*", metavar="NAME")
    parser.add_argument("--problems", nargs="*", default=[], metavar="NAME:SIZE")
    parser.add_argument("--gamg", type=int, nargs="*", default=[], metavar="SIDE")
    parser.add_argument("--times", action="store_true", help="wall and processor time too")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/scale.md")
    args = parser.parse_args()
    if args.worker:
        worker(args.worker[0], Path(args.worker[1]))
        return 0
    sys.stdout.write(f"{machine()}\n\n")
    if args.catalogue is not None:
        names = args.catalogue or CATALOGUE
        rows = []
        for count in args.processes:
            for name in names:
                row = started(f"catalogue:{name}", count)[0][0]
                rows.append([row[0], count, *row[1:]])
        text = table([VALUES[0], "processes", *VALUES[1:]], rows)
        sys.stdout.write(f"{text}\n\n")
        if args.write:
            write_between(PAGE, "catalogue", text)
    jobs = [
        (p, s, c)
        for p in args.problems
        for s, c in (("multifrontal", [0]), ("petsc", args.processes))
    ]
    jobs += [
        (f"square:{side}", s, c)
        for side in args.gamg
        for s, c in (("multifrontal", [0]), ("petsc:gamg", args.processes))
    ]
    if jobs:
        text = table([*COST, *(TIMES if args.times else [])], cost_rows(jobs, args.times))
        sys.stdout.write(f"{text}\n")
        if args.write:
            write_between(PAGE, "distributed", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
