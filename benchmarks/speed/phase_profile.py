"""Where a run of a deck spends its time, phase by phase, against what the machine can do.

The deck of problem P1 with one increment, read, solved and written by ``corota run`` on one
thread, from 4 thousand to a million dofs (``--sizes``). Seconds are processor time: the clock of
the run's own profile is exchanged, so that other programs on the machine do not count. With it

* an exponent for each phase, fitted over the four largest sizes;
* the floor of the assembly: the bytes of the matrix, positions and elements over the bandwidth of
  a large copy; that of the factorization: the operations of nested dissection on this mesh over
  the speed of a dense product. Both are measured in the same run.

``--write`` draws ``benchmarks/images/phases.png`` and prints; ``--element``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import sys
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from benchmarks.common import process, report
from benchmarks.corpora import decks
from benchmarks.corpora.problems import SIZES, build

ROOT = Path(__file__).resolve().parents[2]
PHASES = ("read", "order", "assemble", "factor", "solve", "contact", "recover", "write", "other")
#: Runs the program with processor time in place of wall time.
CHILD = """
import sys, time
time.perf_counter = time.process_time
from corota.cli import main
sys.exit(main(sys.argv[1:]))
"""
#: Best of five, in a process of its own so that the product takes one thread.
SPEED = """
import time
import numpy as np
def best(work):
    taken = []
    for _ in range(5):
        start = time.process_time()
        work()
        taken.append(time.process_time() - start)
    return min(taken)
a, b = np.ones(20_000_000), np.zeros(20_000_000)
m = np.random.default_rng(0).random((1200, 1200))
print(2 * a.nbytes / best(lambda: np.copyto(b, a)), 2 * 1200**3 / best(lambda: m @ m))
"""
#: Sizes between the named ones: elements through the height.
MAX_EXTRA_CONTACT_ITERATIONS = {"12k": 24, "130k": 80}


def profile(size: str, element: str) -> tuple[int, int, dict[str, float], float]:
    """Dofs, iterations, processor seconds of each phase, peak memory [MB]."""
    SIZES["P1"].update({name: (n, n) for name, n in MAX_EXTRA_CONTACT_ITERATIONS.items()})
    p = build("P1", size, last=1)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        decks.write_deck(folder / "job.inp", p)
        command = ["env", f"PYTHONPATH={ROOT / 'src'}", sys.executable, "-c", CHILD, "run"]
        command += ["job.inp", "-o", "out", "--threads", "1", "--json", "--element", element]
        run = process(command, folder, threads=1, limit=3600.0)
    events = [json.loads(line) for line in run.output.splitlines() if line.startswith("{")]
    end = {e["event"]: e for e in events}
    if not run.ok or "files" not in end:
        raise SystemExit(f"{size}: {run.note} {run.output[-300:]}")
    phases = dict(end["end"]["profile"])
    # Writing runs in a thread beside the rest: the clock of the process counts it twice.
    phases["other"] = max(end["files"]["wall"] - sum(phases.values()), 0.0)
    return p.n_dofs, end["files"]["iterations"], phases, run.peak_mb


def machine_speed() -> tuple[float, float]:
    """Bytes per second of a copy that no cache holds, operations per second of a dense product."""
    with tempfile.TemporaryDirectory() as place:
        run = process([sys.executable, "-c", SPEED], Path(place), threads=1)
    copy, product = run.output.split()
    return float(copy), float(product)


@cache
def dissection(width: int, height: int, sides: int) -> float:
    """Operations of LDLᵀ by nested dissection of a grid of nodes with two dofs each.

    Parameters
    ----------
    width, height : int
        Nodes inside.
    sides : int
        Bits 1, 2, 4, 8: a separator lies to the left, right, below, above.

    Notes
    -----
    Eliminating s dofs that are coupled to r others takes s^3/3 + s^2 r + s r^2 operations. The
    separator is a line across the longer side (George 1973).
    """
    if height > width:
        turned = (sides & 1) << 2 | (sides & 2) << 2 | (sides & 4) >> 2 | (sides & 8) >> 2
        return dissection(height, width, turned)
    across = [bool(sides & bit) for bit in (1, 2, 4, 8)]
    if width <= 2:
        s, middle = 2.0 * width * height, 0
    else:
        s, middle = 2.0 * height, (width - 1) // 2
    corners = sum(across[a] and across[b] for a in (0, 1) for b in (2, 3))
    border = height * (across[0] + across[1]) + width * (across[2] + across[3]) + corners
    r = 2.0 * border
    here = s**3 / 3.0 + s**2 * r + s * r**2
    if width <= 2:
        return here
    left = dissection(middle, height, sides | 2)
    return here + left + dissection(width - 1 - middle, height, sides | 1)


def exponent(sizes: list[int], seconds: list[float]) -> float:
    """Slope of the logarithms by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def draw(dofs: list[int], rows: list[dict[str, float]], path: Path) -> None:
    """Processor time of each phase over dofs."""
    from corota.plots.figure import COLORS, look, new_figure, save

    with look():
        figure = new_figure(4.6, 3.4, shown=False)
        ax = figure.subplots()
        drawn = [p for p in PHASES if all(row.get(p, 0.0) > 0.0 for row in rows)]
        for k, phase in enumerate(drawn):
            seconds = [row[phase] for row in rows]
            label = f"{phase} ({exponent(dofs[-4:], seconds[-4:]):.2f})"
            ax.loglog(
                dofs,
                seconds,
                marker="o",
                markersize=3,
                label=label,
                color=COLORS[k % 7],
                linestyle="-" if k < 7 else "--",
            )
        n = np.array([dofs[0], dofs[-1]], dtype=float)
        for power, text in ((1.0, "n"), (1.5, "n$^{1.5}$")):
            line = rows[-1]["factor"] * 3.0 * (n / n[-1]) ** power
            ax.loglog(n, line, color="#999999", linewidth=0.8, linestyle=":")
            ax.text(n[0], 1.3 * line[0], text, color="#777777", fontsize=8, va="bottom")
        ax.set_xlabel("dofs")
        ax.set_ylabel("processor time [s]")
        ax.grid(True, which="major", alpha=0.3)
        ax.legend(fontsize=7, ncols=1, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        save(figure, path, dpi=110)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", nargs="+", default=["4k", "12k", "40k", "130k", "400k", "1M"])
    parser.add_argument("--element", default="CPS4=Q4I")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    speed, rate = machine_speed()
    dofs, phases, table = [], [], []
    for size in args.sizes:
        n, iterations, found, memory = profile(size, args.element)
        dofs.append(n)
        phases.append(found)
        elements = SIZES["P1"][size][0]
        # Upper triangle written and read once, positions and displacements read, elements read.
        moved = 2 * 8 * 9.5 * n + 4 * 8 * n + 32 * 10 * elements**2
        floors = {
            "assemble": iterations * moved / speed,
            "factor": iterations * dissection(10 * elements, elements + 1, 1) / rate,
        }
        table.append(
            [
                n,
                iterations,
                *(found.get(p, 0.0) for p in PHASES),
                memory,
                f"{found['assemble'] / floors['assemble']:.1f}",
                f"{found['factor'] / floors['factor']:.1f}",
            ]
        )
        sys.stderr.write(f"{table[-1]}\n")
    if len(dofs) > 3:
        fits = [
            exponent(dofs[-4:], [max(r.get(p, 0.0), 1e-9) for r in phases[-4:]]) for p in PHASES
        ]
        reported = [
            f"{f:.2f}" if phases[-1].get(p, 0.0) else "" for f, p in zip(fits, PHASES, strict=True)
        ]
        table.append(["exponent", "", *reported, "", "", ""])
    head = ["dofs", "iterations", *PHASES, "peak MB", "assemble / floor", "factor / floor"]
    report(
        f"Phases of one increment of P1, {args.element}, processor seconds, one thread; copy "
        f"{speed / 1e9:.1f} GB/s, dense product {rate / 1e9:.1f} Gflop/s",
        head,
        table,
    )
    if args.write:
        draw(dofs, phases, ROOT / "benchmarks" / "images" / "phases.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
