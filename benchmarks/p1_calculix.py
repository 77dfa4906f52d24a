"""The large-rotation cantilever beside CalculiX: the same deck, iterations, time, result.

Both programs read the same file and run as processes of their own, in turn; times hold reading
and writing. CalculiX expands planar elements to a layer of bricks and stops at half a per cent of
residual; Corota goes on to 1e-9. ``--sizes 4k 40k 400k``, ``--repeats``, ``--threads``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from functools import partial
from pathlib import Path

from benchmarks.cantilever import n_equations, write_deck
from benchmarks.common import TIME_LIMIT, Run, median_run, process, report

#: Elements through the height for linear and quadratic elements.
SIZES = {"4k": (14, 8), "40k": (45, 26), "400k": (141, 81)}
#: The same card in both programs, and what Corota offers beside.
ELEMENTS = ("CPS4", "CPS8")
BETTER = {"CPS4": "CPS4=Q4I"}


def corota_command() -> Path:
    """Path of the command of the running environment."""
    return Path(sys.executable).with_name("corota")


def iterations(sta: Path) -> int:
    """Sum of the iterations column of a ``.sta`` file."""
    total = 0
    for line in sta.read_text(encoding="utf-8").splitlines():
        fields = line.split()
        if len(fields) == 7 and fields[0].isdigit():
            total += int(fields[3])
    return total


def last_displacement(dat: Path) -> tuple[float, float]:
    """Displacement in the last row of a ``.dat`` file [length]."""
    rows = [line.split() for line in dat.read_text(encoding="utf-8").splitlines() if line.strip()]
    return float(rows[-1][1]), float(rows[-1][2])


def finish(run: Run, job: Path) -> Run:
    """Attach iterations and tip displacement where the run wrote them."""
    sta, dat = job.with_suffix(".sta"), job.with_suffix(".dat")
    if run.ok and sta.exists() and dat.exists():
        u, v = last_displacement(dat)
        run.values = {"iterations": iterations(sta), "u": u, "v": v}
    elif run.ok:
        run.ok, run.note = False, "no results"
    return run


def run_calculix(folder: Path, deck: Path, threads: int) -> Run:
    job = folder / deck.stem
    for old in folder.glob(f"{deck.stem}.*"):
        if old != deck:
            old.unlink()
    return finish(process(["ccx", "-i", job], folder, threads=threads), job)


def run_corota(folder: Path, deck: Path, threads: int, upgrade: str = "") -> Run:
    out = folder / "corota"
    shutil.rmtree(out, ignore_errors=True)
    command: list[str | Path] = [
        corota_command(),
        "run",
        deck,
        "-o",
        out,
        "--threads",
        str(threads),
    ]
    if upgrade:
        command += ["--element", upgrade]
    return finish(process(command, folder, threads=threads), out / deck.stem)


def measure(size: str, card: str, repeats: int, threads: int) -> list[list[object]]:
    """Rows of the table for one size and element card."""
    order = 2 if "8" in card else 1
    n = SIZES[size][order - 1]
    dofs = n_equations(n, order)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        deck = folder / f"p1_{card.lower()}.inp"
        write_deck(deck, n, card)
        programs = {
            ("Corota", card): partial(run_corota, folder, deck, threads),
            ("CalculiX", card): partial(run_calculix, folder, deck, threads),
        }
        if card in BETTER:
            better = partial(run_corota, folder, deck, threads, BETTER[card])
            programs["Corota", BETTER[card].split("=")[1]] = better
        runs: dict[tuple[str, str], list[Run]] = {name: [] for name in programs}
        for _ in range(repeats if dofs < 100_000 else 1):
            for name, program in programs.items():
                if not (runs[name] and runs[name][0].seconds >= TIME_LIMIT):
                    runs[name].append(program())
    rows: list[list[object]] = []
    base = median_run(runs["Corota", card])
    for (program_name, element), done in runs.items():
        run = median_run(done)
        if not run.ok:
            rows.append([program_name, element, dofs, run.note, "", "", "", ""])
            continue
        count = int(run.values["iterations"])
        each = run.seconds / count
        ratio = each / (base.seconds / base.values["iterations"]) if base.ok else float("nan")
        tip = f"({run.values['u']:.5f}, {run.values['v']:.5f})"
        rows.append([program_name, element, dofs, count, run.seconds, 1e3 * each, ratio, tip])
    return rows


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--sizes", nargs="+", default=["4k", "40k"], choices=list(SIZES))
    options.add_argument("--repeats", type=int, default=3)
    options.add_argument("--threads", type=int, default=1)
    chosen = options.parse_args()
    if shutil.which("ccx") is None:
        sys.stdout.write("p1_calculix: CalculiX (ccx) is not installed; nothing to compare with\n")
        return 1
    rows = [
        row
        for size in chosen.sizes
        for card in ELEMENTS
        for row in measure(size, card, chosen.repeats, chosen.threads)
    ]
    head = ["program", "element", "dofs", "iterations", "time [s]", "per iteration [ms]"]
    head += ["relative to Corota", "tip displacement"]
    title = f"P1, the same deck: 10 increments, {chosen.threads} thread(s)"
    report(title, head, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
