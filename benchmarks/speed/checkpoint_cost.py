"""What checkpoints cost: processor time of one, its share at one a minute, bytes a dof.

``python -m benchmarks checkpoint_cost [--sizes 410 41k 1M] [--write]`` runs the cantilever P1 with
a checkpoint after each increment and times, within the same run, the copy that the analysis waits
for, the writing beside it, and the digests at the start that tell what need not be stored. By
default a checkpoint is written after each minute, and not before a hundred times the cost of the
last has passed: its share is at most its cost over the longer of both.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import corota as ct
from benchmarks.common import machine, write_between
from corota.analysis import run as analysis
from corota.io.job import CHECKPOINT_SECONDS, CHECKPOINT_WAIT, JobFiles

#: Cells along and across, and increments.
SIZES = {"410": (40, 4, 40), "41k": (400, 50, 4), "1M": (2000, 249, 1)}
PAGE = Path(__file__).resolve().parents[2] / "docs/restart.md"


def model(nx: int, ny: int) -> ct.Model:
    """The cantilever P1 with ten internal numbers an element."""
    found = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=nx, ny=ny), name="job")
    material = ct.Mises(E=1.2e6, nu=0.3, yield_stress=2e5, isotropic=1e4)
    found.section("all", element="Q4I", material=material, thickness=0.01)
    found.fix("left")
    found.force("right", y=-20.0)
    return found


class Clock:
    """Processor time of the calls of a function in its thread [s]."""

    def __init__(self, function: Any) -> None:
        self.function, self.seconds, self.calls = function, 0.0, 0

    def __call__(self, *args: Any, **options: Any) -> Any:
        begin = time.thread_time()
        try:
            return self.function(*args, **options)
        finally:
            self.seconds += time.thread_time() - begin
            self.calls += 1


def measured(nx: int, ny: int, increments: int) -> dict[str, float]:
    """Costs of one run."""
    take, digests = Clock(analysis.take), Clock(analysis.arrays_as_built)
    true = analysis.take, analysis.arrays_as_built
    analysis.take, analysis.arrays_as_built = take, digests  # type: ignore[assignment]
    with tempfile.TemporaryDirectory() as folder:
        files = JobFiles(folder, checkpoint_every=1, checkpoint_seconds=0.0)
        write = Clock(files._checkpoint)
        files._checkpoint = write  # type: ignore[method-assign]
        begin = time.process_time()
        try:
            results = ct.solve(
                model(nx, ny), ct.Static(increments=increments), observers=[files], threads=1
            )
        finally:
            analysis.take, analysis.arrays_as_built = true
        spent = time.process_time() - begin
        size = (Path(folder) / "job.ckpt").stat().st_size
    dofs = results.info["n_dofs"]
    frame = results.frames[-1]
    # What nobody can leave out: displacements, and the history of the points.
    plain = 8 * dofs + sum(b.values["PEEQ"].size * 8 * 5 for b in frame.fields)
    return {
        "dofs": dofs,
        "run": spent - take.seconds - write.seconds - digests.seconds,
        "take": take.seconds / take.calls,
        "write": write.seconds / write.calls,
        "digests": digests.seconds,
        "bytes": size / dofs,
        "plain": plain / dofs,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--sizes", nargs="+", choices=SIZES, default=list(SIZES))
    parser.add_argument("--write", action="store_true", help="put the table into docs/restart.md")
    args = parser.parse_args()
    warnings.simplefilter("ignore")
    lines = [
        "| dofs | run without, s | one checkpoint: copy + writing, s | digests at the start "
        "| share of a run by default | bytes a dof | plain state |",
        "| --- " * 7 + "|",
    ]
    missed = False
    for size in args.sizes:
        m = measured(*SIZES[size])
        each = m["take"] + m["write"]
        # A run that lasts until its first checkpoint: this one, and the digests once.
        wait = max(CHECKPOINT_SECONDS, CHECKPOINT_WAIT * each)
        share = each / wait + m["digests"] / max(m["run"], CHECKPOINT_SECONDS)
        own = m["digests"] / m["run"]
        missed = missed or share > 0.02
        lines.append(
            f"| {m['dofs']:,} | {m['run']:.2f} | {m['take']:.4f} + {m['write']:.4f} | "
            f"{m['digests']:.4f} s, {own:.1%} of this run | {share:.2%} | {m['bytes']:.0f} | "
            f"{m['plain']:.0f} |"
        )
        sys.stdout.write(lines[-1] + "\n")
        sys.stdout.flush()
    text = "\n".join(lines)
    sys.stdout.write(f"{text}\n\nProcessor time, one thread. {machine()}\n")
    if args.write:
        write_between(PAGE, "cost", text)
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
