"""Tables and figures of what ``side_by_side`` has measured: medians, ratios, exponents.

Reads ``results/bench/runs.jsonl`` (or the files named), prints Markdown; ``--write`` puts the
tables between the marks of ``benchmarks/README.md`` and the figures into ``benchmarks/images``.

A ratio is that of the processor time of an iteration (one thread; wall time for more) to that of
the first program of the group in the same round of the same run, and the median over the rounds.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import math
import statistics
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.common import table, write_between
from benchmarks.speed.side_by_side import PROGRAMS, RUNS

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "benchmarks" / "README.md"
IMAGES = ROOT / "benchmarks" / "images"
SIZES = ("400", "1k", "4k", "33k", "40k", "200k", "400k", "1M")
TITLES = {
    "P1": "P1, cantilever with large rotations",
    "P2": "P2, strip with a hole beyond yield",
    "P3": "P3, two blocks in contact",
    "P3f": "P3f, with friction 0.3",
    "P4": "P4, cantilever under a load that acts at once",
    "P4x2": "P4x2, twice that load",
}
GROUPS = {"increments": "the increments alone", "deck": "whole runs of one deck"}
Record = dict[str, Any]


def each(record: Record) -> float:
    """Time of an iteration [s]: of the processor with one thread, else on the wall."""
    clock = "cpu" if record["threads"] == 1 else "solve"
    return float(record[clock]) / max(record["iterations"], 1)


def bases(records: list[Record]) -> dict[tuple[Any, ...], float]:
    """Time of an iteration of the group's first program in each round."""
    first: dict[tuple[Any, ...], float] = {}
    for program in PROGRAMS:
        for r in records:
            if r["ok"] and (r["program"], r["element"]) == (program.name, program.element):
                first.setdefault(round_of(r), each(r))
    return first


def round_of(r: Record) -> tuple[Any, ...]:
    """What runs that are compared have in common."""
    keys = ("session", "repeat", "problem", "size", "threads", "group", "order")
    return tuple(r[k] for k in keys)


def rows(records: list[Record]) -> list[list[object]]:
    """Rows of one table: programs of a problem, group and number of threads by size."""
    first = bases(records)
    made: list[list[object]] = []
    for size, increments in sorted(
        {(r["size"], r["increments"]) for r in records}, key=lambda k: (SIZES.index(k[0]), k[1])
    ):
        for order in (1, 2):
            for program in PROGRAMS:
                runs = [
                    r
                    for r in records
                    if (r["size"], r["increments"], r["order"], r["program"], r["element"])
                    == (size, increments, order, program.name, program.element)
                ]
                if not runs:
                    continue
                good = [r for r in runs if r["ok"]]
                if not good:
                    note = runs[0]["note"]
                    made.append([program.label, runs[0]["dofs"], increments, note, *[""] * 5])
                    continue

                def middle(key: str, good: list[Record] = good) -> float:
                    return statistics.median(r[key] for r in good)

                ratios = [each(r) / first[round_of(r)] for r in good if round_of(r) in first]
                result = ", ".join(f"{v:.6g}" for v in good[0]["result"])
                made.append(
                    [
                        program.label,
                        good[0]["dofs"],
                        increments,
                        int(middle("iterations")),
                        1e3 * statistics.median(each(r) for r in good),
                        f"{statistics.median(ratios):.2f}",
                        f"{middle('total'):.3g}",
                        f"{middle('peak_mb'):.0f}",
                        result,
                    ]
                )
    return made


def head(threads: int) -> list[str]:
    """Columns."""
    time = "CPU ms / iteration" if threads == 1 else "wall ms / iteration"
    return [
        "program, element",
        "dofs",
        "increments",
        "iterations",
        time,
        "ratio",
        "process, wall s",
        "peak MB",
        "result",
    ]


def exponents(records: list[Record], problem: str, group: str) -> list[list[object]]:
    """Exponent of the time of an iteration over dofs, from four thousand dofs on."""
    made: list[list[object]] = []
    for program in PROGRAMS:
        points = curve(records, problem, group, program.name, program.element)
        points = [(n, t) for n, t in points if n > 2000]
        if len(points) > 1:
            n, t = np.log(np.array(points)).T
            made.append(
                [
                    program.label,
                    problem,
                    f"{points[0][0]} to {points[-1][0]}",
                    f"{np.polyfit(n, t, 1)[0]:.2f}",
                ]
            )
    return made


def shares(records: list[Record]) -> list[list[object]]:
    """What contact takes of our increments, from their own profile."""
    made: list[list[object]] = []
    for r in records:
        if r["ok"] and r["problem"] in ("P3", "P3f") and "profile" in r and r["threads"] == 1:
            part = sum(r["profile"].get(name, 0.0) for name in ("contact", "border"))
            name = f"{r['program']} {r['element']}"
            made.append([name, r["problem"], r["dofs"], f"{part / r['solve']:.1%}"])
    return made


def curve(
    records: list[Record], problem: str, group: str, name: str, element: str
) -> list[tuple[int, float]]:
    """Dofs and median time of an iteration on one thread."""
    found: dict[int, list[float]] = {}
    for r in records:
        key = (r["problem"], r["group"], r["program"], r["element"], r["threads"])
        if r["ok"] and key == (problem, group, name, element, 1):
            found.setdefault(r["dofs"], []).append(each(r))
    return sorted((n, statistics.median(t)) for n, t in found.items())


def draw(records: list[Record], path: Path) -> None:
    """Time of an iteration over dofs: a panel for each problem."""
    from matplotlib.ticker import NullFormatter

    from corota.plots.figure import COLORS, look, new_figure, save

    problems = [p for p in ("P1", "P2", "P3", "P4") if any(r["problem"] == p for r in records)]
    names = list(dict.fromkeys(p.name for p in PROGRAMS))
    markers = dict(zip(names, "os^Dv<>pX", strict=False))
    with look():
        figure = new_figure(3.0 * len(problems) + 1.6, 3.3, shown=False)
        axes = figure.subplots(1, len(problems), squeeze=False, sharey=True)[0]
        for ax, problem in zip(axes, problems, strict=True):
            for program in PROGRAMS:
                if program.order == 2 or program.options[:1] == ("scheme=hht",):
                    continue
                points = curve(records, problem, program.group, program.name, program.element)
                if points:
                    n, t = zip(*points, strict=True)
                    k = names.index(program.name)
                    label = program.name + (" (deck)" if program.group == "deck" else "")
                    label += ", Q4I" if "Q4I" in program.element else ""
                    ax.loglog(
                        n,
                        t,
                        marker=markers[program.name],
                        markersize=4,
                        linewidth=1.1,
                        color=(*COLORS, "#000000")[k],
                        label=label,
                        linestyle=":"
                        if program.group == "deck"
                        else "--"
                        if "Q4I" in program.element
                        else "-",
                    )
            whole = [c for first in own(problem) for c in curve(records, problem, *first)]
            large = np.log(np.array([c for c in whole if c[0] > 2000]))
            fits = [np.polyfit(*large.T, 1)[0]] if len(large) > 1 else []
            ax.set_title(problem + (f" (Corota: n$^{{{fits[0]:.2f}}}$)" if fits else ""))
            ax.set_xlim(250.0, 1.6e6)
            ax.xaxis.set_minor_formatter(NullFormatter())
            ax.set_xlabel("dofs")
            ax.grid(True, which="major", alpha=0.3)
        axes[0].set_ylabel("processor time of an iteration [s]")
        handles: dict[str, Any] = {}
        for ax in axes:
            for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
                handles.setdefault(label, handle)
        axes[-1].legend(
            handles.values(),
            handles.keys(),
            fontsize=7,
            loc="upper left",
            bbox_to_anchor=(1.0, 1.0),
        )
        save(figure, path, dpi=110)


def own(problem: str) -> list[tuple[str, str, str]]:
    """Group, program and element of the first row of a problem."""
    return [(p.group, p.name, p.element) for p in PROGRAMS if problem in p.problems.split()][:1]


def page(records: list[Record]) -> str:
    """All tables."""
    when = sorted({r["when"][:10] for r in records})
    loads = [r["load"] for r in records]
    text = [
        f"Measured on {records[-1]['machine'].rsplit(', load', 1)[0]}, {' and '.join(when)}, under "
        f"a load of {min(loads):.0f} to {max(loads):.0f} (median {statistics.median(loads):.0f}) "
        "by other programs.",
        "![Time of an iteration over dofs](images/side-by-side.png)",
    ]
    for problem, title in TITLES.items():
        for threads in sorted({r["threads"] for r in records}):
            for group, what in GROUPS.items():
                chosen = [
                    r
                    for r in records
                    if (r["problem"], r["threads"], r["group"]) == (problem, threads, group)
                ]
                if chosen:
                    text.append(f"#### {title}: {what}, {threads} thread(s)")
                    text.append(table(head(threads), rows(chosen)))
    parts = shares(records)
    if parts:
        text.append("#### Contact's share of the increments: search, evaluation and borders")
        text.append(table(["program, element", "problem", "dofs", "share"], parts))
    fits = [row for p in TITLES for g in GROUPS for row in exponents(records, p, g)]
    if fits:
        text.append("#### Exponent of the time of an iteration over dofs, one thread")
        text.append(table(["program, element", "problem", "dofs", "exponent"], fits))
    versions = {r["program"]: r["version"] for r in records if r.get("version")}
    said = ", ".join(f"{name} {v}" for name, v in sorted(versions.items()) if name != "Corota")
    return "\n\n".join([*text, f"Versions: {said}."])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="*", type=Path, default=[RUNS])
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    records = [
        json.loads(line)
        for file in args.files
        for line in file.read_text(encoding="utf-8").splitlines()
    ]
    for r in records:
        if r["ok"] and not math.isfinite(r["cpu"]):
            r["cpu"] = r["solve"]
    text = page(records)
    sys.stdout.write(text + "\n")
    if args.write:
        IMAGES.mkdir(exist_ok=True)
        draw(records, IMAGES / "side-by-side.png")
        write_between(README, "side by side", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
