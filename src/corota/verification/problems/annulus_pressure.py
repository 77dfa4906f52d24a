"""Thick ring under inner pressure: Lame's solution, plane stress and plane strain.

Radii 100 and 200, pressure 100, E = 210000, nu = 0.3, thickness 3. The values and the order of
convergence of both edge displacements are measured for every element.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import ELEMENTS, QUADRATIC, cell, linear, run

#: Displacement of the inner and the outer edge.
EXACT = {
    "stress": (0.0936507936507936, 0.0634920634920635),
    "strain": (0.0907936507936508, 0.0577777777777778),
}
#: Order of the displacements: the square of that of the energy where the load does the work.
ORDER = {name: 3 if name in QUADRATIC else 2 for name in ELEMENTS}


def model(element: str, n: int, plane: Any = "stress") -> ct.Model:
    """Quarter of the ring, `n` cells across and twice as many around."""
    made = ct.Model(ct.mesh.annulus(100.0, 200.0, n, 2 * n, angle=90.0, cell=cell(element)))
    material = ct.Elastic(E=210000.0, nu=0.3)
    made.section("all", element=element, material=material, thickness=3.0, plane=plane)
    made.fix("start", x=None, rotation=True)
    made.fix("end", y=None, rotation=True)
    made.pressure("inner", 100.0)
    return made


def displacements(element: str, n: int, plane: Any = "stress") -> list[float]:
    """Radial displacement of the inner and the outer edge."""
    made = model(element, n, plane)
    u, found = linear(made).U, []
    for name in ("inner", "outer"):
        nodes = made.mesh.node_sets[name]
        normal = made.mesh.points[nodes] / np.hypot(*made.mesh.points[nodes].T)[:, None]
        found.append(float((u[nodes] * normal).sum(axis=1).mean()))
    return found


def error(element: str, n: int, plane: Any = "stress") -> float:
    """Larger of the two errors."""
    return float(np.abs(np.array(displacements(element, n, plane)) / EXACT[plane] - 1.0).max())


def hoop(results: ct.Results) -> tuple[float, float]:
    """Circumferential stress at the inner and the outer edge, on the x axis."""
    mesh = results.mesh
    nodes = [int(np.argmin(np.hypot(mesh.points[:, 0] - r, mesh.points[:, 1]))) for r in (100, 200)]
    values = results.nodal("S22")
    return float(values[nodes[0]]), float(values[nodes[1]])


def measure() -> Iterator[Value]:
    """Displacements, stresses and orders."""
    for plane, exact in EXACT.items():
        for name, reference, found in zip(
            ("inner", "outer"), exact, displacements("Q8", 8, plane), strict=True
        ):
            yield Value(
                f"displacement of the {name} edge, plane {plane}, Q8 8 x 16", reference, found, 2e-5
            )
    stresses = hoop(run(model("Q9", 16), ct.Static(nlgeom=False), fields=True))
    for name, reference, found in zip(
        ("inner", "outer"), (500 / 3, 200 / 3), stresses, strict=True
    ):
        yield Value(f"hoop stress at the {name} edge, Q9 16 x 32", reference, found, 2e-3)
    for element in ELEMENTS:
        errors = [error(element, n, "strain") for n in (8, 16)]
        order = float(np.log2(errors[0] / errors[1]))
        yield Value(
            f"order of {element}, plane strain", ORDER[element] - 0.2, order, 0.0, "at least"
        )


def study() -> Study:
    """Error of every element."""
    sizes = (2, 4, 8, 16, 32)
    return Study.over("error of the displacement", ELEMENTS, sizes, error, "cells across")


PROBLEM = Problem(
    title="Ring under inner pressure (Lame)",
    group="linear statics",
    source="S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, section 28",
    certainty="analytic",
    why="the mesh error of Q8 at its order; orders 0.2 below the theory on the finest pair",
    picture=lambda: Picture(
        run(model("Q8", 8), ct.Static(nlgeom=False), fields=True), "MISES", 200.0
    ),
    seconds=0.9,
)
