"""Two builds of Corota side by side in one run: the same values, the same iterations, the time.

``python -m benchmarks before_after OLD NEW`` takes two wheels or two source trees, each with its
own compiled core. Every problem of the catalog, every example and every deck runs in both, each
build in a process of its own, and each frame of each analysis is compared: to the bit, and to a
relative :data:`TOLERANCE`. Then Newton iterations are timed in turn (old, new, old, new, ...).
``--quick`` takes a part that lasts about a minute and no times; ``--only`` names some parts.
Ends with 1 if a value, a count of iterations or an error differs.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import pickle
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.common import report

ROOT = Path(__file__).resolve().parents[2]
#: Values may differ by this share of the largest of their kind, where sums change their order.
TOLERANCE = 1e-12
#: Problems, examples and generated decks of a quick run.
QUICK: dict[str, Any] = {
    "catalogue": [
        "annulus_pressure",
        "best_fit_frame",
        "cook_large",
        "diamond_frame",
        "euler_column",
        "friction_incline",
        "heated_parts",
        "hertz_plane",
        "lee_frame",
        "newton_order",
        "plastic_bending",
        "rigid_spin",
        "springs",
        "williams_toggle",
        "zero_modes",
        "beam_frequencies",
        "contact_patch",
        "free_rod",
    ],
    "examples": ["guide/guide.py", "rollup/rollup.py", "motion/pulse.py"],
    "decks": 60,
}
PARTS = ("catalogue", "examples", "decks", "cases", "speed")
#: Examples that make pictures or meshes with other programs, and nothing to compare.
NOT_RUN = ("gripper/mesh.py",)
#: A build may be slower by this share before the line is marked.
SLOWER = 0.02


class Build:
    """A build with a process of its own, which does one thing after the other."""

    def __init__(self, place: Path, scratch: Path) -> None:
        if place.suffix == ".whl":
            home = scratch / place.stem
            with zipfile.ZipFile(place) as wheel:
                wheel.extractall(home)
        else:
            home = place / "src"
        if not list((home / "corota").glob("_core*")):
            raise SystemExit(f"{place}: no compiled core in {home / 'corota'}")
        environment = dict(os.environ, OMP_NUM_THREADS="1", MPLBACKEND="Agg")
        environment["PYTHONPATH"] = os.pathsep.join([str(home), str(ROOT)])
        self.out = scratch / f"{len(list(scratch.iterdir()))}.pickle"
        self.child = subprocess.Popen(
            [sys.executable, "-m", "benchmarks.speed.before_after_worker", str(home)],
            cwd=scratch,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def start(self, part: str, name: str) -> None:
        """Begin a task."""
        assert self.child.stdin is not None
        self.child.stdin.write(json.dumps([part, name, str(self.out)]) + "\n")
        self.child.stdin.flush()

    def finish(self) -> Any:
        """What the task left."""
        assert self.child.stdout is not None
        if not self.child.stdout.readline():
            raise SystemExit("a build's process ended; see its messages above")
        return pickle.loads(self.out.read_bytes())

    def close(self) -> None:
        """End the process."""
        assert self.child.stdin is not None
        self.child.stdin.close()
        self.child.wait()


def names(part: str, quick: bool, build: Build) -> list[str]:
    """Tasks of a part."""
    if part == "catalogue":
        if quick:
            return QUICK["catalogue"]
        build.start("list", "catalogue")
        return list(build.finish())
    if part == "examples":
        found = sorted(str(p.relative_to(ROOT / "examples")) for p in ROOT.glob("examples/*/*.py"))
        return QUICK["examples"] if quick else [f for f in found if f not in NOT_RUN]
    if part == "decks":
        files = [*ROOT.glob("examples/*/*.inp"), *ROOT.glob("tests/**/*.inp")]
        made = [f"#{k}" for k in range(QUICK["decks"] if quick else 400)]
        return [*sorted(str(f.relative_to(ROOT)) for f in files), *made]
    build.start("list", part)
    return list(build.finish())


def differences(old: dict[str, Any], new: dict[str, Any]) -> tuple[list[str], bool, float]:
    """What differs beyond the tolerance, whether all bits are the same, the largest difference."""
    found: list[str] = []
    same, worst = True, 0.0
    for what in ("error", "values", "runs"):
        if what == "error" and old[what] != new[what]:
            found.append(f"error: {old[what] or 'none'!r} -> {new[what] or 'none'!r}")
        if what == "values" and old[what] != new[what]:
            same = False
            before, after = dict(old[what]), dict(new[what])
            found += [
                f"value {name}: {before[name]!r} -> {after[name]!r}"
                for name in before
                if name in after
                and not abs(before[name] - after[name])
                <= TOLERANCE * max(abs(before[name]), abs(after[name]))
            ]
            found += [f"value {name}: only in one build" for name in before.keys() ^ after.keys()]
    if len(old["runs"]) != len(new["runs"]):
        return [*found, f"analyses: {len(old['runs'])} -> {len(new['runs'])}"], False, np.inf
    for k, (a, b) in enumerate(zip(old["runs"], new["runs"], strict=True)):
        for key in ("counts", "notes", "critical", "error"):
            if a[key] != b[key]:
                found.append(f"analysis {k + 1} {key}: {a[key]} -> {b[key]}")
        if [f["iterations"] for f in a["frames"]] != [f["iterations"] for f in b["frames"]]:
            found.append(f"analysis {k + 1}: iterations of the increments differ")
            same, worst = False, np.inf
            continue
        scale: dict[str, float] = {}
        for frame in a["frames"]:
            for name, numbers in frame["sums"].items():
                scale[name] = max(scale.get(name, 0.0), abs(numbers[0]))
        for j, (f, g) in enumerate(zip(a["frames"], b["frames"], strict=True)):
            if f["digest"] == g["digest"]:
                continue
            same = False
            if set(f["sums"]) != set(g["sums"]):
                odd = sorted(set(f["sums"]) ^ set(g["sums"]))
                found.append(f"analysis {k + 1}, frame {j}: only in one build: {odd}")
            for name in sorted(set(f["sums"]) & set(g["sums"])):
                off = np.abs(np.subtract(f["sums"][name], g["sums"][name])).max()
                if name in f["arrays"] and np.shape(f["arrays"][name]) == np.shape(
                    g["arrays"].get(name)
                ):
                    off = np.abs(np.subtract(f["arrays"][name], g["arrays"][name])).max(initial=0.0)
                share = float(off / scale[name]) if scale[name] else float(off)
                worst = max(worst, share)
                if not share <= TOLERANCE:
                    found.append(f"analysis {k + 1}, frame {j}: {name} differs by {share:.1e}")
    return found, same and not found, worst


def values(part: str, old: Build, new: Build, quick: bool) -> tuple[list[object], list[str]]:
    """Compare one part; a row of the table and all differences."""
    tasks = names(part, quick, new)
    bits = runs = frames = iterations = failed = 0
    largest, wrong = 0.0, []
    for name in tasks:
        for build in (old, new):
            build.start(part, name)
        before, after = old.finish(), new.finish()
        found, same, worst = differences(before, after)
        wrong += [f"{part} {name}: {text}" for text in found]
        bits, largest = bits + same, max(largest, worst)
        runs += len(after["runs"])
        failed += bool(after["error"])
        frames += sum(len(r["frames"]) for r in after["runs"])
        iterations += int(sum(r["counts"].get("iterations", 0) for r in after["runs"]))
    return [part, len(tasks), failed, runs, frames, iterations, bits, largest, len(wrong)], wrong


def speed(old: Build, new: Build, repeats: int, cases: list[str]) -> list[list[object]]:
    """Seconds of a Newton iteration in both builds, in turn, and their ratio."""
    rows: list[list[object]] = []
    for name in cases or names("speed", False, new):
        times: tuple[list[float], list[float]] = ([], [])
        pairs = []
        for attempt in range(repeats + 1):
            one = []
            for build in (old, new) if attempt % 2 else (new, old):
                build.start("speed", name)
                one.append(build.finish())
            before, after = one if attempt % 2 else one[::-1]
            if attempt:
                times[0].append(before["seconds"])
                times[1].append(after["seconds"])
                pairs.append(after["seconds"] / before["seconds"])
        ratio = min(times[1]) / min(times[0])
        mark = "" if min(ratio, median(pairs)) <= 1.0 + SLOWER else "slower"
        dofs = after["dofs"]
        both = [1e3 * min(t) for t in times]
        rows.append([name, dofs, after["iterations"], *both, ratio, median(pairs), mark])
    return rows


def main() -> int:
    """Compare, print, and count the parts that differ."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("old", type=Path, help="wheel or source tree")
    options.add_argument("new", type=Path, help="wheel or source tree")
    options.add_argument("--quick", action="store_true", help="a part of the values, no times")
    options.add_argument("--only", nargs="+", choices=PARTS, help="some parts")
    options.add_argument("--repeats", type=int, default=5, help="timed runs of each build")
    options.add_argument("--cases", nargs="+", default=[], help="some cases of speed")
    chosen = options.parse_args()
    parts = chosen.only or [p for p in PARTS if not (chosen.quick and p == "speed")]
    wrong: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        places = [(Path(folder) / side) for side in ("old", "new")]
        for place in places:
            place.mkdir()
        old, new = (
            Build(given.resolve(), place)
            for given, place in zip((chosen.old, chosen.new), places, strict=True)
        )
        rows = []
        for part in [p for p in parts if p != "speed"]:
            row, found = values(part, old, new, chosen.quick)
            rows.append(row)
            wrong += found
        if rows:
            head = ["part", "tasks", "ending in an error", "analyses", "frames", "iterations"]
            head += ["tasks same to the bit", "largest difference", "differences"]
            report("Values", head, rows)
        if "speed" in parts:
            head = ["case", "dofs", "iterations", "old [ms]", "new [ms]", "new / old"]
            head += ["median of ratios", ""]
            report("One Newton iteration", head, speed(old, new, chosen.repeats, chosen.cases))
        old.close()
        new.close()
    for line in wrong:
        sys.stdout.write(line[:400] + "\n")
    return min(len(wrong), 1)


if __name__ == "__main__":
    sys.exit(main())
