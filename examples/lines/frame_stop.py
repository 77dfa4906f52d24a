"""A portal frame sways against a stop beside its corner, and the stop takes the rest of the load.

Columns and girder are chains of beams; the corner touches the stop with half the height of the
column. Up to the gap the frame has its sway stiffness 24 EI/h^3 (1 + 6 r)/(4 + 6 r), with r the
stiffness of the girder over that of a column; then the force on the stop grows with the load.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct
from corota import plots
from corota.mesh import Mesh
from corota.mesh.data import Cells

#: Column height and span [m], section height and width [m], Young's modulus [N/m^2].
TALL, SPAN, HEIGHT, WIDTH, YOUNG = 3.0, 4.0, 0.2, 0.1, 2.1e11
#: Gap and radius of the stop [m], load at the girder [N].
GAP, STOP, LOAD = 0.01, 0.15, 4.0e5


def frame(n: int = 8) -> Mesh:
    """Left column upwards, girder, right column downwards: one chain, cell set ``frame``."""
    t = np.linspace(0.0, 1.0, n + 1)
    left = np.column_stack([0.0 * t, TALL * t])
    girder = np.column_stack([SPAN * t, 0.0 * t + TALL])
    right = np.column_stack([0.0 * t + SPAN, TALL * (1.0 - t)])
    points = np.concatenate([left, girder[1:], right[1:]])
    count = len(points)
    chain = np.column_stack([np.arange(count - 1), np.arange(1, count)])
    mesh = Mesh(points, [Cells("line2", chain, np.arange(1, count))], np.arange(1, count + 1))
    mesh.cell_sets["frame"] = np.arange(count - 1)
    mesh.node_sets["feet"] = np.array([0, count - 1])
    mesh.node_sets["corner"] = np.array([n])
    return mesh


def model(load: float = LOAD) -> ct.Model:
    """The frame, its load and its stop."""
    made = ct.Model(frame())
    area, inertia = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12.0
    steel = ct.Elastic(E=YOUNG, nu=0.3)
    made.beam("frame", material=steel, area=area, inertia=inertia)
    made.fix("feet", rotation=True)
    made.force("corner", x=load)
    stop = ct.RigidCurve.circle((SPAN + 0.5 * HEIGHT + GAP + STOP, TALL), STOP)
    made.contact("frame", stop, name="stop")
    return made


def sway_stiffness() -> float:
    """Force per displacement of the girder, without axial deformation [N/m]."""
    inertia, ratio = WIDTH * HEIGHT**3 / 12.0, TALL / SPAN
    return 24.0 * YOUNG * inertia / TALL**3 * (1.0 + 6.0 * ratio) / (4.0 + 6.0 * ratio)


def main(arguments: list[str] | None = None) -> int:
    """Print load and force on the stop, and draw the frame at the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", help="file for a picture of the end")
    chosen = parser.parse_args(arguments)
    results = ct.solve(model(), ct.Static(increments=8))
    for state in results.frames[1:]:
        load, stop = LOAD * state.time, -state.scalars["stop: force x"]
        print(f"load {load:9.0f} N, on the stop {stop:9.0f} N")
    if chosen.picture:
        plots.status(results, scale=20.0, path=chosen.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
