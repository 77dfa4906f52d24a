"""MacNeal and Harder's curved beam: a quarter ring, clamped, under unit shear at its free end.

Radii 4.12 and 4.32, thickness 0.1, E = 1e7, nu = 0.25. The book's 0.08734 is 1.4 % off: elasticity
gives 0.08856553 with a clamp at the middle only, thin-beam theory with shear 0.08860200.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import cell, linear, run

EXACT = 0.0886
#: Cells across and around for each element.
MESHES = {
    "Q4I": (4, 64),
    "Q8": (2, 24),
    "Q8R": (2, 24),
    "Q9": (2, 24),
    "T6": (2, 24),
    "Q4D": (4, 64),
    "OPT": (4, 64),
}


def model(element: str, across: int, around: int) -> ct.Model:
    """The beam under unit shear."""
    made = ct.Model(ct.mesh.annulus(4.12, 4.32, across, around, angle=90.0, cell=cell(element)))
    made.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.25), thickness=0.1)
    made.fix("end", rotation=True)
    made.traction("start", x=1.0 / 0.02)
    return made


def tip(element: str, across: int, around: int) -> float:
    """Deflection of the loaded end."""
    made = model(element, across, around)
    return abs(float(linear(made).U[made.mesh.node_sets["start"], 0].mean()))


def measure() -> Iterator[Value]:
    """Fine meshes of each element."""
    for element, (across, around) in MESHES.items():
        yield Value(f"{element} {across} x {around}", EXACT, tip(element, across, around), 0.005)


def study() -> Study:
    """Error against cells around, one to four across."""
    series = {}
    for element in MESHES:
        cells = [(1, 6), (1, 12), (2, 24), (4, 48)]
        errors = [abs(tip(element, a, b) / EXACT - 1.0) for a, b in cells]
        series[element] = ([float(b) for _, b in cells], errors)
    return Study("error of the deflection", series, "cells around")


PROBLEM = Problem(
    title="Curved beam under tip shear",
    group="linear statics",
    source="R. H. MacNeal, R. L. Harder, Finite Elements in Analysis and Design 1 (1985); value by "
    "S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, section 33",
    certainty="analytic",
    why="clamps of elasticity and of the model differ by 0.1 %; the rest is mesh error",
    picture=lambda: Picture(run(model("Q8", 2, 24), ct.Static(nlgeom=False), fields=True), "SP1"),
    seconds=0.1,
)
