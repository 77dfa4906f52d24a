"""NAFEMS LE1: a quarter of an elliptic membrane under outward pressure on its outer edge.

Inner ellipse (x/2)^2 + y^2 = 1, outer one (x/3.25)^2 + (y/2.75)^2 = 1 [m], thickness 0.1 m, E = 210
GPa, nu = 0.3, a pressure of 10 MPa outwards on the outer edge, symmetry on both straight sides. The
value is the stress in y at D (2, 0), where the inner edge meets the x axis.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import DRILLING, cell, nearest, run

TARGET = 92.7e6
#: Cells around and across, and the tolerance.
MESHES = {
    "Q8": (48, 32, 0.005),
    "Q9": (48, 32, 0.005),
    "Q8R": (48, 32, 0.005),
    "T6": (48, 32, 0.005),
    "Q4I": (48, 32, 0.005),
    "Q4D": (48, 32, 0.01),
}


def _ellipse(a: float, b: float) -> Any:
    def point(t: float) -> tuple[float, float]:
        return a * float(np.cos(0.5 * np.pi * t)), b * float(np.sin(0.5 * np.pi * t))

    return point


def _line(a: tuple[float, float], b: tuple[float, float]) -> Any:
    return lambda t: (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)


def solved(element: str, along: int, across: int) -> ct.Results:
    """The membrane on `along` cells around and `across` from the inner to the outer edge."""
    sides = [
        _line((2.0, 0.0), (3.25, 0.0)),
        _ellipse(3.25, 2.75),
        _line((0.0, 1.0), (0.0, 2.75)),
        _ellipse(2.0, 1.0),
    ]
    model = ct.Model(ct.mesh.mapped(sides, across, along, cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=210e9, nu=0.3), thickness=0.1)
    turn = 0.0 if element in DRILLING else None
    model.fix("bottom", x=None, rotation=turn)
    model.fix("top", y=None, rotation=turn)
    model.pressure("right", -10e6)
    return run(model, ct.Static(nlgeom=False), fields=True)


def stress(element: str, along: int, across: int) -> float:
    """Stress in y at D, extrapolated from the points of the elements there."""
    results = solved(element, along, across)
    return float(results.nodal("S22")[nearest(results.mesh, 2.0, 0.0)])


def measure() -> Iterator[Value]:
    """One mesh for each element."""
    for element, (along, across, tolerance) in MESHES.items():
        yield Value(
            f"stress in y at D [Pa], {element} {along} x {across}",
            TARGET,
            stress(element, along, across),
            tolerance,
        )


def study() -> Study:
    """Error against cells."""
    series = {}
    for element in ("Q4I", "Q4D", "T6", "Q8", "Q9"):
        cells, errors = [], []
        for n in (2, 4, 8, 16):
            cells.append(6.0 * n * n)
            errors.append(abs(stress(element, 3 * n, 2 * n) / TARGET - 1.0))
        series[element] = (cells, errors)
    return Study("error of the stress at D against 92.7 MPa", series, "cells")


PROBLEM = Problem(
    title="Elliptic membrane (NAFEMS LE1)",
    group="linear statics",
    source="NAFEMS, The Standard NAFEMS Benchmarks, LE1: 92.7 MPa",
    certainty="published",
    why="half a percent on the stated mesh, where stresses at an edge are extrapolated from the "
    "points inside; one percent for Q4D, whose stresses converge from above and more slowly",
    picture=lambda: Picture(solved("Q8", 16, 10), "S22", 200.0),
    seconds=1.6,
)
