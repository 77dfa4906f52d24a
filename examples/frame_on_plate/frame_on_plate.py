"""A portal frame of beams that stands on a plate and sways under a force on its head.

Each column ends in a base plate: a rigid body of its foot and of the plate's edge below, whose
reference node is the foot, so that force and moment of the beam go into the drilling elements. The
sway is printed with that of the same frame on a rigid base, and the reactions of the plate.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import corota as ct
from corota import plots
from corota.mesh.data import Cells

WIDTH, DEPTH, THICKNESS = 60.0, 20.0, 2.0
SPAN, HEIGHT, BASE = 30.0, 40.0, 5.0
#: Square tubes of the frame: area, second moment, shear area.
AREA, INERTIA, SHEAR = 3.0, 4.0, 1.5
STEEL = ct.Elastic(E=2.1e5, nu=0.3)


def frame(force: float = 300.0, fine: int = 1, rigid: bool = False) -> tuple[ct.Model, int]:
    """Model and its loaded node; `rigid` clamps the feet instead of setting them on the plate."""
    step = 2.5 / fine
    plate = ct.mesh.rectangle(WIDTH, DEPTH, nx=24 * fine, ny=8 * fine)
    left, right = 0.5 * (WIDTH - SPAN), 0.5 * (WIDTH + SPAN)
    up = np.arange(DEPTH, DEPTH + HEIGHT + 0.5 * step, step)
    across = np.arange(left, right + 0.5 * step, step)
    corner = DEPTH + HEIGHT
    way = np.concatenate(
        [
            np.stack([0.0 * up + left, up], axis=1),
            np.stack([across, 0.0 * across + corner], axis=1)[1:-1],
            np.stack([0.0 * up + right, up], axis=1)[::-1],
        ]
    )
    n, first = plate.n_cells, plate.n_nodes
    nodes = first + np.arange(len(way))
    lines = np.stack([nodes[:-1], nodes[1:]], axis=1)
    mesh = replace(
        plate,
        points=np.vstack([plate.points, way]),
        cells=[*plate.cells, Cells("line2", lines, np.arange(n + 1, n + len(lines) + 1))],
        node_labels=np.arange(1, first + len(way) + 1),
        cell_sets={"plate": np.arange(n), "frame": n + np.arange(len(lines))},
    )
    model = ct.Model(mesh, name="frame_on_plate")
    model.section("plate", element="Q4D", material=STEEL, thickness=THICKNESS)
    model.beam("frame", material=STEEL, area=AREA, inertia=INERTIA, shear_area=SHEAR)
    top = plate.nodes_of("top")
    for foot in (nodes[0], nodes[-1]):
        if rigid:
            model.fix([foot], rotation=True)
        else:
            under = np.abs(plate.points[top, 0] - mesh.points[foot, 0]) < 0.5 * BASE + 1e-9
            model.rigid(top[under], int(foot))
    model.fix("bottom")
    head = int(nodes[len(up) - 1])
    model.force([head], x=force)
    return model, head


def main() -> ct.Results:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--picture", type=Path, help="file for a picture of the frame")
    args = parser.parse_args()
    rigid, head = frame(rigid=True)
    stiff = ct.solve(rigid, ct.Static(increments=2)).frames[-1].U[head, 0]
    model, head = frame()
    results = ct.solve(model, ct.Static(increments=2))
    last = results.frames[-1]
    held = last.RF[model.mesh.nodes_of("bottom")].sum(axis=0)
    moments = np.abs(np.concatenate([last.fields[1].values[m].ravel() for m in ("M1", "M2")]))
    sys.stdout.write(
        f"sway of the head: {last.U[head, 0]:.5f}, on a rigid base {stiff:.5f} "
        f"({100.0 * (last.U[head, 0] / stiff - 1.0):.1f} % more)\n"
        f"largest moment in the frame: {moments.max():.6g}\n"
        f"force that holds the plate: {held[0]:.6g} across, {held[1]:.2g} along the columns\n"
    )
    if args.picture:
        plots.contour(results, "MISES", scale=4.0, path=args.picture)
    return results


if __name__ == "__main__":
    main()
