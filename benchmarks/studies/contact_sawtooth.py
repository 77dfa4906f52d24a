"""How jagged the force of a snap-fit is with edges of half the radius of the catch's fillets.

Prints the largest departure of each contact force from a smooth curve (polynomial of degree 4 over
the way up the hook), over the largest force there.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys

import numpy as np

import corota as ct
from benchmarks.common import table
from benchmarks.corpora.contact_case_models import METHODS, soft_catch
from corota.model.loads import Fixed

#: Slave edge, way of the catch, increments, and the part of the way that is looked at.
EDGE, WAY, INCREMENTS, PART = 0.15, 2.6, 75, (1.2, 2.45)


def jagged(method: str, smooth: bool) -> tuple[float, float]:
    """Departures of both forces from a smooth curve."""
    model, _ = soft_catch("Q4I", EDGE, method, 0.2, smooth=smooth)
    size = 1.0 / INCREMENTS
    held = [Fixed("catch.top", 1, 0.0), Fixed("catch.top", 0, -WAY)]
    step = ct.Static(first_increment=size, largest_increment=size, supports=held)
    results = ct.solve(model, [step])
    x = WAY * np.array(results.times)
    part = (x > PART[0]) & (x < PART[1])
    out = []
    for axis in "xy":
        force = np.abs(np.array(results.history(f"hook: force {axis}")))[part]
        curve = np.polyval(np.polyfit(x[part], force, 4), x[part])
        out.append(float(np.abs(force - curve).max() / force.max()))
    return out[0], out[1]


def main() -> int:
    """Command line."""
    rows = []
    for method in METHODS:
        for smooth in (False, True):
            x, y = jagged(method, smooth)
            rows.append([method, "yes" if smooth else "no", f"{x:.4f}", f"{y:.4f}"])
    head = ["method", "smooth master", "force along", "force across"]
    sys.stdout.write(f"{table(head, rows)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
