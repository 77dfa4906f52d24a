"""Lee's frame: two legs of 120 that snap through and back under a force on the beam.

E = 720, legs 2 deep and 3 wide, hinged at both ends on their center lines, the force 24 from the
corner, nu = 0.3. Here it is a solid of Q8; the reference is the exact Timoshenko beam. The values
are both limit loads and the displacements there, by arc length with default settings.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.frame_models import lee_frame
from corota.verification.models import run

#: Load factor and displacement (x, y) of the loaded point at the two limit points.
EXACT = [(1.8544527, 26.87833, -48.75424), (-0.93924896, 90.17700, -58.22496)]


@cache
def solved(element: str = "Q8", **keys: Any) -> tuple[ct.Results, int]:
    """Path to a displacement of 62; with the loaded node."""
    model, node = lee_frame(element)
    path = ct.ArcLength(displacement=(node, "y", -62.0))
    return run(model, ct.Static(path=path), **keys), node


def measure() -> Iterator[Value]:
    """Both limit points."""
    results, node = solved()
    points = [p for p in results.critical_points if p.kind == "limit"]
    yield Value("limit points on the path", 2, len(points), 0.0, "absolute")
    for name, exact, point in zip(("first", "second"), EXACT, points, strict=False):
        u = results.frames[point.increment].U[node]
        yield Value(f"{name} limit load, Q8", exact[0], point.factor, 0.02)
        yield Value(f"displacement x there, {name}", exact[1], u[0], 0.02)
        yield Value(f"displacement y there, {name}", exact[2], u[1], 0.02)


def curve() -> Curve:
    """Load against both displacements of the loaded point."""
    results, node = solved()
    load = [f.factor for f in results.frames]
    return Curve(
        "displacement of the loaded point",
        "load",
        {
            "to the right": ([float(f.U[node, 0]) for f in results.frames], load),
            "down": ([-float(f.U[node, 1]) for f in results.frames], load),
        },
        {
            "exact beam, right": ([e[1] for e in EXACT], [e[0] for e in EXACT]),
            "exact beam, down": ([-e[2] for e in EXACT], [e[0] for e in EXACT]),
        },
    )


PROBLEM = Problem(
    title="Lee's frame",
    group="paths and buckling",
    source="S. L. Lee, F. S. Manuel, E. C. Rossow, J. Engng Mech. Div. ASCE 94 (1968); values from "
    "the differential equations of the extensible, shear-flexible beam to seven digits",
    certainty="computed independently",
    why="the solid corner has a finite size: 2 % between solid and beam",
    picture=lambda: Picture(solved(fields=True)[0], "S11"),
    seconds=1.5,
)
