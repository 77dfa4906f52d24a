"""A whole Newton iteration of a solid of revolution over that of a plane one with the same mesh.

Runs of both take turns, and the medians of their iterations are compared: assembly, factorization,
solution, judgement of the residual. Target: 1.15.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import statistics
import sys

import corota as ct
from benchmarks.common import report
from benchmarks.speed.newton_iteration import Watch
from corota.model import elements

#: Strain to which a block is pressed in one increment.
PRESSED = 0.02


def model(element: str, plane: str, n: int) -> ct.Model:
    """A block of n x n cells between plates that hold it."""
    mesh = ct.mesh.rectangle(10.0, 10.0, n, n, cell=elements.find(element).cell)
    mesh.points[:, 0] += 10.0
    found = ct.Model(mesh)
    section: dict[str, float] = {} if plane == "axisymmetric" else {"thickness": 1.0}
    steel = ct.Mises(210e3, 0.3, yield_stress=240.0, isotropic=5e3)
    found.section("all", element=element, material=steel, plane=plane, **section)  # type: ignore[arg-type]
    found.fix("bottom")
    found.fix("top", x=0.0, y=-10.0 * PRESSED)
    return found


def times(element: str, plane: str, n: int) -> list[float]:
    """Times of the iterations of a run [s]."""
    watch = Watch()
    ct.solve(model(element, plane, n), ct.Static(increments=1), observers=[watch], threads=1)
    return watch.times


def measure(element: str, n: int, repeats: int) -> list[object]:
    """One row of the table."""
    taken: dict[str, list[float]] = {"strain": [], "axisymmetric": []}
    for _ in range(repeats):
        for plane, found in taken.items():
            found += times(element, plane, n)
    plane, ring = (1e3 * statistics.median(found) for found in taken.values())
    return [element, n * n, plane, ring, ring / plane]


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--elements", nargs="+", default=["Q4", "Q4I", "Q4R", "Q8", "Q8R"])
    options.add_argument("--cells", type=int, default=60, help="along a side")
    options.add_argument("--repeats", type=int, default=5)
    chosen = options.parse_args()
    rows = [measure(name, chosen.cells, chosen.repeats) for name in chosen.elements]
    head = ["element", "cells", "plane strain [ms]", "axisymmetric [ms]", "ratio"]
    report("Newton iteration of a solid of revolution, one thread", head, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
