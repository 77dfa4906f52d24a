"""The torture set of contact in two builds: who finishes with what, in how many iterations.

``python -m benchmarks contact_before_after OLD NEW --count 400 --size 0.5`` takes two wheels or
source trees, as :mod:`before_after` does. Each problem of
:mod:`contact_problems` runs in both in turn, each build in a process of its own; the
least of ``--repeats`` times counts. Iterations are those of an increment, times those of the
processor. Both are compared where both builds finish with the same answer
(:mod:`contact_answers`); where they finish with another one, the states say in
which of them the bodies overlap more. ``--keep FILE`` keeps a line of JSON for
each problem and does not run again what is there; ``--write`` puts the tables into docs/contact.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.campaigns.contact_answers import DEEPER, deeper, same
from benchmarks.campaigns.contact_torture import PAGE
from benchmarks.common import machine, table, write_between
from benchmarks.corpora.contact_problems import FAMILIES
from benchmarks.speed.before_after import Build

Row = dict[str, Any]

SIDES = ("old", "new")
#: Iterations, those of attempts that failed too.
EVERY = "all iterations"
#: Ratio of processor times from which a run is called slower.
SLOWER = 1.1


def finished(rows: list[Row]) -> list[Row]:
    """Rows of problems that both builds finish."""
    return [r for r in rows if all(r[side]["end"] == "done" for side in SIDES)]


def families(rows: list[Row]) -> list[tuple[str, list[Row]]]:
    """Rows of each family that was run, and all."""
    names = [*sorted(FAMILIES), "all"]
    found = [(n, [r for r in rows if n in ("all", _family(r))]) for n in names]
    return [(name, mine) for name, mine in found if mine]


def _family(row: Row) -> str:
    return str(row["new"]["name"].split("-")[0])


def answers(rows: list[Row]) -> str:
    """Table of who finishes with what."""
    lines = []
    for family, mine in families(rows):
        both = finished(mine)
        others = [r for r in both if not same(r["old"], r["new"])]
        line = [family, str(len(mine))]
        line += [
            f"{100.0 * np.mean([r[side]['end'] == 'done' for r in mine]):.1f}" for side in SIDES
        ]
        line += [str(sum(r["old"]["end"] == "done" != r["new"]["end"] for r in mine))]
        line += [str(len(both) - len(others)), str(len(others))]
        line += [str(sum(deeper(r["old"], r["new"]) for r in others))]
        line += [str(sum(deeper(r["new"], r["old"]) for r in others))]
        lines.append(line)
    head = ["family", "problems", "finish, old [%]", "new [%]", "lost", "same answer"]
    head += ["other answer", "of these overlap more, old", "new"]
    return table(head, lines)


def compared(rows: list[Row]) -> str:
    """Table of iterations and times of those that both finish with the same answer."""
    lines = []
    for family, mine in families(rows):
        both = finished(mine)
        alike = [r for r in both if same(r["old"], r["new"])]
        line = [family, str(len(alike))]
        for side in SIDES:
            each = [r[side]["iterations"] / max(r[side]["increments"], 1) for r in alike]
            line += [f"{np.percentile(each, share):.1f}" if each else "" for share in (50, 95)]
        ratios = [r["new"][EVERY] / max(r["old"][EVERY], 1) for r in alike]
        line.append(f"{statistics.median(ratios):.2f}" if ratios else "")
        times = [_time_ratio(r) for r in alike]
        line.append(f"{statistics.median(times):.2f}" if times else "")
        line.append(str(sum(t > SLOWER for t in times)))
        equal = [_time_ratio(r) for r in alike if r["new"][EVERY] == r["old"][EVERY]]
        line.append(f"{statistics.median(equal):.2f} ({len(equal)})" if equal else "")
        every = [_time_ratio(r) for r in both]
        line.append(f"{statistics.median(every):.2f}" if every else "")
        lines.append(line)
    head = ["family", "same answer", "iterations, old", "95 %", "iterations, new", "95 %"]
    head += ["all iterations, new / old", "CPU, new / old", f"above {SLOWER:g}"]
    head += ["CPU where iterations are equal", "CPU, all that both finish"]
    return table(head, lines)


def _time_ratio(row: Row) -> float:
    return float(row["new"]["seconds"] / max(row["old"]["seconds"], 1e-9))


def differing(rows: list[Row]) -> str:
    """List of the problems that both finish with different answers."""
    lines = []
    for r in finished(rows):
        if same(r["old"], r["new"]):
            continue
        line = [r["new"]["name"], r["new"]["what"]]
        for what in ("moved", "largest force", "deepest"):
            for side in SIDES:
                value = r[side][what] if what == "moved" else r[side]["answer"][what]
                line.append(f"{value:.4g}")
        line += [f"{r[side]['iterations']} / {r[side]['increments']}" for side in SIDES]
        lines.append(line)
    head = ["problem", "what", "moved, old", "new", "largest force, old", "new"]
    head += ["deepest overlap, old [edges]", "new", "iterations / increments, old", "new"]
    return table(head, lines)


def main() -> int:
    """Run what is missing, print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old", type=Path, help="wheel or source tree")
    parser.add_argument("new", type=Path, help="wheel or source tree")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--every", type=int, default=1, help="run every so many problems only")
    parser.add_argument("--limit", type=int, default=100, help="CPU seconds of one")
    parser.add_argument("--size", type=float, default=1.0, help="factor on numbers of elements")
    parser.add_argument("--repeats", type=int, default=2, help="runs of each that both finish")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--write", action="store_true", help="put the table into docs/contact.md")
    chosen = parser.parse_args()

    def task(number: int) -> str:
        return json.dumps([number, chosen.limit, 1.0, chosen.size, True])

    rows: dict[int, Row] = {}
    if chosen.keep and chosen.keep.exists():
        lines = chosen.keep.read_text(encoding="utf-8").splitlines()
        rows = {row["number"]: row for row in map(json.loads, lines)}
    with tempfile.TemporaryDirectory() as folder:
        builds = {}
        for side in SIDES:
            place = Path(folder) / side
            place.mkdir()
            builds[side] = Build(getattr(chosen, side).resolve(), place)
            # What is loaded with the first run is no part of its time.
            builds[side].start("torture", task(0))
            builds[side].finish()
        for number in range(chosen.first, chosen.first + chosen.count, chosen.every):
            if number in rows:
                continue
            row: Row = {"number": number}
            for attempt in range(chosen.repeats):
                for side in SIDES if (number + attempt) % 2 else SIDES[::-1]:
                    builds[side].start("torture", task(number))
                    found = builds[side].finish()
                    if attempt:
                        found["seconds"] = min(found["seconds"], row[side]["seconds"])
                    row[side] = found
                if not finished([row]):
                    break
            rows[number] = row
            if chosen.keep:
                with chosen.keep.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            ends = [row[side]["end"] for side in SIDES]
            if ends != ["done", "done"]:
                sys.stdout.write(f"{row['new']['name']}: {ends[0]}, {ends[1]}\n")
                sys.stdout.flush()
        for build in builds.values():
            build.close()
    kept = [rows[n] for n in sorted(rows)]
    said = f"`python -m benchmarks contact_before_after OLD NEW --size {chosen.size:g} --write`, "
    said += f"{machine()}\n\nNumbers {kept[0]['number']} to {kept[-1]['number']}, {len(kept)} run."
    sys.stdout.write(f"\n{differing(kept)}\n")
    reported = f"{said} *Overlap more*: the largest depth over the run is more than {DEEPER:g} "
    reported += f"times that of the other version.\n\n{answers(kept)}\n\n{compared(kept)}"
    sys.stdout.write(f"\n{reported}\n")
    if chosen.write:
        write_between(PAGE, "before", reported)
    return 0


if __name__ == "__main__":
    sys.exit(main())
