"""A benchmark problem as a deck that Corota and CalculiX both read, and what their files say."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from benchmarks.corpora.problems import Ints, Problem


def write_deck(path: Path, p: Problem, contact: str = "SURFACE TO SURFACE") -> None:
    """Write a problem; the set WATCH is printed.

    Notes
    -----
    The thickness is small against the mesh, so that CalculiX's layer of bricks is in plane stress.
    The part of the increments that is run is a step of its own with that part of the load.
    """
    card = f"CPS{p.cells.shape[1]}"
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{k + 1}, {x:.12g}, {y:.12g}, 0." for k, (x, y) in enumerate(p.points.tolist())]
    lines.append(f"*ELEMENT, TYPE={card}, ELSET=EALL")
    lines += [
        f"{k + 1}, " + ", ".join(str(node + 1) for node in cell)
        for k, cell in enumerate(p.cells.tolist())
    ]
    lines += ["*NSET, NSET=WATCH", *(f"{node + 1}," for node in p.watch.tolist())]
    still = p.held_values == 0.0
    for dof in (0, 1):
        nodes = np.sort(p.held_nodes[still & (p.held_dofs == dof)])
        lines += [f"*NSET, NSET=HELD{dof + 1}", *(f"{node + 1}," for node in nodes.tolist())]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{p.young:g}, {p.poisson:g}"]
    if p.yield_stress:
        lines += ["*PLASTIC", f"{p.yield_stress:g}, 0.", f"{p.yield_stress + p.slope:g}, 1."]
    if p.name == "P4":
        lines += ["*DENSITY", f"{p.density:g}", "*AMPLITUDE, NAME=ON", "0., 1., 10., 1."]
    # CalculiX's law is one of finite strain: Corota's is set to be one.
    strain = ", LOCAL STRAIN=LOGARITHMIC" if p.yield_stress else ""
    lines += [f"*SOLID SECTION, ELSET=EALL, MATERIAL=M{strain}", f"{p.thickness:g}"]
    if len(p.slave):
        lines += surface(p, "SLAVE", p.slave) + surface(p, "MASTER", p.master)
        lines += ["*SURFACE INTERACTION, NAME=TOUCH"]
        # Linear with fifty times the modulus over the length: CalculiX has no multipliers here.
        lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{50.0 * p.young:g}"]
        if p.friction:
            lines += ["*FRICTION", f"{p.friction:g}, {5.0 * p.young:g}"]
        lines += [f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE={contact}", "SLAVE, MASTER"]
    lines += ["*BOUNDARY", "HELD1, 1, 1", "HELD2, 2, 2", "*STEP, NLGEOM, INC=100000"]
    share = p.last / p.increments
    if p.name == "P4":
        step = p.period / p.increments
        lines += ["*DYNAMIC, DIRECT", f"{step:.12g}, {step * p.last:.12g}"]
        loads, share = "*CLOAD, AMPLITUDE=ON", 1.0
    else:
        lines += ["*STATIC, DIRECT", f"{1.0 / p.last:.12g}, 1."]
        loads = "*CLOAD"
    moved = np.flatnonzero(~still)
    if len(moved):
        lines.append("*BOUNDARY")
        for k in moved.tolist():
            node, dof = p.held_nodes[k] + 1, p.held_dofs[k] + 1
            lines.append(f"{node}, {dof}, {dof}, {share * p.held_values[k]:.12g}")
    if len(p.load_nodes):
        lines.append(loads)
        for node, dof, value in zip(p.load_nodes, p.load_dofs, p.load_values, strict=True):
            lines.append(f"{node + 1}, {dof + 1}, {share * value:.12g}")
    what = "*NODE PRINT, NSET=WATCH, TOTALS=ONLY\nRF" if p.name in ("P2", "P3") else None
    lines += [what or "*NODE PRINT, NSET=WATCH\nU", "*END STEP"]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def surface(p: Problem, name: str, edges: Ints) -> list[str]:
    """Cards of a surface of element faces, from the nodes of its edges."""
    faces = {
        tuple(sorted((int(cell[k]), int(cell[(k + 1) % 4])))): (number, k + 1)
        for number, cell in enumerate(p.cells.tolist(), start=1)
        for k in range(4)
    }
    rows = [faces[tuple(sorted(edge))] for edge in edges.tolist()]
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{e}, S{k}" for e, k in rows)]


def iterations(sta: Path) -> tuple[int, float]:
    """Sum of the iterations and the last time of a ``.sta`` file."""
    rows = [line.split() for line in sta.read_text(encoding="utf-8").splitlines()]
    rows = [row for row in rows if len(row) == 7 and row[0].isdigit()]
    return sum(int(row[3]) for row in rows), float(rows[-1][5]) if rows else 0.0


def result(dat: Path, p: Problem) -> list[float]:
    """What the problem asks for, of a ``.dat`` file."""
    rows = [line.split() for line in dat.read_text(encoding="utf-8").splitlines()]
    if p.name in ("P2", "P3"):
        totals = [r for r in rows if len(r) == 3 and r[0][-1].isdigit()]
        return [float(totals[-1][1])]
    tips = [[float(v) for v in r[1:3]] for r in rows if len(r) == 4 and r[0].isdigit()]
    return [max(v for _, v in tips)] if p.name == "P4" else tips[-1]
