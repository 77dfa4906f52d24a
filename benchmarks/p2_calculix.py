"""The perforated strip beyond yield beside CalculiX: the same deck, iterations, time, reaction.

Quarter strip 10 x 18 with a hole of radius 5, thickness 0.01 (so that CalculiX's layer of bricks
is in plane stress), linear hardening, large displacements; the top is moved by 0.3 in 20
increments. CalculiX takes finite plastic strains, Corota the logarithmic local strain. Both
programs read the same file and run as processes of their own, in turn; times hold reading and
writing. ``--sizes 1k 9k 100k``, ``--repeats``, ``--threads``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import shutil
import tempfile
from functools import partial
from pathlib import Path

from benchmarks.common import TIME_LIMIT, Run, median_run, process, report
from benchmarks.p1_calculix import corota_command, iterations
from corota.verification.plastic_models import find, strip_mesh

#: Cells along an eighth of the hole for linear and quadratic elements.
SIZES = {"1k": (13, 8), "9k": (40, 23), "100k": (134, 77)}
ELEMENTS = ("CPS4", "CPS8")
BETTER = {"CPS4": "CPS4=Q4I"}
PULL, INCREMENTS = 0.3, 20


def write_deck(path: Path, n: int, card: str) -> int:
    """Write the strip as a deck; returns its number of free displacements."""
    mesh = strip_mesh(n, "quad8" if "8" in card else "quad4")
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, 0." for i, (x, y) in enumerate(mesh.points, start=1)]
    lines.append(f"*ELEMENT, TYPE={card}, ELSET=EALL")
    number = 0
    for cells in mesh.cells:
        for nodes in cells.nodes + 1:
            number += 1
            lines.append(f"{number}, " + ", ".join(str(k) for k in nodes))
    held = 0
    for name, axis, value in (("BOTTOM", 1, 0.0), ("LEFT", 0, 0.0), ("TOP", 1, 18.0)):
        nodes = find(mesh, axis, value) + 1
        held += len(nodes)
        lines += [f"*NSET, NSET={name}", *(f"{k}," for k in nodes)]
    lines.append(
        "*MATERIAL, NAME=ALUMINIUM\n*ELASTIC\n70000., .2\n*PLASTIC\n243., 0.\n2483., 1.\n"
        "*SOLID SECTION, ELSET=EALL, MATERIAL=ALUMINIUM, LOCAL STRAIN=LOGARITHMIC\n.01\n"
        "*BOUNDARY\nBOTTOM, 2, 2\nLEFT, 1, 1\n*STEP, NLGEOM, INC=1000\n"
        f"*STATIC, DIRECT\n{1 / INCREMENTS:g}, 1.\n*BOUNDARY\nTOP, 2, 2, {PULL}\n"
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP\n"
    )
    path.write_text("\n".join(lines), encoding="utf-8")
    return 2 * mesh.n_nodes - held


def last_total(dat: Path) -> float:
    """Vertical component of the last total force of a ``.dat`` file [force]."""
    rows = [line.split() for line in dat.read_text(encoding="utf-8").splitlines()]
    return next(float(row[1]) for row in reversed(rows) if len(row) == 3 and row[0][-1].isdigit())


def finish(run: Run, job: Path) -> Run:
    """Attach iterations and reaction where the run wrote them."""
    sta, dat = job.with_suffix(".sta"), job.with_suffix(".dat")
    if run.ok and sta.exists() and dat.exists():
        run.values = {"iterations": iterations(sta), "force": last_total(dat)}
    elif run.ok:
        run.ok, run.note = False, "no results"
    return run


def run_calculix(folder: Path, deck: Path, threads: int) -> Run:
    """CalculiX on a deck."""
    job = folder / deck.stem
    for old in folder.glob(f"{deck.stem}.*"):
        if old != deck:
            old.unlink()
    return finish(process(["ccx", "-i", job], folder, threads=threads), job)


def run_corota(folder: Path, deck: Path, threads: int, upgrade: str = "") -> Run:
    """Corota on a deck, with another element if asked."""
    out = folder / "corota"
    shutil.rmtree(out, ignore_errors=True)
    command: list[str | Path] = [
        corota_command(), "run", deck, "-o", out, "--threads", str(threads),
    ]  # fmt: skip
    if upgrade:
        command += ["--element", upgrade]
    return finish(process(command, folder, threads=threads), out / deck.stem)


def measure(size: str, card: str, repeats: int, threads: int) -> list[list[object]]:
    """Rows of the table for one size and element card."""
    n = SIZES[size][1 if "8" in card else 0]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        deck = folder / f"p2_{card.lower()}.inp"
        dofs = write_deck(deck, n, card)
        programs = {
            ("Corota", card): partial(run_corota, folder, deck, threads),
            ("CalculiX", card): partial(run_calculix, folder, deck, threads),
        }
        if card in BETTER:
            better = partial(run_corota, folder, deck, threads, BETTER[card])
            programs["Corota", BETTER[card].split("=")[1]] = better
        runs: dict[tuple[str, str], list[Run]] = {name: [] for name in programs}
        for _ in range(repeats if dofs < 50_000 else 1):
            for name, program in programs.items():
                if not (runs[name] and runs[name][0].seconds >= TIME_LIMIT):
                    runs[name].append(program())
    rows: list[list[object]] = []
    base = median_run(runs["Corota", card])
    for (program_name, element), done in runs.items():
        run = median_run(done)
        if not run.ok:
            rows.append([program_name, element, dofs, run.note, "", "", ""])
            continue
        ratio = run.seconds / base.seconds if base.ok else float("nan")
        force = f"{run.values['force']:.5f}"
        count = int(run.values["iterations"])
        rows.append([program_name, element, dofs, count, run.seconds, ratio, force])
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", nargs="*", choices=SIZES, default=["1k", "9k"])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    head = ("program", "element", "dofs", "iterations", "time [s]", "of Corota's", "reaction")
    rows = []
    for size in options.sizes:
        for card in ELEMENTS:
            rows += measure(size, card, options.repeats, options.threads)
    report(f"Perforated strip beyond yield, {options.threads} threads", head, rows)


if __name__ == "__main__":
    main()
