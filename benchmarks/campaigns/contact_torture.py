"""Random contact problems with the defaults: who finishes, iterations, balance, units.

``python -m benchmarks contact_torture --count 2000`` runs problems 0 to 1999 of
:mod:`contact_problems`, each with a limit of processor time, and prints the score by
family. ``--only N`` runs one and shows its message; ``--keep FILE`` keeps a line of JSON for each;
``--against FILE`` compares iterations and times with an earlier file. ``--write`` puts the score of
all that FILE of ``--keep`` holds into docs/contact.md; with ``--count 0`` it does that alone. Where
a run does not finish, :mod:`contact_reasons` looks for the reason that its message
names. The exit status is 1 where less than ``--share`` of the problems finish, or any
other one ends without a right reason.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import multiprocessing
import signal
import statistics
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.campaigns.contact_answers import answer
from benchmarks.campaigns.contact_reasons import reason
from benchmarks.common import machine, table, write_between
from benchmarks.corpora.contact_problems import Problem, problem

#: Every so many problems is run in another unit of length, by this factor, too.
UNITS, UNIT = 5, 1e-3
#: Relative difference of results between units.
AGREE = 1e-5


PAGE = Path(__file__).resolve().parents[2] / "docs" / "contact.md"


class _OverTime(Exception):
    """A run took too long."""


def _stop(*_: object) -> None:
    raise _OverTime


def run(
    number: int, limit: int, unit: float = 1.0, size: float = 1.0, answers: bool = False
) -> dict[str, Any]:
    """Outcome of a problem; with what it found where `answers` are wanted."""
    return {"number": number, **outcome(problem(number, unit, size), limit, answers)}


def outcome(given: Problem, limit: int, answers: bool = False) -> dict[str, Any]:
    """The same of a problem that is made already."""
    out: dict[str, Any] = {"name": given.name, "what": given.what}
    begin, results = time.process_time(), None
    signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, limit)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            results = ct.solve(given.model, given.steps, threads=1)
        out["end"], out["why"] = "done", ""
    except _OverTime:
        out["end"], out["why"] = "over time", f"{limit} s"
    except ct.CorotaError as error:
        results = getattr(error, "results", None)
        out["end"], out["why"] = type(error).__name__, str(error)
    except Exception as error:
        out["end"], out["why"] = "crash", f"{type(error).__name__}: {error}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    out["seconds"] = time.process_time() - begin
    if out["end"] != "done":
        out["reason"], out["right"] = reason(given, results, out["why"])
    if results is not None and len(results.frames) > 1:
        count = [f.scalars.get("iterations", 0.0) for f in results.frames[1:]]
        out["iterations"], out["increments"] = int(sum(count)), len(count)
        out["reached"] = results.times[-1] / sum(step.period for step in given.steps)
        out["cut-backs"] = int(results.info.get("cut-backs", 0))
        out["all iterations"] = int(results.info.get("iterations", out["iterations"]))
        last = results.frames[-1]
        out["residual"] = max(f.scalars.get("residual", 0.0) for f in results.frames[1:])
        force = {
            k: float(v) for k, v in last.scalars.items() if k.endswith((": force x", ": force y"))
        }
        out["force"] = max(map(abs, force.values()), default=0.0)
        # Over all frames, for parts that return at the end have moved by rounding there.
        moved = max(float(np.abs(frame.U).max()) for frame in results.frames)
        out["moved"] = moved / float(np.ptp(given.model.mesh.points, axis=0).max())
        if answers:
            out["answer"] = answer(given, results)
        out["balance"] = (
            _balance(given, last)
            if given.static
            else abs(float(last.scalars.get("energy balance", 0.0)))
        )
    return out


def _balance(given: Any, frame: Any) -> float:
    """Sum of reactions and contact forces on slaves of rigid curves, over their sizes."""
    total, size = np.zeros(2), 0.0
    loads = any(load for load in given.model.loads)
    if loads:
        return 0.0
    free = np.ones(given.model.mesh.n_nodes, bool)
    for pair in given.model.contacts:
        if isinstance(pair.master, ct.RigidCurve):
            if isinstance(pair.master.reference, int):
                free[pair.master.reference] = False
            force = np.array([frame.scalars[f"{pair.name}: force {a}"] for a in "xy"])
            total += force
            size += float(np.abs(force).sum())
    reaction = frame.RF[free][:, :2]
    total += reaction.sum(axis=0)
    size += float(np.abs(reaction).sum())
    return float(np.abs(total).max() / size) if size > 0.0 else 0.0


def score(rows: list[dict[str, Any]]) -> str:
    """Table by family."""
    lines = []
    families = sorted({r["name"].split("-")[0] for r in rows})
    for family in [*families, "all"]:
        mine = [r for r in rows if family in ("all", r["name"].split("-")[0])]
        done = [r for r in mine if r["end"] == "done"]
        per = [r["iterations"] / r["increments"] for r in done if r.get("increments")]
        balance = max((r.get("balance", 0.0) for r in done if "drop" not in r["name"]), default=0.0)
        lines.append(
            [
                family,
                str(len(mine)),
                f"{100.0 * len(done) / len(mine):.1f}",
                f"{sum(r.get('right', False) for r in mine)} of {len(mine) - len(done)}",
                f"{statistics.median(per):.1f}" if per else "",
                f"{np.percentile(per, 95):.1f}" if per else "",
                str(sum(r.get("cut-backs", 0) for r in done)),
                f"{balance:.0e}",
                f"{statistics.median(r['seconds'] for r in done):.1f}" if done else "",
            ]
        )
    head = [
        "family",
        "problems",
        "finish [%]",
        "others end with a right reason",
        "iterations",
        "95 %",
        "cut-backs",
        "balance",
        "CPU s",
    ]
    return table(head, lines)


def _one(job: tuple[int, int, float]) -> dict[str, Any]:
    number, limit, size = job
    row = run(number, limit, size=size)
    if number % UNITS == 0 and row["end"] == "done":
        other = run(number, limit, UNIT, size)
        row["unit"] = other["end"] == "done" and (
            abs(other["moved"] - row["moved"]) <= AGREE * row["moved"]
        )
        row["unit increments"] = other.get("increments") == row.get("increments")
    return row


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=90)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", type=int, nargs="*")
    parser.add_argument("--limit", type=int, default=60, help="CPU seconds of one")
    parser.add_argument("--size", type=float, default=1.0, help="factor on numbers of elements")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--against", type=Path)
    parser.add_argument("--share", type=float, default=0.99)
    parser.add_argument("--write", action="store_true", help="put the score into docs/contact.md")
    args = parser.parse_args()
    numbers = args.only or range(args.first, args.first + args.count)
    jobs = [(n, args.limit, args.size) for n in numbers]
    rows = []
    with multiprocessing.get_context("spawn").Pool(args.jobs, maxtasksperchild=20) as pool:
        for row in pool.imap_unordered(_one, jobs):
            rows.append(row)
            if args.keep:
                with args.keep.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            if row["end"] != "done" or not row.get("unit", True):
                shown = f"{row.get('reason', '')} {'shown' if row.get('right') else 'not shown'}"
                sys.stdout.write(f"{row['name']}: {row['what']}\n    {row['end']}, {row['why']}\n")
                sys.stdout.write(f"    reason: {shown}\n" * (row["end"] != "done"))
                sys.stdout.flush()
    if rows:
        sys.stdout.write(f"\n{machine()}\n\n{score(rows)}\n")
    units = [r for r in rows if "unit" in r]
    if units:
        same = sum(r["unit"] for r in units)
        counts = sum(r["unit increments"] for r in units)
        sys.stdout.write(
            f"\n{same} of {len(units)} agree in another unit of length, {counts} take the same "
            "increments\n"
        )
    if args.write and args.keep:
        # What was run again counts as it ended last.
        all_rows = {r["number"]: r for r in map(json.loads, args.keep.read_text().splitlines())}
        kept = [all_rows[n] for n in sorted(all_rows)]
        said = f"`python -m benchmarks contact_torture --size {args.size:g} --write`, {machine()}"
        said += f"\n\nNumbers {kept[0]['number']} to {kept[-1]['number']}, {len(kept)} run."
        write_between(PAGE, "torture", f"{said}\n\n{score(kept)}")
    if args.against:
        old = {r["number"]: r for r in map(json.loads, args.against.read_text().splitlines())}
        both = [
            (r, old[r["number"]])
            for r in rows
            if r["end"] == "done" and old.get(r["number"], {}).get("end") == "done"
        ]
        if both:
            time_ratio = statistics.median(a["seconds"] / b["seconds"] for a, b in both)
            work = statistics.median(a["iterations"] / max(b["iterations"], 1) for a, b in both)
            sys.stdout.write(
                f"of {len(both)} that finished before: time {time_ratio:.2f}, iterations "
                f"{work:.2f} of those before (median)\n"
            )
    few = sum(r["end"] == "done" for r in rows) < args.share * len(rows)
    return int(few or any(r["end"] != "done" and not r["right"] for r in rows))


if __name__ == "__main__":
    sys.exit(main())
