"""Roll a thin strip up to a full circle by a moment on the drilling rotations of its end.

Exact for a beam: the moment 2 pi EI/L bends it to a closed circle. Length 10, height 0.1.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import sys

import numpy as np

import corota as ct

LENGTH, HEIGHT, YOUNG = 10.0, 0.1, 1.2e6
MOMENT = 2.0 * math.pi * YOUNG * HEIGHT**3 / 12.0 / LENGTH


def strip(nx: int = 100) -> ct.Model:
    """Build the clamped strip with half of the moment at each node of its end."""
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, nx=nx, ny=1, cell="quad4")
    model = ct.Model(mesh, name="rollup")
    model.section("all", element="Q4D", material=ct.Elastic(E=YOUNG, nu=0.0), thickness=1.0)
    model.fix("left", rotation=True)
    model.force(mesh.nodes_of("right"), moment=MOMENT / 2.0)
    return model


def main() -> ct.Results:
    results = ct.solve(strip(), ct.Static(increments=20))
    end = results.mesh.nodes_of("right")
    place = results.mesh.points[end] + results.frames[-1].U[end]
    miss = float(np.hypot(*(place.mean(axis=0) - [0.0, HEIGHT / 2.0])))
    turn = math.degrees(float(results.frames[-1].UR[end].mean()))
    sys.stdout.write(
        f"The end turned by {turn:.1f} degrees and misses the start by {miss / LENGTH:.3%} of the "
        f"length,\nin {results.info['iterations']} iterations.\n"
    )
    return results


if __name__ == "__main__":
    main()
