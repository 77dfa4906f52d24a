"""What the example scripts print and how long they take, for their pages in the gallery.

``python docs/builder/example_runs.py [NAME ...]`` runs them, or those whose path contains a name,
and keeps processor time and output in ``example_runs.json`` beside this file.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import thumbnails

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
FILE = Path(__file__).with_name("example_runs.json")
#: Lines of output that a page shows.
LINES = 40


def stored() -> dict[str, dict[str, object]]:
    """Processor time [s] and printed lines of each example, by its path below ``examples``."""
    found: dict[str, dict[str, object]] = json.loads(FILE.read_text(encoding="utf-8"))
    return found


def record(seconds: float, printed: str) -> dict[str, object]:
    """One entry: two digits of the time, and as many lines as a page shows."""
    lines = [line.rstrip() for line in printed.strip("\n").splitlines()]
    if len(lines) > LINES:
        lines = [*lines[: LINES // 2], "...", *lines[-LINES // 2 :]]
    return {"seconds": float(f"{seconds:.2g}"), "printed": lines}


def run(script: Path) -> dict[str, object]:
    """Run a script in an empty folder."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, str(script)], cwd=folder, capture_output=True, text=True, check=True
        )
    after = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    return record(after - before, done.stdout)


def write(runs: dict[str, dict[str, object]]) -> None:
    """Keep the runs."""
    text = json.dumps(dict(sorted(runs.items())), indent=1, ensure_ascii=False)
    FILE.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    runs = stored() if FILE.exists() else {}
    for script in thumbnails.scripts():
        path = script.relative_to(EXAMPLES).with_suffix("").as_posix()
        if not sys.argv[1:] or any(word in path for word in sys.argv[1:]):
            runs[path] = run(script)
            write(runs)
            print(path, runs[path]["seconds"], flush=True)
