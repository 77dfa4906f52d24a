"""Frequencies of spinning and preloaded parts beside CalculiX: a table of docs/dynamics.md.

A steel plate of 100 x 10 mm, 8 x 2 ``CPE8``, held at one end or at both: a static step with
a preload, then ``*STEP, PERTURBATION`` and ``*FREQUENCY``; the same deck in both programs.
CalculiX's elastic material is linear in Green-Lagrange strain, so Corota uses it
here too. Its answers are stored; ``--store`` runs ``ccx`` again, ``--write`` puts the table
between the marks in docs/dynamics.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import write_between

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "dynamics.md"
STORED = ROOT / "benchmarks" / "data" / "preloaded_frequencies.json"
MODES = 4
CELLS = (8, 2)
CLAMP = "*BOUNDARY\nL, 1, 2\n"
CLAMPS = CLAMP + "R, 1, 2\n"


def spin(omega: float, x: float = 0.0, y: float = 5.0) -> str:
    """Spin about a point [rad/s, mm]."""
    return f"*DLOAD\nE, CENTRIF, {omega**2:.6g}, {x}, {y}, 0., 0., 0., 1.\n"


def pull(force: float, dof: int = 1) -> str:
    """Force at the end [N], spread as a cubic edge takes it."""
    return f"*CLOAD\nR, {dof}, {force / 5.0:.6g}\n"


HEAT = "*TEMPERATURE\nALL, {}\n"
#: Boundary conditions, whether the preload is taken with large displacements, preload.
CASES: dict[str, tuple[str, bool, str]] = {
    "at rest": (CLAMP, True, ""),
    "spin of 1000 rad/s about the root": (CLAMP, True, spin(1000.0)),
    "spin of 4000 rad/s about the root": (CLAMP, True, spin(4000.0)),
    "spin of 4000 rad/s, linear preload": (CLAMP, False, spin(4000.0)),
    "spin of 2000 rad/s about a hub 50 mm away": (CLAMP, True, spin(2000.0, -50.0)),
    "blade off the axis (30 mm aside), 2000 rad/s": (CLAMP, True, spin(2000.0, 0.0, -25.0)),
    "spin of 2000 rad/s about the free end": (CLAMP, True, spin(2000.0, 100.0)),
    "tension of 20 kN": (CLAMP, True, pull(2e4)),
    "tension of 20 kN, linear preload": (CLAMP, False, pull(2e4)),
    "compression of 10 kN (70 % of buckling)": (CLAMP, True, pull(-1e4)),
    "bent by 3 kN across": (CLAMP, True, pull(3e3, 2)),
    "bent by 3 kN across, linear preload": (CLAMP, False, pull(3e3, 2)),
    "held at both ends, heated by 20": (CLAMPS, True, HEAT.format(20.0)),
    "held at both ends, heated by 20, linear preload": (CLAMPS, False, HEAT.format(20.0)),
    "held at both ends, cooled by 100": (CLAMPS, True, HEAT.format(-100.0)),
    "one end moved across by 2": (CLAMP, True, "*BOUNDARY\nR, 2, 2, 2.\n"),
    "one end moved across by 20, linear preload": (CLAMP, False, "*BOUNDARY\nR, 2, 2, 20.\n"),
}


def deck(case: str) -> str:
    """The deck of a case."""
    held, large, load = CASES[case]
    nx, ny = CELLS
    label: dict[tuple[int, int], int] = {}
    nodes = []
    for j in range(2 * ny + 1):
        for i in range(2 * nx + 1):
            if not (i % 2 and j % 2):
                label[i, j] = len(label) + 1
                nodes.append(f"{label[i, j]}, {50.0 * i / nx}, {5.0 * j / ny}")
    corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = []
    for j in range(ny):
        for i in range(nx):
            own = [label[2 * i + p, 2 * j + q] for p, q in corners]
            elements.append(", ".join(map(str, [len(elements) + 1, *own])))
    ends = [", ".join(str(label[i, j]) for j in range(2 * ny + 1)) for i in (0, 2 * nx)]
    lines = [
        "*NODE, NSET=ALL",
        *nodes,
        "*ELEMENT, TYPE=CPE8, ELSET=E",
        *elements,
        f"*NSET, NSET=L\n{ends[0]}\n*NSET, NSET=R\n{ends[1]}",
        "*MATERIAL, NAME=M\n*ELASTIC\n210000., .3\n*DENSITY\n7.8e-9\n*EXPANSION\n1.2e-5",
        "*SOLID SECTION, ELSET=E, MATERIAL=M, LOCAL STRAIN=GREEN LAGRANGE\n3.",
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 0.",
        held.rstrip(),
    ]
    if load:
        static = "*STEP, NLGEOM" if large else "*STEP"
        lines += [f"{static}\n*STATIC\n{load.rstrip()}\n*END STEP", "*STEP, PERTURBATION"]
    else:
        lines.append("*STEP")
    return "\n".join([*lines, f"*FREQUENCY\n{MODES}\n*END STEP"]) + "\n"


def ours(case: str) -> Any:
    """Frequencies [Hz], shape (MODES,)."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "job.inp"
        path.write_text(deck(case), encoding="ascii")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ct.solve(ct.read(path), threads=1).modes[-1].factors[:MODES]


def calculix(case: str) -> list[float]:
    """Frequencies of ``ccx`` [Hz]."""
    with tempfile.TemporaryDirectory() as folder:
        text = deck(case).replace(", LOCAL STRAIN=GREEN LAGRANGE", "")
        (Path(folder) / "job.inp").write_text(text, encoding="ascii")
        subprocess.run(["ccx", "-i", "job"], cwd=folder, check=True, capture_output=True)
        lines = (Path(folder) / "job.dat").read_text(encoding="ascii").splitlines()
    begin = next(k for k, line in enumerate(lines) if "E I G E N V A L U E" in line)
    found = []
    for line in lines[begin + 1 :]:
        row = line.split()
        if len(row) == 5 and row[0].isdigit():
            found.append(float(row[3]))
        elif found:
            break
    return found[:MODES]


def table() -> str:
    """Lines of Markdown."""
    stored = json.loads(STORED.read_text(encoding="utf-8"))
    lines = [
        "| part | CalculiX 2.20, first four [Hz] | Corota | largest difference |",
        "| --- | --- | --- | --- |",
    ]
    for case in CASES:
        theirs, mine = np.array(stored[case]), ours(case)
        off = float(np.abs(mine / theirs - 1.0).max())
        both = [", ".join(f"{v:.2f}" for v in values) for values in (theirs, mine)]
        lines.append(f"| {case} | {both[0]} | {both[1]} | {off:.1e} |")
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--store", action="store_true", help="run ccx and store its answers")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    if options.store:
        found = {case: calculix(case) for case in CASES}
        STORED.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    text = table()
    sys.stdout.write(text + "\n")
    if options.write:
        write_between(PAGE, "preloaded", text)


if __name__ == "__main__":
    main()
