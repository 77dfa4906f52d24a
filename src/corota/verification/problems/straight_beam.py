"""MacNeal and Harder's straight beam of six cells, rectangular, trapezoidal and slanted.

Length 6, depth 0.2, thickness 0.1, E = 1e7, nu = 0.3, unit shear at the tip; beam theory with shear
gives 0.1080936, the book 0.1081. The value is the tip deflection over 0.1081. Every four-node
element without rotations locks on trapezoids, as R. H. MacNeal proved; the table shows it.
Rotations are clamped; triangles have the diagonal from the lower left.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Value
from corota.verification.models import ELEMENTS, cell, linear, nearest, run

SHAPES = ("rectangles", "trapezoids", "parallelograms")
#: Shift of the nodes, and the rows of the elements for the three shapes.
ROWS = [
    (
        0.2,
        {
            "Q4": (0.0933, 0.0172, 0.0197),
            "Q4I": (0.9929, 0.0262, 0.6175),
            "Q4D": (0.9754, 0.6022, 0.6339),
            "OPT": (1.0517, 0.1606, 0.1660),
        },
    ),
    (
        0.1,
        {
            "Q4": (0.0933, 0.0269, 0.0342),
            "Q4I": (0.9929, 0.0515, 0.6323),
            "Q4D": (0.9754, 0.8563, 0.8733),
            "OPT": (1.0517, 0.5122, 0.5302),
        },
    ),
]


def slanted(shape: str, shift: float, element: str) -> ct.Mesh:
    """Six cells whose inner sides are slanted by `shift` either way."""
    mesh = ct.mesh.rectangle(6.0, 0.2, 6, 1, cell(element), "right")
    if shape != "rectangles":
        # Linear between the sides, so that mid-side nodes stay in the middle.
        signs = [1.0 if shape == "parallelograms" or i % 2 else -1.0 for i in range(7)]
        signs[0] = signs[6] = 0.0
        x, y = mesh.points.T
        mesh.points[:, 0] += shift * (y / 0.1 - 1.0) * np.interp(x, np.arange(7.0), signs)
    return mesh


def model(shape: str, shift: float, element: str) -> ct.Model:
    """The beam under unit tip shear."""
    made = ct.Model(slanted(shape, shift, element))
    made.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.3), thickness=0.1)
    made.fix("left", rotation=True)
    made.traction("right", y=1.0 / 0.02)
    return made


def measure() -> Iterator[Value]:
    """Every row to its last digit."""
    for shift, rows in ROWS:
        for element, row in rows.items():
            for shape, expected in zip(SHAPES, row, strict=True):
                made = model(shape, shift, element)
                tip = made.mesh.node_sets["right"]
                found = float(linear(made).U[tip, 1].mean()) / 0.1081
                text = f"{element} {shape}, shift {shift:g}"
                yield Value(text, expected, found, 0.51e-4, "absolute")
    for element in ELEMENTS:
        made = model("parallelograms", 0.2, element)
        made.supports.clear()
        made.loads.clear()
        made.fix("left", y=None, rotation=True)
        made.fix([nearest(made.mesh, 0.0, 0.0)], x=None)
        made.traction("right", x=1.0 / 0.02)
        found = float(linear(made).U[made.mesh.node_sets["right"], 0].mean())
        yield Value(f"extension, {element} parallelograms, shift 0.2", 3e-5, found, 1e-9)


PROBLEM = Problem(
    title="Straight beam of six cells",
    group="linear statics",
    source="R. H. MacNeal, R. L. Harder, Finite Elements in Analysis and Design 1 (1985); rows by "
    "an independent implementation of each element",
    certainty="computed independently",
    why="the last digit of the rows",
    picture=lambda: Picture(
        run(model("trapezoids", 0.1, "Q4D"), ct.Static(nlgeom=False), fields=True), "S11"
    ),
    seconds=0.2,
)
