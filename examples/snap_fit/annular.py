"""An annular snap-fit: a tube with a lip is pushed over a rigid shaft, and pulled off again.

The tube has a bore of 20, a wall of 1.5 and a round lip of 0.5 at its free end, of a polymer
(E 2300, nu 0.38; N, mm); the shaft a chamfer of 30 degrees, a land of radius 9.95 and a groove with
45 degrees; friction 0.2. Forces are of the whole circumference.

On the land the force is that of a half-infinite shell with a line load near its end, and the
largest force of insertion that of a wedge on this shell, turned by the wall. A strip in plane
strain, as snap-fits are often estimated, has no hoop: it is 50 times too soft.
``--calculix 0.02`` runs the same tube (CAX8R) and shaft in CalculiX, in and out, within minutes:
592 N on the land, 1848 N of insertion, 1482 N of retention, where Corota has 600, 1799 and 1460 N.
CalculiX pairs surfaces once an increment; with increments of 0.1 its insertion is 2178 N.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct

E, NU, FRICTION = 2300.0, 0.38, 0.2
WALL, LENGTH, LIP, LAND = 1.5, 12.0, 0.5, 9.95
#: Steps: the way of the shaft and the number of increments.
STAGES = ((2.4, 2), (3.6, 12), (5.0, 4), (9.2, 20), (8.0, 2), (6.7, 13))


def tube(nx: int = 3, ny: int = 46, cell: str = "quad4") -> ct.Mesh:
    """The section of the tube, fine at its lip."""
    mesh = ct.mesh.rectangle(WALL, 1.0, nx, ny, cell)
    x, y = mesh.points.T.copy()
    y = np.interp(y, [0.0, 32.0 / 46.0, 1.0], [0.0, 2.5, LENGTH])
    lip = LIP * np.sin(0.5 * np.pi * (np.clip(y, 0.25, 2.25) - 0.25)) ** 2
    mesh.points[:] = np.stack([10.0 - lip + x * (WALL + lip) / WALL, y], axis=1)
    return mesh


def shaft(node: int | None = None) -> ct.RigidCurve:
    """Its surface, from the chamfer to the groove and beyond."""
    end = -0.5 - (LAND - 9.0) / np.tan(np.radians(30.0))
    land = [(9.0, -0.5), (LAND, end), (LAND, -5.5), (9.4, -6.05), (9.4, -9.5), (LAND, -10.05)]
    return ct.RigidCurve.polyline([*land, (LAND, -30.0)], fillet=0.6, reference=node)


def snap_fit(plane: str, method: str = "node_to_segment") -> tuple[ct.Model, int]:
    """The tube clamped at its other end, and the node that moves the shaft."""
    mesh = tube()
    node = ct.mesh.add_node(mesh, 0.0, -10.0, "shaft")
    model = ct.Model(mesh, name="annular snap-fit")
    section: dict[str, Any] = {} if plane == "axisymmetric" else {"thickness": 20.0 * np.pi}
    section["local_strain"] = "green_lagrange"  # that of CalculiX
    model.section("all", element="Q4I", material=ct.Elastic(E, NU), plane=plane, **section)
    model.contact("left", shaft(node), friction=FRICTION, method=method, name="snap")
    model.fix("top")
    if plane != "axisymmetric":
        model.fix("shaft", y=None, rotation=True)
    return model, node


def pushed(model: ct.Model, node: int, *stages: tuple[float, int]) -> list[np.ndarray]:
    """Ways and forces of the shaft in steps to given places, in given numbers of increments."""
    steps = []
    for way, increments in stages:
        step = ct.Static(increments=increments)
        step.fix([node], x=None if model.sections[0].axisymmetric else 0.0, y=way)
        steps.append(step)
    frames = ct.solve(model, steps, threads=1).frames
    return [
        np.array([[f.U[node, 1], f.RF[node, 1]] for f in frames if f.step == n + 1])
        for n in range(len(stages))
    ]


def shell_stiffness() -> tuple[float, float]:
    """Force by deflection of the tube at the lip, and rotation by deflection.

    A half-infinite beam on an elastic foundation with the load near its end (Hetenyi 1946, ch. 3).
    """
    radius, a = 10.0 + 0.5 * WALL, 1.25
    beta = (3.0 * (1.0 - NU**2)) ** 0.25 / np.sqrt(radius * WALL)
    c, s, decay = np.cos(beta * a), np.sin(beta * a), np.exp(-2.0 * beta * a)
    share = 1.0 + decay * (1.0 + 2.0 * c**2 - 2.0 * s * c)
    line = 2.0 * E * WALL / (beta * radius**2 * share)
    return line * 2.0 * np.pi * radius, beta


def estimates() -> tuple[float, float]:
    """Force on the land, and the largest one of insertion: the corner of the land on the lip."""
    stiff, beta = shell_stiffness()
    y = np.linspace(0.25, 1.25, 200)
    lip = LIP * np.sin(0.5 * np.pi * (y - 0.25)) ** 2
    slope = 0.5 * np.pi * LIP * np.sin(np.pi * (y - 0.25))
    deflection = np.maximum(lip - (10.0 - LAND), 0.0)
    angle = np.arctan(slope) - beta * deflection + np.arctan(FRICTION)
    wedge = float((stiff * deflection * np.tan(angle)).max())
    return FRICTION * stiff * (LIP - 10.0 + LAND), wedge


def cantilever() -> float:
    """Force on the land of a strip of the same section and depth in plane strain."""
    inertia = 20.0 * np.pi * WALL**3 / 12.0
    beam = 3.0 * E / (1.0 - NU**2) * inertia / (LENGTH - 1.25) ** 3
    return FRICTION * beam * (LIP - 10.0 + LAND)


def deck(increment: float, nx: int = 3, ny: int = 46) -> str:
    """The deck for CalculiX: the shaft of stiff elements, all of whose nodes are moved."""
    body = tube(nx, ny, "quad8")
    curve = []
    for x0, y0, x1, y1, cx, cy, sweep in shaft().segments:
        n = 12 if sweep else max(2, int(np.hypot(x1 - x0, y1 - y0) / 0.25))
        t = np.linspace(0.0, 1.0, n, endpoint=False)
        if sweep:
            c, s = np.cos(sweep * t), np.sin(sweep * t)
            curve += zip(
                cx + c * (x0 - cx) - s * (y0 - cy), cy + s * (x0 - cx) + c * (y0 - cy), strict=True
            )
        else:
            curve += zip(x0 + t * (x1 - x0), y0 + t * (y1 - y0), strict=True)
    curve = [p for p in curve if p[1] > -14.0]
    first = body.n_nodes + 1
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, 0." for i, (x, y) in enumerate(body.points.tolist(), 1)]
    lines += ["*NODE, NSET=SHAFT"]
    for i, (x, y) in enumerate(curve):
        lines += [
            f"{first + 2 * i}, 7., {y:.12g}, 0.",
            f"{first + 2 * i + 1}, {x:.12g}, {y:.12g}, 0.",
        ]
    lines += ["*ELEMENT, TYPE=CAX8R, ELSET=TUBE"]
    cells = body.cells[0].nodes + 1
    lines += [", ".join(map(str, [k, *row])) for k, row in enumerate(cells.tolist(), 1)]
    lines += ["*ELEMENT, TYPE=CAX4, ELSET=RIGID"]
    start = len(cells)
    for i in range(len(curve) - 1):
        a = first + 2 * i  # downwards: inner below, outer below, outer, inner
        lines.append(f"{start + i + 1}, {a + 2}, {a + 3}, {a + 1}, {a}")
    lines += ["*NSET, NSET=TOP", *(f"{n + 1}," for n in body.nodes_of("top"))]
    lines += ["*SURFACE, NAME=BORE"]
    lines += [f"{c + 1}, S{s + 1}" for c, s in body.edge_pairs("left").tolist()]
    lines += ["*SURFACE, NAME=LAND", "RIGID, S2"]
    lines += ["*MATERIAL, NAME=POLYMER", "*ELASTIC", f"{E}, {NU}"]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0."]
    lines += ["*SOLID SECTION, ELSET=TUBE, MATERIAL=POLYMER"]
    lines += ["*SOLID SECTION, ELSET=RIGID, MATERIAL=STEEL"]
    lines += ["*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
    lines += ["1e5, 1e-3", "*FRICTION", f"{FRICTION}, 1e4"]
    lines += ["*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", "BORE, LAND"]
    lines += ["*BOUNDARY", "TOP, 1, 2", "SHAFT, 1, 1"]
    begin = 0.0
    for way in (2.4, 3.6, 5.0, 9.2, 8.0, 6.7):
        n = max(2, round(abs(way - begin) / increment))
        lines += ["*STEP, NLGEOM, INC=5000", "*STATIC", f"{1.0 / n}, 1., 1e-6, {1.0 / n}"]
        lines += ["*BOUNDARY", f"SHAFT, 2, 2, {way}"]
        lines += ["*NODE PRINT, NSET=SHAFT, TOTALS=ONLY", "RF", "*END STEP"]
        begin = way
    return "\n".join(lines) + "\n"


def calculix(increment: float) -> np.ndarray:
    """Total time and force of CalculiX, shape (n, 2); one unit of time for each stage."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "snap.inp").write_text(deck(increment))
        subprocess.run(["ccx", "snap"], cwd=folder, capture_output=True, check=False)
        text = (Path(folder) / "snap.dat").read_text()
    found = []
    time = 0.0
    for line in text.splitlines():
        words = line.split()
        if "total force" in line:
            time = float(words[-1])
        elif len(words) == 3:
            # Of a sector of 2 degrees.
            found.append((time, 180.0 * float(words[1])))
    return np.array(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--calculix", type=float, metavar="INCREMENT", help="way of an increment")
    given = parser.parse_args()
    land, wedge = estimates()
    stages = pushed(*snap_fit("axisymmetric"), *STAGES)
    flat = pushed(*snap_fit("strain"), *STAGES[:3])
    rows = [
        ("on the land", stages[2][-1, 1], land),
        ("insertion", stages[1][:, 1].max(), wedge),
        ("retention", -stages[5][:, 1].min(), np.nan),
        ("on the land, plane strain", flat[2][-1, 1], cantilever()),
    ]
    sys.stdout.write(f"{'':28}{'force':>8}{'estimate':>10}\n")
    for name, force, estimate in rows:
        sys.stdout.write(f"{name:28}{force:8.1f}{estimate:10.1f}\n")
    if given.calculix:
        time, force = calculix(given.calculix).T
        sys.stdout.write(
            f"CalculiX, increments of {given.calculix:g}: reached {time[-1]:.3f} of 6\n"
        )
        for name, begin, end, sign in (
            ("insertion", 1.0, 2.0, 1.0),
            ("on the land", 2.9, 3.0, 1.0),
            ("retention", 5.0, 6.0, -1.0),
        ):
            some = (time > begin) & (time <= end + 1e-9)
            if some.any():
                sys.stdout.write(f"{name:28}{(sign * force[some]).max():8.1f}\n")


if __name__ == "__main__":
    main()
