"""Blocks dragged over tables in one increment, beside CalculiX (surface to surface, hard contact).

``python -m benchmarks friction_calculix --count 30`` prints, for random blocks, the force along the
way over the pressing force, over mu: exact is 1. Needs ``ccx`` on the path.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import re
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.common import table
from benchmarks.corpora.ccx_decks import run_ccx
from corota.model.contact import METHODS

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Cells, their element here, and that of CalculiX.
PAIRS = {"quad4": ("Q4I", "CPS4"), "quad8": ("Q8R", "CPS8R"), "tri6": ("T6", "CPS6")}
YOUNG, POISSON, PRESSED = 1e4, 0.3, 1e-3


def bodies(rng: np.random.Generator, cell: str) -> tuple[ct.Mesh, float, float]:
    """A block on a table that is wider or ends below it, the friction, and the way."""
    ends = rng.random() < 0.3
    block = ct.mesh.rectangle(1.0, 0.6, int(rng.integers(3, 8)), 3, cell, origin=(0.5, 0.5))
    length = 1.6 if ends else 4.0
    low = ct.mesh.rectangle(length, 0.5, int(length * rng.integers(4, 7)), 3, cell)
    return (
        ct.mesh.assembly(b=block, t=low),
        float(rng.uniform(0.1, 0.5)),
        float(rng.uniform(0.05, 0.4 if ends else 1.4)),
    )


def ours(
    mesh: ct.Mesh, element: str, sides: list[str], mu: float, way: float, method: str
) -> float:
    """Force along the way over the pressing force and mu."""
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=YOUNG, nu=POISSON))
    model.fix("t.bottom")
    model.contact(*sides, friction=mu, method=method)
    press, drag = ct.Static(), ct.Static()
    press.fix("b.top", x=0.0, y=-PRESSED)
    drag.fix("b.top", x=way, y=-PRESSED)
    frame = ct.solve(model, [press, drag], threads=1).frames[-1]
    force = frame.RF[mesh.nodes_of("b.top")].sum(axis=0)
    return float(-force[0] / force[1] / mu)


def deck(mesh: ct.Mesh, card: str, sides: list[str], mu: float, way: float) -> Iterator[str]:
    """The same as a deck."""
    yield "*NODE, NSET=NALL"
    for n, (x, y) in enumerate(mesh.points, start=1):
        yield f"{n}, {x:.11g}, {y:.11g}, 0."
    yield f"*ELEMENT, TYPE={card}, ELSET=ALL"
    nodes = np.concatenate([cells.nodes for cells in mesh.cells]) + 1
    for cell, row in enumerate(nodes, start=1):
        yield f"{cell}, " + ", ".join(map(str, row))
    for name, where in (("FLOOR", "t.bottom"), ("TOP", "b.top")):
        yield f"*NSET, NSET={name}"
        yield from (f"{n + 1}," for n in mesh.nodes_of(where))
    for name, side in zip("SM", sides, strict=True):
        yield f"*SURFACE, NAME={name}"
        yield from (f"{cell + 1}, S{edge + 1}" for cell, edge in mesh.edge_sets[side])
    yield f"*MATERIAL, NAME=MAT\n*ELASTIC\n{YOUNG:g}, {POISSON:g}"
    yield "*SOLID SECTION, ELSET=ALL, MATERIAL=MAT\n1."
    yield "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"
    yield f"*FRICTION\n{mu:.11g}, {100.0 * YOUNG:g}"
    yield "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nS, M"
    yield "*BOUNDARY\nFLOOR, 1, 2"
    for along in (0.0, way):
        yield "*STEP, NLGEOM, INC=1000\n*STATIC\n*BOUNDARY"
        yield f"TOP, 1, 1, {along:.11g}\nTOP, 2, 2, {-PRESSED:g}"
        yield "*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP"


def theirs(lines: Iterator[str]) -> tuple[float, int]:
    """Force along the way over the pressing force, not a number if it stops; iterations."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text("\n".join(lines) + "\n", encoding="ascii")
        run_ccx(folder)
        data, steps = folder / "job.dat", folder / "job.cvg"
        text = data.read_text() if data.exists() else ""
        rows = re.findall(r"total force[^\n]*time\s+(\S+)\s+(\S+)\s+(\S+)", text)
        done = [row for row in rows if abs(float(row[0]) - 2.0) < 1e-6]
        count = sum(line.split()[:1] not in ([], ["iter."]) for line in _rows(steps))
    return (-float(done[-1][1]) / float(done[-1][2]) if done else np.nan), count


def _rows(file: Path) -> list[str]:
    lines = file.read_text().splitlines() if file.exists() else []
    return [line for line in lines if len(line.split()) > 4 and line.split()[0].isdigit()]


def main() -> int:
    """Prints a line for each and counts; the status is how many of this program's are 1 % off."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=30)
    chosen = parser.parse_args()
    rows, wrong = [], 0
    for number in range(chosen.count):
        rng = np.random.default_rng(number)
        cell = str(rng.choice(list(PAIRS)))
        element, card = PAIRS[cell]
        mesh, mu, way = bodies(rng, cell)
        sides = ["b.bottom", "t.top"] if rng.random() < 0.5 else ["t.top", "b.bottom"]
        found = []
        for method in METHODS:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found.append(ours(mesh, element, sides, mu, way, method))
        other, count = theirs(deck(mesh, card, sides, mu, way))
        wrong += sum(abs(ratio - 1.0) > 0.01 for ratio in found)
        what = f"{element}, {sides[0]} slave, mu {mu:.2f}, by {way:.2f}"
        of_ccx = "stops" if np.isnan(other) else f"{other / mu:.4f}"
        rows.append([str(number), what, *(f"{ratio:.4f}" for ratio in found), of_ccx, str(count)])
    head = ["number", "problem", *METHODS, "CalculiX", "its iterations"]
    print(table(head, rows))
    return min(wrong, 63)


if __name__ == "__main__":
    raise SystemExit(main())
