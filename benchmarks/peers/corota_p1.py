"""P1 with Corota, without output. Arguments: n, tolerance, element, local strain, threads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import time

import numpy as np

import corota as ct
from benchmarks import cantilever as p1
from corota.mesh import Cells


def main() -> None:
    n, tolerance = int(sys.argv[1]), float(sys.argv[2])
    element, local_strain, threads = sys.argv[3], sys.argv[4], int(sys.argv[5])
    start = time.perf_counter()
    points, cells = p1.grid(n)
    mesh = ct.Mesh(points, [Cells("quad4", cells, np.arange(1, len(cells) + 1))])
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=p1.YOUNG, nu=p1.POISSON),
        thickness=p1.THICKNESS,
        local_strain=local_strain,
    )
    model.fix(np.flatnonzero(points[:, 0] == 0.0))
    for node, share in p1.tip_shares(points).items():
        model.force([node], y=p1.SHEAR * p1.THICKNESS * share)
    step = ct.Static(increments=p1.INCREMENTS, tolerance=tolerance)
    ready = time.perf_counter()
    results = ct.solve(model, step, threads=threads)
    done = time.perf_counter()
    u, v = results.frames[-1].U[p1.tip_middle(points)]
    iterations = sum(int(frame.scalars["iterations"]) for frame in results.frames[1:])
    result = {"setup": ready - start, "solve": done - ready, "iterations": iterations}
    sys.stdout.write(json.dumps({**result, "u": float(u), "v": float(v)}) + "\n")


if __name__ == "__main__":
    main()
