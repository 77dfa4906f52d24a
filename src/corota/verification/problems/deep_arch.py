"""Deep circular arch of 215 degrees, one end hinged and one clamped, under a force on its crown.

R = 100, EI = 1e6, depth 1, nu = 0. The classical problem of J. F. DaDeppo and R. Schmidt; the
well-known 905.28 belongs to a coarse mesh. Curved full-integration elements lock in membrane
action: with 60 cells around Q8 gives 925, with 120 it gives 900, hence 240 here. The values are the
limit load, the displacement there and the second limit load. Beyond it the arch passes through its
own foot, because there is no contact.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.frame_models import deep_arch
from corota.verification.models import run

LOAD = 1000.0
#: Limit loads, and the displacement of the crown at the first.
FIRST, SECOND, PLACE = 897.28913, -73.055, (-61.14168, -113.73065)


@cache
def solved(element: str = "Q8", **keys: Any) -> tuple[ct.Results, int]:
    """Path to a deflection of 124; with the node of the crown."""
    model, crown = deep_arch(element, LOAD, cells=240)
    path = ct.ArcLength(displacement=(crown, "y", -124.0))
    return run(model, ct.Static(path=path), **keys), crown


def measure() -> Iterator[Value]:
    """Both limit points."""
    results, crown = solved()
    points = [p for p in results.critical_points if p.kind == "limit"]
    yield Value("limit points on the path", 2, len(points), 0.0, "absolute")
    yield Value("first limit load, Q8", FIRST, LOAD * points[0].factor, 1e-3)
    for axis, exact, found in zip(
        "xy", PLACE, results.frames[points[0].increment].U[crown], strict=True
    ):
        yield Value(f"displacement {axis} there", exact, found, 1e-3)
    yield Value("second limit load, Q8", SECOND, LOAD * points[1].factor, 0.02)


def curve() -> Curve:
    """Load against the deflection of the crown."""
    results, crown = solved()
    drop = [-float(f.U[crown, 1]) for f in results.frames]
    return Curve(
        "deflection of the crown",
        "load",
        {"Q8": (drop, [LOAD * f.factor for f in results.frames])},
        {"exact beam": ([-PLACE[1]], [FIRST])},
    )


PROBLEM = Problem(
    title="Deep arch, hinged and clamped",
    group="paths and buckling",
    source="J. F. DaDeppo, R. Schmidt, J. Appl. Mech. 42 (1975); values from the differential "
    "equations of the extensible, shear-flexible beam",
    certainty="computed independently",
    why="shear and extension at this depth lower the load by half a thousandth; the second limit "
    "load is a small difference",
    picture=lambda: Picture(solved(fields=True)[0], "S11"),
    seconds=2.5,
)
