"""The fault campaign: random and listed faults, and what became of each.

    python -m benchmarks faults [--inputs N] [--runs N] [--folders N] [--seed N] [--jobs N]
        [--keep DIR] [--fresh]

Without options 100,000 inputs go through the readers in-process, 5,000 whole runs and 5,000
commands in received folders (links, pipes, includes, foreign files, stores, little memory) are made
in processes of their own, beside the listed faults, full disks, little memory, signals, damaged
results and thread counts. The end counts crashes, hangs, silent successes, tracebacks, wrong exit
codes and numbers that are none behind exit 0; it ends with 1 if there is any. The counts of each
part are kept in ``build/faults.jsonl``: a campaign that was ended goes on where it was.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path

from benchmarks.campaigns.campaign_store import CampaignStore
from benchmarks.common import machine, table

ROOT = Path(__file__).resolve().parents[2]
#: What is counted, and the words of an outcome that make it so.
CLASSES = {
    "crashes": ("crash", "signal"),
    "hangs": ("hang",),
    "silent successes": ("silent", "not in equilibrium"),
    "tracebacks": ("traceback", "Traceback"),
    "wrong exit codes": ("wrong", "an error with exit 0", "without a message"),
    "NaN behind exit 0": ("NaN",),
    "other failures": ("failure", "broken", "endless"),
}
#: Inputs and runs of one task.
PART, RUNS = 2500, 125


def classed(outcome: str) -> str:
    """Class of a bad outcome, or an empty text for a good one."""
    for name, words in CLASSES.items():
        if any(word in outcome for word in words):
            return name
    return ""


def task(kind: str, count: int, seed: int, keep: str) -> Counter[str]:
    """Carry out one part of the campaign in a process of the pool."""
    from benchmarks.campaigns import fault_folders, fault_readers, fault_runs, fault_world

    fault_runs.warm_up()
    finds = Path(keep)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.chdir(folder)
        todo = {
            "readers": lambda: fault_readers.run(count, seed, folder, finds),
            "folders": lambda: fault_folders.run(count, seed, folder, finds),
            "runs": lambda: fault_runs.run_decks(count, seed, folder, finds),
            "loads": lambda: fault_runs.random_loads(count, seed, folder / "loads"),
            "loose": lambda: fault_runs.loose_models(count, seed, folder),
            "disk": lambda: fault_world.full_disk(folder / "run"),
            "memory": lambda: fault_world.little_memory(folder / "run"),
            "signals": lambda: fault_world.signals(count, seed, folder / "run"),
            "places": lambda: fault_world.odd_places(folder / "run"),
            "results": lambda: fault_world.damaged_results(count, seed, folder / "run"),
            "threads": lambda: fault_world.threads(folder / "run"),
        }
        try:
            return todo[kind]()
        finally:
            os.chdir(ROOT)


def tasks(inputs: int, runs: int, folders: int, seed: int) -> list[tuple[str, int, int]]:
    """Parts of the campaign: kind, count, seed."""
    found = [("threads", 0, 0), ("memory", 0, 0), ("disk", 0, 0), ("places", 0, 0)]
    found += [("signals", 30, seed), ("results", 300, seed)]
    loads, loose = runs // 5, max(runs // 50, 1)
    found += _split("loads", loads, RUNS, seed) + _split("loose", loose, RUNS, seed)
    found += _split("runs", runs - loads - loose, RUNS, seed)
    found += _split("folders", folders, RUNS, seed)
    found += _split("readers", inputs, PART, seed)
    # The first part of each kind first: a campaign that is ended has seen all kinds.
    return sorted(found, key=lambda part: part[2])


def _split(kind: str, total: int, part: int, seed: int) -> list[tuple[str, int, int]]:
    starts = range(0, total, part)
    return [(kind, min(part, total - k), 1_000_000 * seed + k) for k in starts]


def listed() -> Counter[str]:
    """The listed faults, each with its message, line and exit code: tests of their own."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "tests/io/test_faults_run.py",
        "tests/output/test_streams.py",
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    words = done.stdout.strip().splitlines()[-1:] or [done.stderr[-200:]]
    good = done.returncode == 0
    return Counter({f"listed faults: {'' if good else 'failure: '}{words[0]}": 1})


def main() -> int:
    """Run the campaign and print its counts."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--runs", type=int, default=5_000)
    parser.add_argument("--folders", type=int, default=5_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--fresh", action="store_true", help="forget the store")
    parser.add_argument("--keep", default=str(ROOT / "build" / "finds"), help="inputs that failed")
    args = parser.parse_args()
    for name in ("OMP", "OPENBLAS", "MKL", "RAYON"):
        os.environ.setdefault(f"{name}_NUM_THREADS", "1")
    start, outcomes = time.perf_counter(), listed()
    store = CampaignStore("faults", args.fresh)
    parts = tasks(args.inputs, args.runs, args.folders, args.seed)
    for part in filter(store.__contains__, parts):
        outcomes += Counter(store[part])
    with ProcessPoolExecutor(args.jobs, mp_context=get_context("spawn")) as pool:
        todo = [part for part in parts if part not in store]
        waiting = {pool.submit(task, *part, args.keep): part for part in todo}
        for number, future in enumerate(as_completed(waiting), 1):
            part = waiting[future]
            try:
                store[part] = future.result()
                outcomes += store[part]
            except BrokenProcessPool:
                outcomes[f"{part[0]}: crash of the process of seed {part[2]}"] += 1
            except Exception as error:
                outcomes[f"{part[0]}: failure of the campaign: {error!r:.80}"] += 1
            if number % 10 == 0:
                sys.stderr.write(f"{number} of {len(todo)} parts\n")
    rows = [[name, count] for name, count in sorted(outcomes.items())]
    bad = Counter({name: 0 for name in CLASSES})
    for name, count in outcomes.items():
        if classed(name):
            bad[classed(name)] += count
    seconds = time.perf_counter() - start
    print(f"\n### Fault campaign, seed {args.seed}\n\n{machine()}; {seconds:.0f} s\n")
    print(table(["outcome", "count"], rows), "\n")
    print(table(["class", "count"], [[name, bad[name]] for name in CLASSES]))
    return 1 if sum(bad.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
