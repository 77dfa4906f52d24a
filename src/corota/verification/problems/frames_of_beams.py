"""Frames of beams: Lee's frame, Williams' toggle, a deep arch and von Mises' truss.

The frames of the solid models with straight two-node beams (60 per leg or half span, 240 over the
arch), by arc length with default settings; von Mises' truss of two bars. The beams have the exact
shear flexibility and extensibility; the only error is that of the chords of the elements.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

import corota as ct
from corota.verification.beam_models import (
    deep_arch,
    lee_frame,
    von_mises_limits,
    von_mises_truss,
    williams_toggle,
)
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.models import run

#: Model, last displacement, and the exact load factors at the limit points.
CASES: dict[str, tuple[Callable[[], tuple[ct.Model, int]], float, tuple[float, float]]] = {
    "Lee's frame": (lee_frame, -62.0, (1.8544527, -0.93924896)),
    "Williams' toggle": (williams_toggle, -0.7, (33.847716, 31.246220)),
    "Lee's frame without shear": (lambda: lee_frame(shear=False), -62.0, (1.8556728, -0.94144316)),
    "Williams' toggle without shear": (
        lambda: williams_toggle(shear=False),
        -0.7,
        (33.870385, 31.281774),
    ),
    "deep arch": (lambda: deep_arch(240), -124.0, (0.89728913, -0.073055)),
    "von Mises' truss": (von_mises_truss, -2.2, von_mises_limits()),
}
#: Those that are followed from another first increment too.
TWICE = ("Lee's frame", "Williams' toggle", "von Mises' truss")


@cache
def solved(name: str, first: float = 0.0) -> tuple[ct.Results, int]:
    """Path of a frame to its last displacement; with the loaded node."""
    make, last, _ = CASES[name]
    model, node = make()
    path = ct.ArcLength(displacement=(node, "y", last))
    fields = name == "Lee's frame" and not first
    return run(model, ct.Static(path=path, first_increment=first), fields=fields), node


def measure() -> Iterator[Value]:
    """Both limit loads of each, and the same from another first increment."""
    for name, (_, _, exact) in CASES.items():
        # Two bars have no length of elements in the way.
        tolerance = 1e-6 if name == "von Mises' truss" else 1e-3
        for first in (0.0, 0.4) if name in TWICE else (0.0,):
            points = [p for p in solved(name, first)[0].critical_points if p.kind == "limit"]
            said = f", first increment {first:g}" if first else ""
            yield Value(f"{name}: limit points{said}", 2, len(points), 0.0, "absolute")
            for which, load, point in zip(("first", "second"), exact, points, strict=False):
                yield Value(f"{name}: {which} limit load{said}", load, point.factor, tolerance)


def curve() -> Curve:
    """Load against displacement of the loaded point of Lee's frame."""
    results, node = solved("Lee's frame")
    down = [-float(f.U[node, 1]) for f in results.frames]
    load = [f.factor for f in results.frames]
    return Curve(
        "displacement of the loaded point",
        "load",
        {"beams": (down, load)},
        {"exact beam": ([48.75424, 58.22496], list(CASES["Lee's frame"][2]))},
    )


PROBLEM = Problem(
    title="Frames of beams",
    group="paths and buckling",
    source="differential equations of the extensible, shear-flexible beam to seven digits; of the "
    "truss the derivative of its load by its height",
    certainty="computed independently",
    why="chords of the elements stand for the curve: an error of the square of their length",
    picture=lambda: Picture(solved("Lee's frame")[0], "M1"),
    seconds=8.0,
)
