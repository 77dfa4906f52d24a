"""Cook's panel beyond yield, plane stress: elements on coarse and fine meshes.

The panel 48 x 44/16, clamped left, carries a shear of 1.8 on its right edge; E = 70, nu = 1/3,
yield stress 0.243, linear hardening 0.135 (kN, mm). The value is the rise of the upper right
corner. No standard value exists for plane stress: Q9 48 x 48 gives 6.6081, Q8R 64 x 64 6.6102, Q4I
96 x 96 6.6084, three formulations that agree within 0.03 %. Beyond yield OPT is much too stiff on
coarse meshes (its bending weight is that of the elastic material), and Q4D converges slowly.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value
from corota.verification.models import nearest, run
from corota.verification.plastic_models import cook

TIP = 6.609
#: Element, elements per side, tolerance.
CASES = [
    ("Q8", 16, 0.01),
    ("Q8R", 16, 0.01),
    ("Q9", 16, 0.01),
    ("Q4I", 16, 0.01),
    ("Q8R", 32, 2e-3),
    ("Q4I", 32, 2e-3),
    ("Q4D", 32, 0.025),
]


@cache
def solved(element: str, n: int) -> ct.Results:
    """The panel under its load."""
    return run(cook(element, n), ct.Static(first_increment=0.2), fields=n <= 16)


def rise(element: str, n: int) -> float:
    """Rise of the corner [mm]."""
    results = solved(element, n)
    return float(results.frames[-1].U[nearest(results.mesh, 48.0, 60.0), 1])


def measure() -> Iterator[Value]:
    """Elements on two meshes."""
    for element, n, tolerance in CASES:
        yield Value(f"rise of the corner, {element} {n} x {n}", TIP, rise(element, n), tolerance)
    yield Value("OPT 32 x 32 over that, at most", 0.95, rise("OPT", 32) / TIP, 0.0, "at most")


def curve() -> Curve:
    """Force against the rise."""
    series = {}
    for element in ("Q8", "Q4I", "Q4D", "OPT"):
        results = solved(element, 16)
        tip = nearest(results.mesh, 48.0, 60.0)
        series[f"{element} 16 x 16"] = (
            [float(f.U[tip, 1]) for f in results.frames],
            [1.8 * f.factor for f in results.frames],
        )
    return Curve("rise of the corner", "force", series, {"fine meshes": ([TIP], [1.8])})


def study() -> Study:
    """Error against cells."""
    return Study.over(
        "error of the rise",
        ("Q4", "Q4I", "Q8", "Q8R", "Q4D", "OPT"),
        (4, 8, 16, 32),
        lambda e, n: abs(rise(e, n) / TIP - 1.0),
        "elements per side",
    )


PROBLEM = Problem(
    title="Cook's panel beyond yield",
    group="plasticity",
    source="data after J. C. Simo, F. Armero, Int. J. Numer. Meth. Engng 33 (1992); fine meshes",
    certainty="converged here",
    why="the plastic front passes through cells; 32 x 32 is within 0.2 % for quadratic elements",
    picture=lambda: Picture(solved("Q8", 16), "PEEQ"),
    seconds=5.0,
)
