"""The torture set of contact in two builds: who finishes, in how many iterations, how fast.

``python -m benchmarks.contact_before_after OLD NEW --count 400 --size 0.5`` takes two wheels or
source trees, as :mod:`benchmarks.before_after` does. Each problem of
:mod:`benchmarks.contact_problems` runs in both, one after the other, each build in a process of its
own. Iterations are those of an increment, times those of the processor; both are compared where
both builds finish. ``--keep FILE`` keeps a line of JSON for each problem and does not run again
what is there; ``--write`` puts the table into docs/contact.md.
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

from benchmarks.before_after import Build
from benchmarks.common import machine, table, write_between
from benchmarks.contact_problems import FAMILIES
from benchmarks.contact_torture import PAGE

Row = dict[str, Any]


def compared(rows: list[Row]) -> str:
    """Table by family."""
    lines = []
    for family in [*sorted(FAMILIES), "all"]:
        mine = [r for r in rows if family in ("all", r["new"]["name"].split("-")[0])]
        if not mine:
            continue
        both = [r for r in mine if all(r[side]["end"] == "done" for side in ("old", "new"))]
        line = [family, str(len(mine))]
        line += [
            f"{100.0 * np.mean([r[side]['end'] == 'done' for r in mine]):.1f}"
            for side in ("old", "new")
        ]
        for side in ("old", "new"):
            each = [r[side]["iterations"] / max(r[side]["increments"], 1) for r in both]
            line += [f"{np.percentile(each, share):.1f}" if each else "" for share in (50, 95)]
        for what in ("iterations", "seconds"):
            ratios = [r["new"][what] / max(r["old"][what], 1e-9) for r in both]
            line.append(f"{statistics.median(ratios):.2f}" if ratios else "")
        lost = sum(r["old"]["end"] == "done" != r["new"]["end"] for r in mine)
        lines.append([*line, str(lost)])
    head = ["family", "problems", "finish, old [%]", "new [%]", "iterations, old", "95 %"]
    head += ["iterations, new", "95 %", "all iterations, new / old", "CPU, new / old", "lost"]
    return table(head, lines)


def main() -> int:
    """Run what is missing, print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old", type=Path, help="wheel or source tree")
    parser.add_argument("new", type=Path, help="wheel or source tree")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--limit", type=int, default=100, help="CPU seconds of one")
    parser.add_argument("--size", type=float, default=1.0, help="factor on numbers of elements")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--write", action="store_true", help="put the table into docs/contact.md")
    chosen = parser.parse_args()
    rows: dict[int, Row] = {}
    if chosen.keep and chosen.keep.exists():
        lines = chosen.keep.read_text(encoding="utf-8").splitlines()
        rows = {row["number"]: row for row in map(json.loads, lines)}
    with tempfile.TemporaryDirectory() as folder:
        builds = {}
        for side in ("old", "new"):
            place = Path(folder) / side
            place.mkdir()
            builds[side] = Build(getattr(chosen, side).resolve(), place)
        for number in range(chosen.first, chosen.first + chosen.count):
            if number in rows:
                continue
            row: Row = {"number": number}
            for side in ("old", "new") if number % 2 else ("new", "old"):
                builds[side].start("torture", json.dumps([number, chosen.limit, 1.0, chosen.size]))
                row[side] = builds[side].finish()
            rows[number] = row
            if chosen.keep:
                with chosen.keep.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            ends = [row[side]["end"] for side in ("old", "new")]
            if ends != ["done", "done"]:
                sys.stdout.write(f"{row['new']['name']}: {ends[0]}, {ends[1]}\n")
                sys.stdout.flush()
        for build in builds.values():
            build.close()
    kept = [rows[n] for n in sorted(rows)]
    said = f"`python -m benchmarks.contact_before_after OLD NEW --size {chosen.size:g} --write`, "
    said += f"{machine()}\n\nNumbers {kept[0]['number']} to {kept[-1]['number']}, {len(kept)} run."
    sys.stdout.write(f"\n{said}\n\n{compared(kept)}\n")
    if chosen.write:
        write_between(PAGE, "before", f"{said}\n\n{compared(kept)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
