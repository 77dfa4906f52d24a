"""Williams' toggle: a shallow rigid-jointed roof under a force on its apex.

Half span 12.943 in, rise 0.386 in, bars 0.753 x 0.243 in, E = 1.03e7 psi, clamped; nu = 0.3. Half
of it is a solid of Q8 by symmetry. The values are both limit loads and the deflections there.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.frame_models import williams_toggle
from corota.verification.models import run

#: Limit load of the Timoshenko beam and deflection (of Euler and Bernoulli's).
EXACT = [(33.847716, 0.2321569), (31.246220, 0.3915943)]


@cache
def solved(element: str = "Q8", **keys: Any) -> tuple[ct.Results, int]:
    """Path to a deflection of 0.7; with the node of the apex."""
    model, apex = williams_toggle(element)
    path = ct.ArcLength(displacement=(apex, "y", -0.7))
    return run(model, ct.Static(path=path), **keys), apex


def measure() -> Iterator[Value]:
    """Both limit points."""
    results, apex = solved()
    points = [p for p in results.critical_points if p.kind == "limit"]
    yield Value("limit points on the path", 2, len(points), 0.0, "absolute")
    for name, exact, point in zip(("first", "second"), EXACT, points, strict=False):
        yield Value(f"{name} limit load, Q8", exact[0], point.factor, 0.005)
        drop = -float(results.frames[point.increment].U[apex, 1])
        yield Value(f"deflection there, {name}", exact[1], drop, 0.01)


def curve() -> Curve:
    """Load against deflection."""
    results, apex = solved()
    drop = [-float(f.U[apex, 1]) for f in results.frames]
    return Curve(
        "deflection of the apex [in]",
        "load [lbf]",
        {"Q8": (drop, [f.factor for f in results.frames])},
        {"exact beam": ([e[1] for e in EXACT], [e[0] for e in EXACT])},
    )


PROBLEM = Problem(
    title="Williams' toggle",
    group="paths and buckling",
    source="F. W. Williams, Quart. J. Mech. Appl. Math. 17 (1964); values from the differential "
    "equations of the extensible beam",
    certainty="computed independently",
    why="solid and beam differ at the clamp and the apex; deflections are those without shear",
    picture=lambda: Picture(solved(fields=True)[0], "S11"),
    seconds=0.4,
)
