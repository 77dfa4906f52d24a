"""Run benchmarks: all, those named on the command line, or one with options behind its name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
#: Folders of benchmarks.
FOLDERS = ("speed", "campaigns", "corpora", "studies")
#: What needs arguments, or so much time that it runs only when it is named.
NAMED = {
    "before_after",
    "before_after_worker",
    "contact_before_after",
    "mutants",
    "contact_cases",
    "energy_balance",
    "faults",
    "fuzz_readers",
    "kill",
    "checkpoint_cost",
    "contact_beside_peers",
    "contact_torture",
    "free_bodies",
}


def modules() -> dict[str, str]:
    """Benchmarks: names of their modules with the folder by those without it."""
    return {
        path.stem: f"benchmarks.{folder}.{path.stem}"
        for folder in FOLDERS
        for path in sorted((HERE / folder).glob("*.py"))
        if "__main__" in path.read_text(encoding="utf-8")
    }


def main() -> int:
    """Run one with its options, or one after the other; the number of those that failed."""
    known, given = modules(), sys.argv[1:]
    jobs = [[name] for name in given or known if given or name not in NAMED]
    if given and not set(given) <= set(known):
        jobs = [given]
    if jobs[0][0] not in known:
        there = ", ".join(sorted(known))
        sys.stderr.write(f"no benchmark {jobs[0][0]}; there are: {there}\n")
        return 64
    failed = 0
    for name, *options in jobs:
        command = [sys.executable, "-m", known[name], *options]
        failed += subprocess.run(command, check=False).returncode != 0
    return min(failed, 63)


if __name__ == "__main__":
    sys.exit(main())
