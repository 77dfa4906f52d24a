"""Corota and its peers on the same problems, in turn, in one run: times, memory and results.

P1 (large rotation), P2 (plasticity), P3 (contact), P3f (with friction), P4 (transient) and P4x2
(twice the load) on meshes from 400 to a million dofs. Every program is a process of its own under
GNU ``time``; in each round all of them run one after the other, so that a disturbance meets them
alike, and medians are compared. Two groups:

* *increments*: what the increments take, reading and output left out, driven from Python;
* *deck*: the whole process with reading and writing, the same file in Corota and CalculiX.

Each run appends a line to ``results/bench/runs.jsonl``; ``python -m benchmarks bench_tables`` makes
tables and figures of it. Installs the peers first (``benchmarks/peers/install.py``).
``--problems --sizes --threads --repeats --limit --last --programs --output``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import shutil
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.common import TIME_LIMIT, machine, process
from benchmarks.corpora import decks
from benchmarks.corpora.problems import LIKE, SIZES, Problem, build
from benchmarks.peers.install import PEERS, install, interpreter

ROOT = Path(__file__).resolve().parents[2]
RUNS = ROOT / "results" / "bench" / "runs.jsonl"


@dataclass(frozen=True)
class Program:
    """One row of the tables: a program with an element, and the problems that it can do."""

    name: str
    element: str
    problems: str
    group: str = "increments"
    driver: str = ""
    options: tuple[str, ...] = ()
    order: int = 1
    serial: bool = False

    @property
    def label(self) -> str:
        """Name in tables."""
        return f"{self.name} {self.element}"


PROGRAMS = (
    Program("Corota", "Q4, green_lagrange", "P1 P4", driver="corota"),
    Program("Corota", "Q4, logarithmic", "P2", driver="corota", options=("strain=logarithmic",)),
    Program("Corota", "Q4I", "P1 P4", driver="corota", options=("element=Q4I", "strain=linear")),
    Program(
        "Corota",
        "Q4I, logarithmic",
        "P2",
        driver="corota",
        options=("element=Q4I", "strain=logarithmic"),
    ),
    Program("Corota", "Q4, HHT", "P4", driver="corota", options=("scheme=hht",)),
    Program(
        "Corota", "Q4, energy-momentum", "P4", driver="corota", options=("scheme=energy_momentum",)
    ),
    Program("Corota", "Q4, mortar", "P3", driver="corota"),
    Program(
        "Corota", "Q4, node to segment", "P3", driver="corota", options=("method=node_to_segment",)
    ),
    Program("Kratos", "TL 4N, ALM mortar", "P3", driver="kratos_contact"),
    Program("Corota", "CPS4, surf. to surf.", "P3", "deck"),
    Program("CalculiX", "CPS4, surf. to surf.", "P3", "deck"),
    Program("CalculiX", "CPS4, node to surf.", "P3", "deck", options=("NODE TO SURFACE",)),
    Program("Kratos", "TotalLagrangian 4N", "P1 P2 P4", driver="kratos"),
    Program("Akantu", "quadrangle 4", "P1 P4", driver="akantu"),
    Program("DOLFINx", "Q1", "P1 P4", driver="dolfinx"),
    Program("scikit-fem", "Quad1", "P1", driver="scikit_fem", serial=True),
    Program("FElupe", "Quad", "P1", driver="felupe", serial=True),
    Program("OpenSeesPy", "ASDShellQ4", "P1 P4", driver="openseespy", serial=True),
    Program("OpenSeesPy", "quad, small displ.", "P2", driver="openseespy", serial=True),
    Program("Corota", "CPS4", "P1 P2 P4", "deck"),
    Program("Corota", "CPS4=Q4I", "P1 P2 P4", "deck"),
    Program("CalculiX", "CPS4", "P1 P2 P4", "deck"),
    Program("Corota", "CPS8", "P1 P2", "deck", order=2),
    Program("CalculiX", "CPS8", "P1 P2", "deck", order=2),
)


def run_driver(program: Program, p: Problem, folder: Path, threads: int, limit: float) -> Any:
    """One run of a driver of ``benchmarks.peers``."""
    known = {name.lower().replace("-", "_"): name for name in PEERS} | {"kratos_contact": "Kratos"}
    python: Path | None = Path(sys.executable)
    if program.driver in known:
        python = interpreter(known[program.driver])
    if python is None:
        return {"ok": False, "note": "not installed"}
    p.save(folder / "problem.npz")
    extra = [f"threads={threads}"] if program.driver == "corota" else []
    path = f"PYTHONPATH={ROOT}:{ROOT / 'src'}" if program.driver == "corota" else None
    command: list[str | Path] = [
        "env",
        path or f"PYTHONPATH={ROOT}",
        python,
        "-m",
        f"benchmarks.peers.run_{program.driver}",
        "problem.npz",
        *program.options,
        *extra,
    ]
    run = process(command, folder, threads=threads, limit=limit)
    record = {"total": run.seconds, "peak_mb": run.peak_mb, "ok": run.ok, "note": run.note}
    lines = [line for line in run.output.splitlines() if line.startswith('{"version"')]
    if run.ok and lines:
        return record | json.loads(lines[-1])
    said = [t for t in run.output.splitlines() if "converge" in t or "rror" in t]
    return record | {"ok": False, "note": (said[-1].strip()[:80] if said else run.note) or "died"}


def run_deck(program: Program, p: Problem, folder: Path, threads: int, limit: float) -> Any:
    """One run of Corota or CalculiX on a deck."""
    deck = folder / "job.inp"
    decks.write_deck(deck, p, *program.options)
    command: list[str | Path]
    if program.name == "CalculiX":
        command, out = ["ccx", "-i", "job"], folder / "job"
    else:
        command = [
            "env",
            f"PYTHONPATH={ROOT / 'src'}",
            sys.executable,
            "-m",
            "corota",
            "run",
            deck,
            "-o",
            folder / "out",
            "--threads",
            str(threads),
        ]
        command += ["--element", program.element] if "=" in program.element else []
        out = folder / "out" / "job"
    run = process(command, folder, threads=threads, limit=limit)
    record: dict[str, Any] = {
        "total": run.seconds,
        "solve": run.seconds,
        "cpu": run.cpu,
        "peak_mb": run.peak_mb,
        "ok": run.ok,
        "note": run.note,
    }
    sta, dat = out.with_suffix(".sta"), out.with_suffix(".dat")
    if not (run.ok and sta.exists() and dat.exists()):
        return record | {"ok": False, "note": run.note or "no results"}
    count, end = decks.iterations(sta)
    whole = p.period * p.last / p.increments if p.name == "P4" else 1.0
    if end < whole * (1.0 - 1e-6):
        return record | {"ok": False, "note": f"stopped at {end / whole:.0%} of the load"}
    return record | {"iterations": count, "result": decks.result(dat, p)}


def run(
    program: Program, name: str, size: str, threads: int, limit: float, last: int | None
) -> dict[str, Any]:
    """One run of a program, as the record that is kept."""
    p = build(name, size, program.order, last)
    record: dict[str, Any] = {
        "problem": name,
        "size": size,
        "dofs": p.n_dofs,
        "elements": len(p.cells),
        "increments": p.last,
        "threads": threads,
        "program": program.name,
        "element": program.element,
        "group": program.group,
        "order": program.order,
        "load": os.getloadavg()[0],
        "when": time.strftime("%Y-%m-%d %H:%M"),
    }
    with tempfile.TemporaryDirectory(prefix="corota-bench-") as place:
        work = run_deck if program.group == "deck" else run_driver
        return record | work(program, p, Path(place), threads, limit)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--problems", nargs="+", default=list(SIZES), choices=list(SIZES))
    known = list(dict.fromkeys(size for sizes in SIZES.values() for size in sizes))
    usual = ["400", "1k", "4k", "33k", "40k"]
    parser.add_argument("--sizes", nargs="+", default=usual, choices=known)
    parser.add_argument("--threads", nargs="+", type=int, default=[1, 2])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--limit", type=float, default=TIME_LIMIT, help="longest time of a run [s]")
    parser.add_argument("--last", type=int, help="increments to run, instead of the default")
    parser.add_argument("--programs", nargs="+", help="only names that begin so")
    parser.add_argument("--output", type=Path, default=RUNS)
    args = parser.parse_args()
    for peer in PEERS:
        if not install(peer):
            sys.stdout.write(f"{peer} is not installed and cannot be: left out\n")
    if shutil.which("ccx") is None:
        sys.stdout.write("CalculiX (ccx) is not installed: install the package calculix-ccx\n")
    args.output.parent.mkdir(parents=True, exist_ok=True)
    session = f"{time.time():.0f}"
    sys.stdout.write(f"{machine()}\n")
    out_of_reach: set[tuple[str, str, int]] = set()
    for size in args.sizes:
        for name in (name for name in args.problems if size in SIZES[name]):
            for threads in args.threads:
                chosen = [
                    p
                    for p in PROGRAMS
                    if LIKE.get(name, name) in p.problems.split()
                    and (threads == 1 or not p.serial)
                    and (not args.programs or p.label.startswith(tuple(args.programs)))
                ]
                repeats = args.repeats if SIZES[name][size][0] < 40 else 1
                for repeat in range(repeats):
                    for program in chosen:
                        key = (program.label, name, threads)
                        if key in out_of_reach:
                            continue
                        record = run(program, name, size, threads, args.limit, args.last)
                        record |= {"session": session, "repeat": repeat, "machine": machine()}
                        with args.output.open("a", encoding="utf-8") as file:
                            file.write(json.dumps(record) + "\n")
                        if not record["ok"]:
                            out_of_reach.add(key)
                        solve = record.get("solve", 0.0)
                        sys.stdout.write(
                            f"{name} {size} {threads}t {program.label}: "
                            f"{record['note'] or f'{solve:.3f} s'}"
                            f" {record.get('iterations', '')} {record.get('result', '')}\n"
                        )
                        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
