"""Known hard jobs in contact with the defaults: who finishes, how far, at what cost.

``python -m benchmarks contact_cases`` runs the jobs of :mod:`contact_case_models`, with
names as arguments those whose name holds one of them (``drop``, ``"ring Q8R"``), and prints a line
for each and a table by family. ``--quick`` takes three of each family. ``--keep FILE`` keeps a line
of JSON for each and does not run again what is there, so that long campaigns go in parts;
``--write`` puts the tables of all that was run into docs/contact.md and, for the drop tests, into
docs/measured.md. The exit status is 1 where one does not end as it must.
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
from benchmarks.common import machine, table, write_between
from benchmarks.corpora.contact_case_models import Case, all_cases

DOCS = Path(__file__).resolve().parents[2] / "docs"


class _OverTime(Exception):
    """A run took too long."""


def _stop(*_: object) -> None:
    raise _OverTime


def run(case: Case, limit: int) -> dict[str, Any]:
    """Outcome of a case."""
    model, steps = case.build(**case.options)
    out: dict[str, Any] = {"name": case.name, "ends": case.ends, "why": "", "reached": 0.0}
    begin, results = time.process_time(), None
    signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, limit)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            results = ct.solve(model, steps, threads=1)
    except _OverTime:
        out["why"] = f"over {limit} s of processor time"
    except ct.CorotaError as error:
        results, out["why"] = getattr(error, "results", None), str(error)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    out["ok"] = case.ends in out["why"] if case.ends else not out["why"]
    out["seconds"] = time.process_time() - begin
    if results is None or len(results.frames) < 2:
        return out
    frames = results.frames[1:]
    out["reached"] = results.times[-1] / sum(step.period for step in steps)
    out["increments"] = len(frames)
    out["iterations"] = sum(f.scalars.get("iterations", 0.0) for f in frames) / len(frames)
    out["cut-backs"] = int(results.info.get("cut-backs", 0))
    force = np.array(results.history(case.force))
    out["force"] = float(np.abs(force).max())
    out["balance"] = _balance(model, steps, results)
    error = [float(f.scalars.get("energy balance error", 0.0)) for f in results.frames]
    out["gained"], out["lost"] = max(0.0, *error), max(0.0, *(-e for e in error))
    out["energy"] = max(out["gained"], out["lost"])
    if isinstance(steps[0], ct.Dynamic):
        out["of scheme"] = {**case.options, "last": error[-1]}
    return out


def _balance(model: ct.Model, steps: Any, results: Any) -> float:
    """Forces that are not balanced over all, at the worst instant."""
    worst = 0.0
    if not isinstance(steps[0], ct.Static):
        return worst
    own = np.ones(model.mesh.n_nodes, bool)
    for pair in model.contacts:
        if isinstance(pair.master, ct.RigidCurve) and isinstance(pair.master.reference, int):
            own[pair.master.reference] = False
    for frame in results.frames[1:]:
        force = [
            np.array([frame.scalars[f"{p.name}: force {a}"] for a in "xy"])
            for p in model.contacts
            if isinstance(p.master, ct.RigidCurve)
        ]
        parts = np.vstack([frame.RF[own][:, :2], *force, _loads(frame, own)])
        size = float(np.abs(parts).sum())
        if size > 0.0:
            worst = max(worst, float(np.abs(parts.sum(axis=0)).max()) / size)
    return worst


def _loads(frame: Any, own: Any) -> Any:
    """Loads at nodes; zeros where frames have none."""
    loads = getattr(frame, "F", None)
    return np.zeros((1, 2)) if loads is None else np.asarray(loads)[own][:, :2]


def line(row: dict[str, Any]) -> list[str]:
    """A row as words."""
    return [
        row["name"],
        "yes" if row["ok"] else "NO",
        f"{row['reached']:.3f}",
        str(row.get("increments", 0)),
        f"{row.get('iterations', 0.0):.1f}",
        str(row.get("cut-backs", 0)),
        f"{row.get('force', 0.0):.4g}",
        f"{row.get('balance', 0.0):.0e}",
        f"{row.get('energy', 0.0):.0e}",
        f"{row['seconds']:.1f}",
    ]


HEAD = ["case", "ends well", "reached", "increments", "iterations", "cut-backs"]
HEAD += ["largest force", "balance", "energy", "CPU s"]


def summary(rows: list[dict[str, Any]]) -> str:
    """Table by family."""
    out = []
    for family in dict.fromkeys(r["name"].split()[0] for r in rows):
        mine = [r for r in rows if r["name"].split()[0] == family]
        per = [r["iterations"] for r in mine if "iterations" in r]
        cuts = [r["cut-backs"] for r in mine if "cut-backs" in r]
        # Where statics jumps to another equilibrium, energy is lost.
        moving = [r["energy"] for r in mine if "of scheme" in r]
        out.append(
            [
                family,
                f"{sum(r['ok'] for r in mine)} of {len(mine)}",
                f"{statistics.median(per):.1f}" if per else "",
                f"{statistics.median(cuts):.0f}" if cuts else "",
                f"{max((r.get('balance', 0.0) for r in mine), default=0.0):.0e}",
                f"{max(moving):.0e}" if moving else "",
                f"{statistics.median(r['seconds'] for r in mine):.1f}",
            ]
        )
    head = [
        "family",
        "end well",
        "iterations",
        "cut-backs",
        "worst balance",
        "worst energy",
        "CPU s",
    ]
    return table(head, out)


def drops(rows: list[dict[str, Any]]) -> str:
    """Energy of the drop tests by element, scheme, weight and friction; rows over all periods."""
    out = []
    groups: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
    for row in rows:
        if row["name"].startswith("drop "):
            o = row.get("of scheme") or {}
            key = (o.get("element"), o.get("scheme"), o.get("weight"), o.get("mu"))
            groups.setdefault(key, []).append(row)
    for (element, scheme, weight, mu), mine in groups.items():
        last = [r.get("of scheme", {}).get("last", 0.0) for r in mine]
        out.append(
            [
                str(element),
                str(scheme),
                "yes" if weight else "no",
                f"{mu:g}",
                f"{sum(r['ok'] for r in mine)} of {len(mine)}",
                f"{100.0 * max(r.get('gained', 0.0) for r in mine):.2f}",
                f"{100.0 * max(r.get('lost', 0.0) for r in mine):.2f}",
                f"{100.0 * min(last):+.2f} to {100.0 * max(last):+.2f}",
                f"{statistics.median(r.get('increments', 0) for r in mine):.0f}",
                f"{statistics.median(r.get('iterations', 0.0) for r in mine):.1f}",
                str(sum(r.get("cut-backs", 0) for r in mine)),
            ]
        )
    head = ["element", "scheme", "gravity", "friction", "finish", "gained [%]", "lost [%]"]
    head += ["at the end [%]", "increments", "iterations", "cut-backs"]
    return table(head, out)


def write(rows: list[dict[str, Any]]) -> None:
    """Put the tables into the docs."""
    command = f"`python -m benchmarks contact_cases --write`, {machine()}"
    write_between(DOCS / "contact.md", "cases", f"{command}\n\n{summary(rows)}")
    if any(r["name"].startswith("drop ") for r in rows):
        write_between(DOCS / "measured.md", "drops", f"{command}\n\n{drops(rows)}")


def _one(job: tuple[Case, int]) -> dict[str, Any]:
    return run(*job)


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", help="parts of names; all if there are none")
    parser.add_argument("--quick", action="store_true", help="three cases of each family")
    parser.add_argument("--every", type=int, default=1, help="run every so many cases only")
    parser.add_argument("--list", action="store_true", help="names only")
    parser.add_argument("--limit", type=int, default=120, help="CPU seconds of one")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="JSON lines of what was run")
    parser.add_argument("--write", action="store_true", help="put the tables into the docs")
    args = parser.parse_args()
    chosen = [
        case
        for case in all_cases(args.quick)
        if not args.names or any(f"{n} " in f"{case.name} " for n in args.names)
    ][:: args.every]
    if args.list:
        sys.stdout.write("".join(f"{case.name}\n" for case in chosen))
        return 0
    kept: list[dict[str, Any]] = []
    if args.keep and args.keep.exists():
        kept = [json.loads(text) for text in args.keep.read_text(encoding="utf-8").splitlines()]
    there = {row["name"] for row in kept}
    rows = list(kept)
    jobs = [(case, args.limit) for case in chosen if case.name not in there]
    with multiprocessing.get_context("spawn").Pool(args.jobs, maxtasksperchild=40) as pool:
        for row in pool.imap(_one, jobs):
            rows.append(row)
            if args.keep:
                with args.keep.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            sys.stdout.write("  ".join(line(row)) + "\n")
            if not row["ok"]:
                sys.stdout.write(f"    {row['why'] or 'finished'}\n")
            sys.stdout.flush()
    order = {case.name: i for i, case in enumerate(all_cases(quick=False))}
    rows.sort(key=lambda row: order.get(row["name"], len(order)))
    sys.stdout.write(f"\n{machine()}\n\n{table(HEAD, [line(r) for r in rows])}\n")
    sys.stdout.write(f"\n{summary(rows)}\n")
    if args.write:
        write(rows)
    return int(not all(r["ok"] for r in rows))


if __name__ == "__main__":
    sys.exit(main())
