"""One model on one and two processes, beside the default solver: values, time, memory.

``python -m benchmarks several_processes`` starts ``mpiexec`` for each row:

``--catalogue`` runs the analyses of a part of the verification catalogue, of all kinds, again with
the solver ``petsc`` on all processes together: displacements and reactions of every frame,
displacements at the end and eigenvalues of modes, against those of the default solver.
``rounded`` is the default solver again, for matrices whose entries are changed by a rounding error
each: results are no more certain than what it changes.

``--problems P1:40k P2:40k`` runs increments of the benchmark problems; ``--gamg 143 250`` the
multigrid on a clamped square with so many elements a side, ``--solvers 1414`` each solver on one
process there. ``--times`` adds wall time, processor time [s] and the efficiency, time of one
process over all of several: a process that waits for a message uses its core, so they mean
something only on a quiet machine.

Each row is kept in a file when it is measured (``--rows``, results/several_processes.json), and
``--continue`` takes those of a run that was stopped. ``--limit`` ends a row after so many seconds.
``--write`` puts the tables into docs/scale.md. A row that fails, as without enough memory, is
missing, and the exit code is 1.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import resource
import signal
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
from benchmarks.corpora.problems import build
from benchmarks.peers.run_corota import model_of
from benchmarks.speed.solvers_agree import NAMES
from corota.analysis.linear.solvers import Multifrontal
from corota.errors import CorotaError

#: Solvers of ``--solvers``; PARDISO and PETSc need their extras.
SOLVERS = ("multifrontal", "pardiso", "superlu", "petsc", "petsc:gamg")
ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "scale.md"
#: Problems of the catalogue that are too small to be cut, or solve nothing.
LEFT_OUT = {"best_fit_frame", "rigid_spin", "zero_modes"}
CATALOGUE = [*(n for n in NAMES if n not in LEFT_OUT), "pendulum", "thick_cylinder_plastic"]
#: Share of the stiffness times the displacements below which reactions are rounding errors.
ROUNDING = 1e-9


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


def differences(ours: Any, theirs: Any) -> tuple[float, ...]:
    """Largest relative differences: displacements, those of the last frame, reactions, modes.

    Displacements and reactions are infinite where the frames are not those of the same increments,
    except in the last frame. Reactions that are rounding errors, as in free expansion, are compared
    with the force of the displacements in the stiffness.
    """
    pairs = list(zip(ours.frames, theirs.frames, strict=False))
    moved = max((_size(a.U) for a, _ in pairs), default=0.0)
    errors = [_size(a.U - b.U) for a, b in pairs] or [0.0]
    force = max((max(_size(a.RF), _size(a.F)) for a, _ in pairs), default=0.0)
    held = max((_size(a.RF - b.RF) for a, b in pairs), default=0.0)
    moduli = [getattr(s.material, "E", 0.0) * s.thickness for s in ours.model.sections]
    stiff = max(moduli, default=0.0) * moved
    force = force if force > ROUNDING * stiff else stiff
    modes = [
        _size(_eigenvalues(a) - _eigenvalues(b)) / (_size(_eigenvalues(a)) or 1.0)
        for a, b in zip(ours.modes, theirs.modes, strict=True)
    ]
    moved = moved or 1.0  # then all are zero
    last = _size(ours.frames[-1].U - theirs.frames[-1].U) if pairs else 0.0
    worst = max(errors) / moved, last / moved, held / (force or 1.0), max(modes, default=0.0)
    if len(ours.frames) != len(theirs.frames):
        return np.inf, worst[1], np.inf, worst[3]
    return worst


def _eigenvalues(modes: Any) -> Any:
    """Load factors, or squares of frequencies: roots of zero would be large."""
    return modes.factors**2 if modes.kind == "frequency" else modes.factors


def _size(values: Any) -> float:
    return float(np.abs(values).max(initial=0.0))


class Rounded(Multifrontal):
    """The default solver for matrices whose entries are changed by a rounding error each."""

    def __init__(self, symmetric: bool = True) -> None:
        super().__init__(symmetric)
        self._random = np.random.default_rng(1)

    def factorize(self, data: Any) -> Any:
        error = np.finfo(float).eps * self._random.uniform(-1.0, 1.0, len(data))
        return super().factorize(data * (1.0 + error))


def catalogue_rows(names: list[str], solver: str) -> list[list[object]]:
    """Name, analyses, frames and the differences of each problem."""
    rows: list[list[object]] = []
    for name in names:
        worst = np.zeros(4)
        count = frames = 0
        for given, ours in analyses(name):
            model, steps, _, _, _, keep, fields, start = given
            if ours is None or start is not None:
                continue
            own = Rounded() if solver == "rounded" else solver
            try:
                theirs = analysis.solve(
                    model, steps, solver=own, threads=1, keep=keep, fields=fields
                )
            except CorotaError as error:
                if "each process needs an element" in str(error):
                    continue
                raise
            count, frames = count + 1, frames + len(ours.frames)
            worst = np.maximum(worst, differences(ours, theirs))
        reported = [f"{value:.1e}" if np.isfinite(value) else "other increments" for value in worst]
        rows.append([name, count, frames, *reported])
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
        found = catalogue_rows(rest[:1], ":".join(rest[1:]))
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


class Starter:
    """Starts rows of tables, and keeps what they found in a file.

    Parameters
    ----------
    path : Path
        The file.
    again : bool
        Whether rows of a run before are taken from the file; they stay in it in either case.
    limit : float
        Time after which a row is given up [s].
    """

    def __init__(self, path: Path, again: bool, limit: float) -> None:
        self.path, self.limit, self.failed = path, limit, 0
        self.kept: dict[str, list[Any]] = {}
        if path.exists():
            self.kept = json.loads(path.read_text(encoding="utf-8"))
        self.known = dict(self.kept) if again else {}

    def started(self, job: str, count: int) -> list[Any]:
        """What each of `count` processes found, nothing after the limit; 0 is without mpiexec."""
        key = f"{job} on {count}"
        if key not in self.known:
            found = self._run(job, count)
            if not found:
                return []
            self.known[key] = self.kept[key] = found
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self.path.write_text(json.dumps(self.kept, indent=1), encoding="utf-8")
        return self.known[key]

    def _run(self, job: str, count: int) -> list[Any]:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "found.json"
            command = [sys.executable, "-m", "benchmarks.speed.several_processes", "--worker"]
            command += [job, str(path)]
            if count:
                command = ["mpiexec", "-n", str(count), *command]
            own = {
                "OMP_NUM_THREADS": "1",
                "OMPI_MCA_mpi_yield_when_idle": "0",
                "OMPI_ALLOW_RUN_AS_ROOT": "1",  # containers
                "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            }
            with subprocess.Popen(command, env=os.environ | own, start_new_session=True) as run:
                try:
                    code = run.wait(self.limit)
                except subprocess.TimeoutExpired:
                    os.killpg(run.pid, signal.SIGTERM)
                    sys.stderr.write(f"{job} on {count}: given up after {self.limit:g} s\n")
                    return []
            if code:
                sys.stderr.write(f"{job} on {count} processes: exit code {code}\n")
                self.failed += 1
                return []
            found: list[Any] = json.loads(path.read_text(encoding="utf-8"))
            return found


def cost_rows(
    starter: Starter, jobs: list[tuple[str, str, list[int]]], times: bool
) -> list[list[object]]:
    """A row for each job and number of processes; values against the first row of a job."""
    rows: list[list[object]] = []
    reference: dict[str, list[float]] = {}
    for job, solver, counts in jobs:
        alone = 0.0
        for count in counts:
            found = starter.started(f"{job}:{solver}", count)
            if not found:
                continue
            one = found[0]
            expected = reference.setdefault(job, one["U"])
            error = max(abs(a / b - 1.0) for a, b in zip(one["U"], expected, strict=True))
            wall = max(f["wall"] for f in found)
            alone = wall if count == 1 else alone
            spent = [
                f"{wall:.1f}",
                " ".join(f"{f['cpu']:.1f}" for f in found),
                f"{alone / wall / count:.2f}" if count > 1 and alone else "",
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
TIMES = ["wall s", "CPU s", "efficiency"]
VALUES = ["problem", "solver", "processes", "analyses", "frames", "U", "last U", "RF", "modes"]


def _squares(sides: list[int]) -> list[str]:
    return [f"square:{side}" for side in sides]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--worker", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("--processes", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--catalogue", nargs="*", metavar="NAME")
    parser.add_argument("--problems", nargs="*", default=[], metavar="NAME:SIZE")
    parser.add_argument("--gamg", type=int, nargs="*", default=[], metavar="SIDE")
    parser.add_argument("--solvers", type=int, nargs="*", default=[], metavar="SIDE")
    parser.add_argument("--times", action="store_true", help="wall and processor time too")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/scale.md")
    parser.add_argument("--rows", type=Path, default=ROOT / "results" / "several_processes.json")
    parser.add_argument("--continue", dest="again", action="store_true", help="take known rows")
    parser.add_argument("--limit", type=float, default=900.0, help="seconds for a row")
    args = parser.parse_args()
    if args.worker:
        worker(args.worker[0], Path(args.worker[1]))
        return 0
    starter = Starter(args.rows, args.again, args.limit)
    sys.stdout.write(f"{machine()}\n\n")
    if args.catalogue is not None:
        names = args.catalogue or CATALOGUE
        rows = []
        for name in names:
            for solver, counts in (("rounded", [0]), ("petsc", args.processes)):
                for count in counts:
                    for row in starter.started(f"catalogue:{name}:{solver}", count)[:1]:
                        rows.append([name, solver, max(count, 1), *row[0][1:]])
        text = table(VALUES, rows)
        sys.stdout.write(f"{text}\n\n")
        if args.write:
            write_between(PAGE, "catalogue", text)
    both = [("multifrontal", [0])]
    for name, of, runs in (
        ("distributed", args.problems, [*both, ("petsc", args.processes)]),
        ("multigrid", _squares(args.gamg), [*both, ("petsc:gamg", args.processes)]),
        ("solvers", _squares(args.solvers), [(s, [0]) for s in SOLVERS]),
    ):
        jobs = [(problem, solver, counts) for problem in of for solver, counts in runs]
        if not jobs:
            continue
        head = [*COST, *(TIMES if args.times else [])]
        text = table(head, cost_rows(starter, jobs, args.times))
        sys.stdout.write(f"{text}\n\n")
        if args.write:
            write_between(PAGE, name, text)
    return 1 if starter.failed else 0


if __name__ == "__main__":
    sys.exit(main())
