"""Runs are killed at any moment, resumed until they are done, and compared to the bit.

``python -m benchmarks kill [--runs 300] [--seconds N] [--signal KILL|TERM]`` takes all examples on
coarse meshes, and small decks and models of every procedure (:mod:`restart_cases`).
Half of the strikes with KILL fall inside a write: between halves of a piece of text or of the
numbers of a result file, and before or after a renaming, a removal or a flush; the others come by
the clock. After each strike every result file is opened by h5py and, where it is installed, by
VTK's reader; the frames and rows found must be the first ones of the run that was never stopped.
In the end all files must be the same. Then checkpoints are damaged (``--damaged 500``): what a run
makes of them must be the same too, or an error. ``--write`` puts the table into docs/restart.md.
The runs are kept in ``build/kill.jsonl``: a campaign that was ended goes on where it was.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import math
import random
import shutil
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path

import h5py
import numpy as np

import corota as ct
from benchmarks.campaigns.campaign_store import CampaignStore
from benchmarks.campaigns.kill_worker import JOB, Case, Strike, run
from benchmarks.campaigns.same_bits import folder_differences, records
from benchmarks.common import machine, write_between
from benchmarks.corpora.restart_cases import DECKS, EXAMPLES, MODELS, SWEEPS
from corota.errors import FileError
from corota.io.checkpoint import newest
from corota.io.job import JobFiles
from corota.model.steps import Step

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError:
    vtkHDFReader = None

PAGE = Path(__file__).resolve().parents[2] / "docs/restart.md"
#: Times that a run is struck at most.
MOST_STRIKES = 3


def cases() -> list[Case]:
    """All cases: decks, models and examples in turn."""
    found = [Case(name, "decks", deck=build()) for name, build in DECKS.items()]
    found += [
        Case(name, "sweeps", deck=deck, values=values) for name, (deck, values) in SWEEPS.items()
    ]
    if find_spec("petsc4py") is not None:
        solved = ("large rotations", "isotropic hardening", "contact", "motion, HHT")
        options = ("--solver", "petsc")
        found += [Case(f"{n}, PETSc", "PETSc", DECKS[n](), options=options) for n in solved]
    found += [Case(name, "models", build=build) for name, build in MODELS.items()]
    found += [Case(name, "examples", build=build) for name, build in EXAMPLES.items()]
    return found


@dataclass
class Whole:
    """A run that was not stopped: its files, exit code, duration and calls that write."""

    case: Case
    folder: Path
    code: int
    seconds: float
    calls: dict[str, int]
    every: int


@dataclass
class Tally:
    """What happened to the runs of a kind."""

    runs: int = 0
    same: int = 0
    counts: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Add what happened to others."""
        self.runs += other.runs
        self.same += other.same
        self.counts += other.counts
        self.faults += other.faults


def whole(case: Case, base: Path, every: int) -> Whole:
    """Run a case without a stop."""
    own = base / f"{case.kind}-{case.name}".replace(" ", "_").replace(",", "")
    own.mkdir(parents=True)
    if case.deck:
        (own / f"{JOB}.inp").write_text(case.deck)
    folder = own / "whole"
    begin = time.perf_counter()
    code, log = run(case, folder, every, False, Strike())
    seconds = time.perf_counter() - begin
    if code not in (0, 4):
        raise SystemExit(f"{case.name} does not run: exit code {code}: {log}")
    calls = json.loads(folder.with_suffix(".calls").read_text())
    return Whole(case, folder, code, seconds, calls, every)


# -- what a struck run leaves ------------------------------------------------------------------


def look(folder: Path, reference: Path, counts: Counter[str]) -> list[str]:
    """Open all files of a run that was ended; what is wrong with them."""
    wrong: list[str] = []
    frames = -1
    if not folder.exists():  # ended before it was made
        return wrong
    result = folder / f"{JOB}.vtkhdf"
    if result.exists():
        counts["h5py"] += 1
        try:
            frames, found = _first_frames(result, reference / result.name)
            wrong += found
            if vtkHDFReader is not None:
                counts["vtk"] += 1
                wrong += _by_vtk(result, frames)
        except (OSError, KeyError, ValueError) as error:
            wrong.append(f"{result.name} does not open: {error}")
    for path in sorted(folder.iterdir()):
        wrong += _first_rows(path, reference / path.name)
    if any(folder.glob(f"{JOB}.ckpt*")):
        try:
            saved, refused = newest(folder / JOB)
            wrong += refused
            if frames < saved.files["big"]["vtkhdf"]["count"]:
                wrong.append(f"{frames} frames, fewer than the checkpoint expects")
        except FileError as error:
            wrong.append(str(error))
    return wrong


def _first_frames(path: Path, reference: Path) -> tuple[int, list[str]]:
    """Frames of a result file, and what is not as in the file of the whole run."""
    wrong = []
    with h5py.File(path) as one, h5py.File(reference) as other:
        count = int(one["VTKHDF/Steps"].attrs["NSteps"])
        names: list[str] = []
        one.visititems(lambda name, item: names.append(name) if hasattr(item, "shape") else None)
        for name in names:
            if name not in other:
                wrong.append(f"{name} is not in the file of the whole run")
                continue
            a, b = one[name][()], other[name][()]
            if a.tobytes() != b[: len(a)].tobytes():
                wrong.append(f"{name} differs within {count} frames")
    return count, wrong


def _by_vtk(path: Path, frames: int) -> list[str]:
    """Read the first and the last frame with VTK; what is not as h5py says."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(Pipeline.TIME_STEPS()) or ()
    if len(times) != frames and frames > 1:  # VTK gives no times where there is one
        return [f"VTK finds {len(times)} frames of {frames}"]
    wrong = []
    with h5py.File(path) as file:
        moved, nodes = file["VTKHDF/PointData/displacement"], len(file["VTKHDF/Points"])
        for k in {0, frames - 1} if frames else set():
            if times:
                reader.UpdateTimeStep(times[k])
            else:
                reader.Update()
            found = reader.GetOutput().GetPointData().GetArray("displacement")
            if found is None or not np.array_equal(
                vtk_to_numpy(found), moved[k * nodes : (k + 1) * nodes]
            ):
                wrong.append(f"VTK reads other displacements in frame {k}")
    return wrong


def _first_rows(path: Path, reference: Path) -> list[str]:
    """What a table holds that is not the beginning of the whole one."""
    ending = path.suffix[1:]
    if ending in ("sta", "cvg", "dat"):
        if not reference.read_bytes().startswith(path.read_bytes()):
            return [f"{path.name} is not the beginning of the whole one"]
    elif ending == "jsonl":
        text = path.read_text()
        kept = path.with_suffix(".lines")
        kept.write_text(text[: text.rfind("\n") + 1])
        mine, all_rows = records(kept), records(reference)
        kept.unlink()
        if mine and mine[-1].get("event") == "end":
            mine.pop()  # a run that a signal ends says so
        if mine != all_rows[: len(mine)]:
            return [f"{path.name} is not the beginning of the whole one"]
    elif ending == "csv":
        mine_rows, whole_rows = _columns(path), _columns(reference)
        for name, values in mine_rows.items():
            if values != whole_rows.get(name, [])[: len(values)]:
                return [f"{path.name}: column {name} differs"]
    return []


def _columns(path: Path) -> dict[str, list[str]]:
    """Columns of a CSV file by heading; a last row that is cut is left out."""
    text = path.read_text()
    rows = [line.split(",") for line in text[: text.rfind("\n") + 1].splitlines()]
    if not rows:
        return {}
    return {n: [row[k] for row in rows[1:]] for k, n in enumerate(rows[0]) if n != "seconds"}


# -- the campaign ------------------------------------------------------------------------------


def strike(own: Whole, number: int, by_term: bool, rng: random.Random) -> Strike:
    """A random moment of a run."""
    if by_term:
        return Strike(rng.uniform(0.01, 0.95) * own.seconds, signal.SIGTERM)
    if number % 2 and own.calls:
        name = rng.choice(sorted(own.calls))
        return Strike(inside=name, count=rng.randint(1, own.calls[name]))
    return Strike(rng.uniform(0.01, 0.95) * own.seconds)


def struck_run(own: Whole, folder: Path, by_term: bool, rng: random.Random, tally: Tally) -> None:
    """Strike a run up to three times, resume it until it is done, and compare."""
    tally.runs += 1
    strikes = rng.choice((1, 1, 2, MOST_STRIKES))
    resume, trail = False, []
    for attempt in range(12):
        hit = strike(own, rng.randrange(2), by_term, rng) if attempt < strikes else Strike()
        code, log = run(own.case, folder, own.every, resume, hit)
        trail.append(f"{'resume' if resume else 'run'} {hit} -> {code}")
        if code == own.code:
            break
        ended = code == -signal.SIGKILL or (by_term and code in (7, -signal.SIGTERM))
        if not ended:
            tally.faults.append(f"{own.case.name}: exit code {code}: {log.strip()} {trail}")
            return
        tally.counts["strikes"] += 1
        tally.counts["inside a write"] += bool(hit.inside)
        if wrong := look(folder, own.folder, tally.counts):
            tally.faults.append(f"{own.case.name}: after a strike: {wrong[:3]} {trail}")
            return
        resume = any(folder.glob(f"{JOB}.ckpt*"))
        if by_term and code == 7 and not resume and checkpoint_promised(folder):
            tally.faults.append(f"{own.case.name}: ended by TERM without a checkpoint {trail}")
            return
        tally.counts["resumed" if resume else "begun again"] += 1
    else:
        tally.faults.append(f"{own.case.name}: never done {trail}")
        return
    if own.code:
        # A run that does not get to its end keeps the results of the one before, which was struck.
        for path in folder.glob(f"{JOB}.previous.*"):
            path.unlink()
    if differences := folder_differences(own.folder, folder):
        tally.faults.append(f"{own.case.name}: differs: {differences[:3]} {trail}")
        return
    tally.same += 1


def checkpoint_promised(folder: Path) -> bool:
    """Whether a signal that ended a run has to leave a checkpoint.

    It comes after the increment in which the signal arrived; steps of procedures without a state
    to go on from (modal ones, for instance) take none.
    """
    path = folder / f"{JOB}.jsonl"
    events = [json.loads(line) for line in path.read_text().splitlines() if line.endswith("}")]
    procedures = {e["step"]: e["procedure"] for e in events if e.get("event") == "step"}
    reached = [e["step"] for e in events if e.get("event") == "increment" and e["increment"]]
    return bool(reached) and goes_on(procedures[reached[-1]])


def goes_on(procedure: str) -> bool:
    """Whether a procedure's stepper has a state that checkpoints hold."""
    of_procedure = {step.procedure: step for step in Step.__subclasses__()}
    module = import_module(of_procedure[procedure].run.__module__)
    own = [c for c in vars(module).values() if getattr(c, "__module__", "") == module.__name__]
    return any(hasattr(c, "memory") and c.kind for c in own)


def damage(data: bytes, other: bytes, rng: random.Random) -> tuple[str, bytes]:
    """A damaged copy of a checkpoint, and what was done to it."""
    how = rng.choice(("cut", "cut at a block", "bit", "bits", "zeros", "longer", "mixed", "empty"))
    out = bytearray(data)
    if how == "cut":
        out = out[: rng.randrange(len(out))]
    elif how == "cut at a block":
        out = out[: 512 * rng.randrange(len(out) // 512)]
    elif how in ("bit", "bits"):
        for _ in range(1 if how == "bit" else 20):
            out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    elif how == "zeros":
        at = 512 * rng.randrange(len(out) // 512)
        out[at : at + 512] = bytes(len(out[at : at + 512]))
    elif how == "longer":
        out += bytes(rng.randint(1, 4096))
    elif how == "mixed":
        out[512:] = other[512:]
    else:
        out = bytearray()
    return how, bytes(out)


def damaged_runs(own: Whole, times: int, other: bytes, rng: random.Random, tally: Tally) -> bytes:
    """End a run, damage one or both of its checkpoints and resume it, several times."""
    base = own.folder.with_name("ended")
    paths = [f"{JOB}.ckpt", f"{JOB}.ckpt.1"]
    hit = Strike(rng.uniform(0.4, 0.95) * own.seconds)
    for _ in range(8):
        run(own.case, base, 1, False, hit)
        if all((base / name).exists() for name in paths):
            break
        flushes = own.calls.get("before fsync", 1)
        hit = Strike(inside="before fsync", count=rng.randint(flushes // 2 + 1, flushes))
    else:
        return other  # a run without two checkpoints
    sound = (base / paths[0]).read_bytes()
    for number in range(times):
        folder = own.folder.with_name(f"damaged{number}")
        shutil.copytree(base, folder)
        both = rng.random() < 0.3
        for name in paths if both else [rng.choice(paths)]:
            data = (folder / name).read_bytes()
            how, bad = damage(data, other or (folder / paths[1]).read_bytes(), rng)
            (folder / name).write_bytes(data[:-1] if bad == data else bad)
            tally.counts[how] += 1
            tally.counts["damaged"] += 1
        tally.runs += 1
        code, log = run(own.case, folder, 1, True, Strike())
        fault = ""
        if both and code == 6 and log.strip():
            tally.counts["refused"] += 1
        elif not both and code == own.code:
            tally.counts["by the other one"] += 1
            if differences := folder_differences(own.folder, folder):
                fault = f"resumed wrongly: {differences[:3]}"
        else:
            fault = f"exit code {code}: {log.strip()}"
        faults = [f"{own.case.name}: damaged: {fault}"] if fault else []
        tally.faults += faults
        _tell(faults, folder)
    return sound


def table(tallies: dict[str, Tally], by: str) -> list[str]:
    """Rows of the table of a campaign."""
    head = (
        f"| runs ended by {by} | same to the bit | strikes | inside a write | resumed "
        "| begun again | result files opened by h5py, by VTK |"
    )
    lines = [head, "| --- " * 7 + "|"]
    total = Tally()
    for tally in tallies.values():
        total.add(tally)
    for name, tally in {**tallies, "all": total}.items():
        c = tally.counts
        vtk = c["vtk"] if vtkHDFReader is not None else "not installed"
        lines.append(
            f"| {name}: {tally.runs} | {tally.same} | {c['strikes']} | {c['inside a write']} | "
            f"{c['resumed']} | {c['begun again']} | {c['h5py']}, {vtk} |"
        )
    return lines


@dataclass
class Plan:
    """What a campaign does; its parts run side by side."""

    runs: int
    seconds: float
    by_term: bool
    damaged: int
    only: str
    seed: int
    jobs: int
    base: Path
    store: CampaignStore


def campaign(plan: Plan, part: int) -> tuple[dict[str, Tally], Tally]:
    """The runs of one part: tallies by kind, and that of damaged checkpoints."""
    wanted = [case for case in cases() if plan.only in case.name]
    late = time.monotonic() + (plan.seconds or float("inf"))
    tallies, broken = {case.kind: Tally() for case in wanted}, Tally()
    known: dict[str, Whole] = {}
    for number in range(plan.runs):
        if number % len(wanted) % plan.jobs != part or time.monotonic() > late:
            continue
        case = wanted[number % len(wanted)]
        key = [case.name, number, plan.seed, plan.by_term]
        if key not in plan.store:
            own = _known(case, plan.base, known)
            folder, tally = own.folder.with_name(f"run{number}"), Tally()
            rng = random.Random(f"{plan.seed} {number}")
            struck_run(own, folder, plan.by_term, rng, tally)
            _tell(tally.faults, folder)
            plan.store[key] = vars(tally)
        tallies[case.kind].add(Tally(**plan.store[key]))
    rng, other = random.Random(f"{plan.seed} damaged {part}"), b""
    share = math.ceil(plan.damaged / plan.jobs)
    for case in wanted[part :: plan.jobs]:
        if broken.counts["damaged"] >= share or time.monotonic() > late:
            break
        if case.kind != "examples":
            own = _known(case, plan.base, known)
            other = damaged_runs(own, 10, other, rng, broken)
    return tallies, broken


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--runs", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=0.0, help="begin no run after these")
    parser.add_argument("--signal", choices=("KILL", "TERM"), default="KILL")
    parser.add_argument("--damaged", type=int, default=0, help="damaged checkpoints after that")
    parser.add_argument("--only", default="", help="cases whose name holds this")
    parser.add_argument("--seed", type=int, default=17)
    parser.add_argument("--jobs", type=int, default=1, help="parts that run side by side")
    parser.add_argument("--fresh", action="store_true", help="forget the store")
    parser.add_argument("--write", action="store_true", help="put the table into docs/restart.md")
    args = parser.parse_args()
    base = Path(tempfile.mkdtemp(prefix="corota-kill-"))
    plan = Plan(
        args.runs,
        args.seconds,
        args.signal == "TERM",
        args.damaged,
        args.only,
        args.seed,
        args.jobs,
        base,
        CampaignStore("kill", args.fresh),
    )
    _load()
    begin = time.monotonic()
    if args.jobs == 1:
        parts = [campaign(plan, 0)]
    else:
        with ProcessPoolExecutor(args.jobs, get_context("fork")) as pool:
            parts = list(pool.map(campaign, [plan] * args.jobs, range(args.jobs)))
    tallies: dict[str, Tally] = {}
    broken = Tally()
    for found, damaged in parts:
        broken.add(damaged)
        for kind, tally in found.items():
            tallies.setdefault(kind, Tally()).add(tally)
    faults = broken.faults + [fault for tally in tallies.values() for fault in tally.faults]
    if not faults:
        shutil.rmtree(base, ignore_errors=True)
    lines = table(tallies, args.signal) if args.runs else []
    if args.damaged:
        c = broken.counts
        ways = ("cut", "cut at a block", "bit", "bits", "zeros", "longer", "mixed", "empty")
        lines += [
            "",
            f"Damaged checkpoints: {c['damaged']} in {broken.runs} runs ("
            + ", ".join(f"{way} {c[way]}" for way in ways)
            + f"): {c['by the other one']} runs went on from the other one, {c['refused']} with "
            f"both damaged were refused, {len(broken.faults)} were resumed wrongly.",
        ]
    text = "\n".join(lines)
    spent = time.monotonic() - begin
    sys.stdout.write(f"{text}\n\n{len(cases())} cases, {spent:.0f} s, {machine()}\n")
    if args.write:
        mark = f"kill {args.signal}" if args.runs else "kill damaged"
        write_between(PAGE, mark, text.strip())
    return int(bool(faults))


def _load() -> None:
    """Import what runs need once, so that forked processes need not."""
    with tempfile.TemporaryDirectory() as folder:
        for build in (MODELS["bump"], MODELS["complex modes between"], EXAMPLES["hertz"]):
            files = JobFiles(Path(folder) / "job", JOB, checkpoint_every=1)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                ct.solve(build(), observers=[files], threads=1)


def _known(case: Case, base: Path, known: dict[str, Whole]) -> Whole:
    """The whole run of a case, which is made once."""
    key = f"{case.kind} {case.name}"
    if key not in known:
        known[key] = whole(case, base, every=(1, 3, 5)[len(known) % 3])
    return known[key]


def _tell(faults: list[str], folder: Path) -> None:
    """Print faults and keep their files; remove those of others."""
    for fault in faults:
        sys.stdout.write(f"{fault}\n    files: {folder}\n")
        sys.stdout.flush()
    if not faults:
        shutil.rmtree(folder, ignore_errors=True)
        for ending in (".log", ".calls"):
            folder.with_suffix(ending).unlink(missing_ok=True)


if __name__ == "__main__":
    sys.exit(main())
