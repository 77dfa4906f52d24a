"""Run the benchmarks: all, or those named on the command line."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
#: What is not a benchmark by itself.
HELPERS = {
    "__init__",
    "__main__",
    "common",
    "cantilever",
    "problems",
    "decks",
    "bench_figures",
    "before_after",
    "before_after_worker",
    "fault_readers",
    "fault_runs",
    "fault_world",
    "contact_problems",
    "contact_case_models",
    "free_body_decks",
    "mechanisms",
    "mutants",
    "kill_worker",
    "restart_cases",
    "same_bits",
}
#: What takes so long that it runs only when it is named.
LONG = {
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


def names() -> list[str]:
    """Benchmarks by module name."""
    return sorted(path.stem for path in HERE.glob("*.py") if path.stem not in HELPERS)


def main() -> int:
    """Run one after the other; the number of those that failed."""
    wanted = sys.argv[1:] or [name for name in names() if name not in LONG]
    unknown = sorted(set(wanted) - set(names()))
    if unknown:
        sys.stderr.write(f"no benchmark {', '.join(unknown)}; there are: {', '.join(names())}\n")
        return 64
    failed = 0
    for name in wanted:
        command = [sys.executable, "-m", f"benchmarks.{name}"]
        failed += subprocess.run(command, cwd=HERE.parent, check=False).returncode != 0
    return min(failed, 63)


if __name__ == "__main__":
    sys.exit(main())
